"""Charts of teeth with backlash: mesh force over speed with its branches, contact over the cycle, and
the orders of the largest force.
"""

from __future__ import annotations

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
from solidgear.show.units import ENGINEERING, Units, plain
from solidgear.show.words import hertz
from solidgear.trains.response.waterfall import DEEP, waterfall

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
    found: Any, title: str, units: Units = ENGINEERING, width: float = WIDE
) -> Chart:
    """Dynamic mesh force over the speed of the pinion, share of the cycle in contact, and
    orders.
    """
    judge, teeth = found.judge, found.teeth_a_turn
    rpm = 60 * judge.frequency_hz / teeth
    ends = float(rpm.min()), float(rpm.max())
    panels = [_force(found, rpm, ends, units, width)]
    panels += [_contact(one, rpm, ends, width, teeth.of) for one in judge.meshes if _may_part(one)]
    if found.over_force:
        panels.append(_map(found, ends, units))
    return Chart(in_columns([*panels, _orders(judge, units)], 1), width, title)


def _map(found: Any, ends: tuple[float, float], units: Units) -> Panel:
    """Map of parting teeth and jumps over speed and mean force."""
    judge, teeth = found.judge, found.teeth_a_turn
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
                "x": 60 * at / teeth,
                "y": units.value(one.mean_force, "N"),
                "readout": readout("jump", ("frequency", hertz(at), "Hz")),
            }
            for one in found.over_force
            for at, up in one.jumps_hz
            if up is rising
        ]
        panel.draw({"type": "point", "shape": shape, "filled": True, "color": "#222222"}, rows)
    return panel


def _force(found: Any, rpm: np.ndarray, ends, units: Units, width: float) -> Panel:
    judge, teeth = found.judge, found.teeth_a_turn
    unit = units.unit("N")
    hz, size = judge.linear
    linear = units.values(size, "N")
    curves = {one.label: units.values(one.force, "N") for one in found.mixes}
    ran = {_run_name(one, teeth): one for one in found.runs}
    further = [units.values(one.force, "N") for one in (*judge.branches_apart, *ran.values())]
    sizes = [linear, *curves.values(), *further]
    top = 1.08 * max(float(size.max()) for size in sizes)
    named = [*(one.label for one in found.mixes[1:]), *ran]
    others = {name: Series(OTHERS[k % len(OTHERS)]) for k, name in enumerate(named)}
    panel = Panel(
        Axis(f"speed of the {teeth.of} in rpm", ends),
        Axis(f"dynamic mesh force in {unit}", (0.0, top)),
        360.0,
        "Half of the swing of the mesh force; triangles: jumps as the speed rises (up) and falls (down)",
        series={name: look for name, look in LOOKS.items() if name != APART or judge.branches_apart}
        | others,
        legend=lines_legend(3 if width > NARROW else 1),
    )
    rows = curve(60 * hz / teeth, linear, name=LINEAR)
    panel.draw({"type": "line", "strokeWidth": 1.2, "strokeDash": [5, 3]}, rows)
    for one in found.mixes[1:]:
        places, own = 60 * one.frequency_hz / teeth, curves[one.label]
        inside = one.stable & (places >= ends[0]) & (places <= ends[1])
        for part, (a, b) in enumerate(_runs(inside)):
            rows = curve(places[a:b], own[a:b], name=one.label, detail=part)
            panel.draw({"type": "line", "strokeWidth": 1.1, "clip": True}, rows)
    for name, one in ran.items():
        places, own = _envelope(60 * one.frequency_hz / teeth, units.values(one.force, "N"))
        panel.draw({"type": "line", "strokeWidth": 1.4}, curve(places, own, name=name))
    for one in (*judge.branches_apart, judge):
        calm = STABLE if one is judge else APART
        _branch(panel, one, 60 * one.frequency_hz / teeth, units, calm)
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


def _branch(panel: Panel, one: Any, rpm: np.ndarray, units: Units, calm: str) -> None:
    """Stable and unstable parts of a branch."""
    force = units.values(one.force, "N")
    for name, where, dash in ((UNSTABLE, ~one.stable, [3, 2]), (calm, one.stable, [1, 0])):
        for part, (a, b) in enumerate(_runs(where)):
            # a part reaches its neighbours, so that the branch has no gaps
            a, b = max(a - 1, 0), min(b + 1, len(rpm))
            rows = curve(rpm[a:b], force[a:b], name=name, detail=part)
            panel.draw({"type": "line", "strokeWidth": 2.0, "strokeDash": dash}, rows)


def waterfall_chart(found: Any, one: Any, title: str, width: float = WIDE) -> Chart:
    """Spectra of the mesh force over a run through the speeds, with orders of the mesh."""
    own, teeth = one.run.spectra, found.teeth_a_turn
    rising = np.argsort(own.omega)
    rpm = 60 * own.omega[rising] / (2 * np.pi * teeth)
    hertz = own.omega[rising, None] / (2 * np.pi) * own.order
    orders = {f"order {order:g}": order * teeth for order in MESH_ORDERS}
    highest = MESH_SEEN * float(own.omega.max()) / (2 * np.pi)
    words = f"{_run_name(one, teeth).capitalize()}: mesh force, each spectrum {DEEP:g} dB high"
    panel = waterfall(rpm, hertz, own.size[rising], orders, teeth.of, highest, words)
    return Chart([[panel]], width, title)


def _run_name(one: Any, teeth: int) -> str:
    return f"run-{'up' if one.ramp > 0 else 'down'} at {60 * abs(one.ramp) / teeth:.6g} rpm/s"


def _envelope(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The largest of every few cycles, no more of them than are seen."""
    first = np.arange(0, len(x), -(-len(x) // (3 * BINS)))
    return x[first], np.maximum.reduceat(y, first)


def _runs(where: np.ndarray) -> np.ndarray:
    """(n, 2) first and after the last of each run."""
    return np.flatnonzero(np.diff(np.r_[False, where, False].astype(int))).reshape(-1, 2)


def _may_part(one: Any) -> bool:
    """True if it has a gap, or is the one that is driven."""
    return one.law == 0 or one.teeth.half_gap > 0


def _contact(judge: Any, rpm: np.ndarray, ends, width: float, shaft: str) -> Panel:
    """Shares of the cycle in areas over one another; of stable motions, the largest loss a speed."""
    of = f" of the {judge.teeth.mesh}" if judge.teeth.others or judge.law else ""
    panel = Panel(
        Axis(f"speed of the {shaft} in rpm", ends),
        Axis("share of the cycle in %", (0.0, 100.0)),
        130.0,
        f"Contact{of} over a mesh cycle; of several motions, the one that parts longest; blank: none is stable",
        series=CONTACT,
        legend={"orient": "top", "columns": 3 if width > NARROW else 1},
    )
    edges = np.linspace(ends[0], ends[1], BINS + 1)
    middle = (edges[1:] + edges[:-1]) / 2 * judge.frequency_hz[0] / rpm[0]
    drives, backs = np.full(BINS, np.inf), np.zeros(BINS)
    pairs = zip(judge.interpolate(middle, judge.driving), judge.interpolate(middle, judge.backside))
    for (at, drive), (_, back) in pairs:
        longer = drive < drives[at]
        drives[at[longer]], backs[at[longer]] = drive[longer], back[longer]
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
    """Amplitudes of the mesh force by orders of the mesh."""
    own = judge.worst
    size = units.values(own.spectrum(), "N")
    unit, hz, periods = units.unit("N"), own.loudest[0], own.periods
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
