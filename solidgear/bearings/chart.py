"""Picture of catalogue bearings: stiffness over load, and how the elements share it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from solidgear.bearings.row import Contacts
from solidgear.bearings.study import BearingFacts, OverLoad
from solidgear.show.panel import GREY, Panel, Series, curve
from solidgear.show.plot import WIDE, Chart
from solidgear.show.scales import Axis, log_ticks
from solidgear.show.words import engineering

COLOURS = {"x": "#1f5fa8", "y": "#b2561a", "z": "#2b7a4b"}
#: of rows of elements
ROWS = ("#444444", "#a03070")
#: px; height of panels, and width of the one of elements
TALL, WIDTH = 290.0, 330.0


def draw_bearings(
    file: Path, facts: Sequence[BearingFacts], curves: Mapping[str, OverLoad]
) -> None:
    """Write the picture as a file that ends in ``.png`` or ``.svg``; `curves` are by bearing."""
    Chart([[_stiffness(fact, curves[fact.name]), _shares(fact.rows)] for fact in facts]).write(file)


def _stiffness(fact: BearingFacts, over_load: OverLoad) -> Panel:
    """Return the stiffness over load, and its range."""
    factors = over_load.factors
    middle, low, high = (d[:, :3] for d in (over_load.middle, over_load.low, over_load.high))
    positive = [values[values > 0] for values in (middle, low, high)]
    stiffnesses = np.concatenate(positive) if any(map(len, positive)) else np.ones(1)
    ends = stiffnesses.min() / 1.3, stiffnesses.max() * 1.3
    ticks = {size: engineering(size, 3) for size in log_ticks(*ends)}
    drawn = Panel(
        Axis("load over that of the scene", (min(factors), max(factors)), log=True),
        Axis("stiffness, N/m", ends, log=True, ticks=ticks),
        TALL,
        f"bearing {fact.name}, {fact.called}",
        series={f"K_{name}{name}": Series(colour) for name, colour in COLOURS.items()},
        legend={"orient": "top", "symbolType": "stroke", "symbolStrokeWidth": 3},
    )
    for k, (name, colour) in enumerate(COLOURS.items()):
        if not np.any(middle[:, k] > 0):
            continue
        band = curve(factors, low[:, k])
        for row, upper in zip(band, high[:, k].tolist()):
            row["y2"] = upper
        drawn.draw({"type": "area", "opacity": 0.18, "color": colour}, band)
        drawn.draw("line", curve(factors, middle[:, k], name=f"K_{name}{name}"))
    drawn.draw({"type": "rule", "color": GREY, "strokeDash": [5, 3]}, [{"x": 1.0}])
    return drawn


def _shares(rows: Sequence[Contacts]) -> Panel:
    """Load of every element as spokes: x to the right, z up, rings at round loads."""
    names = ("row",) if len(rows) == 1 else ("lower row", "upper row")
    largest = max((row.load.max() for row in rows), default=0.0) or 1.0
    step = 10.0 ** np.floor(np.log10(largest))
    step *= next(part for part in (0.2, 0.5, 1.0, 2.0, 5.0) if largest <= 5 * step * part)
    rings = np.arange(step, largest + step, step)
    reach = 1.25 * rings[-1]
    wide = reach * WIDTH / TALL
    drawn = Panel(
        Axis("", (-wide, wide), shown=False),
        Axis("", (-reach, reach), shown=False),
        TALL,
        "load of every element, N",
        series={name: Series(colour) for name, colour in zip(names, ROWS)},
        legend={"orient": "top"} if len(names) > 1 else None,
        right=WIDE / 2 - WIDTH - 80,
    )
    round_it = np.linspace(0, 2 * np.pi, 73)
    for ring in rings.tolist():
        circle = {"type": "line", "color": "#e3e3e3", "strokeWidth": 1}
        drawn.draw(circle, curve(ring * np.cos(round_it), ring * np.sin(round_it)))
    for row, (name, look) in zip(rows, drawn.series.items()):
        half = 0.55 * np.pi / len(row.azimuth)
        wedges = [
            {"x": far * np.cos(turn), "y": far * np.sin(turn), "detail": k, "name": name}
            for k, (middle, size) in enumerate(zip(row.azimuth, row.load))
            for far, turn in ((0.0, 0.0), (size, middle - half), (size, middle + half))
        ]
        mark = {"type": "line", "interpolate": "linear-closed", "fill": look.colour}
        drawn.draw(mark | {"strokeWidth": 0.5, "opacity": 0.75}, wedges)
    # between the spokes, on the side that carries least
    total = np.sum([row.load @ np.exp(1j * row.azimuth) for row in rows])
    side = -total / abs(total) if abs(total) > 0 else np.exp(0.4j)
    words = [{"x": r * side.real, "y": r * side.imag, "text": f"{r:g}"} for r in rings.tolist()]
    drawn.draw({"type": "text", "color": GREY}, words)
    far = 1.1 * rings[-1]
    ends = [("x", far, 0.0), ("z", 0.0, far), ("-x", -far, 0.0), ("-z", 0.0, -far)]
    drawn.draw({"type": "text"}, [dict(zip(("text", "x", "y"), e)) for e in ends])
    return drawn
