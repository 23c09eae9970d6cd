"""Operating points of a train: torque, speed and other loads on the shafts, data only."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, model_validator

from solidgear.core import Model, SceneError, Written
from solidgear.core.scene.gravity import Direction, acceleration
from solidgear.core.scene.load import BearingLoad
from solidgear.core.scene.load_case import LoadCase
from solidgear.core.scene.model_table import table_of
from solidgear.core.scene.units import Hours, Speed, TimeShare, Torque

#: operating points of one train
MOST_POINTS = 1000


class OutsideForce(BearingLoad):
    """A load on a shaft from neither teeth nor bearings, such as of a belt."""

    #: shaft and port, such as `pinion.A`; components are along the axes of that shaft's scene
    at: str


class OperatingPoint(Model):
    """A torque and a speed at which a train runs.

    Examples
    --------
    >>> point = OperatingPoint(torque="115 N*m", speed="3000 rpm")
    >>> point.torque, round(point.speed, 3), point.coast
    (115.0, 314.159, False)
    """

    #: name of the operating point
    name: str = ""
    #: torque of the shaft `of`, N m; positive where the flank that the file names carries it
    #: (drive), negative where the other one does (coast)
    torque: Torque
    #: shaft that torque and speed belong to; by default, in a train, the shaft that the engine
    #: turns with
    of: str = "pinion"
    #: speed of the shaft `of`, rad/s
    speed: Speed | None = None
    #: torque of the shaft that the load turns with, or of the engine's where `of` is the load's, N
    #: m; checked against the teeth
    output_torque: Torque | None = None
    #: speed of the shaft that the load turns with, or of the engine's where `of` is the load's,
    #: rad/s; checked against the teeth
    output_speed: Speed | None = None
    #: direction in which weight acts, in the axes of the first shaft's scene, such as `-z`
    weight: Direction | None = None
    #: further forces on shafts, such as of a belt
    force: tuple[OutsideForce, ...] = ()
    #: share of the time of a duty table; of every point or of none
    share: TimeShare | None = None
    #: hours of a duty table; of every point or of none
    hours: Hours | None = None

    @model_validator(mode="after")
    def _one_measure(self) -> OperatingPoint:
        if self.share is not None and self.hours is not None:
            raise SceneError("give either share or hours, not both", path=("share",))
        return self

    @classmethod
    def from_dict(cls, table: Mapping[str, Any]) -> OperatingPoint:
        """An operating point from the table of a file, as `tomllib` gives it.

        Examples
        --------
        >>> point = OperatingPoint.from_dict({"torque": "115 N*m", "speed": "3000 rpm"})
        >>> OperatingPoint.from_dict(point.to_dict()) == point
        True
        """
        return cls(**table)

    def to_dict(self) -> dict[str, Any]:
        """The table of a file, as plain data in SI; `from_dict` reads it back equal."""
        return table_of(self, write=self.model_fields_set & {"of"})

    @property
    def coast(self) -> bool:
        """True where the flank that the file does not name carries the torque."""
        return self.torque < 0

    @property
    def label(self) -> str:
        """Name, torque and speed."""
        numbers = f"{self.torque:.6g} N m on the {self.of}"
        if self.speed is not None:
            numbers += f", {self.speed * 30 / pi:.6g} rpm"
        return f"{self.name} ({numbers})" if self.name else numbers

    @property
    def gravity(self) -> tuple[float, float, float]:
        """(3,) acceleration of weight in the axes of the first shaft's scene, m/s^2; zeros without."""
        x, y, z = acceleration(self.weight).tolist()
        return (x, y, z)

    def torque_of(self, side: str, turns: Mapping[str, float]) -> float:
        """Return the torque of a shaft without losses, N m; `turns` of all shafts in the same time are
        over the share of the power that each carries.
        """
        return self.torque if side == self.of else self.torque * turns[self.of] / turns[side]

    def speed_of(self, side: str, turns: Mapping[str, float]) -> float | None:
        """Return the speed of a shaft, rad/s; None where the point has none."""
        if self.speed is None or side == self.of:
            return self.speed
        return self.speed * turns[side] / turns[self.of]


class ShaftCase(OperatingPoint):
    """A case of the loads of a shaft alone, as a point at which it works."""

    torque: Torque = 0.0
    of: str = "shaft"

    @property
    def label(self) -> str:
        """Name and speed."""
        numbers = "" if self.speed is None else f"{self.speed * 30 / pi:.6g} rpm"
        if not self.name:
            return numbers or "rest"
        return f"{self.name} ({numbers})" if numbers else self.name

    @classmethod
    def of_case(cls, case: LoadCase) -> ShaftCase:
        """Return the point of a case of the loads of a scene."""
        return cls(name=case.name, speed=case.speed, share=case.share, hours=case.hours)


def _as_points(value: Any) -> Any:
    """Return a single table as a list of one."""
    return (value,) if isinstance(value, (Mapping, OperatingPoint)) else value


Operation = Annotated[
    tuple[OperatingPoint, ...],
    BeforeValidator(_as_points),
    Field(max_length=MOST_POINTS),
    Written(OperatingPoint | list[OperatingPoint]),
]
