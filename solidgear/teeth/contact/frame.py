"""Where the frame of a pair of wheels lies in a train, and what carries the wheels there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.core.frames import cross_matrix
from solidgear.teeth.contact.cells import Cells


@dataclass(frozen=True, eq=False)
class Frame:
    """Origin and axes of a pair in the axes of the train's first shaft."""

    origin: np.ndarray  #: (3,) m
    axes: np.ndarray  #: (3, 3) u, v, w in columns


@dataclass(frozen=True, eq=False)
class Stations:
    """Places along the axis of one wheel at which its body moves as a rigid section."""

    #: (m,) along w from the origin of the pair, ascending, m
    place: np.ndarray
    points: np.ndarray  #: (m, 3) in the axes of the first shaft, m

    def rows(self, cells: Cells, frame: Frame) -> np.ndarray:
        """Return the (n, 6 m) motion of cells along the normal, by the six motions of every station
        in the axes of the first shaft; linear between stations.
        """
        points = frame.origin + cells.point @ frame.axes.T
        normals = cells.normal @ frame.axes.T
        n, m = len(points), len(self.place)
        out = np.zeros((n, m, 6))
        weights = _between(self.place, cells.z)
        for k in range(m):
            lever = points - self.points[k]
            row = np.hstack([normals, np.cross(lever, normals)])
            out[:, k] = weights[:, k, None] * row
        return out.reshape(n, 6 * m)


def _between(place: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Return the (n, m) weights of stations at places, linear between and constant beyond."""
    hats = np.eye(len(place))
    return np.column_stack([np.interp(z, place, hat) for hat in hats])


@dataclass(frozen=True, eq=False)
class Supports:
    """What carries both wheels: shafts, bearings and housing.

    The motion of both wheels' stations, one below the other, is ``motion + compliance f`` under the
    loads f on them.
    """

    frame: Frame
    stations: tuple[Stations, Stations]
    compliance: np.ndarray  #: (N, N)
    motion: np.ndarray  #: (N,) under all other loads

    def rows(self, cells: Cells) -> np.ndarray:
        """Return the (n, N) rows by which cells open: the first wheel's motion less the second's."""
        first, second = (stations.rows(cells, self.frame) for stations in self.stations)
        return np.hstack([first, -second])


@dataclass(frozen=True, eq=False)
class RigidSupports:
    """Both wheels as rigid bodies, their relative motion at the origin of the pair."""

    compliance: np.ndarray  #: (6, 6)
    motion: np.ndarray  #: (6,) of the first wheel less the second before any load, m, rad

    def rows(self, cells: Cells) -> np.ndarray:
        """Return the (n, 6) rows by which cells open."""
        return cells.rows


def carried(point: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return the (6, 6) motion at a point of a rigid body that moves by six components at another."""
    out = np.eye(6)
    out[:3, 3:] = -cross_matrix(np.asarray(point) - np.asarray(at))
    return out
