"""Features of a shaft in its sketch: cuts, teeth and circles of holes, fillets and masses."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from solidgear.show.sketch_pen import FILL, Pen

CUT, MASS = "#8a1f1f", "#6b2e8a"


def draw_feature(pen: Pen, feature: Mapping[str, Any], segments: Sequence[Mapping]) -> None:
    """Draw a feature of a scene, seen along x at any angle."""
    segment = next(s for s in segments if s["name"] == feature["segment"])
    if "addendum" in feature:
        _teeth(pen, feature, segment)
    elif "circle" in feature:
        _holes(pen, feature, segment)
    else:
        _cut(pen, feature, segment)


def _name(feature: Mapping) -> str:
    turn = f", at {math.degrees(feature['angle']):.3g} deg" if feature["angle"] else ""
    kind = feature["kind"].replace("_", " ")
    if feature.get("inclination"):
        turn += f", {math.degrees(feature['inclination']):.3g} deg oblique"
    if feature.get("offset"):
        turn += f", {1e3 * feature['offset']:.3g} beside the axis"
    return f"{kind}{turn}" if feature["name"] == kind else f"{kind} {feature['name']}{turn}"


def _cut(pen: Pen, cut: Mapping, segment: Mapping) -> None:
    """Draw a cut into a segment."""
    lo, hi, lean = cut["y"], cut["y"] + cut.get("length", 0.0), 0.0
    radius = segment["outer0"]
    if "diameter" in cut:
        half = cut["diameter"] / 2 / math.cos(cut["inclination"])
        lo, hi, lean = lo - half, lo + half, radius * math.tan(cut["inclination"])
    floor = radius - cut["depth"] if "depth" in cut else -radius
    x = [pen.x(y) for y in (lo - lean, hi - lean, hi + lean, lo + lean, lo - lean)]
    r = [pen.radial * v for v in (floor, floor, radius, radius, floor)]
    pen.ax.fill(x, r, facecolor="white", lw=0, zorder=4)
    pen.line(x, r, CUT, ls="-" if "depth" in cut else "--")
    place = pen.x((lo + hi) / 2), pen.radial * max(floor, 0) - 0.05
    pen.words(*place, _name(cut), CUT, va="top")


def _teeth(pen: Pen, teeth: Mapping, segment: Mapping) -> None:
    """Draw tips and roots above, and the run of the teeth below."""
    x = [pen.x(segment["y0"]), pen.x(segment["y1"])]
    ends = [pen.radial * segment[k] for k in ("outer0", "outer1")]
    tip = 1 + 2 * teeth["addendum"] / teeth["count"]
    root = 1 - 2 * teeth["dedendum"] / teeth["count"]
    for side in (1, -1):
        for share, style in ((tip, "-"), (root, "--")):
            pen.line(x, [side * share * r for r in ends], CUT, 1.0, ls=style)
        for k in (0, 1):
            band = [side * share * ends[k] for share in (root, tip)]
            pen.line([x[k]] * 2, band, CUT, 1.0)
    lean = math.tan(teeth["spiral_angle"]) * (1 if teeth["hand"] == "right" else -1)
    steps = 20
    for j in range(teeth["count"]):
        # seen from +x, with +z upwards: what turns about +y comes from +z towards the viewer
        angle, line = teeth["angle"] + 2 * math.pi * j / teeth["count"], []
        for i in range(steps + 1):
            t = i / steps
            r = segment["outer0"] + (segment["outer1"] - segment["outer0"]) * t
            if math.sin(angle) > 0 and math.cos(angle) < 0:
                line.append((x[0] + (x[1] - x[0]) * t, pen.radial * tip * r * math.cos(angle)))
            slope = (segment["outer1"] - segment["outer0"]) / (segment["y1"] - segment["y0"])
            step = (segment["y1"] - segment["y0"]) / steps * math.hypot(1.0, slope)
            angle += lean * step / r
        if line:
            places, heights = zip(*line)
            pen.line(places, heights, CUT, 0.7, alpha=0.8)
    text = f"{teeth['count']} {_name(teeth)}"
    if teeth["spiral_angle"]:
        text += f", {math.degrees(teeth['spiral_angle']):.3g} deg {teeth['hand']}"
    if teeth["model"] == "pitch_cone":
        text += " (smeared)"
    pen.words(sum(x) / 2, 0.6 * sum(ends) / 2, text, CUT, va="top")


def _holes(pen: Pen, bolts: Mapping, segment: Mapping) -> None:
    """Draw the outlines of a hole above and below, hidden."""
    lo, hi = segment["y0"], segment["y1"]
    if bolts.get("depth") is not None:
        lo, hi = (
            (lo, lo + bolts["depth"]) if bolts["side"] == "start" else (hi - bolts["depth"], hi)
        )
    x = [pen.x(y) for y in (lo, hi, hi, lo, lo)]
    middle, half = bolts["circle"] / 2, bolts["diameter"] / 2
    for side in (1, -1):
        r = [side * pen.radial * v for v in (middle - half,) * 2 + (middle + half,) * 2]
        pen.line(x, [*r, r[0]], CUT, ls="--")
    size = f"{2e3 * half:.4g}"
    text = f"{bolts['count']} x ⌀{size} {_name(bolts)}"
    pen.words((x[0] + x[1]) / 2, pen.radial * (middle - half) - 0.05, text, CUT, va="top")


def draw_blend(pen: Pen, blend: Mapping, segments) -> None:
    """Draw a fillet or chamfer in both halves."""
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
    offset = 0.1 if blend["surface"] == "outer" else -0.1
    place = pen.x((y0 + y1) / 2) + away, pen.radial * (r0 + r1) / 2 + offset
    pen.words(*place, size, ha="left" if away > 0 else "right", size=7, pad=0.4)


def draw_mass(pen: Pen, mass: Mapping) -> None:
    """Draw a rigid mass: its centre, joined to its station, with name and size above."""
    x, centre = pen.x(mass["y"]), pen.x(mass["y"] + mass["offset"][1])
    # seen along x: what lies towards +z is drawn upwards
    height = pen.radial * mass["offset"][2]
    pen.line([x, centre], [0, height], MASS, 1.6, 8)
    pen.ax.plot([centre], [height], marker="o", ms=10, color=MASS, alpha=0.85, zorder=10)
    text = f"{mass['name']}\n{mass['mass']:.4g} kg"
    pen.words(centre, height + 0.12, text, MASS, va="bottom", linespacing=1.0)
