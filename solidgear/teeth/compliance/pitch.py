r"""One pitch of a toothed wheel in plane strain, condensed to its sides.

Sides move in radial and clockwise parts, so that the right one moves under a wave as the left one does,
but for the wave's factor (:mod:`solidgear.teeth.compliance.ring`).
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree
from skfem import ElementQuad2
from skfem.quadrature import get_quadrature
from skfem.refdom import RefQuad

from solidgear.core.errors import SolidgearError
from solidgear.core.kernel.assembly import Pattern, reference, tabulate
from solidgear.teeth.compliance.mesh import PitchMesh
from solidgear.teeth.compliance.ring import CondensedPitch, condensed
from solidgear.teeth.contact.local import Elasticity

#: degree of polynomials that the quadrature of a cell integrates
DEGREE = 7
#: cells whose middles are nearest to a point, one of which has it
NEAREST = 9
#: steps of Newton from the middle of a cell, and what rounding leaves outside it
STEPS, OUTSIDE = 12, 1e-9


def plane_pitch(
    mesh: PitchMesh,
    elasticity: Elasticity,
    holds: bool,
    forces: sp.csr_matrix,
    readings: sp.csr_matrix,
) -> CondensedPitch:
    """Condense one pitch to its sides; the circle that ends the rim is held or free.  Forces and readings
    are rows of the unknowns.
    """
    stiffness = _stiffness(mesh, elasticity)
    fixed = np.zeros(len(mesh.points), bool)
    fixed[mesh.circle] = holds
    sides = mesh.sides[:, ~fixed[mesh.sides[0]]]
    inside = ~fixed
    inside[sides] = False
    inner = (2 * np.flatnonzero(inside)[:, None] + np.arange(2)).ravel()
    # of both sides, left before right, radial and clockwise
    edge = (2 * sides.ravel()[:, None] + np.arange(2)).ravel()
    polar = _polar(mesh.points[sides.ravel()])
    place = sp.csr_matrix(
        (np.ones(len(edge)), (edge, np.arange(len(edge)))), shape=(stiffness.shape[0], len(edge))
    )
    return condensed(stiffness, inner, (place @ polar.T).tocsr(), forces.T.tocsr(), readings)


def _polar(points: np.ndarray) -> sp.csr_matrix:
    """Return the rotation of motions at points into their radial and clockwise parts."""
    out = points / np.hypot(points[:, 0], points[:, 1])[:, None]
    around = np.column_stack([out[:, 1], -out[:, 0]])
    return sp.block_diag(np.stack([out, around], axis=1), format="csr")


def _stiffness(mesh: PitchMesh, elasticity: Elasticity) -> sp.csr_matrix:
    """Return the stiffness of a pitch in plane strain, per face width, N/m^2."""
    youngs, poisson = elasticity.youngs, elasticity.poisson
    shear = youngs / (2 * (1 + poisson))
    lame = youngs * poisson / ((1 + poisson) * (1 - 2 * poisson))
    points, weights = get_quadrature(RefQuad, DEGREE)
    element = ElementQuad2()
    cells = tabulate(element, mesh.points[mesh.cells].transpose(2, 1, 0), element, points)
    gradient = cells.gradient(np.sqrt(cells.det * weights))
    products = np.einsum("eiaq,ejbq->ijeab", gradient, gradient, optimize=True)
    swapped = products.transpose(1, 0, 2, 3, 4)
    values = lame * products + shear * swapped
    for i in range(2):
        values[i, i] += shear * (products[0, 0] + products[1, 1])
    total = Pattern(mesh.cells.T).sum(2)
    total.add(slice(None), values)
    return total.matrix()


def motion_rows(
    nodes: np.ndarray, shares: np.ndarray, directions: np.ndarray, count: int
) -> sp.csr_matrix:
    """Return rows over the unknowns of `count` nodes: the (m, b) shares of the motions of (m, b) nodes
    along (m, 2) directions.
    """
    entries = shares[:, :, None] * directions[:, None, :]
    columns = 2 * nodes[:, :, None] + np.arange(2)
    rows = np.broadcast_to(np.arange(len(nodes))[:, None, None], entries.shape)
    return sp.csr_matrix(
        (entries.ravel(), (rows.ravel(), columns.ravel())), shape=(len(nodes), 2 * count)
    )


def read_rows(mesh: PitchMesh, points: np.ndarray, directions: np.ndarray) -> sp.csr_matrix:
    """Return rows that read the motion along (m, 2) directions at (m, 2) points inside the mesh."""
    cells = mesh.points[mesh.cells]
    tree = cKDTree(cells[:, 8])
    nearest = min(NEAREST, len(cells))
    cell, place, outside = _cells_of(cells, tree.query(points, nearest)[1], points)
    # long cells may have their middles far from what lies in them
    lost = np.flatnonzero(outside > OUTSIDE)
    if lost.size:
        every = tree.query(points[lost], len(cells))[1]
        cell[lost], place[lost], outside[lost] = _cells_of(cells, every, points[lost])
    if outside.max() > OUTSIDE:
        raise SolidgearError("teeth: a place at which motion is read is in no tooth or rim")
    shapes, _ = reference(ElementQuad2(), place.T)
    return motion_rows(mesh.cells[cell], shapes.T, directions, len(mesh.points))


def _cells_of(
    cells: np.ndarray, near: np.ndarray, points: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the cell (m,) of those near (m, k) that holds each point best, the place (m, 2) in it, and how
    far outside the point lies there, in cells.
    """
    place = np.full((*near.shape, 2), 0.5)
    element = ElementQuad2()
    for _ in range(STEPS):
        shapes, slopes = reference(element, place.reshape(-1, 2).T)
        shapes, slopes = shapes.reshape(9, *near.shape), slopes.reshape(9, 2, *near.shape)
        missing = points[:, None] - np.einsum("bmk,mkbi->mki", shapes, cells[near])
        jacobian = np.einsum("bdmk,mkbi->mkid", slopes, cells[near])
        step = np.linalg.solve(jacobian, missing[..., None])[..., 0]
        place = np.clip(place + step, -1.0, 2.0)  # a cell far from the point has it nowhere
    outside = np.abs(place - 0.5).max(axis=2) - 0.5
    best = np.arange(len(points)), np.argmin(outside, axis=1)
    return near[best], place[best], outside[best]
