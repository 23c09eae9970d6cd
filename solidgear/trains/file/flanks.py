"""Teeth of a cylindrical gear beyond module, helix and profile shift: rack, tips, modified flanks."""

from __future__ import annotations

from math import hypot, isfinite
from typing import Annotated, Self

from pydantic import Field, model_validator

from solidgear.core import Length, Model, PositiveLength, SceneError, Written
from solidgear.core.gears.flank_shape import FlankGrid
from solidgear.core.gears.wheel import Rack
from solidgear.core.scene.units import Thickness

#: deviation that no ground or broken-in flank has, m
LARGEST_DEVIATION = 1e-3
#: face places and roll lengths of a measured flank at least
LEAST_OF_GRID = 2


class RackTable(Model):
    """The basic rack that cuts the teeth (ISO 53 A unless given), in normal modules."""

    #: addendum of the rack, in normal modules
    addendum: Annotated[float, Field(gt=0, le=2)] = 1.0
    #: dedendum of the rack, in normal modules
    dedendum: Annotated[float, Field(gt=0, le=2.5)] = 1.25
    #: radius of the fillet of the rack, in normal modules
    root_radius: Annotated[float, Field(gt=0, le=0.8)] = 0.38

    def with_angle(self, pressure_angle: float) -> Rack:
        """Return the rack with a pressure angle, rad."""
        return Rack(pressure_angle, self.addendum, self.dedendum, self.root_radius)


class ReliefTable(Model):
    """Material missing at tip and root, growing evenly along the roll length."""

    #: material missing at the tip, m
    tip: Thickness = 0.0
    #: material missing where the flank ends above the root, m
    root: Thickness = 0.0
    #: diameter at which the relief of the tip begins, m; by default where a single pair of teeth
    #: carries (long relief)
    from_: PositiveLength | None = Field(None, alias="from")
    #: diameter at which the relief of the root begins, m; by default where a single pair of teeth
    #: carries (long relief)
    root_from: PositiveLength | None = None


class MeasuredFlank(Model):
    """Deviations of a measured flank, on a grid."""

    #: face places from the middle of the face along the shaft, m
    z: tuple[float, ...]
    #: roll, diameter: roll lengths, or diameters in their place, m
    roll: tuple[float, ...] = ()
    diameter: tuple[float, ...] = ()
    #: at each face place and height, positive where there is more material than an involute has, m
    deviation: tuple[tuple[float, ...], ...]

    @model_validator(mode="after")
    def _is_a_grid(self) -> Self:
        if bool(self.roll) == bool(self.diameter):
            raise SceneError("give either roll or diameter", path=("roll",))
        heights = self.roll or self.diameter
        for name, places in (("z", self.z), ("roll" if self.roll else "diameter", heights)):
            if len(places) < LEAST_OF_GRID or any(b <= a for a, b in zip(places, places[1:])):
                raise SceneError(f"must ascend, {LEAST_OF_GRID} at least", path=(name,))
        if heights[0] < 0:
            raise SceneError("must not be negative", path=("roll" if self.roll else "diameter",))
        if [len(row) for row in self.deviation] != [len(heights)] * len(self.z):
            reason = f"must be {len(self.z)} rows of {len(heights)}, one for each z"
            raise SceneError(reason, path=("deviation",))
        largest = max(abs(value) for row in self.deviation for value in row)
        if not (isfinite(largest) and largest <= LARGEST_DEVIATION):
            raise SceneError(
                f"is {largest:.4g} m at most, larger than a millimetre: write metres, 5e-6 for 5 um",
                path=("deviation",),
            )
        return self

    def grid(self, base: float) -> FlankGrid:
        """Return what is missing by roll length on a base circle, m."""
        roll = self.roll or tuple(roll_length(d / 2, base) for d in self.diameter)
        missing = tuple(tuple(-value for value in row) for row in self.deviation)
        return FlankGrid(self.z, roll, missing)


def roll_length(radius: float, base: float) -> float:
    """Return the length along the tangent of a base circle at a radius, m; zero within the circle."""
    return float(max(radius**2 - base**2, 0.0) ** 0.5)


def radius_at(roll: float, base: float) -> float:
    """Return the radius at a length along the tangent of a base circle, m."""
    return hypot(roll, base)


class Flanks(Model):
    """Rack, tips, face and flanks of a cylindrical gear; of both flanks of each tooth alike."""

    #: basic rack that cuts the teeth; by default ISO 53 A
    rack: RackTable | None = None
    #: tip diameter, of a ring the inner one, m
    tip_diameter: PositiveLength | None = None
    #: distance of the middle of the face from the lumped point along the shaft, m
    face_offset: Length = 0.0
    #: relief of tip and root
    relief: ReliefTable | None = None
    #: material missing at both ends of the face, m
    crowning: Thickness = 0.0
    #: material missing at the end of the face nearer to the end of the shaft more than at the
    #: other, on the flank that carries, m
    helix_slope: Length = 0.0
    #: a CSV file with the columns z, roll or diameter, and deviation, in m: more material is
    #: positive
    measured_flank: Annotated[MeasuredFlank | None, Written(str)] = None

    @property
    def is_modified(self) -> bool:
        """True where a flank is other than an involute."""
        return bool(self.relief or self.crowning or self.helix_slope or self.measured_flank)

    @property
    def is_described(self) -> bool:
        """True where the file says more of these teeth than their numbers."""
        keys = ("rack", "tip_diameter", "face_offset")
        return self.is_modified or any(getattr(self, key) for key in keys)
