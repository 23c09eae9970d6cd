"""Lower ends of eigenvalues, of modes alone and of near ones as one.

A Rayleigh quotient lies above its eigenvalue by at most ``M / (1 - lambda / lambda_next)`` with the
energy M of the error of a mode of unit mass (Kato 1949, J. Phys. Soc. Japan 4, 334; Temple 1928,
Proc. R. Soc. A 119, 276).  Of near modes the gap between them says nothing, for their shapes may
turn among each other: these are bounded as one.  With Rayleigh quotients Lambda, products of energy
M of all errors, and a number rho that is no more than the first exact eigenvalue beyond,

    (Lambda - rho) x = tau (Lambda - 2 rho + rho^2 Lambda^-1 (Lambda + M) Lambda^-1) x

has negative eigenvalues only, and the lower ends are ``rho tau / (tau - 1)`` (Lehmann 1949, Z.
angew. Math. Mech. 29, 341; Goerisch 1985).  For rho serves the lower end of a mode that lies beyond
the cluster; the modes between are bounded with it.  Nothing that was solved beyond, no lower end.

Of several modes the order may change: the lower end of the j-th is the j-th smallest of all.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.linalg as sla

#: gap between eigenvalues, relative to the upper one, below which they are bounded as one
BESIDE = 0.05
#: gap to what lies beyond that is looked for among all that was solved: a bar is no wider than
#: twice what the energy says
ROOM = 0.5


def clusters(values: Sequence[float] | np.ndarray) -> list[range]:
    """Return runs of near eigenvalues, which ascend.

    Examples
    --------
    >>> clusters([1.0, 1.01, 1.05, 2.0])
    [range(0, 3), range(3, 4)]
    """
    v = np.asarray(values, float)
    starts = [0, *(np.flatnonzero(1 - v[:-1] / v[1:] >= BESIDE) + 1)] if len(v) else []
    return [range(int(a), int(b)) for a, b in zip(starts, [*starts[1:], len(v)])]


def cluster_of(values: Sequence[float] | np.ndarray, place: int) -> range:
    """Return the run of near eigenvalues that the one at a place belongs to."""
    return next(run for run in clusters(values) if place in run)


def cluster_ends(
    values: np.ndarray, products: np.ndarray, rho: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the lower ends of several modes as one, ascending, and the (k, k) combinations of
    modes that they belong to, from Rayleigh quotients (k,), products of energy of their errors
    (k, k), and a number that no exact eigenvalue beyond these lies below.

    Examples
    --------
    >>> ends, _ = cluster_ends(np.array([1.0, 1.0]), np.array([[0.1, 0.1], [0.1, 0.1]]), 2.0)
    >>> ends.round(4)
    array([0.7143, 1.    ])
    """
    v = values / rho
    left = np.diag(v - 1)
    right = np.diag((v - 1) ** 2 / v) + (products + products.T) / (2 * rho * np.outer(v, v))
    tau, shapes = sla.eigh(left, right)
    ends = rho * tau / (tau - 1)
    order = np.argsort(ends)
    return ends[order], shapes[:, order]


def lower_ends(
    values: np.ndarray,
    products: np.ndarray,
    highest: float,
    families: Sequence[str] | None = None,
    pairs: Sequence[int] | None = None,
) -> np.ndarray:
    """Return the least eigenvalues of modes of one eigenproblem, NaN where nothing lies far enough
    beyond.

    Parameters
    ----------
    values : (k,) array
        Rayleigh quotients, ascending.
    products : (k, k) array
        Of energy of the errors of modes of unit mass.
    highest : float
        Highest eigenvalue that was solved of the problem: the discrete modes between are
        orthogonal to each other, so that the gap to it counts for a mode alone.
    families : sequence of str, optional
        Of the modes, where a mesh holds several that the body does not mix: each keeps its order.
    pairs : sequence of int, optional
        Equal numbers for twins, which are as good as alone.

    Examples
    --------
    >>> lower_ends(np.array([1.0, 2.0]), np.diag([0.1, 0.1]), 4.0).round(4)
    array([0.8667, 1.8   ])
    """
    families = ["" for _ in values] if families is None else families
    pairs = range(len(values)) if pairs is None else pairs
    ends, known = np.empty(len(values)), np.ones(len(values), bool)
    runs = clusters(values)
    for k, run in reversed(list(enumerate(runs))):
        own = np.ix_(run, run)
        gap = 1 - values[run] / highest
        alone = len({pairs[i] for i in run}) == 1
        if alone and gap.min() >= BESIDE:
            ends[run] = _as_first_order(values[run], products[own], gap)
            continue
        # at the end of what was solved it is looked at for its place only
        ends[run] = _as_first_order(values[run], products[own], np.ones(len(run)))
        beyond = [runs[j].start for j in range(k + 1, len(runs))]
        several = [_before(values, products, ends, run, b, families) for b in beyond]
        lower = [bounds for bounds in several if bounds is not None]
        known[run] = bool(lower)
        if lower:
            # every one of them holds
            ends[run] = np.max(lower, axis=0)
    for family in set(families):
        members = [i for i, name in enumerate(families) if name == family]
        ends[members] = np.sort(ends[members])
    return np.where(known, ends, np.nan)


def _as_first_order(values: np.ndarray, energy: np.ndarray, gap: np.ndarray) -> np.ndarray:
    """Return lower ends by Kato and Temple, of twins as one."""
    if len(values) == 1:
        return values - energy[0] / gap
    root = np.sqrt(gap)
    return np.linalg.eigvalsh(np.diag(values) - energy / np.outer(root, root))


def _before(
    values: np.ndarray,
    products: np.ndarray,
    ends: np.ndarray,
    run: range,
    beyond: int,
    families: Sequence[str],
) -> np.ndarray | None:
    """Return lower ends of a cluster as one with all up to a mode beyond, in the order of its
    modes; None where that one's lower end is not above them all.
    """
    rho = ends[beyond:].min()
    chosen = slice(run.start, beyond)
    if not rho > values[beyond - 1]:
        return None
    found, shapes = cluster_ends(values[chosen], products[chosen, chosen], rho)
    names = list(families[run.start : beyond])
    if len(set(names)) > 1:
        found = _by_family(found, shapes, names)
    return found[: len(run)]


def _by_family(ends: np.ndarray, shapes: np.ndarray, families: Sequence[str]) -> np.ndarray:
    """Return lower ends, each given to a mode of the family that its combination is made of."""
    from scipy.optimize import linear_sum_assignment  # slow to import, and seldom needed

    weight = shapes**2 / (shapes**2).sum(axis=0)
    same = np.array([[a == b for b in families] for a in families], float)
    modes, places = linear_sum_assignment(-(same @ weight))
    out = np.empty(len(ends))
    out[modes] = ends[places]
    for family in set(families):
        members = [i for i, name in enumerate(families) if name == family]
        out[members] = np.sort(out[members])
    return out
