"""Details of a sketch beside segments, bearings and features: fillets, masses."""

from __future__ import annotations

import math
from collections.abc import Mapping

from solidgear.report.sketch_pen import FILL, Pen

MASS = "#6b2e8a"


def draw_blend(pen: Pen, blend: Mapping, segments) -> None:
    """A fillet or chamfer, in both halves: what it fills or leaves."""
    r, y = blend["corner"]
    owner = next(s for s in segments if s["name"] == blend["owner"])
    added, outline = blend["edge"] == "root", blend["outline"]
    colour = FILL.get(owner.get("part", "shaft"), FILL["shaft"]) if added else "white"
    for half in (1, -1):
        x = [pen.x(b) for _, b in outline]
        height = [half * pen.radial * a for a, _ in outline]
        # its own edge covers the sharp lines below it
        around = [*x, pen.x(y)], [*height, half * pen.radial * r]
        pen.ax.fill(*around, facecolor=colour, edgecolor=colour, lw=1.6, zorder=3.4)
        pen.line(x, height, order=3.6)
    size = f"R{1e3 * blend['radius']:.3g}" if "radius" in blend else f"{1e3 * blend['length']:.3g}"
    if "angle" in blend:
        size += f" x {math.degrees(blend['angle']):.3g} deg"
    (r0, y0), (r1, y1) = outline[0], outline[-1]
    # beyond the outline, where there is no material
    away = 0.1 * (1 if y1 + y0 > 2 * y else -1) * (1 if added else -1)
    up = 0.1 if blend["surface"] == "outer" else -0.1
    place = pen.x((y0 + y1) / 2) + away, pen.radial * (r0 + r1) / 2 + up
    pen.words(*place, size, ha="left" if away > 0 else "right", size=7, pad=0.4)


def draw_mass(pen: Pen, mass: Mapping) -> None:
    """A rigid mass: its centre, joined to its station, with its name and size above."""
    x, centre = pen.x(mass["y"]), pen.x(mass["y"] + mass["offset"][1])
    # seen along x: what lies towards +z is drawn upwards
    height = pen.radial * mass["offset"][2]
    pen.line([x, centre], [0, height], MASS, 1.6, 8)
    pen.ax.plot([centre], [height], marker="o", ms=10, color=MASS, alpha=0.85, zorder=10)
    text = f"{mass['name']}\n{mass['mass']:.4g} kg"
    pen.words(centre, height + 0.12, text, MASS, va="bottom", linespacing=1.0)
