"""Operating points of a train: its torque and speed, and what else loads the shafts there."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from solidgear.errors import SceneError
from solidgear.frames import DOF_NAMES
from solidgear.scene.catalogue import BearingLoad
from solidgear.scene.typed import Model
from solidgear.scene.units import Speed, Torque

Direction = Literal["x", "-x", "y", "-y", "z", "-z"]
#: m/s^2, standard gravity (ISO 80000-3)
GRAVITY = 9.80665
#: operating points of one train
MOST_POINTS = 1000


class OutsideForce(BearingLoad):
    """A load on a shaft that comes neither from the teeth nor from a bearing, such as a belt.

    Attributes
    ----------
    at : str
        Shaft and port, such as ``pinion.A``; components are along the axes of that shaft's scene.
    """

    at: str


class OperatingPoint(Model):
    """A torque and a speed at which a train runs.

    Attributes
    ----------
    torque : float
        N m, of the shaft `of`; positive where the flank that the file names carries it (drive),
        negative where the other one does (coast).
    of : str
        By default, in a train, the shaft that the engine turns with.
    speed : float or None
        rad/s, of the shaft `of`.
    output_torque, output_speed : float or None
        Of the shaft that the load turns with, or of the engine's where `of` is the load's, to be
        held against the teeth.
    weight : str or None
        Direction in which weight acts, in the axes of the first shaft's scene, such as ``-z``.
    share, hours : float or None
        Of a duty table: share of the time, or hours; of every point or of none.

    Raises
    ------
    SceneError
        Of a share and hours, both.

    Examples
    --------
    >>> point = OperatingPoint(torque="115 N*m", speed="3000 rpm")
    >>> point.torque, round(point.speed, 3), point.coast
    (115.0, 314.159, False)
    """

    name: str = ""
    torque: Torque
    of: str = "pinion"
    speed: Speed | None = None
    output_torque: Torque | None = None
    output_speed: Speed | None = None
    weight: Direction | None = None
    force: tuple[OutsideForce, ...] = ()
    share: Annotated[float, Field(gt=0, le=1)] | None = None
    hours: Annotated[float, Field(gt=0)] | None = None

    @model_validator(mode="after")
    def _one_measure(self) -> OperatingPoint:
        if self.share is not None and self.hours is not None:
            raise SceneError("give either share or hours, not both", path=("share",))
        return self

    @property
    def coast(self) -> bool:
        """True where the flank that the file does not name carries the torque."""
        return self.torque < 0

    @property
    def label(self) -> str:
        """Name, torque and speed."""
        told = f"{self.torque:.6g} N m on the {self.of}"
        if self.speed is not None:
            told += f", {self.speed * 30 / pi:.6g} rpm"
        return f"{self.name} ({told})" if self.name else told

    @property
    def gravity(self) -> tuple[float, float, float]:
        """Acceleration of weight in the axes of the first shaft's scene, m/s^2; zeros without weight."""
        out = [0.0, 0.0, 0.0]
        if self.weight is not None:
            size = -GRAVITY if self.weight.startswith("-") else GRAVITY
            out[DOF_NAMES.index(self.weight[-1])] = size
        return (out[0], out[1], out[2])

    def torque_of(self, side: str, turns: Mapping[str, float]) -> float:
        """Torque of a shaft without losses, N m, by the turns of all shafts in the same time over the
        share of the power that each carries.
        """
        return self.torque if side == self.of else self.torque * turns[self.of] / turns[side]

    def speed_of(self, side: str, turns: Mapping[str, float]) -> float | None:
        """Speed of a shaft, rad/s; None where the point has none."""
        if self.speed is None or side == self.of:
            return self.speed
        return self.speed * turns[side] / turns[self.of]


def _as_points(value: Any) -> Any:
    """One table is a list of one."""
    return (value,) if isinstance(value, (Mapping, OperatingPoint)) else value


Operation = Annotated[
    tuple[OperatingPoint, ...], BeforeValidator(_as_points), Field(max_length=MOST_POINTS)
]
