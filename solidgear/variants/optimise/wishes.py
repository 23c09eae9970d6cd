"""Goals and limits in words: ``max bending 1``, ``C_zz < 5 um/kN``."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Any

from solidgear.core.errors import SceneError, SolidgearError, show
from solidgear.core.scene.units import quantity, si_factor
from solidgear.variants.sweep.amounts import amount
from solidgear.variants.sweep.scene_task import MOST_MODES, STATICS
from solidgear.variants.sweep.spans import plain_number

_GOAL = re.compile(r"\s*(?P<sense>max|min)(?:imi[sz]e)?\s+(?P<name>.+?)\s*", re.I)
_KEEP = re.compile(r"\s*(?P<name>.+?)\s*(?P<sense>[<>])=?\s*(?P<value>.+?)\s*")
_FIRST = re.compile(r"f(?P<number>[1-9]\d*)")


@dataclass(frozen=True)
class Wish:
    """A number of a design that is to be large or small, or to stay beyond a limit."""

    name: str  #: ``mass``, a compliance or stiffness, ``f1``, or a mode such as ``bending 1``
    upward: bool  #: large is good
    limit: float | None = None  #: SI; None of a goal

    def of(self, row: dict[str, Any]) -> tuple[float, float | None] | None:
        """Value of a design and its bar, SI; None where it has no number, or no bar."""
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
        """Amount missing to a limit, bar included, relative to it; none or less is kept."""
        told = self.of(row)
        if told is None or self.limit is None:
            return math.inf
        value, bar = told[0], told[1] or 0.0
        short = self.limit - (value - bar) if self.upward else (value + bar) - self.limit
        return short / abs(self.limit or 1.0)

    def __str__(self) -> str:
        if self.limit is None:
            return f"{'max' if self.upward else 'min'} {self.name}"
        return f"{self.name} {'>' if self.upward else '<'} {self.limit:.6g}"


def wish_of(text: str) -> Wish:
    """A goal from ``max bending 1``."""
    found = _GOAL.fullmatch(text)
    if found is None:
        raise SolidgearError(
            f'--goal {show(text, 40)}: write "max NUMBER" or "min NUMBER", such as "max bending 1"'
        )
    return Wish(found["name"], found["sense"].lower() == "max")


def limit_of(text: str) -> Wish:
    """A limit from ``C_zz < 5 um/kN``."""
    found = _KEEP.fullmatch(text)
    if found is None:
        raise SolidgearError(
            f'--keep {show(text, 40)}: write NUMBER < VALUE, such as "C_zz < 5 um/kN" or "f1 > 600 Hz"'
        )
    name = found["name"]
    return Wish(name, found["sense"] == ">", _in_unit_of(name, found["value"], text))


def _in_unit_of(name: str, value: str, text: str) -> float:
    """A limit in SI."""
    if (plain := plain_number(value)) is not value:
        return float(plain)
    known = next((q for q in STATICS if str(q) == name), None)
    try:
        if known is None:
            return quantity(value, "mass" if name == "mass" else "frequency")
        return _static(value, known.unit)
    except SceneError as error:
        raise SolidgearError(f"--keep {show(text, 40)}: {error}") from None


def _static(value: str, wanted: str) -> float:
    """A compliance or stiffness in SI, which any unit of its dimension will do for."""
    found = amount(value)
    if found is None:
        raise SceneError(f"{show(value)} is no number with a unit")
    number, unit = found.groups()
    own, si = si_factor(unit), si_factor(wanted)
    if own is None or si is None or own[2] != si[2]:
        raise SceneError(f"{unit!r} is no unit of what is told in {wanted}")
    return float(number) * own[0]
