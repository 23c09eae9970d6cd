"""Lives of bearings as the command prints them, and as plain data."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from solidgear.bearings.bearing_life import BearingLife
from solidgear.bearings.life import Life
from solidgear.core.errors import SceneError, SolidgearError
from solidgear.core.scene.units import quantity
from solidgear.show.command import say
from solidgear.show.table import Column, Table
from solidgear.show.words import engineering


def speed_of(text: str | None) -> float | None:
    """Speed that was asked for, rad/s."""
    if text is None:
        return None
    try:
        speed = quantity(text, "speed")
    except SceneError as error:
        raise SolidgearError(f"--speed {error}") from None
    if speed <= 0:
        raise SolidgearError(f"--speed {text}: must be greater than zero")
    return speed


@dataclass(frozen=True)
class _Line:
    """A life as a line of a table."""

    name: str
    life: float
    ends: tuple[float, float]


def _lines(found: BearingLife) -> list[_Line]:
    one = found.life
    lines = [
        _Line("basic L10", one.basic, found.range("basic")),
        _Line("reference L10r", one.reference, found.range("reference")),
    ]
    if one.modified is not None:
        lines.append(_Line("modified Lnmr", one.modified.life, found.range("modified")))
    return lines


def print_life(found: BearingLife) -> None:
    """Print the lives of a bearing, their range and where each number came from."""

    def number(value: float) -> str:
        return engineering(value, 3) if math.isfinite(value) else "endless"

    to_hours = 3600 * found.speed / (2 * math.pi)
    columns = [
        Column("life", lambda line: line.name),
        Column("revolutions", lambda line: line.life, number),
    ]
    if found.told:
        columns.append(Column("from", lambda line: line.ends[0], number))
        columns.append(Column("to", lambda line: line.ends[1], number))
    if to_hours:
        columns.append(Column("hours", lambda line: line.life / to_hours, number))
    say(Table("", columns, _lines(found)))
    for sentence in _sources(found.life):
        say(sentence)
    if found.told:
        say(f"From and to: {found.told} at their ends.")
    if found.life.without:
        say(f"No modified life: {found.life.without}.")
    if not to_hours:
        say("No hours: no speed is given; write --speed, or speed in [lubrication].")
    for note in found.life.notes:
        say(f"caution: bearing {found.name!r}: {note}")


def _sources(one: Life) -> Iterator[str]:
    """Sentences on how the lives of a bearing come about."""
    p, own = one.equivalent, one.modified
    yield (
        f"L10 = (C/P)^p with P = {p.X:.3g} Fr + {p.Y:.3g} Fa = {engineering(p.load, 4)} N, Fr "
        f"{engineering(p.radial, 4)} N, Fa {engineering(p.axial, 4)} N (ISO 281)."
    )
    yield (
        "L10r by the loads of all elements (ISO/TS 16281), which feel "
        f"{engineering(one.reference_load, 4)} N."
    )
    if own is not None:
        yield (
            f"Lnmr = a1 aISO L10r: a1 {own.a1:.3g} ({100 * own.reliability:g} %), aISO "
            f"{own.a_iso:.3g} at kappa {own.kappa:.3g} and eC {own.contamination:.3g} (ISO 281, 9.3)."
        )
    values = {"C": one.rated.dynamic, "C0": one.rated.static, "Cu": one.rated.fatigue}
    words = [f"{k} {engineering(v, 4)} N ({one.rated.sources[k]})" for k, v in values.items()]
    yield f"{', '.join(words)}."
    safety = f"{one.static_safety:.3g}" if math.isfinite(one.static_safety) else "endless"
    yield f"Static safety C0/P0 {safety} (ISO 76)."


def plain_life(found: BearingLife) -> dict[str, Any]:
    """Lives of a bearing as plain data, SI; what has no end is None."""

    def known(value: float) -> float | None:
        return float(value) if math.isfinite(value) else None

    one = found.life
    own = one.modified
    return {
        "speed": found.speed or None,
        "basic": known(one.basic),
        "reference": known(one.reference),
        "modified": None if own is None else {k: known(v) for k, v in own._asdict().items()},
        "no_modified_life": one.without,
        "range": {
            line.name.split()[0]: [known(end) for end in line.ends] for line in _lines(found)
        },
        "not_known": found.told,
        "equivalent_load": {k: known(v) for k, v in one.equivalent._asdict().items()},
        "reference_load": one.reference_load,
        "static_load": one.static_load,
        "static_safety": known(one.static_safety),
        "ratings": {
            "C": one.rated.dynamic,
            "C0": one.rated.static,
            "Cu": one.rated.fatigue,
            "sources": one.rated.sources,
        },
        "notes": list(one.notes),
    }
