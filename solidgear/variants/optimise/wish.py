"""Goals and limits of a search, and their numbers in the rows of a design."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from solidgear.core import SceneError, SolidgearError, show
from solidgear.core.scene.units import quantity, si_factor
from solidgear.variants.sweep.curves import FORCE, MISALIGNMENT, misalignment_unit
from solidgear.variants.sweep.entries import amount, plain_number
from solidgear.variants.sweep.scene_task import MOST_MODES, STATICS
from solidgear.variants.sweep.tooth_numbers import TOOTH_UNITS

#: rows of a design: of a shaft one, of a train one for each operating point
Rows = Sequence[dict[str, Any]]

_GOAL = re.compile(r"\s*(?P<sense>max|min)(?:imi[sz]e)?\s+(?P<name>.+?)\s*", re.I)
_KEEP = re.compile(r"\s*(?P<name>.+?)\s*(?P<sense>[<>])=?\s*(?P<value>.+?)\s*")
_FIRST = re.compile(r"f(?P<number>[1-9]\d*)")


@dataclass(frozen=True)
class Wish:
    """A number of a design that should be large or small, or stay beyond a limit."""

    name: str  #: ``mass``, a compliance or stiffness, ``f1``, or a mode such as ``bending 1``
    upward: bool  #: large is good
    limit: float | None = None  #: SI; None of a goal

    def value(self, rows: Rows) -> tuple[float, float | None] | None:
        """Return the worst value of a design over its rows and the error bar of it, SI; None where a
        row has no number, or bar.
        """
        values = []
        for row in rows:
            column = self._column(row)
            if row.get(column) is None:
                return None
            values.append((float(row[column]), row.get(f"{column} bar")))
        worst = min if self.upward else max
        return worst(values, key=lambda number: number[0])

    def _column(self, row: dict[str, Any]) -> str:
        if first := _FIRST.fullmatch(self.name):
            return f"f{first['number']}_hz"
        for k in range(1, MOST_MODES + 1):
            if row.get(f"mode{k}") == self.name:
                return f"f{k}_hz"
        return self.name if self.name in row else self.name.replace(" ", "_")

    def missing(self, rows: Rows) -> float:
        """Compute the distance beyond a limit, error bar included, relative to it; 0 and less is
        kept.
        """
        number = self.value(rows)
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
            f'`goal` {show(text, 40)}: write "max NUMBER" or "min NUMBER", such as "max bending 1"'
        )
    return Wish(match["name"], match["sense"].lower() == "max")


def limit_of(text: str) -> Wish:
    """Read a limit such as ``C_zz < 5 um/kN``."""
    match = _KEEP.fullmatch(text)
    if match is None:
        raise SolidgearError(
            f'`keep` {show(text, 40)}: write NUMBER < VALUE, such as "C_zz < 5 um/kN" or "f1 > 600 Hz"'
        )
    try:
        limit = _limit_in_si(match["name"], match["value"])
    except SceneError as error:
        raise SolidgearError(f"`keep` {show(text, 40)}: {error}") from None
    return Wish(match["name"], match["sense"] == ">", limit)


def _limit_in_si(name: str, value: str) -> float:
    if (number := plain_number(value)) is not value:
        return float(number)
    unit = _unit_of(name)
    if unit is not None:
        return _in_si(value, unit)
    return quantity(value, "mass" if name == "mass" else "frequency")


#: endings of columns of trains, and their units
ENDINGS = {".radial": "N", ".axial": "N", "_force": "N", ".moment": "N*m"}


def _unit_of(name: str) -> str | None:
    """Return the SI unit of a compliance or stiffness of a shaft, or of a column of a train; None for
    masses and frequencies.
    """
    static = next((q for q in STATICS if str(q) == name), None)
    if static is not None:
        return static.unit
    column = name.replace(" ", "_")
    if column.startswith(MISALIGNMENT):
        number = column.removeprefix(f"{MISALIGNMENT}_").replace("_", " ")
        return misalignment_unit(number).removesuffix(" moved")
    if column.startswith(FORCE):
        return "N"
    for number, unit in (*TOOTH_UNITS.items(), *ENDINGS.items()):
        if column.startswith(number) or column.endswith(number):
            return unit.removesuffix(" moved").removesuffix(" stressed")
    return None


def _in_si(value: str, si_unit: str) -> float:
    """Return a number in SI, from any unit of its dimension."""
    match = amount(value)
    if match is None:
        raise SceneError(f"{show(value)} is not a number with a unit")
    number, unit = match.groups()
    factor, si = si_factor(unit), si_factor(si_unit)
    if factor is None or si is None or factor[2] != si[2]:
        raise SceneError(f"{unit!r} is not a unit of a number in {si_unit}")
    return float(number) * factor[0]
