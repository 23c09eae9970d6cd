"""Section motions of a harmonic solid, by quadrature on the cells: they may be far longer than the
distance of two stations.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from solidgear.core.body.sections import Sections, hats
from solidgear.core.kernel.assembly import batches
from solidgear.core.kernel.cell_shapes import Shapes
from solidgear.core.kernel.lobatto import gauss
from solidgear.core.models.harmonic.families import TORSION


@dataclass(frozen=True)
class Part:
    """Part of a displacement that a component of section motion moves: ``u = sign r^power`` in one
    unknown, under the mass ``factor rho r^weight``.
    """

    unknown: int
    factor: float
    weight: int
    sign: float = 1.0
    power: int = 0


#: by waves around, in unknowns (u_r, u_y) axially, u_t / r in torsion, (p, q, w) in bending with
#: translation and tilt
PARTS = {
    0: (Part(1, 2 * np.pi, 1),),
    TORSION: (Part(0, 2 * np.pi, 3),),
    1: (Part(0, 2 * np.pi, 1), Part(2, np.pi, 1, -1.0, 1)),
}


def from_cells(
    shapes: Shapes,
    dofs: np.ndarray,
    order: int,
    density: np.ndarray,
    parts: tuple[Part, ...],
    unknowns: int,
) -> Sections:
    """Return the sections of a block on meridian cells, by their degrees of freedom (nb, ne) and
    densities (ne,), kg/m3: one part a component, with so many unknowns at each scalar degree of
    freedom, numbered together.
    """
    n = int(dofs.max()) + 1
    x, w = gauss(order + 2)
    flat = shapes.flat
    reach = np.ptp(flat.points[1][flat.cells], axis=0)

    def sections(stations):
        loads = np.zeros((n, unknowns, len(stations), len(parts)))
        gram = np.zeros((len(stations), len(parts), len(stations), len(parts)))
        # a cell is cut along the axis until no piece is longer than from station to station
        pieces = np.ceil(reach / np.diff(stations).min() - 1e-9).astype(int).clip(1)
        for count in np.unique(pieces):
            along = ((np.arange(count)[:, None] + x) / count).ravel()
            a, b = np.meshgrid(x, along, indexing="ij")
            weight = np.outer(w, np.tile(w / count, count)).ravel()
            points = np.array([a.ravel(), b.ravel()])
            for cells, t in _tabulated(shapes, pieces == count, points):
                r, dm = t.x[0].ravel(), (t.det * weight * density[cells, None]).ravel()
                hat = hats(np.clip(t.x[1].ravel(), stations[0], stations[-1]), stations)
                value = _at_points(t.value, dofs[:, cells], n)
                for k, part in enumerate(parts):
                    mass = part.factor * dm * r**part.weight
                    field = part.sign * r**part.power
                    loads[:, part.unknown, :, k] += (
                        value.T @ hat.multiply((mass * field)[:, None])
                    ).toarray()
                    gram[:, k, :, k] += (hat.T @ hat.multiply((mass * field**2)[:, None])).toarray()
        size = len(stations) * len(parts)
        return loads.reshape(n * unknowns, size), gram.reshape(size, size)

    return sections


def _tabulated(shapes: Shapes, wanted: np.ndarray, points: np.ndarray):
    """Yield (cells, tabulated basis) for the cells of a mask, a batch of one shape at a time."""
    for kind in shapes.kinds:
        basis = shapes.tabulation(kind, points)
        for cells in batches(kind.cells[wanted[kind.cells]], 8 * 12 * points.shape[1]):
            yield cells, basis.on(shapes.nodes(kind, cells))


def _at_points(value: np.ndarray, dofs: np.ndarray, n: int) -> sp.csr_matrix:
    """Return the values (cells * points, n) of the basis at the points of every cell."""
    nb, nq = value.shape
    cells = dofs.shape[1]
    data = np.broadcast_to(value.T, (cells, nq, nb)).ravel()
    columns = np.broadcast_to(dofs.T[:, None], (cells, nq, nb)).ravel()
    return sp.csr_matrix(
        (data, columns, np.arange(0, cells * nq * nb + 1, nb)), shape=(cells * nq, n)
    )
