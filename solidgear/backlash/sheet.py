"""The sheet of a train with backlash: branches and runs as numbers, tables, and charts of mesh force over
speed, contact over the cycle, orders of the largest force and spectra along runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from solidgear.backlash.nonlinear import Nonlinear
from solidgear.backlash.periodic import Backlash, runs_of
from solidgear.backlash.speed_run import SpeedRun
from solidgear.backlash.study import BacklashStudy
from solidgear.show.command import caution
from solidgear.show.panel import GREY, Panel, Series, curve, lines_legend, read_places, readout
from solidgear.show.plot import NARROW, WIDE, Chart, Make, in_columns
from solidgear.show.scales import Axis
from solidgear.show.sheet import Sheet, Terminal
from solidgear.show.table import Column, Table, numbers, quantity, text
from solidgear.show.units import ENGINEERING, Units, plain
from solidgear.show.words import DASH, hertz
from solidgear.trains.judge.comparison import train_data
from solidgear.trains.modes.modes import unpublished_lines
from solidgear.trains.page import tables as train_tables
from solidgear.trains.page.files import places

JUMPS = text("jump up, Hz"), text("jump down, Hz")
#: what charts say
FORCES = (
    "Dynamic mesh force over the speed of the {0}: periodic motions with backlash, stable and "
    "unstable, with the jumps between them, runs through the speeds, and the linear answer. Below: "
    "contact over the cycle, and the orders of the largest force."
)
SPECTRA = (
    "Spectra of the mesh force along the run, each over 16 to 64 mesh cycles around its speed; grey: "
    "orders of the mesh."
)


def nonlinear_sheet(result: Nonlinear, units: Units) -> Sheet:
    """Return the sheet of a train whose teeth have backlash."""
    study, assembly, cautions = result.study, result.assembly, result.cautions
    title = f"{study.train.called}: teeth with backlash"
    if study.teeth.others:
        title += f", driven by the {study.teeth.mesh}"
    teeth, sentences = lead(study, units), study.sentences()
    by_mix, by_force = mixes(study, units), over_force(study, units)
    waterfalls: dict[str, Make] = {
        f"waterfall_{_stem(study, run)}": partial(waterfall_chart, study, run, title)
        for run in study.runs
    }
    return Sheet(
        name="nonlinear",
        title=title,
        lead=teeth,
        tables=[by_mix, by_force, train_tables.facts(train_data(assembly), units)],
        data={"title": title, **study.as_dict(), "cautions": [*cautions]},
        charts={"nonlinear": partial(backlash_chart, study, title, units), **waterfalls},
        lines=lines(study),
        cautions=cautions,
        verdict=sentences,
        terminal=Terminal(
            heading=[f"{title}.", teeth, *sentences, *map(caution, cautions)],
            tables=[by_mix, *unpublished_lines(study.train.unpublished()), by_force],
            closing=(),
            results=(),
            lines="whole",
        ),
        words={
            "nonlinear": FORCES.format(study.teeth_a_turn.of),
            **dict.fromkeys(waterfalls, SPECTRA),
        },
    )


def lead(study: BacklashStudy, units: Units) -> str:
    """Return data of the teeth and the models in a sentence."""
    teeth = study.teeth
    error = ", ".join(units.text(e, "m moved", 4) for e in teeth.errors)
    if teeth.phases:
        error += f" at phases {', '.join(f'{np.degrees(p):.4g}°' for p in teeth.phases)}"
    cycles = {"stiffness": teeth.cycle, "line of action": teeth.turns}
    varying = " and ".join(name for name, varies in cycles.items() if varies)
    cycle = f" {varying.capitalize()} over the mesh cycle as in the file." if varying else ""
    gap, *gaps = [units.text(2 * mesh.half_gap, "m moved", 4) for mesh in teeth.meshes]
    force, *forces = [units.text(mesh.mean_force, "N", 4) for mesh in teeth.meshes]
    further = [
        f" {mesh.mesh.capitalize()}: backlash {gap}, mean force {force}."
        for mesh, gap, force in zip(teeth.others, gaps, forces)
    ]
    return (
        f"Backlash {gap}, mean mesh force {force} ({teeth.source}), transmission error {error}; "
        f"{study.judge.label}.{cycle}{''.join(further)}"
    )


def lines(study: BacklashStudy) -> dict[str, Table]:
    """Return branches and runs of the first mix in SI, by file name."""
    teeth, judge = study.teeth_a_turn, study.judge
    out = {"nonlinear": _branch_lines(judge, teeth)}
    for k, branch in enumerate(judge.branches_apart, start=1):
        out[f"apart_{k}_of_{branch.periods}_periods"] = _branch_lines(branch, teeth)
    for run in study.runs:
        columns = {
            **places(run.frequency_hz, teeth),
            "dynamic mesh force [N]": run.force,
            "largest mesh force [N]": run.run.highest,
            "steady dynamic mesh force [N]": run.steady_force,
        }
        for mesh in run.meshes[1:]:
            name = mesh.backlash.teeth.mesh
            columns[f"{name} dynamic force [N]"] = mesh.force
            columns[f"{name} largest force [N]"] = mesh.run.highest
        out[_stem(study, run)] = numbers(columns).counted("cycle")
    return out


def _branch_lines(branch: Backlash, teeth: float) -> Table:
    """Return the points of a branch in their order."""
    columns = {
        **places(branch.frequency_hz, teeth),
        "dynamic mesh force [N]": branch.force,
        "largest mesh force [N]": branch.highest,
        "share of the cycle in contact": branch.driving,
        "share on the other flank": branch.backside,
        "stable": branch.stable.astype(float),
        "largest multiplier": np.abs(branch.multiplier),
    }
    for mesh in branch.meshes[1:]:
        name = mesh.teeth.mesh
        columns[f"{name} dynamic force [N]"] = mesh.force
        columns[f"{name} largest force [N]"] = mesh.highest
        columns[f"{name} share of the cycle in contact"] = mesh.driving
    return numbers(columns).counted("point")


def _stem(study: BacklashStudy, run: SpeedRun) -> str:
    """Return the name of the file of a run."""
    return f"run_{run.way}_{study.rpm(abs(run.ramp)):g}".replace(".", "_")


def mixes(study: BacklashStudy, units: Units = ENGINEERING) -> Table:
    """Return jumps and largest force of every mix."""
    force = quantity("largest", "N", units, digits=4)
    hz = Column("at, Hz", write=hertz, name="frequency of the largest")
    linear = quantity("linear", "N", units, digits=4)
    linear_hz = Column("at, Hz", write=hertz, name="frequency of the largest linear")
    others = [
        quantity(mesh.mesh.removeprefix("mesh "), "N", units, digits=4)
        for mesh in study.teeth.others
    ]
    rows = []
    for mix in study.mixes:
        largest, unbounded = mix.worst.loudest, mix.linear_loudest
        jumps = _jump_texts([(jump.frequency_hz, jump.rising) for jump in mix.jumps])
        rows.append(
            [
                mix.label,
                *jumps,
                largest.force,
                largest.frequency_hz,
                unbounded.force,
                unbounded.frequency_hz,
                *(mesh.worst.loudest.force for mesh in mix.meshes[1:]),
            ]
        )
    heads = [text("shafts"), *JUMPS, force, hz, linear, linear_hz, *others]
    return Table("Jumps and largest dynamic mesh force", heads, rows, style="bare")


def over_force(study: BacklashStudy, units: Units = ENGINEERING) -> Table:
    """Return jumps over the mean force of the teeth."""
    rows = [
        [
            branch.mean_force,
            branch.mean_force * study.lever,
            *_jump_texts(branch.jumps_hz),
            branch.largest,
        ]
        for branch in study.over_force
    ]
    mean, torque = (
        quantity(head, si, units, digits=4) for head, si in (("mean force", "N"), ("torque", "N m"))
    )
    heads = [mean, torque, *JUMPS, quantity("largest", "N", units, digits=4)]
    title = f"Jumps over the torque of the {study.train.reference}, on the branch from low speed"
    return Table(title, heads, rows, style="bare")


def _jump_texts(jumps: Sequence[tuple[float, bool]]) -> list[str]:
    """Return frequencies of jumps (Hz, whether the speed rises): as it rises, and as it falls."""
    return [
        ", ".join(hertz(hz) for hz, rises in jumps if rises is rising) or DASH
        for rising in (True, False)
    ]


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
#: dB below the largest line at which spectra begin, and how high one is over the distance of two
DEEP, TALL = 50.0, 1.8
#: of spectra, of lines of orders and of their names
LOOK, LINE, NAME = "#0072b2", "#cccccc", "#777777"
#: orders of the mesh drawn over a run, and up to which frequencies are, of the highest of the mesh
MESH_ORDERS, MESH_SEEN = (0.5, 1, 2, 3, 4), 2.0
#: of answers without backlash
DASHED = {"type": "line", "strokeWidth": 1.2, "strokeDash": [5, 3]}
#: bins of the speed in which shares of the cycle are drawn
BINS = 160


def backlash_chart(
    study: BacklashStudy, title: str, units: Units = ENGINEERING, width: float = WIDE
) -> Chart:
    """Chart dynamic mesh force over speed, share of the cycle in contact, and orders."""
    judge = study.judge
    rpm = study.rpm(judge.frequency_hz)
    speeds = Axis(
        f"speed of the {study.teeth_a_turn.of} in rpm", (float(rpm.min()), float(rpm.max()))
    )
    panels = [_forces(study, speeds, units, width)]
    # a mesh without a gap keeps contact, but the one that is driven is shown
    gapped = [mesh for mesh in judge.meshes if mesh.law == 0 or mesh.teeth.half_gap > 0]
    panels += [_contact(study, mesh, speeds, width) for mesh in gapped]
    if study.over_force:
        panels.append(_map(study, speeds, units))
    return Chart(in_columns([*panels, _orders(judge, units)], 1), width, title)


def _map(study: BacklashStudy, speeds: Axis, units: Units) -> Panel:
    """Return a map of parting teeth and jumps over speed and mean force."""
    hz, size = study.judge.holding
    force = units.values(size, "N")
    panel = Panel(
        speeds,
        Axis(f"mean mesh force in {units.unit('N')}", (0.0, 1.05 * float(force.max()))),
        240.0,
        "Teeth part below the line; triangles: jumps as the speed rises (up) and falls (down)",
        series={LINEAR: LOOKS[LINEAR]},
    )
    panel.draw(DASHED, curve(study.rpm(hz), force, name=LINEAR))
    for branch in study.over_force:
        for jump_hz, rising in branch.jumps_hz:
            words = readout("jump", ("frequency", hertz(jump_hz), "Hz"))
            place = {"x": study.rpm(jump_hz), "y": units.value(branch.mean_force, "N")}
            panel.draw(_triangle(rising), [{**place, "readout": words}])
    return panel


def _triangle(rising: bool) -> dict[str, Any]:
    """Return the mark of a jump."""
    shape = "triangle-up" if rising else "triangle-down"
    return {"type": "point", "shape": shape, "filled": True, "color": "#222222"}


def _forces(study: BacklashStudy, speeds: Axis, units: Units, width: float) -> Panel:
    """Return the panel of dynamic mesh forces by every branch, run and mix."""
    judge, unit = study.judge, units.unit("N")
    hz, linear = judge.linear
    ran = {_run_name(study, run): run for run in study.runs}
    sizes = [linear, *(mix.force for mix in (*study.mixes, *judge.branches_apart))]
    sizes += [run.force for run in study.runs]
    top = 1.08 * max(float(units.values(size, "N").max()) for size in sizes)
    labels = [*(mix.label for mix in study.mixes[1:]), *ran]
    panel = Panel(
        speeds,
        Axis(f"dynamic mesh force in {unit}", (0.0, top)),
        360.0,
        "Half of the swing of the mesh force; triangles: jumps as the speed rises (up) and falls (down)",
        series={name: look for name, look in LOOKS.items() if name != APART or judge.branches_apart}
        | {name: Series(OTHERS[k % len(OTHERS)]) for k, name in enumerate(labels)},
        legend=lines_legend(3 if width > NARROW else 1),
    )
    panel.draw(DASHED, curve(study.rpm(hz), units.values(linear, "N"), name=LINEAR))
    for mix in study.mixes[1:]:
        rpm, force = study.rpm(mix.frequency_hz), units.values(mix.force, "N")
        inside = mix.stable & (rpm >= speeds.ends[0]) & (rpm <= speeds.ends[1])
        for part, (a, b) in enumerate(runs_of(inside)):
            rows = curve(rpm[a:b], force[a:b], name=mix.label, detail=part)
            panel.draw({"type": "line", "strokeWidth": 1.1, "clip": True}, rows)
    for name, run in ran.items():
        rpm, force = study.rpm(run.frequency_hz), units.values(run.force, "N")
        # the largest of every few cycles
        first = np.arange(0, len(rpm), -(-len(rpm) // (3 * BINS)))
        rows = curve(rpm[first], np.maximum.reduceat(force, first), name=name)
        panel.draw({"type": "line", "strokeWidth": 1.4}, rows)
    for branch in (*judge.branches_apart, judge):
        rpm, force = study.rpm(branch.frequency_hz), units.values(branch.force, "N")
        calm = STABLE if branch is judge else APART
        for name, mask, dash in ((UNSTABLE, ~branch.stable, [3, 2]), (calm, branch.stable, [1, 0])):
            look = {"type": "line", "strokeWidth": 2.0, "strokeDash": dash}
            for part, (a, b) in enumerate(runs_of(mask)):
                # a part reaches its neighbours, so that the branch has no gaps
                a, b = max(a - 1, 0), min(b + 1, len(rpm))
                panel.draw(look, curve(rpm[a:b], force[a:b], name=name, detail=part))
    for jump in judge.jumps:
        way = "rising" if jump.rising else "falling"
        words = readout(f"jumps, {way}", ("frequency", hertz(jump.frequency_hz), "Hz"))
        place = {"x": study.rpm(jump.frequency_hz), "y": units.value(jump.force, "N")}
        panel.draw(_triangle(jump.rising) | {"size": 90}, [{**place, "readout": words}])
    rpm, force, read = study.rpm(judge.frequency_hz), units.values(judge.force, "N"), []
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


def _run_name(study: BacklashStudy, run: SpeedRun) -> str:
    return f"run-{run.way} at {study.rpm(abs(run.ramp)):.6g} rpm/s"


def _contact(study: BacklashStudy, mesh: Backlash, speeds: Axis, width: float) -> Panel:
    """Draw shares of the cycle in contact; of stable motions the largest loss at each speed."""
    name = f" of the {mesh.teeth.mesh}" if mesh.teeth.others or mesh.law else ""
    panel = Panel(
        speeds,
        Axis("share of the cycle in %", (0.0, 100.0)),
        130.0,
        f"Contact{name} over a mesh cycle, for the motion that parts longest; blank: none is stable",
        series=CONTACT,
        legend={"orient": "top", "columns": 3 if width > NARROW else 1},
    )
    edges = np.linspace(*speeds.ends, BINS + 1)
    middle = (edges[1:] + edges[:-1]) / 2 * mesh.frequency_hz[0] / study.rpm(mesh.frequency_hz[0])
    drives, backs = np.full(BINS, np.inf), np.zeros(BINS)
    shares = mesh.interpolate(middle, mesh.driving), mesh.interpolate(middle, mesh.backside)
    for (bins, drive), (_, back) in zip(*shares):
        longer = drive < drives[bins]
        drives[bins[longer]], backs[bins[longer]] = drive[longer], back[longer]
    rows = []
    for k in np.flatnonzero(np.isfinite(drives)):
        low, high, touch = edges[k], edges[k + 1], 100 * drives[k]
        hit = touch + 100 * backs[k]
        # a little over the next, so that no line shows between them
        wide = {"x": low, "x2": high + (high - low) / 4}
        shares_there = ((DRIVE, 0, touch), (BACK, touch, hit), (NONE, hit, 100))
        rows += [{**wide, "y": y, "y2": y2, "name": part} for part, y, y2 in shares_there if y2 > y]
    panel.draw({"type": "rect", "strokeWidth": 0}, rows)
    return panel


def _orders(judge: Backlash, units: Units) -> Panel:
    """Return amplitudes of the mesh force by orders of the mesh."""
    worst = judge.worst
    size = units.values(worst.spectrum(), "N")
    unit, hz, periods = units.unit("N"), worst.loudest.frequency_hz, worst.periods
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


def waterfall_chart(study: BacklashStudy, run: SpeedRun, title: str, width: float = WIDE) -> Chart:
    """Chart spectra of the mesh force over a run through the speeds, with orders of the mesh."""
    spectra, teeth = run.run.spectra, study.teeth_a_turn
    rising = np.argsort(spectra.omega)
    hz = spectra.omega[rising] / (2 * np.pi)
    name = _run_name(study, run).capitalize()
    panel = waterfall(
        rpm=study.rpm(hz),
        hertz=hz[:, None] * spectra.order,
        size=spectra.size[rising],
        orders={f"order {order:g}": order * teeth for order in MESH_ORDERS},
        shaft=teeth.of,
        highest=MESH_SEEN * float(hz[-1]),
        title=f"{name}: mesh force, each spectrum {DEEP:g} dB high",
    )
    return Chart([[panel]], width, title)


def waterfall(
    rpm: np.ndarray,
    hertz: np.ndarray,
    size: np.ndarray,
    orders: Mapping[str, float],
    shaft: str,
    highest: float,
    title: str = "",
) -> Panel:
    """Return spectra over frequency at ascending, evenly spaced speeds, with named lines of
    orders.
    """
    step = float(rpm[1] - rpm[0]) if len(rpm) > 1 else float(rpm[0])
    tall = TALL * step
    ends = float(rpm[0]), float(rpm[-1]) + tall
    panel = Panel(
        Axis("frequency in Hz", (0.0, highest)),
        Axis(f"speed of the {shaft} in rpm", (ends[0] - 0.4 * step, ends[1] + 0.4 * step)),
        480.0,
        title,
    )
    for name, order in orders.items():
        rows = [{"x": order * speed / 60, "y": speed} for speed in ends]
        panel.draw({"type": "line", "color": LINE}, rows)
        place = min(ends[1], highest * 60 / order * 0.99)
        look = {"type": "text", "color": NAME, "dx": -4, "dy": -6, "align": "right"}
        if place > ends[0]:
            panel.draw(look, [{"x": order * place / 60, "y": place, "text": name}])
    level = 20 * np.log10(np.maximum(size / size.max(), 1e-12))
    heights = rpm[:, None] + tall * np.maximum(1 + level / DEEP, 0.0)
    for x, y in zip(hertz, heights):
        inside = (x > 0) & (x < highest)
        panel.draw({"type": "line", "color": LOOK, "strokeWidth": 1}, curve(x[inside], y[inside]))
    return panel
