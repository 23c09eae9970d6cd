"""Lives of bearings as the command prints them, and as plain data."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from solidgear.bearings.bearing_life import BearingLife
from solidgear.bearings.life import Life
from solidgear.core.plain import plain
from solidgear.show.command import say
from solidgear.show.table import Column, Table
from solidgear.show.words import engineering


@dataclass(frozen=True)
class _Line:
    """A life as a line of a table."""

    name: str
    life: float
    ends: tuple[float, float]


def _lines(bearing: BearingLife) -> list[_Line]:
    life = bearing.life
    lines = [
        _Line("basic L10", life.basic, bearing.range("basic")),
        _Line("reference L10r", life.reference, bearing.range("reference")),
    ]
    if life.modified is not None:
        lines.append(_Line("modified Lnmr", life.modified.life, bearing.range("modified")))
    return lines


def print_life(bearing: BearingLife) -> None:
    """Print the lives of a bearing, their range and where each number came from."""

    def number(value: float) -> str:
        return engineering(value, 3) if math.isfinite(value) else "endless"

    to_hours = 3600 * bearing.speed / (2 * math.pi)
    columns = [
        Column("life", lambda line: line.name),
        Column("revolutions", lambda line: line.life, number),
    ]
    if bearing.told:
        columns.append(Column("from", lambda line: line.ends[0], number))
        columns.append(Column("to", lambda line: line.ends[1], number))
    if to_hours:
        columns.append(Column("hours", lambda line: line.life / to_hours, number))
    say(Table("", columns, _lines(bearing)))
    for sentence in _sources(bearing.life):
        say(sentence)
    if bearing.told:
        say(f"From and to: range over {bearing.told}.")
    if bearing.life.without:
        say(f"No modified life: {bearing.life.without}.")
    if not to_hours:
        say("No hours: no speed is given; write --speed, or speed in [lubrication].")
    for note in bearing.life.notes:
        say(f"caution: bearing {bearing.name!r}: {note}")


def _sources(life: Life) -> Iterator[str]:
    """Yield sentences on how the lives of a bearing were computed."""
    p, modified = life.equivalent, life.modified
    yield (
        f"L10 = (C/P)^p with P = {p.X:.3g} Fr + {p.Y:.3g} Fa = {engineering(p.load, 4)} N, Fr "
        f"{engineering(p.radial, 4)} N, Fa {engineering(p.axial, 4)} N (ISO 281)."
    )
    yield (
        "L10r by the loads of all elements (ISO/TS 16281), equivalent load "
        f"{engineering(life.reference_load, 4)} N."
    )
    if modified is not None:
        yield (
            f"Lnmr = a1 aISO L10r: a1 {modified.a1:.3g} ({100 * modified.reliability:g} %), aISO "
            f"{modified.a_iso:.3g} at kappa {modified.kappa:.3g} and eC {modified.contamination:.3g} (ISO 281, 9.3)."
        )
    values = {"C": life.rated.dynamic, "C0": life.rated.static, "Cu": life.rated.fatigue}
    words = [f"{k} {engineering(v, 4)} N ({life.rated.sources[k]})" for k, v in values.items()]
    yield f"{', '.join(words)}."
    safety = f"{life.static_safety:.3g}" if math.isfinite(life.static_safety) else "endless"
    yield f"Static safety C0/P0 {safety} (ISO 76)."


def plain_life(bearing: BearingLife) -> dict[str, Any]:
    """Return lives of a bearing as plain data in SI; infinite ones are None."""
    life = bearing.life
    data = {
        "speed": bearing.speed or None,
        "basic": life.basic,
        "reference": life.reference,
        "modified": life.modified,
        "no_modified_life": life.without,
        "range": {line.name.split()[0]: line.ends for line in _lines(bearing)},
        "not_known": bearing.told,
        "equivalent_load": life.equivalent,
        "reference_load": life.reference_load,
        "static_load": life.static_load,
        "static_safety": life.static_safety,
        "ratings": {
            "C": life.rated.dynamic,
            "C0": life.rated.static,
            "Cu": life.rated.fatigue,
            "sources": life.rated.sources,
        },
        "notes": life.notes,
    }
    return plain(data)
