"""Faces of seats in meshes of tetrahedra, and in given meshes.

A face lies on a surface of revolution if its corners do and its middle nodes lie between the chords of
its edges and the surface: meshers straighten edges where elements would fold, and such faces are as much
part of a seat as curved ones. The floor of a flat one element wide has its corners on the surface and
straight edges too, but it is plane: no plane has more than a line or an ellipse in common with a
cylinder, so that of faces joined by straight edges those of a floor lie in one plane with all their
nodes, and those of a cylinder do not.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from solidgear.core.errors import SolidgearError
from solidgear.core.models.solid.block import BEYOND, chords, edges_of
from solidgear.core.models.solid.mesh import SolidMesh
from solidgear.core.scene.shaft import on_face

if TYPE_CHECKING:
    from solidgear.core.scene.parts import Segment

#: distance of a node from a surface of revolution, over its radius, at which it is on it
ON_SURFACE = 2e-5
#: share of curved edges around a surface from which plane faces do not belong to it
CURVED = 0.3
#: distance from a surface, over its radius, within which a face is meant to be on it
MEANT = 2e-4
#: of radii, how far those of one cylinder may differ
SAME = 1e-9
#: share of a seat that faces close to it, but off it, may have
LOST = 0.01


class Seats:
    """Faces of seats on the rest of a surface of revolution, and of sections; ``clipped`` takes facets
    that reach beyond the ends of a seat.
    """

    def __init__(self, mesh: SolidMesh, segments: Sequence[Segment], clipped: bool) -> None:
        self.mesh, self.segments, self.clipped = mesh, _surfaces(segments), clipped
        # teeth may leave no segment of revolution
        self.length = segments[-1].y1 if len(segments) else float(mesh.mesh.p[1].max())
        self.corners = mesh.mesh.facets[:, mesh.boundary]
        self.y = mesh.mesh.p[1, self.corners]
        self.r = np.hypot(*mesh.mesh.p[[0, 2]][:, self.corners])
        self._by_segment: dict[Segment, tuple[np.ndarray, np.ndarray]] = {}

    def __call__(self, station, attachment: str) -> np.ndarray:
        """Return the facets that carry a station; refuse a station without a section, and faces
        that were meant to be on its seat and are not: their corners are, or all but are, and they
        are no plane floor of a feature.
        """
        if attachment == "section" or on_face(station):
            section = self.mesh.section(station.y, 1e-7 * self.length)
            if not len(section):
                raise SolidgearError(
                    f"port {station.name!r}: the mesh has no section at y = {station.y:.6g} m; "
                    "use attachment 'average' or 'rigid'"
                )
            return section
        near = self._near(station)
        on_seat, meant = np.zeros(len(near), bool), np.zeros(len(near), bool)
        hair = 1e-7 * self.length
        for s in self.segments:
            if s.y1 > station.lo + hair and s.y0 < station.hi - hair:
                lateral, floors = self._sorted(s)
                on_seat |= near & lateral
                meant |= near & ~floors & self._along(s, MEANT)
        lost, area = (self.area(part, station) for part in (meant & ~on_seat, on_seat))
        # a seat without any face is refused in another sentence
        if area > 0 and lost > LOST * (lost + area):
            raise SolidgearError(
                f"port {station.name!r}: {100 * lost / (lost + area):.2g} % of the faces of its seat "
                f"are not on it: their nodes lie off the surface by more than {self._reason()}"
            )
        return self.mesh.boundary[on_seat]

    def _reason(self) -> str:
        """Return the reason why nodes lie off a surface, and the remedy, in a given mesh or one of
        a drawn part.
        """
        if self.clipped:
            return (
                f"the digits of a mesh file explain ({ON_SURFACE:g} of the radius); write the mesh "
                "with more digits, or its middle nodes on the surface or on the straight edges"
            )
        return (
            f"{ON_SURFACE:g} of the radius, so this cylinder or cone has another axis than the "
            "part; draw both about one axis"
        )

    def area(self, chosen: np.ndarray, station) -> float:
        """Return the area of some facets of the boundary between the ends of a seat, m^2."""
        facets = self.mesh.boundary[chosen]
        if not len(facets):
            return 0.0
        span = (station.lo, station.hi) if self.clipped else None
        return float(sum(a.sum() for _, _, a, _ in self.mesh.over_facets(facets, span)))

    def _near(self, station) -> np.ndarray:
        """Return the facets within the ends of a seat, or, of those to be clipped, that reach into
        it.
        """
        hair = 1e-7 * self.length
        low, high = self.y.min(axis=0), self.y.max(axis=0)
        if self.clipped:
            return (high > station.lo + hair) & (low < station.hi - hair)
        return (low > station.lo - hair) & (high < station.hi + hair)

    def _along(self, s, near: float) -> np.ndarray:
        """Return the facets with all corners near the surface of a segment, those across the axis
        left out.
        """
        hair, outer = 1e-7 * self.length, _outer(s, self.y)
        inside = (self.y > s.y0 - hair) & (self.y < s.y1 + hair)
        close = inside & (np.abs(self.r - outer) < near * outer)
        return close.all(axis=0) & (np.ptp(self.y, axis=0) > hair)

    def _sorted(self, s) -> tuple[np.ndarray, np.ndarray]:
        """Return the facets on the surface of a segment, and plane floors with their corners on it."""
        if s not in self._by_segment:
            self._by_segment[s] = _lateral(self.mesh, self.corners, self._along(s, ON_SURFACE), s)
        return self._by_segment[s]


def _surfaces(segments: Sequence[Segment]) -> list[Segment]:
    """Return segments joined where the outer surface goes on as a cylinder: a bore or a hole within a part
    from a file begins there, of which its surface has no line.
    """
    surfaces: list[Segment] = []
    for s in segments:
        last = surfaces[-1] if surfaces else s
        radii = [s.outer0, s.outer1, last.outer0, last.outer1]
        if surfaces and np.allclose(radii, s.outer0, rtol=SAME, atol=0.0):
            surfaces[-1] = last.with_changes(y1=s.y1)
        else:
            surfaces.append(s)
    return surfaces


def _outer(s, y):
    """Return the radius of the surface of a segment, m."""
    return s.outer0 + (s.outer1 - s.outer0) * (y - s.y0) / (s.y1 - s.y0)


def _lateral(mesh: SolidMesh, corners, candidates, s) -> tuple[np.ndarray, np.ndarray]:
    """Return, of facets with all corners on the surface of a segment, those that lie on it, and
    plane floors.
    """
    floors = np.zeros(len(candidates), bool)
    if not mesh.element.edge_dofs or not candidates.any():
        return candidates, floors
    chosen = np.flatnonzero(candidates)
    edge, places = edges_of(mesh, corners[:, chosen])
    outer = _outer(s, places[1])
    sagitta = np.abs(outer - chords(mesh, corners[:, chosen]))
    inwards = outer - np.hypot(places[0], places[2])
    hair = ON_SURFACE * outer + BEYOND * sagitta
    bent = (np.abs(inwards) < hair) | (edge < 0)
    # curved edges along the axis may lie off by a little of the sagitta of those around
    near, deep = hair.max(axis=0), sagitta.max(axis=0)
    between = ((inwards > -near) & (inwards < deep + near) | (edge < 0)).all(axis=0)
    around = (sagitta > hair) & (edge >= 0)
    lateral = np.zeros(len(candidates), bool)
    # in a mesh without curved edges every face is plane
    if (bent & around).sum() > CURVED * around.sum():
        floors[chosen] = ~bent.all(axis=0) & _plane(mesh, corners[:, chosen], edge, places, ~bent)
    lateral[chosen] = between
    return lateral & ~floors, floors


def _plane(mesh: SolidMesh, corners, edge, places, straight) -> np.ndarray:
    """Return True where facets that share straight edges lie in one plane with all their nodes."""
    count = corners.shape[1]
    m, f = np.nonzero(straight)
    _, number = np.unique(edge[m, f], return_inverse=True)
    size = count + int(number.max(initial=-1)) + 1
    links = sp.coo_matrix((np.ones(len(f)), (f, count + number)), shape=(size, size))
    _, label = connected_components(links, directed=False)
    nodes = np.concatenate([mesh.mesh.p[:, corners], places], axis=1)  # (3, node, f)
    out = np.zeros(count, bool)
    order = np.argsort(label[:count], kind="stable")
    for members in np.split(order, np.flatnonzero(np.diff(label[:count][order])) + 1):
        points = nodes[:, :, members].reshape(3, -1)
        points = points - points.mean(axis=1, keepdims=True)
        normal = np.linalg.eigh(points @ points.T)[1][:, 0]
        reach = np.abs(points).max()
        out[members] = np.abs(normal @ points).max() < 10 * ON_SURFACE * reach
    return out
