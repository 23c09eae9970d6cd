"""A shaft at rest under load: the deflection line, and the load and stiffness of its bearings."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from solidgear.bearings.catalogue import catalogue_of
from solidgear.bearings.catalogued import Catalogued
from solidgear.bearings.life import Life, life
from solidgear.bearings.row import Contacts
from solidgear.bearings.solved import AS_STATED, Choice, catalogued_bearings
from solidgear.core import LADDER, Bearing, Body, Scene, SolidgearError, System, build, rubin
from solidgear.core.frames import shift
from solidgear.core.solve.naming import Projection
from solidgear.trains.system.equilibrium import OnBearings, SystemEquilibrium, seats_of

#: stations of a deflection line
STATIONS = 81
#: models of a shaft, the cheapest first
MODELS = ("euler", "timoshenko", LADDER.judges[0])
#: name of the shaft in a system of one
SHAFT = "shaft"
#: modes kept of a body for statics
FEW = 6
#: why numbers have no error bar
WITHOUT_BAR = "each model is solved on one mesh; solidgear stiffness shows error bars"


@dataclass(frozen=True, eq=False)
class BearingState:
    """A bearing under load; without catalogue data it has no clearance, rows or life."""

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

    def as_dict(self) -> dict:
        """Return plain data in SI that JSON can hold."""
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
            "reference_life": None if self.life is None else _finite(self.life.reference),
            "static_safety": None if self.life is None else _finite(self.life.static_safety),
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


def _finite(value: float) -> float | None:
    """Return a number, or None where it is infinite, which JSON cannot hold."""
    return value if np.isfinite(value) else None


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

    def as_dict(self) -> dict:
        """Return plain data in SI that JSON can hold."""
        return {
            "name": self.name,
            "model": self.model,
            "stations": self.stations.tolist(),
            "line": self.line.tolist(),
            "ports": {name: motion.tolist() for name, motion in self.ports.items()},
            "bearings": [bearing.as_dict() for bearing in self.bearings],
        }


@dataclass(frozen=True, eq=False)
class SceneDeflection:
    """A shaft at rest under the load of the scene, by several models."""

    title: str
    port: str  #: the lumped point
    load: np.ndarray  #: (6,) at the lumped point, N and N m
    shafts: tuple[ShaftDeflection, ...]  #: one a model, the finest last

    def as_dict(self) -> dict:
        """Return plain data in SI that JSON can hold."""
        return {
            "scene": self.title,
            "load": self.load.tolist(),
            "models": {shaft.model: shaft.as_dict() for shaft in self.shafts},
            "why_without_bar": WITHOUT_BAR,
        }


def deflect_scene(
    scene: Scene,
    models: Sequence[str] = MODELS,
    progress: Callable[[str], None] = lambda text: None,
) -> SceneDeflection:
    """Compute the deflection of a shaft under the [load] of the scene, by several models, the finest
    last; bearings of catalogue data need no stiffness yet.

    Examples
    --------
    >>> import solidgear as sg
    >>> deflection = deflect_scene(sg.load("geometry/gearbox_catalogue.toml"), ["timoshenko"])
    >>> round(sum(float(b.load[2]) for b in deflection.shafts[0].bearings), 6)
    1400.0
    """
    load, shafts = load_of(scene), []
    for model in models:
        progress(model)
        shafts.append(ShaftAtRest(scene, model).settled())
    return SceneDeflection(scene.title or scene.name, scene.port.name, load, tuple(shafts))


def load_of(scene: Scene) -> np.ndarray:
    """Return the load (6,) at the lumped point of a scene, N and N m; refuse a scene without load."""
    if scene.load is None:
        raise SolidgearError(
            'there is no load; write [load] with forces at the port, such as z = "2 kN", or give '
            "--load"
        )
    return np.array(scene.load.six)


class ShaftAtRest:
    """A shaft by one model, to be settled under the load of the scene."""

    def __init__(self, scene: Scene, model: str):
        self.scene, self.model = scene, model
        self.body = build(scene, model)
        self.system = System({SHAFT: rubin(self.body, n=FEW)})
        self.load = self.system.load({f"{SHAFT}.{scene.port.name}": load_of(scene)})

    def settled(self, choice: Choice = AS_STATED) -> ShaftDeflection:
        """Compute the deflection with the bearings at a choice in the ranges of their data; refuse
        a shaft that nothing holds.
        """
        bearings = {
            f"{SHAFT}.{name}": rows
            for name, rows in catalogued_bearings(self.scene, choice).items()
        }
        supported = OnBearings(self.system, (seats_of(SHAFT, self.scene, bearings),))
        state = supported.equilibrium(self.load)
        return shaft_deflection(
            SHAFT, self.model, self.scene, self.system, state, self.body, bearings
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
    if all(block.sections is None for block in body.blocks):
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
