"""Tools of features: the solid of OCC that one cuts out of a shaft, and its formula of element
size.
"""

from __future__ import annotations

from math import cos, pi, sin, sqrt
from typing import TYPE_CHECKING, Any

from solidgear.meshing.element_size import _num

if TYPE_CHECKING:
    from solidgear.scene.features import CrossHole, CutFeature

#: elements across the smaller size of a feature, at the size asked for
ACROSS = 2.0
#: and as many times more at its re-entrant edges, where those are graded towards. On the keyed pinion
#: 15,000 unknowns give C_zz to 1.7e-4 so, where 18,000 without gave it to 2.8e-4
EDGES = 3.0
#: refinement from which on a hole has more than eight edges around where sizes are graded towards edges
LEAST = 0.35
#: growth of the element size per distance from a feature
GROWTH = 1.0
#: how far a tool reaches beyond the surface, in radii
BEYOND = 0.2


def tool(occ: Any, feature: CutFeature, radius: float) -> int:
    """The solid that cuts a feature.

    Parameters
    ----------
    occ : module
        ``gmsh.model.occ``.
    feature : Keyway, Flat or CrossHole
    radius : float
        Outer radius of its segment, m.

    Returns
    -------
    int
        Tag of the volume; it reaches out of the shaft, and is not yet cut with it.
    """
    lo, hi = feature.reach
    top = BEYOND * radius
    if feature.kind == "cross_hole":
        made = occ.addCylinder(
            0, feature.y, -radius - top, 0, 0, 2 * (radius + top), feature.diameter / 2
        )
    elif feature.kind == "flat":
        floor = radius - feature.depth
        wide = 2 * (radius + top)
        made = occ.addBox(-wide / 2, lo, floor, wide, hi - lo, radius + top - floor)
    else:
        made = _slot(occ, feature, radius - feature.depth, feature.depth + top)
    if feature.angle:
        occ.rotate([(3, made)], 0, 0, 0, 0, 1, 0, feature.angle)
    return made


def _slot(occ, key, floor: float, height: float) -> int:
    """A keyway drawn on its floor and pulled outwards."""
    lo, hi = key.reach
    half = key.width / 2
    a, b = (lo + half, hi - half) if key.ends == "round" else (lo, hi)
    points = [occ.addPoint(x, y, floor) for x, y in ((-half, a), (half, a), (half, b), (-half, b))]
    sides = [occ.addLine(points[1], points[2]), occ.addLine(points[3], points[0])]
    if key.ends == "round":
        ends = []
        for first, middle, last, y, tip in (
            (points[0], None, points[1], a, lo),
            (points[2], None, points[3], b, hi),
        ):
            centre, middle = occ.addPoint(0, y, floor), occ.addPoint(0, tip, floor)
            ends.append(
                [occ.addCircleArc(first, centre, middle), occ.addCircleArc(middle, centre, last)]
            )
        loop = [*ends[0], sides[0], *ends[1], sides[1]]
    else:
        loop = [
            occ.addLine(points[0], points[1]),
            sides[0],
            occ.addLine(points[2], points[3]),
            sides[1],
        ]
    face = occ.addPlaneSurface([occ.addCurveLoop(loop)])
    return next(tag for dim, tag in occ.extrude([(2, face)], 0, 0, height) if dim == 3)


def volume(feature: CutFeature, outer: float, inner: float) -> float | None:
    """Volume that a feature takes from its segment, where a closed form is known.

    Parameters
    ----------
    feature : Keyway, Flat or CrossHole
    outer, inner : float
        Radii of the segment, m.

    Returns
    -------
    float or None
        m^3; None for a cross hole through a wall, or a cut down to a bore.

    Examples
    --------
    A flat down to nearly the axis is nearly half of the cylinder:

    >>> from solidgear.scene import Flat
    >>> deep = Flat(name="flat", segment="rod", y=0.0, length=1.0, depth=0.1 - 1e-9)
    >>> round(volume(deep, 0.1, 0.0) / (pi * 0.1**2), 6)
    0.5
    """
    from scipy.integrate import quad

    if feature.kind == "cross_hole":
        return None
    floor = outer - feature.depth
    if floor < inner:
        return None

    def height(x):
        return sqrt(outer**2 - x * x) - floor

    if feature.kind == "flat":
        half = sqrt(outer**2 - floor**2)
        return 2 * quad(height, 0, half, epsabs=0, epsrel=1e-12)[0] * feature.length
    half = feature.width / 2

    def along(x):
        if feature.ends == "square":
            return feature.length
        return feature.length - 2 * half + 2 * sqrt(half**2 - x * x)

    return 2 * quad(lambda x: height(x) * along(x), 0, half, epsabs=0, epsrel=1e-12)[0]


def feature_size(
    feature: CutFeature, radius: float, refinement: float, finer: float = 1.0
) -> tuple[str, float]:
    """Formula of the element edge around a feature, and its least value.

    Parameters
    ----------
    feature : Keyway, Flat or CrossHole
    radius : float
        Of its segment, m.
    refinement : float
        Divides the size.
    finer : float
        Divides it too, and the largest that a hole or a round end may have.

    Returns
    -------
    formula : str
        In x, y, z, m.
    least : float
        m.
    """
    lo, hi = feature.reach
    across, up = _towards(feature)
    along = f"Max(0,Max({_num(lo)}-y,y-{_num(hi)}))"
    if feature.kind == "cross_hole":
        least, distance = pi * feature.diameter / 8, _from_hole(feature)
    else:
        floor = radius - feature.depth
        wide = feature.width / 2 if feature.kind == "keyway" else sqrt(radius**2 - floor**2)
        least = min(feature.depth, wide) if feature.kind == "keyway" else wide / 2
        below = f"Max(0,{_num(floor)}-{up})"
        beside = f"Max(0,{across}-{_num(wide)})"
        distance = f"Sqrt({below}^2+{beside}^2+{along}^2)"
    divided = ACROSS * refinement
    # a circle of fewer than eight edges is no hole: it loses a fifteenth of its volume; nor is half
    # of one of fewer than four the end of a keyway, which five leave room for
    least = least / (max(1.0, divided) if feature.kind == "cross_hole" else divided)
    if feature.kind == "keyway" and feature.ends == "round":
        least = min(least, pi * feature.width / 10 / max(1.0, divided))
    least /= finer
    return f"{_num(least)}+{_num(GROWTH)}*{distance}", least


def edge_size(feature: CutFeature, radius: float, refinement: float) -> tuple[str, float]:
    """Formula of the element edge where stresses around a feature are highest: at the re-entrant
    edges of the floor of a keyway and of the ends of a flat, at the wall of a hole.

    Parameters
    ----------
    feature : Keyway, Flat or CrossHole
    radius : float
        Of its segment, m.
    refinement : float
        Divides the size.

    Returns
    -------
    formula : str
        In x, y, z, m.
    least : float
        m. That of a hole, which eight edges around are the least of, differs from refinement
        ``LEAST`` on.

    Examples
    --------
    >>> from solidgear.scene import Flat
    >>> flat = Flat(name="flat", segment="rod", y=0.1, length=0.03, depth=0.006)
    >>> round(edge_size(flat, 0.03, 1.0)[1], 12)
    0.001
    """
    if feature.kind == "cross_hole":
        least = pi * feature.diameter / (8 * max(1.0, refinement / LEAST))
        return f"{_num(least)}+{_num(GROWTH)}*{_from_hole(feature)}", least
    lo, hi = feature.reach
    across, up = _towards(feature)
    floor = radius - feature.depth
    if feature.kind == "flat":
        half = sqrt(radius**2 - floor**2)
        ends = f"Min(Sqrt((y-{_num(lo)})^2),Sqrt((y-{_num(hi)})^2))"
        away = f"Sqrt({ends}^2+Max(0,{across}-{_num(half)})^2)"
    else:
        half = feature.width / 2
        if feature.ends == "round":
            beyond = f"Max(0,Max({_num(lo + half)}-y,y-{_num(hi - half)}))"
            away = f"(Sqrt({across}^2+{beyond}^2)-{_num(half)})"
        else:
            aside, beyond = f"({across}-{_num(half)})", f"Max({_num(lo)}-y,y-{_num(hi)})"
            outside = f"Sqrt(Max(0,{aside})^2+Max(0,{beyond})^2)"
            away = f"({outside}+Min(0,Max({aside},{beyond})))"
    least = min(feature.depth, half) / (ACROSS * EDGES * refinement)
    return f"{_num(least)}+{_num(GROWTH)}*Sqrt({away}^2+({up}-{_num(floor)})^2)", least


def _towards(feature: CutFeature) -> tuple[str, str]:
    """Formulas of the distance from the middle plane of a feature, and of the height towards it."""
    c, s = _num(cos(feature.angle)), _num(sin(feature.angle))
    return f"Sqrt((x*{c}-z*{s})^2)", f"(z*{c}+x*{s})"


def _from_hole(hole: CrossHole) -> str:
    """Formula of the distance from the wall of a cross hole."""
    off = f"Sqrt({_towards(hole)[0]}^2+(y-{_num(hole.y)})^2)"
    return f"Max(0,{off}-{_num(hole.diameter / 2)})"


def mirror_plane(features: tuple[CutFeature, ...]) -> int | None:
    """The plane that all features are symmetric about.

    Parameters
    ----------
    features : tuple of Keyway, Flat or CrossHole

    Returns
    -------
    int or None
        0 for the plane x = 0, 2 for the plane z = 0; None where there is neither.

    Examples
    --------
    >>> from solidgear.scene import CrossHole
    >>> mirror_plane((CrossHole(name="oil", segment="rod", y=0.1, diameter=0.01),))
    0
    """
    for plane, first in ((0, 0.0), (2, pi / 2)):
        # towards either side, or a hole across, which is as symmetric
        quarter = [(feature.angle - first) / (pi / 2) for feature in features]
        straight = [abs(q - round(q)) < 1e-9 for q in quarter]
        own = [ok and round(q) % 2 == 0 for ok, q in zip(straight, quarter)]
        across = [ok and f.kind == "cross_hole" for ok, f in zip(straight, features)]
        if all(a or b for a, b in zip(own, across)):
            return plane
    return None
