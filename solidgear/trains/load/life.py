"""Lives of the bearings of a train over the operating points."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from solidgear.bearings.bearing_life import BearingLife, left_open, life_of
from solidgear.bearings.duty import DutyLife, DutyPoint, duty_life
from solidgear.bearings.solved import AS_STATED
from solidgear.core import SolidgearError
from solidgear.trains.assembly.models import Workshop
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.train import Train
from solidgear.trains.load.operation import Operating, OperatingState


@dataclass(frozen=True)
class TrainBearingLife:
    """Lives of a bearing of a train."""

    end: str  #: shaft and bearing, such as ``pinion.A``
    points: tuple[OperatingPoint, ...]
    lives: tuple[BearingLife, ...]  #: at each of them

    @cached_property
    def kind(self) -> str:
        """Kind of life that duty adds up: the modified one where every loaded point has it."""
        finite = [life.life for life in self.lives if math.isfinite(life.life.reference)]
        modified = finite and all(life.modified is not None for life in finite)
        return "modified" if modified else "reference"

    @property
    def duty(self) -> DutyLife | None:
        """Life over the duty table; None where the points give neither speed nor shares."""
        weights = [p.share if p.share is not None else p.hours for p in self.points]
        single = len(weights) == 1
        if (None in weights and not single) or not all(life.speed for life in self.lives):
            return None
        return duty_life(
            [
                DutyPoint(
                    self._life_at_point(life),
                    life.speed,
                    1.0 if single else p.share,
                    None if single else p.hours,
                )
                for p, life in zip(self.points, self.lives)
            ]
        )

    def _life_at_point(self, bearing_life: BearingLife) -> float:
        life = bearing_life.life
        return life.modified.life if self.kind == "modified" and life.modified else life.reference


def train_lives(train: Train) -> list[TrainBearingLife]:
    """Return the life of every catalogue bearing of a train at all operating points; refused
    without points or catalogue bearings.
    """
    if not train.operation:
        raise SolidgearError(
            f"{train.name} has no operating point; write [operation] with a torque in its file"
        )
    scenes = {side: shaft.scene for side, shaft in train.shafts.items()}
    open_data, choices = left_open(scenes.values())
    shop = Workshop(train)
    settled = [_states(Operating(shop, choice=choice), train) for choice in (AS_STATED, *choices)]
    lives_by_bearing = []
    for side, scene in scenes.items():
        for bearing in scene.bearings:
            if bearing.catalogue is None:
                continue
            end = f"{side}.{bearing.name}"
            lives = []
            for k, point in enumerate(train.operation):
                places = [(s[k].bearings[end], s[k].equilibrium.relative[end]) for s in settled]
                speed = point.speed_of(side, train.turns)
                lives.append(life_of(bearing, scene.lubrication, open_data, speed, places))
            lives_by_bearing.append(TrainBearingLife(end, train.operation, tuple(lives)))
    if not lives_by_bearing:
        raise SolidgearError(f"{train.name}: no bearing is described by catalogue data")
    return lives_by_bearing


def _states(operating: Operating, train: Train) -> list[OperatingState]:
    """Return the train at all points, each begun at the one before."""
    states: list[OperatingState] = []
    for point in train.operation:
        states.append(operating.at(point, states[-1] if states else None))
    return states
