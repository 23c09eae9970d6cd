"""The parts of a scene, each frozen and validated: material, segment, bearing and port."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, TypeVar

import numpy as np
from pydantic import BaseModel, BeforeValidator, ConfigDict, ValidationError, model_validator

from solidgear.errors import TOLD, SceneError, did_you_mean, near, scene_error, show
from solidgear.frames import DOF_NAMES
from solidgear.scene.bearing_stiffness import checked_matrix
from solidgear.scene.rules import MOST_SPRINGS, TOUCH
from solidgear.scene.units import (
    POSITION_DECIMALS,
    SOFTEST,
    AxialSpring,
    Density,
    Modulus,
    Poisson,
    Position,
    PositiveLength,
    Thickness,
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
