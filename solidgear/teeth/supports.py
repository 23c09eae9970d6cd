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
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg as sla

from solidgear.core import Scene, System
from solidgear.core.scene.stations import Port
from solidgear.teeth.contact.frame import Frame, Stations, Supports
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.file.mesh_teeth import MeshTeeth
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.train import Train
from solidgear.trains.load.operation import Operating
from solidgear.trains.load.state import OperatingState, with_settled_bearings

#: model of all shafts, and sections along a face
SHAFT, SECTIONS = "timoshenko", 5
#: seat of a section, of the face
SEAT = 0.05
#: of a section among the lumped points of a scene
MARK = " face "


@dataclass(frozen=True, eq=False)
class Carried:
    """A train at rest with sections along the faces of its gears.

    Examples
    --------
    >>> import solidgear as sg
    >>> from solidgear.trains.file.mesh_teeth import wheels_of
    >>> train = sg.load_train("geometry/gearbox_train.toml")
    >>> carried = Carried.at_rest(with_sections(train), train.point)
    >>> pair = carried.train.pairs[0]
    >>> supports = carried.supports(pair, carried.frame(pair, wheels_of(pair)))
    >>> [len(stations.place) for stations in supports.stations]   # the wheel is a rigid mass
    [5, 1]
    """

    operating: Operating  #: of a train as of :func:`with_sections`
    state: OperatingState

    @classmethod
    def at_rest(cls, train: Train, point: OperatingPoint) -> Carried:
        """Settle a train of :func:`with_sections` at an operating point."""
        operating = Operating(Assembly(train), SHAFT)
        return cls(operating, operating.at(point))

    def at(self, point: OperatingPoint) -> Carried:
        """Settle the same train at another point, from this state on."""
        return Carried(self.operating, self.operating.at(point, self.state))

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

    def _held(self, pair: Pair) -> dict[str, str]:
        """Return the end at which every shaft is held against turning: where the torque of a pair
        enters or leaves it.
        """
        train, ends = self.train, {}
        for side, shaft in train.shafts.items():
            rotors = [train.spring_port(name) for name in train.rotors_of(side)]
            mates = zip(pair.shafts, pair.ports)
            further = [name for name in shaft.gears if (side, name) not in mates]
            port = [*rotors, *further, *shaft.gears, shaft.scene.port.name][0]
            ends[side] = f"{side}.{port}"
        return ends

    def _without_teeth(self, held: dict[str, str]) -> tuple[np.ndarray, np.ndarray]:
        """Return the factor of the stiffness without teeth, what is held as constraints."""
        system = self.system
        rows, places = system.strains
        bodies = np.ones(len(rows), bool)
        for name in self._teeth_links:
            bodies[places[name]] = False
        stiffness = rows[bodies].T @ rows[bodies]
        fixed = np.vstack([system.motion(end)[4] for end in held.values()])
        size = np.abs(np.diag(stiffness)).max()
        bordered = np.block(
            [[stiffness, size * fixed.T], [size * fixed, np.zeros((len(fixed), len(fixed)))]]
        )
        return sla.lu_factor(bordered)

    @property
    def _teeth_links(self) -> Iterator[str]:
        """Names of all meshes in the system."""
        for pair in self.train.pairs:
            yield pair.name

    def _motion(self, end: str, held: dict[str, str]) -> np.ndarray:
        """Return the (6,) motion of a port in the state, without the turning of its shaft, in its own
        axes.
        """
        motion = self.state.motion(end).copy()
        motion[4] -= self.state.motion(held[end.partition(".")[0]])[4]
        return motion

    def frame(self, pair: Pair, teeth: MeshTeeth) -> Frame:
        """Return the frame of a pair: the pitch point at the middle of the shared face, and axes along
        the transverse line of action and the shafts, so that contact lines run on towards larger w.
        """
        port = self.system.port(f"{pair.shafts[0]}.{pair.ports[0]}")
        vector = self.assembly.contacts[pair.name].pinion
        normal, axis = port.axes @ vector.normal, port.axes[:, 1]
        transverse = normal - (normal @ axis) * axis
        u = -transverse / np.linalg.norm(transverse)
        w = teeth.along[0] * axis
        origin = port.point + port.axes @ vector.point + teeth.middles[0] * axis
        return Frame(origin, np.column_stack([u, np.cross(w, u), w]))

    def supports(self, pair: Pair, frame: Frame) -> Supports:
        """Return what carries both wheels of a pair."""
        ends = [
            list(sections(self.train, side, port)) for side, port in zip(pair.shafts, pair.ports)
        ]
        stations = tuple(self._stations(names, frame) for names in ends)
        held = self._held(pair)
        rows, motions = [], []
        for end in (end for names in ends for end in names):
            port = self.system.port(end)
            turn = np.kron(np.eye(2), port.axes)
            rows.append(turn @ port.rows)
            motions.append(turn @ self._motion(end, held))
        loads, total = self._teeth_load(pair)
        count = 6 * len(rows)
        flexibility = _flexibility(self._without_teeth(held), np.vstack([*rows, *loads]))
        motion = np.concatenate(motions) - flexibility[:count, count:] @ total
        return Supports(frame, (stations[0], stations[1]), flexibility[:count, :count], motion)

    def _stations(self, names: list[str], frame: Frame) -> Stations:
        points = np.array([self.system.port(end).point for end in names])
        place = (points - frame.origin) @ frame.axes[:, 2]
        order = np.argsort(place)
        names[:] = [names[k] for k in order]
        return Stations(place[order], points[order])

    def _teeth_load(self, pair: Pair) -> tuple[list[np.ndarray], np.ndarray]:
        """Return the rows of both lumped points and the load of the teeth on them in the state."""
        contact, force = self.assembly.contacts[pair.name], self.state.mesh_forces[pair.name]
        vectors = contact.pinion.vector, -contact.gear.vector
        rows = [self.system.motion(f"{side}.{port}") for side, port in zip(pair.shafts, pair.ports)]
        return rows, force * np.concatenate(vectors)


def _flexibility(factor: tuple[np.ndarray, np.ndarray], rows: np.ndarray) -> np.ndarray:
    """Return the (N, N) motions of rows under unit loads on them."""
    right = np.zeros((len(factor[0]), len(rows)))
    right[: rows.shape[1]] = rows.T
    return rows @ sla.lu_solve(factor, right)[: rows.shape[1]]


def with_sections(train: Train) -> Train:
    """Return the train with lumped points along the face of every gear that is part of its shaft."""
    shafts = {}
    for side, shaft in train.shafts.items():
        scene = shaft.scene
        points: list[Port] = []
        for name, gear in shaft.gears.items():
            if gear.head is None and gear.face_width:
                points += _points(scene, name, gear.face_width)
        further = (*scene.further_ports, *points)
        shafts[side] = shaft.with_changes(scene=scene.with_changes(further_ports=further))
    return train.with_changes(shafts=shafts)


def _points(scene: Scene, name: str, face: float) -> Iterator[Port]:
    """Yield the sections along a face, on the shaft."""
    port = next(p for p in scene.ports if p.name == name)
    half = SEAT * face / 2
    low, high = max(port.y - face / 2, 0.0), min(port.y + face / 2, scene.length)
    for k, y in enumerate(np.linspace(low + half, high - half, SECTIONS)):
        # a seat lies on one segment
        segment = next(s for s in scene.segments if s.y0 <= y <= s.y1)
        seat = max(y - half, segment.y0), min(y + half, segment.y1)
        yield port.with_changes(name=f"{name}{MARK}{k}", position=y, lo=seat[0], hi=seat[1])


def sections(train: Train, side: str, port: str) -> Iterator[str]:
    """Yield the ends of the sections of a gear, or its lumped point where it is rigid."""
    names = [p.name for p in train.shafts[side].scene.ports if p.name.startswith(f"{port}{MARK}")]
    for name in names or [port]:
        yield f"{side}.{name}"
