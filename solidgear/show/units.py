"""Units in which tables and pages are read: a customer's, SI, or pounds and inches.

Results are SI inside and in every JSON; only what a person reads is converted, here and nowhere
else. Factors are exact by definition: 1 in = 25.4 mm, 1 lbf = 4.4482216152605 N (NIST SP 811,
appendix B).
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from solidgear.core import SolidgearError, nearest
from solidgear.show.words import DASH, engineering, is_number

if TYPE_CHECKING:
    import numpy as np

INCH, POUND = 0.0254, 4.4482216152605
#: kg in a pound of mass, exact as well
POUND_MASS = 0.45359237
#: between groups of three digits: the page must not break a number there
GROUP = "\u00a0"
#: letter -> how terminals that know none but ASCII have it
ASCII = str.maketrans({"µ": "u", GROUP: " ", "±": "+-", "–": "-"})
#: sizes, as powers of ten, that are written without an exponent
SMALLEST, LARGEST = -3, 8


@dataclass(frozen=True)
class Units:
    """A choice of units."""

    name: str  #: what ``--units`` calls it
    about: str  #: the choice in a few words
    #: SI unit -> its name here, and how many of it make one of SI; those left out stay as they are.
    #: ``m moved`` is a metre of motion, which is read finer than one of length; ``rad moved`` is
    #: the like of angles, ``Pa stressed`` a stress, which is far below a modulus, and ``N/m along`` a
    #: force per length of a line, which is no stiffness.
    of: Mapping[str, tuple[str, float]]
    #: whether numbers carry exponents (multiples of three) or all their digits
    exponents: bool = False

    @property
    def title(self) -> str:
        """The choice at the head of a table."""
        return "SI" if self is SI else f"{self.name.upper() if self is US else self.name} units"

    def unit(self, si: str) -> str:
        """Return the name of an SI unit here."""
        return self.of.get(si, (si, 1.0))[0]

    def value(self, value: float | None, si: str) -> float | None:
        """Return a value of SI in this unit."""
        return value * self.of.get(si, (si, 1.0))[1] if is_number(value) else None

    def values(self, values: np.ndarray, si: str) -> np.ndarray:
        """Return values of SI in this unit."""
        return values * self.of.get(si, (si, 1.0))[1]

    def number(self, value: float | None, si: str, digits: int = 5) -> str:
        """Return a value of SI in this unit, without its name.

        Examples
        --------
        >>> ENGINEERING.number(4.7105e9, "N/m"), ENGINEERING.number(5.9612e-10, "m/N")
        ('4710.5', '0.59612')
        """
        converted = self.value(value, si)
        if self.exponents:
            return engineering(converted, digits)
        return plain(converted, digits)

    def given(self, value: float | None, si: str) -> str:
        """Return a number of a scene as it was written, without zeros behind it."""
        converted = self.value(value, si)
        if converted is None:
            return DASH
        written = f"{converted:.6g}"
        return engineering(converted, 4) if "e" in written else written

    def fitting(self, values: Iterable[float], si: str) -> Units:
        """Return these units with a prefix that suits the largest of some values.

        Examples
        --------
        >>> small = ENGINEERING.fitting([2.495e-13, 1e-14], "m/N")
        >>> small.text(2.495e-13, "m/N", 4), small.text(1e-14, "m/N", 4)
        ('249.5 pm/kN', '10.00 pm/kN')
        """
        name, factor = self.of.get(si, (si, 1.0))
        top = max((abs(v) * factor for v in values), default=0.0)
        if self.exponents or not name.startswith("µm") or not 0 < top < 10.0**SMALLEST:
            return self
        prefix, finer = ("n", 1e3) if top * 1e3 >= 1 else ("p", 1e6)
        return replace(self, of={**self.of, si: (prefix + name[1:], factor * finer)})

    def text(self, value: float | None, si: str, digits: int = 5) -> str:
        """Return the number with its unit."""
        number = self.number(value, si, digits)
        return number if number == DASH else f"{number} {self.unit(si)}"


def plain(value: float | None, digits: int = 5) -> str:
    """Return a number with all its digits, in groups of three from five digits on."""
    if not is_number(value):
        return DASH
    if value == 0:
        return "0"
    value = float(f"{value:.{digits - 1}e}")
    size = math.floor(math.log10(abs(value)) + 1e-12)
    if not SMALLEST <= size <= LARGEST:
        return engineering(value, digits)
    text = f"{value:,.{max(digits - 1 - size, 0)}f}"
    return text.replace(",", GROUP if size >= 4 else "")


def digits_for(bar: float | None, least: int = 3, most: int = 6) -> int:
    """Return the figures that a number with this relative error bar deserves."""
    if not is_number(bar) or bar <= 0:
        return most - 1
    return min(max(round(-math.log10(bar)) + 1, least), most)


def in_ascii(text: str) -> str:
    """Return a text for terminals without Greek letters and groups of digits."""
    # between digits it groups; elsewhere it keeps a unit on one line
    ungrouped = re.sub(rf"(?<=\d){GROUP}(?=\d)", "", text)
    return ungrouped.translate(ASCII)


ENGINEERING = Units(
    "engineering",
    "N/um, um/kN, N m/rad, mm",
    {
        "N/m": ("N/µm", 1e-6),
        "N/m along": ("N/mm", 1e-3),
        "N/rad": ("kN/rad", 1e-3),
        "m/N": ("µm/kN", 1e9),
        "rad/N": ("µrad/kN", 1e9),
        "rad/(N m)": ("µrad/(kN m)", 1e9),
        "m/(N m)": ("µm/(N m)", 1e6),
        "m": ("mm", 1e3),
        "m moved": ("µm", 1e6),
        "rad moved": ("µrad", 1e6),
        "Pa": ("GPa", 1e-9),
        "Pa stressed": ("MPa", 1e-6),
    },
)
SI = Units(
    "si",
    "N/m, m/N, N m/rad; lengths in mm",
    {
        "N/m along": ("N/m", 1.0),
        "m": ("mm", 1e3),
        "m moved": ("m", 1.0),
        "rad moved": ("rad", 1.0),
        "Pa stressed": ("Pa", 1.0),
    },
    exponents=True,
)
US = Units(
    "us",
    "lbf/in, uin/lbf, lbf in/rad, in",
    {
        "N/m": ("lbf/in", INCH / POUND),
        "N/m along": ("lbf/in", INCH / POUND),
        "N/rad": ("lbf/rad", 1 / POUND),
        "N m/rad": ("lbf in/rad", 1 / (POUND * INCH)),
        "m/N": ("µin/lbf", 1e6 * POUND / INCH),
        "rad/N": ("µrad/lbf", 1e6 * POUND),
        "rad/(N m)": ("µrad/(lbf in)", 1e6 * POUND * INCH),
        "m/(N m)": ("µin/(lbf in)", 1e6 * POUND),
        "m": ("in", 1 / INCH),
        "m moved": ("µin", 1e6 / INCH),
        "rad moved": ("µrad", 1e6),
        "m/s²": ("in/s²", 1 / INCH),
        "kg": ("lb", 1 / POUND_MASS),
        "kg/m³": ("lb/in³", INCH**3 / POUND_MASS),
        "kg m": ("lb in", 1 / (POUND_MASS * INCH)),
        "kg m²": ("lb in²", 1 / (POUND_MASS * INCH**2)),
        "N m": ("lbf in", 1 / (POUND * INCH)),
        "Pa": ("ksi", 1e-3 * INCH**2 / POUND),
        "Pa stressed": ("ksi", 1e-3 * INCH**2 / POUND),
        "N": ("lbf", 1 / POUND),
    },
)
SYSTEMS = {units.name: units for units in (ENGINEERING, SI, US)}


def plain_unit(si: str) -> str:
    """Return an SI unit without the word that says what is measured in it.

    Examples
    --------
    >>> plain_unit("Pa stressed"), plain_unit("N/m along"), plain_unit("N m/rad")
    ('Pa', 'N/m', 'N m/rad')
    """
    return si.removesuffix(" moved").removesuffix(" stressed").removesuffix(" along")


def units_named(name: str | Units) -> Units:
    """Return a choice of units by its name.

    Raises
    ------
    SolidgearError
        For one that does not exist.
    """
    if isinstance(name, Units):
        return name
    if name not in SYSTEMS:
        raise SolidgearError(
            f"units {name!r} are unknown{nearest(str(name), SYSTEMS)}; "
            f"use one of {', '.join(SYSTEMS)}"
        )
    return SYSTEMS[name]
