"""Goals and limits of a search, and their numbers in the rows of a design."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from solidgear.core import SceneError, SolidgearError, show
from solidgear.core.scene.units import quantity, si_factor
from solidgear.show.units import ENGINEERING
from solidgear.variants.sweep.curves import FORCE, MISALIGNMENT, misalignment_unit
from solidgear.variants.sweep.entries import amount, plain_number
from solidgear.variants.sweep.life_numbers import BASIC, HOURS, LIFE, STATIC
from solidgear.variants.sweep.scene_task import MOST_MODES, STATICS
from solidgear.variants.sweep.shaft_numbers import LOADS, LOCAL, MOVED, SAFETIES
from solidgear.variants.sweep.tooth_numbers import TOOTH_UNITS

#: rows of a design: of a shaft one, of a train one for each operating point
Rows = Sequence[dict[str, Any]]

_GOAL = re.compile(r"\s*(?P<sense>max|min)(?:imi[sz]e)?\s+(?P<name>.+?)\s*", re.I)
_KEEP = re.compile(r"\s*(?P<name>.+?)\s*(?P<sense>[<>])=?\s*(?P<value>.+?)\s*")
#: natural frequencies by their numbers
FIRST = re.compile(r"f(?P<number>[1-9]\d*)")


@dataclass(frozen=True)
class Wish:
    """A number of a design that should be large or small, or stay beyond a limit."""

    name: str  #: column of a sweep, ``f1``, or a mode such as ``bending 1``
    upward: bool  #: large is good
    limit: float | None = None  #: SI; None of a goal

    def value(self, rows: Rows) -> tuple[float, float | None] | None:
        """Return the worst value of a design over its rows and the error bar of it, SI, of a
        misalignment its size; None where a row has no number, or bar.
        """
        values = []
        for row in rows:
            column = self._column(row)
            if row.get(column) is None:
                return None
            number = float(row[column])
            # a misalignment has a direction, and either is as bad
            size = abs(number) if column.startswith(MISALIGNMENT) else number
            values.append((size, row.get(f"{column} bar")))
        worst = min if self.upward else max
        return worst(values, key=lambda number: number[0])

    def _column(self, row: dict[str, Any]) -> str:
        if first := FIRST.fullmatch(self.name):
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

    @property
    def unit(self) -> str:
        """Unit of the number in SI, as of :class:`solidgear.show.units.Units`; empty for a ratio."""
        return unit_of(self.name)

    def __str__(self) -> str:
        if self.limit is None:
            return f"{'max' if self.upward else 'min'} {self.name}"
        limit = ENGINEERING.text(self.limit, self.unit).strip()
        return f"{self.name} {'>' if self.upward else '<'} {limit}"


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
    name = match["name"]
    if name == LIFE and match["value"].endswith((" h", " hours")):
        name = HOURS
    try:
        limit = _limit_in_si(name, match["value"])
    except SceneError as error:
        raise SolidgearError(f"`keep` {show(text, 40)}: {error}") from None
    return Wish(name, match["sense"] == ">", limit)


def _limit_in_si(name: str, value: str) -> float:
    if (number := plain_number(value)) is not value:
        return float(number)
    unit = unit_of(name).partition(" moved")[0].partition(" stressed")[0]
    if unit in ("kg", "Hz"):
        return quantity(value, "mass" if unit == "kg" else "frequency")
    if unit in ("h", "rev"):
        match = amount(value)
        if match is None or match[2] not in (unit, *WORDS[unit]):
            raise SceneError(f"write a number, or one in {unit}", value=show(value))
        return float(match[1])
    return _in_si(value, unit)


#: units of lives in words
WORDS = {"h": ("hours",), "rev": ("revolutions",)}
#: units of columns by their names, by their beginnings, and by their endings
NAMED = {
    "mass": "kg",
    LIFE: "rev",
    BASIC: "rev",
    HOURS: "h",
    "torque": "N m",
    LOCAL: "Pa stressed",
    **dict.fromkeys((STATIC, *SAFETIES), ""),
    **TOOTH_UNITS,
}
BEGINNINGS = {FORCE: "N", **{f"{moved}_": unit for moved, unit in MOVED.items()}, **TOOTH_UNITS}
ENDINGS = {
    "_force": "N",
    f".{LIFE}": "rev",
    f".{STATIC}": "",
    **{f".{load}": unit for load, unit in LOADS.items()},
}


def unit_of(name: str) -> str:
    """Return the SI unit of a number of a design; Hz of any that is no column.

    Examples
    --------
    >>> unit_of("deflection_pinion"), unit_of("pinion.A.radial"), unit_of("bending 1")
    ('m moved', 'N', 'Hz')
    """
    static = next((q for q in STATICS if str(q) == name), None)
    if static is not None:
        return static.unit
    column = name.replace(" ", "_")
    if column in NAMED:
        return NAMED[column]
    if column.startswith(MISALIGNMENT):
        return misalignment_unit(column.removeprefix(f"{MISALIGNMENT}_").replace("_", " "))
    for beginning, unit in BEGINNINGS.items():
        if column.startswith(beginning):
            return unit
    return next((unit for ending, unit in ENDINGS.items() if column.endswith(ending)), "Hz")


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
