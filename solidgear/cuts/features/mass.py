"""Mass that features take from a shaft, or that teeth add to it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import combinations
from math import cos, pi, sin
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.core import TOUCH
from solidgear.core.models.kinds import CUTS
from solidgear.core.scene.closed_form import integrals_along
from solidgear.core.scene.own_mass import Beside
from solidgear.cuts.features.cut import Cut, Long

if TYPE_CHECKING:
    from solidgear.core.scene.parts import Segment


@lru_cache(maxsize=64)
def mass_beside(segments: Sequence[Segment], features: Sequence[Any]) -> tuple[Beside, ...]:
    """Return the masses that features take away and add, one for each, or for cuts that meet."""
    by_name = {segment.name: segment for segment in segments}
    out = []
    for feature in features:
        if feature.sort != CUTS:
            out.append(_around(feature, by_name[feature.segment]))
    for cuts in _meeting([f for f in features if f.sort == CUTS], segments):
        segment = by_name[cuts[0].segment]
        volume, centre = _drawn(cuts, segment) if len(cuts) > 1 else _cut(cuts[0], segment)
        ends = [end for cut in cuts for end in cut.reach(segment.outer0)]
        mass = -segment.material.density * volume
        out.append(Beside(mass, mass * np.array(centre), min(ends), max(ends)))
    return tuple(out)


def _around(feature: Any, segment: Segment) -> Beside:
    """Return the mass of teeth beside the cone of their segment, or that of holes."""
    density = segment.material.density
    if feature.toothed:
        from solidgear.cuts.sector.teeth import section_area  # slow to import, and seldom needed

        square, first, *_ = integrals_along(segment.length, segment.outer0, segment.outer1)
        mass = density * (section_area(feature) - pi) * square
        moment = density * (section_area(feature) - pi) * first + mass * segment.y0
        lo, hi = segment.y0, segment.y1
    else:
        lo, hi = feature.reach(segment)
        mass = -density * feature.count * pi * feature.diameter**2 / 4 * (hi - lo)
        moment = mass * (lo + hi) / 2
    return Beside(mass, np.array([0.0, moment, 0.0]), lo, hi)


def _cut(cut: Cut, segment: Segment) -> tuple[float, tuple[float, float, float]]:
    """Return the volume of a cut, m^3, and its centre, m."""
    volume = cut.volume(segment.outer0, segment.inner0)
    if volume is None:
        return _drawn([cut], segment)
    side, up = cut.centre(segment.outer0, segment.inner0)
    lo, hi = cut.reach(segment.outer0)
    c, s = cos(cut.angle), sin(cut.angle)
    return volume, (side * c + up * s, (lo + hi) / 2, up * c - side * s)


def _meeting(cuts: Sequence[Cut], segments: Sequence[Segment]) -> Iterator[list[Cut]]:
    """Yield cuts of a segment that may share material, and others one by one."""
    groups = [[cut] for cut in cuts]
    for a, b in combinations(cuts, 2):
        group, other = (next(g for g in groups if cut in g) for cut in (a, b))
        if group is not other and _may_meet(a, b, segments):
            groups.remove(other)
            group += other
    yield from groups


def _may_meet(a: Cut, b: Cut, segments: Sequence[Segment]) -> bool:
    """Return False for cuts one behind the other, and for slots on different sides of the shaft."""
    if a.segment != b.segment:
        return False
    (lo, hi), (first, last) = a.span(segments), b.span(segments)
    if min(hi, last) - max(lo, first) <= TOUCH:
        return False
    if not (isinstance(a, Long) and isinstance(b, Long)):
        return True
    radius = next(s.outer0 for s in segments if s.name == a.segment)
    apart = abs((a.angle - b.angle + pi) % (2 * pi) - pi)
    # a slot is widest, seen from the axis, at its floor
    return apart < sum(float(np.arctan2(f.half_width(radius), f.floor(radius))) for f in (a, b))


def _drawn(cuts: Sequence[Cut], segment: Segment) -> tuple[float, tuple[float, float, float]]:
    """Return the volume that cuts take together, m^3, and its centre, m, as the kernel of the mesher has
    them.
    """
    # slow to import, and seldom needed
    from solidgear.core.meshing.gmsh_session import Session, import_gmsh

    # slow to import, and seldom needed
    from solidgear.cuts.solid.cuts import tool

    gmsh = import_gmsh()
    with Session(gmsh):
        occ = gmsh.model.occ
        wall = [(3, occ.addCylinder(0, segment.y0, 0, 0, segment.length, 0, segment.outer0))]
        if segment.inner0:
            bore = occ.addCylinder(0, segment.y0, 0, 0, segment.length, 0, segment.inner0)
            wall, _ = occ.cut(wall, [(3, bore)])
        tools = [(3, tool(occ, cut, segment.outer0)) for cut in cuts]
        if len(tools) > 1:
            tools, _ = occ.fuse(tools[:1], tools[1:])
        pieces, _ = occ.intersect(wall, tools)
        volumes = np.array([occ.getMass(3, tag) for _, tag in pieces])
        centres = np.array([occ.getCenterOfMass(3, tag) for _, tag in pieces])
    x, y, z = volumes @ centres / volumes.sum()
    return float(volumes.sum()), (float(x), float(y), float(z))
