"""Planetary stages of a train as parts and links of its system: planets, and a ring that gives way,
as rigid bodies between the shafts of sun and carrier.

A stage is told in axes in which its sun drives about +y: those of the sun's scene, or these turned
by half a turn about x.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from solidgear.reduction.superelement import PortMotion
from solidgear.scene import Scene
from solidgear.scene.gears import Pair
from solidgear.scene.planetary import MATES, PlanetMesh, Stage
from solidgear.scene.train import Train
from solidgear.solve.families import FAMILIES
from solidgear.studies.train.contact import Contact
from solidgear.studies.train.housing import ring_in
from solidgear.studies.train.layout import Place, sun_ways
from solidgear.system.links import BearingSpring, Link, RowSpring
from solidgear.system.parts import Part, Placed
from solidgear.system.planetary import PlanetaryStage
from solidgear.system.planetary_members import CentralMember, Planet, weights
from solidgear.system.planetary_modes import IN_PLANE, NAMES, OUT_OF_PLANE, patterns
from solidgear.system.system import System

#: N/m and N m/rad, of a ring that is part of the ground
FIXED = 1e20


@dataclass(frozen=True, eq=False)
class StageAtWork:
    """A planetary stage of a train, on the flanks that carry."""

    stage: Stage
    #: way, turns: 1 where the sun drives, and turns, about +y of its scene, else -1; a sun that is
    #: driven turns against its torque on the planets
    way: float
    turns: float
    y: float  #: of the middle of the sun in its scene, m
    #: end that holds the ring, and its port in the axes of the stage; ground without it
    holds: tuple[str, PortMotion] | None = None

    @property
    def axes(self) -> np.ndarray:
        """(3, 3) axes of the stage as columns, in those of the sun's scene."""
        return np.diag([1.0, self.way, self.way])

    @cached_property
    def model(self) -> PlanetaryStage:
        """The stage by itself; sun and carrier are there for their places alone."""
        table, teeth = self.stage.table, self.stage.teeth
        sun, planet, ring = teeth.base_radii
        own, mesh = table.planet, table.mesh
        assert own.pin is not None
        planets = tuple(
            Planet(
                own.mass,
                own.torsional,
                planet,
                np.diag(own.pin.diagonal),
                mesh.sun_stiffness,
                mesh.ring_stiffness,
                self.way * (azimuth + table.position),
                own.bending,
            )
            for azimuth in teeth.azimuths
        )
        held = CentralMember(1.0, ring**2, ring, np.eye(6) * FIXED, diametral=ring**2)
        if table.ring is not None:
            one, springs = table.ring, np.diag(table.ring.support.diagonal)
            held = CentralMember(one.mass, one.torsional, ring, springs, diametral=one.bending)
        pins = teeth.pin_radius
        return PlanetaryStage(
            CentralMember(1.0, sun**2, sun, diametral=sun**2),
            held,
            CentralMember(1.0, pins**2, pins, diametral=pins**2),
            planets,
            teeth.pressure_angle,
            teeth.base_helix,
            self.stage.sun.face_width or 0.0,
        )

    @property
    def planets(self) -> dict[str, str]:
        """Names of parts in the system of the train, by those of the planets in the model."""
        names = [f"planet {k}" for k in range(1, len(self.model.planets) + 1)]
        return {name: f"{self.stage.called} {name}" for name in names}

    @property
    def ends(self) -> tuple[str, str]:
        """Ports of sun and carrier in the system of the train."""
        sun, carrier = zip(self.stage.shafts, self.stage.ports)
        return ".".join(sun), ".".join(carrier)

    @property
    def ring(self) -> str | None:
        """Name of the part that the ring is; None of a fixed one."""
        return None if self.stage.table.ring is None else f"{self.stage.called} ring"

    @property
    def bodies(self) -> list[str]:
        """Names of all its parts in the system of the train."""
        return [*self.planets.values(), *([] if self.ring is None else [self.ring])]

    def parts(self, turn: np.ndarray, origin: np.ndarray) -> dict[str, Part]:
        """Planets, and the ring that gives way, with the sun's scene at a place of the train."""
        named = self.planets | ({} if self.ring is None else {"ring": self.ring})
        at = origin + turn @ [0.0, self.y, 0.0]
        return {
            name: Placed(self.model.parts[own], turn @ self.axes, at) for own, name in named.items()
        }

    @cached_property
    def links(self) -> dict[str, Link]:
        """Pins, ``stage pin 1``, meshes, ``mesh stage sun 1``, and what holds the ring."""
        stage = self.stage

        def port(member: str, planet: str) -> tuple[str, PortMotion] | None:
            if member == "ring":
                whole = PortMotion(np.eye(6), np.zeros(3), np.eye(3))
                return self.holds if self.ring is None else (f"{self.ring}.centre", whole)
            here = PortMotion(np.eye(6), np.zeros(3), self.axes.T)
            return self.ends[member == "carrier"], here

        out: dict[str, Link] = {}
        joints = self.model.joints(port, f"{stage.called} ")
        for k, name in enumerate(self.planets.values(), 1):
            out[f"{stage.called} pin {k}"] = joints[f"{name} pin"]
            for mate in MATES:
                out[f"{stage.name} {mate} {k}"] = joints[f"{name} {mate} mesh"]
        if self.ring is not None:
            support = self.model.ring.support
            to = self.holds and self.holds[0]
            out[f"{stage.called} ring support"] = BearingSpring(f"{self.ring}.centre", support, to)
        return out

    def kinetic(self, system: System, shapes: np.ndarray) -> dict[str, np.ndarray]:
        """Twice the kinetic energy (k,) of planets by what they do together, in the words of
        `solidgear.system.planetary_modes`, and of a ring that gives way by its motions.
        """
        out: dict[str, np.ndarray] = {}
        planets, called = self.model.planets, self.stage.called
        moved = np.array(
            [
                np.sqrt(weights(planet))[:, None] * (system.motion(f"{name}.centre") @ shapes)
                for name, planet in zip(self.planets.values(), planets)
            ]
        )
        for words, pattern in zip(NAMES, patterns([planet.azimuth for planet in planets])):
            seen = np.einsum("pq,pik->qik", pattern, moved) ** 2
            for word, own in zip(words, (IN_PLANE, OUT_OF_PLANE)):
                out[f"{called} {word}"] = seen[:, own].sum(axis=(0, 1))
        if self.ring is not None:
            energy = weights(self.model.ring)[:, None] * (
                system.motion(f"{self.ring}.centre") @ shapes
            ) ** 2  # fmt: skip
            for family, rows in FAMILIES.items():
                out[f"{self.ring} {family}"] = energy[list(rows)].sum(axis=0)
        return out

    def strained(self, energy: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        """Shares of the strain energy with those of all planets added up: ``stage pins``, ``mesh
        stage sun``, ``mesh stage ring``.
        """
        own = {f"{self.stage.called} pin": "s"} | {f"{self.stage.name} {m}": "" for m in MATES}
        out = dict(energy)
        for name, more in own.items():
            every = [out.pop(f"{name} {k}") for k in range(1, len(self.model.planets) + 1)]
            out[name + more] = np.sum(every, axis=0)
        return out


def mesh_row(system: System, name: str) -> tuple[np.ndarray, float]:
    """Row (N,) that gives the stretch of a mesh by its name, m, the mean over its face, and its
    stiffness, N/m.
    """
    spring = system.links[name]
    assert isinstance(spring, RowSpring)
    rows = spring.stretch(*map(system.port, spring.ends))
    return rows.mean(axis=0), len(rows) * spring.stiffness


def phases_of(driver: Pair | PlanetMesh, stages: Mapping[str, StageAtWork]) -> dict[str, float]:
    """Meshes whose errors drive, each with the angle by which it is behind the first, rad."""
    if isinstance(driver, Pair):
        return {driver.name: 0.0}
    return driver.phases(stages[driver.stage.name].turns)


def stages_at_work(
    train: Train,
    found: Mapping[str, Contact],
    scenes: Mapping[str, Scene],
    places: Mapping[str, Place],
    coast: bool | None = None,
) -> dict[str, StageAtWork]:
    """Planetary stages of a train by name, on the flanks that its contacts are those of."""
    ways = sun_ways(train, found, coast)
    out = {}
    for stage in train.stages:
        ports = scenes[stage.shafts[0]].ports
        y = next(port.y for port in ports if port.name == stage.ports[0])
        own = StageAtWork(stage, *ways[stage.name], y)
        if (held := ring_in(train, stage)) is not None:
            end, point = held
            turn, origin = places[stage.shafts[0]]
            axes, at = turn @ own.axes, origin + turn @ [0.0, y, 0.0]
            holds = end, PortMotion(np.eye(6), axes.T @ (point - at), axes.T)
            own = replace(own, holds=holds)
        out[stage.name] = own
    return out
