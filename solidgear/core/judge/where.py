"""Places of the error of a number.

An error bar is made of the energies of local solutions, cell by cell of the meridian
(:mod:`solidgear.core.judge.bounded`): each shoulder, seat end or other singular place gets the share of
the cells around it.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.core.body import Body, Supports, as_supports
from solidgear.core.bounds.harmonic import richer_space
from solidgear.core.bounds.refining import corner_strength
from solidgear.core.errors import SolidgearError
from solidgear.core.judge.bars import LEAST, ErrorBar
from solidgear.core.judge.bounded import NOTHING_BEYOND, bounded
from solidgear.core.judge.quantities import usual
from solidgear.core.judge.record import PlaceRecord, WhereRecord
from solidgear.core.judge.singular_places import Place, singular_places
from solidgear.core.judge.solving import ENOUGH, Statics, numbers, search_modes
from solidgear.core.judge.ties import SCENE
from solidgear.core.ladder import build
from solidgear.core.machine.memory import one_run
from solidgear.core.machine.threads import pinned
from solidgear.core.meshing.meridian import Meridian
from solidgear.core.quantity import Quantity
from solidgear.core.scene.coned import coned
from solidgear.core.solve.statics import SOLVED, flexibility

if TYPE_CHECKING:
    from solidgear.core.judge.solution import Solution
    from solidgear.core.scene import Scene

#: error bars that exceed the solver's error by less than this are rounding, and have no place
ROUNDING = 1e-9
#: exponents, and distances in lengths of the shaft, that differ by less are the same
SAME_EXPONENT, SAME_DISTANCE = 1e-3, 1e-9
ELSEWHERE = "elsewhere"


@pinned
def error_places(scene: Scene, quantity: Quantity, options: Mapping[str, Any]) -> WhereRecord:
    """Locate the error of a number of the harmonic solid that was answered on a mesh of some
    options: a compliance, a stiffness or a frequency, also of a further point or between two.
    SolidgearError for a number whose error bar is no more than rounding.
    """
    start = time.perf_counter()
    with one_run():
        body, supports = build(scene, "harmonic", **options), as_supports(scene)
        error_bar, shares = _shares(scene, body, supports, quantity)
        # a body with several attachments answers with the first
        places = singular_places(scene, (options.get("attachments") or ())[:1] or None)
        return _record(scene, body, places, quantity, error_bar.width, shares, start)


def recorded_places(scene: Scene, solution: Solution) -> WhereRecord | None:
    """Locate the error of the least certain number of a harmonic solid, for the record; None where
    the error has no place: nothing is judged, or only rounding is left.
    """
    start = time.perf_counter()
    bars = solution.error_bars.get(SCENE, {})
    judged = [q for q in usual(scene) if q in bars]
    if not judged:
        return None
    quantity = max(judged, key=lambda q: bars[q].width)
    if _rounding(bars[quantity]):
        return None
    shares, places = solution.scores[quantity], singular_places(scene)
    return _record(scene, solution.body, places, quantity, bars[quantity].width, shares, start)


def _sentence(quantity: Quantity, shares: list[tuple[Place, float]]) -> str:
    """Say in words where most of an error sits."""
    (first, most), *others = shares
    sentence = f"{100 * most:.0f} % of the error bar of {quantity} arises {_at(first)}"
    if most >= 0.5 or not others:
        return sentence
    second, less = others[0]
    return f"{sentence}, {100 * less:.0f} % {_at(second)}"


def _at(place: Place) -> str:
    height = f"y = {1e3 * place.y:.4g} mm"
    if place.what == ELSEWHERE:
        return f"away from shoulders and seat ends, most of it around {height}"
    return f"at the {place.what} at {height}"


def _shares(
    scene: Scene, body: Body, supports: Supports, quantity: Quantity
) -> tuple[ErrorBar, np.ndarray]:
    """Return the error bar of a quantity, and (m,) shares of it by cells."""
    statics, modes = None, None
    if quantity.is_frequency:
        modes = search_modes(body, supports, ENOUGH, [quantity], spare=True, ovalising=False)
    else:
        flexibility(body, SOLVED)
        statics = Statics.for_quantities(scene, body, supports, [quantity])
    solver = numbers(statics, modes).solver
    judged = bounded(scene, body, supports, statics, modes, [quantity], solver)
    if quantity not in judged.error_bars:
        raise SolidgearError(f"{quantity} has no error bar: {NOTHING_BEYOND}")
    error_bar, score = judged.error_bars[quantity], judged.scores[quantity]
    if _rounding(error_bar):
        raise SolidgearError(
            f"the error bar of {quantity} is {error_bar.width:.1e}, which is rounding, so that there is "
            "no place to show"
        )
    return error_bar, score / score.sum()


def _rounding(bar: ErrorBar) -> bool:
    """Return whether an error bar is no more than rounding, and has no place."""
    return bar.width - bar.solver - LEAST < ROUNDING


def _record(
    scene: Scene,
    body: Body,
    places: tuple[Place, ...],
    quantity: Quantity,
    total: float,
    shares: np.ndarray,
    start: float,
) -> WhereRecord:
    """Build the record of the places of the error of a quantity, begun at `start` by the clock."""
    flat = body.geometry.meridian  # type: ignore[union-attr]
    placed = _by_place(places, flat, _owners(scene, body, places), shares)
    return WhereRecord(
        model=body.fidelity,
        quantity=quantity,
        order=int(body.mesh["order"]),
        total=total,
        sentence=_sentence(quantity, placed),
        rows=[PlaceRecord(**asdict(place), share=share) for place, share in placed],
        points=flat.points.tolist(),
        cells=flat.cells.tolist(),
        shares=shares.tolist(),
        seconds=time.perf_counter() - start,
    )


def _by_place(
    places: tuple[Place, ...], flat: Meridian, owners: list[list[int]], shares: np.ndarray
) -> list[tuple[Place, float]]:
    """Return the shares of the places and the share outside all of them, the largest first."""
    sums, outside = np.zeros(len(places)), shares.copy()
    for cell, cell_owners in enumerate(owners):
        if cell_owners:
            sums[cell_owners] += shares[cell] / len(cell_owners)
            outside[cell] = 0.0
    r, y = flat.points[:, flat.cells[:, outside.argmax()]].mean(axis=1)
    elsewhere = Place(ELSEWHERE, float(y), float(r), math.inf)  # a record has no such reach
    out = [*zip(places, sums.tolist()), (elsewhere, float(outside.sum()))]
    return sorted(out, key=lambda placed: -placed[1])


def _owners(scene: Scene, body: Body, places: tuple[Place, ...]) -> list[list[int]]:
    """Return the places that every cell of a mesh belongs to; several share the cell in equal
    parts.

    A cell with singular corners belongs to the place of the sharpest: where cells are equally
    small, a smaller exponent costs more. Any other cell belongs to the nearest place to the middle
    of the cell, if the reach of that place is so large.
    """
    flat = body.geometry.meridian  # type: ignore[union-attr]
    corners: dict[int, tuple[list[int], float]] = {}
    for vertex, (kind, angle) in richer_space(coned(scene), body).corners.items():
        nearest = _nearest(scene, places, flat.points[:, vertex])
        if nearest:
            corners[vertex] = nearest, corner_strength(kind, angle)
    out = []
    for cell in flat.cells.T:
        cell_corners = [corners[v] for v in map(int, cell) if v in corners]
        sharpest = min((exponent for _, exponent in cell_corners), default=0.0) + SAME_EXPONENT
        sharpest_places = [nearest for nearest, exponent in cell_corners if exponent < sharpest]
        out.append(
            list(dict.fromkeys(k for nearest in sharpest_places for k in nearest))
            or _nearest(scene, places, flat.points[:, cell].mean(axis=1))
        )
    return out


def _nearest(scene: Scene, places: tuple[Place, ...], point: np.ndarray) -> list[int]:
    """Return the indices of the nearest places to a point, r and y in m; none where that place does
    not reach so far, several where they are equally near.
    """
    distance = np.array([np.hypot(p.r - point[0], p.y - point[1]) for p in places])
    least = distance.min(initial=np.inf) + SAME_DISTANCE * scene.length
    return [k for k, p in enumerate(places) if distance[k] <= min(least, p.reach)]
