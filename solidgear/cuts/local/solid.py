r"""Stress concentration of a cut that is not of revolution, by a 3D solid of the shaft around it.

Four unit loads act on the ends of a piece of the shaft: tension, bending in the plane of the cut
and across it, and torsion, as Saint-Venant's stress of a plain shaft. A plane of symmetry of the cut
makes every load even or odd, so that a part of the piece is enough:

    load              x = 0   middle   z = 0
    tension           even    even     even
    bending about x   even    even     odd
    bending about z   odd     even     even
    torsion           odd     odd      odd

Meshes are refined where the largest stress of each load may lie until error bars are met. The error bar
counts the change from the mesh before, and the traction that is left on the free surface where the
largest stress may lie.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import numpy as np
import scipy.linalg as sla
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTet

from solidgear.core.kernel.assembly import Tabulation
from solidgear.core.models.solid.block import rigid_motions
from solidgear.core.models.solid.matrices import integrals
from solidgear.core.solve.factor import factorise
from solidgear.core.solve.inertia_relief import ratio
from solidgear.cuts.local.mesh import LocalShape, Places, local_mesh
from solidgear.cuts.local.surface_stress import (
    SurfaceStress,
    larger,
    largest_shear,
    surface_stress,
)

if TYPE_CHECKING:
    from solidgear.core.models.solid.mesh import SolidMesh

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
class PeakStress:
    """Largest stress under one load, over the nominal stress of the plain shaft."""

    value: float
    place: np.ndarray  #: (3,) m, y from the middle of the cut
    #: root mean square of what is left on the surface wherever it may lie, of which the largest shear
    #: has the share that it has in stress
    traction: float
    gradient: float  #: relative, into the material, 1/m


@dataclass(frozen=True)
class LocalSolution:
    """Stress on the surface around a cut by one mesh, over the nominal stress of the plain shaft."""

    unknowns: int
    x: np.ndarray  #: (3, m) places on the surface, m, y from the middle of the cut
    #: (m,) by load: largest principal stress under tension, its amplitude under bending of the
    #: turning shaft, largest shear stress under torsion
    fields: Mapping[str, np.ndarray] = field(repr=False)
    peaks: Mapping[str, PeakStress]
    #: (3, k) where the largest stress of a load may lie: with the traction left there no less than the
    #: largest without it
    leading: np.ndarray = field(repr=False)


class Elastic(NamedTuple):
    """A material of unit shear modulus: stress is over nominal stress, whatever the modulus."""

    nu: float
    shear_modulus: float = 1.0
    density: float = 1.0


def solution_on(shape: LocalShape, nu: float, places: Sequence[Places] = ()) -> LocalSolution:
    """Solve a piece around a cut on one mesh, with smaller elements at some places, by Poisson's
    ratio.
    """
    mesh = local_mesh(shape, places)
    moved = displacements(mesh, shape, nu)
    surface = surface_stress(mesh, free_surface(mesh, shape), moved, *lame_of(nu))
    tension, first, second, torsion = range(4)
    angles = np.linspace(0.0, np.pi, ANGLES, endpoint=False)
    planes = np.zeros((ANGLES, len(LOADS)))
    planes[:, first], planes[:, second] = np.cos(angles), np.sin(angles)
    turned = larger(np.tensordot(planes, surface.plane, axes=1))
    fields = {
        "tension": larger(surface.plane[tension]),
        "bending": turned.max(axis=0),
        "torsion": largest_shear(surface.plane[torsion]),
    }
    worst = planes[turned.max(axis=1).argmax()]
    weights = dict(zip(fields, (np.eye(4)[tension], worst, np.eye(4)[torsion])))
    peaks, leading = {}, np.zeros(surface.x.shape[1], bool)
    for load, w in weights.items():
        loaded, values = surface.combined(w[None]), fields[load]
        left = _left(loaded, values)
        possible = values + left >= (values - left).max()
        peaks[load] = _peak(loaded, load, values, float(np.sqrt((left[possible] ** 2).mean())))
        leading |= possible
    return LocalSolution(moved.shape[0], surface.x, fields, peaks, surface.x[:, leading])


def _left(surface: SurfaceStress, values: np.ndarray) -> np.ndarray:
    """Return the traction (m,) left on a surface, of which values have the share that they have in the
    largest stress there.
    """
    largest = np.abs(np.linalg.eigvalsh(surface.sigma[0])).max(axis=1)
    return ratio(surface.traction[0] * values, largest)


def _peak(surface: SurfaceStress, load: str, values: np.ndarray, left: float) -> PeakStress:
    """Return the largest of values (m,) on a surface, with what goes with it."""
    node = int(values.argmax())
    sigma, slope = surface.sigma[0, node], surface.slope[0, node]
    stress, direction = np.linalg.eigh(sigma)
    along = np.einsum("ia,ij,ja->a", direction, slope, direction)
    if load == "torsion":
        # the two principal stresses between which the shear is largest
        gradient = (along[-1] - along[0]) / (stress[-1] - stress[0])
    else:
        largest = int(np.abs(stress).argmax())
        gradient = along[largest] / stress[largest]
    return PeakStress(float(values[node]), surface.x[:, node], left, float(gradient))


def lame_of(nu: float) -> tuple[float, float]:
    """Return the constants of Lame for a unit shear modulus, that the second."""
    return 2 * nu / (1 - 2 * nu), 1.0


def displacements(mesh: SolidMesh, shape: LocalShape, nu: float) -> np.ndarray:
    """Compute the displacements (3 n, k) of the nodes under unit loads, whose nominal stress on
    the surface of the plain shaft is one, in units of the shear modulus.
    """
    points, weights = get_quadrature(RefTet, DEGREE)
    basis = Tabulation(mesh.element, mesh.element, points)
    stiffness = integrals(mesh, [cast(Any, Elastic(nu))], basis, weights, mesh.dofs)[0].matrix()
    forces = forces_on(mesh, shape)
    moved = np.zeros_like(forces)
    groups: dict[bytes, list[int]] = {}
    held = [held_unknowns(mesh, shape, load) for load in LOADS]
    for k, mask in enumerate(held):
        groups.setdefault(mask.tobytes(), []).append(k)
    for members in groups.values():
        free = np.flatnonzero(~held[members[0]])
        factor = factorise(stiffness[free][:, free])
        block = np.ix_(free, np.array(members))
        moved[block] = factor.solve(forces[block])
    return moved


def forces_on(mesh: SolidMesh, shape: LocalShape) -> np.ndarray:
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


def held_unknowns(mesh: SolidMesh, shape: LocalShape, load: str) -> np.ndarray:
    """Return the mask (3 n,) of unknowns that planes of symmetry hold under a load, and of as many
    as hold the rigid motions that remain.
    """
    held = np.zeros((mesh.nodes.shape[1], 3), bool)
    for axis in shape.planes:
        on_plane = np.abs(mesh.nodes[axis]) < 1e-9 * shape.half
        components = [axis] if EVEN[load][axis] else [c for c in range(3) if c != axis]
        held[np.ix_(on_plane, components)] = True
    out = held.ravel()
    rigid = rigid_motions(mesh.nodes / shape.outer)
    remaining = sla.null_space(rigid[out].T @ rigid[out], rcond=1e-12)
    if remaining.shape[1]:
        free = np.flatnonzero(~out)
        _, _, pivots = sla.qr((rigid[free] @ remaining).T, mode="economic", pivoting=True)
        out[free[pivots[: remaining.shape[1]]]] = True
    return out


def free_surface(mesh: SolidMesh, shape: LocalShape) -> np.ndarray:
    """Return the facets of the surface that carry no load and lie on no plane of symmetry."""
    facets = mesh.boundary
    places, hair = mesh.mesh.p[:, mesh.mesh.facets[:, facets]], 1e-9 * shape.half
    on_end = (np.abs(np.abs(places[1]) - shape.half) < hair).all(axis=0)
    for axis in shape.planes:
        on_end |= (np.abs(places[axis]) < hair).all(axis=0)
    return facets[~on_end]
