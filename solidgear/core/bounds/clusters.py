"""Lower ends of eigenvalues, of near modes as one.

With the modes of a mesh, their Rayleigh quotients Lambda and the products of energy M of their errors,
the exact eigenvalue number j is the j-th of

    Lambda - r' (S - lambda_j m)^-1 r,      M = r' S^-1 r

where r couples the modes to what is orthogonal to them, of stiffness S and mass m.  Since the modes
are orthogonal to each other, what couples to them lies beyond the highest one that was solved, rho, and
the eigenvalue is no less than the j-th of

    Lambda - M / (1 - lambda_j / rho)

of one mode the bound of Kato and Temple (Kato 1949, J. Phys. Soc. Japan 4, 334; Temple 1928, Proc. R.
Soc. A 119, 276).  The gap to rho alone counts.  The shapes of near modes may turn among each other, and
M holds what their errors share; others do not, and what these share is of second order.  Where nothing
was solved far enough beyond, there is no lower end.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from solidgear.core.safety import BESIDE
from solidgear.core.solve.neighbours import best_assignment


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


def lower_ends(
    values: np.ndarray,
    products: np.ndarray,
    highest: float,
    families: Sequence[str] | None = None,
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
        Eigenvalue that nothing orthogonal to the modes solved lies below: on meshes whose modes are
        hardly off the highest that was solved.
    families : sequence of str, optional
        Of the modes, where a mesh holds several that the body does not mix: each keeps its order.

    Examples
    --------
    >>> lower_ends(np.array([1.0, 2.0]), np.diag([0.1, 0.1]), 4.0).round(4)
    array([0.8667, 1.8   ])
    """
    ends_of_runs = [run.stop for run in clusters(values)]
    number = np.searchsorted(ends_of_runs, np.arange(len(values)), side="right")
    shared = np.where(np.equal.outer(number, number), products, 0.0)
    ends = np.full(len(values), np.nan)
    if not highest > 0:
        return ends
    for k, gap in enumerate(1 - values / highest):
        if gap < BESIDE:
            continue
        found, shapes = np.linalg.eigh(np.diag(values) - shared / gap)
        ends[k] = found[k] if families is None else _by_family(found, shapes, families)[k]
    return np.minimum(ends, values)


def _by_family(ends: np.ndarray, shapes: np.ndarray, families: Sequence[str]) -> np.ndarray:
    """Return ascending lower ends, each given to a mode of the family that its combination is made
    of.
    """
    if len(set(families)) == 1:
        return ends
    weight = shapes**2 / (shapes**2).sum(axis=0)
    same = np.array([[a == b for b in families] for a in families], float)
    modes, places = best_assignment(same @ weight)
    out = np.empty(len(ends))
    out[modes] = ends[places]
    for family in set(families):
        members = [i for i, name in enumerate(families) if name == family]
        out[members] = np.sort(out[members])
    return out
