"""One shaft at rest: the deflection line, and the load and stiffness of its bearings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from solidgear.bearings.catalogue import catalogue_of
from solidgear.bearings.catalogued import Catalogued
from solidgear.bearings.life import Life, life
from solidgear.bearings.row import Contacts
from solidgear.core import LADDER, Bearing, Body, Scene, System
from solidgear.core.frames import shift
from solidgear.core.solve.naming import Projection
from solidgear.trains.system.equilibrium import SystemEquilibrium

#: stations of a deflection line
STATIONS = 81


@dataclass(frozen=True, eq=False)
class BearingState:
    """A bearing under load; without catalogue data it has no clearance, rows or life."""

    plain_names = (
        "name",
        "place",
        "load",
        ("radial_load", "radial"),
        ("load_azimuth", "azimuth"),
        "moment",
        ("relative_motion", "relative"),
        "stiffness",
        "clearance",
        "reference_life",
        "static_safety",
        ("rows", "elements"),
    )

    name: str
    place: float  #: along the shaft, m
    load: np.ndarray  #: (6,) load of the shaft on it, N and N m
    relative: np.ndarray  #: (6,) motion of the inner ring against the outer ring, m and rad
    stiffness: np.ndarray  #: (6, 6) tangent at that motion
    clearance: float | None = None  #: radial, at work, m
    rows: tuple[Contacts, ...] = ()  #: loads of rolling elements, row by row
    life: Life | None = None  #: with its static safety

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
        """Number of loaded rolling elements, row by row."""
        return tuple(int((row.load > 0).sum()) for row in self.rows)

    @property
    def pressure(self) -> float | None:
        """Largest contact pressure, Pa; None without catalogue data or load."""
        loaded = [row for row in self.rows if row.load.any()]
        if not loaded:
            return None
        return float(max(max(np.nanmax(row.inner), np.nanmax(row.outer)) for row in loaded))

    @property
    def reference_life(self) -> float | None:
        """Basic reference life in revolutions; None without catalogue data."""
        return None if self.life is None else self.life.reference

    @property
    def static_safety(self) -> float | None:
        """Static safety; None without catalogue data."""
        return None if self.life is None else self.life.static_safety

    @property
    def elements(self) -> list[dict[str, np.ndarray]]:
        """Loads and pressures of rolling elements, row by row, in SI."""
        return [
            {
                "azimuth": row.azimuth,
                "element_load": row.load,
                "inner_pressure": np.nan_to_num(row.inner),
                "outer_pressure": np.nan_to_num(row.outer),
            }
            for row in self.rows
        ]


@dataclass(frozen=True, eq=False)
class ShaftDeflection:
    """One shaft at rest under load, by one model."""

    name: str
    model: str
    stations: np.ndarray  #: (s,) along the shaft, m
    line: np.ndarray  #: (s, 6) motions of cross-sections there (mean, weighted by mass), m and rad
    ports: dict[str, np.ndarray]  #: motions of lumped points, bearings and other stations
    bearings: tuple[BearingState, ...]

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on bearings beyond what they are rated for."""
        lives = [(bearing.name, bearing.life) for bearing in self.bearings if bearing.life]
        return tuple(
            f"bearing {self.name}.{name}: {note}"
            for name, bearing_life in lives
            for note in bearing_life.notes
        )


def shaft_deflection(
    part: str,
    model: str,
    scene: Scene,
    system: System,
    state: SystemEquilibrium,
    body: Body | None,
    made: Mapping[str, Catalogued],
    against: np.ndarray | None = None,
) -> ShaftDeflection:
    """Compute the deflection of one part of a system at rest.

    A rigid part has no `body`, and a line of its two ends; `against` (6,) is the motion, at the start
    of the shaft, of the housing that its line is relative to.
    """
    ports = {
        station.name: system.motion(f"{part}.{station.name}") @ state.coordinates
        for station in scene.stations
    }
    bearings = tuple(
        _bearing(f"{part}.{b.name}", b, state, made)
        for b in scene.bearings
        if f"{part}.{b.name}" in state.load
    )
    if body is None:
        stations = np.array([0.0, scene.length])
        motion = system.motion(f"{part}.{scene.port.name}") @ state.coordinates
        line = np.array([shift((0.0, y - scene.port.y, 0.0)) @ motion for y in stations])
    else:
        sections = body.cache.get(_Sections, lambda: _sections(body, scene.length))
        stations = sections.stations
        line = sections.project(system.expand(part, state.coordinates))
    if against is not None:
        line = line - np.array([shift((0.0, y, 0.0)) @ against for y in stations])
    return ShaftDeflection(part, model, stations, line, ports, bearings)


@dataclass(frozen=True)
class _Sections:
    """Sections of the deflection line of a body."""

    stations: np.ndarray  #: m
    project: Projection  #: of the body's displacement on the motions of sections


def _sections(body: Body, length: float) -> _Sections:
    """Return the sections of a line: those at the nodes of a beam, between which they would be
    guessed.
    """
    stations = np.linspace(0.0, length, STATIONS)
    # a solid has error bars, and nodes all along
    solid = body.fidelity in LADDER and bool(LADDER[body.fidelity].bars_by)
    if not solid and all(block.sections is None for block in body.blocks):
        stations = np.unique(min((block.y for block in body.blocks), key=len))
    return _Sections(stations, Projection(body, stations))


def _bearing(
    end: str, bearing: Bearing, state: SystemEquilibrium, made: Mapping[str, Catalogued]
) -> BearingState:
    relative = state.relative[end]
    plain = BearingState(
        name=bearing.name,
        place=bearing.y,
        load=state.load[end],
        relative=relative,
        stiffness=state.tangent[end],
    )
    rows, data = made.get(end), catalogue_of(bearing)
    if rows is None or data is None:
        return plain
    return replace(
        plain,
        clearance=rows.clearance,
        rows=rows.bearing.contacts(relative),
        life=life(data, rows, relative),
    )
