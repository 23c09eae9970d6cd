"""Tables of a train file, each checked by itself: meshes, engine and load, losses."""

from __future__ import annotations

from math import pi
from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Field, model_validator

from solidgear.core import (
    Length,
    Model,
    PositiveLength,
    Range,
    SceneError,
    SignedAngle,
    SolidgearError,
    Written,
)
from solidgear.core.scene.limits import MOST_MODES
from solidgear.core.scene.stations import Status
from solidgear.core.scene.units import (
    TYPED,
    Frequency,
    Inertia,
    Loss,
    MeshSpring,
    PressureAngle,
    ShaftAngle,
    Thickness,
    Tolerance,
    TorsionSpring,
    quantity,
)
from solidgear.trains.file.mesh_cycle import LineCycle, StiffnessCycle, Vector

#: nodal diameters; ports hold those below, and finer waves than the last are shorter than teeth
FIRST_HARMONIC, LAST_HARMONIC = 2, 32
Harmonic = Annotated[int, Field(strict=True, ge=FIRST_HARMONIC, le=LAST_HARMONIC)]


#: rad, of a place around an axis
Azimuth = Annotated[
    SignedAngle,
    Range(
        "is more than one turn, 360 deg; a number without a unit is in rad, and degrees are "
        'written as "120 deg"',
        least=-2 * pi * (1 + TYPED),
        most=2 * pi * (1 + TYPED),
    ),
]


#: in place of a stiffness, which then follows from the contact of the teeth
TEETH = "teeth"


def _number_or_teeth(value: Any) -> float | str:
    if isinstance(value, str) and value.strip() == TEETH:
        return TEETH
    number = quantity(value, "force_per_length")
    if number <= 0:
        raise SceneError("must be greater than zero")
    return number


#: of a mesh, N/m, or ``teeth``
MeshStiffness = Annotated[
    float | Literal["teeth"],
    BeforeValidator(_number_or_teeth),
    Written(MeshSpring | Literal["teeth"]),
]


def solved(stiffness: float | str) -> float:
    """Return the stiffness of a mesh, N/m; refuse that of teeth which nobody has solved."""
    if isinstance(stiffness, str):
        raise SolidgearError(
            'stiffness = "teeth": the contact of these teeth is not solved yet; studies solve it '
            "when they assemble a train"
        )
    return stiffness


class TorsionSpringTable(Model):
    """Torsional spring between a shaft and a rotor, and where on the shaft it sits."""

    needs: ClassVar = (("at", "position"),)

    #: torsional stiffness, N m/rad
    stiffness: TorsionSpring
    #: port of the shaft that the spring sits at: its lumped point or a bearing
    at: str | None = None
    #: distance of the spring from the place `from` along the shaft, m
    position: Length | None = None
    #: place that the position counts from
    from_: str = Field("start", alias="from")
    #: width of the seat at that position, m
    seat_width: PositiveLength | None = None
    #: source of the stiffness
    status: Status = "assumed"

    @model_validator(mode="after")
    def _one_place(self):
        if (self.at is None) == (self.position is None):
            reason = "say where on the shaft the spring sits: at = a port of the shaft, or position"
            raise SceneError(f"{reason} with from and seat_width, one of the two", path=("at",))
        if self.position is not None and self.seat_width is None:
            raise SceneError("a position needs a seat_width as well", path=("seat_width",))
        return self


class Rotor(Model):
    """The engine, the load or another inertia behind a torsional spring."""

    #: shaft that it turns with
    shaft: str = ""
    #: moment of inertia about the shaft, kg m^2
    inertia: Inertia
    #: torsional spring between the rotor and its shaft
    spring: TorsionSpringTable
    #: share of the power that one of several engines or loads brings or takes
    share: Annotated[float, Field(gt=0, le=1)] | None = None
    #: source of the inertia
    status: Status = "assumed"


class ErrorTable(Model):
    """A transmission error that is not the same everywhere."""

    needs: ClassVar = (("orders", "frequency"),)

    #: ascending frequencies, Hz; amplitudes between are linear, and constant beyond
    frequency: tuple[Frequency, ...] = ()
    #: amplitude at each frequency, m
    amplitude: tuple[Thickness, ...] = ()
    #: amplitudes of the orders of the mesh frequency, m
    orders: tuple[Thickness, ...] = ()
    #: phases of the orders where the mesh cycle begins, rad: `sum A cos(n x angle + phase)`,
    #: positive where teeth stand back; for nonlinear motion alone
    phases: tuple[SignedAngle, ...] = ()

    @model_validator(mode="after")
    def _one_kind(self):
        if bool(self.orders) == bool(self.frequency):
            reason = "give either orders, or frequency with amplitude"
            raise SceneError(reason, path=("orders",))
        if len(self.frequency) != len(self.amplitude):
            counts = f"{len(self.amplitude)} amplitudes for {len(self.frequency)} frequencies"
            raise SceneError(f"there are {counts}; give as many", path=("amplitude",))
        if self.phases and len(self.phases) != len(self.orders):
            counts = f"{len(self.phases)} phases for {len(self.orders)} orders"
            raise SceneError(f"there are {counts}; give as many", path=("phases",))
        if any(b <= a for a, b in zip(self.frequency, self.frequency[1:])):
            raise SceneError("frequencies must ascend", path=("frequency",))
        return self


def constant_or_table(value: Any) -> Any:
    """Return a number as a table of one order; anything else as it is."""
    if value is None or isinstance(value, (dict, ErrorTable)):
        return value
    return {"orders": (value,)}


#: of a mesh; a single number is a constant amplitude, m
Error = Annotated[
    ErrorTable | None, BeforeValidator(constant_or_table), Written(Thickness | ErrorTable)
]


class Cell(Model):
    """A cell of a loaded tooth contact, in the pinion's frame from the lumped point."""

    point: tuple[float, float, float]  #: m
    normal: tuple[float, float, float]  #: unit, the direction of the force on the pinion
    force: float  #: N, not negative


class Mesh(Model):
    """The teeth in contact."""

    needs: ClassVar = (
        ("pressure_angle", "line_of_action", "contact_cells"),
        ("stiffness", ("contact_cells", "loaded_error", "unloaded_error")),
    )

    #: name of the mesh
    name: str = ""
    #: shafts of the two gears, the first of which is called pinion here whatever its size; for a
    #: shaft with several gears with the lumped point, such as `middle.wheel`
    between: tuple[str, str] = ("pinion", "gear")
    #: angle of the mesh about the pinion's axis from -x, right-handed about y, and of parallel
    #: shafts about the gear's as well, so that their scenes keep parallel axes, rad
    azimuth: Azimuth = 0.0
    #: stiffness of the mesh, N/m, or `teeth`, whose contact gives it; with contact cells it may
    #: follow from `loaded_error` and `unloaded_error`
    stiffness: MeshStiffness | None = None
    #: source of the stiffness
    status: Status = "assumed"
    #: angle between the shafts, rad; 0 for parallel ones
    shaft_angle: ShaftAngle = pi / 2
    #: teeth of the gear over teeth of the pinion, where a source gives it
    ratio: Annotated[float, Field(gt=0)] | None = None
    #: angle normal to the tooth, for a line of action from gear geometry, rad; where there is a
    #: module, at the reference cylinder
    pressure_angle: PressureAngle | None = None
    #: distance of parallel shafts, m; by default that without backlash
    centre_distance: PositiveLength | None = None
    #: gap of both flanks of bevel gears at their corners, m, by the radii of the cutters, where
    #: these are not both given
    ease_off: Thickness | None = None
    #: addendum of a bevel gear over the working depth
    gear_share: Annotated[float, Field(gt=0, lt=1)] | None = None
    #: working depth of bevel gears, in mean normal modules
    working_depth: Annotated[float, Field(gt=0, le=3)] | None = None
    #: direction of the force on the pinion, in the pinion's frame, in place of a pressure angle
    line_of_action: tuple[float, float, float] | None = None
    #: source of the line of action
    line_of_action_status: Status = "assumed"
    #: mesh point in the pinion's frame from its lumped point, m, with `line_of_action`
    point: Vector | None = None
    #: a CSV file of contact cells with the columns x, y, z, nx, ny, nz and force, in place of a
    #: pressure angle or a line of action
    contact_cells: Annotated[tuple[Cell, ...], Written(str)] = ()
    #: the gear's lumped point from the pinion's, in the pinion's frame, m; by default both lie at
    #: the middle of the face
    gear_position: Vector | None = None
    #: static transmission error under the load of the cells, m
    loaded_error: Thickness | None = None
    #: static transmission error without load, m
    unloaded_error: Thickness | None = None
    #: amplitude of the transmission error, m, or a table of orders or over frequency; needed where
    #: it drives a motion
    transmission_error: Error = None
    #: source of the transmission error
    transmission_error_status: Status = "assumed"
    #: stiffness over a mesh cycle; for nonlinear motion alone
    stiffness_cycle: StiffnessCycle | None = None
    #: mesh point and line of action over a mesh cycle; for nonlinear motion alone
    line_cycle: LineCycle | None = None
    #: width of the gap between both flanks along the line of action, m; for nonlinear motion alone
    backlash: Thickness | None = None
    #: harmonics n >= 2 of harmonic solids that the force of the teeth drives where it acts, on one
    #: tooth pitch of the lumped point's seat; by default none, the mean of the seat alone
    local_harmonics: tuple[Harmonic, ...] = ()

    @model_validator(mode="after")
    def _each_once(self):
        if len(set(self.local_harmonics)) != len(self.local_harmonics):
            raise SceneError("names a harmonic twice; give each once", path=("local_harmonics",))
        return self

    @model_validator(mode="after")
    def _one_line(self):
        presence = {
            "pressure_angle": self.pressure_angle is not None,
            "line_of_action": self.line_of_action is not None,
            "contact_cells": bool(self.contact_cells),
        }
        ways = [key for key, present in presence.items() if present]
        if not ways:
            reason = (
                "give pressure_angle (line of action from gear geometry), or line_of_action with"
            )
            raise SceneError(f"{reason} point, or contact_cells", path=("pressure_angle",))
        if self.contact_cells and self.line_of_action is not None:
            reason = "contact cells have a line of action of their own; give either"
            raise SceneError(reason, path=("line_of_action",))
        if (self.point is None) != (self.line_of_action is None):
            missing = "point" if self.point is None else "line_of_action"
            raise SceneError("line_of_action and point go together; give both", path=(missing,))
        errors = (self.loaded_error, self.unloaded_error)
        computed = None not in errors and errors[0] != errors[1] and bool(self.contact_cells)
        if self.stiffness is None and not computed:
            reason = "this key is missing; give it, or contact_cells with loaded_error and"
            raise SceneError(f"{reason} unloaded_error, which must differ", path=("stiffness",))
        return self


class Losses(Model):
    """Loss factors eta, dissipated energy over ``2 pi`` times the stored: twice a damping ratio."""

    #: loss factor of the material of all shafts
    shafts: Loss = 0.04
    #: loss factor of all bearings
    bearings: Loss = 0.04
    #: loss factor of the teeth
    mesh: Loss = 0.12
    #: loss factor of the torsional springs
    springs: Loss = 0.04
    #: source of the loss factors
    status: Status = "assumed"


class TrainAsk(Model):
    """Questions of a train: the frequency range, and the tolerance of answers."""

    #: elastic modes that system-modes lists; by default all up to `max_frequency`
    modes: Annotated[int, Field(strict=True, ge=1, le=MOST_MODES)] | None = None
    #: highest frequency, Hz
    max_frequency: Frequency = 4000.0
    #: relative error that natural frequencies may have
    tolerance: Tolerance = 0.02
    #: decibels by which the mesh force may differ
    decibels: Annotated[float, Field(gt=0, le=60)] = 3.0
