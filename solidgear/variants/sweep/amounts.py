"""Numbers as people write them, with a unit or without one, of any dimension."""

from __future__ import annotations

import re

from solidgear.core import DIMENSIONS, SceneError
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
