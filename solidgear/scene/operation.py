"""Operating points of a train: its torque and speed, and what else loads the shafts there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import fsum, isclose, pi
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from solidgear.errors import SceneError, listed, nearest
from solidgear.frames import DOF_NAMES
from solidgear.scene.catalogue import BearingLoad
from solidgear.scene.typed import Model
from solidgear.scene.units import Speed, Torque

Direction = Literal["x", "-x", "y", "-y", "z", "-z"]
#: m/s^2, standard gravity (ISO 80000-3)
GRAVITY = 9.80665
#: torques, speeds and shares that are typed with four digits may differ by this
TYPED = 1e-3
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


def operation_problems(
    points: Sequence[OperatingPoint],
    turns: Mapping[str, float],
    torque_turns: Mapping[str, float],
    ends: tuple[str, str],
    ports: Mapping[str, Sequence[str]],
) -> Iterator[SceneError]:
    """Problems of operating points among themselves, against the teeth, and of forces nowhere.

    Parameters
    ----------
    turns, torque_turns : mapping of str to float
        Of all shafts in the same time, and of those that the torque passes over the share of the power
        that each carries.
    ends : (str, str)
        Shafts where it comes in and goes out.
    ports : mapping of str to sequence of str
        Ports of each shaft.

    Yields
    ------
    SceneError
    """
    for k, point in enumerate(points):
        if point.of not in torque_turns:
            reason = f"is no shaft that the torque passes; write one of {listed(torque_turns)}"
            hint = nearest(point.of, torque_turns)
            yield SceneError(reason + hint, path=("operation", k, "of"))
            continue
        yield from _against_teeth(point, turns, torque_turns, ends, k)
        for i, force in enumerate(point.force):
            side, _, port = force.at.partition(".")
            if port not in ports.get(side, ()):
                known = ", ".join(f"{s}.{p}" for s, names in ports.items() for p in names)
                path = ("operation", k, "force", i, "at")
                yield SceneError(f"names no port of a shaft; known here: {known}", path=path)
    yield from _duty(points)


def _against_teeth(
    point: OperatingPoint,
    turns: Mapping[str, float],
    torque_turns: Mapping[str, float],
    ends: tuple[str, str],
    k: int,
) -> Iterator[SceneError]:
    """Torque and speed of the other end that are not those of the teeth."""
    other = ends[0] if point.of == ends[1] else ends[1]
    torque, speed = point.torque_of(other, torque_turns), point.speed_of(other, turns)
    given, ratio = point.output_torque, turns[ends[0]] / turns[ends[1]]
    if given is not None and not isclose(abs(given), abs(torque), rel_tol=TYPED):
        yield SceneError(
            f"{point.torque:.6g} N m on the {point.of} are balanced by {abs(torque):.6g} N m on "
            f"the {other} (teeth {ratio:.4f} to 1, no losses); correct one, or leave it out",
            path=("operation", k, "output_torque"),
        )
    if point.output_speed is None:
        return
    if speed is None:
        reason = "needs a speed to be held against; write speed as well"
        yield SceneError(reason, path=("operation", k, "output_speed"))
    elif not isclose(point.output_speed, speed, rel_tol=TYPED):
        yield SceneError(
            f"the teeth turn the {other} at {speed * 30 / pi:.6g} rpm; correct one, or leave it out",
            path=("operation", k, "output_speed"),
        )


def _duty(points: Sequence[OperatingPoint]) -> Iterator[SceneError]:
    """A duty table that is not whole."""
    for key in ("share", "hours"):
        given = [getattr(point, key) for point in points]
        if any(given) and None in given:
            lacking = given.index(None)
            reason = f"this key is missing; a duty table gives {key} for every point"
            yield SceneError(reason, path=("operation", lacking, key))
            return
    shares = [point.share for point in points if point.share is not None]
    if shares and abs(fsum(shares) - 1) > TYPED:
        yield SceneError(
            f"the shares of {len(shares)} operating points sum to {fsum(shares):.6g}; they must "
            "sum to 1",
            path=("operation", 0, "share"),
        )
