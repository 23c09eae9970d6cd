"""Guards on bearings of catalogue data as bodies: do they fit their seats, shoulders and each other."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from solidgear.scene import Bearing, Scene
from solidgear.scene.catalogue import Catalogue
from solidgear.scene.outline import TOUCH
from solidgear.studies.guards.notice import Notice, Notices
from solidgear.studies.guards.probe import Probe

#: relative; an interference fit is some 1e-3 of the bore, and drawings round a seat to a whole mm
BORE = 0.01
#: of the width of a bearing: a seat may end at chamfers, and be longer than the ring by as much
NARROW, WIDE = 0.4, 1.15
#: of the width of a bearing: rings whose places are rounded may reach over a step or each other by the
#: first, and lean on a step that is as near as the second
REACH, LEANS = 0.12, 0.02
#: of the height from bore to outer diameter, at which outer rings begin
OUTER_RING = 0.8
#: of the middle between bore and outer diameter: pitch circles of all kinds lie within this of it
PITCH = 0.05


def bearing_fit(probe: Probe) -> Notices:
    """Bearings that do not fit where they sit."""
    yield from (Notice("caution", (), sentence) for sentence in misfits(probe.scene))


def misfits(scene: Scene) -> Iterator[str]:
    """Sentences on bearings of catalogue data that do not fit their seat, a shoulder, another bearing
    or what is given of their inside.
    """
    known = [(b, b.catalogue) for b in scene.bearings if b.catalogue is not None and not b.patch]
    for bearing, data in known:
        yield from _on_its_seat(scene, bearing, data)
        yield from _beside_steps(scene, bearing, data)
        yield from _inside(bearing, data)
    for (one, first), (two, second) in combinations(known, 2):
        apart, widths = abs(one.y - two.y), (width_of(first), width_of(second))
        if apart < (1 - REACH) * sum(widths) / 2:
            yield (
                f"bearings {one.name!r} and {two.name!r} take the same space: their middles are "
                f"{_mm(apart)} apart, and they are {_mm(widths[0])} and {_mm(widths[1])} wide; "
                "correct position or designation"
            )


def width_of(data: Catalogue) -> float:
    """Width of a bearing with all that is paired in it, m."""
    return data.width * (2 if data.paired else 1)


def called(bearing: Bearing, data: Catalogue) -> str:
    """A bearing in words, with its designation."""
    return f"bearing {bearing.name!r}" + (f" ({data.designation})" if data.designation else "")


def _on_its_seat(scene: Scene, bearing: Bearing, data: Catalogue) -> Iterator[str]:
    """Bore and width against the seat."""
    middle = (bearing.lo + bearing.hi) / 2
    here = [s for s in scene.segments if s.y0 - TOUCH <= middle <= s.y1 + TOUCH]
    seat = 2 * max(s.radius_at(middle)[1] for s in here)
    if abs(seat / data.bore - 1) > BORE:
        yield (
            f"{called(bearing, data)} has a bore of {_mm(data.bore)} and sits on a diameter of "
            f"{_mm(seat)} ({here[0].name!r}): correct designation, bore, position or the segment"
        )
    width, seat_width = width_of(data), bearing.hi - bearing.lo
    if not NARROW <= seat_width / width <= WIDE:
        pair = " with both of its rows" * data.paired
        yield (
            f"{called(bearing, data)} is {_mm(width)} wide{pair}, and its seat_width "
            f"{_mm(seat_width)}: correct one of them"
        )


def _beside_steps(scene: Scene, bearing: Bearing, data: Catalogue) -> Iterator[str]:
    """Larger diameters under the bearing, or beside it as high as its outer ring."""
    middle, width = (bearing.lo + bearing.hi) / 2, width_of(data)
    low, high = middle - width / 2, middle + width / 2
    slack = REACH * width
    for segment in scene.segments:
        reach = min(high, segment.y1) - max(low, segment.y0)
        if reach < -LEANS * width or segment.y0 <= middle <= segment.y1:
            continue
        at = segment.y0 if segment.y0 >= middle else segment.y1
        shoulder = 2 * segment.radius_at(at)[1]
        if reach > slack and shoulder > data.bore * (1 + BORE):
            yield (
                f"{called(bearing, data)} reaches from y = {_mm(low)} to {_mm(high)}, over a step "
                f"to {_mm(shoulder)} at {_mm(at)} ({segment.name!r}), which its bore of "
                f"{_mm(data.bore)} does not pass: correct position, designation or the segment"
            )
        elif shoulder > data.bore + OUTER_RING * (data.outer_diameter - data.bore):
            yield (
                f"the shoulder of {_mm(shoulder)} at y = {_mm(at)} ({segment.name!r}) is as high as "
                f"the outer ring of {called(bearing, data)}, whose outer diameter is "
                f"{_mm(data.outer_diameter)}: it rubs there; correct position, designation or the "
                "segment"
            )


def _inside(bearing: Bearing, data: Catalogue) -> Iterator[str]:
    """A pitch circle that is not in the middle of the boundary dimensions."""
    middle = (data.bore + data.outer_diameter) / 2
    if data.pitch_diameter and abs(data.pitch_diameter / middle - 1) > PITCH:
        yield (
            f"{called(bearing, data)} has a pitch_diameter of {_mm(data.pitch_diameter)}, and the "
            f"middle between its bore and its outer diameter is {_mm(middle)}: are its inner "
            "dimensions those of another bearing?"
        )


def _mm(length: float) -> str:
    return f"{1e3 * length:.5g} mm"
