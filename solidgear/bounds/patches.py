"""Local problems of a harmonic solid: the cells of :mod:`solidgear.kernel.local_problems` on a meridian.

Functions inside a piece (:mod:`solidgear.bounds.loads`) are eliminated at once, those
inside a cell of the mesh once its pieces are put together.
"""

from __future__ import annotations

import numpy as np

from solidgear.body import Block
from solidgear.bounds.loads import Batch, LoadedPieces, Loading
from solidgear.bounds.richer_space import RicherSpace
from solidgear.kernel.local_problems import Cell, condensed, energies, merged


def local_energies(
    space: RicherSpace, block: Block, loading: Loading
) -> tuple[np.ndarray, np.ndarray]:
    """(ne, k, k) products of energy of the local solutions, cell by cell of the mesh.

    Their sum bounds the errors of the displacements, as far as the richer space sees them, and as far as
    one of an order less does.
    """
    work = _Loaded(space, block, loading)
    whole, lower = work.cells()
    return energies(whole, work.rigid), energies(lower, work.rigid)


class _Loaded:
    """Cells of one block under some displacements."""

    def __init__(self, space: RicherSpace, block: Block, loading: Loading):
        self.space, self.loading = space, loading
        self.pieces = LoadedPieces(space, block, loading)
        self.family = family = self.pieces.family
        self.motions = len(block.components)
        start = space.count * family.count
        self.first = {i: start + self.motions * m for m, i in enumerate(space.tied)}
        count = family.rigid(np.zeros(1), np.zeros(1)).shape[-1]
        self.rigid = np.zeros((start + self.motions * len(space.tied), count))

    def cells(self) -> tuple[list[Cell], list[Cell]]:
        """All cells of the mesh, condensed to what they share: of the richer space, and of the one of
        an order less.
        """
        space = self.space
        made: tuple[dict[int, Cell], dict[int, Cell]] = ({}, {})
        for batch in self.pieces.batches():
            self._eliminate(batch, *made)
        for i, first in self.first.items():
            y = space.body.ports[i].y
            own = [[1.0, y], [0.0, 1.0]] if self.family.waves == 1 else [[1.0]]
            self.rigid[first : first + self.motions] = np.array(own)[: self.motions]
        return self._whole(made[0]), self._whole(made[1])

    def _eliminate(self, batch: Batch, whole: dict[int, Cell], lower: dict[int, Cell]) -> None:
        """Cells of some pieces without the functions inside them.

        Those of an order less come first, and what is left of the others is the richer space still.
        """
        c, (inside, few, outside) = self.family.count, self.pieces.ends
        k = batch.loads.shape[-1]
        nothing = np.zeros((len(batch.part), k, k))
        held = _without(batch.stiffness, batch.loads, nothing, inside * c, front=True)
        self._add(batch, few, held, lower)
        # the functions of the top order inside stand last
        self._add(batch, outside, _without(*held, held[0].shape[1] - outside * c), whole)

    def _add(self, batch: Batch, count: int, held: tuple, into: dict[int, Cell]) -> None:
        """Cells of pieces from the first of their functions on corners and sides."""
        space, c = self.space, self.family.count
        part, (stiffness, loads, const) = batch.part, held
        own, n = self.pieces.outside[:count], count * c
        signs = np.repeat(space.signs[part][:, own], c, axis=1)
        stiffness = stiffness[:, :n, :n] * (signs[:, :, None] * signs[:, None])
        loads = loads[:, :, :n] * signs[:, None, :, None]
        scalar = space.ids[part][:, own]
        ids = (scalar[..., None] * c + np.arange(c)).reshape(len(part), -1)
        first = self.pieces.ends[0] * c
        rigid = batch.rigid[:, first : first + n] * signs[:, :, None]
        self.rigid[ids] = rigid
        apart = space.on_axis[scalar].any(axis=1)
        for on in space.tied.values():
            apart |= on[scalar].any(axis=1)
        at_corners = space.corner_hat[space.flat.cells[:, space.pieces.parent[part]]].T
        for j, piece in enumerate(part):
            cell = Cell(at_corners[j], ids[j], stiffness[j], loads[j], const[j])
            into[int(piece)] = self._constrained(cell, rigid[j]) if apart[j] else cell

    def _constrained(self, cell: Cell, rigid: np.ndarray) -> Cell:
        """A cell without what the axis holds, and with rigid seats moving as their ports."""
        space, c = self.space, self.family.count
        scalar, component = cell.unknowns // c, cell.unknowns % c
        keep = ~(space.on_axis[scalar] & np.isin(component, self.family.held))
        tied = {i: on[scalar] for i, on in space.tied.items() if on[scalar].any()}
        for on in tied.values():
            keep = keep & ~on
        ids, columns = [cell.unknowns[keep]], [np.eye(len(keep))[:, keep]]
        for i, on in tied.items():
            if not self.motions:
                continue  # waves that no motion of a port goes with
            about = rigid.copy()
            if self.family.waves == 1:
                about[:, 1] -= space.body.ports[i].y * about[:, 0]
            about[~on] = 0.0
            columns.append(about)
            ids.append(self.first[i] + np.arange(self.motions))
        to = np.hstack(columns)
        return Cell(
            cell.hats,
            np.concatenate(ids),
            to.T @ cell.stiffness @ to,
            to.T @ cell.loads,
            cell.inside,
        )

    def _whole(self, made: dict[int, Cell]) -> list[Cell]:
        """Cells of the mesh from their pieces, with the forces on rigid seats."""
        space = self.space
        pieces: list[list[int]] = [[] for _ in range(space.flat.cells.shape[1])]
        for piece, parent in enumerate(space.pieces.parent):
            pieces[parent].append(piece)
        numbered = np.empty(len(self.rigid), int)
        whole = [_together([made[p] for p in own], numbered) for own in pieces]
        owners = np.zeros(len(self.rigid), int)
        for cell in whole:
            owners[cell.unknowns] += 1
        for i, first in self.first.items():
            if not self.motions:
                continue
            at_seat = space.pieces.parent[space.carrying[i][0][0]]
            seat = int(space.corner_hat[space.flat.cells[1, at_seat]])
            cell = next(c for c in whole if seat in c.hats and first in c.unknowns)
            places = [list(cell.unknowns).index(first + m) for m in range(self.motions)]
            own = self.loading.forces[i * self.motions : (i + 1) * self.motions]
            cell.loads[list(cell.hats).index(seat), places] += own
            owners[first : first + self.motions] = 2  # loaded from outside: never condensed
        return [condensed(cell, owners[cell.unknowns] == 1) for cell in whole]


def _without(
    stiffness: np.ndarray, loads: np.ndarray, const: np.ndarray, count: int, front: bool = False
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Stiffness, loads by hat and energies of pieces without their first or last functions."""
    n = stiffness.shape[1]
    gone, left = (
        (slice(count), slice(count, n)) if front else (slice(n - count, n), slice(n - count))
    )
    far, load = stiffness[:, gone, left], loads[:, :, gone].sum(axis=1)
    solved = np.linalg.solve(stiffness[:, gone, gone], np.concatenate([far, load], axis=2))
    follow, alone = solved[:, :, : far.shape[2]], solved[:, :, far.shape[2] :]
    back = follow.transpose(0, 2, 1)
    return (
        stiffness[:, left, left] - back @ far,
        loads[:, :, left] - back[:, None] @ loads[:, :, gone],
        const + load.transpose(0, 2, 1) @ alone,
    )


def _together(pieces: list[Cell], numbered: np.ndarray) -> Cell:
    """One cell from its pieces; hats at corners that belong to one seat are added up."""
    first = pieces[0]
    own = list(dict.fromkeys(int(h) for h in first.hats))
    if len(pieces) == 1 and len(own) == len(first.hats):
        return first
    add = np.array([[float(h == one) for h in first.hats] for one in own])
    ids, places = merged([p.unknowns for p in pieces], numbered)
    n, k = len(ids), first.loads.shape[2]
    stiffness, loads = np.zeros((n, n)), np.zeros((len(first.hats), n, k))
    for piece, at in zip(pieces, places):
        stiffness[at[:, None], at] += piece.stiffness
        loads[:, at] += piece.loads
    inside = np.sum([piece.inside for piece in pieces], axis=0)
    return Cell(own, ids, stiffness, np.tensordot(add, loads, axes=1), inside)
