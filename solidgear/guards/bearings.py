"""Guards on catalogue bearings as bodies: whether they fit their seats, shoulders and each other."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from typing import TYPE_CHECKING

from solidgear.bearings.catalogue import Catalogue, catalogue_of
from solidgear.core import TOUCH, Bearing, Scene
from solidgear.guards.notice import Notice, Notices

if TYPE_CHECKING:
    from solidgear.guards.probe import Probe

#: bore against seat, relative; an interference fit is some 1e-3 of the bore, and drawings round a seat to a whole mm
BORE = 0.01
#: seat over the width of a bearing: it may end at chamfers, and be longer than the ring by as much
NARROW, WIDE = 0.4, 1.15
#: shares of the width of a bearing: rings whose places are rounded may reach over a step or each
#: other by the first, and lean on a step that is as near as the second
REACH, LEANS = 0.12, 0.02
#: share of the height from bore to outer diameter, at which outer rings begin
OUTER_RING = 0.8
#: pitch circles of all kinds lie within this share of the middle between bore and outer diameter
PITCH = 0.05


def bearing_fit(probe: Probe) -> Notices:
    """Yield notices on bearings that do not fit where they sit."""
    yield from (Notice("caution", (), sentence) for sentence in misfits(probe.scene))


def misfits(scene: Scene) -> Iterator[str]:
    """Yield sentences on catalogue bearings that do not fit their seat, a shoulder, another bearing
    or the given inner dimensions.
    """
    on_axis = [b for b in scene.bearings if not b.patch]
    catalogued = [(b, data) for b in on_axis if (data := catalogue_of(b)) is not None]
    for bearing, _ in catalogued:
        yield from misfits_of(scene, bearing)
    for (a, data_a), (b, data_b) in combinations(catalogued, 2):
        distance, widths = abs(a.y - b.y), (data_a.seat_width, data_b.seat_width)
        if distance < (1 - REACH) * sum(widths) / 2:
            yield (
                f"bearings {a.name!r} and {b.name!r} take the same space: their middles are "
                f"{_mm(distance)} apart, and they are {_mm(widths[0])} and {_mm(widths[1])} wide; "
                "correct position or designation"
            )


def misfits_of(scene: Scene, bearing: Bearing) -> Iterator[str]:
    """Yield sentences on a bearing that does not fit its seat, a shoulder or given inner dimensions;
    none without catalogue data or on a patch.
    """
    data = catalogue_of(bearing)
    if data is None or bearing.patch:
        return
    yield from _on_its_seat(scene, bearing, data)
    yield from _beside_steps(scene, bearing, data)
    yield from _inside(bearing, data)


def _label(bearing: Bearing, data: Catalogue) -> str:
    """Return a bearing in words, with designation."""
    return f"bearing {bearing.name!r}" + (f" ({data.designation})" if data.designation else "")


def _on_its_seat(scene: Scene, bearing: Bearing, data: Catalogue) -> Iterator[str]:
    """Yield sentences on bore and width against the seat."""
    middle = (bearing.lo + bearing.hi) / 2
    segments = [s for s in scene.segments if s.y0 - TOUCH <= middle <= s.y1 + TOUCH]
    seat = 2 * max(s.radius_at(middle)[1] for s in segments)
    if abs(seat / data.bore - 1) > BORE:
        yield (
            f"{_label(bearing, data)} has a bore of {_mm(data.bore)} and sits on a diameter of "
            f"{_mm(seat)} ({segments[0].name!r}): correct designation, bore, position or the segment"
        )
    width, seat_width = data.seat_width, bearing.seat_width
    if not NARROW <= seat_width / width <= WIDE:
        pair = " with both of its rows" if data.paired else ""
        yield (
            f"{_label(bearing, data)} is {_mm(width)} wide{pair}, and its seat_width "
            f"{_mm(seat_width)}: correct one of them"
        )


def _beside_steps(scene: Scene, bearing: Bearing, data: Catalogue) -> Iterator[str]:
    """Yield sentences on larger diameters under the bearing, or beside it as high as its outer
    ring.
    """
    middle, width = (bearing.lo + bearing.hi) / 2, data.seat_width
    low, high = middle - width / 2, middle + width / 2
    slack = REACH * width
    for segment in scene.segments:
        reach = min(high, segment.y1) - max(low, segment.y0)
        if reach < -LEANS * width or segment.y0 <= middle <= segment.y1:
            continue
        step = segment.y0 if segment.y0 >= middle else segment.y1
        shoulder = 2 * segment.radius_at(step)[1]
        if reach > slack and shoulder > data.bore * (1 + BORE):
            yield (
                f"{_label(bearing, data)} reaches from y = {_mm(low)} to {_mm(high)}, over a step "
                f"to {_mm(shoulder)} at {_mm(step)} ({segment.name!r}), larger than its bore of "
                f"{_mm(data.bore)}: correct position, designation or the segment"
            )
        elif shoulder > data.bore + OUTER_RING * (data.outer_diameter - data.bore):
            yield (
                f"the shoulder of {_mm(shoulder)} at y = {_mm(step)} ({segment.name!r}) is as high as "
                f"the outer ring of {_label(bearing, data)}, whose outer diameter is "
                f"{_mm(data.outer_diameter)}: it rubs there; correct position, designation or the "
                "segment"
            )


def _inside(bearing: Bearing, data: Catalogue) -> Iterator[str]:
    """Yield a sentence on a pitch circle that is not in the middle of the boundary dimensions."""
    middle = (data.bore + data.outer_diameter) / 2
    if data.pitch_diameter and abs(data.pitch_diameter / middle - 1) > PITCH:
        yield (
            f"{_label(bearing, data)} has a pitch_diameter of {_mm(data.pitch_diameter)}, but "
            f"{_mm(middle)} is midway between its bore and its outer diameter: check its inner "
            "dimensions"
        )


def _mm(length: float) -> str:
    return f"{1e3 * length:.5g} mm"
