"""Quadrilaterals of the meridian, cut geometrically into the corners where the stress is singular.

The mesh of the product is taken at its coarsest; all refinement is made here. Two operations keep
it conforming:

- a *chord* is a strip of cells that share opposite edges, from boundary to boundary; splitting it
  splits all its cells;
- a *corner cut* parts every cell around a vertex into a small copy at the vertex and two cells
  around that copy.
  The edges away from the vertex stay whole, so that layers cost a few cells each and no lines
  through the shaft.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from solidgear.core.ladder import build
from solidgear.core.scene import Scene

#: edges at a singular vertex are no longer than this many times the shortest one there
STRETCH = 4.0
#: local edges of a cell: along r (0-1, 3-2), along y (0-3, 1-2)
ALONG = (((0, 1), (3, 2)), ((0, 3), (1, 2)))


@dataclass
class CornerMesh:
    """``points`` (n, 2) with r and y in m, ``cells`` (m, 4) counterclockwise in the (r, y) plane,
    ``segment`` (m,).
    """

    points: np.ndarray
    cells: np.ndarray
    segment: np.ndarray


class TooFine(ValueError):
    """A mesh of more cells than were allowed."""


def corner_mesh(
    scene: Scene, layers: int, size: float, ratio: float, most: int = 10_000
) -> CornerMesh:
    """Mesh of a scene with `layers` corner cuts at every singular vertex.

    Cells are no longer than `size` outer radii of the shaft where they lie; a copy is `ratio` times
    the cell that it is cut from. TooFine is raised above `most` cells before corners are cut.
    """
    least = min(min(s.outer0, s.outer1) for s in scene.segments)
    # one cell where one will do: all that is asked of this mesh is that it knows the outline
    options = {"order": 1, "layers": 0, "edge_layers": 0, "ratio": 0.5, "refinement": 1.0}
    coarse = build(scene, "harmonic", size=scene.length, ovalising=(), **options)
    flat = coarse.geometry.meridian
    mesh = CornerMesh(flat.points.T.copy(), flat.cells.T.copy(), flat.segment.copy())
    corners = _vertices(mesh.points, singular_points(scene), 1e-7 * least)

    def longest(y: float) -> float:
        return size * max(_radii(scene, y, below)[1] for below in (True, False))

    mesh = _spread(mesh, corners, longest, most)
    for _ in range(layers):
        mesh = _cut(mesh, corners, ratio)
    return mesh


def singular_points(scene: Scene) -> np.ndarray:
    """(k, 2) r and y of re-entrant corners, ends of seats, planes of section ties and places
    where the material changes.
    """
    out = []
    for a, b in zip(scene.segments, scene.segments[1:]):
        tiny = 1e-9 * scene.length
        kink = any(abs(_slope(a, w) - _slope(b, w)) > 1e-6 for w in ("outer", "inner"))
        if kink or a.material != b.material or abs(a.outer1 - b.outer0) > tiny:
            out.append((min(a.outer1, b.outer0), b.y0))
        if kink or a.material != b.material or abs(a.inner1 - b.inner0) > tiny:
            out.append((max(a.inner1, b.inner0), b.y0))
    for station in scene.stations:
        if station.attachment == "section":
            inner, outer = _radii(scene, station.y, below=True)
            out += [(inner, station.y), (outer, station.y)]
        else:
            out.append((_radii(scene, station.lo, below=False)[1], station.lo))
            out.append((_radii(scene, station.hi, below=True)[1], station.hi))
    return np.array([p for p in out if p[0] > 0])


def _slope(segment, surface: str) -> float:
    rise = getattr(segment, surface + "1") - getattr(segment, surface + "0")
    return rise / segment.length


def _radii(scene: Scene, y: float, below: bool) -> tuple[float, float]:
    """Of the segment that ends (or begins) at y, where two meet there."""
    tiny = 1e-9
    here = [s for s in scene.segments if s.y0 - tiny <= y <= s.y1 + tiny]
    return (here[0] if below else here[-1]).radius_at(y)


def _vertices(points, wanted, tol) -> np.ndarray:
    """Mesh points at the places wanted."""
    distance = np.linalg.norm(points[None] - wanted[:, None], axis=2)
    at = distance.argmin(axis=1)
    missed = distance[np.arange(len(wanted)), at] > tol
    if missed.any():
        raise ValueError(f"no mesh point at r, y = {wanted[missed].tolist()} m")
    return np.unique(at)


# ------------------------------------------------------------------------------------------------
# - chords
def _spread(
    mesh: CornerMesh, corners: np.ndarray, longest: Callable[[float], float], most: int
) -> CornerMesh:
    """Split chords until cells are small enough, have one singular vertex at most, and are not
    too slender there.
    """
    special = set(corners.tolist())
    for _ in range(10_000):
        found = _worst_edge(mesh, special, longest)
        if found is None:
            return mesh
        if len(mesh.cells) > most:
            raise TooFine(f"the mesh of the meridian takes more than {most} cells")
        mesh = _split_chord(mesh, *found)
    raise ValueError("the mesh of the meridian does not settle")


def _worst_edge(
    mesh: CornerMesh, special: set[int], longest: Callable[[float], float]
) -> tuple[int, int, float] | None:
    """(start, end, fraction) of an edge whose chord is to be split, or None."""
    points, cells = mesh.points, mesh.cells
    shortest: dict[int, float] = {}
    edges: dict[tuple[int, int], float] = {}
    for i, j in (pair for pairs in ALONG for pair in pairs):
        lengths = np.linalg.norm(points[cells[:, i]] - points[cells[:, j]], axis=1)
        edges |= zip(zip(cells[:, i].tolist(), cells[:, j].tolist()), lengths.tolist())
    for edge, d in edges.items():
        for v in special.intersection(edge):
            shortest[v] = min(shortest.get(v, np.inf), d)
    for (a, b), d in sorted(edges.items(), key=lambda e: -e[1]):
        if a in special and b in special:
            return a, b, 0.5
        if d > 1.0001 * longest((points[a, 1] + points[b, 1]) / 2):
            return a, b, 0.5
        if a in special and d > 1.5 * STRETCH * shortest[a]:
            return a, b, max(STRETCH * shortest[a] / d, 0.15)
        if b in special and d > 1.5 * STRETCH * shortest[b]:
            return a, b, 1 - max(STRETCH * shortest[b] / d, 0.15)
    for cell in cells:
        for i, j in ((0, 2), (1, 3)):
            if cell[i] in special and cell[j] in special:
                return int(cell[0]), int(cell[1]), 0.5
    return None


def _split_chord(mesh: CornerMesh, start: int, end: int, fraction: float) -> CornerMesh:
    """All cells across the chord of an edge parted at one fraction of their edges; start before
    end as cells number them.
    """
    points, cells = mesh.points, mesh.cells
    beside: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for k, cell in enumerate(cells):
        for direction, pairs in enumerate(ALONG):
            for i, j in pairs:
                beside.setdefault((int(cell[i]), int(cell[j])), []).append((k, direction))
    waiting, seen, parted = [(start, end)], {(start, end)}, {}
    while waiting:
        edge = waiting.pop()
        for k, direction in beside[edge]:
            parted[k] = direction
            for i, j in ALONG[direction]:
                other = int(cells[k, i]), int(cells[k, j])
                if other not in seen:
                    seen.add(other)
                    waiting.append(other)
    middle = {edge: len(points) + n for n, edge in enumerate(seen)}
    fresh = np.array([(1 - fraction) * points[a] + fraction * points[b] for a, b in seen])
    new_cells, owner = [], []
    for k, cell in enumerate(cells):
        if k not in parted:
            new_cells.append(cell)
            owner.append(mesh.segment[k])
            continue
        (a, b), (d, c) = ALONG[parted[k]]
        low, high = middle[int(cell[a]), int(cell[b])], middle[int(cell[d]), int(cell[c])]
        if parted[k] == 0:
            new_cells += [[cell[0], low, high, cell[3]], [low, cell[1], cell[2], high]]
        else:
            # along y: low lies between 0 and 3, high between 1 and 2
            new_cells += [[cell[0], cell[1], high, low], [low, high, cell[2], cell[3]]]
        owner += [mesh.segment[k]] * 2
    return CornerMesh(np.vstack([points, fresh]), np.array(new_cells), np.array(owner))


# ------------------------------------------------------------------------------------------------
# - corners
def _cut(mesh: CornerMesh, corners: np.ndarray, ratio: float) -> CornerMesh:
    """One layer at every corner: the cells around it parted in three."""
    points = [*mesh.points]
    known: dict[tuple[int, int], int] = {}

    def towards(corner: int, other: int) -> int:
        if (corner, other) not in known:
            known[corner, other] = len(points)
            points.append((1 - ratio) * mesh.points[corner] + ratio * mesh.points[other])
        return known[corner, other]

    special = set(corners.tolist())
    cells, owner = [], []
    for k, cell in enumerate(mesh.cells):
        at = [i for i in range(4) if int(cell[i]) in special]
        if not at:
            cells.append(cell)
            owner.append(mesh.segment[k])
            continue
        a, b, c, d = (int(cell[(at[0] + i) % 4]) for i in range(4))
        q, r = towards(a, b), towards(a, d)
        x = len(points)
        points.append((1 - ratio) * mesh.points[a] + ratio * mesh.points[c])
        cells += [[a, q, x, r], [q, b, c, x], [r, x, c, d]]
        owner += [mesh.segment[k]] * 3
    return CornerMesh(np.array(points), np.array(cells), np.array(owner))
