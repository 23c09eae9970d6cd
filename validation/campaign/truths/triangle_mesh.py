"""Triangles of the meridian of a shaft, graded towards the points where its stress is singular.

The meridian (r, y) is cut into slabs at the ends of segments and at sections that carry a station;
gmsh fills them with triangles. Around a singular point the size of a triangle is proportional to
its distance. Below a millionth of the radius, where gmsh begins to leave slivers, the triangles
that meet at the point are parted again and again halfway to it. Either way every ten times smaller
size costs about a hundred triangles. Stress is singular

- strongly at re-entrant corners, at the ends of rigid seats and where two materials meet at the
  surface: what energy lies within reach h of the point goes with h, a little more, or less;
- weakly where a pressure ends, at the ends of averaged seats and of sections that carry a station:
  what goes with h^2 and a logarithm is missed there.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from solidgear.core.errors import SolidgearError
from solidgear.core.meshing.gmsh_session import Session, import_gmsh
from solidgear.core.scene import Scene

#: of the largest radius: places that are one
SAME = 1e-9
#: least size over the largest radius, of what gmsh makes and for coordinates of sixteen digits
LEAST_OF_GMSH, LEAST = 1e-6, 1e-12
#: rad: kinks of less are none
STRAIGHT = 1e-6
#: size at weak points as a power of that at strong ones
WEAK = 1 / 2
#: size at corners that stick out, over the largest radius: the stress is bounded there, its
#: higher derivatives are not
BLUNT = 0.05


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """Triangles of a meridian; lengths in units of the largest radius of the shaft.

    Attributes
    ----------
    points : (2, n) ndarray
        r and y.
    triangles : (3, m) ndarray of int
    segment : (m,) ndarray of int
        Of the scene, in which a triangle lies.
    surfaces : dict of str to list of ndarray of int
        By station: points on each straight piece of its seat, or of its section.
    """

    points: np.ndarray
    triangles: np.ndarray
    segment: np.ndarray
    surfaces: dict[str, list[np.ndarray]]


def triangle_mesh(
    scene: Scene, *, finest: float = 1e-10, growth: float = 0.4, bulk: float = 0.6
) -> TriangleMesh:
    """Graded triangles of the meridian of a scene without features and blends.

    Sizes are at most: `finest` over the largest radius at strongly singular points, `growth` over
    the distance to the nearest singular point, and `bulk` over the local radius or wall. Refused
    are sizes of slivers, and a station that holds its section and lies at a step, where sections
    are two.
    """
    if finest < LEAST:
        raise SolidgearError(f"finest = {finest:g} is below {LEAST:g}: triangles would be slivers")
    unit = max(max(s.outer0, s.outer1) for s in scene.segments)
    slabs = _slabs(scene, unit)
    gmsh = import_gmsh()
    with _Plane(gmsh):
        drawing = _Drawing(gmsh, slabs, [y / unit for s in scene.stations for y in (s.lo, s.hi)])
        pieces = {s.name: drawing.surface(s, unit) for s in scene.stations}
        strong = drawing.reentrant() | drawing.joints(scene)
        weak = set()
        for station in scene.stations:
            ends = drawing.ends(pieces[station.name])
            (strong if station.attachment == "rigid" else weak).update(ends)
        blunt = drawing.blunt() - strong - weak
        drawn = max(finest, LEAST_OF_GMSH)
        graded = [(drawn, strong), (finest**WEAK, weak - strong), (max(drawn, BLUNT), blunt)]
        drawing.mesh(graded, growth, bulk)
        mesh, corners = drawing.collected(pieces, strong)
    for _ in range(math.ceil(math.log2(drawn / finest))):
        mesh = sharpened(mesh, corners)
    return mesh


def sharpened(mesh: TriangleMesh, corners: np.ndarray) -> TriangleMesh:
    """A mesh whose triangles at some points, of which no triangle has two, are parted halfway to
    them: of each a copy of half the size is left, and two are added beside it.
    """
    at = np.isin(mesh.triangles, corners)
    there = np.flatnonzero(at.any(axis=0))
    turn = (np.argmax(at[:, there], axis=0) + np.arange(3)[:, None]) % 3
    tip, a, b = np.take_along_axis(mesh.triangles[:, there], turn, axis=0)
    edges, number = np.unique(np.hstack([[tip, a], [tip, b]]), axis=1, return_inverse=True)
    half = mesh.points.shape[1] + number.ravel()
    half_a, half_b = half[: len(there)], half[len(there) :]
    triangles = mesh.triangles.copy()
    triangles[:, there] = tip, half_a, half_b
    beside = np.hstack([[half_a, a, b], [half_a, b, half_b]])
    on = {
        name: [_joined(piece, edges, mesh.points.shape[1]) for piece in pieces]
        for name, pieces in mesh.surfaces.items()
    }
    return TriangleMesh(
        np.hstack([mesh.points, mesh.points[:, edges].mean(axis=1)]),
        np.hstack([triangles, beside]),
        np.concatenate([mesh.segment, mesh.segment[there], mesh.segment[there]]),
        on,
    )


def _joined(piece: np.ndarray, edges: np.ndarray, first: int) -> np.ndarray:
    """Points of a straight piece with the middles, numbered from `first`, of edges along it."""
    return np.concatenate([piece, first + np.flatnonzero(np.isin(edges, piece).all(axis=0))])


class _Plane(Session):
    """A gmsh model of straight triangles that may be far smaller than what they fill."""

    options = Session.options | {
        "Mesh.ElementOrder": 1,
        "Mesh.Algorithm": 5,  # Delaunay: the frontal one leaves slivers where sizes grow fast
        "Geometry.Tolerance": 1e-13,
    }


@dataclass(frozen=True)
class _Slab:
    """A quadrilateral of the meridian between two cuts, in units of the largest radius."""

    segment: int
    y: tuple[float, float]
    inner: tuple[float, float]
    outer: tuple[float, float]


def _slabs(scene: Scene, unit: float) -> list[_Slab]:
    """Segments, parted at the sections that carry a station."""
    sections = [s.y / unit for s in scene.stations if s.attachment == "section"]
    out = []
    for k, segment in enumerate(scene.segments):
        ends = [segment.y0 / unit, segment.y1 / unit]
        inside = {y for y in sections if ends[0] + SAME < y < ends[1] - SAME}
        for y in pairwise(sorted([*ends, *inside])):
            radii = [segment.radius_at(one * unit) for one in y]
            inner, outer = ((a / unit, b / unit) for a, b in zip(*radii))
            out.append(_Slab(k, y, inner, outer))
    return out


def _walls(slabs: Sequence[_Slab]) -> list[float]:
    """Length that the triangles of each slab are measured by: its radius or wall at the thinner end, or
    the thickness of the plate that it is part of.
    """
    out = [min(b - a for a, b in zip(slab.inner, slab.outer)) for slab in slabs]
    for i, first in enumerate(slabs):
        for j, last in enumerate(slabs[i:], start=i + 1):
            thick = last.y[1] - first.y[0]
            inner = max(r for slab in slabs[i:j] for r in slab.inner)
            outer = min(r for slab in slabs[i:j] for r in slab.outer)
            beside = [(slab.inner[1], slab.outer[1]) for slab in slabs[:i][-1:]]
            beside += [(slab.inner[0], slab.outer[0]) for slab in slabs[j : j + 1]]
            # how far it reaches outwards and inwards beyond what is on both sides of it
            outwards = outer - max([inner, *(b for _, b in beside)])
            inwards = min([outer, *(a for a, _ in beside)]) - inner
            if max(outwards, inwards) > thick:
                out[i:j] = [min(wall, thick) for wall in out[i:j]]
    return out


class _Drawing:
    """Slabs as gmsh knows them: points by their tags, lines by those of their two points; `ends` are
    places where seats begin and end.
    """

    def __init__(self, gmsh, slabs: Sequence[_Slab], ends: Sequence[float]):
        self.gmsh, self.slabs = gmsh, slabs
        self.points: dict[tuple[float, float], int] = {}
        self.place: dict[int, tuple[float, float]] = {}
        self.lines: dict[tuple[int, int], int] = {}
        self.angle: dict[int, float] = {}
        # lines of the outer surface, and those at every cut
        self.along: list[tuple[int, int]] = []
        self.across: list[list[tuple[int, int]]] = []
        self.faces = [self._face(k, ends) for k in range(len(slabs))]
        gmsh.model.geo.synchronize()

    def _point(self, r: float, y: float) -> int:
        key = (round(r, 11), round(y, 11))
        if key not in self.points:
            self.points[key] = self.gmsh.model.geo.addPoint(r, y, 0.0)
            self.place[self.points[key]] = (r, y)
        return self.points[key]

    def _line(self, one: int, other: int) -> int:
        """Tag of the line from one point to another; negative where it was drawn backwards."""
        if (other, one) in self.lines:
            return -self.lines[other, one]
        if (one, other) not in self.lines:
            self.lines[one, other] = self.gmsh.model.geo.addLine(one, other)
        return self.lines[one, other]

    def _face(self, k: int, ends: Sequence[float]) -> int:
        """Draw a slab: its first cut outwards, its outer side, its last cut inwards, its bore."""
        slab = self.slabs[k]
        first, last = self._cut(k, 0), self._cut(k, 1)
        inside = sorted({y for y in ends if slab.y[0] + SAME < y < slab.y[1] - SAME})
        outer = [
            first[-1],
            *(self._point(float(np.interp(y, slab.y, slab.outer)), y) for y in inside),
            last[-1],
        ]
        self.along += pairwise(outer)
        self.across += [list(pairwise(first))] * (k == 0) + [list(pairwise(last))]
        path = list(dict.fromkeys([*first, *outer, *reversed(last)]))
        around = [*path, *path[:2]]
        for a, b, c in zip(around, around[1:], around[2:]):
            self.angle[b] = self.angle.get(b, 0.0) + self._corner(a, b, c)
        loop = [self._line(a, b) for a, b in pairwise(around[:-1])]
        geo = self.gmsh.model.geo
        return geo.addPlaneSurface([geo.addCurveLoop(loop)])

    def _cut(self, k: int, end: int) -> list[int]:
        """Points on an end of a slab, outwards: its own, and those of the slab beyond."""
        slab, beyond = self.slabs[k], k + (1 if end else -1)
        radii = [slab.inner[end], slab.outer[end]]
        if 0 <= beyond < len(self.slabs):
            other = self.slabs[beyond]
            marks = (other.inner[1 - end], other.outer[1 - end])
            radii += [r for r in marks if radii[0] + SAME < r < radii[1] - SAME]
        return [self._point(r, slab.y[end]) for r in sorted(radii)]

    def _corner(self, a: int, b: int, c: int) -> float:
        """Angle at b between the ways to a and to c; the slabs are convex."""
        (ar, ay), (br, by), (cr, cy) = (self.place[tag] for tag in (a, b, c))
        one, two = (ar - br, ay - by), (cr - br, cy - by)
        return math.atan2(abs(one[0] * two[1] - one[1] * two[0]), one[0] * two[0] + one[1] * two[1])

    def surface(self, station, unit: float) -> list[tuple[int, int]]:
        """Lines of the seat of a station, or of its section."""
        if station.attachment != "section":
            middle = {line: sum(self.place[p][1] for p in line) / 2 for line in self.along}
            return [line for line, y in middle.items() if station.lo < unit * y < station.hi]
        cuts = [self.slabs[0].y[0], *(slab.y[1] for slab in self.slabs)]
        k = int(np.argmin(np.abs(np.array(cuts) - station.y / unit)))
        if 0 < k < len(self.slabs) and not np.allclose(
            (self.slabs[k - 1].inner[1], self.slabs[k - 1].outer[1]),
            (self.slabs[k].inner[0], self.slabs[k].outer[0]),
        ):
            raise SolidgearError(
                f'the section of "{station.name}" lies at a step, where it has two sizes'
            )
        return self.across[k]

    def ends(self, lines: Sequence[tuple[int, int]]) -> set[int]:
        """Points off the axis that belong to one of some lines alone."""
        tags = [tag for line in lines for tag in line]
        return {tag for tag in tags if tags.count(tag) == 1 and self.place[tag][0] > SAME}

    def reentrant(self) -> set[int]:
        """Corners with more than half a turn of material; on the axis, tips of conical bores."""
        off = {tag for tag, angle in self.angle.items() if angle > math.pi + STRAIGHT}
        right = (math.pi / 2, math.pi)
        return off | {
            tag
            for tag, angle in self.angle.items()
            if self.place[tag][0] <= SAME and min(abs(angle - a) for a in right) > STRAIGHT
        }

    def blunt(self) -> set[int]:
        """Corners with less than half a turn of material."""
        return {
            tag
            for tag, angle in self.angle.items()
            if angle < math.pi - STRAIGHT and self.place[tag][0] > SAME
        }

    def joints(self, scene: Scene) -> set[int]:
        """Points where two materials meet at the surface."""
        out: set[int] = set()
        for a, b in pairwise(self.slabs):
            if scene.segments[a.segment].material != scene.segments[b.segment].material:
                radii = (max(a.inner[1], b.inner[0]), min(a.outer[1], b.outer[0]))
                out |= {self._point(r, a.y[1]) for r in radii if r > SAME}
        return out

    def mesh(self, graded: Iterable[tuple[float, set[int]]], growth: float, bulk: float) -> None:
        """Triangles no larger than a share of the wall, and than sizes that grow from points."""
        field = self.gmsh.model.mesh.field
        walls = _walls(self.slabs)
        most = bulk * max(walls)
        sizes = []
        for face, wall in zip(self.faces, walls):
            sizes.append(self._field("Constant", VIn=bulk * wall, VOut=1e22))
            field.setNumbers(sizes[-1], "SurfacesList", [face])
        for size, tags in graded:
            if tags and size < most:
                away = self._field("Distance")
                field.setNumbers(away, "PointsList", sorted(tags))
                far = (most - size) / growth
                sizes.append(
                    self._field(
                        "Threshold",
                        InField=away,
                        SizeMin=size,
                        SizeMax=most,
                        DistMin=0,
                        DistMax=far,
                    )
                )
        least = self._field("Min")
        field.setNumbers(least, "FieldsList", sizes)
        field.setAsBackgroundMesh(least)
        self.gmsh.model.mesh.generate(2)

    def _field(self, kind: str, **numbers: float) -> int:
        field = self.gmsh.model.mesh.field
        tag = field.add(kind)
        for name, number in numbers.items():
            field.setNumber(tag, name, number)
        return tag

    def collected(
        self, pieces: Mapping[str, Sequence[tuple[int, int]]], strong: Iterable[int]
    ) -> tuple[TriangleMesh, np.ndarray]:
        """The mesh that gmsh has made, and which of its points some points drawn are."""
        mesh = self.gmsh.model.mesh
        tags, places, _ = mesh.getNodes()
        number = np.zeros(int(tags.max()) + 1, int)
        number[tags] = np.arange(len(tags))
        faces = [mesh.getElementsByType(2, face)[1].reshape(-1, 3) for face in self.faces]
        surfaces = {
            name: [
                number[mesh.getNodes(1, abs(self._line(*line)), includeBoundary=True)[0]]
                for line in lines
            ]
            for name, lines in pieces.items()
        }
        corners = [number[mesh.getNodes(0, tag)[0]] for tag in strong]
        found = TriangleMesh(
            places.reshape(-1, 3)[:, :2].T.copy(),
            number[np.vstack(faces)].T.copy(),
            np.repeat([slab.segment for slab in self.slabs], [len(face) for face in faces]),
            surfaces,
        )
        return found, np.concatenate([*corners, np.zeros(0, int)])
