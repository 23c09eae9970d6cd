"""Gears and the shafts that carry them: data only."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, InstanceOf, model_validator

from solidgear.core import Model, PositiveLength, Scene, SceneError, Written, listed, nearest
from solidgear.core.reduction.port_matrices import PortMatrices
from solidgear.core.scene.stations import Status
from solidgear.core.scene.units import Inertia, Mass, PitchAngle, SpiralAngle
from solidgear.trains.file.flanks import Flanks
from solidgear.trains.file.matrix_keys import WithMatrices
from solidgear.trains.file.tables import Azimuth

#: relative, of inertias: the last of three digits
ROUNDED = 5e-3
#: teeth that a wheel may have
FEWEST_TEETH, MOST_TEETH = 3, 2000

#: 1/m, of the blade of a cutter: a circle of a tenth of a metre
MOST_CURVED = 10.0

Teeth = Annotated[int, Field(strict=True, ge=FEWEST_TEETH, le=MOST_TEETH)]
#: of cylindrical gears (ISO 21771)
FLANKS = ("left", "right")


#: of a shaft: mass and stiffness of its free body in the axes of its scene, by another program
Matrices = Annotated[InstanceOf[PortMatrices] | None, Field(exclude=True, repr=False), Written(str)]


class HeadInertia(Model):
    """A rigid body of revolution at the lumped point of a shaft, added to the mass of the segments."""

    #: mass, kg
    mass: Mass
    #: moment of inertia about the shaft, at the lumped point, kg m^2
    torsional: Inertia
    #: moment of inertia across the shaft, at the lumped point, kg m^2
    bending: Inertia
    #: source of these numbers
    status: Status = "assumed"

    @model_validator(mode="after")
    def _possible(self) -> Self:
        if self.bending < (1 - ROUNDED) * self.torsional / 2:
            raise SceneError(
                f"is less than half of torsional, {self.torsional:g} kg m^2, which is impossible",
                path=("bending",),
            )
        return self


class Gear(Flanks):
    """The teeth of one gear of a shaft."""

    #: number of teeth
    teeth: Teeth
    #: hand of the teeth
    hand: Literal["left", "right"] | None = None
    #: flank that carries; on parallel shafts left or right, as seen from the side of the apex (the
    #: start of the shaft unless `apex` says otherwise), a tooth with its tip upwards (ISO 21771)
    loaded_side: Literal["concave", "convex", "left", "right"] | None = None
    #: pitch radius at the heel, m
    pitch_radius: PositiveLength | None = None
    #: face width along the cone, m
    face_width: PositiveLength | None = None
    #: angle of the pitch cone to the axis, rad
    pitch_angle: PitchAngle | None = None
    #: spiral angle of bevel gears, rad
    spiral_angle: SpiralAngle | None = None
    #: normal module of a cylindrical gear, m; radii follow from the teeth
    module: PositiveLength | None = None
    #: helix angle of a cylindrical gear at the reference cylinder, rad
    helix_angle: SpiralAngle | None = None
    #: profile shift of a cylindrical gear, in modules
    profile_shift: Annotated[float, Field(gt=-1.5, lt=2.5)] = 0.0
    #: radius of the cutter of a bevel gear at the pitch plane, m; flanks open away from their
    #: middle where the cutter of the concave flank has the larger radius
    cutter_radius: PositiveLength | None = None
    #: curvature of the blade of the cutter of a bevel gear, 1/m; where the pinion's blade is
    #: curved, flanks open away from their middle
    blade_curvature: Annotated[float, Field(ge=-MOST_CURVED, le=MOST_CURVED)] | None = None
    #: angle of the middle of a tooth of a cylindrical gear at the lumped point about y of the
    #: scene, right-handed from x, rad: that of two gears of a shaft ties the phases of their meshes
    angle: Azimuth | None = None
    #: end of the shaft that the pitch apex lies towards
    apex: Literal["start", "end"] = "start"
    #: rigid mass and inertia of the gear body at the lumped point
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


class Shaft(WithMatrices):
    """A shaft and the gears that it carries."""

    #: file of the shaft, or the tables of its scene
    scene: Annotated[Scene, Written(str | dict)]
    #: gears by the lumped points of the scene at which they sit
    gears: dict[str, Gear] = {}
    #: whether the [load] of the scene is added to the mesh force or replaced by it, in a train
    #: with an operating point; without this key it must be the mesh force
    scene_load: Literal["added", "replaced"] | None = None
    #: file of matrices of the free body by another program
    matrices: Matrices = None

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
            matrices=self.matrices,
            **{key: getattr(self.gears[port], key) for key in Gear.model_fields},
        )


class Member(WithMatrices, Gear):
    """A gear and its shaft, whose main lumped point is that of the gear."""

    #: file of the shaft, or the tables of its scene
    scene: Annotated[Scene, Written(str | dict)]
    #: whether the [load] of the scene is added to the mesh force or replaced by it, in a train
    #: with an operating point; without this key it must be the mesh force
    scene_load: Literal["added", "replaced"] | None = None
    #: file of matrices of the free body by another program
    matrices: Matrices = None

    @property
    def shaft(self) -> Shaft:
        """Shaft that carries this gear alone."""
        gear = Gear(**{key: getattr(self, key) for key in Gear.model_fields})
        gears = {self.scene.port.name: gear}
        return Shaft(
            scene=self.scene, gears=gears, scene_load=self.scene_load, matrices=self.matrices
        )
