"""Waterfall: spectra over frequency, each at its speed, with lines of orders."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from solidgear.show.panel import Axis, Panel, curve

#: dB below the largest line at which spectra begin, and how high one is over the distance of two
DEEP, TALL = 50.0, 1.8
#: of spectra, of lines of orders and of their names
LOOK, LINE, NAME = "#0072b2", "#cccccc", "#777777"


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
