"""Holes along the axis: where they lie in a sector, and element sizes at them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, pi, sin, sqrt
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.meshing.element_size import _num
from solidgear.cuts.sector.teeth import turn_at
from solidgear.cuts.solid.cuts import ACROSS, GROWTH

if TYPE_CHECKING:
    from solidgear.core.scene.parts import Segment
    from solidgear.cuts.features.bolt_circle import BoltCircle
    from solidgear.cuts.features.toothed import Toothed

Place = tuple[float, float]
#: share of the section that holes take from which elements at them are refined as all others are.
#: The error of elements at a hole is of second order and counts by that share: the edge may grow with
#: its root. Eight edges instead of sixteen around holes of 0.7 and 3 % changed no number by 1e-4
FULL_SHARE = 0.1


@dataclass(frozen=True)
class Hole:
    """Holes of a bolt circle and the edge of elements at them, m."""

    #: circle, radius: radius of the circle of middles, and of a hole
    circle: float
    radius: float
    #: lo, hi: ends along the axis
    lo: float
    hi: float
    count: int  #: on the circle
    least: float  #: element edge on the wall


def hole_of(bolts: BoltCircle, segment: Segment, refinement: float) -> Hole:
    """Return the holes of a bolt circle in a segment, with the element edge that a refinement asks
    of them.
    """
    # a circle of fewer than eight edges is no hole
    area = bolts.count * bolts.diameter**2 / 4
    share = area / (min(segment.outer0, segment.outer1) ** 2 - segment.inner0**2)
    divided = ACROSS * refinement * min(1.0, sqrt(share / FULL_SHARE))
    least = pi * bolts.diameter / 8 / max(1.0, divided)
    lo, hi = bolts.reach(segment)
    return Hole(bolts.circle / 2, bolts.diameter / 2, lo, hi, bolts.count, least)


def hole_places(
    bolts: BoltCircle,
    segment: Segment,
    twists: list[tuple[Segment, Toothed]],
    first: float,
    reach: float,
) -> list[Place]:
    """Return the middles (x, z) of holes in the straight sector, whose middle looks to +z, m.

    `twists` turn the sections later, `first` is the angle of the middle of the sector in the shaft,
    and `reach` the angle from there up to which holes are wanted, rad.

    Examples
    --------
    >>> from solidgear import Segment
    >>> from solidgear.cuts.features import BoltCircle
    >>> disc = Segment.cylinder("disc", length=0.02, diameter=0.2)
    >>> four = BoltCircle(name="b", segment="disc", count=4, diameter=0.01, circle=0.1)
    >>> [len(hole_places(four, disc, [], 0.0, t)) for t in (0.1, 1.6)]
    [1, 3]
    """
    lo, hi = bolts.reach(segment)
    start = bolts.angle - first - float(turn_at(np.array([(lo + hi) / 2]), twists)[0])
    angles = [(start + 2 * pi * k / bolts.count + pi) % (2 * pi) - pi for k in range(bolts.count)]
    r = bolts.circle / 2
    return [(r * sin(t), r * cos(t)) for t in angles if abs(t) < reach]


def hole_size(hole: Hole, places: Sequence[Place]) -> str:
    """Return a formula (in x, y, z, m) of the element edge at holes: fine at their walls, growing
    with the distance from the nearest of some middles (x, z).
    """
    away = ""
    for x, z in places:
        distance = f"Sqrt((x-{_num(x)})^2+(z-{_num(z)})^2)"
        away = f"Min({distance},{away})" if away else distance
    across = f"Max(0,{away}-{_num(hole.radius)})"
    along = f"Max(0,Max({_num(hole.lo)}-y,y-{_num(hole.hi)}))"
    return f"{_num(hole.least)}+{_num(GROWTH)}*Sqrt({across}^2+{along}^2)"


def fine_lines(hole: Hole) -> tuple[float, float, float]:
    """Return holes as edges that elements grow from: see
    :func:`solidgear.core.meshing.element_size.rough_cells`.
    """
    # around a wall of radius a there are a growth / least as many more as along a line
    wider = 1 + hole.radius * GROWTH / hole.least
    return 2 * hole.count * (hole.hi - hole.lo) * wider, hole.least, GROWTH
