"""Units that a schema knows, and numbers with a unit as regular expressions.

Expressions use nothing but groups, alternatives and repetitions, which the engines of all editors
read.  Readers of files know more units (:mod:`solidgear.core.scene.units`).
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from solidgear.core import Range
from solidgear.core.scene.units import DIMENSIONS, LARGEST, TURNS


def _any(*words: str) -> str:
    return f"(?:{'|'.join(words)})"


_LENGTH = _any("[kcmuµn]?m", "in", "inch", "ft", "thou")
_ANGLE = _any("m?rad", "urad", "µrad", "deg", "degree", "arcmin", "arcsec")
_FORCE = _any("[kMm]?N", "daN", "lbf", "kgf")
_MASS = _any("[km]?g", "t", "lb")
_TIME = _any("m?s", "min")
_TIMES = r"(?: ?\* ?| )"
_SQUARE, _CUBE = _any(r"\^2", r"\*\*2"), _any(r"\^3", r"\*\*3")
_AREA = _any(f"{_LENGTH}{_SQUARE}", "[kcmuµn]?m2")
_VOLUME = _any(f"{_LENGTH}{_CUBE}", "[kcmuµn]?m3")
#: without a sign between them
_NM = "[kM]?N[mc]?m"
_MOMENT = _any(f"{_FORCE}{_TIMES}{_LENGTH}", _NM)
#: units by dimension
UNITS = {
    "length": _LENGTH,
    "angle": _ANGLE,
    "pressure": _any("[kMG]?Pa", "bar", "psi", "ksi", f"{_FORCE}/{_AREA}"),
    "density": f"{_MASS}/{_VOLUME}",
    "force_per_length": f"{_FORCE}/{_LENGTH}",
    "force": f"{_FORCE}(?:/{_ANGLE})?",
    "moment": f"{_MOMENT}(?:/{_ANGLE})?",
    "mass": _MASS,
    "inertia": f"{_MASS}{_TIMES}{_AREA}",
    "frequency": "[kM]?Hz",
    "load": _FORCE,
    "torque": _MOMENT,
    "speed": _any("rpm", *(word.replace("^", r"\^") for word in TURNS), f"{_ANGLE}/{_TIME}"),
    "viscosity": _any(f"{_AREA}/{_TIME}", "c?St"),
    "temperature": "m?K",
    "time": _any("h", "hours?", "min", "s"),
    "power": _any("[kM]?W", "hp"),
    "dimensionless": "%",
}
_EXPONENT = "(?:[eE][+-]?[0-9]+)?"
_UNSIGNED = r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)"
#: with a digit that is not zero
_ABOVE_ZERO = r"(?:0*[1-9][0-9]*\.?[0-9]*|0*\.0*[1-9][0-9]*)"
_BLANK = r"[ \t]*"


def text_of(dimension: str, ranges: Iterable[Range] = ()) -> str:
    """Return the regular expression of a number with a unit; of ranges it keeps the sign."""
    least = max((r.least for r in ranges), default=-LARGEST)
    above = max((r.above for r in ranges), default=-LARGEST)
    number = f"[+-]?{_UNSIGNED}"
    if above >= 0 or least > 0:
        number = rf"\+?{_ABOVE_ZERO}"
    elif least == 0:
        number = rf"\+?{_UNSIGNED}"
    unit = f"{_BLANK}{UNITS[dimension]}"
    if not DIMENSIONS[dimension][0]:
        unit = f"(?:{unit})?"
    return f"{_BLANK}{number}{_EXPONENT}{unit}{_BLANK}"


def number_of(ranges: Iterable[Range]) -> dict[str, Any]:
    """Return the bounds of a number in SI."""
    whole = [Range("", least=-LARGEST, most=LARGEST), *ranges]
    least, above = max(r.least for r in whole), max(r.above for r in whole)
    most, below = min(r.most for r in whole), min(r.below for r in whole)
    low = {"minimum": least} if least > above else {"exclusiveMinimum": above}
    high = {"maximum": most} if most < below else {"exclusiveMaximum": below}
    return low | high


def words_on_unit(si: str) -> str:
    """Return a sentence on how a file writes a quantity by its SI unit; of plain ratios by none."""
    examples = {unit: example for unit, example, _ in DIMENSIONS.values()}
    number = f"A number in {si}, or a text with a unit" if si else "A number, or a text"
    return f'{number} such as "{examples[si]}".'
