"""Search of a box for the least of a number that is costly and a little rough: a sample of the whole
box first, searches from the best places of it, and a last step at the best.

The sample has the corners of a small box and points of Sobol's sequence inside, the searches are those
of SciPy that want no derivative: Brent's bounded scalar search for one coordinate without limits, and
COBYQA (Ragonneau and Zhang 2024), a trust-region method with bounds and constraints, for all others.
A box of one minimum costs little more than one search; the sample shows whether there are several.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence

import numpy as np

#: coordinates of a box whose corners are all sampled
MOST_CORNERED = 3
#: points of the sample: on a line, and for each coordinate of other boxes (a power of two for two)
LINE, INSIDE = 9, 8
#: searches from the sample, distance of their beginnings, and most designs of one a coordinate
STARTS, DISTANCE, MOST = 3, 0.25, 12
#: of a range: last steps of a search and of the last one, and a distance that is moved to the end
COARSE, FINE, NEAR = 1e-2, 1e-4, 2e-2
#: of the number, for a limit that is missed by all of it
PENALTY = 2.0

#: from a place in the unit box
Number = Callable[[np.ndarray], float]


def search_box(dimension: int, goal: Number, misses: Sequence[Number], begin: np.ndarray) -> str:
    """Search the least of a number where no miss is above zero, each relative to a size of its own, from
    a (dimension,) place `begin` and those of a sample; return the search in words.

    The caller keeps the places that its numbers were asked for: the best of them is the result.
    """
    merit = _merit(goal, misses)
    places = _sample(dimension)
    merits = [merit(place) for place in places]
    if dimension == 1 and not misses:
        count = _on_the_line(goal, [float(place[0]) for place in places], merits)
        return f"{LINE} designs across the range, then Brent's method from {_best(count)}"
    starts = _distant([begin, *places], [merit(begin), *merits])
    best = min(starts, key=merit)
    for start in starts:
        best = min(best, _trust_region(goal, misses, start, 0.2, COARSE), key=merit)
    ends = np.where(best < NEAR, 0.0, np.where(best > 1 - NEAR, 1.0, best))
    best = min(best, ends, key=merit)
    _trust_region(goal, misses, best, COARSE, FINE)
    return (
        f"{len(places)} designs across the ranges, then COBYQA from {_best(len(starts))}, and a last "
        f"step of {FINE:g} of the ranges"
    )


def _best(count: int) -> str:
    return "the best of them" if count == 1 else f"the {count} best separate ones"


def _merit(goal: Number, misses: Sequence[Number]) -> Number:
    """Return the number with a penalty for limits that are missed."""

    def merit(place: np.ndarray) -> float:
        missing = sum(max(0.0, miss(place)) for miss in misses)
        return goal(place) + (1.0 + PENALTY * missing if missing else 0.0)

    return merit


def _sample(dimension: int) -> list[np.ndarray]:
    """Return the places of a sample of the unit box."""
    from scipy.stats import qmc  # slow to import, and few commands have a use for it

    if dimension == 1:
        return list(np.linspace(0.0, 1.0, LINE)[:, None])
    corners: list[np.ndarray] = []
    if dimension <= MOST_CORNERED:
        corners = [*map(np.array, itertools.product((0.0, 1.0), repeat=dimension))]
    inside = qmc.Sobol(dimension, scramble=False).random_base2(int(np.log2(INSIDE * dimension)))
    return [*corners, *inside[1:]]  # the sequence begins in a corner


def _on_the_line(goal: Number, places: Sequence[float], values: Sequence[float]) -> int:
    """Run Brent's search about the places of a line that are better than their neighbours, the best
    first, and return their number.
    """
    from scipy.optimize import minimize_scalar

    wall = [np.inf, *values, np.inf]
    least = [k for k in range(len(places)) if wall[k] > wall[k + 1] <= wall[k + 2]]
    least = sorted(least, key=lambda k: values[k])[:STARTS]
    for k in least:
        low, high = places[max(k - 1, 0)], places[min(k + 1, len(places) - 1)]
        minimize_scalar(
            lambda x: goal(np.array([x])),
            bounds=(low, high),
            method="bounded",
            options={"xatol": COARSE / 2, "maxiter": MOST},
        )
    return len(least)


def _distant(places: Sequence[np.ndarray], merits: Sequence[float]) -> list[np.ndarray]:
    """Return the best places that lie a distance from each other."""
    starts: list[np.ndarray] = []
    for k in np.argsort(merits, kind="stable"):
        far = all(np.abs(places[k] - start).max() > DISTANCE for start in starts)
        if far and len(starts) < STARTS:
            starts.append(places[k])
    return starts


def _trust_region(
    goal: Number, misses: Sequence[Number], start: np.ndarray, first: float, last: float
) -> np.ndarray:
    """Run COBYQA with a first and last radius of the region, and return its last place."""
    from scipy.optimize import NonlinearConstraint, minimize

    limits = [NonlinearConstraint(miss, -np.inf, 0.0) for miss in misses]
    result = minimize(
        goal,
        start,
        bounds=[(0.0, 1.0)] * len(start),
        constraints=limits,
        method="COBYQA",
        options={
            "maxfev": MOST * len(start) + MOST * bool(misses),
            "initial_tr_radius": first,
            "final_tr_radius": last,
        },
    )
    return np.clip(result.x, 0.0, 1.0)
