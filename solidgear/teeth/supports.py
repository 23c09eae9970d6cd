r"""What carries the wheels of every mesh of a train at an operating point.

The train is settled there with all its loads (:mod:`solidgear.trains.load.operation`), its shafts as
Timoshenko beams with sections along the faces of their gears, which twist and bend within the face.
About that state motions of the sections are ``u + S (f - w)`` under the loads f of the teeth's cells,
with w the load of the teeth in that state, at the lumped points, and the compliance S of all shafts,
bearings at their load and the housing, the teeth taken out and every shaft held against turning where
torque enters or leaves it.  So the deflection under other meshes, belts and weight, and what the teeth's
own load adds, both stand in it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import scipy.linalg as sla

from solidgear.core import Scene, SolidgearError, System
from solidgear.core.scene.stations import Port
from solidgear.teeth.contact.cylindrical import CylindricalPair
from solidgear.teeth.contact.frame import Frame, Stations, Supports
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.mesh_place import MeshPlace, place_of
from solidgear.trains.file.mesh_teeth import MeshTeeth, wheels_of
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import PlanetMesh
from solidgear.trains.file.train import Train
from solidgear.trains.load.operation import Operating
from solidgear.trains.load.state import OperatingState, with_settled_bearings

#: model of all shafts, and sections along a face
SHAFT, SECTIONS = "timoshenko", 5
#: seat of a section, of the face
SEAT = 0.05
#: of a section among the lumped points of a scene
MARK = " face "
#: of a gear: its middle from the lumped point, and its width, m
Face = tuple[float, float]


@dataclass(frozen=True, eq=False)
class Carried:
    """A train at rest with sections along the faces of its gears.

    Examples
    --------
    >>> import solidgear as sg
    >>> from solidgear.trains.file.mesh_teeth import wheels_of
    >>> train = sg.load_train("geometry/gearbox_train.toml")
    >>> carried = Carried.at_rest(with_sections(train), train.point)
    >>> teeth = wheels_of(carried.train.pairs[0])
    >>> place = carried.place(carried.train.pairs[0], teeth)
    >>> supports = carried.supports(place, Frame.of(place, teeth))
    >>> [len(stations.place) for stations in supports.stations]   # the wheel is a rigid mass
    [5, 1]
    """

    operating: Operating  #: of a train as of :func:`with_sections`
    state: OperatingState
    #: wheels whose contact was solved, by their geometry, bodies and model of the teeth
    pairs: dict[Any, CylindricalPair] = field(default_factory=dict, repr=False)
    _supports: dict[Any, Supports] = field(default_factory=dict, init=False, repr=False)

    @classmethod
    def at_rest(cls, train: Train, point: OperatingPoint) -> Carried:
        """Settle a train of :func:`with_sections` at an operating point; refused without a torque."""
        if point.torque == 0:
            raise SolidgearError("a torque of 0 N m presses no teeth together; give another one")
        operating = Operating(Assembly(train))
        return cls(operating, operating.at(point))

    def at(self, point: OperatingPoint) -> Carried:
        """Settle the same train at another point, from this state on."""
        return Carried(self.operating, self.operating.at(point, self.state), self.pairs)

    @property
    def train(self) -> Train:
        """The train with its sections."""
        return self.operating.assembly.train

    @property
    def point(self) -> OperatingPoint:
        """Where it is at rest."""
        return self.state.point

    @cached_property
    def assembly(self) -> Assembly:
        """The train on the flanks that carry, with the bearings of the state."""
        settled = with_settled_bearings(self.train, self.state)
        return self.operating.assembly.with_train(settled).on_flank(self.point.coast)

    @cached_property
    def system(self) -> System:
        """The train with its bearings about the state."""
        return self.assembly.coupled(self.assembly.models_by_shaft([SHAFT]))

    def coast(self, mesh: Pair | PlanetMesh) -> bool:
        """Return True where a mesh carries on the flank that the file does not name, and planets of a
        sun that drives about -y.
        """
        if isinstance(mesh, PlanetMesh):
            return self.assembly.stages[mesh.stage.name].way < 0
        return self.point.coast

    def place(self, mesh: Pair | PlanetMesh, teeth: MeshTeeth) -> MeshPlace:
        """Return where a mesh lies in the system."""
        return place_of(self.assembly, self.system, mesh, teeth)

    def force(self, place: MeshPlace) -> float:
        """Return the force of the teeth of a mesh in the state, N."""
        return self.state.mesh_forces[place.force]

    def supports(self, place: MeshPlace, frame: Frame) -> Supports:
        """Return what carries both wheels of a mesh."""
        key = place.link, *frame.origin.tolist(), *frame.axes.ravel().tolist()
        if key not in self._supports:
            self._supports[key] = self._solved_supports(place, frame)
        return self._supports[key]

    def _solved_supports(self, place: MeshPlace, frame: Frame) -> Supports:
        held = self._held(place)
        stations, rows, motions = [], [], []
        for end in place.ends:
            names = [] if end is None else self._sections(end, frame)
            ports = [self.system.port(name) for name in names]
            points = np.array([port.point for port in ports]).reshape(-1, 3)
            stations.append(Stations((points - frame.origin) @ frame.axes[:, 2], points))
            for name, port in zip(names, ports):
                turn = np.kron(np.eye(2), port.axes)
                rows.append(turn @ port.rows)
                motions.append(turn @ self._motion(name, held))
        by_end = place.load(self.system)
        loaded = [self.system.motion(end) for end, _ in by_end]
        total = self.force(place) * np.concatenate([load for _, load in by_end])
        count = 6 * len(rows)
        flexibility = _flexibility(self._without_teeth(held), np.vstack([*rows, *loaded]))
        motion = np.concatenate(motions) - flexibility[:count, count:] @ total
        return Supports(frame, (stations[0], stations[1]), flexibility[:count, :count], motion)

    def _held(self, place: MeshPlace) -> dict[str, str]:
        """Return the end at which every part is held against turning: of a shaft where the torque of
        these teeth enters or leaves it.
        """
        train, ends = self.train, {}
        for side, shaft in train.shafts.items():
            gear = next((name for name in shaft.gears if f"{side}.{name}" in place.ends), "")
            entry = train.torque_entry(side, gear) or gear or shaft.scene.port.name
            ends[side] = f"{side}.{entry}"
        for stage in self.assembly.stages.values():
            ends |= {name: f"{name}.centre" for name in stage.planets.values()}
        return ends

    def _without_teeth(self, held: dict[str, str]) -> tuple[np.ndarray, np.ndarray]:
        """Return the factor of the stiffness without teeth, what is held as constraints."""
        system = self.system
        rows, places = system.strains
        bodies = np.ones(len(rows), bool)
        for mesh in self.train.teeth:
            bodies[places[mesh.name]] = False
        stiffness = rows[bodies].T @ rows[bodies]
        fixed = np.vstack([system.motion(end)[4] for end in held.values()])
        size = np.abs(np.diag(stiffness)).max()
        bordered = np.block(
            [[stiffness, size * fixed.T], [size * fixed, np.zeros((len(fixed), len(fixed)))]]
        )
        return sla.lu_factor(bordered)

    def _motion(self, end: str, held: dict[str, str]) -> np.ndarray:
        """Return the (6,) motion of a port in the state, without the turning of its part, in its own
        axes.
        """
        motion, part = self.state.motion(end).copy(), end.partition(".")[0]
        if part in held:  # a housing does not turn freely
            motion[4] -= self.state.motion(held[part])[4]
        return motion

    def _sections(self, end: str, frame: Frame) -> list[str]:
        """Return the ends of the sections of a wheel along w, or its own where it is rigid."""
        side, _, port = end.partition(".")
        if side not in self.train.shafts:
            return [end]
        names = [p.name for p in self.train.shafts[side].scene.ports]
        ends = [f"{side}.{name}" for name in names if name.startswith(f"{port}{MARK}")]
        way = frame.axes[:, 2]
        return sorted(ends, key=lambda name: self.system.port(name).point @ way) or [end]


def _flexibility(factor: tuple[np.ndarray, np.ndarray], rows: np.ndarray) -> np.ndarray:
    """Return the (N, N) motions of rows under unit loads on them."""
    right = np.zeros((len(factor[0]), len(rows)))
    right[: rows.shape[1]] = rows.T
    return rows @ sla.lu_solve(factor, right)[: rows.shape[1]]


def with_sections(train: Train) -> Train:
    """Return the train with lumped points along the face of every cylindrical gear that is part of its
    shaft.
    """
    faces: dict[tuple[str, str], Face] = {}
    for mesh in train.teeth:
        teeth = wheels_of(mesh)
        if teeth is None or not teeth.wheels.face_width > 0:
            continue
        for (side, port), wheel in zip(_gears(mesh), (teeth.wheels.first, teeth.wheels.second)):
            gear = train.shafts[side].gears[port]
            if gear.head is None:
                faces[side, port] = gear.face_offset, wheel.face_width
    shafts = {}
    for side, shaft in train.shafts.items():
        scene = shaft.scene
        points = [
            point
            for (of, port), face in faces.items()
            if of == side
            for point in _points(scene, port, face)
        ]
        further = (*scene.further_ports, *points)
        shafts[side] = shaft.with_changes(scene=scene.with_changes(further_ports=further))
    return train.with_changes(shafts=shafts)


def _gears(mesh: Pair | PlanetMesh) -> list[tuple[str, str]]:
    """Return shaft and lumped point of the wheels of a mesh that are gears of shafts, the first first."""
    if isinstance(mesh, Pair):
        return list(zip(mesh.shafts, mesh.ports))
    return [(mesh.stage.shafts[0], mesh.stage.ports[0])] if mesh.mate == "sun" else []


def _points(scene: Scene, name: str, face: Face) -> Iterator[Port]:
    """Yield the sections along a face, on the shaft."""
    port, (offset, width) = next(p for p in scene.ports if p.name == name), face
    half = SEAT * width / 2
    low = max(port.y + offset - width / 2, 0.0)
    high = min(port.y + offset + width / 2, scene.length)
    for k, y in enumerate(np.linspace(low + half, high - half, SECTIONS)):
        # a seat lies on one segment
        segment = scene.segments_at(y)[0]
        seat = max(y - half, segment.y0), min(y + half, segment.y1)
        yield port.with_changes(name=f"{name}{MARK}{k}", position=y, lo=seat[0], hi=seat[1])
