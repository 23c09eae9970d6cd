"""The section of trapezoid teeth, how they turn along the axis, and element sizes at features."""

from __future__ import annotations

from math import cos, hypot, pi
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.meshing.element_size import _num
from solidgear.core.scene.closed_form import integrals_along
from solidgear.cuts.features.toothed import arc
from solidgear.cuts.solid.cuts import ACROSS, GROWTH

if TYPE_CHECKING:
    from solidgear.core.scene.parts import Segment
    from solidgear.cuts.features.toothed import Toothed


def outline(teeth: Toothed, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return corners of the section of one of `count` sectors, from one cut face to the other:
    angles from the middle, rad, and radii over the pitch radius.

    Examples
    --------
    >>> from solidgear.cuts.features import Teeth
    >>> angle, radius = outline(Teeth(name="t", segment="head", count=14), 14)
    >>> len(angle), bool(abs(angle[-1] - np.pi / 14) < 1e-12)
    (6, True)
    """
    pitch, many = 2 * pi / teeth.count, teeth.count // count
    tip = [(t, teeth.tip) for t in arc(teeth.tip_half)]
    tooth = [(-teeth.root_half, teeth.root), *tip, (teeth.root_half, teeth.root)]
    # between the ends of a land, which are corners of teeth
    land = [(t, teeth.root) for t in arc(teeth.land_half)[1:-1]]
    border = pitch * many / 2
    # cut planes meet the middle of a chord
    corners = [(-border, teeth.land)]
    for j in range(many):
        gap = pitch * j - border
        corners += [(gap + t, r) for t, r in land if j or t > 0]
        corners += [(gap + pitch / 2 + t, r) for t, r in tooth]
    corners += [(border + t, r) for t, r in land if t < 0]
    angle, radius = np.array([*corners, (border, teeth.land)]).T
    return angle, radius


def half_outline(teeth: Toothed, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return corners of the section of half a sector, from the middle to a cut face, as of
    :func:`outline`.

    Examples
    --------
    >>> from solidgear.cuts.features import Teeth
    >>> angle, radius = half_outline(Teeth(name="t", segment="head", count=14), 14)
    >>> len(angle), float(angle[0])
    (4, 0.0)
    """
    angle, radius = outline(teeth, count)
    past_middle = angle > 0.0
    # a tip or a land: the plane meets the middle of a chord
    k = int(np.argmax(past_middle))
    return np.r_[0.0, angle[past_middle]], np.r_[radius[k] * cos(angle[k]), radius[past_middle]]


def section_area(teeth: Toothed) -> float:
    """Return the area of a toothed section of unit pitch radius, closed form.

    Examples
    --------
    >>> from solidgear.cuts.features import Teeth
    >>> low = Teeth(name="t", segment="s", count=300, addendum=1e-6, dedendum=1e-6)
    >>> abs(section_area(low) / pi - 1) < 1e-3
    True
    """
    angle, radius = outline(teeth, teeth.count)
    triangles = radius[1:] * radius[:-1] * np.sin(np.diff(angle)) / 2
    return float(teeth.count * triangles.sum())


def section_polar(teeth: Toothed) -> float:
    """Return the polar second moment of area of a toothed section of unit pitch radius, closed
    form.

    Examples
    --------
    >>> from solidgear.cuts.features import Teeth
    >>> low = Teeth(name="t", segment="s", count=300, addendum=1e-6, dedendum=1e-6)
    >>> abs(section_polar(low) / (pi / 2) - 1) < 1e-3
    True
    """
    angle, radius = outline(teeth, teeth.count)
    x, z = radius * np.sin(angle), radius * np.cos(angle)
    # triangles from the axis
    twice = radius[1:] * radius[:-1] * np.sin(np.diff(angle))
    square = radius[:-1] ** 2 + radius[1:] ** 2 + x[:-1] * x[1:] + z[:-1] * z[1:]
    return float(teeth.count * (twice * square).sum() / 12)


def lacking(teeth: Toothed, segment: Segment) -> tuple[float, float]:
    """Return mass, kg, and polar inertia, kg m^2, that a toothed segment has beyond the cone; below
    zero where the cone has more.
    """
    square, _, _, fourth = integrals_along(segment.length, segment.outer0, segment.outer1)
    return (
        segment.material.density * (section_area(teeth) - pi) * square,
        segment.material.density * (section_polar(teeth) - pi / 2) * fourth,
    )


def turn_at(y: np.ndarray, twists: list[tuple[Segment, Toothed]]) -> np.ndarray:
    """Return the angle about +y, rad, by which spiral teeth on segments have turned the sections at
    places y, m: zero at the start of the shaft, and constant outside the teeth.

    Examples
    --------
    A lead of half a turn in a helix of 45 degrees:

    >>> from solidgear import Segment
    >>> from solidgear.cuts.features import Spline
    >>> rod = Segment.cylinder("rod", length=0.1 * pi, diameter=0.2)
    >>> helix = Spline(name="h", segment="rod", count=20, spiral_angle="45 deg")
    >>> round(float(turn_at(np.array([1.0]), [(rod, helix)])[0] / pi), 6)
    1.0
    """
    out = np.zeros(np.shape(y))
    for s, teeth in twists:
        along = np.clip(y, s.y0, s.y1) - s.y0
        slope = (s.outer1 - s.outer0) / (s.y1 - s.y0)
        if abs(slope) < 1e-12:
            out += teeth.twist * along / s.outer0
        else:
            out += teeth.twist * hypot(1.0, slope) / slope * np.log1p(slope * along / s.outer0)
    return out


def tooth_size(teeth: Toothed, segment: Segment, refinement: float) -> str:
    """Return a formula (in x, y, z, m) of the element edge at teeth: a part of their height in the
    section that refinement divides, growing inwards.
    """
    share = (teeth.tip - teeth.root) / (ACROSS * refinement)
    slope = (segment.outer1 - segment.outer0) / (segment.y1 - segment.y0)
    inside = f"Max({_num(segment.y0)},Min({_num(segment.y1)},y))"
    pitch = f"({_num(segment.outer0)}+{_num(slope)}*({inside}-{_num(segment.y0)}))"
    below = f"Max(0,{_num(teeth.root)}*{pitch}-Sqrt(x^2+z^2))"
    outside = f"(y-{inside})"
    return f"{_num(share)}*{pitch}+{_num(GROWTH)}*Sqrt({below}^2+{outside}^2)"
