"""Lives of the bearings of a train over its operating points."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from solidgear.bearings.duty import DutyLife, DutyPoint, duty_life
from solidgear.bearings.solved import AS_STATED
from solidgear.errors import SolidgearError
from solidgear.scene.operation import OperatingPoint
from solidgear.scene.train import Train
from solidgear.studies.bearing_life import BearingLife, left_open, life_of
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.operation import Operating, OperatingState


@dataclass(frozen=True)
class TrainBearingLife:
    """Lives of one bearing of a train."""

    end: str  #: shaft and bearing, such as ``pinion.A``
    points: tuple[OperatingPoint, ...]
    lives: tuple[BearingLife, ...]  #: at each of them

    @cached_property
    def kind(self) -> str:
        """The life that duty adds up: the modified one where every loaded point has it."""
        known = [one.life for one in self.lives if math.isfinite(one.life.reference)]
        modified = known and all(one.modified is not None for one in known)
        return "modified" if modified else "reference"

    @property
    def duty(self) -> DutyLife | None:
        """Life over the duty table; None where the points give neither speed nor shares."""
        told = [p.share if p.share is not None else p.hours for p in self.points]
        alone = len(told) == 1
        if (None in told and not alone) or not all(one.speed for one in self.lives):
            return None
        return duty_life(
            [
                DutyPoint(
                    self._of(one), one.speed, 1.0 if alone else p.share, None if alone else p.hours
                )
                for p, one in zip(self.points, self.lives)
            ]
        )

    def _of(self, one: BearingLife) -> float:
        own = one.life
        return own.modified.life if self.kind == "modified" and own.modified else own.reference


def train_lives(train: Train) -> list[TrainBearingLife]:
    """Life of every catalogue bearing of a train at all its operating points.

    Parameters
    ----------
    train : Train
        With operating points.

    Raises
    ------
    SolidgearError
        A train without operating points or catalogue bearings, or one that finds no equilibrium.
    """
    if not train.operation:
        raise SolidgearError(
            f"{train.name} has no operating point; write [operation] with a torque in its file"
        )
    scenes = {side: own.scene for side, own in train.shafts.items()}
    told, choices = left_open(scenes.values())
    shop = Workshop(train)
    settled = [_settled(Operating(shop, choice=choice), train) for choice in (AS_STATED, *choices)]
    found = []
    for side, scene in scenes.items():
        for bearing in scene.bearings:
            if bearing.catalogue is None:
                continue
            end = f"{side}.{bearing.name}"
            lives = []
            for k, point in enumerate(train.operation):
                places = [(s[k].made[end], s[k].equilibrium.relative[end]) for s in settled]
                speed = point.speed_of(side, train.turns)
                lives.append(life_of(bearing, scene.lubrication, told, speed, places))
            found.append(TrainBearingLife(end, train.operation, tuple(lives)))
    if not found:
        raise SolidgearError(f"{train.name}: no bearing is described by catalogue data")
    return found


def _settled(operating: Operating, train: Train) -> list[OperatingState]:
    """The train at all its points, each begun at the one before."""
    states: list[OperatingState] = []
    for point in train.operation:
        states.append(operating.at(point, states[-1] if states else None))
    return states
