"""The scene as a dimensioned section, to scale along the shaft."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from solidgear.show.sketch_features import MASS, draw_blend, draw_feature, draw_mass
from solidgear.show.sketch_pen import FILL, INK, Pen
from solidgear.show.words import is_number

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
