"""Singular places of a 3D solid, read off its mesh: features, concave edges, ends of patches."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.core.body import Body
from solidgear.core.bounds.layers import Layers
from solidgear.core.bounds.seat_facets import rim_of, seat_facets
from solidgear.core.bounds.singular_places import Place, Singular, feature_exponent, singular_places
from solidgear.core.kernel.assembly import reference
from solidgear.core.meshing.grading import corner_length
from solidgear.core.safety import LOAD_EDGE
from solidgear.core.scene.feature import SMALLEST
from solidgear.core.scene.shaft import attached_stations, without_axis

if TYPE_CHECKING:
    from solidgear.core.models.solid.edges import SharpEdges
    from solidgear.core.models.solid.mesh import SolidMesh
    from solidgear.core.scene import Scene
    from solidgear.core.scene.outline import Outline
    from solidgear.core.scene.patches import Patch

#: distance of a node from a surface of revolution that it lies on, in largest radii: a tenth of the
#: least size of a feature, since nodes between corners are moved to keep the volume
NEAR = SMALLEST / 10
#: distance of points that are the same, in lengths of the body
SAME = 1e-6


@dataclass(frozen=True, eq=False)
class Spots:
    """Points of the surface of a 3D solid at which stress is singular."""

    what: str
    points: np.ndarray  #: (3, k) m
    reach: float
    exponent: float

    def distance(self, points: np.ndarray) -> np.ndarray:
        """Return the distance (n,) of points (3, n) from the nearest one, m."""
        from scipy.spatial import cKDTree  # slow to import, and seldom needed

        return cKDTree(self.points.T).query(points.T)[0]

    def nearest(self, point: np.ndarray) -> np.ndarray:
        """Return the place (3,) of the one that is nearest to a point, m."""
        away = np.linalg.norm(self.points - point[:, None], axis=0)
        return self.points[:, away.argmin()] + 0.0  # no zero below zero


def solid_places(
    scene: Scene, body: Body, attachments: tuple[str, ...] | None = None
) -> tuple[Singular, ...]:
    """Return the singular places of the 3D solid of a scene, with all stations tied by `attachments`
    or as the scene says.
    """
    drawing: Any = body.geometry
    # where features are cut out of some of the cells that a bar is shared among
    mesh: SolidMesh = getattr(drawing, "cut", drawing).solved
    if without_axis(scene):
        return (*_on_a_block(scene, body, mesh),)
    around = singular_places(scene, attached_stations(scene.stations, attachments))
    if scene.body is not None:
        sharp = Layers.of(scene, body, mesh).sharp
        return (*around, *_lines(mesh, sharp, around, np.zeros(0, int)))
    return (*around, *_features(scene, mesh))


def _on_a_block(scene: Scene, body: Body, mesh: SolidMesh) -> Iterator[Spots]:
    """Yield the singular places of a body without an axis."""
    sharp = Layers.of(scene, body, mesh).sharp
    taken = [np.zeros(0, int)]
    for patch, tie, edges in _ends_of_patches(scene, body, mesh):
        what, exponent = f"end of patch {patch.name}", LOAD_EDGE
        if tie == "rigid":
            taken.append(edges)
            exponent = float(sharp.exponents_on(edges).min())
        points = mesh.mesh.p[:, np.unique(mesh.mesh.edges[:, edges])]
        yield Spots(what, points, patch.extent, exponent)
    yield from _lines(mesh, sharp, (), np.concatenate(taken))


def _features(scene: Scene, mesh: SolidMesh) -> Iterator[Spots]:
    """Yield the features of a shaft, as what its mesh has of the surface that is none of the
    outline's; of those at the same place along the shaft all as one.
    """
    features = [feature for feature in scene.features if not feature.smeared]
    if not features:
        return
    nodes = _off_outline(scene.outline, mesh)
    spans = [feature.span(scene.segments) for feature in features]
    y = mesh.nodes[1, nodes].mean(axis=0)
    held = np.array([(lo <= y) & (y <= hi) for lo, hi in spans])
    for kind in np.unique(held, axis=1).T:
        members = [f for f, is_there in zip(features, kind) if is_there]
        if not members:
            continue
        points = mesh.nodes[:, np.unique(nodes[:, (held == kind[:, None]).all(axis=0)])]
        segment = next(s for s in scene.segments if s.name == members[0].segment)
        lengths = [hi - lo for (lo, hi), is_there in zip(spans, kind) if is_there]
        yield Spots(
            " or ".join(f"{f.what} {f.name}" for f in members),
            points,
            min(corner_length(segment), *lengths),
            feature_exponent(members, scene),
        )


def _off_outline(outline: Outline, mesh: SolidMesh) -> np.ndarray:
    """Return the nodes (b, k) of the facets of a mesh that lie on no surface of an outline, and in
    no mirror plane through the axis.
    """
    on_surface = np.array([*_on_surfaces(outline, mesh.nodes), *_in_mirrors(outline, mesh.nodes)])
    out = []
    for place, elements in mesh.local_facets(mesh.boundary):
        points, _, _ = mesh.on_facet(place, np.array([[0.2, 0.5, 0.1], [0.3, 0.1, 0.6]]))
        alive = np.abs(reference(mesh.element, points)[0]).max(axis=1) > 1e-9
        nodes = mesh.dofs[alive][:, elements]
        out.append(nodes[:, ~on_surface[:, nodes].all(axis=1).any(axis=0)])
    return np.concatenate(out, axis=1)


def _on_surfaces(outline: Outline, nodes: np.ndarray) -> Iterator[np.ndarray]:
    """Yield for every surface of revolution which nodes lie on it."""
    r, y = np.hypot(nodes[0], nodes[2]), nodes[1]
    near = NEAR * outline.largest_radius
    for piece in outline.pieces:
        inside = (y > piece.y0 - near) & (y < piece.y1 + near)
        if piece.corner is None:
            near_by = np.abs(r - np.interp(y, [piece.y0, piece.y1], [piece.r0, piece.r1])) < near
        else:  # an arc lies between its ends
            low, high = sorted((piece.r0, piece.r1))
            near_by = (r > low - near) & (r < high + near)
        yield inside & near_by
    for place in {y for s in outline.segments for y in (s.y0, s.y1)}:
        yield np.abs(y - place) < near


def _in_mirrors(outline: Outline, nodes: np.ndarray) -> Iterator[np.ndarray]:
    """Yield for both planes of a half model which nodes lie in it."""
    for axis in (0, 2):
        yield np.abs(nodes[axis]) < NEAR * outline.largest_radius


def _lines(
    mesh: SolidMesh, sharp: SharpEdges, known: tuple[Place, ...], taken: np.ndarray
) -> Iterator[Spots]:
    """Yield the sharp edges of a mesh that are none of the places known nor of the edges taken, every
    line of them that hangs together as one.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    points = mesh.mesh.p
    edges = mesh.mesh.edges[:, sharp.numbers]
    size = float(np.ptp(points, axis=1).max())
    free = ~np.isin(sharp.numbers, taken)
    for place in known:
        away = place.distance(points[:, edges.ravel()]).reshape(2, -1)
        free &= (away > SAME * size).any(axis=0)
    for joined, what in ((False, "concave edge"), (True, "change of material")):
        chosen = np.flatnonzero(free & (sharp.joined == joined))
        vertices, numbers = np.unique(edges[:, chosen], return_inverse=True)
        start, end = numbers.reshape(2, -1)
        graph = coo_matrix((np.ones(len(start)), (start, end)), shape=2 * (len(vertices),))
        count, line = connected_components(graph, directed=False)
        for k in range(count):
            on_line = points[:, vertices[line == k]]
            extent = float(np.linalg.norm(np.ptp(on_line, axis=1)))
            exponent = float(sharp.exponents[chosen[line[start] == k]].min())
            yield Spots(what, on_line, extent, exponent)


def _ends_of_patches(
    scene: Scene, body: Body, mesh: SolidMesh
) -> Iterator[tuple[Patch, str, np.ndarray]]:
    """Yield the patches of a body, how each is tied, and the edges around it, where its load ends."""
    stations = {station.name: station for station in scene.stations}
    for port in body.ports:
        station = stations[port.name]
        patch = getattr(station, "patch", None)
        if patch is None:
            continue
        rim = rim_of(mesh, seat_facets(scene, body, mesh, station))
        if len(rim):
            yield patch, port.attachment, rim
