"""Planetary stages of a train, between the shaft of the sun and that of the carrier: data only.

Azimuths are those of the sun's scene: right-handed about y from x.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import atan, cos, tan
from typing import Annotated, ClassVar

from pydantic import Field, model_validator

from solidgear.core import Model, SceneError
from solidgear.core.scene.planetary_teeth import PlanetaryTeeth
from solidgear.core.scene.stations import Status
from solidgear.core.scene.units import MeshSpring, PressureAngle, TorsionSpring
from solidgear.trains.file.flanks import Flanks
from solidgear.trains.file.gears import HeadInertia, Member, Shaft, Teeth
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.tables import Azimuth, Error, ErrorTable, MeshStiffness, solved

MATES = ("sun", "ring")
MOST_PLANETS = 20


class Seat(Model):
    """Springs on which a body turns freely: pin and bearing of a planet."""

    #: radial stiffness, N/m
    radial: MeshSpring
    #: axial stiffness, N/m
    axial: MeshSpring
    #: tilting stiffness, N m/rad
    tilting: TorsionSpring

    @property
    def diagonal(self) -> list[float]:
        """Stiffness on x y z thx thy thz."""
        return [self.radial, self.axial, self.radial, self.tilting, 0.0, self.tilting]


class HeldSeat(Seat):
    """Springs that also hold a body against turning, with torsional stiffness in N m/rad."""

    #: torsional stiffness, N m/rad
    turning: TorsionSpring

    @property
    def diagonal(self) -> list[float]:
        """Stiffness on x y z thx thy thz."""
        stiffness = super().diagonal
        stiffness[4] = self.turning
        return stiffness


class PlanetTable(HeadInertia, Flanks):
    """A planet, rigid; all are alike."""

    needs: ClassVar = (("pin",),)

    #: number of teeth of a planet
    teeth: Teeth
    #: stiffness of pin and planet bearing, between planet and carrier
    pin: Seat | None = None

    @model_validator(mode="after")
    def _on_a_pin(self) -> PlanetTable:
        if self.pin is None:
            reason = "planets have no pins: give radial, axial and tilting stiffness of pin and"
            raise SceneError(f"{reason} planet bearing", path=("pin",))
        return self


class RingTable(HeadInertia):
    """A ring that is no part of the ground, rigid, on springs that keep it from turning."""

    #: springs that hold the ring
    support: HeldSeat


class PlanetMeshes(Model):
    """Meshes of every planet with sun and ring."""

    #: stiffness of the mesh of each planet with the sun, N/m, or `teeth`
    sun_stiffness: MeshStiffness
    #: stiffness of the mesh of each planet with the ring, N/m, or `teeth`
    ring_stiffness: MeshStiffness
    #: angle normal to the tooth, at the reference cylinder, rad
    pressure_angle: PressureAngle
    #: amplitude of the transmission error of each mesh, m, or a table of orders or over frequency;
    #: needed where it drives a motion
    transmission_error: Error = None
    #: transmission error of the meshes with the sun, in place of that of each
    sun_error: Error = None
    #: transmission error of the meshes with the ring, in place of that of each
    ring_error: Error = None
    #: source of these numbers
    status: Status = "assumed"


class Planetary(Model):
    """A planetary stage as a file describes it."""

    needs: ClassVar = (("planets", "angles"),)

    #: gear of a shaft, as in `between` of a mesh; its module, helix angle and face width are those
    #: of the stage
    sun: str
    #: shaft that carries the pins rigidly, at its main lumped point or at the one after a dot
    carrier: str
    #: number of teeth of the ring
    ring_teeth: Teeth
    #: turns of the sun in one of the carrier, where a source gives it
    ratio: Annotated[float, Field(gt=0)] | None = None
    #: number of planets at equal angles, unless `angles` are given
    planets: Annotated[int, Field(strict=True, ge=1, le=MOST_PLANETS)] | None = None
    #: angle of every planet, rad
    angles: Annotated[tuple[Azimuth, ...], Field(max_length=MOST_PLANETS)] = ()
    #: angle of the carrier, which planets are turned by, rad
    position: Azimuth = 0.0
    #: teeth, mass and pin of a planet; all are alike
    planet: PlanetTable
    #: meshes of every planet with sun and ring
    mesh: PlanetMeshes
    #: a ring that gives way; without it the ring is fixed
    ring: RingTable | None = None
    #: teeth of the ring, with offsets along the sun's shaft
    ring_flanks: Flanks | None = None

    @model_validator(mode="after")
    def _so_many(self) -> Planetary:
        if (self.planets is None) == (not self.angles):
            reason = "give either planets, how many at equal angles, or the angles of all of them"
            raise SceneError(reason, path=("planets",))
        return self


@dataclass(frozen=True)
class PlanetMesh:
    """Mesh of planets with sun or ring, with the interface of a `Pair`."""

    #: ``mesh stage sun`` of all planets of the stage of that name, ``mesh stage sun 1`` of the
    #: first
    name: str
    stage: Stage
    mate: str
    planets: tuple[int, ...]  #: counted from 1

    @property
    def mesh(self) -> PlanetMeshes:
        """Table of the teeth."""
        return self.stage.table.mesh

    @property
    def error(self) -> ErrorTable | None:
        """Transmission error of each planet's mesh; None where the file gives none."""
        own_error = getattr(self.mesh, f"{self.mate}_error")
        return own_error if own_error is not None else self.mesh.transmission_error

    @property
    def stiffness(self) -> float:
        """Stiffness of each planet's mesh, N/m."""
        return self.stage.stiffness(self.mate)

    def phases(self, way: float) -> dict[str, float]:
        """Return the phase lag of the error at each planet behind the first, rad, by name of the mesh;
        `way` is 1 where the sun turns about +y of its scene, else -1.

        Teeth of the sun reach a planet at the azimuth psi later by ``z_s psi``, and of the ring, for
        planets assemble, by as much (Parker, Journal of Sound and Vibration 236, 2000, p. 561-573).
        """
        teeth, name = self.stage.teeth, f"{self.stage.name} {self.mate}"
        angles = {k: way * teeth.sun * teeth.azimuths[k - 1] for k in self.planets}
        return {f"{name} {k}": angles[k] - angles[self.planets[0]] for k in self.planets}

    @property
    def label(self) -> str:
        """Name in the middle of a phrase."""
        return self.name.removeprefix("mesh")


@dataclass(frozen=True)
class Stage:
    """A planetary stage between two shafts, that of the sun and that of the carrier."""

    called: str
    shafts: tuple[str, str]
    ports: tuple[str, str]
    sun: Member
    table: Planetary

    @property
    def name(self) -> str:
        """Name of all meshes of the stage together."""
        return f"mesh {self.called}"

    def stiffness(self, mate: str) -> float:
        """Return the stiffness of each planet's mesh with sun or ring, N/m."""
        return solved(getattr(self.table.mesh, f"{mate}_stiffness"))

    @property
    def ring_point(self) -> str:
        """Point of an elastic housing that holds the ring."""
        return f"{self.called}.ring"

    @cached_property
    def teeth(self) -> PlanetaryTeeth:
        """Transverse teeth; refuses teeth that do not fit, overlapping planets, another ratio."""
        assert self.sun.module is not None
        table, helix = self.table, self.sun.helix_angle or 0.0
        return PlanetaryTeeth(
            sun=self.sun.teeth,
            planet=table.planet.teeth,
            ring=table.ring_teeth,
            module=self.sun.module / cos(helix),
            planets=table.planets or table.angles,
            pressure_angle=atan(tan(table.mesh.pressure_angle) / cos(helix)),
            ratio=table.ratio,
            helix=-helix if self.sun.hand == "left" else helix,
        )

    @property
    def ratio(self) -> float:
        """Turns of the first shaft in one of the second: of the sun in one of the carrier."""
        return self.teeth.speed_ratio

    @property
    def levers(self) -> tuple[float, float]:
        """Torques about +y on sun and carrier, N m, for 1 N in the mesh of every planet with the sun
        while this drives about +y.
        """
        sun = len(self.teeth.azimuths) * self.teeth.base_radii[0] * cos(self.teeth.base_helix)
        return -sun, sun * self.ratio

    @cached_property
    def meshes(self) -> tuple[PlanetMesh, ...]:
        """Meshes of each planet with the sun, then those with the ring."""
        return tuple(
            PlanetMesh(f"{mesh.name} {k}", self, mesh.mate, (k,))
            for mesh in self.together
            for k in mesh.planets
        )

    @property
    def together(self) -> tuple[PlanetMesh, ...]:
        """Meshes of all planets together with the sun, and with the ring."""
        planets = tuple(range(1, len(self.teeth.azimuths) + 1))
        return tuple(PlanetMesh(f"{self.name} {mate}", self, mate, planets) for mate in MATES)


def stage_of(name: str, table: Planetary, shafts: Mapping[str, Shaft]) -> Stage:
    """Return a planetary stage on the shafts of a train."""
    sun, _, port = table.sun.partition(".")
    carrier, _, flange = table.carrier.partition(".")
    flange = flange or shafts[carrier].scene.port.name
    port = port or next(iter(shafts[sun].gears))
    return Stage(name, (sun, carrier), (port, flange), shafts[sun].member(port), table)


def error_of(driver: Pair | PlanetMesh) -> ErrorTable:
    """Return the transmission error of a mesh that drives a motion; refuse a mesh without one."""
    if (error := driver.error) is not None:
        return error
    table: tuple
    if isinstance(driver, PlanetMesh):
        table = ("planetary", driver.stage.called, "mesh")
    else:
        table = driver.paths["mesh"]
    raise SceneError(
        'this key is missing, and it is what drives the teeth; write transmission_error = "1 um", or '
        "orders or a table over frequency",
        path=(*table, "transmission_error"),
    )
