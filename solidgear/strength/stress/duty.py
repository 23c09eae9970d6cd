"""Duty tables of stress: section forces of a shaft at every point, and how often it turns there."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING

from solidgear.core import SolidgearError
from solidgear.strength.stress.conditions import Conditions, LoadLevel

if TYPE_CHECKING:
    from solidgear.strength.stress.nominal import NominalStress
    from solidgear.strength.stress.section_forces import SectionForces
    from solidgear.trains.file.operation import OperatingPoint
    from solidgear.trains.file.train import Train

#: s
HOUR = 3600.0


@dataclass(frozen=True)
class DutyForces:
    """Section forces of a shaft at one point of a duty table."""

    label: str
    forces: SectionForces
    cycles: float  #: turns of the shaft there


def cycles_of(train: Train, conditions: Conditions) -> dict[str, tuple[float, ...]]:
    """Return the turns of every shaft at each point of the duty table of a train, or of the cases of
    a shaft; points without a time or a speed are refused.

    Examples
    --------
    >>> import solidgear as sg
    >>> train = sg.load_train("geometry/gearbox_train.toml")
    >>> turns = cycles_of(train, Conditions(hours=10))
    >>> [round(value) for value in turns["pinion"]]
    [630000, 396000]
    """
    points = train.operation
    if len(points) < 2:
        what = "case" if train.is_one_shaft else "operating point"
        raise SolidgearError(
            f"{train.name} has {'one' if points else 'no'} {what}; a duty table needs two or more"
        )
    if conditions.spectrum is not None or conditions.cycles is not None:
        raise SolidgearError("a duty table gives the cycles: leave out `cycles` and `spectrum`")
    if conditions.hard_surface:
        raise SolidgearError("a duty table is for surfaces that are not hardened")
    seconds = [HOUR * _hours(point, conditions.hours) for point in points]
    out = {}
    for side in train.shafts:
        speeds = [_speed(point, side, train) for point in points]
        out[side] = tuple(speed * time / (2 * pi) for speed, time in zip(speeds, seconds))
    return out


def _hours(point: OperatingPoint, life: float | None) -> float:
    """Return the hours of a point, by its share of a life where it has one."""
    if point.hours is not None:
        return point.hours
    if point.share is None:
        raise SolidgearError(
            f"{point.label}: a duty table needs share or hours of every case; give one, such as "
            "hours = 2000"
        )
    if life is None:
        raise SolidgearError("the duty table has shares of the time: give the life by `hours`")
    return point.share * life


def _speed(point: OperatingPoint, side: str, train: Train) -> float:
    speed = point.speed_of(side, train.turns)
    if speed is None:
        raise SolidgearError(
            f'{point.label}: cycles of bending are turns of the shaft; give its speed, such as "1500 '
            'rpm"'
        )
    return abs(speed)


def levels(
    conditions: Conditions,
    duty: Sequence[DutyForces],
    nominal: NominalStress,
    nominal_under: Callable[[SectionForces], NominalStress],
) -> tuple[LoadLevel, ...]:
    """Return levels of nominal stress: those of a duty table, or of conditions."""
    if not duty:
        return conditions.levels(nominal)
    return tuple(LoadLevel(nominal_under(point.forces), point.cycles) for point in duty)
