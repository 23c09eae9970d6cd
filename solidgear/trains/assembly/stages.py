"""Planetary stages of a train as parts and links of a system: planets, and an elastically supported
ring, as rigid bodies between the shafts of sun and carrier.

A stage is described in axes in which the sun drives about +y: those of the sun's scene, or these
turned by half a turn about x.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from solidgear.core import Scene, System
from solidgear.core.reduction.superelement import PortMotion
from solidgear.core.solve.families import FAMILIES
from solidgear.core.system.links import BearingSpring, Link, RowSpring
from solidgear.core.system.parts import Part, Placed
from solidgear.trains.assembly.housing import ring_port
from solidgear.trains.assembly.layout import Place, sun_ways
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import MATES, PlanetMesh, Stage
from solidgear.trains.file.train import Train
from solidgear.trains.load.contact import Contact
from solidgear.trains.system.planetary import PlanetaryStage
from solidgear.trains.system.planetary_members import CentralMember, Planet, weights
from solidgear.trains.system.planetary_modes import IN_PLANE, NAMES, OUT_OF_PLANE, patterns

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
        """Axes (3, 3) of the stage as columns, in those of the sun's scene."""
        return np.diag([1.0, self.way, self.way])

    @cached_property
    def model(self) -> PlanetaryStage:
        """The stage alone; sun and carrier are there for their places."""
        table, teeth = self.stage.table, self.stage.teeth
        sun, planet, ring = teeth.base_radii
        planet_table, stage = table.planet, self.stage
        assert planet_table.pin is not None
        planets = tuple(
            Planet(
                planet_table.mass,
                planet_table.torsional,
                planet,
                np.diag(planet_table.pin.diagonal),
                stage.stiffness("sun"),
                stage.stiffness("ring"),
                self.way * (azimuth + table.position),
                planet_table.bending,
            )
            for azimuth in teeth.azimuths
        )
        ring_member = CentralMember(1.0, ring**2, ring, np.eye(6) * FIXED, diametral=ring**2)
        if table.ring is not None:
            ring_table, springs = table.ring, np.diag(table.ring.support.diagonal)
            ring_member = CentralMember(
                ring_table.mass, ring_table.torsional, ring, springs, diametral=ring_table.bending
            )
        pins = teeth.pin_radius
        return PlanetaryStage(
            CentralMember(1.0, sun**2, sun, diametral=sun**2),
            ring_member,
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
        """Name of the ring as a part; None for a fixed one."""
        return None if self.stage.table.ring is None else f"{self.stage.called} ring"

    @property
    def bodies(self) -> list[str]:
        """Names of all parts of the stage in the system of the train."""
        return [*self.planets.values(), *([] if self.ring is None else [self.ring])]

    def parts(self, turn: np.ndarray, origin: np.ndarray) -> dict[str, Part]:
        """Return planets and a supported ring, with the sun's scene at a place of the train."""
        names = self.planets | ({} if self.ring is None else {"ring": self.ring})
        centre = origin + turn @ [0.0, self.y, 0.0]
        return {
            name: Placed(self.model.parts[member], turn @ self.axes, centre)
            for member, name in names.items()
        }

    @cached_property
    def links(self) -> dict[str, Link]:
        """Pins such as ``stage pin 1``, meshes such as ``mesh stage sun 1``, and the support of the
        ring.
        """
        stage = self.stage

        def port(member: str, planet: str) -> tuple[str, PortMotion] | None:
            if member == "ring":
                ring_motion = PortMotion(np.eye(6), np.zeros(3), np.eye(3))
                return self.holds if self.ring is None else (f"{self.ring}.centre", ring_motion)
            motion = PortMotion(np.eye(6), np.zeros(3), self.axes.T)
            return self.ends[member == "carrier"], motion

        links: dict[str, Link] = {}
        joints = self.model.joints(port, f"{stage.called} ")
        for k, name in enumerate(self.planets.values(), 1):
            links[f"{stage.called} pin {k}"] = joints[f"{name} pin"]
            for mate in MATES:
                links[f"{stage.name} {mate} {k}"] = joints[f"{name} {mate} mesh"]
        if self.ring is not None:
            support = self.model.ring.support
            to = self.holds and self.holds[0]
            links[f"{stage.called} ring support"] = BearingSpring(
                f"{self.ring}.centre", support, to
            )
        return links

    def kinetic(self, system: System, shapes: np.ndarray) -> dict[str, np.ndarray]:
        """Return twice the kinetic energy (k,) of planets by their joint motions, named as in
        `solidgear.trains.system.planetary_modes`, and of a supported ring by motion.
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
            pattern_energy = np.einsum("pq,pik->qik", pattern, moved) ** 2
            for word, rows_of_word in zip(words, (IN_PLANE, OUT_OF_PLANE)):
                out[f"{called} {word}"] = pattern_energy[:, rows_of_word].sum(axis=(0, 1))
        if self.ring is not None:
            energy = weights(self.model.ring)[:, None] * (
                system.motion(f"{self.ring}.centre") @ shapes
            ) ** 2  # fmt: skip
            for family, rows in FAMILIES.items():
                out[f"{self.ring} {family}"] = energy[list(rows)].sum(axis=0)
        return out

    def strained(self, energy: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        """Return shares of the strain energy with those of all planets added up: ``stage pins``,
        ``mesh stage sun``, ``mesh stage ring``.
        """
        suffixes = {f"{self.stage.called} pin": "s"} | {f"{self.stage.name} {m}": "" for m in MATES}
        shares = dict(energy)
        for name, suffix in suffixes.items():
            planet_shares = [
                shares.pop(f"{name} {k}") for k in range(1, len(self.model.planets) + 1)
            ]
            shares[name + suffix] = np.sum(planet_shares, axis=0)
        return shares


def mesh_row(system: System, name: str) -> tuple[np.ndarray, float]:
    """Return the row (N,) that gives the stretch of a mesh, m, the mean over the face, and the
    stiffness, N/m.
    """
    rows, stiffness = mesh_rows(system, name)
    return rows.mean(axis=0), len(rows) * stiffness


def mesh_rows(system: System, name: str) -> tuple[np.ndarray, float]:
    """Return the (s, N) stretches of the springs that a mesh is, and the stiffness of each, N/m."""
    spring = system.links[name]
    assert isinstance(spring, RowSpring)
    return spring.stretch(*map(system.port, spring.ends)), spring.stiffness


def with_mesh_stiffness(system: System, stiffness: Mapping[str, float]) -> System:
    """Return a system with the stiffness of some meshes, N/m, by name."""
    links = dict(system.links)
    for name, value in stiffness.items():
        spring = links[name]
        assert isinstance(spring, RowSpring)
        links[name] = replace(
            spring, stiffness=spring.stiffness * value / mesh_row(system, name)[1]
        )
    return System(system.parts, links)


def phases_of(mesh: Pair | PlanetMesh, stages: Mapping[str, StageAtWork]) -> dict[str, float]:
    """Return the meshes whose errors drive, each with the angle by which it is behind the first,
    rad.
    """
    if isinstance(mesh, Pair):
        return {mesh.name: 0.0}
    return mesh.phases(stages[mesh.stage.name].turns)


def stages_at_work(
    train: Train,
    mesh_contacts: Mapping[str, Contact],
    scenes: Mapping[str, Scene],
    places: Mapping[str, Place],
    coast: bool | None = None,
) -> dict[str, StageAtWork]:
    """Return the planetary stages of a train by name, on the flanks of the contacts."""
    ways = sun_ways(train, mesh_contacts, coast)
    by_name = {}
    for stage in train.stages:
        ports = scenes[stage.shafts[0]].ports
        y = next(port.y for port in ports if port.name == stage.ports[0])
        way, turns = ways[stage.name]
        at_work = StageAtWork(stage, way, turns, y)
        if (ring_seat := ring_port(train, stage)) is not None:
            end, point = ring_seat
            turn, origin = places[stage.shafts[0]]
            axes, centre = turn @ at_work.axes, origin + turn @ [0.0, y, 0.0]
            holds = end, PortMotion(np.eye(6), axes.T @ (point - centre), axes.T)
            at_work = replace(at_work, holds=holds)
        by_name[stage.name] = at_work
    return by_name
