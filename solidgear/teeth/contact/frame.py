"""Where the frame of a pair of wheels lies in a train, and what carries the wheels there."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from solidgear.teeth.contact.cells import Cells
from solidgear.trains.assembly.mesh_place import MeshPlace
from solidgear.trains.file.mesh_teeth import MeshTeeth


@dataclass(frozen=True, eq=False)
class Frame:
    """Origin and axes of a pair in the axes of the train's first shaft."""

    origin: np.ndarray  #: (3,) m
    axes: np.ndarray  #: (3, 3) u, v, w in columns

    @classmethod
    def of(cls, place: MeshPlace, teeth: MeshTeeth) -> Frame:
        """Return the frame of two cylindrical wheels: origin in the pitch point at the middle of the
        shared face, axes along the transverse line of action and the shafts, so that contact lines run
        on towards larger w.
        """
        transverse = place.normal - (place.normal @ place.axis) * place.axis
        u = -transverse / np.linalg.norm(transverse)
        w = teeth.along[0] * place.axis
        return cls(place.pitch_point, np.column_stack([u, np.cross(w, u), w]))


@dataclass(frozen=True, eq=False)
class Stations:
    """Places along the axis of one wheel at which its body moves as a rigid section."""

    #: (m,) along w from the origin of the pair, ascending, m
    place: np.ndarray
    points: np.ndarray  #: (m, 3) in the axes of the first shaft, m

    def rows(self, point: np.ndarray, normal: np.ndarray, frame: Frame) -> np.ndarray:
        """Return the (n, 6 m) motion of points along normals, both (n, 3) in the frame of the pair, by
        the six motions of every station in the axes of the first shaft; linear along the face.
        """
        points = frame.origin + point @ frame.axes.T
        normals = normal @ frame.axes.T
        levers = points[:, None] - self.points
        normals = np.broadcast_to(normals[:, None], levers.shape)
        rows = np.concatenate([normals, np.cross(levers, normals)], axis=2)
        weights = _between(self.place, point[:, 2])
        return (weights[:, :, None] * rows).reshape(len(points), -1)


def _between(place: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Return the (n, m) weights of stations at places, linear between and beyond."""
    if len(place) < 2:
        return np.ones((len(z), len(place)))
    out, each = np.zeros((len(z), len(place))), np.arange(len(z))
    before = np.clip(np.searchsorted(place, z) - 1, 0, len(place) - 2)
    share = (z - place[before]) / (place[before + 1] - place[before])
    out[each, before], out[each, before + 1] = 1 - share, share
    return out


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
    #: (N,) load of the teeth where the train is at rest, spread over the face
    spread: np.ndarray
    #: rows that were computed, by the points and normals of cells
    _rows: dict[bytes, np.ndarray] = field(default_factory=dict, init=False, repr=False)

    def rows(self, cells: Cells) -> np.ndarray:
        """Return the (n, N) rows by which cells open: the first wheel's motion less the second's."""
        places = cells.point.tobytes() + cells.normal.tobytes()
        if places not in self._rows:
            self._rows[places] = self.opening(cells.point, cells.normal)
        return self._rows[places]

    def opening(self, point: np.ndarray, normal: np.ndarray) -> np.ndarray:
        """Return the (n, N) rows by which flanks open at points along normals, both (n, 3) in the frame
        of the pair.
        """
        first, second = (stations.rows(point, normal, self.frame) for stations in self.stations)
        return np.hstack([first, -second])

    @property
    def turning(self) -> np.ndarray:
        """(N, N) what of the motions is turning about the axes."""
        axis = self.frame.axes[:, 2]
        turn = np.zeros((6, 6))
        turn[3:, 3:] = np.outer(axis, axis)
        return np.kron(np.eye(sum(len(stations.place) for stations in self.stations)), turn)


@dataclass(frozen=True, eq=False)
class RigidSupports:
    """Both wheels as rigid bodies, their relative motion at the origin of the pair."""

    compliance: np.ndarray  #: (6, 6)
    motion: np.ndarray  #: (6,) of the first wheel less the second before any load, m, rad

    def rows(self, cells: Cells) -> np.ndarray:
        """Return the (n, 6) rows by which cells open."""
        return cells.rows
