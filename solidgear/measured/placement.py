"""Places of measuring points in a scene, by the unit, axis and origin of the file that gives them.

They are stated by a table ``points``, with the keys of ``[body]``; entries that are not stated are
those of the scene's frame where the points then lie on the surface, and else are searched for: the
unit, the axis, and for a body of revolution the place along it. Points that fit in more than one
way are refused.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Literal

import numpy as np
from scipy.spatial import cKDTree

from solidgear.core import Model, SolidgearError, Surface
from solidgear.core.meshing.placing import TURNS, Placing
from solidgear.parts.body_file import UNITS, Origin, Unit

#: largest distance of a point from the surface, as a share of the largest radius
OFF = 0.05
#: nearest points of the surface whose triangles are tried
NEAR = 4
#: points that lie within this share of the largest radius are one, of a unit that is not theirs
SPREAD = 0.1
#: and in a frame that is looked for they reach over this share of the body's longest side
REACH = 0.25
#: points whose place is known may slide along the axis by so many largest distances
SLIDE = 4.0
#: steps of a search along the axis in a largest distance, and those about the best, twice
STEPS, FINER = 2, 41
#: of the pieces that lines of a surface are cut into, a largest distance has so many
PIECES = 20
#: units that are looked for, each under one name
KNOWN = {name: UNITS[name] for name in ("m", "mm", "inch", "cm")}


class PointsTable(Model):
    """The table ``points`` of a file of measured resonances."""

    #: unit of the places
    unit: Unit | None = None
    #: axis of the file that is y of the scene
    axis: Literal["x", "-x", "y", "-y", "z", "-z"] | None = None
    #: where y = 0 of the scene lies in the file, m: along that axis, or a point on it
    origin: Origin = None

    def states(self, frame: Frame, length: float | None) -> bool:
        """Return whether a frame is the stated one, in a file whose unit is `length` m by itself."""
        length_unit = length if self.unit is None else UNITS[self.unit]
        return frame == Frame(length_unit or math.nan, self.axis or "y", self.origin or 0.0)


@dataclass(frozen=True)
class Frame:
    """Unit, axis and origin of a file, the origin in m along the axis or as a point."""

    unit: float
    axis: str = "y"
    origin: float | tuple[float, float, float] = 0.0

    @property
    def placing(self) -> Placing:
        """From places in the file to those in the scene."""
        turn = TURNS[self.axis]
        foot = self.origin
        if not isinstance(foot, tuple):
            x, y, z = (foot * np.array(turn)[1]).tolist()
            foot = x, y, z
        return Placing(self.unit, turn, foot)

    @property
    def table(self) -> str:
        """The frame as a file states it."""
        unit = next((name for name, size in KNOWN.items() if size == self.unit), "m")
        words = [f'unit = "{unit}"', f'axis = "{self.axis}"']
        if isinstance(self.origin, tuple):
            words.append(f"origin = [{', '.join(map(_millimetres, self.origin))}]")
        elif self.origin:
            words.append(f"origin = {_millimetres(self.origin)}")
        return f"points = {{ {', '.join(words)} }}"


class Places:
    """Measuring points (p, 3), in units of `length` m or of a file whose unit is unknown, to be
    placed on the surface of a body.
    """

    def __init__(self, points: np.ndarray, length: float | None, still: Surface, revolved: bool):
        self.points, self.length, self.still, self.revolved = points, length, still, revolved
        self.radius = largest_radius(still)
        self.limit = OFF * self.radius

    def frame(self, table: PointsTable) -> tuple[Frame, float]:
        """Return the stated frame, or the one in which the points lie on the surface, and the
        distance of the farthest from it.
        """
        unit = self.length if table.unit is None else UNITS[table.unit]
        if unit is not None:
            stated = Frame(unit, table.axis or "y", table.origin or 0.0)
            away = self.away(stated)
            if away <= self.limit or not {None} & {table.unit, table.axis, table.origin}:
                return stated, away
        fits = sorted(self.fits(table, unit), key=lambda fit: fit[:2])
        if not fits:
            if unit is None:
                raise SolidgearError(
                    "the file of measuring points does not say its unit of length (dataset 164), and "
                    f"in none of {', '.join(KNOWN)} do they lie on the surface; write their unit, axis "
                    'and origin, such as points = { unit = "mm", axis = "x", origin = "0 mm" }'
                )
            return stated, away
        least = [fit for fit in fits if fit[0] == fits[0][0]]
        if len(least) > 1 or least[0][3]:
            tables = " or ".join(fit[2].table for fit in least)
            raise SolidgearError(
                "measuring points do not lie on the surface where their file places them, and fit "
                + (
                    f"in more than one way: write {tables}"
                    if len(least) > 1
                    else "at many places along the axis: write the origin of the file, where y = 0 of "
                    f"the scene lies, such as {tables}"
                )
            )
        _, away, frame, _ = least[0]
        return frame, away

    def fits(
        self, table: PointsTable, unit: float | None
    ) -> Iterator[tuple[int, float, Frame, bool]]:
        """Yield frames in which the points lie on the surface: the number of differences from the
        scene's frame, the largest distance, and whether the points slide along the axis.
        """
        longest = float(np.ptp(self.still.points, axis=0).max())
        extent = float(np.ptp(self.points, axis=0).max()) / (self.length or 1.0)
        units = KNOWN.values() if table.unit is None else [UNITS[table.unit]]
        axes = TURNS if table.axis is None else [table.axis]
        for size, axis in product(units, axes):
            if size * extent < REACH * longest:
                continue
            changes = (unit is not None and size != unit) + (axis != "y") + axis.startswith("-")
            frame = Frame(size, axis, table.origin or 0.0)
            away = self.away(frame)
            if away <= self.limit:
                yield changes, away, frame, False
            elif self.revolved and table.origin is None and (placed := self._along(frame)):
                yield changes + 1, *placed

    def away(self, frame: Frame) -> float:
        """Return the largest distance from the surface; infinite of points that are all in one
        place.
        """
        points = self.placed(frame)
        size = max(np.ptp(self.still.points, axis=0).max(), self.radius)
        spread = float(np.ptp(points, axis=0).max())
        if len(points) > 1 and spread < SPREAD * self.radius or np.abs(points).max() > 10 * size:
            return math.inf
        return float(nearest(self.still, points)[2].max())

    def placed(self, frame: Frame) -> np.ndarray:
        """Return (p, 3) points in the scene."""
        return frame.placing.to_scene(self.points.T / (self.length or 1.0)).T

    def _along(self, frame: Frame) -> tuple[float, Frame, bool] | None:
        """Return the place along the axis where the points lie on the surface of a body of
        revolution, the largest distance there, and whether they lie on it elsewhere as well.
        """
        points = self.placed(frame)
        along, radii = points[:, 1], np.hypot(points[:, 0], points[:, 2])
        low, high = (self.still.points[:, 1].min(), self.still.points[:, 1].max())
        first, last = low - self.limit - along.min(), high + self.limit - along.max()
        spread = float(np.ptp(points, axis=0).max())
        if last < first or radii.max() > self.radius + self.limit or spread < SPREAD * self.radius:
            return None
        tree = cKDTree(_meridian(self.still, self.limit / PIECES))

        def distances(shifts: np.ndarray) -> np.ndarray:
            places = np.add.outer(shifts, along)
            return tree.query(np.stack(np.broadcast_arrays(places, radii), axis=-1))[0]

        shifts = np.linspace(first, last, max(int(STEPS * (last - first) / self.limit), 2))
        size = distances(shifts)
        fitting = shifts[size.max(axis=1) <= self.limit]
        shift = float(shifts[np.square(size).sum(axis=1).argmin()])
        for step in (self.limit, 2 * self.limit / FINER):
            finer = shift + np.linspace(-step, step, FINER)
            shift = float(finer[np.square(distances(finer)).sum(axis=1).argmin()])
        placed = Frame(frame.unit, frame.axis, -shift)
        away = self.away(placed)
        if away > self.limit:
            return None
        slides = len(fitting) > 0 and float(np.ptp(fitting)) > SLIDE * self.limit
        return away, placed, slides


def _millimetres(place: float) -> str:
    return f'"{1e3 * place:.1f} mm"'


def nearest(still: Surface, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return corners of the nearest triangle of every point, their weights there, and the distance."""
    triangles = _triangles(still)
    near = cKDTree(still.points).query(points, NEAR)[1]
    corners, weights, distances = [], [], []
    for point, candidates in zip(points, near):
        tried = triangles[np.any(np.isin(triangles, candidates), axis=1)]
        weight = np.array([_weights(still.points[triangle], point) for triangle in tried])
        places = np.einsum("tc,tcx->tx", weight, still.points[tried])
        away = np.linalg.norm(places - point, axis=1)
        best = int(away.argmin())
        corners.append(tried[best])
        weights.append(weight[best])
        distances.append(away[best])
    return np.array(corners), np.array(weights), np.array(distances)


def largest_radius(still: Surface) -> float:
    return float(np.hypot(still.points[:, 0], still.points[:, 2]).max())


def refuse_off(
    still: Surface, numbers: Sequence[int], points: np.ndarray, away: np.ndarray
) -> None:
    """Refuse a point that is off the surface."""
    for number, point, distance in zip(numbers, points, away):
        if distance > OFF * largest_radius(still):
            raise SolidgearError(
                f"measuring point {number} at x, y, z = {', '.join(f'{x:.6g}' for x in point)} m of the "
                f"scene is {distance:.3g} m off the surface, more than {100 * OFF:.0f} % of the largest "
                "radius; a TOML file that names the file of points says where they lie, with the keys "
                'of [body]: points = { unit = "mm", axis = "x", origin = "0 mm" }'
            )


def _triangles(still: Surface) -> np.ndarray:
    faces = still.faces
    return np.concatenate(
        [np.reshape(part, (-1, 3)) for part in (faces[:, :3], faces[:, [0, 2, 3]], still.triangles)]
    )


def _meridian(still: Surface, piece: float) -> np.ndarray:
    """Return (k, 2) places along and off the axis on all edges of a surface of revolution."""
    triangles = _triangles(still)
    flat = np.column_stack([still.points[:, 1], np.hypot(still.points[:, 0], still.points[:, 2])])
    edges = np.concatenate([flat[triangles[:, pair]] for pair in ([0, 1], [1, 2], [2, 0])])
    edges = np.unique(np.round(edges.reshape(-1, 4) / (piece / 100)), axis=0) * (piece / 100)
    lengths = np.hypot(*(edges[:, 2:] - edges[:, :2]).T)
    return np.concatenate(
        [
            edge[:2]
            + np.linspace(0.0, 1.0, int(length / piece) + 2)[:, None] * (edge[2:] - edge[:2])
            for edge, length in zip(edges, lengths)
        ]
    )


def _weights(corners: np.ndarray, point: np.ndarray) -> np.ndarray:
    """Return shares of a triangle's corners in the point of it that is near another."""
    sides = (corners[1:] - corners[0]).T
    s, t = np.clip(np.linalg.lstsq(sides, point - corners[0], rcond=None)[0], 0.0, 1.0)
    return np.array([max(1 - s - t, 0.0), s, t]) / (max(1 - s - t, 0.0) + s + t)
