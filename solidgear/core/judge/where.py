"""Places of the error of a number.

An error bar is made of energies of cells (:mod:`solidgear.core.judge.bounded`): each shoulder, seat
end, feature or other singular place gets the share of the cells around it
(:mod:`solidgear.core.judge.cell_places`).
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.core.body import Body, Supports, as_supports
from solidgear.core.bounds.singular_places import Place
from solidgear.core.elements import ELEMENTS
from solidgear.core.errors import SolidgearError
from solidgear.core.judge.bars import LEAST, ErrorBar
from solidgear.core.judge.bounded import NOTHING_BEYOND, bounded
from solidgear.core.judge.cell_places import CellPlaces, Share
from solidgear.core.judge.quantities import usual
from solidgear.core.judge.record import PlaceRecord, WhereRecord
from solidgear.core.judge.solving import ENOUGH, Statics, numbers, search_modes
from solidgear.core.judge.ties import SCENE
from solidgear.core.ladder import build
from solidgear.core.ladder.registry import LADDER
from solidgear.core.machine.memory import one_run
from solidgear.core.machine.threads import pinned
from solidgear.core.quantity import Quantity
from solidgear.core.solve.statics import SOLVED, flexibility

if TYPE_CHECKING:
    from solidgear.core.judge.solution import Solution
    from solidgear.core.scene import Scene

#: error bars that exceed the solver's error by less than this are rounding, and have no place
ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class ErrorMap:
    """The places of the error of a number, and the cells that they are summed over."""

    record: WhereRecord
    body: Body
    by_cells: np.ndarray  #: (ne,) shares of the error bar, in sum one


def error_places(
    scene: Scene, quantity: Quantity, options: Mapping[str, Any], model: str = "harmonic"
) -> WhereRecord:
    """Return the places of the error of a number; parameters and errors are those of
    :func:`map_error`.
    """
    return map_error(scene, quantity, options, model).record


@pinned
def map_error(
    scene: Scene, quantity: Quantity, options: Mapping[str, Any], model: str = "harmonic"
) -> ErrorMap:
    """Locate the error of a number of a solid that was answered on a mesh of some options: a
    compliance, a stiffness or a frequency, also of a further point or between two. SolidgearError
    for a number whose error bar is no more than rounding, and for a model whose error bars are not
    computed on its mesh.
    """
    start = time.perf_counter()
    with one_run():
        body, supports = build(scene, model, **options), as_supports(scene)
        if not LADDER[model].bars_by:
            raise SolidgearError(f"the {LADDER[model].title} has no error bar by cells")
        error_bar, shares = _shares(scene, body, supports, quantity)
        # a body with several attachments answers with the first
        cells = CellPlaces.of_body(scene, body, (options.get("attachments") or ())[:1] or None)
        record = _record(body, cells, quantity, error_bar.width, shares, start)
        return ErrorMap(record, body, shares)


def recorded_places(scene: Scene, solution: Solution) -> WhereRecord | None:
    """Locate the error of the least certain number of a solid, for the record; None where the error
    has no place: nothing is judged by cells, or only rounding is left.
    """
    start = time.perf_counter()
    quantity = least_certain(scene, solution)
    if quantity is None:
        return None
    bar, shares = solution.error_bars[SCENE][quantity], solution.scores[quantity]
    cells = CellPlaces.of_body(scene, solution.body)
    return _record(solution.body, cells, quantity, bar.width, shares, start)


def least_certain(scene: Scene, solution: Solution) -> Quantity | None:
    """Return the number of a solid with the widest error bar that has a place; None without one."""
    bars = solution.error_bars.get(SCENE, {})
    judged = [q for q in usual(scene) if q in bars and q in solution.scores]
    if not judged:
        return None
    quantity = max(judged, key=lambda q: bars[q].width)
    return None if _rounding(bars[quantity]) else quantity


def _sentence(quantity: Quantity, cells: CellPlaces, shares: list[Share]) -> str:
    """Say in words where most of an error sits."""
    first, *others = shares
    of = f"of the error bar of {quantity} arises"
    sentence = f"{100 * first.share:.0f} % {of} {_at(cells, first)}"
    if first.share >= 0.5 or not others:
        return sentence
    return f"{sentence}, {100 * others[0].share:.0f} % {_at(cells, others[0])}"


def _at(cells: CellPlaces, share: Share) -> str:
    if share.place is not None:
        return f"at {cells.at(share)}"
    known = "shoulders and seat ends" if cells.axis else "concave edges and ends of patches"
    if cells.flat:
        return f"away from {known}, most of it around y = {1e3 * share.point[1]:.4g} mm"
    return f"away from {known}, most of it in {cells.at(share)}"


def _shares(
    scene: Scene, body: Body, supports: Supports, quantity: Quantity
) -> tuple[ErrorBar, np.ndarray]:
    """Return the error bar of a quantity, and (m,) shares of it by cells."""
    statics, modes = None, None
    if quantity.is_frequency:
        modes = search_modes(body, supports, ENOUGH, [quantity], spare=True, ovalising=False)
    else:
        if LADDER[body.fidelity].follows:
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
    body: Body,
    cells: CellPlaces,
    quantity: Quantity,
    total: float,
    by_cells: np.ndarray,
    start: float,
) -> WhereRecord:
    """Build the record of the places of the error of a quantity, begun at `start` by the clock; it
    holds the cells of a meridian, and not those of a volume, of which there are many.
    """
    shares = cells.shares(by_cells)
    record = WhereRecord(
        model=body.fidelity,
        quantity=quantity,
        order=_order(body, cells),
        total=total,
        sentence=_sentence(quantity, cells, shares),
        rows=[_row(cells, share) for share in shares],
        seconds=time.perf_counter() - start,
    )
    if cells.flat:
        record.points = cells.points[:2].tolist()
        record.cells, record.shares = cells.cells.tolist(), by_cells.tolist()
    return record


def _order(body: Body, cells: CellPlaces) -> int:
    """Return the order of the elements of a body."""
    if cells.flat:
        return int(body.mesh["order"])
    geometry: Any = body.geometry
    return ELEMENTS[geometry.solved.name].order


def _row(cells: CellPlaces, share: Share) -> PlaceRecord:
    """Build the record of a place; x and z only where it is no circle around the axis."""
    x, y, z = share.point
    row = PlaceRecord(what=share.what, y=y, share=share.share)
    if share.place is not None:
        row.reach = share.place.reach
    if isinstance(share.place, Place):
        row.r = share.place.r
        return row
    if cells.axis:
        row.r = float(np.hypot(x, z))
    if not cells.flat:
        row.x, row.z = x, z
    return row
