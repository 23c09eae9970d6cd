"""The scene: what is modelled, and what is asked of it.

A shaft of cylinders and cones along y, bearings with 6x6 stiffness, one lumped point (the port),
and the questions. Frozen and validated, SI inside, no numerics beyond geometry bookkeeping. Degrees
of freedom are everywhere in the order (x, y, z, thx, thy, thz); y runs along the shaft and is 0 at
its first end face.

>>> scene = solidgear.load("geometry/pinion_overhung.toml")
>>> stiff = scene.with_attachment("rigid").with_bearing_scale(10.0)
>>> rod = Scene.from_parts([Segment.cylinder("rod", length=0.3, diameter=0.06)])
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Annotated, Any, Literal, TypeVar

import numpy as np
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, model_validator

from solidgear.bearing_stiffness import checked_matrix, stiffness_entries
from solidgear.errors import TOLD, SceneError, did_you_mean, near, scene_error, show
from solidgear.frames import DOF_NAMES
from solidgear.scene_rules import (
    MOST_MODES,
    MOST_SPRINGS,
    TOUCH,
    shaft_problems,
    station_problems,
    steps,
)
from solidgear.units import (
    POSITION_DECIMALS,
    SOFTEST,
    AxialSpring,
    Density,
    Frequency,
    Modulus,
    Poisson,
    Position,
    PositiveLength,
    Thickness,
    Tolerance,
    quantity,
)

Attachment = Literal["average", "rigid", "section"]
Status = Literal["published", "identified", "assumed", "measured"]


def _few_springs(springs: Any) -> Any:
    if isinstance(springs, (list, tuple)) and len(springs) > MOST_SPRINGS:
        raise SceneError(
            f"{len(springs)} springs in series are more than the {MOST_SPRINGS} there may be; write their sum: 1/k = 1/k1 + 1/k2 + ..."
        )
    return springs


AxialSeries = Annotated[tuple[AxialSpring, ...], BeforeValidator(_few_springs)]

_Self = TypeVar("_Self", bound="Model")


class Model(BaseModel):
    """Frozen, validated, and one sentence for each problem when it refuses."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    def __init__(self, /, **data: Any):
        known = [field.alias or name for name, field in type(self).model_fields.items()]
        strange = [key for key in data if key not in known]
        meant = {key: near(key, known) for key in strange[:TOLD]}
        problems = [
            SceneError(
                f"unknown key{did_you_mean(meant.get(key)) or '; known here: ' + ', '.join(known)}",
                path=(key,),
            )
            for key in strange
        ]
        try:
            super().__init__(**{key: data[key] for key in data if key in known})
        except ValidationError as error:
            # where a key is misspelt, it is not also missing
            absent = {(name,) for name in meant.values() if name not in data}
            problems += [one for one in scene_error(error, data).problems if one.path not in absent]
        if problems:
            raise SceneError.of(one.located(data) for one in problems) from None

    def with_changes(self: _Self, **changes: Any) -> _Self:
        """A validated copy with some fields replaced. Raises `SceneError` like the constructor."""
        return type(self)(
            **{name: getattr(self, name) for name in type(self).model_fields} | changes
        )

    def model_copy(
        self: _Self, *, update: Mapping[str, Any] | None = None, deep: bool = False
    ) -> _Self:
        """As `with_changes`: pydantic's own copy would skip validation."""
        return self.with_changes(**(update or {}))


# ------------------------------------------------------------------------------------------------- parts
class Material(Model):
    """Isotropic linear elastic material: `E` in Pa, `nu`, `density` in kg/m3 (numbers in SI, or
    texts with units).
    """

    E: Modulus
    nu: Poisson
    density: Density

    @property
    def shear_modulus(self) -> float:
        """G = E / (2 (1 + nu)) in Pa."""
        return self.E / (2 * (1 + self.nu))


STEEL = Material(E=2.07e11, nu=0.3, density=7850.0)


class Segment(Model):
    """A cylinder or cone between `y0` and `y1` (m), with radii (m) at both ends; `inner` 0 is
    solid.
    """

    name: str
    y0: Position
    y1: Position
    outer0: PositiveLength
    outer1: PositiveLength
    inner0: Thickness = 0.0
    inner1: Thickness = 0.0
    material: Material = STEEL
    part: Literal["shaft", "frustum", "backcone"] = "shaft"

    @model_validator(mode="after")
    def _has_a_wall(self) -> Segment:
        if self.y1 <= self.y0:
            raise SceneError("must lie beyond y0", path=("y1",))
        for end in "01":
            if getattr(self, "inner" + end) >= getattr(self, "outer" + end):
                raise SceneError(
                    f"the bore must be smaller than the outer radius {getattr(self, 'outer' + end):.6g} m",
                    path=("inner" + end,),
                )
        return self

    @classmethod
    def cylinder(
        cls,
        name: str,
        *,
        length: Any,
        diameter: Any,
        bore: Any = 0.0,
        y0: float = 0.0,
        material: Material | None = None,
    ) -> Segment:
        """A cylinder from `y0` on; without `material` it takes that of the scene it is put into."""
        return cls.cone(
            name,
            length=length,
            start_diameter=diameter,
            end_diameter=diameter,
            bore=bore,
            y0=y0,
            material=material,
        )

    @classmethod
    def cone(
        cls,
        name: str,
        *,
        length: Any,
        start_diameter: Any,
        end_diameter: Any,
        bore: Any = 0.0,
        y0: float = 0.0,
        material: Material | None = None,
    ) -> Segment:
        """A cone with a constant bore from `y0` on; `cylinder` says the rest."""
        outer0, outer1, inner = (
            quantity(d, "length") / 2 for d in (start_diameter, end_diameter, bore)
        )
        given: dict[str, Any] = {} if material is None else {"material": material}
        return cls(
            name=name,
            y0=y0,
            y1=y0 + quantity(length, "length"),
            outer0=outer0,
            outer1=outer1,
            inner0=inner,
            inner1=inner,
            **given,
        )

    @property
    def length(self) -> float:
        """Axial length in m."""
        return self.y1 - self.y0

    def radius_at(self, y: float) -> tuple[float, float]:
        """(inner, outer) radius in m at `y`; ValueError outside the segment."""
        if not self.y0 - TOUCH <= y <= self.y1 + TOUCH:
            raise ValueError(
                f'y = {y} m is outside segment "{self.name}" ({self.y0} to {self.y1} m)'
            )
        t = min(max((y - self.y0) / self.length, 0.0), 1.0)
        return (1 - t) * self.inner0 + t * self.inner1, (1 - t) * self.outer0 + t * self.outer1


class Bearing(Model):
    """A bearing: a 6x6 between ground and the seat it sits on.

    `matrix` (or, as a constructor argument, `stiffness`: rows or named entries) is the bearing
    alone, in SI; `axial_series` lists springs (N/m) in series with its axial stiffness. `y` is the
    middle of the seat.
    """

    name: str
    y: Position
    seat_width: PositiveLength
    matrix: Annotated[tuple[tuple[float, ...], ...], BeforeValidator(checked_matrix)]
    axial_series: AxialSeries = ()
    attachment: Attachment = "average"
    status: Status = "assumed"
    note: str = ""

    def __init__(self, /, **data: Any):
        if "stiffness" in data:
            data["matrix"] = data.pop("stiffness")
        super().__init__(**data)

    @model_validator(mode="after")
    def _springs_or_none(self) -> Bearing:
        for name, k in zip(DOF_NAMES, np.diag(self.matrix)):
            if 0 < k < SOFTEST:
                raise SceneError(
                    f"the stiffness in {name} is {k:.6g}, below {SOFTEST:g} in SI, which is no spring: write 0",
                    path=("matrix",),
                )
        return self

    @property
    def lo(self) -> float:
        """Seat end towards y = 0, in m."""
        return round(self.y - self.seat_width / 2, POSITION_DECIMALS)

    @property
    def hi(self) -> float:
        """Seat end away from y = 0, in m."""
        return round(self.y + self.seat_width / 2, POSITION_DECIMALS)

    @property
    def stiffness(self) -> np.ndarray:
        """(6, 6) read-only, SI, order x y z thx thy thz: the bearing with its axial series springs
        condensed in.
        """
        K = np.array(self.matrix)
        if self.axial_series:
            # the ring between bearing and spring carries no load of its own: condense its y out,
            # couplings included
            spring = 1 / sum(1 / k for k in self.axial_series)
            K -= np.outer(K[:, 1], K[1, :]) / (K[1, 1] + spring)
        K.flags.writeable = False
        return K

    def scaled(self, factor: float) -> Bearing:
        """The same bearing with every stiffness, series springs included, times `factor` > 0."""
        if not factor > 0:
            raise SceneError("must be greater than zero", field="factor", value=show(factor))
        return self.with_changes(
            matrix=np.array(self.matrix) * factor,
            axial_series=tuple(k * factor for k in self.axial_series),
        )


class Port(Model):
    """The lumped point on the axis at `y` (m), attached to the outer surface from `lo` to `hi` (m)."""

    name: str = "port"
    y: Position
    lo: Position
    hi: Position
    attachment: Attachment = "average"


#: what a model can be judged by: compliance and stiffness at the lumped point, first modes
Quantity = Literal[
    "C_zz",
    "C_z,thx",
    "C_thx",
    "C_yy",
    "K_zz",
    "K_z,thx",
    "K_thx",
    "K_yy",
    "bending 1",
    "bending 2",
    "axial 1",
    "torsion 1",
]


class Ask(Model):
    """The questions: how many modes, up to what frequency (Hz; None is no limit), to what relative
    tolerance.

    `quantities` names what models are judged by; empty is the usual set, compliances with first
    bending and first axial mode.
    """

    modes: Annotated[int, Field(strict=True, ge=1, le=MOST_MODES)] = 10
    max_frequency: Frequency | None = None
    tolerance: Tolerance = 0.05
    quantities: tuple[Quantity, ...] = ()


# ------------------------------------------------------------------------------------------------- the scene
class Scene(Model):
    """A shaft on its bearings; read one with `solidgear.load`, or make one with `Scene.from_parts`.

    `segments` lie end to end from y = 0; `port` is the lumped point; `housing_axial` (N/m or None)
    is the spring along y between the common bearing housing and ground; `source` says where the
    data come from.
    """

    title: str = ""
    name: str = "scene"
    source: str = ""
    segments: tuple[Segment, ...]
    material: Material = STEEL
    bearings: tuple[Bearing, ...] = ()
    housing_axial: AxialSpring | None = None
    port: Port
    ask: Ask = Ask()

    @model_validator(mode="after")
    def _hangs_together(self) -> Scene:
        # a station can be judged only on a shaft that is sound
        bearings = dict(enumerate(self.bearings))
        if problems := [*shaft_problems(self.segments)] or [
            *station_problems(self.segments, self.port, bearings)
        ]:
            raise SceneError.of(problems)
        return self

    @classmethod
    def from_parts(
        cls,
        segments: Iterable[Segment],
        material: Material = STEEL,
        bearings: Iterable[Bearing] = (),
        port: Port | None = None,
        **rest: Any,
    ) -> Scene:
        """A scene made in Python.

        Parameters
        ----------
        segments : iterable of Segment
            End to end from y = 0. One made without a material takes `material`.
        material : Material
        bearings : iterable of Bearing
        port : Port, optional
            Without it, the middle of the longest segment, attached to all of that segment's outer
            surface.
        **rest
            title, name, source, housing_axial, ask.

        Raises
        ------
        SceneError
        """
        segments = tuple(
            s if "material" in s.model_fields_set else s.with_changes(material=material)
            for s in segments
        )
        if port is None and segments:
            longest = max(segments, key=lambda s: s.length)
            port = Port(y=(longest.y0 + longest.y1) / 2, lo=longest.y0, hi=longest.y1)
        given: dict[str, Any] = {} if port is None else {"port": port}
        return cls(segments=segments, material=material, bearings=tuple(bearings), **given, **rest)

    @property
    def length(self) -> float:
        """Length of the shaft in m."""
        return self.segments[-1].y1

    @property
    def stations(self) -> tuple[Port | Bearing, ...]:
        """Everything attached to the shaft, the port first: each has name, y, lo, hi, attachment."""
        return (self.port, *self.bearings)

    @property
    def steps(self) -> tuple[float, ...]:
        """y (m) where the outer radius jumps, end faces left out."""
        return steps(self.segments)

    def with_changes(self, **changes: Any) -> Scene:
        """A validated copy with some fields replaced; a new `material` also replaces the old
        default in the segments.
        """
        if "material" in changes and "segments" not in changes:
            swap = {self.material: changes["material"]}
            changes["segments"] = tuple(
                s.with_changes(material=swap.get(s.material, s.material)) for s in self.segments
            )
        return super().with_changes(**changes)

    def with_attachment(self, attachment: str) -> Scene:
        """The same scene with the port and every bearing attached by 'average', 'rigid' or
        'section'.
        """
        bearings = tuple(b.with_changes(attachment=attachment) for b in self.bearings)
        return self.with_changes(
            bearings=bearings, port=self.port.with_changes(attachment=attachment)
        )

    def with_seat_width(self, width: float | str) -> Scene:
        """The same scene with every bearing seat `width` wide."""
        return self.with_changes(
            bearings=tuple(b.with_changes(seat_width=width) for b in self.bearings)
        )

    def with_material(self, **changes: Any) -> Scene:
        """The same scene with `E`, `nu` or `density` replaced in the default material and in every
        segment.
        """
        segments = tuple(
            s.with_changes(material=s.material.with_changes(**changes)) for s in self.segments
        )
        return self.with_changes(material=self.material.with_changes(**changes), segments=segments)

    def with_bearing_scale(self, factor: float) -> Scene:
        """The same scene with every bearing's stiffness, series springs included, times `factor` >
        0.
        """
        return self.with_changes(bearings=tuple(b.scaled(factor) for b in self.bearings))

    def with_port(self, **changes: Any) -> Scene:
        """The same scene with fields of its port replaced, such as ``y=0.03``; the span stays
        unless given too.
        """
        return self.with_changes(port=self.port.with_changes(**changes))

    def as_dict(self) -> dict[str, Any]:
        """Everything resolved, in SI, as plain JSON-serialisable data."""
        data = self.model_dump(mode="json")
        for row, segment in zip(data["segments"], self.segments):
            row["length"] = segment.length
        for row, bearing in zip(data["bearings"], self.bearings):
            row |= {
                "lo": bearing.lo,
                "hi": bearing.hi,
                "stiffness": bearing.stiffness.tolist(),
                "entries": stiffness_entries(row.pop("matrix")),
            }
        return data | {"length": self.length, "steps": list(self.steps)}
