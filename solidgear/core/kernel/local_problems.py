r"""Distance of a discrete solution from one in a richer space, patch by patch.

The residual of a discrete displacement u,

    R(v) = f(v) - a(u, v),

is weighted by the hats of the mesh, which sum up to one. For every hat the problem

    a_patch(e_i, v) = R(phi_i v)     for all v of the richer space on the cells of the hat

is solved, free on the border of the patch. The sum e* of all e_i, cell by cell (it jumps between
cells), stores more energy than the error e of u in the richer space does (Pares, Diez and Huerta
2006, Comput. Methods Appl. Mech. Engrg. 195, 297):

    a(e, e) = R(e) = sum R(phi_i e) = sum a_patch(e_i, e) = a(e*, e) <= |e*| |e|

With several displacements at once the products ``M_jk = a(e*_j, e*_k)`` bound their errors as
quadratic forms. A patch that can move as a rigid body is balanced, since u solves its problem for
all functions ``phi_i r`` with r rigid.

Nothing here knows what cells are: a cell has a dense stiffness on the unknowns of the richer space,
loads by hat, and the rigid motions of its unknowns.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import lapack

#: added to patch matrices whose diagonal is one: functions of slender cells are nearly dependent
REGULAR = 1e-12

#: least diagonal entry of a patch, in its largest, that is not rounding
ROUNDED = 1e-13


@dataclass
class Cell:
    """A cell, condensed to the unknowns that it shares with others."""

    hats: Sequence[int]  #: that are not zero on it
    unknowns: np.ndarray  #: (n,) numbers of its unknowns in the richer space
    stiffness: np.ndarray  #: (n, n)
    loads: np.ndarray  #: (h, n, k) ``R(phi_i v)`` by hat
    inside: np.ndarray  #: (k, k) products of energy of the condensed unknowns


def condensed(cell: Cell, inner: np.ndarray) -> Cell:
    """Return a cell without some unknowns, given by a mask, which no other cell has."""
    if not inner.any():
        return cell
    outer = ~inner
    rows = cell.stiffness[inner]
    inner_block, across, loads = rows[:, inner], rows[:, outer], cell.loads[:, inner]
    total = loads.sum(axis=0)
    solved = _solve(inner_block, np.hstack([across, total]))
    follow, alone = solved[:, : across.shape[1]], solved[:, across.shape[1] :]
    return Cell(
        cell.hats,
        cell.unknowns[outer],
        cell.stiffness[outer][:, outer] - across.T @ follow,
        cell.loads[:, outer] - follow.T @ loads,
        cell.inside + total.T @ alone,
    )


def energies(cells: Sequence[Cell], rigid: np.ndarray) -> np.ndarray:
    """Compute products of energy (m, k, k) of the sum of all local solutions, cell by cell, whose
    sum bounds the errors; `rigid` (n, r) are rigid motions in the unknowns of the richer space.

    Examples
    --------
    Two springs of 2 N/m in a row whose outer ends are held, as two cells under one hat; u is zero,
    and a force of 1 N pulls at the middle:

    >>> half = np.array([[[0.5]]])
    >>> cells = [Cell([7], np.array([0]), 2 * np.eye(1), half, np.zeros((1, 1))) for _ in range(2)]
    >>> np.round(energies(cells, np.zeros((1, 0))).ravel(), 6)  # in sum its motion, 1 / 4 m
    array([0.125, 0.125])
    """
    patches: dict[int, list[tuple[int, int]]] = {}
    for k, cell in enumerate(cells):
        for h, hat in enumerate(cell.hats):
            patches.setdefault(hat, []).append((k, h))
    solutions = [np.zeros(cell.loads.shape[1:]) for cell in cells]
    numbered = np.empty(len(rigid), int)
    for members in patches.values():
        for k, x in _solved(cells, members, rigid, numbered):
            solutions[k] += x
    return np.array([_energy(cell, x, rigid) for cell, x in zip(cells, solutions)])


def merged(
    unknowns: Sequence[np.ndarray], numbered: np.ndarray
) -> tuple[np.ndarray, list[np.ndarray]]:
    """Return the unknowns of several cells, each once, and the places of those of every cell among
    them; an array as long as there are unknowns in all is written over.

    Examples
    --------
    >>> ids, places = merged([np.array([7, 3]), np.array([3, 5])], np.empty(9, int))
    >>> [ids[place].tolist() for place in places]
    [[7, 3], [3, 5]]
    """
    repeated = np.concatenate(unknowns)
    order = np.arange(len(repeated))
    numbered[repeated] = order
    ids = repeated[numbered[repeated] == order]
    numbered[ids] = order[: len(ids)]
    return ids, [numbered[ids_of_cell] for ids_of_cell in unknowns]


def _solved(
    cells: Sequence[Cell], members: list[tuple[int, int]], rigid: np.ndarray, numbered: np.ndarray
):
    """Yield the displacements of the cells of one patch under the hat, each with the number of the
    cell.
    """
    ids, places = merged([cells[k].unknowns for k, _ in members], numbered)
    n, count = len(ids), cells[members[0][0]].loads.shape[2]
    stiffness, load = np.zeros((n, n)), np.zeros((n, count))
    for (k, h), place in zip(members, places):
        stiffness[place[:, None], place] += cells[k].stiffness
        load[place] += cells[k].loads[h]
    # an unknown that moves a whole patch as a rigid body has no stiffness but rounding, of either sign
    diagonal = stiffness.diagonal()
    root = 1 / np.sqrt(np.maximum(diagonal, ROUNDED * diagonal.max()))
    stiffness *= root[:, None]
    stiffness *= root
    load *= root[:, None]
    free = _orthonormal(rigid[ids] / root[:, None])
    load -= free @ (free.T @ load)
    _stiffen(stiffness, free)
    stiffness.flat[:: n + 1] += REGULAR
    x = _solve(stiffness, load) * root[:, None]
    for (k, _), place in zip(members, places):
        yield k, x[place]


def _stiffen(stiffness: np.ndarray, free: np.ndarray) -> None:
    """Give orthonormal motions that cost no energy a stiffness of one, and take out what rounding has
    left them: it may be negative, and as large as that after scaling.
    """
    rounding = stiffness @ free
    rest = rounding - free @ (free.T @ rounding + np.eye(free.shape[1])) / 2
    stiffness -= rest @ free.T
    stiffness -= free @ rest.T


def _solve(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Return the solution with a positive definite matrix, which is written over."""
    _, x, info = lapack.dposv(matrix.T, right, lower=True, overwrite_a=True)
    if info:
        raise np.linalg.LinAlgError("a local problem is not positive definite")
    return x


def _energy(cell: Cell, x: np.ndarray, rigid: np.ndarray) -> np.ndarray:
    """Return the energy of a cell without the rigid motion, which costs none but rounding."""
    free = _orthonormal(rigid[cell.unknowns])
    x = x - free @ (free.T @ x)
    return x.T @ cell.stiffness @ x + cell.inside


def _orthonormal(motions: np.ndarray) -> np.ndarray:
    """Return a basis of at most a few motions, those that vanish or repeat others left out."""
    out: list[np.ndarray] = []
    for motion in motions.T:
        size = np.sqrt(motion @ motion)
        if size == 0.0:
            continue
        residual = motion / size
        for _ in range(2):  # twice is enough (Kahan)
            for unit in out:
                residual = residual - unit * (unit @ residual)
        norm = np.sqrt(residual @ residual)
        if norm > 1e-9:
            out.append(residual / norm)
    return np.array(out).T if out else motions[:, :0]
