"""The places that the cells of a mesh belong to, and their shares of what the cells have in sum.

A cell that touches singular places belongs to the sharpest of them: where cells are equally small, a
smaller exponent costs more. Any other one belongs to the nearest place to its middle, if the reach
of that place is so large. Several that are equally sharp or near share a cell in equal parts.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.core.body import Body
from solidgear.core.bounds.singular_places import Singular, singular_places
from solidgear.core.judge.solid_places import solid_places
from solidgear.core.scene.shaft import attached_stations, without_axis

if TYPE_CHECKING:
    from solidgear.core.scene import Scene

#: exponents, and distances in lengths of the body, that differ by less are the same
SAME_EXPONENT, SAME_DISTANCE = 1e-3, 1e-9
ELSEWHERE = "elsewhere"


@dataclass(frozen=True)
class Share:
    """A place, None where no place reaches, and its share."""

    place: Singular | None
    share: float
    #: x, y and z (m) of what of it is nearest to its cell with the most, or of the middle of that
    #: cell; of a meridian r, y and zero
    point: tuple[float, float, float]

    @property
    def what(self) -> str:
        """What the place is."""
        return ELSEWHERE if self.place is None else self.place.what


@dataclass(frozen=True, eq=False)
class CellPlaces:
    """Cells of a body and the singular places that they belong to."""

    places: tuple[Singular, ...]
    points: np.ndarray  #: (3, n) vertices, m; of a meridian r, y and zero
    cells: np.ndarray  #: (k, ne) vertices of every cell
    flat: bool  #: whether cells are those of a meridian
    axis: bool  #: whether the body has an axis, so that r and y say where a place is

    @classmethod
    def of_body(
        cls, scene: Scene, body: Body, attachments: tuple[str, ...] | None = None
    ) -> CellPlaces:
        """Return the cells of a solid, with all stations tied by `attachments` or as the scene says."""
        geometry: Any = body.geometry
        if hasattr(geometry, "meridian"):
            meridian = geometry.meridian
            points = np.vstack([meridian.points, 0 * meridian.points[0]])
            around = singular_places(scene, attached_stations(scene.stations, attachments))
            return cls(around, points, meridian.cells, True, True)
        mesh = geometry.solved.mesh
        places = solid_places(scene, body, attachments)
        return cls(places, mesh.p, mesh.t, False, not without_axis(scene))

    @property
    def middles(self) -> np.ndarray:
        """(3, ne) middles of the cells, m."""
        return self.points[:, self.cells].mean(axis=1)

    @property
    def owners(self) -> np.ndarray:
        """(p, ne) part of every cell that belongs to every place."""
        if not self.places:
            return np.zeros((0, self.cells.shape[1]))
        same = SAME_DISTANCE * float(np.ptp(self.points, axis=1).max())
        touching = np.array([place.distance(self.points) < same for place in self.places])
        touched = touching[:, self.cells].any(axis=1)
        exponents = np.array([[place.exponent] for place in self.places])
        sharpness = np.where(touched, exponents, np.inf)
        sharpest = touched & (sharpness <= sharpness.min(axis=0) + SAME_EXPONENT)
        distance = np.array([place.distance(self.middles) for place in self.places])
        reach = np.array([[place.reach] for place in self.places])
        nearest = distance <= np.minimum(distance.min(axis=0) + same, reach)
        members = np.where(touched.any(axis=0), sharpest, nearest)
        return members / np.maximum(members.sum(axis=0), 1)

    def shares(self, by_cells: np.ndarray) -> list[Share]:
        """Return the sums (ne,) by cells has at every place and outside all of them, the largest
        first.
        """
        owners = self.owners
        outside = (owners.sum(axis=0) == 0).astype(float)
        parts = np.vstack([owners, outside]) * by_cells
        middles = self.middles[:, parts.argmax(axis=1)].T
        out = []
        for place, part, middle in zip((*self.places, None), parts, middles):
            x, y, z = middle if place is None else place.nearest(middle)
            out.append(Share(place, float(part.sum()), (float(x), float(y), float(z))))
        return sorted(out, key=lambda share: -share.share)

    def at(self, share: Share, radius: bool = False) -> str:
        """Return where a place is, in words."""
        x, y, z = share.point
        name = "cells" if share.place is None else f"the {share.what}"
        if not self.axis or share.place is None and not self.flat:
            return f"{name} at x = {1e3 * x:.4g}, y = {1e3 * y:.4g}, z = {1e3 * z:.4g} mm"
        beside = f", r = {1e3 * np.hypot(x, z):.4g} mm" if radius or share.place is None else ""
        return f"{name} at y = {1e3 * y:.4g} mm{beside}"


def place_of_most(scene: Scene, body: Body, by_cells: np.ndarray) -> str:
    """Return the place that has the largest part of what the cells of a solid have, in words."""
    cells = CellPlaces.of_body(scene, body)
    return cells.at(cells.shares(by_cells)[0], radius=True)
