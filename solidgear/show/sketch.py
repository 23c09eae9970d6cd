"""The scene as a dimensioned section, to scale along the shaft: segments, bearings, and features (cuts,
teeth and circles of holes, fillets and masses)."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from solidgear.show.pen import Pen, element, path, short, width_of
from solidgear.show.plot import Picture
from solidgear.show.words import is_number

INK = "#222222"
FILL = {"shaft": "#d5dbe1", "frustum": "#ecd9b4", "backcone": "#dcc08a"}
#: points of paper in an inch, and height of letters in points
POINTS, SIZE = 72.0, 8.0
#: dashes of lines, in their widths
DASHED, DOTTED, CHAINED = (3.7, 1.6), (1.0, 1.65), (12.0, 3.0, 2.0, 3.0)
#: of hatching: its lines, their width and distance, points
HATCH, FINE, PITCH = "#8a8f94", 0.4, 5.0


@dataclass(frozen=True)
class Board:
    """Paper in inches: x along the shaft, and height from its axis up."""

    pen: Pen
    above: float  #: from the upper edge of the paper to the axis
    left: float  #: where the shaft begins
    #: inch, radial: inches per metre along the shaft and across it
    inch: float
    radial: float
    top: float  #: largest radius
    silent: bool = False  #: whether words are left out, for drawings with other ones

    def x(self, y: float) -> float:
        """Return the place of a position along the shaft, m."""
        return self.left + y * self.inch

    def place(self, x: float, height: float) -> tuple[float, float]:
        """Return a place as the pen counts, points from the upper left corner."""
        return POINTS * x, POINTS * (self.above - height)

    def line(
        self,
        x: Sequence[float],
        heights: Sequence[float],
        colour: str = INK,
        width: float = 1.1,
        order: float = 5,
        dashes: Sequence[float] = (),
        opacity: float | None = None,
        flat: bool = False,
    ) -> None:
        """Draw a line through places, over lower orders; a flat one ends where its ends are."""
        drawn = path([self.place(a, b) for a, b in zip(x, heights)])
        dashed = ",".join(short(width * dash) for dash in dashes) or None
        cap = None if flat or dashes else "square"
        line = element(
            "path",
            d=drawn,
            stroke=colour,
            stroke_width=width,
            stroke_linecap=cap,
            stroke_dasharray=dashed,
            opacity=opacity,
        )
        self.pen.put(line, order)

    def surface(
        self,
        x: Sequence[float],
        heights: Sequence[float],
        fill: str,
        order: float,
        opacity: float | None = None,
        edge: float | None = None,
    ) -> None:
        """Draw a surface between places, with an edge in its colour."""
        drawn = path([self.place(a, b) for a, b in zip(x, heights)], closed=True)
        stroke = fill if edge else None
        surface = element(
            "path", d=drawn, fill=fill, stroke=stroke, stroke_width=edge, opacity=opacity
        )
        self.pen.put(surface, order)

    def hatch(self, x: Sequence[float], heights: Sequence[float], order: float) -> None:
        """Draw hatching between places."""
        corners = [self.place(a, b) for a, b in zip(x, heights)]
        inside = self.pen.define("clipPath", element("path", d=path(corners, closed=True)))
        across, down = zip(*corners)
        first = math.floor((min(across) + min(down)) / PITCH)
        last = math.ceil((max(across) + max(down)) / PITCH)
        # along each of them the sum of both coordinates is the same
        ends = [(PITCH * k - max(down), PITCH * k - min(down)) for k in range(first, last + 1)]
        lines = "".join(path([(a, max(down)), (b, min(down))]) for a, b in ends)
        hatching = element("path", d=lines, stroke=HATCH, stroke_width=FINE, clip_path=inside)
        self.pen.put(hatching, order)

    def dot(
        self, x: float, height: float, size: float, fill: str, order: float, edge: str | None = None
    ) -> None:
        """Draw a disc of a diameter in points."""
        across, down = self.place(x, height)
        width = 1.6 if edge else None
        disc = element(
            "circle", cx=across, cy=down, r=size / 2, fill=fill, stroke=edge, stroke_width=width
        )
        self.pen.put(disc, order)

    def words(
        self,
        x: float,
        height: float,
        text: str,
        colour: str = INK,
        order: float = 10,
        *,
        align: str = "center",
        baseline: str = "middle",
        size: float = SIZE,
        cover: float = 0.8,
        turn: float = 0.0,
        style: str | None = None,
    ) -> None:
        """Draw words, which cover what is around their letters."""
        if self.silent:
            return
        across, down = self.place(x, height)
        around: dict[str, Any] = {"stroke": "#ffffff", "stroke_width": 2.4, "paint_order": "stroke"}
        around |= {"stroke_linejoin": "round", "stroke_opacity": cover}
        drawn = self.pen.words(
            across,
            down,
            text,
            align=align,
            baseline=baseline,
            size=size,
            turn=turn,
            lead=0.18 * size,
            fill=colour,
            font_style=style,
            **(around if cover else {}),
        )
        self.pen.put(drawn, order)

    def arrows(self, first: float, last: float, height: float, size: float) -> None:
        """Draw a dimension from one place to another, its heads so large, points."""
        self.line([first, last], [height, height], width=0.6)
        long, half = size / POINTS, 0.5 * size / POINTS
        for x, way in ((first, 1), (last, -1)):
            back = x + way * long
            self.surface([x, back, back], [height, height + half, height - half], INK, 5)


PART_NAMES = {"shaft": "shaft", "frustum": "gear head (pitch cone)", "backcone": "backcone"}
SEAT, SPAN = "#1f5f99", "#c4541c"
#: inches on paper: width of a wide and of a narrow one, which on a phone of 390 px has letters of
#: 8.8 px; the largest radius that is drawn, and the least
WIDTH, NARROW = 10.6, 4.55
TALLEST, FLATTEST = 1.75, 0.45
#: in; beside the shaft, on either side, of a wide and of a narrow paper
BESIDE, NARROWLY = 0.9, 0.6
CHAR = 0.075  # of a letter at the size of the labels
LINE = 0.17  # from one line of letters to the next
#: in; of the symbol of a name in the legend, and from the name to the next symbol
SYMBOL, GAP = 0.22, 0.2


def extent(scene: Mapping[str, Any]) -> tuple[float, float]:
    """Return the length and largest radius of the shaft of a scene, m; zero without segments."""
    segments = scene.get("segments") or []
    radii = [max(s["outer0"], s["outer1"]) for s in segments]
    return max((s["y1"] for s in segments), default=0.0), max(radii, default=0.0)


@dataclass(repr=False)
class Sketch(Picture):
    """The section of a scene with segments.

    The upper half is cut (hatched), the lower half shows the surface. Radii are to the same scale
    as lengths, unless the shaft is so slender that they have to be enlarged; then the sketch says
    by how much.

    Parameters
    ----------
    scene : mapping
        As its file tells it, SI.
    width : float
        in.
    room : tuple of float, optional
        Length and largest radius that set the scale, m; those of the scene by default.
    """

    scene: Mapping[str, Any]
    width: float = WIDTH
    room: tuple[float, float] | None = None

    def svg(
        self, kind: str = "sketch", name: str = "part-", margin: float = 0.0, ground: str = ""
    ) -> str:
        """Return the drawing as an SVG; see :meth:`solidgear.show.plot.Picture.svg`."""
        scene, width = self.scene, self.width
        segments = scene["segments"]
        length, height_m = extent(scene)
        longest, radius = self.room or (length, height_m)
        inside = width - 2 * (BESIDE if width == WIDTH else NARROWLY)
        inch = min(inside / longest, TALLEST / radius)  # inches per metre
        enlarged = 1.0 if radius * inch >= FLATTEST else FLATTEST / (radius * inch)
        top = height_m * inch * enlarged
        before = (width - longest * inch) / 2

        stations = [(b, False) for b in scene.get("bearings") or []]
        points = [port for port in (scene.get("port"), *(scene.get("further_ports") or [])) if port]
        stations += [(port, True) for port in points]
        labels = _labels(stations, lambda y: before + y * inch, width)
        marks = [(before + y * inch, f"{1e3 * y:.1f}") for y in _marks(scene, length)]
        ordinates = _staggered(marks)
        above = top + 0.62 + 0.34 * (1 + max((level for *_, level in labels), default=0))
        notes = _notes(scene, enlarged)
        above += LINE * len(notes) + 0.1 * bool(notes)  # room over the names
        legend = _legend(segments, scene, width)
        chain = _chain(segments, lambda y: before + y * inch)
        deep = LINE * max((level for *_, level in chain), default=0)
        below = top + 1.62 + deep + LINE * max((level for *_, level in ordinates), default=0)
        below += LINE * (len(legend) - 1)

        pen = Pen(name, SIZE)
        board = Board(pen, above + margin / POINTS, before, inch, inch * enlarged, top)
        for s in segments:
            draw_segment(board, s)
        beyond = [before - 0.3, before + length * inch + 0.3]
        board.line(beyond, [0, 0], INK, 0.8, 4, CHAINED)
        for blend in scene.get("blends") or []:
            draw_blend(board, blend, segments)
        for cut in scene.get("features") or []:
            draw_feature(board, cut, segments)
        for b in scene.get("bearings") or []:
            _bearing(board, b, segments)
        for mass in scene.get("masses") or []:
            draw_mass(board, mass)
        for port in points:
            _port(board, port, segments)
        for x, text, station, is_port, level in labels:
            colour = SPAN if is_port else SEAT
            foot, height = 0.08 if is_port else top + 0.45, top + 0.62 + 0.34 * level
            board.line([station, station], [foot, height - 0.04], colour, 0.6, 6)
            board.words(x, height, text, colour, 7, baseline="bottom", size=8.5, cover=1.0)
        _lengths(board, segments, chain, -top - 0.72)
        _ruler(board, ordinates, length, -top - 1.04 - deep)
        for k, note in enumerate(notes):
            height = above - 0.1 - LINE * k
            board.words(0.15, height, note, align="left", baseline="top", style="italic", cover=0)
        _draw_legend(board, legend, width / 2, 0.1 - below)
        edges = -margin, POINTS * width + margin
        return pen.svg(kind, *edges, POINTS * (above + below) + 2 * margin, ground)


def draw(
    scene: Mapping[str, Any], width: float = WIDTH, room: tuple[float, float] | None = None
) -> Sketch | None:
    """Return the section of a scene, None without segments; see :class:`Sketch`."""
    return Sketch(scene, width, room) if scene.get("segments") else None


def sketch_svg(
    name: str, scene: Mapping[str, Any], room: tuple[float, float] | None = None
) -> bytes | None:
    """Return the section of a scene for a page, wide and for a phone; None without segments."""
    drawings = []
    for kind, width in (("wide", WIDTH), ("narrow", NARROW)):
        sketch = draw(scene, width, room)
        if sketch is None:
            return None
        drawings.append(sketch.svg(kind, f"{name}-{kind}-"))
    return "".join(drawings).encode()


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


def surface_of(segments, lo: float, hi: float) -> list[tuple[float, float]]:
    """Return (y, outer radius) along the shaft from `lo` to `hi`, steps included."""
    points = []
    for s in segments:
        a, b = max(lo, s["y0"]), min(hi, s["y1"])
        if b - a > 1e-9:
            slope = (s["outer1"] - s["outer0"]) / (s["y1"] - s["y0"])
            points += [(y, s["outer0"] + slope * (y - s["y0"])) for y in (a, b)]
    return points


def draw_segment(board: Board, s: Mapping) -> None:
    """Draw a segment, cut above and from outside below, with its diameters."""
    x0, x1 = board.x(s["y0"]), board.x(s["y1"])
    o0, o1, i0, i1 = (board.radial * s[k] for k in ("outer0", "outer1", "inner0", "inner1"))
    colour, along = FILL.get(s.get("part", "shaft"), FILL["shaft"]), [x0, x1, x1, x0]
    board.surface(along, [i0, i1, o1, o0], colour, 2)
    board.hatch(along, [i0, i1, o1, o0], 2)
    board.surface(along, [0, 0, -o1, -o0], colour, 2, opacity=0.55)
    board.line([x0, x0, x1, x1, x0], [-o0, o0, o1, -o1, -o0], order=3)
    if i0 > 0 or i1 > 0:
        board.line([x0, x1], [i0, i1], INK, 0.9, 3)
        board.line([x0, x1], [-i0, -i1], INK, 0.7, 3, DASHED)
    _diameter(board, s, x0, x1, min(o0, o1))


def _diameter(board: Board, s: Mapping, x0: float, x1: float, room: float) -> None:
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
    turn = -90.0 if upright else 0.0
    board.words((x0 + x1) / 2, -room / 2, text + bore, order=5, cover=0.55, turn=turn)


def _seat(board: Board, s: Mapping, segments, side: int, colour: str, width: float) -> None:
    """Draw the surface that carries a bearing or lumped point, on one side of the axis."""
    points = surface_of(segments, s["lo"], s["hi"])
    x, r = [board.x(y) for y, _ in points], [side * board.radial * r for _, r in points]
    board.line(x, r, colour, width, flat=True)


#: of a spring, from the seat to the ground: inches aside, and share of the way
SPRING = [
    *((0, 0), (0, 0.2)),
    *((0.07 * (-1) ** k, 0.2 + 0.6 * (k + 0.5) / 6) for k in range(6)),
    *((0, 0.8), (0, 1)),
]


def _bearing(board: Board, b: Mapping, segments) -> None:
    """Draw the seat of a bearing, and springs from it to the ground."""
    middle = surface_of(segments, b["y"] - 1e-6, b["y"] + 1e-6)
    radius = board.radial * (middle[0][1] if middle else 0.0)
    x, ground = board.x(b["y"]), board.top + 0.38
    rise = ground - radius
    for side in (1, -1):
        _seat(board, b, segments, side, SEAT, 4.5)
        zigzag = [x + aside for aside, _ in SPRING], [side * (radius + t * rise) for _, t in SPRING]
        board.line(*zigzag, SEAT)
        board.line([x - 0.17, x + 0.17], [side * ground] * 2, SEAT, 1.4)
        for k in range(6):
            foot = x - 0.17 + 0.068 * k
            board.line([foot, foot - 0.05], [side * ground, side * (ground + 0.06)], SEAT, 0.7)


def _port(board: Board, port: Mapping, segments) -> None:
    """Draw a lumped point, and its spokes to the surface that carries it."""
    x = board.x(port["y"])
    for side in (1, -1):
        _seat(board, port, segments, side, SPAN, 4)
        for k in range(5):
            y = port["lo"] + (port["hi"] - port["lo"]) * (0.04 + 0.92 * k / 4)
            spot = surface_of(segments, y - 1e-6, y + 1e-6)
            if spot:
                end = side * board.radial * spot[0][1]
                board.line([x, board.x(y)], [0, end], SPAN, 0.5, 4, DOTTED)
    board.dot(x, 0, 8, "#ffffff", 8, edge=SPAN)
    reach = 4 / POINTS
    board.line([x - reach, x + reach], [0, 0], SPAN, 1.0, 9)
    board.line([x, x], [-reach, reach], SPAN, 1.0, 9)


def _lengths(board: Board, segments, chain: list[tuple], level: float) -> None:
    """Draw the chain of segment lengths; a text without room stands below it."""
    for s in segments:
        for x, y in ((board.x(s["y0"]), s["outer0"]), (board.x(s["y1"]), s["outer1"])):
            board.line([x, x], [-board.radial * y - 0.04, level - 0.06], "#777777", 0.4, 1)
    for middle, text, (a, b), step in chain:
        wide = b - a > CHAR * len(text) + 0.2
        board.arrows(a, b, level, 2.4 if wide else 1.6)
        place = level - 0.07 - LINE * (step - 1) if step else level + (0.02 if wide else 0.07)
        baseline = "top" if step else "bottom"
        board.words(middle, place, text, "#000000", 6, baseline=baseline, cover=1.0)


def _ruler(board: Board, ordinates, length: float, level: float) -> None:
    """Draw positions from y = 0 of the ends, the bearings and the lumped point."""
    board.line([board.x(0), board.x(length)], [level, level], INK, 0.6, 2)
    for x, text, step in ordinates:
        board.line([x, x], [level + 0.05, level - 0.05 - 0.17 * step], INK, 0.6, 2)
        board.words(x, level - 0.07 - 0.17 * step, text, baseline="top", cover=0)
    end = board.x(length) + 0.22
    board.words(end, level, "y, mm", align="left", style="italic", cover=0)


class Entry(NamedTuple):
    """An entry of the legend: a patch, a line or a dot in a colour, and its meaning."""

    kind: str
    colour: str
    words: str

    @property
    def width(self) -> float:
        """in; of the entry with the gap to the next."""
        return SYMBOL + 0.08 + GAP + width_of(self.words, SIZE) / POINTS


def _legend(segments, scene, width: float) -> list[list[Entry]]:
    """Return rows of the legend: one, or two entries a row."""
    parts = [p for p in FILL if any(s.get("part", "shaft") == p for s in segments)]
    entries = [Entry("patch", FILL[p], PART_NAMES[p]) for p in parts]
    if scene.get("bearings"):
        entries.append(Entry("line", SEAT, "bearing seat"))
    if scene.get("masses"):
        entries.append(Entry("dot", MASS, "rigid mass, at its centre"))
    if scene.get("port"):
        entries.append(Entry("line", SPAN, "surface that carries the lumped point"))
    columns = len(entries) if sum(entry.width for entry in entries) <= width else 2
    rows = -(-len(entries) // max(columns, 1))
    return [entries[k::rows] for k in range(rows)]


def _draw_legend(board: Board, rows: Sequence[Sequence[Entry]], middle: float, low: float) -> None:
    """Draw the legend in columns about the middle of the paper, over a height."""
    columns = range(max(map(len, rows), default=0))
    widths = [max(row[k].width for row in rows if k < len(row)) for k in columns]
    for i, row in enumerate(reversed(rows)):
        x, height = middle - sum(widths) / 2 + GAP / 2, low + LINE * (i + 0.5)
        for entry, width in zip(row, widths):
            _draw_entry(board, entry, x, height)
            x += width


def _draw_entry(board: Board, entry: Entry, x: float, height: float) -> None:
    end, half = x + SYMBOL, 0.04
    if entry.kind == "dot":
        board.dot((x + end) / 2, height, 7, entry.colour, 5)
    elif entry.kind == "line":
        board.line([x, end], [height, height], entry.colour, 4, flat=True)
    else:
        around, edges = [x, end, end, x, x], [height - half] * 2 + [height + half] * 2
        board.surface(around[:4], edges, entry.colour, 5)
        board.line(around, [*edges, height - half], INK, 0.6)
    board.words(end + 0.08, height, entry.words, align="left", cover=0)


CUT, MASS = "#8a1f1f", "#6b2e8a"
#: kinds of features around a cylinder, which are drawn as marks
DETAILS = ("ring_groove", "round_groove", "v_groove", "relief", "thread", "press_fit")


def draw_feature(board: Board, feature: Mapping[str, Any], segments: Sequence[Mapping]) -> None:
    """Draw a feature of a scene, seen along x at any angle."""
    segment = next(s for s in segments if s["name"] == feature["segment"])
    if "addendum" in feature:
        _teeth(board, feature, segment)
    elif "circle" in feature:
        _holes(board, feature, segment)
    elif feature["kind"] in DETAILS:
        _detail(board, feature, segment)
    else:
        _cut(board, feature, segment)


def _name(feature: Mapping) -> str:
    turn = f", at {math.degrees(feature['angle']):.3g} deg" if feature["angle"] else ""
    kind = feature["kind"].replace("_", " ")
    if feature.get("inclination"):
        turn += f", {math.degrees(feature['inclination']):.3g} deg oblique"
    if feature.get("offset"):
        turn += f", {1e3 * feature['offset']:.3g} beside the axis"
    return f"{kind}{turn}" if feature["name"] == kind else f"{kind} {feature['name']}{turn}"


def _cut(board: Board, cut: Mapping, segment: Mapping) -> None:
    """Draw a cut into a segment."""
    lo, hi, lean = cut["y"], cut["y"] + cut.get("length", 0.0), 0.0
    radius = segment["outer0"]
    if "diameter" in cut:
        half = cut["diameter"] / 2 / math.cos(cut["inclination"])
        lo, hi, lean = lo - half, lo + half, radius * math.tan(cut["inclination"])
    floor = radius - cut["depth"] if "depth" in cut else -radius
    x = [board.x(y) for y in (lo - lean, hi - lean, hi + lean, lo + lean, lo - lean)]
    r = [board.radial * v for v in (floor, floor, radius, radius, floor)]
    board.surface(x, r, "#ffffff", 4)
    board.line(x, r, CUT, dashes=() if "depth" in cut else DASHED)
    place = board.x((lo + hi) / 2), board.radial * max(floor, 0) - 0.05
    board.words(*place, _name(cut), CUT, baseline="top")


def _detail(board: Board, detail: Mapping, segment: Mapping) -> None:
    """Mark a groove, undercut, thread or hub on both sides of a cylinder."""
    side = segment["y0"] if detail.get("side") == "start" else segment["y1"]
    lo = detail.get("y", side)
    hi = lo + (detail.get("length") or 0.0)
    if "length" in detail and detail["length"] is None:
        hi = segment["y1"]
    radius = board.radial * segment["outer0"]
    for half in (1, -1):
        board.line([board.x(lo), board.x(hi)], [half * radius] * 2, CUT, 2.4)
        board.dot(board.x(lo), half * radius, 4, CUT, 4)
    board.words(board.x((lo + hi) / 2), radius + 0.05, _name(detail), CUT, baseline="bottom")


def _teeth(board: Board, teeth: Mapping, segment: Mapping) -> None:
    """Draw tips and roots above, and the run of the teeth below."""
    x = [board.x(segment["y0"]), board.x(segment["y1"])]
    ends = [board.radial * segment[k] for k in ("outer0", "outer1")]
    tip = 1 + 2 * teeth["addendum"] / teeth["count"]
    root = 1 - 2 * teeth["dedendum"] / teeth["count"]
    for side in (1, -1):
        for share, dashes in ((tip, ()), (root, DASHED)):
            board.line(x, [side * share * r for r in ends], CUT, 1.0, dashes=dashes)
        for k in (0, 1):
            band = [side * share * ends[k] for share in (root, tip)]
            board.line([x[k]] * 2, band, CUT, 1.0)
    lean = math.tan(teeth["spiral_angle"]) * (1 if teeth["hand"] == "right" else -1)
    steps = 20
    for j in range(teeth["count"]):
        # seen from +x, with +z upwards: what turns about +y comes from +z towards the viewer
        angle, line = teeth["angle"] + 2 * math.pi * j / teeth["count"], []
        for i in range(steps + 1):
            t = i / steps
            r = segment["outer0"] + (segment["outer1"] - segment["outer0"]) * t
            if math.sin(angle) > 0 and math.cos(angle) < 0:
                line.append((x[0] + (x[1] - x[0]) * t, board.radial * tip * r * math.cos(angle)))
            slope = (segment["outer1"] - segment["outer0"]) / (segment["y1"] - segment["y0"])
            step = (segment["y1"] - segment["y0"]) / steps * math.hypot(1.0, slope)
            angle += lean * step / r
        if line:
            places, heights = zip(*line)
            board.line(places, heights, CUT, 0.7, opacity=0.8)
    text = f"{teeth['count']} {_name(teeth)}"
    if teeth["spiral_angle"]:
        text += f", {math.degrees(teeth['spiral_angle']):.3g} deg {teeth['hand']}"
    if teeth["model"] == "pitch_cone":
        text += " (smeared)"
    board.words(sum(x) / 2, 0.6 * sum(ends) / 2, text, CUT, baseline="top")


def _holes(board: Board, bolts: Mapping, segment: Mapping) -> None:
    """Draw the outlines of a hole above and below, hidden."""
    lo, hi = segment["y0"], segment["y1"]
    if bolts.get("depth") is not None:
        lo, hi = (
            (lo, lo + bolts["depth"]) if bolts["side"] == "start" else (hi - bolts["depth"], hi)
        )
    x = [board.x(y) for y in (lo, hi, hi, lo, lo)]
    middle, half = bolts["circle"] / 2, bolts["diameter"] / 2
    for side in (1, -1):
        r = [side * board.radial * v for v in (middle - half,) * 2 + (middle + half,) * 2]
        board.line(x, [*r, r[0]], CUT, dashes=DASHED)
    size = f"{2e3 * half:.4g}"
    text = f"{bolts['count']} x ⌀{size} {_name(bolts)}"
    board.words((x[0] + x[1]) / 2, board.radial * (middle - half) - 0.05, text, CUT, baseline="top")


def draw_blend(board: Board, blend: Mapping, segments) -> None:
    """Draw a fillet or chamfer in both halves."""
    r, y = blend["corner"]
    owner = next(s for s in segments if s["name"] == blend["owner"])
    added, outline = blend["edge"] == "root", blend["outline"]
    colour = FILL.get(owner.get("part", "shaft"), FILL["shaft"]) if added else "white"
    for half in (1, -1):
        x = [board.x(b) for _, b in outline]
        height = [half * board.radial * a for a, _ in outline]
        # its own edge covers the sharp lines below it
        around = [*x, board.x(y)], [*height, half * board.radial * r]
        board.surface(*around, colour, 3.4, edge=1.6)
        board.line(x, height, order=3.6)
    size = f"R{1e3 * blend['radius']:.3g}" if "radius" in blend else f"{1e3 * blend['length']:.3g}"
    if "angle" in blend:
        size += f" x {math.degrees(blend['angle']):.3g} deg"
    (r0, y0), (r1, y1) = outline[0], outline[-1]
    # beyond the outline, where there is no material
    away = 0.1 * (1 if y1 + y0 > 2 * y else -1) * (1 if added else -1)
    offset = 0.1 if blend["surface"] == "outer" else -0.1
    place = board.x((y0 + y1) / 2) + away, board.radial * (r0 + r1) / 2 + offset
    board.words(*place, size, align="left" if away > 0 else "right", size=7)


def draw_mass(board: Board, mass: Mapping) -> None:
    """Draw a rigid mass: its centre, joined to its station, with name and size above."""
    x, centre = board.x(mass["y"]), board.x(mass["y"] + mass["offset"][1])
    # seen along x: what lies towards +z is drawn upwards
    height = board.radial * mass["offset"][2]
    board.line([x, centre], [0, height], MASS, 1.6, 8)
    board.dot(centre, height, 10, MASS, 10)
    text = f"{mass['name']}\n{mass['mass']:.4g} kg"
    board.words(centre, height + 0.12, text, MASS, baseline="bottom")
