"""Details of a sketch beside segments, bearings and features: fillets, masses."""

from __future__ import annotations

import math
from collections.abc import Mapping

MASS, INK = "#6b2e8a", "#222222"
FILL = {"shaft": "#d5dbe1", "frustum": "#ecd9b4", "backcone": "#dcc08a"}


def blend(pen, blend: Mapping, segments) -> None:
    """A fillet or chamfer, in both halves: what it fills or leaves."""
    r, y = blend["corner"]
    owner = next(s for s in segments if s["name"] == blend["owner"])
    fill = FILL.get(owner.get("part", "shaft"), FILL["shaft"])
    outline = blend["outline"]
    for half in (1, -1):
        x = [pen.x(b) for _, b in outline]
        height = [half * pen.radial * a for a, _ in outline]
        added = blend["edge"] == "root"
        # its own edge covers the sharp lines below it
        pen.ax.fill(
            [*x, pen.x(y)],
            [*height, half * pen.radial * r],
            facecolor=fill if added else "white",
            edgecolor=fill if added else "white",
            lw=1.6,
            zorder=3.4,
        )
        pen.ax.plot(x, height, color=INK, lw=1.1, zorder=3.6)
    size = f"R{1e3 * blend['radius']:.3g}" if "radius" in blend else f"{1e3 * blend['length']:.3g}"
    if "angle" in blend:
        size += f" x {math.degrees(blend['angle']):.3g} deg"
    (r0, y0), (r1, y1) = outline[0], outline[-1]
    # beyond the outline, where there is no material
    away = 0.1 * (1 if y1 + y0 > 2 * y else -1) * (1 if added else -1)
    up = 0.1 if blend["surface"] == "outer" else -0.1
    pen.ax.text(
        pen.x((y0 + y1) / 2) + away,
        pen.radial * (r0 + r1) / 2 + up,
        size,
        fontsize=7,
        ha="left" if away > 0 else "right",
        va="center",
        color=INK,
        zorder=10,
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.4},
    )


def mass(pen, mass: Mapping) -> None:
    """A rigid mass: its centre, joined to its station, with its name and size above."""
    x, centre = pen.x(mass["y"]), pen.x(mass["y"] + mass["offset"][1])
    # seen along x: what lies towards +z is drawn upwards
    height = pen.radial * mass["offset"][2]
    pen.ax.plot([x, centre], [0, height], color=MASS, lw=1.6, zorder=8)
    pen.ax.plot([centre], [height], marker="o", ms=10, color=MASS, alpha=0.85, zorder=10)
    pen.ax.text(
        centre,
        height + 0.12,
        f"{mass['name']}\n{mass['mass']:.4g} kg",
        color=MASS,
        ha="center",
        va="bottom",
        fontsize=8,
        linespacing=1.0,
        parse_math=False,
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.5},
        zorder=10,
    )
