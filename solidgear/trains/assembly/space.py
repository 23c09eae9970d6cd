"""Shafts of a train that take the same space: a gear that runs into a shaft, or a shaft into another.

Every shaft is segments as bodies of revolution, gears up to their tips and bearings of
catalogue data.  Teeth that mesh take each other's space as far as their tips reach.  On parallel
axes both shafts are compared over the stretch that they share, which is exact; on axes at an angle
points of one shaft are looked for in the other, on circles that are close beside the radii.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import combinations
from math import ceil, cos, pi, sin

import numpy as np

from solidgear.bearings.catalogue import catalogue_of
from solidgear.core import Scene
from solidgear.trains.assembly.layout import Place
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.train import Train

#: m; less is how numbers are typed
LEAST = 1e-5
#: axes whose angle has a sine below this are parallel
PARALLEL = 1e-6
#: depth of teeth in modules, and a little more: a blank that reaches into them carries them
DEEP = 2.5
#: places along parallel axes; points around a circle, circles along its radius, and at most along a
#: piece
ALONG, AROUND, FINE, MOST = 9, 72, 6, 500


@dataclass(frozen=True)
class Piece:
    """A length of a shaft with straight meridians; pairs are values at both ends."""

    name: str  #: in words
    #: y, outer, inner: m
    y: tuple[float, float]
    outer: tuple[float, float]
    inner: tuple[float, float] = (0.0, 0.0)
    meshes: frozenset[str] = frozenset()  #: meshes whose teeth it has or carries

    def radii(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the inner and the outer radius at places along the shaft."""
        return np.interp(y, self.y, self.inner), np.interp(y, self.y, self.outer)


@dataclass(frozen=True)
class Overlap:
    """Two shafts that take the same space."""

    shafts: tuple[str, str]
    pieces: tuple[str, str]
    depth: float  #: how far the one reaches into the other where that is most, m
    #: from where to where along each shaft, m
    places: tuple[tuple[float, float], tuple[float, float]]

    def __str__(self) -> str:
        (side_a, side_b), (piece_a, piece_b) = self.shafts, self.pieces
        stretches = [
            f"{1e3 * low:.1f} to {1e3 * high:.1f} mm along the {side}"
            for side, (low, high) in zip(self.shafts, self.places)
        ]
        return (
            f"{piece_a} of the {side_a} and {piece_b} of the {side_b} take the same space, by "
            f"{1e3 * self.depth:.4g} mm: {' and '.join(stretches)}; correct azimuth, places or sizes"
        )


def overlaps(
    train: Train, scenes: Mapping[str, Scene], places: Mapping[str, Place]
) -> tuple[Overlap, ...]:
    """Return the deepest overlap of every two shafts that have any; `places` are those of
    :func:`solidgear.trains.assembly.layout.places`.
    """
    tips: dict[str, float] = {}
    pieces = {side: _pieces(train, side, scene, tips) for side, scene in scenes.items()}
    deepest = []
    nested = [{*stage.shafts} for stage in train.stages]  # a carrier is around its sun
    for side_a, side_b in combinations(scenes, 2):
        if {side_a, side_b} in nested:
            continue
        (axes_a, origin_a), (axes_b, origin_b) = places[side_a], places[side_b]
        turn, offset = axes_a.T @ axes_b, axes_a.T @ (origin_b - origin_a)
        parallel = np.hypot(turn[0, 1], turn[2, 1]) < PARALLEL
        pair_overlaps: list[Overlap] = []
        for a in pieces[side_a]:
            for b in pieces[side_b]:
                shared = a.meshes & b.meshes
                if parallel:
                    free = max(
                        [0.0, *(tips[m] - float(np.hypot(offset[0], offset[2])) for m in shared)]
                    )
                    pair_overlaps += parallel_overlap(
                        (side_a, side_b), a, b, turn[1, 1], offset, free
                    )
                elif not shared:
                    pair_overlaps += angled_overlap((side_a, side_b), a, b, turn, offset)
        deepest += sorted(pair_overlaps, key=lambda o: -o.depth)[:1]
    return tuple(deepest)


def _pieces(train: Train, side: str, scene: Scene, tips: dict[str, float]) -> list[Piece]:
    """Return segments, gears and bearings of a shaft; the tip radii of the meshes are added to
    `tips`.
    """
    blanks = [
        Piece(f'"{s.name}"', (s.y0, s.y1), (s.outer0, s.outer1), (s.inner0, s.inner1))
        for s in scene.segments
    ]
    gears: list[Piece] = []
    for port in train.shafts[side].gears:
        pairs = [p for p in train.pairs if (side, port) in zip(p.shafts, p.ports)]
        gear_pieces = [
            piece for pair in pairs if (piece := _gear(pair, side, port, scene)) is not None
        ]
        seat = next(s for s in scene.stations if s.name == port)
        meshes = frozenset(pair.name for pair in pairs)
        gear, depth = (
            gear_pieces[0] if gear_pieces else (Piece("", (seat.lo, seat.hi), (0.0, 0.0)), np.inf)
        )
        tip = max(gear.outer) if gear_pieces else np.inf
        straight, bore = bool(gear_pieces) and gear.outer[0] == gear.outer[1], gear.outer
        for k, blank in enumerate(blanks):
            along = min(blank.y[1], gear.y[1]) - max(blank.y[0], gear.y[0])
            if along < min(blank.y[1] - blank.y[0], gear.y[1] - gear.y[0]) / 2:
                continue
            bore = min(bore, blank.inner)
            # a blank up to the teeth, whose profile shift may be unknown; for a bevel gear any as large
            size = max(blank.outer)
            fits = size <= max(gear.outer) + depth / DEEP or not straight
            if fits and size >= min(gear.outer) - depth:
                blanks[k], tip = replace(blank, meshes=blank.meshes | meshes), max(tip, size)
        for pair in pairs:
            tips[pair.name] = tips.get(pair.name, 0.0) + tip
        gears += [replace(gear, inner=bore, meshes=meshes)] if gear_pieces else []
    for k, segment in enumerate(scene.segments):
        if segment.part == "backcone":  # of the head before it or behind it
            head = blanks[max(k - 1, 0) : k + 2]
            blanks[k] = replace(blanks[k], meshes=frozenset().union(*(b.meshes for b in head)))
    return [*blanks, *gears, *_bearings(scene)]


def _bearings(scene: Scene) -> Iterator[Piece]:
    """Yield bearings with catalogue data up to their outer diameter."""
    for bearing in scene.bearings:
        if (data := catalogue_of(bearing)) is not None:
            half = data.seat_width / 2
            sizes = data.outer_diameter / 2, data.bore / 2
            outer, inner = ((size, size) for size in sizes)
            name, ends = f'bearing "{bearing.name}"', (bearing.y - half, bearing.y + half)
            yield Piece(name, ends, outer, inner)


def _gear(pair: Pair, side: str, port: str, scene: Scene) -> tuple[Piece, float] | None:
    """Return a gear up to its tips, and the depth of the teeth; None where the file does not give
    its size.
    """
    first = side == pair.shafts[0]
    pair = pair.rolling
    wheel, mate = (pair.pinion, pair.gear)[:: 1 if first else -1]
    ratio, angle = wheel.teeth / mate.teeth, pair.mesh.shaft_angle
    radius = wheel.pitch_radius or (mate.pitch_radius or 0.0) * ratio
    if not radius:
        return None
    lean = wheel.helix_angle or mate.helix_angle or wheel.spiral_angle or mate.spiral_angle or 0.0
    module = wheel.module or mate.module
    if module:
        radius = module * wheel.teeth / (2 * cos(lean))
    module = module or 2 * radius * cos(lean) / wheel.teeth
    seat = next(s for s in scene.stations if s.name == port)
    cone, face = wheel.pitch_angle, wheel.face_width or mate.face_width
    if abs(sin(angle)) < PARALLEL:
        tip = radius + module * (1 + wheel.profile_shift)
        half_face = (wheel.face_width or 0.0) / 2
        y = (seat.y - half_face, seat.y + half_face) if half_face else (seat.lo, seat.hi)
        return Piece(f'the gear at "{port}"', y, (tip, tip)), DEEP * module
    if cone is None and mate.pitch_angle is not None:
        cone = angle - mate.pitch_angle
    if cone is None or face is None:
        return None
    half = face * cos(cone) / 2
    heel, toe = (r + module * cos(cone) * r / radius for r in (radius, radius - face * sin(cone)))
    ends = (toe, heel) if wheel.apex == "start" else (heel, toe)
    return Piece(f'the gear at "{port}"', (seat.y - half, seat.y + half), ends), DEEP * module


def parallel_overlap(
    shafts: tuple[str, str], a: Piece, b: Piece, sense: float, offset: np.ndarray, free: float
) -> Iterator[Overlap]:
    """Yield the overlap of two pieces on parallel axes, where teeth may take the space `free`;
    `sense` is 1 or -1, the second axis along the first, `offset` (3,) the origin of the second
    scene in the axes of the first.
    """
    ends = sorted(offset[1] + sense * np.array(b.y))
    low, high = max(a.y[0], ends[0]), min(a.y[1], ends[1])
    if high - low < LEAST:
        return
    y = np.linspace(low, high, ALONG)
    distance = np.hypot(offset[0], offset[2])
    y_b = sense * (y - offset[1])
    (bore_a, outer_a), (bore_b, outer_b) = a.radii(y), b.radii(y_b)
    depth = outer_a + outer_b - distance
    for hole, inside in ((bore_a, outer_b), (bore_b, outer_a)):
        depth = np.where(hole > 0, np.minimum(depth, distance + inside - hole), depth)
    if depth.max() - free > LEAST:
        overlap_y = y[depth - free > 0]
        span_a = float(overlap_y.min()), float(overlap_y.max())
        span_b = sorted(float(sense * (v - offset[1])) for v in span_a)
        places = span_a, (span_b[0], span_b[1])
        yield Overlap(shafts, (a.name, b.name), float(depth.max() - free), places)


def angled_overlap(
    shafts: tuple[str, str], a: Piece, b: Piece, turn: np.ndarray, offset: np.ndarray
) -> Iterator[Overlap]:
    """Yield overlaps of two pieces on axes at an angle: points of either in the other."""
    middles = [np.array([0.0, sum(piece.y) / 2, 0.0]) for piece in (a, b)]
    reach = sum(np.hypot((p.y[1] - p.y[0]) / 2, max(p.outer)) for p in (a, b))
    if np.linalg.norm(offset + turn @ middles[1] - middles[0]) > reach:
        return
    back = turn.T, -turn.T @ offset
    step = min(max(piece.outer) for piece in (a, b)) / FINE
    directions = ((shafts, a, b, *back), (shafts[::-1], b, a, turn, offset))
    for sides, source, target, into, origin in directions:
        points = _points(source, step)
        points_in_target = points @ into.T + origin
        size = np.hypot(points_in_target[:, 0], points_in_target[:, 2])
        inner, outer = target.radii(points_in_target[:, 1])
        depth = np.minimum(outer - size, np.where(inner > 0, size - inner, np.inf))
        depth = np.minimum(
            depth,
            np.minimum(points_in_target[:, 1] - target.y[0], target.y[1] - points_in_target[:, 1]),
        )
        if len(depth) and depth.max() > LEAST:
            hit = depth > 0
            y_source, y_target = points[hit, 1], points_in_target[hit, 1]
            spans = (
                (float(y_source.min()), float(y_source.max())),
                (float(y_target.min()), float(y_target.max())),
            )
            yield Overlap(sides, (source.name, target.name), float(depth.max()), spans)


def _points(piece: Piece, step: float) -> np.ndarray:
    """Return (n, 3) points of the outer surface and of both ends of a piece, a step apart."""
    length = piece.y[1] - piece.y[0]
    y = np.linspace(*piece.y, min(2 + ceil(length / step), MOST))
    rings = [(v, r) for v, r in zip(y, piece.radii(y)[1])]
    for k in (0, 1):
        count = 1 + ceil((piece.outer[k] - piece.inner[k]) / step)
        rings += [(piece.y[k], r) for r in np.linspace(piece.inner[k], piece.outer[k], count)]
    around = 2 * pi * np.arange(AROUND) / AROUND
    v, r = np.array(rings).T
    return np.column_stack(
        [
            np.outer(r, np.cos(around)).ravel(),
            np.repeat(v, AROUND),
            np.outer(r, np.sin(around)).ravel(),
        ]
    )
