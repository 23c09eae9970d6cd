"""Files of a train with backlash: the branch as numbers, its charts (mesh force over speed with its
branches, contact over the cycle, orders of the largest force), a page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.show.panel import (
    GREY,
    Axis,
    Panel,
    Series,
    curve,
    lines_legend,
    read_places,
    readout,
)
from solidgear.show.plot import NARROW, WIDE, Chart, in_columns
from solidgear.show.sheet_files import write_files
from solidgear.show.table import Column, Table, numbers, text
from solidgear.show.units import ENGINEERING, Units, plain, units_named
from solidgear.show.words import DASH, hertz
from solidgear.trains.page import tables as train_tables
from solidgear.trains.page.files import places
from solidgear.trains.response.waterfall import DEEP, waterfall


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


STABLE, UNSTABLE, LINEAR, APART = "stable", "unstable", "linear: no backlash", "stable, apart"
OTHERS = ("#c98a00", "#b3305c", "#5a3e8c", "#1f9bb8", "#8a6d3b")
DRIVE, NONE, BACK = "in contact", "apart", "on the other flank"
LOOKS = {
    STABLE: Series("#00805e"),
    UNSTABLE: Series("#d55e00"),
    APART: Series("#0057b8"),
    LINEAR: Series(GREY),
}
CONTACT = {DRIVE: Series("#00805e"), NONE: Series("#d9d9d9"), BACK: Series("#b3305c")}
#: orders of the mesh drawn over a run, and up to which frequencies are, of the highest of the mesh
MESH_ORDERS, MESH_SEEN = (0.5, 1, 2, 3, 4), 2.0
#: bins of the speed in which shares of the cycle are drawn
BINS = 160


def backlash_chart(
    study: Any, title: str, units: Units = ENGINEERING, width: float = WIDE
) -> Chart:
    """Chart dynamic mesh force over speed, share of the cycle in contact, and orders."""
    judge, teeth = study.judge, study.teeth_a_turn
    rpm = 60 * judge.frequency_hz / teeth
    ends = float(rpm.min()), float(rpm.max())
    panels = [_force_axes(study, rpm, ends, units, width)]
    panels += [
        _contact(mesh, rpm, ends, width, teeth.of) for mesh in judge.meshes if _may_part(mesh)
    ]
    if study.over_force:
        panels.append(_map(study, ends, units))
    return Chart(in_columns([*panels, _orders(judge, units)], 1), width, title)


def _map(study: Any, ends: tuple[float, float], units: Units) -> Panel:
    """Return a map of parting teeth and jumps over speed and mean force."""
    judge, teeth = study.judge, study.teeth_a_turn
    unit, (hz, size) = units.unit("N"), judge.holding
    top = 1.05 * float(units.values(size, "N").max())
    panel = Panel(
        Axis(f"speed of the {teeth.of} in rpm", ends),
        Axis(f"mean mesh force in {unit}", (0.0, top)),
        240.0,
        "Teeth part below the line; triangles: jumps as the speed rises (up) and falls (down)",
        series={LINEAR: LOOKS[LINEAR]},
    )
    line = curve(60 * hz / teeth, units.values(size, "N"), name=LINEAR)
    panel.draw({"type": "line", "strokeWidth": 1.2, "strokeDash": [5, 3]}, line)
    for rising, shape in ((True, "triangle-up"), (False, "triangle-down")):
        rows = [
            {
                "x": 60 * jump_hz / teeth,
                "y": units.value(branch.mean_force, "N"),
                "readout": readout("jump", ("frequency", hertz(jump_hz), "Hz")),
            }
            for branch in study.over_force
            for jump_hz, is_up in branch.jumps_hz
            if is_up is rising
        ]
        panel.draw({"type": "point", "shape": shape, "filled": True, "color": "#222222"}, rows)
    return panel


def _force_axes(study: Any, rpm: np.ndarray, ends, units: Units, width: float) -> Panel:
    judge, teeth = study.judge, study.teeth_a_turn
    unit = units.unit("N")
    hz, size = judge.linear
    linear = units.values(size, "N")
    curves = {branch.label: units.values(branch.force, "N") for branch in study.mixes}
    ran = {_run_name(branch, teeth): branch for branch in study.runs}
    further = [units.values(branch.force, "N") for branch in (*judge.branches_apart, *ran.values())]
    sizes = [linear, *curves.values(), *further]
    top = 1.08 * max(float(size.max()) for size in sizes)
    labels = [*(branch.label for branch in study.mixes[1:]), *ran]
    series = {name: Series(OTHERS[k % len(OTHERS)]) for k, name in enumerate(labels)}
    panel = Panel(
        Axis(f"speed of the {teeth.of} in rpm", ends),
        Axis(f"dynamic mesh force in {unit}", (0.0, top)),
        360.0,
        "Half of the swing of the mesh force; triangles: jumps as the speed rises (up) and falls (down)",
        series={name: look for name, look in LOOKS.items() if name != APART or judge.branches_apart}
        | series,
        legend=lines_legend(3 if width > NARROW else 1),
    )
    rows = curve(60 * hz / teeth, linear, name=LINEAR)
    panel.draw({"type": "line", "strokeWidth": 1.2, "strokeDash": [5, 3]}, rows)
    for branch in study.mixes[1:]:
        places, own = 60 * branch.frequency_hz / teeth, curves[branch.label]
        inside = branch.stable & (places >= ends[0]) & (places <= ends[1])
        for part, (a, b) in enumerate(_runs(inside)):
            rows = curve(places[a:b], own[a:b], name=branch.label, detail=part)
            panel.draw({"type": "line", "strokeWidth": 1.1, "clip": True}, rows)
    for name, branch in ran.items():
        places, own = _envelope(60 * branch.frequency_hz / teeth, units.values(branch.force, "N"))
        panel.draw({"type": "line", "strokeWidth": 1.4}, curve(places, own, name=name))
    for branch in (*judge.branches_apart, judge):
        calm = STABLE if branch is judge else APART
        _branch(panel, branch, 60 * branch.frequency_hz / teeth, units, calm)
    for jump in judge.jumps:
        x, y = 60 * jump.frequency_hz / teeth, units.value(jump.force, "N")
        way = "rising" if jump.rising else "falling"
        mark = {"type": "point", "shape": "triangle-up" if jump.rising else "triangle-down"}
        words = readout(f"jumps, {way}", ("frequency", hertz(jump.frequency_hz), "Hz"))
        panel.draw(
            mark | {"size": 90, "filled": True, "color": "#222222"},
            [{"x": x, "y": y, "readout": words}],
        )
    read, force = [], curves[judge.label]
    for k in read_places(rpm, force, int(width / 14.0)):
        words = readout(
            "stable" if judge.stable[k] else "unstable",
            ("speed", f"{rpm[k]:.0f}", "rpm"),
            ("frequency", hertz(float(judge.frequency_hz[k])), "Hz"),
            ("mesh force", plain(float(force[k]), 4), unit),
            ("in contact", f"{100 * judge.driving[k]:.0f}", "% of the cycle"),
        )
        read.append({"x": rpm[k], "y": force[k], "readout": words})
    panel.read(read, LOOKS[STABLE].colour)
    return panel


def _branch(panel: Panel, branch: Any, rpm: np.ndarray, units: Units, calm: str) -> None:
    """Draw stable and unstable parts of a branch."""
    force = units.values(branch.force, "N")
    for name, chosen, dash in ((UNSTABLE, ~branch.stable, [3, 2]), (calm, branch.stable, [1, 0])):
        for part, (a, b) in enumerate(_runs(chosen)):
            # a part reaches its neighbours, so that the branch has no gaps
            a, b = max(a - 1, 0), min(b + 1, len(rpm))
            rows = curve(rpm[a:b], force[a:b], name=name, detail=part)
            panel.draw({"type": "line", "strokeWidth": 2.0, "strokeDash": dash}, rows)


def waterfall_chart(study: Any, run: Any, title: str, width: float = WIDE) -> Chart:
    """Chart spectra of the mesh force over a run through the speeds, with orders of the mesh."""
    spectra, teeth = run.run.spectra, study.teeth_a_turn
    rising = np.argsort(spectra.omega)
    rpm = 60 * spectra.omega[rising] / (2 * np.pi * teeth)
    hertz = spectra.omega[rising, None] / (2 * np.pi) * spectra.order
    orders = {f"order {order:g}": order * teeth for order in MESH_ORDERS}
    highest = MESH_SEEN * float(spectra.omega.max()) / (2 * np.pi)
    words = f"{_run_name(run, teeth).capitalize()}: mesh force, each spectrum {DEEP:g} dB high"
    panel = waterfall(rpm, hertz, spectra.size[rising], orders, teeth.of, highest, words)
    return Chart([[panel]], width, title)


def _run_name(run: Any, teeth: int) -> str:
    return f"run-{'up' if run.ramp > 0 else 'down'} at {60 * abs(run.ramp) / teeth:.6g} rpm/s"


def _envelope(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the largest of every few cycles."""
    first = np.arange(0, len(x), -(-len(x) // (3 * BINS)))
    return x[first], np.maximum.reduceat(y, first)


def _runs(mask: np.ndarray) -> np.ndarray:
    """Return (n, 2) first and after the last of each run of True."""
    return np.flatnonzero(np.diff(np.r_[False, mask, False].astype(int))).reshape(-1, 2)


def _may_part(mesh: Any) -> bool:
    """Return True for a mesh with a gap, or the one that is driven."""
    return mesh.law == 0 or mesh.teeth.half_gap > 0


def _contact(judge: Any, rpm: np.ndarray, ends, width: float, shaft: str) -> Panel:
    """Draw shares of the cycle in contact; of stable motions the largest loss at each speed."""
    mesh = f" of the {judge.teeth.mesh}" if judge.teeth.others or judge.law else ""
    panel = Panel(
        Axis(f"speed of the {shaft} in rpm", ends),
        Axis("share of the cycle in %", (0.0, 100.0)),
        130.0,
        f"Contact{mesh} over a mesh cycle, for the motion that parts longest; blank: none is stable",
        series=CONTACT,
        legend={"orient": "top", "columns": 3 if width > NARROW else 1},
    )
    edges = np.linspace(ends[0], ends[1], BINS + 1)
    middle = (edges[1:] + edges[:-1]) / 2 * judge.frequency_hz[0] / rpm[0]
    drives, backs = np.full(BINS, np.inf), np.zeros(BINS)
    pairs = zip(judge.interpolate(middle, judge.driving), judge.interpolate(middle, judge.backside))
    for (drive_row, drive), (_, back) in pairs:
        longer = drive < drives[drive_row]
        drives[drive_row[longer]], backs[drive_row[longer]] = drive[longer], back[longer]
    rows = []
    for low, high, drive, back in zip(edges, edges[1:], 100 * drives, 100 * backs):
        if not np.isfinite(drive):
            continue
        for name, y, y2 in (
            (DRIVE, 0, drive),
            (BACK, drive, drive + back),
            (NONE, drive + back, 100),
        ):
            if y2 > y:
                # a little over the next, so that no line shows between them
                wide = high + (high - low) / 4
                rows.append({"x": low, "x2": wide, "y": y, "y2": y2, "name": name})
    panel.draw({"type": "rect", "strokeWidth": 0}, rows)
    return panel


def _orders(judge: Any, units: Units) -> Panel:
    """Return amplitudes of the mesh force by orders of the mesh."""
    worst = judge.worst
    size = units.values(worst.spectrum(), "N")
    unit, hz, periods = units.unit("N"), worst.loudest[0], worst.periods
    half = 0.3 / periods
    panel = Panel(
        Axis("order of the mesh", (2 * half - 0.2 / periods, len(size) / periods + 2 * half)),
        Axis(f"amplitude in {unit}", (0.0, 1.1 * float(size.max()))),
        130.0,
        f"Orders of the mesh force where it is largest, {hz:.0f} Hz",
        series={STABLE: LOOKS[STABLE]},
    )
    rows = [
        {
            "x": k / periods - half,
            "x2": k / periods + half,
            "y": 0.0,
            "y2": float(y),
            "fill": LOOKS[STABLE].colour,
            "readout": readout(
                f"order {k / periods:.3g}", ("mesh force", plain(float(y), 4), unit)
            ),
        }
        for k, y in enumerate(size, start=1)
    ]
    panel.draw({"type": "rect"}, rows)
    return panel
