"""Files of a train with backlash: the branch as numbers, its chart, a page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.backlash.chart import backlash_chart, waterfall_chart
from solidgear.show.sheet_files import write_files
from solidgear.show.table import Column, Table, numbers, text
from solidgear.show.units import ENGINEERING, Units, plain, units_named
from solidgear.show.words import DASH, hertz
from solidgear.trains.page import tables as train_tables
from solidgear.trains.page.files import places


def lead(found: Any, shown: Units) -> str:
    """Data of the teeth, and the models that answer, in a sentence."""
    teeth = found.teeth
    gap = shown.text(2 * teeth.half_gap, "m moved", 4)
    error = ", ".join(shown.text(e, "m moved", 4) for e in teeth.errors)
    if teeth.phases:
        error += f" at phases {', '.join(f'{np.degrees(p):.4g}°' for p in teeth.phases)}"
    named = {"stiffness": teeth.cycle, "line of action": teeth.turns}
    varying = " and ".join(name for name, there in named.items() if there)
    cycle = f" {varying.capitalize()} over the mesh cycle as in the file." if varying else ""
    force = shown.text(teeth.mean_force, "N", 4)
    told = (
        f"Backlash {gap}, mean mesh force {force} ({teeth.source}), transmission error {error}; "
        f"{found.judge.label}.{cycle}"
    )
    others = [
        f" {other.mesh.capitalize()}: backlash {shown.text(2 * other.half_gap, 'm moved', 4)}, mean "
        f"force {shown.text(other.mean_force, 'N', 4)}."
        for other in teeth.others
    ]
    return told + "".join(others)


def write_nonlinear(
    folder: Path,
    found: Any,
    title: str,
    train: Mapping[str, Any],
    units: str | Units = ENGINEERING,
    cautions: Sequence[str] = (),
) -> list[Path]:
    """``nonlinear.csv`` of the branch of the first mix and ``nonlinear.json`` in SI, its chart and
    page in `units`; `train` is what is known of the train as plain data.
    """
    shown = units_named(units)
    return write_files(
        folder,
        "nonlinear",
        title,
        lead(found, shown),
        [mixes(found, shown), over_force(found, shown), train_tables.facts(train, shown)],
        {"title": title, **found.as_dict(), "cautions": list(cautions)},
        lines={"nonlinear": branch(found, found.judge), **apart(found), **runs(found)},
        charts={
            "nonlinear": partial(backlash_chart, found, title, shown),
            **{
                f"waterfall_{stem}": partial(waterfall_chart, found, one, title)
                for stem, one in _stems(found).items()
            },
        },
        cautions=cautions,
        verdict=found.sentences(),
    )


def apart(found: Any) -> dict[str, Table]:
    """Each branch apart of the first mix, by the names of their files."""
    some = enumerate(found.judge.branches_apart, start=1)
    return {f"apart_{k}_of_{one.periods}_periods": branch(found, one) for k, one in some}


def branch(found: Any, one: Any) -> Table:
    """A branch of the first mix in its order, in SI."""
    there = {
        **places(one.frequency_hz, found.teeth_a_turn),
        "dynamic mesh force [N]": one.force,
        "largest mesh force [N]": one.highest,
        "share of the cycle in contact": one.driving,
        "share on the other flank": one.backside,
        "stable": one.stable.astype(float),
        "largest multiplier": np.abs(one.multiplier),
    }
    for other in one.meshes[1:]:
        there |= {
            f"{other.teeth.mesh} dynamic force [N]": other.force,
            f"{other.teeth.mesh} largest force [N]": other.highest,
            f"{other.teeth.mesh} share of the cycle in contact": other.driving,
        }
    return numbers(there)


def runs(found: Any) -> dict[str, Table]:
    """Each run through the range, mesh cycle by mesh cycle, in SI, by the names of their files."""
    out = {}
    for stem, one in _stems(found).items():
        there = {
            **places(one.frequency_hz, found.teeth_a_turn),
            "dynamic mesh force [N]": one.force,
            "largest mesh force [N]": one.run.highest,
            "steady dynamic mesh force [N]": one.steady_force,
        }
        for other in one.meshes[1:]:
            there |= {
                f"{other.backlash.teeth.mesh} dynamic force [N]": other.force,
                f"{other.backlash.teeth.mesh} largest force [N]": other.run.highest,
            }
        out[stem] = numbers(there)
    return out


def _stems(found: Any) -> dict[str, Any]:
    """Runs by the names of their files."""
    out = {}
    for one in found.runs:
        rpm = 60 * abs(one.ramp) / found.teeth_a_turn
        out[f"run_{'up' if one.ramp > 0 else 'down'}_{rpm:g}".replace(".", "_")] = one
    return out


def mixes(found: Any, units: Units = ENGINEERING) -> Table:
    """Jumps and largest force of every mix."""

    def jumps(one: Any, rising: bool) -> str:
        own = [hertz(j.frequency_hz) for j in one.jumps if j.rising is rising]
        return ", ".join(own) or DASH

    columns = [
        text("shafts", lambda one: one.label),
        text("jump up, Hz", lambda one: jumps(one, True)),
        text("jump down, Hz", lambda one: jumps(one, False)),
        Column(f"largest, {units.unit('N')}", lambda one: _force(one.worst.loudest[1], units)),
        Column("at, Hz", lambda one: hertz(one.worst.loudest[0])),
        Column(f"linear, {units.unit('N')}", lambda one: _force(one.linear_loudest[1], units)),
        Column("at, Hz", lambda one: hertz(one.linear_loudest[0])),
    ]
    for k, other in enumerate(found.teeth.others, start=1):
        head = f"{other.mesh.removeprefix('mesh ')}, {units.unit('N')}"
        columns.append(Column(head, partial(_largest, k, units)))
    return Table("Jumps and largest dynamic mesh force", columns, found.mixes, style="bare")


def _largest(mesh: int, units: Units, one: Any) -> str:
    return _force(one.meshes[mesh].worst.loudest[1], units)


def over_force(found: Any, units: Units = ENGINEERING) -> Table:
    """Jumps over the mean force of the teeth."""

    def jumps(one: Any, rising: bool) -> str:
        return ", ".join(hertz(hz) for hz, up in one.jumps_hz if up is rising) or DASH

    columns = [
        Column(f"mean force, {units.unit('N')}", lambda one: _force(one.mean_force, units)),
        Column(
            f"torque, {units.unit('N m')}",
            lambda one: plain(units.value(one.mean_force * found.lever, "N m"), 4),
        ),
        text("jump up, Hz", lambda one: jumps(one, True)),
        text("jump down, Hz", lambda one: jumps(one, False)),
        Column(f"largest, {units.unit('N')}", lambda one: _force(one.largest, units)),
    ]
    return Table(
        f"Jumps over the torque of the {found.train.reference}, on the branch from low speed",
        columns,
        found.over_force,
        style="bare",
    )


def _force(value: float, units: Units) -> str:
    return plain(units.value(value, "N"), 4)
