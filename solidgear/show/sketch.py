"""The scene as a dimensioned section, to scale along the shaft: segments, bearings, and features (cuts,
teeth and circles of holes, fillets and masses)."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from solidgear.show.words import is_number

INK = "#222222"
FILL = {"shaft": "#d5dbe1", "frustum": "#ecd9b4", "backcone": "#dcc08a"}


@dataclass(frozen=True)
class Pen:
    """Axes of matplotlib, in inches: x along the shaft, 0 on the axis."""

    ax: Any
    left: float  #: where the shaft begins
    #: inch, radial: inches per metre along the shaft and across it
    inch: float
    radial: float
    top: float  #: largest radius

    def x(self, y: float) -> float:
        """Return the place of a position along the shaft, m."""
        return self.left + y * self.inch

    def line(
        self,
        x: Sequence[float],
        y: Sequence[float],
        colour: str = INK,
        width: float = 1.1,
        order: float = 5,
        **look: Any,
    ) -> None:
        """Draw a line through places, over lower orders."""
        self.ax.plot(x, y, color=colour, lw=width, zorder=order, **look)

    def words(
        self,
        x: float,
        y: float,
        text: str,
        colour: str = INK,
        order: float = 10,
        *,
        ha: str = "center",
        va: str = "center",
        size: float = 8,
        alpha: float = 0.8,
        pad: float = 0.5,
        **look: Any,
    ) -> None:
        """Draw words on white, texts from a file unchanged."""
        paper = {"facecolor": "white", "edgecolor": "none", "alpha": alpha, "pad": pad}
        how: dict[str, Any] = {"ha": ha, "va": va, "fontsize": size, "parse_math": False, **look}
        self.ax.text(x, y, text, color=colour, bbox=paper, zorder=order, **how)


PART_NAMES = {"shaft": "shaft", "frustum": "gear head (pitch cone)", "backcone": "backcone"}
SEAT, SPAN = "#1f5f99", "#c4541c"
#: inches on paper
WIDTH, TALLEST, FLATTEST = 10.6, 1.75, 0.45
#: in; beside the shaft, on either side, of a wide and of a narrow paper
BESIDE, NARROWLY = 0.9, 0.6
CHAR = 0.075  # of a letter at the size of the labels
LINE = 0.17  # from one line of letters to the next
#: in; of what stands before a name in the legend
HANDLE = 0.5


def extent(scene: Mapping[str, Any]) -> tuple[float, float]:
    """Return the length and largest radius of the shaft of a scene, m; zero without segments."""
    segments = scene.get("segments") or []
    radii = [max(s["outer0"], s["outer1"]) for s in segments]
    return max((s["y1"] for s in segments), default=0.0), max(radii, default=0.0)


def draw(
    scene: Mapping[str, Any], width: float = WIDTH, room: tuple[float, float] | None = None
) -> Any:
    """Draw the section of a scene, None without segments; `room` (length, largest radius) sets the
    scale, m.

    The upper half is cut (hatched), the lower half shows the surface. Radii are to the same scale
    as lengths, unless the shaft is so slender that they have to be enlarged; then the sketch says
    by how much.
    """
    from matplotlib.figure import Figure

    segments = scene.get("segments") or []
    if not segments:
        return None
    length, height_m = extent(scene)
    longest, radius = room or (length, height_m)
    drawn = width - 2 * (BESIDE if width == WIDTH else NARROWLY)
    inch = min(drawn / longest, TALLEST / radius)  # inches per metre
    enlarged = 1.0 if radius * inch >= FLATTEST else FLATTEST / (radius * inch)
    top = height_m * inch * enlarged
    margin = (width - longest * inch) / 2

    stations = [(b, False) for b in scene.get("bearings") or []]
    points = [port for port in (scene.get("port"), *(scene.get("further_ports") or [])) if port]
    stations += [(port, True) for port in points]
    labels = _labels(stations, lambda y: margin + y * inch, width)
    ordinates = _staggered([(margin + y * inch, f"{1e3 * y:.1f}") for y in _marks(scene, length)])
    above = top + 0.62 + 0.34 * (1 + max((level for *_, level in labels), default=0))
    notes = _notes(scene, enlarged)
    above += LINE * len(notes) + 0.1 * bool(notes)  # room over the names
    handles = _handles(segments, scene)
    columns = len(handles)
    if sum(2 * _half(handle.get_label()) + HANDLE for handle in handles) > width:
        columns = 2
    chain = _chain(segments, lambda y: margin + y * inch)
    deep = LINE * max((level for *_, level in chain), default=0)
    below = top + 1.62 + deep + LINE * max((level for *_, level in ordinates), default=0)
    below += LINE * (-(-len(handles) // max(columns, 1)) - 1)

    figure = Figure(figsize=(width, above + below))
    ax = figure.add_axes((0, 0, 1, 1))
    ax.set(xlim=(0, width), ylim=(-below, above))
    ax.axis("off")
    pen = Pen(ax, margin, inch, inch * enlarged, top)
    for s in segments:
        _segment(pen, s)
    pen.line(
        [margin - 0.3, margin + length * inch + 0.3], [0, 0], INK, 0.8, 4, dashes=(12, 3, 2, 3)
    )
    for blend in scene.get("blends") or []:
        draw_blend(pen, blend, segments)
    for cut in scene.get("features") or []:
        draw_feature(pen, cut, segments)
    for b in scene.get("bearings") or []:
        _bearing(pen, b, segments)
    for mass in scene.get("masses") or []:
        draw_mass(pen, mass)
    for port in points:
        _port(pen, port, segments)
    for x, text, station, is_port, level in labels:
        colour = SPAN if is_port else SEAT
        foot, height = 0.08 if is_port else top + 0.45, top + 0.62 + 0.34 * level
        pen.line([station, station], [foot, height - 0.04], colour, 0.6, 6)
        look: dict[str, Any] = {"va": "bottom", "size": 8.5, "linespacing": 1.1}
        pen.words(x, height, text, colour, 7, alpha=1.0, pad=0.6, **look)
    _lengths(pen, segments, chain, -top - 0.72)
    _ruler(pen, ordinates, length, -top - 1.04 - deep)
    for k, note in enumerate(notes):
        how: dict[str, Any] = {"va": "top", "fontsize": 8, "style": "italic", "parse_math": False}
        ax.text(0.15, above - 0.1 - LINE * k, note, **how)
    _legend(ax, handles, columns, (width / 2, -below + 0.1))
    return figure


def _notes(scene: Mapping, enlarged: float) -> list[str]:
    """Return remarks on what the drawing leaves out or does not draw to scale."""
    notes = []
    if body := scene.get("body"):
        notes.append(
            f"round part of {body['name']}, {100 * body['round_share']:.3g} % of its surface"
        )
    if enlarged > 1:
        notes.append(f"radii drawn {enlarged:.2g} times larger than lengths")
    if scene.get("housing") or is_number(scene.get("housing_axial")):
        around = "a 6x6 spring" if scene.get("housing") else "an axial spring"
        notes.append(f"not drawn: housing on {around}")
    return notes


def _marks(scene: Mapping, length: float) -> list[float]:
    points = [
        port["y"] for port in (scene.get("port"), *(scene.get("further_ports") or [])) if port
    ]
    return sorted({0.0, length, *points, *(b["y"] for b in scene.get("bearings") or [])})


def _staggered(items: list[tuple]) -> list[tuple]:
    """Return (x of the middle, text, more) with the lowest level at which texts do not overlap."""
    ends: list[float] = []
    placed = []
    for item in sorted(items, key=lambda item: item[:2]):
        x, half = item[0], _half(item[1]) + 0.05
        level = next((k for k, end in enumerate(ends) if x - half >= end), len(ends))
        ends[level : level + 1] = [x + half]
        placed.append((*item, level))
    return placed


def _half(text: str) -> float:
    """Return half of the width of a text at the size of the labels, in."""
    return CHAR * max(len(line) for line in text.splitlines() or [""]) / 2


def _labels(stations, place, width: float) -> list[tuple]:
    """Return (x of the text, text, x of the station, whether it is a lumped point, level)."""
    texts = []
    for s, is_port in stations:
        name = str(s.get("name", ""))
        name = name if len(name) <= 22 else name[:21] + "…"
        kind = {"clamped": "clamp", "pinned": "pin"}.get(s.get("hold") or "", "bearing")
        label = f"lumped point {name}" if is_port else f"{kind} {name}"
        surface = "span" if is_port else "seat"
        below = f"{s.get('attachment', '')}, {surface} {1e3 * (s['hi'] - s['lo']):.1f} mm"
        text, x = f"{label}\n{below}", place(s["y"])
        half = min(_half(text), width / 2)
        texts.append((min(max(x, half), width - half), text, x, is_port))
    return _staggered(texts)


def _chain(segments, place) -> list[tuple]:
    """Return (x of the middle, text, both ends on paper, level) of the length of every segment."""
    dimensions = []
    for s in segments:
        a, b = place(s["y0"]), place(s["y1"])
        text = f"{1e3 * (s['y1'] - s['y0']):.2f}".rstrip("0").rstrip(".")
        dimensions.append(((a + b) / 2, text, (a, b)))
    return _staggered(dimensions)


def _surface(segments, lo: float, hi: float) -> list[tuple[float, float]]:
    """Return (y, outer radius) along the shaft from `lo` to `hi`, steps included."""
    points = []
    for s in segments:
        a, b = max(lo, s["y0"]), min(hi, s["y1"])
        if b - a > 1e-9:
            slope = (s["outer1"] - s["outer0"]) / (s["y1"] - s["y0"])
            points += [(y, s["outer0"] + slope * (y - s["y0"])) for y in (a, b)]
    return points


def _segment(pen: Pen, s: Mapping) -> None:
    """Draw a segment, cut above and from outside below, with its diameters."""
    x0, x1 = pen.x(s["y0"]), pen.x(s["y1"])
    o0, o1, i0, i1 = (pen.radial * s[k] for k in ("outer0", "outer1", "inner0", "inner1"))
    colour, along = FILL.get(s.get("part", "shaft"), FILL["shaft"]), [x0, x1, x1, x0]
    cut: dict[str, Any] = {"facecolor": colour, "edgecolor": "#8a8f94", "hatch": "////", "lw": 0}
    pen.ax.fill(along, [i0, i1, o1, o0], zorder=2, **cut)
    pen.ax.fill(along, [0, 0, -o1, -o0], facecolor=colour, alpha=0.55, lw=0, zorder=2)
    pen.line([x0, x0, x1, x1, x0], [-o0, o0, o1, -o1, -o0], order=3)
    if i0 > 0 or i1 > 0:
        pen.line([x0, x1], [i0, i1], INK, 0.9, 3)
        pen.line([x0, x1], [-i0, -i1], INK, 0.7, 3, ls="--")
    _diameter(pen, s, x0, x1, min(o0, o1))


def _diameter(pen: Pen, s: Mapping, x0: float, x1: float, room: float) -> None:
    d0, d1 = (f"⌀{2e3 * s[k]:.5g}" for k in ("outer0", "outer1"))
    text = d0 if d0 == d1 else f"{d0} – {d1}"
    bore = ""
    if s["inner0"] or s["inner1"]:
        bore = f"\nbore {2e3 * s['inner0']:.5g}"
        if s["inner0"] != s["inner1"]:
            bore += f" – {2e3 * s['inner1']:.5g}"
    size = CHAR * max(len(line) for line in (text + bore).splitlines()) * 0.95
    upright = size > x1 - x0
    if upright and (size > 0.95 * room or x1 - x0 < 0.14):
        return
    turn = 90 if upright else 0
    pen.words((x0 + x1) / 2, -room / 2, text + bore, order=5, alpha=0.55, rotation=turn)


def _seat(pen: Pen, s: Mapping, segments, side: int, colour: str, width: float, **look) -> None:
    """Draw the surface that carries a bearing or lumped point, on one side of the axis."""
    points = _surface(segments, s["lo"], s["hi"])
    x, r = [pen.x(y) for y, _ in points], [side * pen.radial * r for _, r in points]
    pen.line(x, r, colour, width, solid_capstyle="butt", **look)


#: of a spring, from the seat to the ground: inches aside, and share of the way
SPRING = [
    *((0, 0), (0, 0.2)),
    *((0.07 * (-1) ** k, 0.2 + 0.6 * (k + 0.5) / 6) for k in range(6)),
    *((0, 0.8), (0, 1)),
]


def _bearing(pen: Pen, b: Mapping, segments) -> None:
    """Draw the seat of a bearing, and springs from it to the ground."""
    middle = _surface(segments, b["y"] - 1e-6, b["y"] + 1e-6)
    radius = pen.radial * (middle[0][1] if middle else 0.0)
    x, ground = pen.x(b["y"]), pen.top + 0.38
    rise = ground - radius
    for side in (1, -1):
        _seat(pen, b, segments, side, SEAT, 4.5)
        zigzag = [x + aside for aside, _ in SPRING], [side * (radius + t * rise) for _, t in SPRING]
        pen.line(*zigzag, SEAT)
        pen.line([x - 0.17, x + 0.17], [side * ground] * 2, SEAT, 1.4)
        for k in range(6):
            foot = x - 0.17 + 0.068 * k
            pen.line([foot, foot - 0.05], [side * ground, side * (ground + 0.06)], SEAT, 0.7)


def _port(pen: Pen, port: Mapping, segments) -> None:
    """Draw a lumped point, and its spokes to the surface that carries it."""
    x = pen.x(port["y"])
    for side in (1, -1):
        _seat(pen, port, segments, side, SPAN, 4, alpha=0.9)
        for k in range(5):
            y = port["lo"] + (port["hi"] - port["lo"]) * (0.04 + 0.92 * k / 4)
            spot = _surface(segments, y - 1e-6, y + 1e-6)
            if spot:
                end = side * pen.radial * spot[0][1]
                pen.line([x, pen.x(y)], [0, end], SPAN, 0.5, 4, ls=":")
    pen.ax.plot([x], [0], marker="o", ms=8, mfc="white", mec=SPAN, mew=1.6, zorder=8)
    pen.ax.plot([x], [0], marker="+", ms=8, mec=SPAN, mew=1.0, zorder=9)


def _lengths(pen: Pen, segments, chain: list[tuple], level: float) -> None:
    """Draw the chain of segment lengths; a text without room stands below it."""
    for s in segments:
        for x, y in ((pen.x(s["y0"]), s["outer0"]), (pen.x(s["y1"]), s["outer1"])):
            pen.line([x, x], [-pen.radial * y - 0.04, level - 0.06], "#777777", 0.4, 1)
    arrow = {"arrowstyle": "<|-|>", "lw": 0.6, "shrinkA": 0, "shrinkB": 0, "color": INK}
    for middle, text, (a, b), step in chain:
        wide = b - a > CHAR * len(text) + 0.2
        look = {**arrow, "mutation_scale": 6 if wide else 4}
        pen.ax.annotate("", (a, level), (b, level), arrowprops=look)
        place = level - 0.07 - LINE * (step - 1) if step else level + (0.02 if wide else 0.07)
        pen.words(middle, place, text, "black", 6, va="top" if step else "bottom", alpha=1.0)


def _ruler(pen: Pen, ordinates, length: float, level: float) -> None:
    """Draw positions from y = 0 of the ends, the bearings and the lumped point."""
    pen.line([pen.x(0), pen.x(length)], [level, level], INK, 0.6, 2)
    for x, text, step in ordinates:
        pen.line([x, x], [level + 0.05, level - 0.05 - 0.17 * step], INK, 0.6, 2)
        pen.ax.text(x, level - 0.07 - 0.17 * step, text, ha="center", va="top", fontsize=8)
    pen.ax.text(pen.x(length) + 0.22, level, "y, mm", va="center", fontsize=8, style="italic")


def _handles(segments, scene) -> list[Any]:
    """Return entries of the legend."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    parts = [p for p in FILL if any(s.get("part", "shaft") == p for s in segments)]
    handles: list[Any] = [
        Patch(facecolor=FILL[p], edgecolor=INK, lw=0.6, label=PART_NAMES[p]) for p in parts
    ]
    if scene.get("bearings"):
        handles.append(Line2D([], [], color=SEAT, lw=4, label="bearing seat"))
    if scene.get("masses"):
        handles.append(
            Line2D([], [], color=MASS, marker="o", ms=7, lw=0, label="rigid mass, at its centre")
        )
    if scene.get("port"):
        handles.append(
            Line2D([], [], color=SPAN, lw=4, label="surface that carries the lumped point")
        )
    return handles


def _legend(ax, handles: list[Any], columns: int, place: tuple[float, float]) -> None:
    ax.legend(
        handles=handles,
        loc="lower center",
        bbox_to_anchor=place,
        bbox_transform=ax.transData,
        ncols=max(columns, 1),
        frameon=False,
        fontsize=8,
        borderaxespad=0,
    )


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
