"""Clearance at work: class, fits and temperature.

A fit widens the inner ring, or narrows the outer one, by Lame's thick rings.  With one
material throughout, a ring of inner diameter d and raceway F that is pressed with an interference I
on a shaft with a bore b widens at its raceway by

    I (d / F) (1 - (b/d)^2) / (1 - (b/F)^2),

which is ``I d / F`` on a solid shaft (Harris and Kotzalas, Essential Concepts, ch. 3; it follows
from equal radial stress and the interference shared at d).  A housing is taken as very thick: the
ring narrows by ``I G / D`` at the raceway G.
"""

from __future__ import annotations

import math

from solidgear.bearings.catalogue import Catalogue
from solidgear.bearings.inside import Inside
from solidgear.core import SceneError

#: 1/K, bearing steel
EXPANSION = 11.5e-6

_BORES = (0, 10, 14, 18, 24, 30, 40, 50, 65, 80, 100, 120, 140, 160, 180, 200)
#: ISO 5753-1:2009, radial internal clearance in micrometres by bore over .. up to and including; a
#: dash for none.  CM is that of electric motors, which NSK and NTN print beside them.
_BALLS = {
    "C2": "0-7 0-9 0-9 0-10 1-11 1-11 1-11 1-15 1-15 1-18 2-20 2-23 2-23 2-25 2-30",
    "CN": "2-13 3-18 3-18 5-20 5-20 6-20 6-23 8-28 10-30 12-36 15-41 18-48 18-53 20-61 25-71",
    "C3": "8-23 11-25 11-25 13-28 13-28 15-33 18-36 23-43 25-51 30-58 36-66 41-81 46-91 53-102 63-117",
    "C4": "14-29 18-33 18-33 20-36 23-41 28-46 30-51 38-61 46-71 53-84 61-97 71-114 81-130 91-147 107-163",
    "C5": "20-37 25-45 25-45 28-48 30-53 40-64 45-73 55-90 65-105 75-120 90-140 105-160 120-180 135-200 "
    "150-230",
    "CM": "- 4-11 4-11 5-12 5-12 9-17 9-17 12-22 12-22",
}
_ROLLERS = {
    "C2": "0-25 0-25 0-25 0-25 0-25 5-30 5-35 10-40 10-45 15-50 15-55 15-60 20-70 25-75 35-90",
    "CN": "20-45 20-45 20-45 20-45 20-45 25-50 30-60 40-70 40-75 50-85 50-90 60-105 70-120 75-125 90-145",
    "C3": "35-60 35-60 35-60 35-60 35-60 45-70 50-80 60-90 65-100 75-110 85-125 100-145 115-165 120-170 "
    "140-195",
    "C4": "50-75 50-75 50-75 50-75 50-75 60-85 70-100 80-110 90-125 105-140 125-165 145-190 165-215 "
    "170-220 195-250",
    "C5": "65-90 65-90 65-90 65-90 70-95 80-105 95-125 110-140 130-165 155-190 180-220 200-245 225-275 "
    "250-300 275-330",
}
_SPHERICAL = {
    "C2": "- - 10-20 10-20 15-25 15-30 20-35 20-40 30-50 35-60 40-75 50-95 60-110 65-120 70-130",
    "CN": "- - 20-35 20-35 25-40 30-45 35-55 40-65 50-80 60-100 75-120 95-145 110-170 120-180 130-200",
    "C3": "- - 35-45 35-45 40-55 45-60 55-75 65-90 80-110 100-135 120-160 145-190 170-220 180-240 "
    "200-260",
    "C4": "- - 45-60 45-60 55-75 60-80 75-100 90-120 110-145 135-180 160-210 190-240 220-280 240-310 "
    "260-340",
    "C5": "- - 60-75 60-75 75-95 80-100 100-125 120-150 145-180 180-225 210-260 240-300 280-350 310-390 "
    "340-430",
}
#: of two rows of balls on a sphere
_SELF_ALIGNING = {
    "C2": "2-9 2-10 3-12 4-14 5-16 6-18 6-19 7-21 8-24 9-27 10-31 10-38 15-44",
    "CN": "6-17 6-19 8-21 10-23 11-24 13-29 14-31 16-36 18-40 22-48 25-56 30-68 35-80",
    "C3": "12-25 13-26 15-28 17-30 19-35 23-40 25-44 30-50 35-60 42-70 50-83 60-100 70-120",
    "C4": "19-33 21-35 23-37 25-39 29-46 34-53 37-57 45-69 54-83 64-96 75-114 90-135 110-161",
    "C5": "27-42 30-48 32-50 34-52 40-58 46-66 50-71 62-88 76-108 89-124 105-145 125-175 150-210",
}
#: classes by kind; other kinds have none
TABLES = {
    "deep_groove": _BALLS,
    "cylindrical": _ROLLERS,
    "needle": _ROLLERS,
    "spherical": _SPHERICAL,
    "self_aligning": _SELF_ALIGNING,
}
#: classes along the shaft by kind (ISO 5753-2, DIN 628), with their bores
_FOUR_POINT = {
    "C2": "20-60 30-70 40-90 50-100 60-120 70-140 80-160 100-180",
    "CN": "50-90 60-110 80-130 90-140 100-160 120-180 140-200 160-220",
    "C3": "80-120 100-150 120-170 130-180 140-200 160-220 180-240 200-260",
}
_TWO_ROWS = {
    "C2": "1-11 1-12 2-14 2-15 2-16 2-18 3-22 3-24 3-26 4-30",
    "CN": "5-21 6-23 7-25 8-27 9-29 11-33 13-36 15-40 18-46 22-53",
    "C3": "12-28 13-31 16-34 18-37 21-40 23-44 26-48 30-54 35-63 42-73",
}
AXIAL = {
    "four_point": (_FOUR_POINT, (0, 18, 40, 60, 80, 100, 140, 180, 220)),
    "double_row_angular": (_TWO_ROWS, (0, 10, 18, 24, 30, 40, 50, 65, 80, 100, 110)),
}


def clearance_range(data: Catalogue) -> tuple[float, float]:
    """Return the least and largest internal clearance before mounting, m, equal if it is given as a
    length; refuse a class of a bearing that has none. It is radial, but along the shaft for classes
    of two rows of balls against each other and of four points.
    """
    if not isinstance(data.clearance, str):
        return data.clearance, data.clearance
    kind, name = data.kind.replace("_", " "), data.clearance
    table, edges = AXIAL.get(data.kind, (TABLES.get(data.kind), _BORES))
    if table is None:
        instead = "a length, or a preload" if data.nature.holds == "one way" else "a length"
        raise SceneError(
            f"{kind} bearings have no clearance class; write {instead}", path=("clearance",)
        )
    ranges = table.get(name, "").split()
    bore = data.bore * 1e3
    place = sum(bore > edge + 1e-9 for edge in edges[1:])
    if place >= len(ranges) or ranges[place] == "-":
        known = [k for k, range_ in enumerate(ranges) if range_ != "-"]
        span = f", from {edges[known[0]]} to {edges[known[-1] + 1]} mm of bore" if known else ""
        raise SceneError(
            f"{name} of {kind} bearings is not known here at a bore of {bore:g} mm{span}; write a "
            "length",
            path=("clearance",),
        )
    low, high = ranges[place].split("-")
    return round(float(low) * 1e-6, 9), round(float(high) * 1e-6, 9)


def is_axial(data: Catalogue) -> bool:
    """Return whether the clearance is a class along the shaft."""
    return isinstance(data.clearance, str) and data.kind in AXIAL


def across_shaft(axial: float, inside: Inside) -> float:
    """Return the radial clearance of balls that touch after the shaft has moved half of an axial
    clearance, m: ``axial tan(a)`` where it is small beside the distance of the grooves' centres.
    """
    free = (sum(inside.conformity) - 1) * inside.diameter
    risen = min(free * math.sin(inside.angle) + axial / 2, free)
    return 2 * (free * math.cos(inside.angle) - math.sqrt(free**2 - risen**2))


def mounting_change(data: Catalogue, inside: Inside) -> float:
    """Return the change of the clearance by fits and temperature, m; negative for a tight fit or a
    warm shaft.
    """
    reach = inside.diameter * math.cos(inside.angle)
    inner, outer = inside.pitch - reach, inside.pitch + reach
    # interference only: a loose fit changes nothing
    on_shaft = max(data.shaft_interference, 0.0) * data.bore / inner
    in_housing = max(data.housing_interference, 0.0) * outer / data.outer_diameter
    # elements half way between the rings' temperatures
    warm = EXPANSION * data.inner_ring_warmer * (inner + reach)
    return -(on_shaft + in_housing + warm)


def clearance_at_work(data: Catalogue, inside: Inside, share: float = 0.5) -> float:
    """Return the radial internal clearance once mounted and warm, m, at a place in the range of the
    class, 0 to 1.
    """
    low, high = clearance_range(data)
    clearance = low + share * (high - low)
    if is_axial(data):
        clearance = across_shaft(clearance, inside)
    return clearance + mounting_change(data, inside)
