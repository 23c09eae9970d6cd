"""Speeds at which a train runs according to the files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import pi

from solidgear.core import Scene
from solidgear.trains.file.train import Train

RPM = 30 / pi


@dataclass(frozen=True)
class GivenSpeed:
    """A speed of the engine's shaft in the files."""

    rpm: float  #: zero where all that is given stands still
    source: str  #: where it stands


def highest_speed(train: Train, scenes: Mapping[str, Scene]) -> GivenSpeed | None:
    """Return the highest speed that the files of a train and of the shafts give; None where none does."""
    return max(_speeds(train, scenes), key=lambda speed: speed.rpm, default=None)


def _speeds(train: Train, scenes: Mapping[str, Scene]) -> Iterator[GivenSpeed]:
    """Yield the speeds that the files give, and the place of each in the files."""
    for point in train.operation:
        if (speed := point.speed_of(train.reference, train.turns)) is not None:
            source = f"operation {point.name!r}" if point.name else "the operation"
            yield GivenSpeed(abs(speed) * RPM, source)
    for side, turns_of_shaft in train.turns.items():
        turns, oil = 1 / turns_of_shaft, scenes[side].lubrication
        if oil is not None and oil.speed:
            yield GivenSpeed(abs(turns * oil.speed) * RPM, f"lubrication of the {side}")
        for bearing in scenes[side].bearings:
            if bearing.catalogue is not None and bearing.catalogue.speed:
                speed = abs(turns * bearing.catalogue.speed) * RPM
                yield GivenSpeed(speed, f"bearing {bearing.name!r} of the {side}")
