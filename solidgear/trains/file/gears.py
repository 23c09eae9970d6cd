"""Gears, the shafts that carry them, and the pairs that mesh: data only."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import isclose, pi
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from solidgear.core import Model, PositiveLength, Scene, SceneError, listed, nearest
from solidgear.core.scene.stations import Status
from solidgear.core.scene.units import TYPED, Inertia, Mass, PitchAngle, SpiralAngle
from solidgear.trains.file.cylindrical import cylindrical_problems, rolling_fields
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.tables import Mesh
from solidgear.trains.file.tooth_fit import fit_problems

#: relative, of inertias: the last of three digits
ROUNDED = 5e-3
#: teeth that a wheel may have
FEWEST_TEETH, MOST_TEETH = 3, 2000

Teeth = Annotated[int, Field(strict=True, ge=FEWEST_TEETH, le=MOST_TEETH)]
#: of cylindrical gears (ISO 21771)
FLANKS = ("left", "right")


class HeadInertia(Model):
    """A rigid body of revolution at the lumped point of a shaft, added to the mass of the segments."""

    mass: Mass  #: kg
    #: torsional, bending: about the shaft and across it, at the lumped point, kg m^2
    torsional: Inertia
    bending: Inertia
    status: Status = "assumed"

    @model_validator(mode="after")
    def _possible(self) -> Self:
        if self.bending < (1 - ROUNDED) * self.torsional / 2:
            raise SceneError(
                f"is less than half of torsional, {self.torsional:g} kg m^2, which is impossible",
                path=("bending",),
            )
        return self


class Gear(Model):
    """The teeth of one gear of a shaft."""

    teeth: Teeth
    hand: Literal["left", "right"] | None = None
    #: of parallel shafts also the left or right flank: as seen from the side of the apex (the start
    #: of the shaft unless ``apex`` says otherwise), a tooth with its tip upwards (ISO 21771)
    loaded_side: Literal["concave", "convex", "left", "right"] | None = None
    #: pitch_radius, face_width: at the heel and along the cone, m
    pitch_radius: PositiveLength | None = None
    face_width: PositiveLength | None = None
    #: pitch_angle, spiral_angle: rad
    pitch_angle: PitchAngle | None = None
    spiral_angle: SpiralAngle | None = None
    #: module, helix_angle: of cylindrical gears instead: normal module, m, and helix angle at the
    #: reference cylinder, rad; radii follow from the teeth
    module: PositiveLength | None = None
    helix_angle: SpiralAngle | None = None
    #: of cylindrical gears, in modules
    profile_shift: Annotated[float, Field(gt=-1.5, lt=2.5)] = 0.0
    apex: Literal["start", "end"] = "start"  #: towards which end of the shaft the pitch apex lies
    head: HeadInertia | None = None

    @property
    def flank(self) -> str | None:
        """Loaded flank of a cylindrical gear, ``left`` or ``right``; None where it is not given.

        A concave flank faces the way the teeth lean: right-handed teeth, seen from the apex, to the
        right.
        """
        if self.loaded_side in FLANKS or self.loaded_side is None:
            return self.loaded_side
        if self.hand is None:
            return None
        return self.hand if self.loaded_side == "concave" else FLANKS[self.hand == "left"]


class Shaft(Model):
    """A shaft and the gears that it carries."""

    scene: Scene
    gears: dict[str, Gear] = {}  #: by the lumped point of the scene at which each sits
    #: of a train with an operating point, the [load] of the scene: added to the mesh force, or
    #: replaced by it; where neither is given it must be the mesh force
    scene_load: Literal["added", "replaced"] | None = None

    @model_validator(mode="after")
    def _at_points(self) -> Shaft:
        names = [port.name for port in self.scene.ports]
        problems = [
            SceneError(
                f"no lumped point of the scene is called so{nearest(name, names)}; known here: "
                f"{listed(names)}",
                path=("gears", name),
            )
            for name in self.gears
            if name not in names
        ]
        if problems:
            raise SceneError.of(problems)
        return self

    def member(self, port: str = "") -> Member:
        """Return a gear, the first by default, on the scene with that lumped point as main point."""
        port = port or next(iter(self.gears))
        main = self.scene.port.name == port
        return Member(
            scene=self.scene if main else self.scene.with_main_port(port),
            scene_load=self.scene_load,
            **{key: getattr(self.gears[port], key) for key in Gear.model_fields},
        )


class Member(Gear):
    """A gear and its shaft, whose main lumped point is that of the gear."""

    scene: Scene
    scene_load: Literal["added", "replaced"] | None = None  #: as of `Shaft`

    @property
    def shaft(self) -> Shaft:
        """Shaft that carries this gear alone."""
        gear = Gear(**{key: getattr(self, key) for key in Gear.model_fields})
        gears = {self.scene.port.name: gear}
        return Shaft(scene=self.scene, gears=gears, scene_load=self.scene_load)


@dataclass(frozen=True)
class Pair:
    """Two gears that mesh."""

    name: str  #: of the mesh: ``mesh`` where it is the only one
    #: shafts, ports: of the first gear, called pinion here whatever its size, and of the other
    shafts: tuple[str, str]
    ports: tuple[str, str]
    paths: Mapping[str, tuple]  #: keys of a file at which ``pinion``, ``gear`` and ``mesh`` stand
    pinion: Member
    gear: Member
    mesh: Mesh
    point: OperatingPoint | None  #: at which the train is looked at
    #: true where the second gear is first in a further mesh: it drives there with the flank that the
    #: file names, and is driven here on the flank behind
    idle: bool = False

    @property
    def members(self) -> dict[str, Member]:
        """Both gears, by ``pinion`` and ``gear``."""
        return {"pinion": self.pinion, "gear": self.gear}

    @property
    def label(self) -> str:
        """Name of the mesh in the middle of a phrase; empty where it is the only one."""
        return self.name.removeprefix("mesh")

    @property
    def ratio(self) -> float:
        """Teeth of the gear over teeth of the pinion."""
        return self.gear.teeth / self.pinion.teeth

    @cached_property
    def rolling(self) -> Pair:
        """The pair with pitch radii and angles of parallel shafts where the wheels roll on each other,
        as module, helix angle, profile shifts and centre distance give them.
        """
        return replace(self, **rolling_fields(self.pinion, self.gear, self.mesh))

    def with_file_paths(self, problems: Iterable[SceneError]) -> Iterator[SceneError]:
        """Yield problems of ``pinion``, ``gear`` or ``mesh`` with the paths of the file."""
        for problem in problems:
            first, *further = problem.path
            yield problem.located(None, path=(*self.paths[first], *further))


def pair_problems(pair: Pair) -> Iterator[SceneError]:
    """Yield problems of two gears that mesh, with paths from ``pinion``, ``gear`` or ``mesh``."""
    pinion, gear, mesh = pair.pinion, pair.gear, pair.mesh
    hands = (pinion.hand, gear.hand)
    curved = any(m.spiral_angle or m.helix_angle for m in (pinion, gear))
    if curved and None not in hands and hands[0] == hands[1]:
        kind = "spiral bevel pair" if mesh.shaft_angle else "helical pair on parallel shafts"
        yield SceneError(
            f"both wheels are {hands[0]}-handed; a {kind} needs one of each hand",
            path=("gear", "hand"),
        )
    yield from _flanks(pair)
    if wrong := [*cylindrical_problems(pinion, gear, mesh)]:
        yield from wrong
    else:
        yield from fit_problems(pair)
    ratio, file_ratio = pair.ratio, mesh.ratio
    if file_ratio is not None and not isclose(file_ratio, ratio, rel_tol=TYPED):
        yield SceneError(
            f"{gear.teeth} over {pinion.teeth} teeth are a ratio of {ratio:.4f}; "
            "correct it or leave it out",
            path=("mesh", "ratio"),
        )
    yield from _cycles(pair)


def _cycles(pair: Pair) -> Iterator[SceneError]:
    """Yield problems of tables over a mesh cycle, which cover one tooth pitch of the pinion."""
    teeth, pitch = pair.pinion.teeth, 2 * pi / pair.pinion.teeth
    tables = {key: getattr(pair.mesh, key) for key in ("stiffness_cycle", "line_cycle")}
    tables_given = {key: table for key, table in tables.items() if table is not None}
    for key, table in tables_given.items():
        if not isclose(table.pitch, pitch, rel_tol=TYPED):
            yield SceneError(
                f"covers {table.pitch:.5g} rad of the pinion, but one of its {teeth} teeth takes "
                f"{pitch:.5g} rad; correct the angles, or the number of teeth",
                path=("mesh", key, "angle"),
            )
    first = [table.angle[0] for table in tables_given.values()]
    if len(first) > 1 and not isclose(first[0], first[1], abs_tol=TYPED * pitch):
        yield SceneError(
            f"begins at {first[1]:.5g} rad, but stiffness_cycle at {first[0]:.5g} rad; let both "
            "begin at one angle",
            path=("mesh", "line_cycle", "angle"),
        )


def _flanks(pair: Pair) -> Iterator[SceneError]:
    """Yield problems of left and right flanks: of cylindrical gears alone, left against left."""
    pinion, gear, mesh = pair.pinion, pair.gear, pair.mesh
    sides = [side for side in pair.members if pair.members[side].loaded_side in FLANKS]
    if sides and mesh.shaft_angle:
        yield SceneError(
            "left and right flanks are for parallel shafts (ISO 21771); for a bevel gear write "
            "concave or convex",
            path=(sides[0], "loaded_side"),
        )
    elif sides and None not in (pinion.flank, gear.flank):
        if pinion.flank != gear.flank and pair.idle:
            file_flank = next(flank for flank in FLANKS if flank != gear.flank)
            yield SceneError(
                f"is the flank that the {pair.shafts[1]} drives with, so it would be driven on "
                f"its {gear.flank} flank, but the {pair.shafts[0]} drives it on the "
                f'{pinion.flank} one: write "{gear.flank}" in place of "{file_flank}", or leave it '
                "out",
                path=("gear", "loaded_side"),
            )
        elif pinion.flank != gear.flank:
            yield SceneError(
                f"is the {gear.flank} flank, but the {pinion.flank} one is loaded on the "
                f"{pair.shafts[0]}, and left flanks touch left ones; correct one of them, or "
                "leave the gear's out",
                path=("gear", "loaded_side"),
            )
