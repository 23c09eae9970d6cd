"""Rules between features on one segment: teeth, bolt circles, grooves."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import Any

from solidgear.core import TOUCH, SceneError
from solidgear.core.scene.feature import FEWEST, SMALLEST
from solidgear.core.scene.parts import Segment
from solidgear.cuts.features.bolt_circle import BoltCircle
from solidgear.cuts.features.grooves import Groove
from solidgear.cuts.features.relief import Relief
from solidgear.cuts.features.toothed import Spline, Teeth

#: angle, rad, up to which gaps of two sets of teeth lie behind each other
SAME_ANGLE = 1e-9
#: turned into a cylinder
GROOVES = (Groove, Relief)


def meeting_problems(
    segments: Sequence[Segment], features: Sequence[Any]
) -> Iterator[tuple[int, SceneError]]:
    """Yield problems of teeth, bolt circles and grooves that cannot share a place, each with the number of
    the feature whose fields it names.
    """
    segment_named = {s.name: s for s in segments}
    for (_, a), (j, b) in combinations(enumerate(features), 2):
        if a.segment != b.segment:
            continue
        if a.toothed and b.toothed:
            yield (
                j,
                SceneError(
                    f'"{b.segment}" has the {a.what} "{a.name}" already, and carries one set of '
                    "them; divide the segment in two",
                    path=("segment",),
                ),
            )
        elif isinstance(a, BoltCircle) and isinstance(b, BoltCircle):
            if _touch(a, b, segment_named[b.segment]):
                yield (
                    j,
                    SceneError(f'the holes run into those of "{a.name}"', path=("circle",)),
                )
        elif isinstance(a, GROOVES) and isinstance(b, GROOVES):
            (lo, hi), (first, last) = a.span(segments), b.span(segments)
            if min(hi, last) - max(lo, first) > TOUCH:
                place = "side" if isinstance(b, Relief) else "y"
                reason = (
                    f"the {b.what} reaches from {first:.6g} to {last:.6g} m, into the {a.what} "
                    f'"{a.name}" ({lo:.6g} to {hi:.6g} m)'
                )
                yield j, SceneError(reason, path=(place,))
        elif a.toothed != b.toothed and BoltCircle in (type(a), type(b)):
            teeth, bolts = (a, b) if a.toothed else (b, a)
            reason = "" if teeth.smeared else _in_teeth(teeth, bolts, segment_named[b.segment])
            if reason:
                yield features.index(bolts), SceneError(reason, path=("circle",))


def _touch(a: BoltCircle, b: BoltCircle, segment: Segment) -> bool:
    """Return True where holes of two circles run into each other."""
    (lo, hi), (first, last) = a.reach(segment), b.reach(segment)
    if min(hi, last) <= max(lo, first):
        return False
    # angles between holes repeat themselves after the common part of both pitches
    common = 2 * math.pi / math.lcm(a.count, b.count)
    angle = (b.angle - a.angle + common / 2) % common - common / 2
    ra, rb = a.circle / 2, b.circle / 2
    distance = math.sqrt(max(ra * ra + rb * rb - 2 * ra * rb * math.cos(angle), 0.0))
    return distance < (a.diameter + b.diameter) / 2 + SMALLEST * segment.outer0


def _in_teeth(teeth: Teeth | Spline, bolts: BoltCircle, segment: Segment) -> str:
    """Return the reason why holes do not fit a segment with resolved teeth; empty without one."""
    if teeth.spiral_angle:
        return (
            f'"{segment.name}" has the spiral {teeth.what} "{teeth.name}", along which its mesh is '
            "twisted, and straight holes would be with it; give the holes a segment of their own"
        )
    low = min(segment.outer0, segment.outer1)
    root = teeth.land * low
    reach = (bolts.circle + bolts.diameter) / 2
    if reach > root - SMALLEST * low:
        return (
            f"the holes reach {reach:.6g} m from the axis, into the {teeth.what} "
            f'"{teeth.name}", whose roots lie at {root:.6g} m'
        )
    return ""


def no_common_sector(features: Sequence[Any], count: int | None = None) -> str:
    """Return the reason why features have no common sector around the axis, in `count` sectors or as
    many as possible; empty without one.

    Examples
    --------
    >>> from solidgear.cuts.features import Spline
    >>> a, b = (Spline(name=n, segment=n, count=c) for n, c in (("a", 12), ("b", 14)))
    >>> no_common_sector([a, b])[:32]
    '12 of spline "a" and 14 of splin'
    >>> no_common_sector([a])
    ''
    """
    count = count or math.gcd(*(f.count for f in features))
    if count < FEWEST or any(f.count % count for f in features):
        counts = " and ".join(f'{f.count} of {f.what} "{f.name}"' for f in features)
        return (
            f"{counts} have no sector of a third of a turn or less in common: "
            "there is no cyclic symmetry to use"
        )
    toothed = [f for f in features if f.toothed]
    for teeth in toothed[1:]:
        pitch = 2 * math.pi / teeth.count
        offset = (middle(teeth, count) - middle(toothed[0], count) + pitch / 2) % pitch - pitch / 2
        if abs(offset) > SAME_ANGLE:
            # in as many digits as it takes to be the same angle when written down
            right = math.degrees((teeth.angle - offset) % pitch)
            return (
                f'the gaps of {teeth.what} "{teeth.name}" do not lie behind those of the other '
                f"teeth: no sector border runs between both; write angle = "
                f'"{right:.11g} deg" for it'
            )
    return ""


def middle(teeth: Teeth | Spline, count: int) -> float:
    """Return the angle (rad) of the middle of a sector whose borders run between teeth."""
    # with an even number of teeth in a sector its middle lies between two of them
    return teeth.angle + (math.pi / teeth.count if teeth.count // count % 2 == 0 else 0.0)


def mirror_angle(features: Sequence[Any], count: int) -> float | None:
    """Return the angle (rad) of a mirror plane of all features through the middle of one of `count`
    sectors; None for spiral teeth and for holes that lie unevenly to teeth or other holes.

    Borders of sectors run between teeth, so that teeth decide; bolt circles alone have the plane
    through a hole, or the one between two.

    Examples
    --------
    >>> bolts = BoltCircle(name="b", segment="s", count=6, diameter=0.01, circle=0.1, angle=0.3)
    >>> mirror_angle([bolts], 6)
    0.3
    >>> mirror_angle([bolts, bolts.with_changes(name="c", circle=0.2, angle=0.4)], 6) is None
    True
    """
    toothed = [f for f in features if f.toothed]
    if any(teeth.spiral_angle for teeth in toothed):
        return None
    holes = [f for f in features if not f.toothed]
    if toothed:
        planes = [middle(toothed[0], count)]
    elif holes:
        first = holes[0]
        planes = [first.angle + k * math.pi / first.count for k in range(2 * first.count // count)]
    else:
        planes = [0.0]
    return next((a for a in planes if all(_even(f, a) for f in holes)), None)


def _even(holes: BoltCircle, plane: float) -> bool:
    """Return True where a plane through the axis runs through a hole or between two."""
    half = math.pi / holes.count
    offset = (plane - holes.angle + half / 2) % half - half / 2
    return abs(offset) < SAME_ANGLE
