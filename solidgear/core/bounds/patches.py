"""Local problems of a harmonic solid: the cells of :mod:`solidgear.core.kernel.local_problems` on a
meridian.

Functions inside a piece (:mod:`solidgear.core.bounds.loads`) are eliminated at once, those
inside a cell of the mesh once its pieces are put together.
"""

from __future__ import annotations

import numpy as np

from solidgear.core.body import Block
from solidgear.core.bounds.loads import Batch, LoadedPieces, Loading
from solidgear.core.bounds.richer_space import RicherSpace
from solidgear.core.kernel.local_problems import Cell, condensed, energies, merged


def local_energies(
    space: RicherSpace, block: Block, loading: Loading
) -> tuple[np.ndarray, np.ndarray]:
    """Compute (ne, k, k) products of energy of the local solutions, cell by cell of the mesh, by
    the richer space and by one of an order less.

    Their sum bounds the errors of the displacements, with what cuts towards corners leave unseen.
    """
    loaded = _Loaded(space, block, loading)
    unseen = space.unseen()[:, None, None]
    two_more, one_more = (unseen * energies(cells, loaded.rigid) for cells in loaded.cells())
    return two_more, one_more


class _Loaded:
    """Cells of one block under some displacements."""

    def __init__(self, space: RicherSpace, block: Block, loading: Loading):
        self.space, self.loading = space, loading
        self.pieces = LoadedPieces(space, block, loading)
        self.family = family = self.pieces.family
        self.motions = len(block.components)
        start = space.count * family.count
        # number of the first motion of each port that is a rigid seat
        self.first = {i: start + self.motions * m for m, i in enumerate(space.tied)}
        count = family.rigid(np.zeros(1), np.zeros(1)).shape[-1]
        self.rigid = np.zeros((start + self.motions * len(space.tied), count))

    def cells(self) -> tuple[list[Cell], list[Cell]]:
        """Return all cells of the mesh, condensed to the unknowns that they share: of the richer
        space, and of the one of an order less.
        """
        space = self.space
        pieces: dict[int, Cell] = {}
        lower: dict[int, Cell] = {}
        for batch in self.pieces.batches():
            self._eliminate(batch, pieces, lower)
        for i, first in self.first.items():
            y = space.ports[i].y
            motions = [[1.0, y], [0.0, 1.0]] if self.family.waves == 1 else [[1.0]]
            self.rigid[first : first + self.motions] = np.array(motions)[: self.motions]
        return self._cells_of_mesh(pieces), self._cells_of_mesh(lower)

    def _eliminate(self, batch: Batch, pieces: dict[int, Cell], lower: dict[int, Cell]) -> None:
        """Add the cells of some pieces without the functions inside them.

        Those of an order less come first, and the rest of the others is the richer space still.
        """
        c, (inside, few, outside) = self.family.count, self.pieces.ends
        k = batch.loads.shape[-1]
        nothing = np.zeros((len(batch.part), k, k))
        reduced = _eliminated(batch.stiffness, batch.loads, nothing, inside * c, front=True)
        self._add(batch, few, reduced, lower)
        # the functions of the top order inside stand last
        stiffness, loads, const = reduced
        top = stiffness.shape[1] - outside * c
        self._add(batch, outside, _eliminated(stiffness, loads, const, top), pieces)

    def _add(self, batch: Batch, count: int, reduced: tuple, cells: dict[int, Cell]) -> None:
        """Add to `cells` those of pieces from the first of their functions on corners and sides."""
        space, c = self.space, self.family.count
        part, (stiffness, loads, const) = batch.part, reduced
        functions, n = self.pieces.outside[:count], count * c
        signs = np.repeat(space.signs[part][:, functions], c, axis=1)
        stiffness = stiffness[:, :n, :n] * (signs[:, :, None] * signs[:, None])
        loads = loads[:, :, :n] * signs[:, None, :, None]
        scalar = space.ids[part][:, functions]
        ids = (scalar[..., None] * c + np.arange(c)).reshape(len(part), -1)
        first = self.pieces.ends[0] * c
        rigid = batch.rigid[:, first : first + n] * signs[:, :, None]
        self.rigid[ids] = rigid
        constrained = space.on_axis[scalar].any(axis=1)
        for on_seat in space.tied.values():
            constrained |= on_seat[scalar].any(axis=1)
        at_corners = space.corner_hat[space.flat.cells[:, space.pieces.parent[part]]].T
        for j, piece in enumerate(part):
            cell = Cell(at_corners[j], ids[j], stiffness[j], loads[j], const[j])
            cells[int(piece)] = self._constrained(cell, rigid[j]) if constrained[j] else cell

    def _constrained(self, cell: Cell, rigid: np.ndarray) -> Cell:
        """Return a cell without the motions that the axis holds, and with rigid seats moving as
        their ports.
        """
        space, c = self.space, self.family.count
        scalar, component = cell.unknowns // c, cell.unknowns % c
        keep = ~(space.on_axis[scalar] & np.isin(component, self.family.zero_on_axis))
        tied = {i: on_seat[scalar] for i, on_seat in space.tied.items() if on_seat[scalar].any()}
        for on_seat in tied.values():
            keep = keep & ~on_seat
        ids, columns = [cell.unknowns[keep]], [np.eye(len(keep))[:, keep]]
        for i, on_seat in tied.items():
            if not self.motions:
                continue  # waves that no motion of a port goes with
            about = rigid.copy()
            if self.family.waves == 1:
                about[:, 1] -= space.ports[i].y * about[:, 0]
            about[~on_seat] = 0.0
            columns.append(about)
            ids.append(self.first[i] + np.arange(self.motions))
        expand = np.hstack(columns)
        return Cell(
            cell.hats,
            np.concatenate(ids),
            expand.T @ cell.stiffness @ expand,
            expand.T @ cell.loads,
            cell.inside,
        )

    def _cells_of_mesh(self, pieces_by_number: dict[int, Cell]) -> list[Cell]:
        """Return the cells of the mesh from their pieces, with the forces on rigid seats."""
        space = self.space
        pieces: list[list[int]] = [[] for _ in range(space.flat.cells.shape[1])]
        for piece, parent in enumerate(space.pieces.parent):
            pieces[parent].append(piece)
        numbered = np.empty(len(self.rigid), int)
        cells = [_joined([pieces_by_number[p] for p in numbers], numbered) for numbers in pieces]
        owners = np.zeros(len(self.rigid), int)
        for cell in cells:
            owners[cell.unknowns] += 1
        for i, first in self.first.items():
            if not self.motions:
                continue
            at_seat = space.pieces.parent[space.carrying[i][0][0]]
            seat = int(space.corner_hat[space.flat.cells[1, at_seat]])
            cell = next(c for c in cells if seat in c.hats and first in c.unknowns)
            places = [list(cell.unknowns).index(first + m) for m in range(self.motions)]
            forces = self.loading.forces[i * self.motions : (i + 1) * self.motions]
            cell.loads[list(cell.hats).index(seat), places] += forces
            owners[first : first + self.motions] = 2  # loaded from outside: never condensed
        return [condensed(cell, owners[cell.unknowns] == 1) for cell in cells]


def _eliminated(
    stiffness: np.ndarray, loads: np.ndarray, const: np.ndarray, count: int, front: bool = False
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return stiffness, loads by hat and energies of pieces without their first or last
    functions.
    """
    n = stiffness.shape[1]
    inner, outer = (
        (slice(count), slice(count, n)) if front else (slice(n - count, n), slice(n - count))
    )
    far, load = stiffness[:, inner, outer], loads[:, :, inner].sum(axis=1)
    solved = np.linalg.solve(stiffness[:, inner, inner], np.concatenate([far, load], axis=2))
    follow, alone = solved[:, :, : far.shape[2]], solved[:, :, far.shape[2] :]
    back = follow.transpose(0, 2, 1)
    return (
        stiffness[:, outer, outer] - back @ far,
        loads[:, :, outer] - back[:, None] @ loads[:, :, inner],
        const + load.transpose(0, 2, 1) @ alone,
    )


def _joined(pieces: list[Cell], numbered: np.ndarray) -> Cell:
    """Join pieces to one cell; hats at corners that belong to one seat are added up."""
    first = pieces[0]
    hats = list(dict.fromkeys(int(h) for h in first.hats))
    if len(pieces) == 1 and len(hats) == len(first.hats):
        return first
    add = np.array([[float(h == hat) for h in first.hats] for hat in hats])
    ids, places = merged([p.unknowns for p in pieces], numbered)
    n, k = len(ids), first.loads.shape[2]
    stiffness, loads = np.zeros((n, n)), np.zeros((len(first.hats), n, k))
    for piece, ids_of_piece in zip(pieces, places):
        stiffness[ids_of_piece[:, None], ids_of_piece] += piece.stiffness
        loads[:, ids_of_piece] += piece.loads
    inside = np.sum([piece.inside for piece in pieces], axis=0)
    return Cell(hats, ids, stiffness, np.tensordot(add, loads, axes=1), inside)
