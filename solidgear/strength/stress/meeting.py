"""Notches that meet: those that lie in one section of a shaft count together there.

DIN 743 has factors of one notch, and of two keyways. For all others that overlap, the excess of every
factor over one adds (:class:`~solidgear.strength.stress.norm_notch.MeetingNotches`). A keyway and a
hole at other angles, which do not touch around the shaft, do not meet. Files that draw a fillet into
another notch, or grooves into each other, are refused.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from solidgear.core import listed
from solidgear.strength.stress.norm_notch import MeetingNotches
from solidgear.strength.stress.notches import drawn_notch
from solidgear.strength.stress.section_forces import Cut, lies_in

if TYPE_CHECKING:
    from solidgear.core import Scene
    from solidgear.strength.stress.rated_notch import RatedNotch


@dataclass(frozen=True)
class PlacedNotch:
    """A notch at its place on a shaft."""

    name: str
    kind: str  #: in words
    span: tuple[float, float]  #: ends along the shaft, m
    notch: RatedNotch | None  #: None where the norm has no factor
    remarks: tuple[str, ...] = ()  #: on its factors; without them the reason
    counted: tuple[str, ...] = ()  #: other notches that its factors hold already
    #: angles, rad, to which it opens, and half of its width around the shaft; none all around
    angles: tuple[float, ...] = ()
    half_width: float = 0.0

    def touches(self, other: PlacedNotch) -> bool:
        """Return whether it meets another that lies in the same section."""
        if not self.angles or not other.angles:
            return True
        room = self.half_width + other.half_width
        gaps = (math.remainder(a - b, 2 * math.pi) for a in self.angles for b in other.angles)
        return any(abs(gap) < room for gap in gaps)


def placed_notches(scene: Scene) -> list[PlacedNotch]:
    """Return the features of a shaft as notches, in the order of the file."""
    return [_placed(scene, feature) for feature in scene.features]


def _placed(scene: Scene, feature: Any) -> PlacedNotch:
    segment = next(s for s in scene.segments if s.name == feature.segment)
    name, kind, span = feature.name, feature.what, feature.span(scene.segments)
    drawn = drawn_notch(scene, feature)
    if isinstance(drawn, str):
        return PlacedNotch(name, kind, span, None, (drawn,))
    angles, half_width = _around(feature, segment.outer0)
    return PlacedNotch(
        name, kind, span, drawn.notch, drawn.remarks, drawn.counted, angles, half_width
    )


def _around(feature: Any, radius: float) -> tuple[tuple[float, ...], float]:
    """Return the angles to which a feature opens and half of its width there, rad."""
    if feature.kind == "keyway":
        return (feature.angle,), math.asin(feature.width / (2 * radius))
    if feature.kind == "cross_hole":
        return (feature.angle, feature.angle + math.pi), math.asin(feature.diameter / (2 * radius))
    return (), 0.0


def others_at(
    cut: Cut, placed: PlacedNotch, notches: Sequence[PlacedNotch]
) -> Iterator[PlacedNotch]:
    """Yield the other notches that one meets in a section."""
    counted = {placed.name, *placed.counted}
    for other in notches:
        if other.name in counted or not lies_in(other.span, cut.y, cut.beyond):
            continue
        if placed.touches(other):
            counted |= {other.name, *other.counted}
            yield other


def together(placed: PlacedNotch, others: Sequence[PlacedNotch]) -> RatedNotch:
    """Return a notch that has a factor with those that it meets."""
    assert placed.notch is not None, "a notch without a factor is not rated"
    notches = tuple(other.notch for other in others if other.notch is not None)
    return MeetingNotches(placed.notch, notches) if notches else placed.notch


def meeting_remark(others: Sequence[PlacedNotch]) -> str:
    """Return the remark on a notch that others with a factor meet; empty without any."""
    names = [f'{other.kind} "{other.name}"' for other in others if other.notch is not None]
    if not names:
        return ""
    return (
        f"it meets the {listed(names)}: the norm has no factor for {'both' if len(names) == 1 else 'all'}, "
        "so that the excess of every factor over 1 adds (assumed)"
    )
