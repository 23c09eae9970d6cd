"""Numbers of books as they are printed: their digits say how sure they are."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

import solidgear as sg
from validation.manual.case import Reference, references

INCH, POUND = 0.0254, 4.4482216152605
POUND_INCH = INCH * POUND
LIMITS = "the last printed digit"
SHIGLEY = "Shigley's Mechanical Engineering Design, 9th edition"
STEEL = "E 206.8 GPa (30e6 psi), Poisson's ratio 0.292; statics does not depend on them."
EXACT = "exact statics gives the printed digits"
#: unknowns of a rigid shaft
EQUATIONS = 6


def half_digit(text: str) -> float:
    """Half a unit of the last printed digit, relative to the number.

    Examples
    --------
    >>> round(half_digit("2.50"), 4), round(half_digit("24.89e3"), 6)
    (0.002, 0.000201)
    """
    digits, _, power = text.partition("e")
    decimals = len(digits.partition(".")[2])
    return 0.5 * 10.0 ** (int(power or 0) - decimals) / abs(float(text))


def printed(
    values: Mapping[str, str], unit: str, source: str, limits: str = LIMITS
) -> tuple[Reference, ...]:
    """References whose uncertainty is that of their digits."""
    return tuple(
        reference
        for name, text in values.items()
        for reference in references(
            {name: float(text)}, unit, "literature", source, half_digit(text), limits
        )
    )


def to_the_digits(values: Mapping[str, str], units: float = 0.5) -> dict[str, float]:
    """Tolerances of so many units of the last printed digit; half a unit is the same digits."""
    return {name: 2 * units * half_digit(text) for name, text in values.items()}


def reactions(scene: sg.Scene, axes: str, unit: float) -> dict[str, float]:
    """Forces of the bearings on the shaft by name and axis, in a unit."""
    shaft = sg.deflect(scene, "euler").judge.shafts[0]
    return {
        f"F_{bearing.name} {axis}": float(-force / unit)
        for bearing in shaft.bearings
        for axis, force in zip(axes, bearing.load[:3])
    }


def moments(six: np.ndarray) -> tuple[float, float, float]:
    """Bending moments in both planes and together, lbf in."""
    across, up = abs(six[5]) / POUND_INCH, abs(six[3]) / POUND_INCH
    return across, up, math.hypot(across, up)
