"""Spectra of a design over speed and by orders, and the lines that the source measured."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.backlash.sheet import waterfall
from solidgear.show.panel import Panel, Series
from solidgear.show.plot import Chart
from solidgear.show.scales import Axis
from validation.reducer.design import Design
from validation.reducer.dynamics import EVERY, RUNOUT, STEPS, amplitudes, moved
from validation.reducer.multibody import Reducer
from validation.reducer.stepping import run, together

#: r/min of the pinion
SPEEDS = np.arange(4000, 10001, 500)
#: Hz; of the chart over speed
HIGHEST = 2600.0
#: of the chart by orders, N
WEAKEST, LOUDEST = 1e-2, 300.0
#: that the source says are its test bench's
BENCH = {1598, 1868}
MEASURED = {
    8000: (137, 275, 876, 1113, 1598, 1868, 2008),
    6000: (100, 200, 300, 400, 848, 1488),
}
#: largest difference from a frequency of ours that is still called it
SAME = 0.035
JOINTS = {
    "ideal joints": (0, Series("#666666")),
    "two bearings": (2, Series("#c2185b")),
    "three bearings": (3, Series("#0072b2")),
}


@dataclass(frozen=True)
class Line:
    """A measured frequency.

    Attributes
    ----------
    order : float
        Of the pinion's speed.
    name : str
        Of a frequency of the reducer, ``bench``, or ``none``.
    off : float
        From that frequency, relative.
    """

    rpm: int
    hertz: float
    order: float
    name: str
    off: float


def measured(design: Design) -> list[Line]:
    """All lines of the source beside frequencies of a design."""
    out = []
    orders = Reducer(design).orders
    turn = orders["shaft"]
    known = {f"shaft x {n}".removesuffix(" x 1"): n for n in (1, 2, 3, 4)}
    known |= {"planets": orders["planetary"] / turn, "bevel": orders["bevel"] / turn}
    for rpm, lines in MEASURED.items():
        for hertz in lines:
            order = 60 * hertz / rpm
            name, nearest = min(known.items(), key=lambda one: abs(order / one[1] - 1))
            off = order / nearest - 1
            if hertz in BENCH:
                name = "bench"
            elif abs(off) > SAME:
                name = "none"
            out.append(Line(rpm, hertz, order, name, off))
    return out


def chart() -> Chart:
    """Waterfall over speed, and orders at 8000 r/min below it."""
    return Chart(
        [[over_speed()], by_orders()],
        width=1000.0,
        title="Force of bearings on the housing, three bearings, each spectrum 50 dB high; dots: measured",
    )


def over_speed() -> Panel:
    """Spectra of the force on the housing, each at its speed."""
    some = [Reducer(Design(), 3, float(rpm), RUNOUT) for rpm in SPEEDS]
    motion = run(together([one.bodies for one in some]), 2 * STEPS, every=2 * EVERY)
    size = amplitudes(motion.place @ some[0].on_housing)
    turn = some[0].orders["shaft"]
    hertz = np.arange(1, len(size)) / turn * SPEEDS[:, None] / 60
    named = {f"order {order:g}": order for order in (1, 2, 8.4, 15, 16.8)}
    panel = waterfall(SPEEDS.astype(float), hertz, size[1:].T, named, "pinion", HIGHEST)
    for line in measured(Design()):
        place = {"x": line.hertz, "y": float(line.rpm)}
        panel.draw({"type": "point", "color": "#c2185b", "filled": True, "size": 45}, [place])
        words = line.name if line.name in ("bench", "none") else f"{line.order:.2f}"
        look = {"type": "text", "color": "#c2185b", "dy": 12}
        panel.draw(look, [{**place, "text": words}])
    return panel


def by_orders() -> list[Panel]:
    """Lines of the mesh with the sun at 8000 r/min, around three of its orders."""
    series = {name: look for name, (_, look) in JOINTS.items()}
    found = {}
    for name, (bearings, _) in JOINTS.items():
        (one,), motion = moved([Design()], bearings)
        found[name] = (
            np.arange(len(motion.force) // 2 + 1) / one.orders["shaft"],
            amplitudes(motion.force[:, 0, 1]),
        )
    out = []
    for low, high, title in ((0.0, 0.5, "carrier"), (8.0, 8.8, "planets"), (14.6, 15.4, "bevel")):
        panel = Panel(
            Axis("order of the pinion", (low, high)),
            Axis("mesh with the sun, N", (WEAKEST, LOUDEST), log=True),
            200.0,
            title,
            series=series,
            legend={"orient": "bottom"} if title == "planets" else None,
        )
        for shift, (name, (order, size)) in zip((-0.012, 0.0, 0.012), found.items()):
            here = (order > low + 0.02) & (order < high - 0.02) & (size > WEAKEST)
            rows = [
                {"x": float(x) + shift, "y": WEAKEST, "y2": float(y), "name": name}
                for x, y in zip(order[here], size[here])
            ]
            panel.draw({"type": "rule", "strokeWidth": 4}, rows)
        out.append(panel)
    return out
