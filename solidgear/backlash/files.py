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


def lead(study: Any, units: Units) -> str:
    """Return data of the teeth and the models in a sentence."""
    teeth = study.teeth
    gap = units.text(2 * teeth.half_gap, "m moved", 4)
    error = ", ".join(units.text(e, "m moved", 4) for e in teeth.errors)
    if teeth.phases:
        error += f" at phases {', '.join(f'{np.degrees(p):.4g}°' for p in teeth.phases)}"
    cycles = {"stiffness": teeth.cycle, "line of action": teeth.turns}
    varying = " and ".join(name for name, varies in cycles.items() if varies)
    cycle = f" {varying.capitalize()} over the mesh cycle as in the file." if varying else ""
    force = units.text(teeth.mean_force, "N", 4)
    sentence = (
        f"Backlash {gap}, mean mesh force {force} ({teeth.source}), transmission error {error}; "
        f"{study.judge.label}.{cycle}"
    )
    further = [
        f" {mesh.mesh.capitalize()}: backlash {units.text(2 * mesh.half_gap, 'm moved', 4)}, mean "
        f"force {units.text(mesh.mean_force, 'N', 4)}."
        for mesh in teeth.others
    ]
    return sentence + "".join(further)


def write_nonlinear(
    folder: Path,
    study: Any,
    title: str,
    train: Mapping[str, Any],
    units: str | Units = ENGINEERING,
    cautions: Sequence[str] = (),
) -> list[Path]:
    """Write ``nonlinear.csv`` and ``nonlinear.json`` in SI, chart and page in `units`."""
    chosen_units = units_named(units)
    return write_files(
        folder,
        "nonlinear",
        title,
        lead(study, chosen_units),
        [
            mixes(study, chosen_units),
            over_force(study, chosen_units),
            train_tables.facts(train, chosen_units),
        ],
        {"title": title, **study.as_dict(), "cautions": list(cautions)},
        lines={"nonlinear": branch(study, study.judge), **apart(study), **runs(study)},
        charts={
            "nonlinear": partial(backlash_chart, study, title, chosen_units),
            **{
                f"waterfall_{stem}": partial(waterfall_chart, study, run, title)
                for stem, run in _stems(study).items()
            },
        },
        cautions=cautions,
        verdict=study.sentences(),
    )


def apart(study: Any) -> dict[str, Table]:
    """Return each separate branch of the first mix, by file name."""
    some = enumerate(study.judge.branches_apart, start=1)
    return {
        f"apart_{k}_of_{separate.periods}_periods": branch(study, separate) for k, separate in some
    }


def branch(study: Any, motion: Any) -> Table:
    """Return a branch of the first mix in its order, in SI."""
    columns = {
        **places(motion.frequency_hz, study.teeth_a_turn),
        "dynamic mesh force [N]": motion.force,
        "largest mesh force [N]": motion.highest,
        "share of the cycle in contact": motion.driving,
        "share on the other flank": motion.backside,
        "stable": motion.stable.astype(float),
        "largest multiplier": np.abs(motion.multiplier),
    }
    for mesh in motion.meshes[1:]:
        columns |= {
            f"{mesh.teeth.mesh} dynamic force [N]": mesh.force,
            f"{mesh.teeth.mesh} largest force [N]": mesh.highest,
            f"{mesh.teeth.mesh} share of the cycle in contact": mesh.driving,
        }
    return numbers(columns)


def runs(study: Any) -> dict[str, Table]:
    """Return each run through the range, mesh cycle by mesh cycle, in SI, by file name."""
    out = {}
    for stem, run in _stems(study).items():
        columns = {
            **places(run.frequency_hz, study.teeth_a_turn),
            "dynamic mesh force [N]": run.force,
            "largest mesh force [N]": run.run.highest,
            "steady dynamic mesh force [N]": run.steady_force,
        }
        for mesh in run.meshes[1:]:
            columns |= {
                f"{mesh.backlash.teeth.mesh} dynamic force [N]": mesh.force,
                f"{mesh.backlash.teeth.mesh} largest force [N]": mesh.run.highest,
            }
        out[stem] = numbers(columns)
    return out


def _stems(study: Any) -> dict[str, Any]:
    """Return runs by file name."""
    out = {}
    for run in study.runs:
        rpm = 60 * abs(run.ramp) / study.teeth_a_turn
        out[f"run_{'up' if run.ramp > 0 else 'down'}_{rpm:g}".replace(".", "_")] = run
    return out


def mixes(study: Any, units: Units = ENGINEERING) -> Table:
    """Return jumps and largest force of every mix."""

    def jumps(mix: Any, rising: bool) -> str:
        jumps_hz = [hertz(j.frequency_hz) for j in mix.jumps if j.rising is rising]
        return ", ".join(jumps_hz) or DASH

    columns = [
        text("shafts", lambda mix: mix.label),
        text("jump up, Hz", lambda mix: jumps(mix, True)),
        text("jump down, Hz", lambda mix: jumps(mix, False)),
        Column(f"largest, {units.unit('N')}", lambda mix: _force(mix.worst.loudest[1], units)),
        Column("at, Hz", lambda mix: hertz(mix.worst.loudest[0])),
        Column(f"linear, {units.unit('N')}", lambda mix: _force(mix.linear_loudest[1], units)),
        Column("at, Hz", lambda mix: hertz(mix.linear_loudest[0])),
    ]
    for k, mesh in enumerate(study.teeth.others, start=1):
        head = f"{mesh.mesh.removeprefix('mesh ')}, {units.unit('N')}"
        columns.append(Column(head, partial(_largest, k, units)))
    return Table("Jumps and largest dynamic mesh force", columns, study.mixes, style="bare")


def _largest(mesh: int, units: Units, mix: Any) -> str:
    return _force(mix.meshes[mesh].worst.loudest[1], units)


def over_force(study: Any, units: Units = ENGINEERING) -> Table:
    """Return jumps over the mean force of the teeth."""

    def jumps(mix: Any, rising: bool) -> str:
        return ", ".join(hertz(hz) for hz, is_up in mix.jumps_hz if is_up is rising) or DASH

    columns = [
        Column(f"mean force, {units.unit('N')}", lambda mix: _force(mix.mean_force, units)),
        Column(
            f"torque, {units.unit('N m')}",
            lambda mix: plain(units.value(mix.mean_force * study.lever, "N m"), 4),
        ),
        text("jump up, Hz", lambda mix: jumps(mix, True)),
        text("jump down, Hz", lambda mix: jumps(mix, False)),
        Column(f"largest, {units.unit('N')}", lambda mix: _force(mix.largest, units)),
    ]
    return Table(
        f"Jumps over the torque of the {study.train.reference}, on the branch from low speed",
        columns,
        study.over_force,
        style="bare",
    )


def _force(value: float, units: Units) -> str:
    return plain(units.value(value, "N"), 4)
