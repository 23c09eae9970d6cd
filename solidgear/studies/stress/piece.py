"""The piece of a shaft around one of its fillets, on which the stress there is solved.

What a shoulder does to the stress of a plain shaft dies out along it as exp(-2.7 y / a) and faster,
a the radius (Little and Childs, Q. Appl. Math. 25 (1967), 261, for a solid cylinder), so that a
piece that goes on for four radii on both sides is off by some 2e-5. Loads enter at its ends as
Saint-Venant's stress of a plain shaft, which makes no disturbance of its own. Where the shaft ends
earlier, its end face is the end of the piece.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from solidgear.scene import Port
from solidgear.scene.coned import coned
from solidgear.scene.outline import TOUCH, Outline

if TYPE_CHECKING:
    from solidgear.scene import Corner, Scene, Segment

#: how far a piece goes on beyond its fillet, in outer radii of the shaft on that side
REACH = 4.0
#: of the extent of a fillet along a segment, what is left of that segment at least
ROOM = 3.0


@dataclass(frozen=True)
class Piece:
    """A piece of a shaft, loaded at its two ends; to builders a shaft of its own."""

    segments: tuple[Segment, ...]  #: from y = 0 on
    outline: Outline[Segment]
    corner: Corner  #: the one looked at, in the places of the piece
    start: float  #: of the piece on the shaft, m

    @property
    def length(self) -> float:
        """Overall length, m."""
        return self.segments[-1].y1

    @property
    def stations(self) -> tuple[Port, Port]:
        """Its two ends as mean motions of their cross-sections."""
        return _end("left", 0.0), _end("right", self.length)


def piece_around(scene: Scene, name: str, reach: float = REACH) -> Piece:
    """The piece of a shaft, its features left out, around a fillet of a name; it goes on for
    `reach` outer radii of the shaft on either side.

    Examples
    --------
    >>> import solidgear as sg
    >>> piece = piece_around(sg.load("geometry/pinion_filleted.toml"), "head fillet")
    >>> [(s.name, round(s.length, 4)) for s in piece.segments]
    [('head', 0.0582), ('head.backcone', 0.01), ('shaft', 0.184)]
    """
    whole = coned(scene.plain)
    corner = next(c for c in whole.outline.corners if c.name == name)
    low, high = whole.segments[corner.joint - 1 : corner.joint + 1]
    first, last = corner.span
    start = _cut(whole, first - reach * low.outer1, -1)
    end = _cut(whole, last + reach * high.outer0, 1)
    kept = [s for s in whole.segments if s.y1 > start + TOUCH and s.y0 < end - TOUCH]
    before = whole.segments.index(kept[0])
    segments = tuple(_part(s, start, end) for s in kept)
    corners = {
        c.name: replace(c, y=c.y - start, owner=c.owner - before)
        for c in whole.outline.corners
        if start + TOUCH < c.y < end - TOUCH and _counts(c, corner)
    }
    return Piece(segments, Outline(segments, corners.values()), corners[name], start)


def _counts(other: Corner, corner: Corner) -> bool:
    """False of rims on other faces, round which no stress flows, and of chamfers that could not
    become cones.
    """
    if other.root:
        return other.kind == "fillet"
    return other.joint == corner.joint


def _cut(shaft: Scene, y: float, way: int) -> float:
    """Place of a cut near a place, clear of all fillets; the end of the shaft where that comes
    first.
    """
    if not 0.0 < y < shaft.length:
        return 0.0 if way < 0 else shaft.length
    index = next(
        k for k, s in enumerate(shaft.segments) if y < s.y1 or k + 1 == len(shaft.segments)
    )
    segment = shaft.segments[index]
    rooms = (
        ROOM * max((c.axial for c in shaft.outline.corners if c.joint == joint), default=TOUCH)
        for joint in (index, index + 1)
    )
    first, last = segment.y0 + next(rooms), segment.y1 - next(rooms)
    # not so near to the joint passed that its fillets have no room
    if way < 0:
        y = min(y, last)
        return y if y > first else segment.y0
    y = max(y, first)
    return y if y < last else segment.y1


def _part(segment: Segment, start: float, end: float) -> Segment:
    """Part of a segment between two places, counted from the first."""
    y0, y1 = max(segment.y0, start), min(segment.y1, end)
    (inner0, outer0), (inner1, outer1) = segment.radius_at(y0), segment.radius_at(y1)
    return segment.with_changes(
        y0=y0 - start,
        y1=y1 - start,
        outer0=outer0,
        outer1=outer1,
        inner0=inner0,
        inner1=inner1,
    )


def _end(name: str, y: float) -> Port:
    return Port(name=name, y=y, lo=y, hi=y, attachment="section")
