"""Sheets of catalogue bearings: of a shaft under its load, and of a train over its operating points."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.bearings.bearing_life import BearingLife
from solidgear.bearings.designation import boundary
from solidgear.bearings.duty import LivesOverPoints
from solidgear.bearings.life import Life
from solidgear.bearings.rolling import UNITS
from solidgear.bearings.study import BearingFacts
from solidgear.core import DOF_NAMES
from solidgear.show.command import caution
from solidgear.show.sheet import Sheet, Terminal
from solidgear.show.table import Cell, Column, Table
from solidgear.show.terminal import matrix_table
from solidgear.show.words import engineering, percent

#: lives by kind as tables name them
LIVES = {"basic": "basic L10", "reference": "reference L10r", "modified": "modified Lnmr"}


def scene_sheet(
    scene: str,
    facts: Sequence[BearingFacts],
    chart: Path | None = None,
    case: str = "",
    lives: Sequence[LivesOverPoints] = (),
) -> Sheet:
    """Return the sheet of the catalogue bearings of a shaft at their load in a case, and their lives,
    over all cases where there are several.
    """
    blocks: list[str | Table] = [f"Loads of the case {case}."] if case else []
    for fact in facts:
        blocks += [*_at_load(fact), *_life(fact.life)]
    if lives:
        blocks += [*_over_points(lives), *_duty(lives, "case")]
    if chart is not None:
        blocks.append(f"Chart: {chart}")
    data: dict[str, Any] = {"scene": scene, "bearings": [fact.as_dict() for fact in facts]}
    if case:
        data |= {"case": case, "cases": [life.as_dict() for life in lives]}
    return _sheet(scene, blocks, data)


def train_sheet(
    train: str, bearings: Sequence[LivesOverPoints], cautions: Sequence[str] = ()
) -> Sheet:
    """Return the sheet of the bearings of a train: lives at all operating points, and over the duty
    table.
    """
    blocks = [*_over_points(bearings), *_duty(bearings)]
    rows = [bearing.as_dict() for bearing in bearings]
    data = {"train": train, "bearings": rows, "cautions": [*cautions]}
    return _sheet(train, blocks, data, cautions)


def _sheet(
    name: str,
    blocks: Sequence[str | Table],
    data: Mapping[str, Any],
    cautions: Sequence[str] = (),
) -> Sheet:
    return Sheet(
        name="bearings",
        title=f"{name}: bearings",
        lead="",
        tables=[block for block in blocks if isinstance(block, Table)],
        data=data,
        notes=[block for block in blocks if isinstance(block, str)],
        cautions=cautions,
        terminal=Terminal(
            heading=blocks, tables=(), closing=[*map(caution, cautions)], lines="whole"
        ),
    )


def _at_load(fact: BearingFacts) -> Iterator[str | Table]:
    """Yield the inside of a bearing, and its load, displacement, stiffness and contacts."""
    data = fact.data
    unused = f" ({data.listed})" if data.listed else ""
    if data.designation and not data.listed and (ignored := boundary(data.designation).ignored):
        unused = f" (read and ignored: {ignored})"
    support = f", {fact.bearing.support}" if fact.bearing.support else ""
    yield f"Bearing {fact.name!r}: {fact.called}{unused}{support}, {fact.bearing.status}"
    yield _inside(fact)
    if fact.made.estimated:
        words = ", ".join(fact.made.estimated).replace("_", " ")
        yield f"Estimated from boundary dimensions and ratings: {words}."
    # contacts that balance each other leave the rounding of their sum
    at_work = max(np.abs(fact.load).max(), sum(row.load.sum() for row in fact.rows))
    loads = [
        f"{name} {engineering(value, 4)} {unit}"
        for name, value, unit in zip(DOF_NAMES, fact.load, UNITS)
        if abs(value) > 1e-9 * at_work
    ]
    yield f"Load: {', '.join(loads) or 'none'}"
    motions = [
        f"{name} {1e6 * value:.4g} {'um' if k < 3 else 'urad'}"
        for k, (name, value) in enumerate(zip(DOF_NAMES, fact.motion))
        if abs(value) > 1e-12
    ]
    yield f"Displacement: {', '.join(motions) or 'none'}"
    scale = np.sqrt(np.abs(np.diag(fact.stiffness)))
    rounding = np.abs(fact.stiffness) <= 1e-12 * np.outer(scale, scale)
    table = matrix_table(np.where(rounding, 0.0, fact.stiffness), "stiffness")
    table.name = f"stiffness_{fact.name}"
    yield table
    # a bearing that carries nothing has no stiffness at either end
    if fact.spread is not None and np.any(fact.spread[1] > 0):
        ends = [
            f"{name} {engineering(low, 3)} to {engineering(high, 3)}"
            for name, low, high in zip(DOF_NAMES, *fact.spread)
            if high > 0
        ]
        yield f"Range over the estimated inside, from soft to stiff: {', '.join(ends)}."
    yield from _contacts(fact)
    yield from (caution(f"bearing {fact.name!r}: {note}") for note in fact.notes)


def _inside(fact: BearingFacts) -> str:
    inside = fact.inside
    size = f"{inside['elements']} elements of {1e3 * inside['element_diameter']:.4g}"
    if "element_length" in inside:
        size += f" x {1e3 * inside['element_length']:.4g}"
    sentence = f"{size} mm a row on {1e3 * inside['pitch_diameter']:.5g} mm"
    if inside["contact_angle"]:
        sentence += f", contact angle {np.degrees(inside['contact_angle']):.4g} deg"
    if fact.data.kind != "thrust_ball":
        sentence += f"; radial clearance at work {1e6 * fact.made.clearance:.3g} um"
    return sentence


def _contacts(fact: BearingFacts) -> Iterator[str]:
    """Yield a sentence on the loaded elements of each row that carries."""
    for k, row in enumerate(fact.rows):
        place = "" if len(fact.rows) == 1 else f" of the {'lower' if k == 0 else 'upper'} row"
        carrying = row.load > 0
        if not carrying.any():
            continue
        angle = np.degrees(row.angle[carrying])
        angles = f", contact angle {angle.min():.2f} to {angle.max():.2f} deg" if any(angle) else ""
        yield (
            f"{int(carrying.sum())} of {len(row.load)} elements{place} carry, at most "
            f"{engineering(float(row.load.max()), 4)} N{angles}, pressure "
            f"{row.inner.max() / 1e6:.0f} MPa inside, {row.outer.max() / 1e6:.0f} MPa outside"
        )


def _life(bearing: BearingLife) -> Iterator[str | Table]:
    """Yield the lives of a bearing, their range and where each number came from."""
    to_hours = 3600 * bearing.speed / (2 * math.pi)
    heads = ["revolutions"]
    heads += ["from", "to"] if bearing.unknown else []
    heads += ["hours"] if to_hours else []
    rows = []
    for kind, life in bearing.lives.items():
        ends = bearing.range(kind) if bearing.unknown else ()
        numbers = [life, *ends, *([life / to_hours] if to_hours else [])]
        rows.append([LIVES[kind], *map(_cell, numbers)])
    yield Table("", ["life", *heads], rows, name=f"life_{bearing.name}")
    yield from _sources(bearing.life)
    if bearing.unknown:
        yield _ranges(bearing)
    if bearing.life.without:
        yield f"No modified life: {bearing.life.without}."
    if not to_hours:
        yield "No hours: no speed is given; write --speed, or speed of its lubrication."
    yield from (caution(f"bearing {bearing.name!r}: {note}") for note in bearing.life.notes)


def _number(value: float) -> str:
    """Return a life, or another number that may have no end, in words."""
    return engineering(value, 3) if math.isfinite(value) else "endless"


def _cell(value: float) -> Cell:
    """Return a life, or another number that may have no end."""
    return Cell(value, "", _number(value))


def _ranges(bearing: BearingLife) -> str:
    return f"From and to: range over {bearing.unknown}."


def _sources(life: Life) -> Iterator[str]:
    """Yield sentences on how the lives of a bearing were computed."""
    p, modified = life.equivalent, life.modified
    yield (
        f"L10 = (C/P)^p with P = {p.X:.3g} Fr + {p.Y:.3g} Fa = {engineering(p.load, 4)} N, Fr "
        f"{engineering(p.radial, 4)} N, Fa {engineering(p.axial, 4)} N (ISO 281)."
    )
    yield (
        "L10r by the loads of all elements (ISO/TS 16281), as (C/P)^p with P = "
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
    yield f"Static safety C0/P0 {_number(life.static_safety)} (ISO 76)."


def _over_points(bearings: Sequence[LivesOverPoints]) -> Iterator[str | Table]:
    """Yield the life of each bearing at each operating point."""
    columns = ["bearing", Column("at", kind="text"), "L10", "L10r", "from", "to", "Lnmr", "C0/P0"]
    rows = []
    for bearing in bearings:
        for point in bearing.points:
            lives = point.life.lives
            numbers = [lives["basic"], lives["reference"], *point.life.range("reference")]
            modified = _cell(lives["modified"]) if "modified" in lives else None
            safety = _cell(point.life.life.static_safety)
            rows.append([bearing.name, point.label, *map(_cell, numbers), modified, safety])
    yield Table("", columns, rows, name="lives")
    yield (
        "Lives in revolutions: basic L10 (ISO 281), reference L10r (ISO/TS 16281) with its range, "
        "modified Lnmr (ISO 281, 9.3); static safety C0/P0 (ISO 76)."
    )
    first = bearings[0].points[0].life
    if first.unknown:
        yield _ranges(first)
    for bearing in bearings:
        notes = [note for point in bearing.points for note in point.life.life.notes]
        yield from (caution(f"bearing {bearing.name!r}: {n}") for n in dict.fromkeys(notes))


def _duty(bearings: Sequence[LivesOverPoints], point: str = "point") -> Iterator[str | Table]:
    """Yield lives over the duty table, where there is one, of points or of cases."""
    rows = []
    for bearing in bearings:
        duty = bearing.duty
        if duty is not None:
            worst = bearing.points[duty.worst].label
            share = duty.damage[duty.worst]
            damage = Cell(share, "", percent(share, signed=False))
            lives = map(_cell, (duty.hours, duty.revolutions))
            rows.append([bearing.name, *lives, bearing.kind, worst, damage])
    if not rows:
        yield f"No life over all {point}s: give each {point} its speed, and its share or hours."
        return
    words = [Column("of", kind="word"), Column("most damage at", kind="text"), "of all"]
    yield Table("", ["bearing", "hours", "revolutions", *words], rows, name="duty")
    yield f"Damage of all {point}s is added (Palmgren, Miner)."
