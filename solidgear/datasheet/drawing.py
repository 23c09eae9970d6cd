"""Drawing of a shaft for a data sheet: to scale, with bearings, forces, turning sense and dimensions.

It is seen from +x: y runs to the right, z upwards. Loads stand above the shaft, bearings with their
forces below it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from solidgear.datasheet.facts import DrawnShaft, Force
from solidgear.datasheet.language import Language
from solidgear.show.pen import Pen, width_of
from solidgear.show.sketch import (
    INK,
    POINTS,
    SEAT,
    SIZE,
    SPAN,
    Board,
    draw_blend,
    draw_feature,
    draw_mass,
    draw_segment,
    extent,
    surface_of,
)

#: in; width of a paper for one shaft a row, and for two of them or a phone
WIDE, NARROW = 7.4, 4.55
#: in; beside the shaft
ASIDE = {WIDE: 0.75, NARROW: 0.62}
#: in; largest radius that is drawn, and the least
TALLEST, FLATTEST = {WIDE: 0.85, NARROW: 0.6}, 0.32
#: in; of the longest arrow, its head, and from one line of letters to the next
ARROW, HEAD, LINE = 0.42, 0.08, 0.145
#: of the largest force or moment on a shaft: less is not drawn
NOTHING = 1e-2
#: in; radius of the symbol of a force across the paper
SYMBOL = 0.055
#: in; height of a bearing over its seat, at least and at most
LEAST_RING, MOST_RING = 0.1, 0.3


@dataclass(frozen=True)
class Block:
    """Words on one place of a shaft."""

    x: float  #: in; of the place
    foot: float  #: in; distance from the axis at which its line begins
    lines: tuple[str, ...]
    colour: str

    @property
    def half(self) -> float:
        """Half of its width, in."""
        return max(width_of(line, SIZE) for line in self.lines) / POINTS / 2

    @property
    def height(self) -> float:
        """Height, in."""
        return LINE * len(self.lines)


def enlarged_by(shaft: DrawnShaft, width: float, room: tuple[float, float]) -> float:
    """Return the factor by which radii are drawn larger than lengths."""
    _, inch, radial = _scale(shaft, width, room)
    return radial / inch


def _scale(
    shaft: DrawnShaft, width: float, room: tuple[float, float]
) -> tuple[float, float, float]:
    """Return the place of the start of the shaft, in, and inches per metre along and across it."""
    longest, radius = room
    inch = min((width - 2 * ASIDE[width]) / longest, TALLEST[width] / radius)
    radial = max(inch, FLATTEST / radius)
    length, _ = extent(shaft.scene)
    return (width - length * inch) / 2, inch, radial


def shaft_svg(
    name: str,
    kind: str,
    shaft: DrawnShaft,
    words: Language,
    width: float,
    room: tuple[float, float],
) -> str:
    """Return the drawing of a shaft as an SVG of a class, `room` is the length and the largest radius
    that set the scale, m.
    """
    scene, segments = shaft.scene, shaft.scene["segments"]
    before, inch, radial = _scale(shaft, width, room)
    length, height = extent(scene)
    pen = Pen(name, SIZE)
    top = height * radial
    probe = Board(pen, 0.0, before, inch, radial, top)
    loads, carried = _blocks(probe, shaft, words)
    upper, lower = _levels(loads, width), _levels(carried, width)
    upper_reach = max((block.foot for block in loads), default=top) + ARROW
    reach = max((block.foot for block in carried), default=top) + ARROW
    above = max(upper_reach + sum(upper.heights), top + MOST_RING) + 0.05
    lower_reach = reach + sum(lower.heights)
    chain = _staggered(_lengths(probe, segments, words))
    places = _staggered(_places(probe, scene, length, words))
    deep = LINE * max((level for *_, level in chain), default=0)
    deeper = LINE * max((level for *_, level in places), default=0)
    below = lower_reach + 0.3 + deep + 0.28 + deeper + 0.12
    board = replace(probe, above=above)
    _draw_shaft(board, shaft, words)
    _draw_blocks(board, upper, upper_reach, 1, width)
    _draw_blocks(board, lower, reach, -1, width)
    bearings = {bearing["name"]: bearing for bearing in scene.get("bearings") or []}
    for force in shaft.forces:
        _draw_force(board, shaft, force, bearings.get(force.name))
    _draw_sense(board, shaft, before + length * inch, words, width)
    _draw_axes(board, above)
    level = -lower_reach - 0.22
    _draw_chain(board, segments, chain, level)
    _draw_ruler(board, places, length, level - deep - 0.28, words)
    return pen.svg(kind, 0.0, POINTS * width, POINTS * (above + below))


def _ports(scene: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    return [port for port in (scene.get("port"), *(scene.get("further_ports") or [])) if port]


def _radius(segments: Sequence[Mapping], y: float) -> float:
    """Return the outer radius at a place, the larger one at a step, m."""
    return max((r for _, r in surface_of(segments, y - 1e-6, y + 1e-6)), default=0.0)


def _ring(board: Board, bearing: Mapping, segments: Sequence[Mapping]) -> tuple[float, float]:
    """Return inner and outer radius of a bearing on paper, in."""
    inner = board.radial * _radius(segments, bearing["y"])
    data = bearing.get("catalogue") or {}
    height = board.radial * (data.get("outer_diameter", 0.0) - data.get("bore", 0.0)) / 2
    return inner, inner + min(max(height, LEAST_RING), MOST_RING)


def _draw_shaft(board: Board, shaft: DrawnShaft, words: Language) -> None:
    """Draw the shaft, what is cut out of it and sits on it, and its bearings."""
    scene, segments = shaft.scene, shaft.scene["segments"]
    still = replace(board, silent=True)
    for segment in segments:
        draw_segment(still, segment)
    for blend in scene.get("blends") or []:
        draw_blend(still, blend, segments)
    for cut in scene.get("features") or []:
        draw_feature(still, cut, segments)
    for mass in scene.get("masses") or []:
        draw_mass(still, mass)
    ends = [board.x(0.0) - 0.25, board.x(extent(scene)[0]) + 0.25]
    board.line(ends, [0, 0], INK, 0.7, 4, (12.0, 3.0, 2.0, 3.0))
    for bearing in scene.get("bearings") or []:
        _draw_bearing(board, bearing, segments)
    for port in _ports(scene):
        _draw_port(board, port, segments)
    _draw_diameters(board, segments, words)


def _draw_bearing(board: Board, bearing: Mapping, segments: Sequence[Mapping]) -> None:
    """Draw a bearing as its symbol: two squares with a cross (ISO 8826-1)."""
    inner, outer = _ring(board, bearing, segments)
    half = max(board.inch * (bearing["hi"] - bearing["lo"]) / 2, 0.05)
    x = board.x(bearing["y"])
    start, end = x - half, x + half
    for side in (1, -1):
        a, b = side * inner, side * outer
        board.surface([start, end, end, start], [a, a, b, b], "#ffffff", 5)
        board.line([start, end, end, start, start], [a, a, b, b, a], SEAT, 1.2, 6)
        board.line([start, end], [a, b], SEAT, 0.7, 6)
        board.line([start, end], [b, a], SEAT, 0.7, 6)


def _draw_port(board: Board, port: Mapping, segments: Sequence[Mapping]) -> None:
    """Draw the surface that carries a gear."""
    points = surface_of(segments, port["lo"], port["hi"])
    for side in (1, -1):
        heights = [side * board.radial * r for _, r in points]
        board.line([board.x(y) for y, _ in points], heights, SPAN, 3.0, 6, flat=True)


def _draw_diameters(board: Board, segments: Sequence[Mapping], words: Language) -> None:
    """Write every diameter into its segment, upright or beside it where there is no room."""
    for segment in segments:
        x0, x1 = board.x(segment["y0"]), board.x(segment["y1"])
        room = board.radial * min(segment["outer0"], segment["outer1"])
        text = _diameter(segment, words)
        size = width_of(text, SIZE) / POINTS + 0.06
        lines = text.count("\n") + 1
        upright = size > x1 - x0
        turn = -90.0 if upright else 0.0
        middle = (x0 + x1) / 2
        fits = x1 - x0 > LINE * lines and size < room if upright else LINE * lines < room
        if fits:
            board.words(middle, -room / 2, text, order=7, cover=0.6, turn=turn)
        else:
            edge = -board.radial * max(segment["outer0"], segment["outer1"])
            board.line([middle, middle], [edge + 0.04, edge - 0.1], INK, 0.4, 7)
            board.words(middle, edge - 0.1, text, order=8, baseline="top", size=7)


def _diameter(segment: Mapping, words: Language) -> str:
    ends = [words.length(2 * segment[key]) for key in ("outer0", "outer1")]
    text = f"⌀{ends[0]}" if ends[0] == ends[1] else f"⌀{ends[0]} – {ends[1]}"
    bores = [words.length(2 * segment[key]) for key in ("inner0", "inner1")]
    if segment["inner0"] or segment["inner1"]:
        bore = bores[0] if bores[0] == bores[1] else f"{bores[0]} – {bores[1]}"
        text += f"\n{words.say('bore')} {bore}"
    return text


def _blocks(board: Board, shaft: DrawnShaft, words: Language) -> tuple[list[Block], list[Block]]:
    """Return words on what stands above the shaft, and on its bearings."""
    scene, segments = shaft.scene, shaft.scene["segments"]
    loads = {force.name: force for force in shaft.forces if not force.by_bearing}
    reactions = {force.name: force for force in shaft.forces if force.by_bearing}
    above, below = [], []
    ports = {port["name"]: port["y"] for port in _ports(scene)}
    further = {name: load.y for name, load in loads.items() if name not in ports}
    for name, y in (ports | further).items():
        lines = (name, *_components(shaft, loads.get(name), words))
        foot = board.radial * _radius(segments, y)
        above.append(Block(board.x(y), foot, lines, SPAN))
    for mass in scene.get("masses") or []:
        if mass["name"] not in ports | further:
            heavy = words.text(mass["mass"], "kg", 3)
            foot = board.radial * _radius(segments, mass["y"])
            above.append(Block(board.x(mass["y"]), foot, (mass["name"], heavy), INK))
    for bearing in scene.get("bearings") or []:
        kind = (bearing.get("catalogue") or {}).get("designation", "")
        heading = " ".join(filter(None, (bearing["name"], kind)))
        lines = (heading, *_components(shaft, reactions.get(bearing["name"]), words))
        _, foot = _ring(board, bearing, segments)
        below.append(Block(board.x(bearing["y"]), foot, lines, SEAT))
    return above, below


def _without_trifles(shaft: DrawnShaft, six: Sequence[float]) -> np.ndarray:
    """Return a load without what is next to nothing beside the largest on the shaft."""
    loads = np.abs([force.six for force in shaft.forces])
    most = np.repeat([loads[:, :3].max(), loads[:, 3:].max()], 3)
    return np.where(np.abs(six) > NOTHING * most, six, 0.0)


def _components(shaft: DrawnShaft, force: Force | None, words: Language) -> Iterator[str]:
    """Yield forces, the size of the bending moment, and the torque of a load."""
    if force is None:
        return
    six = _without_trifles(shaft, force.six)
    for k, axis in enumerate("xyz"):
        if six[k]:
            yield f"F{axis} {_minus(words.text(six[k], 'N', 3))}"
    if bending := math.hypot(six[3], six[5]):
        yield f"M {words.text(bending, 'N m', 3)}"
    if six[4]:
        yield f"T {_minus(words.text(six[4], 'N m', 3))}"


def _minus(number: str) -> str:
    return number.replace("-", "\u2212")


@dataclass(frozen=True)
class Levels:
    """Blocks of words at levels, the nearest to the shaft first."""

    placed: tuple[tuple[Block, float, int], ...]  #: block, x of its middle, in, and level
    heights: tuple[float, ...]  #: of the levels, in


def _levels(blocks: Sequence[Block], width: float) -> Levels:
    """Place blocks beside each other where there is room, else over each other."""
    ends: list[float] = []
    heights: list[float] = []
    placed = []
    for block in sorted(blocks, key=lambda block: block.x):
        half = block.half + 0.05
        x = min(max(block.x, half), width - half)
        level = next((k for k, end in enumerate(ends) if x - half >= end), len(ends))
        ends[level : level + 1] = [x + half]
        heights[level : level + 1] = [max(block.height + 0.06, *heights[level : level + 1], 0.0)]
        placed.append((block, x, level))
    return Levels(tuple(placed), tuple(heights))


def _draw_blocks(board: Board, levels: Levels, reach: float, side: int, width: float) -> None:
    """Draw words above or below the shaft, each with a line to its place."""
    for block, x, level in levels.placed:
        near = reach + sum(levels.heights[:level])
        board.line([block.x, block.x], [side * block.foot, side * near], block.colour, 0.4, 3)
        lines = block.lines
        for k, line in enumerate(lines):
            step = k if side < 0 else len(lines) - 1 - k
            height = side * (near + LINE * (step + 0.5))
            board.words(x, height, line, block.colour, 9, size=SIZE, cover=1.0)


def _draw_force(board: Board, shaft: DrawnShaft, force: Force, bearing: Mapping | None) -> None:
    """Draw a load from above, or the force of a bearing from below, in its three directions."""
    six = _without_trifles(shaft, force.six)
    segments = shaft.scene["segments"]
    side = -1 if force.by_bearing else 1
    foot = board.radial * _radius(segments, force.y)
    if bearing is not None:
        _, foot = _ring(board, bearing, segments)
    colour, x = SEAT if force.by_bearing else SPAN, board.x(force.y)
    most = max(np.abs(f.six[:3]).max() for f in shaft.forces)
    if six[2]:
        long = ARROW * (0.45 + 0.55 * abs(six[2]) / most)
        ends = [side * foot, side * (foot + long)]
        if six[2] * side < 0:
            ends.reverse()
        _arrow(board, (x, ends[0]), (x, ends[1]), colour)
    height = side * (foot + 0.1)
    if six[1]:
        way = math.copysign(1.0, six[1])
        long = 0.15 + 0.2 * abs(six[1]) / most
        _arrow(board, (x + 0.05 * way, height), (x + (0.05 + long) * way, height), colour)
    if six[0]:
        aside = -0.12 if six[1] > 0 else 0.12
        _across(board, x + (aside if six[1] or six[2] else 0.0), height, six[0] > 0, colour)


def _arrow(board: Board, tail: tuple[float, float], tip: tuple[float, float], colour: str) -> None:
    """Draw an arrow between two places."""
    (x0, z0), (x1, z1) = tail, tip
    size = math.hypot(x1 - x0, z1 - z0)
    along, rise = (x1 - x0) / size, (z1 - z0) / size
    back = x1 - HEAD * along, z1 - HEAD * rise
    board.line([x0, back[0]], [z0, back[1]], colour, 1.6, 8, flat=True)
    across = -0.4 * HEAD * rise, 0.4 * HEAD * along
    corners = [
        (back[0] + across[0], back[1] + across[1]),
        (back[0] - across[0], back[1] - across[1]),
    ]
    board.surface([x1, *(x for x, _ in corners)], [z1, *(z for _, z in corners)], colour, 8)


def _across(board: Board, x: float, height: float, to_reader: bool, colour: str) -> None:
    """Draw the symbol of a force across the paper."""
    board.dot(x, height, 2 * SYMBOL * POINTS, "#ffffff", 8, edge=colour)
    if to_reader:
        board.dot(x, height, 0.6 * SYMBOL * POINTS, colour, 9)
        return
    half = SYMBOL * math.sqrt(0.5)
    board.line([x - half, x + half], [height - half, height + half], colour, 1.0, 9)
    board.line([x - half, x + half], [height + half, height - half], colour, 1.0, 9)


def _draw_sense(board: Board, shaft: DrawnShaft, end: float, words: Language, width: float) -> None:
    """Draw the sense in which the shaft turns at its far end, and write its speed."""
    x, tall = end + 0.2, 0.2
    if shaft.sense:
        # seen from +x the near side of a shaft that turns about +y moves down
        angles = np.radians(np.linspace(75, -75, 15))
        if shaft.sense == "-y":
            angles = angles[::-1]
        places = [(x + 0.08 * math.cos(a), tall * math.sin(a)) for a in angles]
        board.line([p for p, _ in places[:-2]], [z for _, z in places[:-2]], INK, 1.3, 8)
        _arrow(board, places[-4], places[-1], INK)
    if shaft.speed:
        text = words.speed(shaft.speed, 4)
        place = min(end + 0.08, width - width_of(text, SIZE) / POINTS)
        board.words(place, -tall - 0.14, text, align="left", cover=1.0)


def _draw_axes(board: Board, above: float) -> None:
    """Draw the directions of y and z."""
    x, z = 0.12, above - 0.42
    _arrow(board, (x, z), (x + 0.26, z), "#777777")
    _arrow(board, (x, z), (x, z + 0.26), "#777777")
    board.words(x + 0.32, z, "y", "#777777", cover=0)
    board.words(x, z + 0.33, "z", "#777777", cover=0)


def _lengths(board: Board, segments: Sequence[Mapping], words: Language) -> list[tuple]:
    """Return middle and text of the length of every segment, with its ends on paper."""
    ends = [(board.x(s["y0"]), board.x(s["y1"])) for s in segments]
    texts = [words.length(s["y1"] - s["y0"]) for s in segments]
    return [((a + b) / 2, text, (a, b)) for (a, b), text in zip(ends, texts)]


def _places(board: Board, scene: Mapping[str, Any], length: float, words: Language) -> list[tuple]:
    """Return place and text of both ends, ports and bearings."""
    stations = [*_ports(scene), *(scene.get("bearings") or []), *(scene.get("masses") or [])]
    places = sorted({0.0, length, *(round(station["y"], 6) for station in stations)})
    return [(board.x(y), words.length(round(y, 5))) for y in places]


def _staggered(items: Sequence[tuple]) -> list[tuple]:
    """Return items with the lowest level at which their texts do not overlap."""
    ends: list[float] = []
    placed = []
    for item in sorted(items, key=lambda item: item[:2]):
        x, half = item[0], width_of(item[1], SIZE) / POINTS / 2 + 0.04
        level = next((k for k, end in enumerate(ends) if x - half >= end), len(ends))
        ends[level : level + 1] = [x + half]
        placed.append((*item, level))
    return placed


def _draw_chain(
    board: Board, segments: Sequence[Mapping], chain: Sequence[tuple], level: float
) -> None:
    """Draw the lengths of segments; a text without room stands below the chain."""
    for segment in segments:
        for y, r in ((segment["y0"], segment["outer0"]), (segment["y1"], segment["outer1"])):
            x = board.x(y)
            board.line([x, x], [-board.radial * r - 0.03, level - 0.05], "#999999", 0.3, 1)
    for middle, text, (a, b), step in chain:
        wide = b - a > width_of(text, SIZE) / POINTS + 0.1
        board.arrows(a, b, level, 2.4 if wide else 1.6)
        height = level - 0.05 - LINE * (step - 1) if step else level + 0.02
        board.words(middle, height, text, order=6, baseline="top" if step else "bottom", cover=1.0)


def _draw_ruler(
    board: Board, places: Sequence[tuple], length: float, level: float, words: Language
) -> None:
    """Draw places from y = 0."""
    board.line([board.x(0), board.x(length)], [level, level], INK, 0.6, 2)
    for x, text, step in places:
        board.line([x, x], [level + 0.05, level - 0.04 - LINE * step], INK, 0.5, 2)
        board.words(x, level - 0.06 - LINE * step, text, baseline="top", cover=0)
    end = board.x(length) + 0.1
    board.words(end, level, f"y, {words.units.unit('m')}", align="left", style="italic", cover=0)
