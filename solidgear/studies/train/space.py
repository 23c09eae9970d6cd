"""Shafts of a train that take the same space: a gear that runs into a shaft, or a shaft into another.

Every shaft is its segments as bodies of revolution, its gears up to their tips and its bearings of
catalogue data.  Teeth that mesh
take each other's space as far as their tips reach.  On parallel axes what lies over the same stretch
of both is compared, which is exact; of axes at an angle points of the one are looked for in the
other, on circles that are close beside the radii.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import combinations
from math import ceil, cos, pi, sin

import numpy as np

from solidgear.scene import Scene
from solidgear.scene.gears import Pair
from solidgear.scene.train import Train
from solidgear.studies.guards.bearings import width_of
from solidgear.studies.train.layout import Place

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
    """A length of a shaft with straight meridians; pairs are its values at both ends."""

    name: str  #: in words
    #: y, outer, inner: m
    y: tuple[float, float]
    outer: tuple[float, float]
    inner: tuple[float, float] = (0.0, 0.0)
    meshes: frozenset[str] = frozenset()  #: meshes whose teeth it has or carries

    def radii(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Inner and outer radius at places."""
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
        (one, two), (first, second) = self.shafts, self.pieces
        at = [
            f"{1e3 * low:.1f} to {1e3 * high:.1f} mm along the {side}"
            for side, (low, high) in zip(self.shafts, self.places)
        ]
        return (
            f"{first} of the {one} and {second} of the {two} take the same space, by "
            f"{1e3 * self.depth:.4g} mm: {' and '.join(at)}; correct azimuth, places or sizes"
        )


def overlaps(
    train: Train, scenes: Mapping[str, Scene], places: Mapping[str, Place]
) -> tuple[Overlap, ...]:
    """The deepest overlap of every two shafts that have any.

    Parameters
    ----------
    places : mapping of str to (turn, origin)
        Of every shaft, as :func:`solidgear.studies.train.layout.places`.
    """
    tips: dict[str, float] = {}
    pieces = {side: _pieces(train, side, scene, tips) for side, scene in scenes.items()}
    out = []
    around = [{*stage.shafts} for stage in train.stages]  # a carrier is around its sun
    for one, two in combinations(scenes, 2):
        if {one, two} in around:
            continue
        (turned, origin), (other, end) = places[one], places[two]
        turn, at = turned.T @ other, turned.T @ (end - origin)
        parallel = np.hypot(turn[0, 1], turn[2, 1]) < PARALLEL
        found: list[Overlap] = []
        for a in pieces[one]:
            for b in pieces[two]:
                shared = a.meshes & b.meshes
                if parallel:
                    free = max([0.0, *(tips[m] - float(np.hypot(at[0], at[2])) for m in shared)])
                    found += beside((one, two), a, b, turn[1, 1], at, free)
                elif not shared:
                    found += across((one, two), a, b, turn, at)
        out += sorted(found, key=lambda o: -o.depth)[:1]
    return tuple(out)


def _pieces(train: Train, side: str, scene: Scene, tips: dict[str, float]) -> list[Piece]:
    """Segments and gears of a shaft; the tip radii of its meshes are added to `tips`."""
    blanks = [
        Piece(f'"{s.name}"', (s.y0, s.y1), (s.outer0, s.outer1), (s.inner0, s.inner1))
        for s in scene.segments
    ]
    gears: list[Piece] = []
    for port in train.shafts[side].gears:
        pairs = [p for p in train.pairs if (side, port) in zip(p.shafts, p.ports)]
        known = [made for pair in pairs if (made := _gear(pair, side, port, scene)) is not None]
        seat = next(s for s in scene.stations if s.name == port)
        meshes = frozenset(pair.name for pair in pairs)
        gear, depth = known[0] if known else (Piece("", (seat.lo, seat.hi), (0.0, 0.0)), np.inf)
        tip = max(gear.outer) if known else np.inf
        straight, bore = bool(known) and gear.outer[0] == gear.outer[1], gear.outer
        for k, one in enumerate(blanks):
            along = min(one.y[1], gear.y[1]) - max(one.y[0], gear.y[0])
            if along < min(one.y[1] - one.y[0], gear.y[1] - gear.y[0]) / 2:
                continue
            bore = min(bore, one.inner)
            # a blank up to the teeth, whose profile shift may not be told; of a bevel gear any as large
            size = max(one.outer)
            fits = size <= max(gear.outer) + depth / DEEP or not straight
            if fits and size >= min(gear.outer) - depth:
                blanks[k], tip = replace(one, meshes=one.meshes | meshes), max(tip, size)
        for pair in pairs:
            tips[pair.name] = tips.get(pair.name, 0.0) + tip
        gears += [replace(gear, inner=bore, meshes=meshes)] if known else []
    for k, segment in enumerate(scene.segments):
        if segment.part == "backcone":  # of the head before it or behind it
            head = blanks[max(k - 1, 0) : k + 2]
            blanks[k] = replace(blanks[k], meshes=frozenset().union(*(b.meshes for b in head)))
    return [*blanks, *gears, *_bearings(scene)]


def _bearings(scene: Scene) -> Iterator[Piece]:
    """Bearings of catalogue data up to their outer diameter."""
    for bearing in scene.bearings:
        if (data := bearing.catalogue) is not None:
            half = width_of(data) / 2
            sizes = data.outer_diameter / 2, data.bore / 2
            outer, inner = ((size, size) for size in sizes)
            name, ends = f'bearing "{bearing.name}"', (bearing.y - half, bearing.y + half)
            yield Piece(name, ends, outer, inner)


def _gear(pair: Pair, side: str, port: str, scene: Scene) -> tuple[Piece, float] | None:
    """A gear up to its tips, and the depth of its teeth; None where the file does not tell its size."""
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
        own = (wheel.face_width or 0.0) / 2
        y = (seat.y - own, seat.y + own) if own else (seat.lo, seat.hi)
        return Piece(f'the gear at "{port}"', y, (tip, tip)), DEEP * module
    if cone is None and mate.pitch_angle is not None:
        cone = angle - mate.pitch_angle
    if cone is None or face is None:
        return None
    half = face * cos(cone) / 2
    heel, toe = (r + module * cos(cone) * r / radius for r in (radius, radius - face * sin(cone)))
    ends = (toe, heel) if wheel.apex == "start" else (heel, toe)
    return Piece(f'the gear at "{port}"', (seat.y - half, seat.y + half), ends), DEEP * module


def beside(
    shafts: tuple[str, str], one: Piece, two: Piece, way: float, at: np.ndarray, free: float
) -> Iterator[Overlap]:
    """Overlap of two pieces on parallel axes, where teeth may take some space.

    Parameters
    ----------
    way : float
        1 or -1, of the second axis along the first.
    at : (3,) ndarray
        Where the second scene begins, in the axes of the first.
    """
    ends = sorted(at[1] + way * np.array(two.y))
    low, high = max(one.y[0], ends[0]), min(one.y[1], ends[1])
    if high - low < LEAST:
        return
    y = np.linspace(low, high, ALONG)
    apart = np.hypot(at[0], at[2])
    there = way * (y - at[1])
    (bore, outer), (other_bore, other) = one.radii(y), two.radii(there)
    deep = outer + other - apart
    for hole, inside in ((bore, other), (other_bore, outer)):
        deep = np.where(hole > 0, np.minimum(deep, apart + inside - hole), deep)
    if deep.max() - free > LEAST:
        within = y[deep - free > 0]
        own = float(within.min()), float(within.max())
        far = sorted(float(way * (v - at[1])) for v in own)
        places = own, (far[0], far[1])
        yield Overlap(shafts, (one.name, two.name), float(deep.max() - free), places)


def across(
    shafts: tuple[str, str], one: Piece, two: Piece, turn: np.ndarray, at: np.ndarray
) -> Iterator[Overlap]:
    """Overlap of two pieces on axes at an angle: points of either in the other."""
    middles = [np.array([0.0, sum(piece.y) / 2, 0.0]) for piece in (one, two)]
    reach = sum(np.hypot((p.y[1] - p.y[0]) / 2, max(p.outer)) for p in (one, two))
    if np.linalg.norm(at + turn @ middles[1] - middles[0]) > reach:
        return
    back = turn.T, -turn.T @ at
    ways = ((shafts, one, two, *back), (shafts[::-1], two, one, turn, at))
    for (a, b), own, other, into, origin in ways:
        points = _points(own, _step(one, two))
        there = points @ into.T + origin
        size = np.hypot(there[:, 0], there[:, 2])
        inner, outer = other.radii(there[:, 1])
        deep = np.minimum(outer - size, np.where(inner > 0, size - inner, np.inf))
        deep = np.minimum(deep, np.minimum(there[:, 1] - other.y[0], other.y[1] - there[:, 1]))
        if len(deep) and deep.max() > LEAST:
            within = deep > 0
            here, far = points[within, 1], there[within, 1]
            spans = (float(here.min()), float(here.max())), (float(far.min()), float(far.max()))
            yield Overlap((a, b), (own.name, other.name), float(deep.max()), spans)


def _step(*pieces: Piece) -> float:
    """Distance of circles beside the smaller of two pieces."""
    return min(max(piece.outer) for piece in pieces) / FINE


def _points(piece: Piece, step: float) -> np.ndarray:
    """(n, 3) points of the outer surface and of both ends of a piece."""
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
