r"""Modes of one bearing set in the reduced basis, with a bound on their error.

The supported body is ``B = A + G' Kb G`` with ``A = K + sigma M``, and its modes are those of
``B^-1 M`` with ``theta = 1 / (lambda + sigma)``. The Ritz values theta~ in the span of V
(:mod:`solidgear.core.reduction.moments`) are too small.  By how much at most follows from what V holds:

- V contains ``A^-1 G'`` of every occupied seat.  A field v with ``V' B v = 0`` therefore has ``(I
  + G A^-1 G' Kb) G v = 0``, so ``G v = 0``: its seats stand still.
- V contains the free modes U up to a cut.  With the above, ``0 = U' B v = U' A v``, so v lies in
  the complement of U and ``v' M v <= theta_c v' B v``, theta_c being the first theta left out of U.
- In a B-orthonormal basis of V (turned to its Ritz vectors) and of the rest, ``B^-1 M = [[T, E'],
  [E, C]]`` with ``T = diag(theta~)`` and ``C <= theta_c``.  Eigenvalues above theta_c are those of
  ``T + E' (theta - C)^-1 E``, counted alike (Schur complement), and this is at most ``T + E'E / (t
  - theta_c)`` for theta_c < t <= theta.

So the k-th true theta lies between theta~_k and the k-th eigenvalue of ``T + E'E / (t - theta_c)``,
t being the least theta~ wanted: an error of second order, without any assumption on gaps, for
single and repeated frequencies, and no mode can be missed.  ``E'E`` is cheap: in an A-orthonormal
basis of V with P = ``V'MV``, g = ``V'G'L``, ``L L' = Kb`` and the root ``R = (I + g g')^(-1/2)``,
the Ritz matrix is ``R P R`` and

    E'E = R (V' M A^-1 M V - P P) R,

where the bracket has nothing to do with the bearings and is zero on U.  (``B^-1`` by Woodbury;
``L'G A^-1 G'L = g'g`` because V holds ``A^-1 G'``.) Masses m on ports change little of it: with
``M' = M + G'm G`` and ``B = A + G'(Kb + sigma m) G`` the complement, whose seats and masses stand
still, is the same, and so are C and E; in V the mass is ``P + h h'`` with ``h = V'G'N``, ``N N' =
m``. The bound is one in exact arithmetic; rounding adds about 1e-16 times the ratio of the largest
to the wanted theta.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg as sla

from solidgear.core import Supports
from solidgear.core.body import component_rows
from solidgear.core.body.mode_names import numbered
from solidgear.core.reduction.moments import Reduced, ReducedBlock, residual_basis
from solidgear.core.solve.coupling import decoupled, groups
from solidgear.core.solve.naming import ALIKE, quarter_turn_change
from solidgear.core.springs import root_of

#: as in `solidgear.core.solve.modes.modes`: relative change of an eigenvalue below which couplings
#: between blocks are left out
COUPLING = 1e-6


@dataclass(frozen=True)
class RitzModes:
    """Lowest elastic modes of a variant."""

    frequency_hz: np.ndarray  #: (n,) ascending, twins twice
    names: tuple[str, ...]  #: such as ``bending 1``; twins share a name
    #: largest relative error of these frequencies against the body itself; infinite where nothing
    #: can be promised
    error_bound: float


class Seats:
    """Bearing-independent part of the small problems on seats that are occupied, by port indices."""

    def __init__(self, reduced: Reduced, ports: tuple[int, ...]):
        self._blocks = [_Occupied(block, ports) for block in reduced.blocks]
        self._groups: dict[tuple[int, ...], _Together] = {}

    def group(self, blocks: tuple[int, ...]) -> _Together:
        """Return blocks that bearings couple."""
        if blocks not in self._groups:
            self._groups[blocks] = _Together([self._blocks[b] for b in blocks])
        return self._groups[blocks]


class _Occupied:
    """One block with some of its seats occupied, in an A-orthonormal basis ``[U, W]``."""

    def __init__(self, block: ReducedBlock, ports: tuple[int, ...]):
        c, steps, mu = len(block.components), block.steps, block.moments
        rows = np.array([c * p + k for p in ports for k in range(c)], int)
        mu = mu[:, rows[:, None], rows]

        if steps and len(rows):
            z, mass, beyond = residual_basis(mu)
            motions = np.hstack(list(mu[:steps])) @ z
        else:
            mass = beyond = np.zeros((0, 0))
            motions = np.zeros((len(rows), 0))
        u, w = len(block.theta), len(mass)
        self.block = block
        self.motions = np.hstack([block.motions[rows], motions])
        self.mass = sla.block_diag(np.diag(block.theta), mass)
        self.defect = sla.block_diag(np.zeros((u, u)), beyond - mass @ mass)
        self.families = (*block.families[:-1], *[block.families[-1]] * w)


class _Together:
    """Several such blocks side by side."""

    def __init__(self, parts: list[_Occupied]):
        self.components = [list(p.block.components) for p in parts]
        self.turns = [p.block.turn for p in parts]
        self.cut = max(p.block.cut for p in parts)
        self.motions = sla.block_diag(*(p.motions for p in parts))
        self.mass = sla.block_diag(*(p.mass for p in parts))
        self.defect = sla.block_diag(*(p.defect for p in parts))
        starts = np.cumsum([0] + [len(p.mass) for p in parts])
        self.rigid = np.concatenate(
            [s + np.arange(len(c)) for s, c in zip(starts, self.components)]
        ).astype(int)
        names = np.array([name for p in parts for name in p.families])
        self.families = {str(name): names == name for name in dict.fromkeys(names) if name}

    def resisted(self, null: np.ndarray, heavy: np.ndarray) -> np.ndarray | None:
        """Return an orthonormal basis without the rigid motions ``null`` (6, k) that no spring resists,
        orthogonal to them with the masses on ports, ``shift m = heavy heavy'``; None if there are
        none.
        """
        free = np.vstack([turn @ null[c] for turn, c in zip(self.turns, self.components)])
        norm = np.linalg.norm(free, axis=0)
        free = free[:, norm > 0] / norm[norm > 0]
        if not free.shape[1]:
            return None
        q, s, _ = np.linalg.svd(free)
        if heavy.shape[1]:
            motions = np.zeros((len(self.mass), int((s > 1e-6).sum())))
            motions[self.rigid] = q[:, : motions.shape[1]]
            return sla.null_space((motions + heavy @ (heavy.T @ motions)).T)
        basis = np.eye(len(self.mass))
        basis[np.ix_(self.rigid, self.rigid)] = q
        return np.delete(basis, self.rigid[: int((s > 1e-6).sum())], axis=1)


@dataclass(frozen=True)
class _Group:
    """Ritz solution of the blocks that the bearings couple."""

    value: np.ndarray
    theta: np.ndarray
    excess: np.ndarray
    cut: float
    share: dict[str, np.ndarray]


def ritz_modes(
    reduced: Reduced, seats: Seats, supports: Supports, n: int, slack: float
) -> RitzModes:
    """Solve for the lowest ``n`` elastic modes on bearings, with the seats of their ports in order.

    A mode that may lie among the first ``n`` by less than ``slack``, relative, is no reason to
    distrust the count.
    """
    frame = reduced.frame
    spring, _ = decoupled(frame, supports, COUPLING)
    null = supports.unresisted(frame)
    solved: dict[tuple[int, ...], _Group] = {}
    for group in groups(frame, supports, spring):
        twin = _twin(reduced, supports, spring, group)
        solved[tuple(group)] = (
            solved[twin]
            if twin in solved
            else _solve(reduced, seats, supports, spring, group, null)
        )
    # a block without port motions is an ovalising one, of a cosine and a sine form
    parts = [
        part
        for group, part in solved.items()
        for _ in range(1 if reduced.blocks[group[0]].components else 2)
    ]
    which = np.concatenate([np.full(len(p.value), k) for k, p in enumerate(parts)])
    place = np.concatenate([np.arange(len(p.value)) for p in parts])
    value = np.concatenate([p.value for p in parts])
    order = np.argsort(value, kind="stable")[:n]
    value = value[order]
    bound = np.inf if len(value) < n else 0.0
    for k, part in enumerate(parts):
        bound = max(
            bound, _bound(part, int((which[order] == k).sum()), value[-1], reduced.shift, slack)
        )
    family = [
        max(parts[k].share, key=lambda name: parts[k].share[name][j])
        for k, j in zip(which[order], place[order])
    ]
    return RitzModes(
        np.sqrt(value) / (2 * np.pi),
        _names(family, _paired(reduced, supports)),
        float(bound),
    )


def _twin(reduced, supports, spring, group):
    """Return the group that a lone block repeats in the other plane, if springs are mirrored too."""
    mirror = reduced.blocks[group[0]].mirror
    if len(group) != 1 or mirror is None:
        return None
    m = len(supports.ports)
    rows, mirrored = (
        component_rows(range(m), reduced.blocks[k].components) for k in (group[0], mirror[0])
    )
    sign = np.tile(mirror[1], m)
    for matrix in (spring, supports.masses):
        a = matrix[np.ix_(rows, rows)]
        b = matrix[np.ix_(mirrored, mirrored)] * np.outer(sign, sign)
        if np.abs(a - b).max(initial=0.0) > 1e-14 * np.abs(b).max(initial=0.0):
            return None
    return (mirror[0],)


def _solve(reduced: Reduced, seats: Seats, supports: Supports, spring, group, null) -> _Group:
    blocks = seats.group(tuple(group))
    rows = np.concatenate(
        [component_rows(range(len(supports.ports)), c) for c in blocks.components]
    )
    stiff, heavy = (
        blocks.motions.T @ root_of(matrix[np.ix_(rows, rows)])
        for matrix in (spring, supports.masses)
    )
    mass, defect = blocks.mass, blocks.defect
    basis = blocks.resisted(null, np.sqrt(reduced.shift) * heavy)
    if basis is not None:
        stiff, heavy = basis.T @ stiff, basis.T @ heavy
        mass, defect = basis.T @ mass @ basis, basis.T @ defect @ basis
    total = mass + heavy @ heavy.T if heavy.shape[1] else mass
    both = np.hstack([stiff, np.sqrt(reduced.shift) * heavy]) if heavy.shape[1] else stiff
    u, s, _ = np.linalg.svd(both, full_matrices=False)
    half = np.eye(len(mass)) + u @ ((1 / np.sqrt(1 + s * s) - 1)[:, None] * u.T)
    small = half @ total @ half
    theta, vector = np.linalg.eigh((small + small.T) / 2)
    theta, vector = theta[::-1], vector[:, ::-1]
    good = theta > 0
    theta, shape = theta[good], half @ vector[:, good]
    value = 1 / theta - reduced.shift
    # an eigenvalue below a thousandth of the shift loses more digits than in a direct Ritz step
    soft = value < 1e-3 * reduced.shift
    if soft.any():
        value[soft] = _soft(shape[:, soft], mass, stiff, heavy, reduced.shift)
    full = shape if basis is None else basis @ shape
    weight = full * (blocks.mass @ full)
    share = {name: weight[members].sum(axis=0) for name, members in blocks.families.items()}
    return _Group(value, theta, shape.T @ defect @ shape, blocks.cut, share)


def _soft(shape, mass, stiff, heavy, shift) -> np.ndarray:
    """Compute Ritz values of nearly rigid modes, with the rigid part split off exactly (as in
    :mod:`solidgear.core.solve.modes`).
    """
    # rigid shapes alone have sigma times their mass as energy in A
    rigid = np.abs(np.diag(mass) * shift - 1) < 1e-9
    r = int(rigid.sum())
    elastic = np.where(
        rigid[:, None], 0.0, shape / np.sqrt(np.einsum("ij,ij->j", shape, mass @ shape))
    )
    w, v = np.linalg.eigh(elastic.T @ mass @ elastic)
    keep = w > 1e-18
    elastic = elastic @ (v[:, keep] / np.sqrt(w[keep]))
    small = np.zeros((r + elastic.shape[1],) * 2)
    small[r:, r:] = elastic.T @ elastic - shift * elastic.T @ mass @ elastic
    basis = np.hstack([np.eye(len(mass))[:, rigid] * np.sqrt(shift), elastic])
    reach, moved = stiff.T @ basis, heavy.T @ basis
    total = np.eye(len(small)) + moved.T @ moved if heavy.shape[1] else None
    return sla.eigh(small + reach.T @ reach, total, eigvals_only=True)[: shape.shape[1]]


def _bound(part: _Group, count: int, last: float, shift: float, slack: float) -> float:
    """Bound the largest relative frequency error of the first ``count`` modes of a group; ``last`` is
    the last eigenvalue of all groups.
    """
    t = 1 / (last + shift)
    if t <= part.cut:
        return np.inf
    upper = np.linalg.eigvalsh(np.diag(part.theta) + part.excess / (t - part.cut))[::-1]
    if len(upper) > count and upper[count] > t * (1 + 2 * slack):
        return np.inf  # a further mode may hide below the last one
    lower = 1 / upper[:count] - shift
    if np.any(lower <= 0):
        return np.inf
    value = 1 / part.theta[:count] - shift
    return float(np.max(np.sqrt(value / lower) - 1, initial=0.0))


def _paired(reduced: Reduced, supports: Supports) -> Callable[[str], bool]:
    """Return a function that is true for a family to which symmetry promises twins, as in
    :meth:`solidgear.core.solve.naming.Names.pairs`.
    """
    whole, bends = len(reduced.blocks) == 1, quarter_turn_change(supports) <= ALIKE

    def promised(family: str) -> bool:
        return reduced.round and (
            bends if family == "bending" else whole and family.startswith("ovalising")
        )

    return promised


def _names(family: Sequence[str], promised: Callable[[str], bool]) -> tuple[str, ...]:
    """Return names as of :mod:`solidgear.core.solve.naming` by the families of modes in ascending order; two
    twins share that of the first.
    """
    firsts: list[int] = []
    waiting: dict[str, int] = {}
    for k, name in enumerate(family):
        firsts.append(waiting.pop(name, k))
        if firsts[-1] == k and promised(name):
            waiting[name] = k
    distinct = list(dict.fromkeys(firsts))
    names = dict(zip(distinct, numbered(family[k] for k in distinct)))
    return tuple(names[k] for k in firsts)
