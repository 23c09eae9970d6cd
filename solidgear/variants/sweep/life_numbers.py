"""Lives and static safety of bearings in the rows of a sweep."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

from solidgear.bearings.bearing_life import BearingLife
from solidgear.bearings.duty import LivesOverPoints

#: columns of the least of all bearings: revolutions, hours, revolutions, and C_0 over P_0; and of the
#: kind of life that the first two are
LIFE, HOURS, BASIC, STATIC, KIND = "life", "life_hours", "basic_life", "static_safety", "life_kind"
LEAST = (LIFE, HOURS, BASIC, STATIC)
#: kinds of life by the words of bearings
KINDS = {
    "modified": "modified reference life (ISO 281, ISO/TS 16281)",
    "reference": "reference life (ISO/TS 16281)",
}


def life_columns(bearings: Iterable[str]) -> dict[str, type]:
    """Return the columns of lives: of every bearing, by its name, and the least of all."""
    out: dict[str, type] = {}
    for name in bearings:
        out |= {f"{name}.{LIFE}": float, f"{name}.{STATIC}": float}
    return (out | dict.fromkeys(LEAST, float) | {KIND: str}) if out else {}


def life_numbers(bearings: Iterable[LivesOverPoints]) -> dict[str, float | str]:
    """Return the numbers of lives by column; of a bearing that carries nothing there is none.

    Over a duty table it is the life of all of it, else the least of the points; static safety is the
    least of them.
    """
    out: dict[str, float | str] = {}
    kinds = set()
    for bearing in bearings:
        lives = [point.life for point in bearing.points]
        duty, kind = bearing.duty, bearing.kind
        kinds.add(KINDS[kind])
        numbers = {
            LIFE: duty.revolutions if duty else min(_lived(life, kind) for life in lives),
            HOURS: duty.hours if duty else math.inf,
            BASIC: min(life.life.basic for life in lives),
            STATIC: min(life.life.static_safety for life in lives),
        }
        for column in (LIFE, STATIC):
            if math.isfinite(numbers[column]):
                out[f"{bearing.name}.{column}"] = numbers[column]
        for column, number in numbers.items():
            if math.isfinite(number):
                out[column] = min(number, float(out.get(column, math.inf)))
    return out | {KIND: "; ".join(sorted(kinds))}


def _lived(life: BearingLife, kind: str) -> float:
    lives: Mapping[str, float] = life.lives
    return lives.get(kind, life.life.reference)
