"""Stress on the free surface of a solid of tetrahedra, with the traction that it should not have.

Stress at a node is the mean of the elements around it. On a free surface it is plane: two normal
stresses and a shear between directions of the surface. The traction left on the surface is the
error of a finite element solution there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.core.kernel.assembly import reference
from solidgear.core.models.solid.mesh import SolidMesh


@dataclass(frozen=True)
class SurfaceStress:
    """Stress under some loads at the nodes of the facets of a free surface, Pa."""

    x: np.ndarray  #: (3, m) places, m
    normal: np.ndarray  #: (3, m) of the surface
    plane: np.ndarray  #: (k, 3, m) both normal stresses and the shear, of directions of the surface
    traction: np.ndarray  #: (k, 3, m) that should be zero

    def largest(self) -> np.ndarray:
        """Return the larger principal stress (k, m), without its sign."""
        return larger(self.plane)

    def shear(self) -> np.ndarray:
        """Return the largest shear stress (k, m) on any plane; the third principal stress is zero."""
        first, second = principal(self.plane)
        return np.maximum(np.abs(first - second), larger(self.plane)) / 2


def principal(plane: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return both principal stresses of plane stress (..., 3, m), the larger first."""
    a, b, shear = np.moveaxis(plane, -2, 0)
    half = np.hypot((a - b) / 2, shear)
    return (a + b) / 2 + half, (a + b) / 2 - half


def larger(plane: np.ndarray) -> np.ndarray:
    """Return the principal stress of plane stress (..., 3, m) that is larger without its sign."""
    first, second = principal(plane)
    return np.maximum(np.abs(first), np.abs(second))


def surface_stress(
    mesh: SolidMesh, facets: np.ndarray, moved: np.ndarray, lame: float, mu: float
) -> SurfaceStress:
    """Compute the stress on facets under displacements (3 n, k) of the nodes, by the constants of
    Lame, Pa.
    """
    nodal = _at_nodes(mesh, facets, moved, lame, mu)
    x, normal, node = _facet_nodes(mesh, facets)
    first, second = _tangents(normal)
    sigma = nodal[:, node]  # (k, m, 3, 3)
    traction = np.einsum("kmij,jm->kim", sigma, normal)
    plane = np.stack(
        [
            np.einsum("im,kmij,jm->km", a, sigma, b, optimize=True)
            for a, b in ((first, first), (second, second), (first, second))
        ],
        axis=1,
    )
    return SurfaceStress(x, normal, plane, traction)


def _at_nodes(
    mesh: SolidMesh, facets: np.ndarray, moved: np.ndarray, lame: float, mu: float
) -> np.ndarray:
    """Return the mean stress (k, n, 3, 3) of elements at the nodes that facets have; zero elsewhere."""
    n, k = mesh.nodes.shape[1], moved.shape[1]
    on_surface = np.zeros(n, bool)
    on_surface[mesh.facet_unknowns(facets)] = True
    elements = np.flatnonzero(on_surface[mesh.dofs].any(axis=0))
    table = mesh.tabulate(mesh.element.doflocs.T, elements)
    slope = table.gradient(np.ones_like(table.det))  # (e, dim, nb, nq)
    u = moved.reshape(n, 3, k)[mesh.dofs[:, elements]]  # (nb, e, 3, k)
    rate = np.einsum("edbq,beck->kqecd", slope, u, optimize=True)
    strain = (rate + rate.swapaxes(-1, -2)) / 2
    sigma = 2 * mu * strain
    trace = np.trace(strain, axis1=-2, axis2=-1)
    sigma += lame * trace[..., None, None] * np.eye(3)
    total, count = np.zeros((n, k, 3, 3)), np.zeros(n)
    dofs = mesh.dofs[:, elements]
    np.add.at(total, dofs, sigma.transpose(1, 2, 0, 3, 4))
    np.add.at(count, dofs, 1.0)
    return (total / np.maximum(count, 1.0)[:, None, None, None]).transpose(1, 0, 2, 3)


def _facet_nodes(mesh: SolidMesh, facets: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return places (3, m), normals (3, m) and numbers (m,) of the nodes of facets, facet by facet."""
    grid = np.array([[0.0, 1.0, 0.0, 0.5, 0.5, 0.0], [0.0, 0.0, 1.0, 0.0, 0.5, 0.5]])
    places, normals, numbers = [], [], []
    for place, elements in mesh.local_facets(facets):
        points, s, t = mesh.on_facet(place, grid)
        table = mesh.tabulate(points, elements)
        normal = np.cross(table.tangent @ s, table.tangent @ t)
        normal /= np.linalg.norm(normal, axis=2, keepdims=True)
        function = np.abs(reference(mesh.element, points)[0]).argmax(axis=0)
        places.append(table.x.reshape(3, -1))
        normals.append(normal.reshape(-1, 3).T)
        numbers.append(mesh.dofs[function][:, elements].T.ravel())
    return np.hstack(places), np.hstack(normals), np.concatenate(numbers)


def _tangents(normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return two directions (3, m) of a surface at right angles to each other."""
    least = np.abs(normal).argmin(axis=0)
    axis = np.eye(3)[:, least]
    first = np.cross(normal, axis, axis=0)
    first /= np.linalg.norm(first, axis=0)
    return first, np.cross(normal, first, axis=0)
