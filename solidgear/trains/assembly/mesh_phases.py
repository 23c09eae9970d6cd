r"""Where every mesh stands in its cycle while another one begins its own, by places and numbers of teeth.

The phase p of a mesh counts pitches since a flank that carries passed the pitch point at the middle of
the shared face, towards the tip of the first gear (:mod:`solidgear.core.gears.wheel_pair`).  A gear of z
teeth with the middle of a tooth at the angle gamma about y of its scene has its carrying flank at
``gamma - t h``, with the sign t of the torque of the teeth on it and half the tooth's angle h where
the wheels roll; with the mate at the azimuth psi

    p = -t (gamma - t h - psi) z / 2 pi   of the first gear,    p = t (gamma - t h - psi) z / 2 pi   of the
    second,

so that a mesh passes the angle from gear to gear, an idler or a planet hands it on to its next mesh, and
a shaft from one of its gears to another where the file gives the angle of both.  Which tooth meets which
is not known: the mate may stand any number of its pitches further.  Order n of a mesh is in step with
order m of another all the same where m such steps are whole cycles, as they are across one shaft.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from math import pi, sin, tan

import numpy as np

from solidgear.core import SceneError
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.layout import senses, torque_on
from solidgear.trains.file.gears import FLANKS
from solidgear.trains.file.mesh_teeth import MeshTeeth, wheels_of
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import PlanetMesh

#: axes whose angle has a sine below this are parallel
PARALLEL = 1e-6


@dataclass(frozen=True)
class MeshPhase:
    """Phase of a mesh at the moment at which the reference begins its cycle."""

    pitches: float
    #: pitches by which it may stand elsewhere, with other teeth in mesh, each any number of times
    freedom: tuple[float, ...]
    way: int  #: 1 where the phase grows in time, for the first gear drives; else -1


@dataclass(frozen=True)
class _Flank:
    """Carrying flank of a gear in a mesh."""

    gear: str  #: ``shaft.port``, or a planet
    teeth: int
    torque: int  #: sign of that of the teeth about y
    azimuth: float  #: of the mate about y from x, rad
    half: float  #: half the angle of a tooth where wheels roll, rad
    twist: float  #: of a tooth from the lumped point to the middle of the shared face, rad

    def phase(self, gamma: float, number: int) -> float:
        """Return the phase with a tooth at an angle; number 0 is the first gear."""
        way = self.torque * (2 * number - 1)
        return way * (gamma + self._ahead) * self.teeth / (2 * pi)

    def angle(self, phase: float, number: int) -> float:
        """Return the angle of a tooth at a phase."""
        way = self.torque * (2 * number - 1)
        return way * phase * 2 * pi / self.teeth - self._ahead

    @property
    def _ahead(self) -> float:
        """Angle of the flank from the pitch point while that of the tooth is zero, rad."""
        return self.twist - self.torque * self.half - self.azimuth


@dataclass(frozen=True)
class _Stand:
    """Angle of a gear's tooth, and the turns by which it may stand elsewhere."""

    angle: float
    freedom: tuple[float, ...]


@dataclass(frozen=True, eq=False)
class MeshPhases:
    """Phases of the meshes of a train that places and numbers of teeth tie to that of one of them."""

    assembly: Assembly
    reference: str  #: name of a mesh of a pair or of one planet

    @cached_property
    def by_mesh(self) -> dict[str, MeshPhase]:
        """Phases by mesh, that of the reference 0."""
        by_gear: dict[str, list[str]] = {}
        for name, flanks in self._flanks.items():
            for flank in flanks:
                by_gear.setdefault(flank.gear, []).append(name)
        if self.reference not in self._flanks:
            return {}
        first = self._flanks[self.reference][0]
        stands = {first.gear: _Stand(first.angle(0.0, 0), ())}
        phases: dict[str, MeshPhase] = {}
        queue = [first.gear]
        while queue:
            gear = queue.pop(0)
            for name in by_gear.get(gear, ()):
                if name not in phases:
                    phases[name] = self._phase(name, gear, stands[gear])
                for end, stand in self._across(name, gear, stands[gear]):
                    if end not in stands:
                        stands[end] = stand
                        queue.append(end)
            for end, stand in self._along(gear, stands[gear]):
                if end not in stands:
                    stands[end] = stand
                    queue.append(end)
        return phases

    def _phase(self, name: str, gear: str, stand: _Stand) -> MeshPhase:
        number = [flank.gear for flank in self._flanks[name]].index(gear)
        flank = self._flanks[name][number]
        freedom = tuple(turns * flank.teeth for turns in stand.freedom)
        return MeshPhase(flank.phase(stand.angle, number) % 1.0, freedom, self._ways[name])

    def _across(self, name: str, gear: str, stand: _Stand) -> Iterator[tuple[str, _Stand]]:
        """Yield the mate of a gear in a mesh, and how it stands."""
        flanks = self._flanks[name]
        number = [flank.gear for flank in flanks].index(gear)
        if len(flanks) < 2:
            return
        flank, mate = flanks[number], flanks[1 - number]
        angle = mate.angle(flank.phase(stand.angle, number), 1 - number)
        passed = tuple(turns * flank.teeth / mate.teeth for turns in stand.freedom)
        yield mate.gear, _Stand(angle, (*passed, 1 / mate.teeth))

    def _along(self, end: str, stand: _Stand) -> Iterator[tuple[str, _Stand]]:
        """Yield the other gears of a shaft whose angles the file gives, and how they stand."""
        side, _, port = end.partition(".")
        shaft = self.assembly.train.shafts.get(side)
        start = None if shaft is None else shaft.gears[port].angle
        if shaft is None or start is None:
            return
        for name, gear in shaft.gears.items():
            if name != port and gear.angle is not None:
                angle = stand.angle + gear.angle - start
                yield f"{side}.{name}", _Stand(angle, stand.freedom)

    @cached_property
    def _flanks(self) -> dict[str, list[_Flank]]:
        """Carrying flanks of the first and the second gear of every mesh of parallel axes; of a mesh
        with a ring those of the planet alone.
        """
        train, flanks = self.assembly.train, {}
        for pair in train.pairs:
            if abs(sin(pair.mesh.shaft_angle)) < PARALLEL:
                flanks[pair.name] = self._of_pair(pair)
        for stage in train.stages:
            for mesh in stage.meshes:
                flanks[mesh.name] = self._of_planet(mesh)
        return flanks

    def _of_pair(self, pair: Pair) -> list[_Flank]:
        assembly, teeth = self.assembly, _teeth(pair)
        flanks = []
        for k, (side, port) in enumerate(zip(pair.shafts, pair.ports)):
            gear = (pair.pinion, pair.gear)[k]
            torque = int(np.sign(torque_on(pair, side, assembly.contacts)))
            half, twist = _half(teeth, k, gear.teeth), _twist(teeth, k, gear.hand)
            azimuth = self._azimuth(pair, k)
            flanks.append(_Flank(f"{side}.{port}", gear.teeth, torque, azimuth, half, twist))
        return flanks

    def _azimuth(self, pair: Pair, k: int) -> float:
        """Return the azimuth of the mate's axis, in the scene of the first or the second gear."""
        points = []
        for side, port in zip(pair.shafts, pair.ports):
            turn, origin = self.assembly.places[side]
            y = next(p.y for p in self.assembly.scenes[side].ports if p.name == port)
            points.append(origin + turn @ [0.0, y, 0.0])
        axes, _ = self.assembly.places[pair.shafts[k]]
        x, _, z = axes.T @ (points[1 - k] - points[k])
        return float(np.arctan2(-z, x))

    def _of_planet(self, mesh: PlanetMesh) -> list[_Flank]:
        stage, (number,), teeth = mesh.stage, mesh.planets, _teeth(mesh)
        way = int(self.assembly.stages[stage.name].way)
        azimuth = stage.teeth.azimuths[number - 1] + stage.table.position
        name, count, sun = f"{stage.called} planet {number}", stage.table.planet.teeth, stage.sun
        hand = None if sun.hand is None else FLANKS[sun.hand == "left"]
        planet = int(mesh.mate == "sun")  # the second gear there, the first of a mesh with a ring
        half, twist = _half(teeth, planet, count), _twist(teeth, planet, hand)
        if mesh.mate == "ring":
            return [_Flank(name, count, way, azimuth, half, twist)]
        sun_end, sun_half = ".".join((stage.shafts[0], stage.ports[0])), _half(teeth, 0, sun.teeth)
        return [
            _Flank(sun_end, sun.teeth, -way, azimuth, sun_half, _twist(teeth, 0, sun.hand)),
            _Flank(name, count, -way, azimuth + pi, half, twist),
        ]

    @cached_property
    def _ways(self) -> dict[str, int]:
        """1 for every mesh whose first gear drives, else -1."""
        train, contacts = self.assembly.train, self.assembly.contacts
        turning = {
            side: 1 if sense == "+y" else -1 for side, sense in senses(train, contacts).items()
        }
        ways = {}
        for pair in train.pairs:
            side = pair.shafts[0]
            ways[pair.name] = -int(np.sign(torque_on(pair, side, contacts))) * turning[side]
        for stage in train.stages:
            at_work = self.assembly.stages[stage.name]
            ways |= {mesh.name: int(at_work.way * at_work.turns) for mesh in stage.meshes}
        return ways


def _teeth(mesh: Pair | PlanetMesh) -> MeshTeeth | None:
    """Return the wheels of a mesh; None where the file does not give them."""
    try:
        teeth = wheels_of(mesh)
        _ = teeth and teeth.wheels.distance
    except SceneError:
        return None
    return teeth


def _half(teeth: MeshTeeth | None, k: int, count: int) -> float:
    """Return half the angle of a tooth where wheels roll, a quarter of the pitch by default, rad."""
    if teeth is None:
        return pi / (2 * count)
    wheels = teeth.wheels
    wheel = (wheels.first, wheels.second)[k]
    return float(wheel.half_angle(wheel.base / np.cos(wheels.working_angle)))


def _twist(teeth: MeshTeeth | None, k: int, hand: str | None) -> float:
    """Return the angle by which teeth stand further at the middle of the shared face than at the lumped
    point, rad.
    """
    if teeth is None or hand is None:
        return 0.0
    wheel = (teeth.wheels.first, teeth.wheels.second)[k]
    per_length = tan(wheel.helix_angle) / wheel.radius
    return (1 if hand == "right" else -1) * per_length * teeth.middles[k]
