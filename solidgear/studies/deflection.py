"""A shaft at rest under load: where it goes, what its bearings carry, and how each carries it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from solidgear.bearings.catalogued import Catalogued
from solidgear.bearings.row import Contacts
from solidgear.body import Body
from solidgear.scene import Scene
from solidgear.solve.naming import Projection
from solidgear.system.equilibrium import SystemEquilibrium
from solidgear.system.system import System

#: stations of a deflection line
STATIONS = 81


@dataclass(frozen=True, eq=False)
class BearingState:
    """A bearing and what it carries.

    Attributes
    ----------
    name : str
    place : float
        Along the shaft, m.
    load : (6,) ndarray
        Of the shaft on it, N and N m.
    relative : (6,) ndarray
        Motion of its inner ring against the outer one, m and rad.
    stiffness : (6, 6) ndarray
        Tangent at that point.
    clearance : float or None
        Radial, at work, m; None of a bearing without catalogue data.
    rows : tuple of Contacts
        Loads of rolling elements, row by row; none without catalogue data.
    """

    name: str
    place: float
    load: np.ndarray
    relative: np.ndarray
    stiffness: np.ndarray
    clearance: float | None
    rows: tuple[Contacts, ...]

    @property
    def radial(self) -> float:
        """Size of the radial load, N."""
        return float(np.hypot(self.load[0], self.load[2]))

    @property
    def azimuth(self) -> float:
        """Direction of the radial load, from x towards z, rad."""
        return float(np.arctan2(self.load[2], self.load[0]))

    @property
    def moment(self) -> float:
        """Size of the tilting moment, N m."""
        return float(np.hypot(self.load[3], self.load[5]))

    @property
    def loaded(self) -> tuple[int, ...]:
        """Rolling elements that carry, row by row."""
        return tuple(int((row.load > 0).sum()) for row in self.rows)

    @property
    def pressure(self) -> float | None:
        """Largest contact pressure, Pa; None without catalogue data or load."""
        loaded = [row for row in self.rows if row.load.any()]
        if not loaded:
            return None
        return float(max(max(np.nanmax(row.inner), np.nanmax(row.outer)) for row in loaded))

    def as_dict(self) -> dict:
        """Plain data in SI that JSON can hold."""
        return {
            "name": self.name,
            "place": self.place,
            "load": self.load.tolist(),
            "radial_load": self.radial,
            "load_azimuth": self.azimuth,
            "moment": self.moment,
            "relative_motion": self.relative.tolist(),
            "stiffness": self.stiffness.tolist(),
            "clearance": self.clearance,
            "rows": [
                {
                    "azimuth": row.azimuth.tolist(),
                    "element_load": row.load.tolist(),
                    "inner_pressure": np.nan_to_num(row.inner).tolist(),
                    "outer_pressure": np.nan_to_num(row.outer).tolist(),
                }
                for row in self.rows
            ],
        }


@dataclass(frozen=True, eq=False)
class ShaftDeflection:
    """One shaft at rest under load, by one model.

    Attributes
    ----------
    name, model : str
    stations : (s,) ndarray
        Along the shaft, m; empty of a model without a body.
    line : (s, 6) ndarray
        Motions of cross-sections there (mean, weighted by mass), m and rad.
    ports : dict of str to (6,) ndarray
        Motions of lumped points, bearings and other stations.
    bearings : tuple of BearingState
    """

    name: str
    model: str
    stations: np.ndarray
    line: np.ndarray
    ports: dict[str, np.ndarray]
    bearings: tuple[BearingState, ...]

    def as_dict(self) -> dict:
        """Plain data in SI that JSON can hold."""
        return {
            "name": self.name,
            "model": self.model,
            "stations": self.stations.tolist(),
            "line": self.line.tolist(),
            "ports": {name: motion.tolist() for name, motion in self.ports.items()},
            "bearings": [bearing.as_dict() for bearing in self.bearings],
        }


def shaft_deflection(
    part: str,
    model: str,
    scene: Scene,
    system: System,
    found: SystemEquilibrium,
    body: Body | None,
    made: Mapping[str, Catalogued],
) -> ShaftDeflection:
    """Deflection of one part of a system at rest.

    Parameters
    ----------
    part : str
        Its name in the system.
    model : str
    scene : Scene
        Of that shaft.
    system : System
        Without its bearings.
    found : SystemEquilibrium
    body : Body or None
        That the part was reduced from; None of a rigid one, whose line has its two ends.
    made : mapping of str to Catalogued
        Bearings of catalogue data, by ``part.name``.
    """
    ports = {
        station.name: system.motion(f"{part}.{station.name}") @ found.coordinates
        for station in scene.stations
    }
    bearings = tuple(
        _bearing(f"{part}.{b.name}", b.name, b.y, found, made)
        for b in scene.bearings
        if f"{part}.{b.name}" in found.load
    )
    if body is None:
        stations = np.array([0.0, scene.length])
        line = _rigid_line(system, part, scene, found.coordinates, stations)
    else:
        stations = np.linspace(0.0, scene.length, STATIONS)
        line = Projection(body, stations)(system.expand(part, found.coordinates))
    return ShaftDeflection(part, model, stations, line, ports, bearings)


def _rigid_line(
    system: System, part: str, scene: Scene, coordinates: np.ndarray, stations: np.ndarray
) -> np.ndarray:
    """(s, 6) motions along a rigid shaft."""
    from solidgear.frames import shift

    motion = system.motion(f"{part}.{scene.port.name}") @ coordinates
    return np.array([shift((0.0, y - scene.port.y, 0.0)) @ motion for y in stations])


def _bearing(
    end: str, name: str, place: float, found: SystemEquilibrium, made: Mapping[str, Catalogued]
) -> BearingState:
    own = made.get(end)
    relative = found.relative[end]
    return BearingState(
        name,
        place,
        found.load[end],
        relative,
        found.tangent[end],
        None if own is None else own.clearance,
        () if own is None else own.bearing.contacts(relative),
    )
