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

_BORES = (10, 18, 24, 30, 40, 50, 65, 80, 100, 120)
#: ISO 5753-1:2009, radial internal clearance in micrometres by bore over .. up to; below 10 mm the
#: first holds
_BALLS = {
    "C2": "0-9 0-10 1-11 1-11 1-11 1-15 1-15 1-18 2-20",
    "CN": "3-18 5-20 5-20 6-20 6-23 8-28 10-30 12-36 15-41",
    "C3": "11-25 13-28 13-28 15-33 18-36 23-43 25-51 30-58 36-66",
    "C4": "18-33 20-36 23-41 28-46 30-51 38-61 46-71 53-84 61-97",
}
_ROLLERS = {
    "C2": "0-25 0-25 0-25 5-30 5-35 10-40 10-45 15-50 15-55",
    "CN": "20-45 20-45 20-45 25-50 30-60 40-70 40-75 50-85 50-90",
    "C3": "35-60 35-60 35-60 45-70 50-80 60-90 65-100 75-110 85-125",
    "C4": "50-75 50-75 50-75 60-85 70-100 80-110 90-125 105-140 125-165",
}
_SPHERICAL = {
    "C2": "10-20 10-20 15-25 15-30 20-35 20-40 30-50 35-60 40-75",
    "CN": "20-35 20-35 25-40 30-45 35-55 40-65 50-80 60-100 75-120",
    "C3": "35-45 35-45 40-55 45-60 55-75 65-90 80-110 100-135 120-160",
    "C4": "45-60 45-60 55-75 60-80 75-100 90-120 110-145 135-180 160-210",
}
#: classes by kind; other kinds have none
TABLES = {
    "deep_groove": _BALLS,
    "cylindrical": _ROLLERS,
    "needle": _ROLLERS,
    "spherical": _SPHERICAL,
}


def clearance_range(data: Catalogue) -> tuple[float, float]:
    """Return the least and largest radial internal clearance before mounting, m, equal if it is
    given as a length; refuse a class of a bearing that has none.
    """
    if not isinstance(data.clearance, str):
        return data.clearance, data.clearance
    table = TABLES.get(data.kind)
    if table is None:
        instead = "a length, or a preload" if data.nature.holds == "one way" else "a length"
        raise SceneError(
            f"{data.kind.replace('_', ' ')} bearings have no clearance class; write {instead}",
            path=("clearance",),
        )
    bore = data.bore * 1e3
    place = sum(bore > edge + 1e-9 for edge in _BORES[1:])
    if place >= len(_BORES) - 1:
        raise SceneError(
            f"classes are known up to a bore of {_BORES[-1]} mm; write a length",
            path=("clearance",),
        )
    low, high = table[data.clearance].split()[place].split("-")
    return round(float(low) * 1e-6, 9), round(float(high) * 1e-6, 9)


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
    return low + share * (high - low) + mounting_change(data, inside)
