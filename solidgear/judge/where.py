"""Places of the error of a number.

A bar is made of the energies of local solutions, cell by cell of the meridian
(:mod:`solidgear.judge.bounded`): each shoulder, seat end or other singular place has what the cells
around it hold.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.body import Body, Supports, as_supports
from solidgear.bounds.harmonic import richer_space
from solidgear.bounds.refining import corner_strength
from solidgear.errors import SolidgearError
from solidgear.judge.bars import LEAST, ErrorBar
from solidgear.judge.bounded import bounded
from solidgear.judge.quantities import usual
from solidgear.judge.record import PlaceRecord, WhereRecord
from solidgear.judge.singular_places import Place, singular_places
from solidgear.judge.solving import ENOUGH, Statics, numbers, searched
from solidgear.judge.ties import SCENE
from solidgear.ladder import build
from solidgear.machine.memory import one_run
from solidgear.machine.threads import pinned
from solidgear.meshing.meridian import Meridian
from solidgear.quantity import Quantity
from solidgear.scene.coned import coned
from solidgear.solve.statics import SOLVED, flexibility

if TYPE_CHECKING:
    from solidgear.judge.solution import Solution
    from solidgear.scene import Scene

#: bars that leave less than this beside what the solver leaves are rounding, and have no place
ROUNDING = 1e-9
#: exponents, and distances in lengths of the shaft, that differ by less are the same
SAME_EXPONENT, SAME_DISTANCE = 1e-3, 1e-9
ELSEWHERE = "elsewhere"


@pinned
def where(scene: Scene, quantity: Quantity, options: Mapping[str, Any]) -> WhereRecord:
    """Places of the error of a number of the harmonic solid that was answered on a mesh.

    Parameters
    ----------
    quantity : Quantity
        A compliance, a stiffness or a frequency, also of a further point or between two.
    options : mapping
        Of the builder of the harmonic solid.

    Raises
    ------
    SolidgearError
        For a number whose bar is no more than rounding.
    """
    start = time.perf_counter()
    with one_run():
        body, supports = build(scene, "harmonic", **options), as_supports(scene)
        bar, shares = _shares(scene, body, supports, quantity)
        # a body with several attachments answers with the first
        places = singular_places(scene, (options.get("attachments") or ())[:1] or None)
        return _record(scene, body, places, quantity, bar.width, shares, start)


def recorded_places(scene: Scene, solution: Solution) -> WhereRecord | None:
    """Places of the error of the least certain number of a harmonic solid, for the record; None where the
    error has no place: nothing is judged, or what is left is rounding.
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
    """Place of most of it, in words."""
    (first, most), *rest = shares
    said = f"{100 * most:.0f} % of what is left in {quantity} sits {_at(first)}"
    if most >= 0.5 or not rest:
        return said
    second, less = rest[0]
    return f"{said}, {100 * less:.0f} % {_at(second)}"


def _at(place: Place) -> str:
    at = f"y = {1e3 * place.y:.4g} mm"
    if place.what == ELSEWHERE:
        return f"away from shoulders and seat ends, most of it around {at}"
    return f"at the {place.what} at {at}"


def _shares(
    scene: Scene, body: Body, supports: Supports, quantity: Quantity
) -> tuple[ErrorBar, np.ndarray]:
    """Bar of a quantity, and (m,) shares of it by cells."""
    statics, found = None, None
    if quantity.is_frequency:
        found = searched(body, supports, ENOUGH, [quantity], spare=True, ovalising=False)
    else:
        flexibility(body, SOLVED)
        statics = Statics.of(scene, body, supports, [quantity])
    solver = numbers(statics, found).solver
    told = bounded(scene, body, supports, statics, found, [quantity], solver)
    bar, score = told.error_bars[quantity], told.scores[quantity]
    if _rounding(bar):
        raise SolidgearError(
            f"the bar of {quantity} is {bar.width:.1e}, which is rounding; there is no error to place"
        )
    return bar, score / score.sum()


def _rounding(bar: ErrorBar) -> bool:
    """Tell whether a bar is no more than rounding, and has no place."""
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
    """Places of the error of a quantity, begun at some time."""
    flat = body.geometry.meridian  # type: ignore[union-attr]
    found = _by_place(places, flat, _owners(scene, body, places), shares)
    return WhereRecord(
        model=body.fidelity,
        quantity=quantity,
        order=int(body.mesh["order"]),
        total=total,
        sentence=_sentence(quantity, found),
        rows=[PlaceRecord(**asdict(place), share=share) for place, share in found],
        points=flat.points.tolist(),
        cells=flat.cells.tolist(),
        shares=shares.tolist(),
        seconds=time.perf_counter() - start,
    )


def _by_place(
    places: tuple[Place, ...], flat: Meridian, owners: list[list[int]], shares: np.ndarray
) -> list[tuple[Place, float]]:
    """Shares of the places and of what belongs to none, the largest first."""
    sums, away = np.zeros(len(places)), shares.copy()
    for cell, own in enumerate(owners):
        if own:
            sums[own] += shares[cell] / len(own)
            away[cell] = 0.0
    r, y = flat.points[:, flat.cells[:, away.argmax()]].mean(axis=1)
    elsewhere = Place(ELSEWHERE, float(y), float(r), math.inf)  # a record has no such reach
    out = [*zip(places, sums.tolist()), (elsewhere, float(away.sum()))]
    return sorted(out, key=lambda one: -one[1])


def _owners(scene: Scene, body: Body, places: tuple[Place, ...]) -> list[list[int]]:
    """Places that every cell of a mesh belongs to, of several each to the same part.

    Of a cell with singular corners it is that of the sharpest: where cells are as small as each
    other a smaller exponent costs more. Of all else it is the nearest to its middle, if that
    reaches so far.
    """
    flat = body.geometry.meridian  # type: ignore[union-attr]
    corners: dict[int, tuple[list[int], float]] = {}
    for vertex, (kind, angle) in richer_space(coned(scene), body).corners.items():
        at = _nearest(scene, places, flat.points[:, vertex])
        if at:
            corners[vertex] = at, corner_strength(kind, angle)
    out = []
    for cell in flat.cells.T:
        here = [corners[v] for v in map(int, cell) if v in corners]
        sharpest = min((exponent for _, exponent in here), default=0.0) + SAME_EXPONENT
        own = [at for at, exponent in here if exponent < sharpest]
        out.append(
            list(dict.fromkeys(k for at in own for k in at))
            or _nearest(scene, places, flat.points[:, cell].mean(axis=1))
        )
    return out


def _nearest(scene: Scene, places: tuple[Place, ...], point: np.ndarray) -> list[int]:
    """The nearest of some places to a point, r and y in m; none where that does not reach so far,
    several where they are as near.
    """
    away = np.array([np.hypot(p.r - point[0], p.y - point[1]) for p in places])
    least = away.min(initial=np.inf) + SAME_DISTANCE * scene.length
    return [k for k, p in enumerate(places) if away[k] <= min(least, p.reach)]
