"""Speeds at which the files of a train say that it runs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import pi

from solidgear.scene import Scene
from solidgear.scene.train import Train

RPM = 30 / pi


@dataclass(frozen=True)
class Fastest:
    """The highest speed of the engine's shaft in the files."""

    rpm: float  #: zero where all that is given stands still
    said_by: str  #: where it stands


def fastest(train: Train, scenes: Mapping[str, Scene]) -> Fastest | None:
    """The highest speed that the files of a train and its shafts give; None where none does."""
    return max(_speeds(train, scenes), key=lambda speed: speed.rpm, default=None)


def _speeds(train: Train, scenes: Mapping[str, Scene]) -> Iterator[Fastest]:
    """Speeds that the files give, and where."""
    for point in train.operation:
        if (speed := point.speed_of(train.reference, train.turns)) is not None:
            where = f"operation {point.name!r}" if point.name else "the operation"
            yield Fastest(abs(speed) * RPM, where)
    for side, own in train.turns.items():
        turns, oil = 1 / own, scenes[side].lubrication
        if oil is not None and oil.speed:
            yield Fastest(abs(turns * oil.speed) * RPM, f"lubrication of the {side}")
        for bearing in scenes[side].bearings:
            if bearing.catalogue is not None and bearing.catalogue.speed:
                speed = abs(turns * bearing.catalogue.speed) * RPM
                yield Fastest(speed, f"bearing {bearing.name!r} of the {side}")
