"""Goals and limits in words: ``max bending 1``, ``C_zz < 5 um/kN``."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Any

from solidgear.core import SceneError, SolidgearError, show
from solidgear.core.scene.units import quantity, si_factor
from solidgear.variants.sweep.amounts import amount
from solidgear.variants.sweep.scene_task import MOST_MODES, STATICS
from solidgear.variants.sweep.spans import plain_number

_GOAL = re.compile(r"\s*(?P<sense>max|min)(?:imi[sz]e)?\s+(?P<name>.+?)\s*", re.I)
_KEEP = re.compile(r"\s*(?P<name>.+?)\s*(?P<sense>[<>])=?\s*(?P<value>.+?)\s*")
_FIRST = re.compile(r"f(?P<number>[1-9]\d*)")


@dataclass(frozen=True)
class Wish:
    """A number of a design that should be large or small, or stay beyond a limit."""

    name: str  #: ``mass``, a compliance or stiffness, ``f1``, or a mode such as ``bending 1``
    upward: bool  #: large is good
    limit: float | None = None  #: SI; None of a goal

    def value(self, row: dict[str, Any]) -> tuple[float, float | None] | None:
        """Return the value of a design and its error bar, SI; None where it has no number, or bar."""
        column = self._column(row)
        value = row.get(column)
        if value is None:
            return None
        return float(value), row.get(f"{column} bar")

    def _column(self, row: dict[str, Any]) -> str:
        if first := _FIRST.fullmatch(self.name):
            return f"f{first['number']}_hz"
        for k in range(1, MOST_MODES + 1):
            if row.get(f"mode{k}") == self.name:
                return f"f{k}_hz"
        return self.name

    def missing(self, row: dict[str, Any]) -> float:
        """Compute the distance beyond a limit, error bar included, relative to it; 0 and less is
        kept.
        """
        number = self.value(row)
        if number is None or self.limit is None:
            return math.inf
        value, bar = number[0], number[1] or 0.0
        short = self.limit - (value - bar) if self.upward else (value + bar) - self.limit
        return short / abs(self.limit or 1.0)

    def __str__(self) -> str:
        if self.limit is None:
            return f"{'max' if self.upward else 'min'} {self.name}"
        return f"{self.name} {'>' if self.upward else '<'} {self.limit:.6g}"


def wish_of(text: str) -> Wish:
    """Read a goal such as ``max bending 1``."""
    match = _GOAL.fullmatch(text)
    if match is None:
        raise SolidgearError(
            f'--goal {show(text, 40)}: write "max NUMBER" or "min NUMBER", such as "max bending 1"'
        )
    return Wish(match["name"], match["sense"].lower() == "max")


def limit_of(text: str) -> Wish:
    """Read a limit such as ``C_zz < 5 um/kN``."""
    match = _KEEP.fullmatch(text)
    if match is None:
        raise SolidgearError(
            f'--keep {show(text, 40)}: write NUMBER < VALUE, such as "C_zz < 5 um/kN" or "f1 > 600 Hz"'
        )
    name = match["name"]
    return Wish(name, match["sense"] == ">", _limit_in_si(name, match["value"], text))


def _limit_in_si(name: str, value: str, text: str) -> float:
    if (number := plain_number(value)) is not value:
        return float(number)
    static = next((q for q in STATICS if str(q) == name), None)
    try:
        if static is None:
            return quantity(value, "mass" if name == "mass" else "frequency")
        return _static_in_si(value, static.unit)
    except SceneError as error:
        raise SolidgearError(f"--keep {show(text, 40)}: {error}") from None


def _static_in_si(value: str, si_unit: str) -> float:
    """Return a compliance or stiffness in SI, from any unit of its dimension."""
    match = amount(value)
    if match is None:
        raise SceneError(f"{show(value)} is not a number with a unit")
    number, unit = match.groups()
    factor, si = si_factor(unit), si_factor(si_unit)
    if factor is None or si is None or factor[2] != si[2]:
        raise SceneError(f"{unit!r} is not a unit of a number in {si_unit}")
    return float(number) * factor[0]
