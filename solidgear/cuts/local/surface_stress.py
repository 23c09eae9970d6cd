"""Stress on the free surface of a solid of tetrahedra, with the traction that it should not have.

Stress at a node is the mean of the elements around it. On a free surface it is plane: two normal
stresses and a shear between directions of the surface. The traction left on the surface is the
error of a finite element solution there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.core.models.solid.mesh import SolidMesh

#: local coordinates of the nodes of a facet
FACET = np.array([[0.0, 1.0, 0.0, 0.5, 0.5, 0.0], [0.0, 0.0, 1.0, 0.0, 0.5, 0.5]])


@dataclass(frozen=True)
class SurfaceStress:
    """Stress under some loads at the nodes of the facets of a free surface, Pa."""

    x: np.ndarray  #: (3, m) places, m
    normal: np.ndarray  #: (3, m) of the surface, outwards
    sigma: np.ndarray  #: (k, m, 3, 3) stress
    slope: np.ndarray  #: (k, m, 3, 3) its derivative along the normal, outwards, Pa/m

    @property
    def traction(self) -> np.ndarray:
        """Traction (k, m), which should be zero, Pa."""
        return np.linalg.norm(np.einsum("kmij,jm->kim", self.sigma, self.normal), axis=1)

    @property
    def plane(self) -> np.ndarray:
        """Both normal stresses and the shear (k, 3, m) of two directions of the surface, Pa."""
        first, second = _tangents(self.normal)
        pairs = ((first, first), (second, second), (first, second))
        parts = [np.einsum("im,kmij,jm->km", a, self.sigma, b, optimize=True) for a, b in pairs]
        return np.stack(parts, axis=1)

    def combined(self, weights: np.ndarray) -> SurfaceStress:
        """Return the stress under combinations (c, k) of the loads."""
        sigma, slope = (np.tensordot(weights, a, axes=1) for a in (self.sigma, self.slope))
        return SurfaceStress(self.x, self.normal, sigma, slope)


def principal(plane: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return both principal stresses of plane stress (..., 3, m), the larger first."""
    a, b, shear = np.moveaxis(plane, -2, 0)
    half = np.hypot((a - b) / 2, shear)
    return (a + b) / 2 + half, (a + b) / 2 - half


def larger(plane: np.ndarray) -> np.ndarray:
    """Return the principal stress of plane stress (..., 3, m) that is larger without its sign."""
    first, second = principal(plane)
    return np.maximum(np.abs(first), np.abs(second))


def largest_shear(plane: np.ndarray) -> np.ndarray:
    """Return the largest shear on any plane of plane stress (..., 3, m): half of the difference of
    two principal stresses, of which the third is zero.
    """
    first, second = principal(plane)
    return np.maximum(np.abs(first - second), larger(plane)) / 2


def surface_stress(
    mesh: SolidMesh, facets: np.ndarray, moved: np.ndarray, lame: float, mu: float
) -> SurfaceStress:
    """Compute the stress on facets under displacements (3 n, k) of the nodes, by the constants of
    Lame, Pa.
    """
    nodal = _at_nodes(mesh, moved, lame, mu)
    places, normals, stresses, slopes = [], [], [], []
    for place, elements in mesh.local_facets(facets):
        points, s, t = mesh.on_facet(place, FACET)
        table = mesh.tabulate(points, elements)
        normal = np.cross(table.tangent @ s, table.tangent @ t)
        normal /= np.linalg.norm(normal, axis=2, keepdims=True)
        middle = mesh.nodes[:, mesh.dofs[:, elements]].mean(axis=1)
        outwards = (normal * (table.x - middle[:, :, None]).transpose(1, 2, 0)).sum(axis=2) > 0
        normal = np.where(outwards[..., None], normal, -normal)
        # of the nodal stress, which is continuous
        inside = nodal[:, mesh.dofs[:, elements]]  # (k, nb, e, 3, 3)
        rate = table.gradient(np.ones_like(table.det))  # (e, dim, nb, q)
        along = np.einsum("edbq,eqd->ebq", rate, normal, optimize=True)
        k = len(nodal)
        places.append(table.x.reshape(3, -1))
        normals.append(normal.reshape(-1, 3).T)
        stresses.append(
            np.einsum("bq,kbeij->keqij", table.value, inside, optimize=True).reshape(k, -1, 3, 3)
        )
        slopes.append(
            np.einsum("ebq,kbeij->keqij", along, inside, optimize=True).reshape(k, -1, 3, 3)
        )
    return SurfaceStress(
        np.hstack(places),
        np.hstack(normals),
        np.concatenate(stresses, axis=1),
        np.concatenate(slopes, axis=1),
    )


def _at_nodes(mesh: SolidMesh, moved: np.ndarray, lame: float, mu: float) -> np.ndarray:
    """Return the mean stress (k, n, 3, 3) of the elements around each node."""
    n, k = mesh.nodes.shape[1], moved.shape[1]
    table = mesh.tabulate(mesh.element.doflocs.T, np.arange(mesh.dofs.shape[1]))
    slope = table.gradient(np.ones_like(table.det))  # (e, dim, nb, nq)
    u = moved.reshape(n, 3, k)[mesh.dofs]  # (nb, e, 3, k)
    rate = np.einsum("edbq,beck->qekcd", slope, u, optimize=True)
    strain = (rate + rate.swapaxes(-1, -2)) / 2
    sigma = 2 * mu * strain
    trace = np.trace(strain, axis1=-2, axis2=-1)
    sigma += lame * trace[..., None, None] * np.eye(3)
    total, count = np.zeros((n, k, 3, 3)), np.zeros(n)
    np.add.at(total, mesh.dofs, sigma)
    np.add.at(count, mesh.dofs, 1.0)
    return (total / count[:, None, None, None]).transpose(1, 0, 2, 3)


def _tangents(normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return two directions (3, m) of a surface at right angles to each other."""
    axis = np.eye(3)[:, np.abs(normal).argmin(axis=0)]
    first = np.cross(normal, axis, axis=0)
    first /= np.linalg.norm(first, axis=0)
    return first, np.cross(normal, first, axis=0)
