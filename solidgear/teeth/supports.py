r"""What carries the wheels of every mesh of a train at an operating point.

The train is settled there with all its loads (:mod:`solidgear.trains.load.operation`), its shafts as
Timoshenko beams with sections along the faces of their gears, which twist and bend within the face.
About that state motions of the sections are ``u + S (f - w)`` under the loads f of the teeth's cells,
with w the load of the teeth in that state, as its springs have it, and the compliance S of all shafts,
bearings at their load, the housing and all other meshes, these teeth taken out and both shafts held
against turning where torque enters or leaves them.  So the deflection under other meshes, belts and
weight, and what the teeth's own load adds, both stand in it; under w it is that of the state.

**Planets.**  A sun that floats goes where all of its planets push it.  What the teeth of one planet do
beyond w, those of all planets are taken to do, each at its own azimuth: their teeth are taken out as
well, and S has the loads f on all of them, turned about the axis.  For equal planets this is so.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import scipy.linalg as sla

from solidgear.bearings.solved import AS_STATED, Choice
from solidgear.core import Scene, SolidgearError, System
from solidgear.core.scene.stations import Port
from solidgear.teeth.contact.cylindrical import CylindricalPair
from solidgear.teeth.contact.frame import Frame, Stations, Supports
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.mesh_place import MeshPlace, place_of
from solidgear.trains.assembly.stages import mesh_rows
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
#: places of a load that is spread over the face
EVEN = 24
#: of a section among the lumped points of a scene
MARK = " face "
#: of a gear: its middle from the lumped point, and its width, m
Face = tuple[float, float]


def on_beams(assembly: Assembly, choice: Choice = AS_STATED) -> Operating:
    """Return a train of :func:`with_sections` to be put at rest on the beams that contact bends."""
    return Operating(assembly.settling(SHAFT), SHAFT, choice=choice)


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
    >>> supports = carried.supports(carried.train.pairs[0], place, Frame.of(place, teeth))
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
        operating = on_beams(Assembly(train))
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
        """Return the force of the teeth of a mesh in the state, N; of planets each has its own."""
        rows, forces = self.springs(place)
        load = np.sum([self.system.motion(end).T @ six for end, six in place.load(self.system)], 0)
        # rows of planets that are driven the other way are negative where teeth press
        return float(np.sign(rows.mean(axis=0) @ load) * forces.sum())

    def springs(self, place: MeshPlace) -> tuple[np.ndarray, np.ndarray]:
        """Return the (s, N) stretches of the springs that the teeth of a mesh are in the state, and
        their (s,) forces, N.
        """
        rows, stiffness = mesh_rows(self.state.system, place.link)
        return rows, -stiffness * (rows @ self.state.coordinates)

    def supports(self, mesh: Pair | PlanetMesh, place: MeshPlace, frame: Frame) -> Supports:
        """Return what carries both wheels of a mesh, with its place and frame."""
        key = place.link, *frame.origin.tolist(), *frame.axes.ravel().tolist()
        if key not in self._supports:
            self._supports[key] = self._solved_supports(mesh, place, frame)
        return self._supports[key]

    def _solved_supports(self, mesh: Pair | PlanetMesh, place: MeshPlace, frame: Frame) -> Supports:
        entries, teeth = self._entries(mesh), wheels_of(mesh, self.coast(mesh))
        width = 0.0 if teeth is None else teeth.wheels.face_width
        alike = [_Touching.at(self, *at, width) for at in self._alike(mesh, place, frame, teeth)]
        first = alike[0]
        loads, beyond = np.zeros_like(first.rows), np.zeros(self.system.size)
        for touching in alike:
            turn = touching.frame.axes @ frame.axes.T
            turned = np.kron(np.eye(len(first.rows) // 3), turn)
            loads += turned.T @ touching.rows
            beyond += (touching.spread - turned @ first.spread) @ touching.rows - touching.springs
        factor = self._without_teeth([touching.place.link for touching in alike], entries)
        moved = first.rows @ _solved(factor, np.column_stack([loads.T, beyond]))
        compliance, by_others = moved[:, :-1], moved[:, -1]
        # bearings and planets that are not the same all around leave it a little unsymmetric
        compliance = (compliance + compliance.T) / 2
        motion = self._motions(first.names, entries) + by_others
        return Supports(frame, first.stations, compliance, motion, first.spread)

    def _alike(
        self, mesh: Pair | PlanetMesh, place: MeshPlace, frame: Frame, teeth: MeshTeeth | None
    ) -> list[tuple[MeshPlace, Frame]]:
        """Return the places of the meshes that do what a mesh does, which is the first: of a pair that
        one alone, of a planet those of all planets.
        """
        places = [(place, frame)]
        if isinstance(mesh, PlanetMesh):
            assert teeth is not None  # a stage is refused without a module
            others = [m for m in mesh.stage.meshes if m.mate == mesh.mate and m.name != mesh.name]
            at = [self.place(other, teeth) for other in others]
            places += [(other, Frame.of(other, teeth)) for other in at]
        return places

    def _entries(self, mesh: Pair | PlanetMesh) -> list[str]:
        """Return the ends at which the shafts on both sides of these teeth are held against turning:
        where torque enters or leaves them.
        """
        both = mesh if isinstance(mesh, Pair) else mesh.stage
        return [
            f"{side}.{self.train.torque_entry(side, port) or port}"
            for side, port in zip(both.shafts, both.ports)
        ]

    def _without_teeth(
        self, links: Sequence[str], entries: Sequence[str]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the factor of the stiffness without the teeth of some links, with no turning at the
        entries as constraints.
        """
        system = self.system
        rows, places = system.strains
        bodies = np.ones(len(rows), bool)
        for link in links:
            bodies[places[link]] = False
        stiffness = rows[bodies].T @ rows[bodies]
        fixed = np.vstack([system.motion(end)[4] for end in entries])
        size = np.abs(np.diag(stiffness)).max()
        bordered = np.block(
            [[stiffness, size * fixed.T], [size * fixed, np.zeros((len(fixed), len(fixed)))]]
        )
        return sla.lu_factor(bordered)

    def _motions(self, names: Sequence[str], entries: Sequence[str]) -> np.ndarray:
        """Return the (6 n,) motions of ports in the state in the axes of the first shaft, those of shafts
        and planets without their turning.
        """
        held = {end.partition(".")[0]: end for end in entries}
        for stage in self.assembly.stages.values():
            held |= {name: f"{name}.centre" for name in stage.planets.values()}
        motions = []
        for end in names:
            motion, part = self.state.motion(end).copy(), end.partition(".")[0]
            if part in held:  # a housing does not turn freely
                motion[4] -= self.state.motion(held[part])[4]
            motions.append(np.kron(np.eye(2), self.system.port(end).axes) @ motion)
        return np.concatenate(motions)

    def sections(self, end: str | None, frame: Frame) -> list[str]:
        """Return the ends of the sections of a wheel along w, its own where it is rigid, and none of the
        ground.
        """
        if end is None:
            return []
        side, _, port = end.partition(".")
        if side not in self.train.shafts:
            return [end]
        names = [p.name for p in self.train.shafts[side].scene.ports]
        ends = [f"{side}.{name}" for name in names if name.startswith(f"{port}{MARK}")]
        way = frame.axes[:, 2]
        return sorted(ends, key=lambda name: self.system.port(name).point @ way) or [end]


@dataclass(frozen=True, eq=False)
class _Touching:
    """Teeth that touch in the state of a train."""

    place: MeshPlace
    frame: Frame
    names: tuple[str, ...]  #: ends of the stations of both wheels
    stations: tuple[Stations, Stations]
    rows: np.ndarray  #: (n, N) motions of the stations, in the axes of the first shaft
    springs: np.ndarray  #: (N,) load of the teeth on the coordinates of the system
    spread: np.ndarray  #: (n,) the same load on the stations, spread over the face

    @classmethod
    def at(cls, carried: Carried, place: MeshPlace, frame: Frame, width: float) -> _Touching:
        """Look at the teeth of a mesh, with a face of that width, m."""
        system, names, stations = carried.system, [], []
        for end in place.ends:
            sections = carried.sections(end, frame)
            points = np.array([system.port(name).point for name in sections]).reshape(-1, 3)
            stations.append(Stations((points - frame.origin) @ frame.axes[:, 2], points))
            names += sections
        ports = [system.port(name) for name in names]
        rows = np.vstack([np.kron(np.eye(2), port.axes) @ port.rows for port in ports])
        stretches, forces = carried.springs(place)
        springs, both = forces @ stretches, (stations[0], stations[1])
        spread = np.zeros(len(rows))
        if width:
            first = system.port(place.ends[0])
            load = np.linalg.lstsq(first.rows.T, springs, rcond=None)[0]
            force, moment = first.axes @ load[:3], first.axes @ load[3:]
            moment += np.cross(first.point - frame.origin, force)
            spread = _spread(frame, both, width, force, moment)
        return cls(place, frame, tuple(names), both, rows, springs, spread)


def _spread(
    frame: Frame,
    stations: tuple[Stations, Stations],
    width: float,
    force: np.ndarray,
    moment: np.ndarray,
) -> np.ndarray:
    """Return the load on the stations of both wheels by a force and a moment of teeth on the first, each
    (3,) at the origin of a frame, which lie along the face as a straight line.
    """
    z = ((np.arange(EVEN) + 0.5) / EVEN - 0.5) * width
    normal = frame.axes.T @ force
    size = np.linalg.norm(normal)
    lever = moment @ frame.axes[:, 1] / normal[0]
    along = size * (1 / EVEN + lever * z / (z @ z))
    points = np.column_stack([np.zeros((EVEN, 2)), z])
    normals = np.tile(normal / size, (EVEN, 1))
    first, second = (one.rows(points, normals, frame) for one in stations)
    return along @ np.hstack([first, -second])


def _solved(factor: tuple[np.ndarray, np.ndarray], loads: np.ndarray) -> np.ndarray:
    """Return the (N, k) motions under loads (N, k) where some are held as constraints."""
    right = np.zeros((len(factor[0]), loads.shape[1]))
    right[: len(loads)] = loads
    return sla.lu_solve(factor, right)[: len(loads)]


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
    low = max(port.y + offset - width / 2, 0.0)
    high = min(port.y + offset + width / 2, scene.length)
    half = SEAT * (high - low) / 2
    for k, y in enumerate(np.linspace(low + half, high - half, SECTIONS)):
        # a seat lies on one segment
        segment = scene.segments_at(y)[0]
        seat = max(y - half, segment.y0), min(y + half, segment.y1)
        yield port.with_changes(name=f"{name}{MARK}{k}", position=y, lo=seat[0], hi=seat[1])
