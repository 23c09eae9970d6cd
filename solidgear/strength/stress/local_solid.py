r"""Stress concentration of a cut that is not of revolution, by a 3D solid of the shaft around it.

Four unit loads act on the ends of a piece of the shaft: tension, bending in the plane of the cut
and across it, and torsion, as Saint-Venant's stress of a plain shaft. A plane of symmetry of the cut
makes every load even or odd, so that a part of the piece is enough:

    load              x = 0   middle   z = 0
    tension           even    even     even
    bending about x   even    even     odd
    bending about z   odd     even     even
    torsion           odd     odd      odd

Meshes are refined towards the largest stress of each load until error bars are met. The error bar
is the larger of the change from the mesh before and of the traction that is left on the free surface
where the stress is largest.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import scipy.linalg as sla
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTet

from solidgear.core.kernel.assembly import Tabulation
from solidgear.core.models.solid.block import rigid_motions
from solidgear.core.models.solid.matrices import integrals
from solidgear.core.solve.factor import factorise
from solidgear.strength.stress.local_mesh import LocalShape, Peak, local_mesh
from solidgear.strength.stress.surface_stress import SurfaceStress, larger, surface_stress

if TYPE_CHECKING:
    from solidgear.core.models.solid.mesh import SolidMesh
    from solidgear.core.scene import Material

#: unit loads: tension, bending in the plane of the cut and across it, torsion
LOADS = ("tension", "bending_x", "bending_z", "torsion")
#: by load, whether it is even about the planes x = 0, y = 0 and z = 0
EVEN = {
    "tension": (True, True, True),
    "bending_x": (True, True, False),
    "bending_z": (False, True, True),
    "torsion": (False, False, False),
}
#: of polynomials that the quadrature of stiffness has right: the first with positive weights that has
#: four points an edge or more
DEGREE = 5
#: angles of the bending plane at which the stress of a turning shaft is looked for
ANGLES = 24


@dataclass(frozen=True)
class Peaks:
    """Largest stress under unit loads on one mesh, over the nominal stress of the plain shaft."""

    unknowns: int
    value: Mapping[str, float]  #: by load, with one bending of the turning shaft
    place: Mapping[str, np.ndarray]  #: (3,) m from the middle of the cut
    traction: Mapping[str, float]  #: left on the surface there
    surface: SurfaceStress = field(repr=False)  #: in the order of LOADS


def peaks_on(shape: LocalShape, material: Material, at: Sequence[Peak] = ()) -> Peaks:
    """Solve a piece around a cut on one mesh, with smaller elements at some places."""
    mesh = local_mesh(shape, at)
    moved = displacements(mesh, shape, material)
    mu = material.shear_modulus
    lame = 2 * mu * material.nu / (1 - 2 * material.nu)
    surface = surface_stress(mesh, _free(mesh, shape), moved, lame, mu)
    return Peaks(moved.size // len(LOADS), *_largest(surface), surface)


def _largest(surface: SurfaceStress):
    """Return the largest stress, its place and the traction there, by load."""
    tension, first, second, torsion = range(4)
    angles = np.linspace(0.0, np.pi, ANGLES, endpoint=False)
    turned = np.array(
        [larger(np.cos(t) * surface.plane[first] + np.sin(t) * surface.plane[second]) for t in angles]
    )
    turn = turned.max(axis=1).argmax()
    fields = {
        "tension": surface.largest()[tension],
        "bending": turned[turn],
        "torsion": surface.shear()[torsion],
    }
    left = {
        "tension": surface.traction[tension],
        "bending": np.cos(angles[turn]) * surface.traction[first]
        + np.sin(angles[turn]) * surface.traction[second],
        "torsion": surface.traction[torsion],
    }
    node = {load: int(values.argmax()) for load, values in fields.items()}
    return (
        {load: float(fields[load][k]) for load, k in node.items()},
        {load: surface.x[:, k] for load, k in node.items()},
        {load: float(np.linalg.norm(left[load][:, k])) for load, k in node.items()},
    )


def displacements(mesh: SolidMesh, shape: LocalShape, material: Material) -> np.ndarray:
    """Compute the displacements (3 n, k) of the nodes under unit loads, whose nominal stress on
    the surface of the plain shaft is 1 Pa.
    """
    points, weights = get_quadrature(RefTet, DEGREE)
    basis = Tabulation(mesh.element, mesh.element, points)
    stiffness = integrals(mesh, [material], basis, weights, mesh.dofs)[0].matrix()
    forces = _forces(mesh, shape)
    rigid = rigid_motions(mesh.nodes / shape.outer)
    moved = np.zeros_like(forces)
    groups: dict[tuple[bool, ...], list[int]] = {}
    for k, load in enumerate(LOADS):
        groups.setdefault(tuple(EVEN[load][axis] for axis in shape.planes), []).append(k)
    for even, members in groups.items():
        free = _movable(mesh, shape, even, rigid)
        factor = factorise(stiffness[free][:, free])
        moved[np.ix_(free, members)] = factor.solve(forces[np.ix_(free, members)])
    return moved


def _forces(mesh: SolidMesh, shape: LocalShape) -> np.ndarray:
    """Return the forces (3 n, k) on the nodes of the end faces."""
    n, forces = mesh.nodes.shape[1], np.zeros((mesh.nodes.shape[1], 3, len(LOADS)))
    for side in (1.0,) if 1 in shape.planes else (-1.0, 1.0):
        facets = mesh.section(side * shape.half, 1e-9 * shape.half)
        for value, place, area, dofs in mesh.over_facets(facets):
            x, _, z = place / shape.outer
            still = np.zeros_like(x)
            # (component, load, e, q)
            traction = side * np.array(
                [
                    [still, still, still, z],
                    [still + 1, z, x, still],
                    [still, still, still, -x],
                ]
            )
            load = np.einsum("bq,eq,cleq->becl", value, area, traction, optimize=True)
            np.add.at(forces, dofs, load)
    return forces.reshape(3 * n, -1)


def _movable(
    mesh: SolidMesh, shape: LocalShape, even: tuple[bool, ...], rigid: np.ndarray
) -> np.ndarray:
    """Return the unknowns that planes of symmetry leave free under even or odd loads, without as
    many as hold the rigid motions that remain.
    """
    held = np.zeros((mesh.nodes.shape[1], 3), bool)
    for axis, is_even in zip(shape.planes, even):
        on_plane = np.abs(mesh.nodes[axis]) < 1e-9 * shape.half
        components = [axis] if is_even else [c for c in range(3) if c != axis]
        held[np.ix_(on_plane, components)] = True
    fixed = held.ravel()
    remaining = sla.null_space(rigid[fixed], rcond=1e-9) if fixed.any() else np.eye(6)
    free = np.flatnonzero(~fixed)
    if not remaining.shape[1]:
        return free
    _, _, pivots = sla.qr((rigid[free] @ remaining).T, mode="economic", pivoting=True)
    return np.delete(free, pivots[: remaining.shape[1]])


def _free(mesh: SolidMesh, shape: LocalShape) -> np.ndarray:
    """Return the facets of the surface that carry no load and lie on no plane of symmetry."""
    facets = mesh.boundary
    places, hair = mesh.mesh.p[:, mesh.mesh.facets[:, facets]], 1e-9 * shape.half
    on_end = (np.abs(np.abs(places[1]) - shape.half) < hair).all(axis=0)
    for axis in shape.planes:
        on_end |= (np.abs(places[axis]) < hair).all(axis=0)
    return facets[~on_end]
