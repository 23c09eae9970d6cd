"""Picture of catalogue bearings: stiffness over load, and how the elements share it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from solidgear.show.panel import GREY, Axis, Panel, Series, curve, log_ticks
from solidgear.show.plot import WIDE, Chart
from solidgear.show.words import engineering

COLOURS = {"x": "#1f5fa8", "y": "#b2561a", "z": "#2b7a4b"}
#: of rows of elements
ROWS = ("#444444", "#a03070")
#: px; height of panels, and width of the one of elements
TALL, WIDTH = 290.0, 330.0


class BearingPanel(NamedTuple):
    """Curves of one bearing over its load."""

    title: str
    factors: np.ndarray  #: (n,) times the load of the scene
    #: middle, low, high: (n, 3) stiffness in x, y and z, N/m, and the ends of its range
    middle: np.ndarray
    low: np.ndarray
    high: np.ndarray
    rows: Sequence[tuple[np.ndarray, np.ndarray]]  #: of every element, rad from x towards z, and N


def draw_bearings(file: Path, panels: Sequence[BearingPanel]) -> None:
    """Write the picture as a file that ends in ``.png`` or ``.svg``."""
    Chart([[_stiffness(panel), _shares(panel)] for panel in panels]).write(file)


def _stiffness(panel: BearingPanel) -> Panel:
    """Return the stiffness over load, and its range."""
    positive = [values[values > 0] for values in (panel.middle, panel.low, panel.high)]
    stiffnesses = np.concatenate(positive) if any(map(len, positive)) else np.ones(1)
    ends = stiffnesses.min() / 1.3, stiffnesses.max() * 1.3
    ticks = {size: engineering(size, 3) for size in log_ticks(*ends)}
    drawn = Panel(
        Axis("load over that of the scene", (min(panel.factors), max(panel.factors)), log=True),
        Axis("stiffness, N/m", ends, log=True, ticks=ticks),
        TALL,
        panel.title,
        series={f"K_{name}{name}": Series(colour) for name, colour in COLOURS.items()},
        legend={"orient": "top", "symbolType": "stroke", "symbolStrokeWidth": 3},
    )
    for k, (name, colour) in enumerate(COLOURS.items()):
        if not np.any(panel.middle[:, k] > 0):
            continue
        band = curve(panel.factors, panel.low[:, k])
        for row, high in zip(band, panel.high[:, k].tolist()):
            row["y2"] = high
        drawn.draw({"type": "area", "opacity": 0.18, "color": colour}, band)
        drawn.draw("line", curve(panel.factors, panel.middle[:, k], name=f"K_{name}{name}"))
    drawn.draw({"type": "rule", "color": GREY, "strokeDash": [5, 3]}, [{"x": 1.0}])
    return drawn


def _shares(panel: BearingPanel) -> Panel:
    """Load of every element as spokes: x to the right, z up, rings at round loads."""
    names = ("row",) if len(panel.rows) == 1 else ("lower row", "upper row")
    largest = max((load.max() for _, load in panel.rows), default=0.0) or 1.0
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
    for (azimuth, load), (name, look) in zip(panel.rows, drawn.series.items()):
        half = 0.55 * np.pi / len(azimuth)
        wedges = [
            {"x": far * np.cos(turn), "y": far * np.sin(turn), "detail": k, "name": name}
            for k, (middle, size) in enumerate(zip(azimuth, load))
            for far, turn in ((0.0, 0.0), (size, middle - half), (size, middle + half))
        ]
        mark = {"type": "line", "interpolate": "linear-closed", "fill": look.colour}
        drawn.draw(mark | {"strokeWidth": 0.5, "opacity": 0.75}, wedges)
    # between the spokes, on the side that carries least
    total = np.sum([load @ np.exp(1j * azimuth) for azimuth, load in panel.rows])
    side = -total / abs(total) if abs(total) > 0 else np.exp(0.4j)
    words = [{"x": r * side.real, "y": r * side.imag, "text": f"{r:g}"} for r in rings.tolist()]
    drawn.draw({"type": "text", "baseline": "middle", "color": GREY}, words)
    far = 1.1 * rings[-1]
    ends = [("x", far, 0.0), ("z", 0.0, far), ("-x", -far, 0.0), ("-z", 0.0, -far)]
    drawn.draw(
        {"type": "text", "baseline": "middle"}, [dict(zip(("text", "x", "y"), e)) for e in ends]
    )
    return drawn
