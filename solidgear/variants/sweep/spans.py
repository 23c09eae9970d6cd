"""Numbers as people write them, with a unit or without one, and values of entries that vary in a study:
``a:b:n`` (n values, evenly), ``log:a:b:n`` (geometrically) or a list ``a,b,c``, their full product or
a Latin hypercube."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from solidgear.core import DIMENSIONS, SceneError, SolidgearError
from solidgear.core.scene.units import quantity

_NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*)", re.S)


def in_si(value: object) -> float | None:
    """Return a number, or a text with a unit, in SI; None for any other value.

    Examples
    --------
    >>> in_si("20 mm"), in_si("3000 rpm") == in_si("50 Hz"), in_si("concave"), in_si(20)
    (0.02, False, None, 20.0)
    """
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value)
    if not isinstance(value, str):
        return None
    if not (match := amount(value)) or not match[2]:
        return None
    for dimension in DIMENSIONS:
        try:
            return quantity(value, dimension)
        except SceneError:
            continue
    return None


def amount(word: object) -> re.Match[str] | None:
    """Match number and unit of a text."""
    return _NUMBER.fullmatch(word.strip()) if isinstance(word, str) else None


#: More variants than this are a slip of the keyboard.
MOST = 10_000_000


@dataclass(frozen=True, kw_only=True)
class Span:
    """Values of an entry that varies."""

    label: str  #: name of its column, such as ``bearing.2.position``
    values: tuple[float, ...]
    #: how values between the listed ones are drawn: along a line, along its logarithm, or not at
    #: all
    spacing: str

    @property
    def only_listed(self) -> bool:
        """True where no values but the listed ones are drawn."""
        return self.spacing == "list"

    def draw(self, u: np.ndarray) -> np.ndarray:
        """Return (n,) values for numbers between 0 and 1."""
        if self.only_listed:
            places = np.minimum((u * len(self.values)).astype(int), len(self.values) - 1)
            return np.array(self.values)[places]
        a, b = self.values[0], self.values[-1]
        return a + (b - a) * u if self.spacing == "linear" else a * (b / a) ** u


def product(axes: Sequence[Span]) -> np.ndarray:
    """Return (variants, axes) all combinations, the last axis running fastest."""
    total = int(np.prod([float(len(axis.values)) for axis in axes]))
    if total > MOST:
        raise SolidgearError(
            f"{total} variants are more than the {MOST} a sweep takes; use fewer values, or draw some with --sample"
        )
    return np.array(list(itertools.product(*(axis.values for axis in axes))), float)


def sample(axes: Sequence[Span], count: int, seed: int) -> np.ndarray:
    """Return (count, axes) a Latin hypercube over the ranges of the axes."""
    if not 1 <= count <= MOST:
        raise SolidgearError(f"--sample {count}: give a whole number from 1 to {MOST}")
    if seed < 0:
        raise SolidgearError(f"--seed {seed}: must not be negative")
    from scipy.stats import qmc

    u = qmc.LatinHypercube(d=len(axes), seed=seed).random(count)
    return np.column_stack([axis.draw(u[:, k]) for k, axis in enumerate(axes)])


def spread(spec: str, read: Callable[[str], float]) -> tuple[list[float], str]:
    """Return the values of a text ``a:b:n``, ``log:a:b:n`` or ``a,b,c``, and their spacing; `read`
    gives the value of a number. SceneError for another text.
    """
    spacing, parts = "linear", [part.strip() for part in spec.split(":")]
    if parts[0] == "log":
        spacing, parts = "log", parts[1:]
    if len(parts) == 1 and spacing == "linear":
        return [float(read(part)) for part in spec.split(",")], "list"
    if len(parts) != 3:
        raise SceneError('values are "a:b:n", "log:a:b:n" or a list "a,b,c"')
    a, b = (read(part) for part in parts[:2])
    if not parts[2].isdecimal() or not 2 <= int(parts[2]) <= MOST:
        raise SceneError(f"a:b:n needs a whole number n of 2 or more values, not {parts[2]!r}")
    if spacing == "log" and not a * b > 0:
        raise SceneError("a logarithmic range needs both ends above zero")
    spread_between = np.linspace if spacing == "linear" else np.geomspace
    return spread_between(a, b, int(parts[2])).tolist(), spacing


def plain_number(text: str) -> str | float:
    """Return a number where a text is one, else the text."""
    try:
        return float(text)
    except ValueError:
        return text
