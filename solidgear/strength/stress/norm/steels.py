"""Groups of steels of DIN 743: how strength falls with size, and strengths by name.

K_1 of DIN 743-2, equations 10 to 14, as two public programs have it (see
:mod:`solidgear.strength.stress.norm.tested`). Strengths are those of DIN 743-3, tables A.1, A.3 and
A.4, of a test bar, where both programs agree (editions of 2000 and 2024).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from solidgear.core.scene import Segment
from solidgear.core.scene.parts import SteelGroup, Strength

#: m, above which the norm gives no K_1
LARGEST = 0.5


class Fall(NamedTuple):
    """How strength falls with the diameter of heat treatment."""

    start: float  #: m, up to which it is that of the test bar
    slope: float  #: over the decimal logarithm of the diameter
    end: float  #: m, from which it is constant
    least: float


BAR = 16e-3
_CASE = Fall(BAR, 0.41, 0.150, 0.6)
_NICKEL = Fall(BAR, 0.26, 0.300, 0.67)
_THICK = Fall(0.100, 0.23, 0.300, 0.89)
#: of tensile strength and of the yield point, by group
FALLS: dict[SteelGroup, tuple[Fall, Fall]] = {
    "construction": (_THICK, Fall(2 * BAR, 0.26, 0.300, 0.75)),
    "tempering": (_NICKEL, Fall(BAR, 0.34, 0.300, 0.57)),
    "case_hardening": (_CASE, _CASE),
    "case_hardening_crnimo": (_NICKEL, _NICKEL),
    "nitriding": (_THICK, _THICK),
}
#: name: group, tensile strength and yield point, MPa
STEELS: dict[str, tuple[SteelGroup, float, float]] = {
    "S235": ("construction", 360, 235),
    "S275": ("construction", 410, 275),
    "S355": ("construction", 470, 355),
    "E295": ("construction", 470, 295),
    "E335": ("construction", 570, 335),
    "E360": ("construction", 670, 360),
    "C45": ("tempering", 700, 490),
    "C60": ("tempering", 850, 580),
    "34CrMo4": ("tempering", 1000, 800),
    "42CrMo4": ("tempering", 1100, 900),
    "50CrMo4": ("tempering", 1100, 900),
    "34CrNiMo6": ("tempering", 1200, 1000),
    "16MnCr5": ("case_hardening", 1000, 695),
    "20MnCr5": ("case_hardening", 1200, 850),
    "18CrNiMo7-6": ("case_hardening_crnimo", 1200, 850),
}


def size_factor(fall: Fall, diameter: float) -> float:
    """Return K_1 at a diameter of heat treatment, m.

    Examples
    --------
    >>> [round(size_factor(FALLS["tempering"][0], d), 3) for d in (0.01, 0.05, 0.4)]
    [1.0, 0.871, 0.67]
    """
    if diameter <= fall.start:
        return 1.0
    if diameter >= fall.end:
        return fall.least
    return 1 - fall.slope * math.log10(diameter / fall.start)


def size_factors(group: SteelGroup, diameter: float) -> tuple[float, float]:
    """Return K_1 of the tensile strength and of the yield point (DIN 743-2, equations 10 to 14).

    Examples
    --------
    >>> [round(k, 3) for k in size_factors("tempering", 0.08)]
    [0.818, 0.762]
    """
    ultimate, yields = FALLS[group]
    return size_factor(ultimate, diameter), size_factor(yields, diameter)


def least_size_factors(diameter: float) -> tuple[float, float]:
    """Return the least K_1 of tensile strength and of yield point over all groups.

    Examples
    --------
    >>> [round(k, 3) for k in least_size_factors(0.08)]
    [0.713, 0.713]
    """
    factors = [size_factors(group, diameter) for group in FALLS]
    return min(first for first, _ in factors), min(second for _, second in factors)


def source_of(segment: Segment) -> str:
    """Return where the strength of a segment comes from."""
    material = segment.material
    return "material" if material.strength is not None else f"DIN 743-3: {material.name}"


def strength_of(segment: Segment) -> Strength | None:
    """Return the strength of a segment: that of its material, or of a steel of its name; None
    without.

    Examples
    --------
    >>> rod = Segment.cylinder("rod", length=0.1, diameter=0.04, material="42CrMo4")
    >>> strength_of(rod).group
    'tempering'
    """
    material = segment.material
    if material.strength is not None or material.name not in STEELS:
        return material.strength
    group, ultimate, yields = STEELS[material.name]
    return Strength(yield_point=1e6 * yields, ultimate=1e6 * ultimate, group=group)
