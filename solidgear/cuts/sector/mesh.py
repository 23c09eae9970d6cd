"""Isoparametric mesh of a sector, its seats, and drawings of all copies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.core import Surface, rotation
from solidgear.core.models.solid.block import Facets
from solidgear.core.models.solid.drawing import copied
from solidgear.core.models.solid.mesh import SolidMesh, _isoparametric
from solidgear.core.models.solid.seat_faces import Seats
from solidgear.cuts.sector.cyclic import Sector
from solidgear.cuts.sector.meshing import SectorMesh, cut_vertices, matched

if TYPE_CHECKING:
    from solidgear.core import Scene


def seats(mesh: SolidMesh, straight: np.ndarray, scene: Scene, features: Sequence[Any]) -> Facets:
    """Return the function that gives facets of seats, in a sector or the whole: on the rest of
    surfaces of revolution, and on flanks, tips and roots of teeth; of the places (3, nv) of straight
    vertices only y and the radius count.
    """
    toothed = {f.segment: f for f in features if f.toothed}
    tolerance = 1e-7 * scene.length
    plain = [s for s in scene.segments if s.name not in toothed]
    on_cylinder = Seats(mesh, plain, clipped=False)
    corners = mesh.mesh.facets[:, mesh.boundary]
    y, r = straight[1, corners], np.hypot(*straight[[0, 2]][:, corners])

    def facets(station, attachment):
        on_revolution = on_cylinder(station, attachment)
        if attachment == "section":
            return on_revolution
        low, high = y.min(axis=0), y.max(axis=0)
        on_teeth = np.zeros(len(mesh.boundary), bool)
        for s in scene.segments:
            if s.name in toothed:
                teeth = toothed[s.name]
                pitch = s.outer0 + (s.outer1 - s.outer0) * (y - s.y0) / s.length
                # no chord of a root runs deeper; bores and holes do
                least = teeth.land * (1 - 1e-6)
                on_segment = (low > s.y0 - tolerance) & (high < s.y1 + tolerance)
                on_teeth |= on_segment & (r > least * pitch).all(axis=0)
        inside = (low >= station.lo - tolerance) & (high <= station.hi + tolerance)
        steep = high - low > tolerance
        return np.union1d(on_revolution, mesh.boundary[inside & steep & on_teeth])

    return facets


@dataclass(frozen=True, eq=False)
class PieceSolid(SolidMesh):
    """The mesh of a piece of a part, which draws all of it."""

    #: (k,) facets inside the whole part: cut faces, and the middle plane of a half
    inner: np.ndarray
    # its shapes are waves of a given order around, not displacements of the whole part
    motion = None  # type: ignore[assignment]

    @cached_property
    def boundary(self) -> np.ndarray:
        """Indices of the facets on the surface of the whole part."""
        return np.setdiff1d(self.mesh.boundary_facets(), self.inner)

    def volume(self) -> None:  # type: ignore[override]
        """Return None: there is no mesh of the whole part."""


@dataclass(frozen=True, eq=False)
class SectorSolid(PieceSolid):
    """The mesh of a sector, which draws the whole part."""

    sector: Sector

    def surface(self, moved: Mapping[str, np.ndarray]) -> Surface:
        """Return all copies of the sector, each with its phase."""
        parts = {}
        for name, vector in moved.items():
            h = int(name.removeprefix("cyclic_"))
            pieces = (vector,) if h == 0 else (vector[::2], vector[1::2])
            parts[h] = [self.outline.surface(piece).displacement for piece in pieces]
        undeformed = self.outline.surface(None)
        copies = []
        for k in range(self.sector.count):
            angle = k * self.sector.angle
            local = np.zeros(undeformed.points.shape)
            for h, fields in parts.items():
                for factor, field in zip((np.cos(h * angle), -np.sin(h * angle)), fields):
                    local += factor * field
            copies.append((rotation(1, angle)[:3, :3], local))
        return copied(undeformed, copies)


def sector_solid(meshed: SectorMesh) -> SectorSolid:
    """Return the isoparametric mesh of a sector, the cut faces matched; MeshError if they carry
    different meshes.
    """
    plain = _isoparametric(meshed.mesh, "tet10", meshed.segment)
    low, high, axis = cut_vertices(meshed)
    outside = meshed.mesh.boundary_facets()
    inner, sides = [], []
    for vertices in (low, high):
        on_face = np.zeros(plain.nodes.shape[1], bool)
        on_face[vertices] = on_face[axis] = True
        inner.append(outside[on_face[meshed.mesh.facets[:, outside]].all(axis=0)])
        sides.append(plain.facet_unknowns(inner[-1]))
    on_axis = np.intersect1d(sides[0], sides[1])
    master, slave = (np.setdiff1d(side, on_axis) for side in sides)
    master = matched(plain.nodes, meshed.count, master, slave)
    return SectorSolid(
        plain.mesh,
        plain.name,
        plain.element,
        plain.dofs,
        plain.nodes,
        plain.segment,
        np.concatenate(inner),
        Sector(meshed.count, master, slave, on_axis),
    )
