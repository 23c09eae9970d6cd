"""Lives of the bearings of a train over its operating points."""

from __future__ import annotations

from collections.abc import Sequence

from solidgear.bearings.bearing_life import left_open, life_of
from solidgear.bearings.duty import LivesOverPoints, PointLife
from solidgear.bearings.solved import AS_STATED
from solidgear.core import SolidgearError
from solidgear.trains.assembly.assembly import NO_MODES, Assembly
from solidgear.trains.file.train import Train
from solidgear.trains.load.operation import Operating
from solidgear.trains.load.state import OperatingState


def train_lives(train: Train) -> list[LivesOverPoints]:
    """Return the life of every catalogue bearing of a train at all operating points, or of a shaft
    alone in all cases of its loads; refused without points or catalogue bearings.
    """
    return lives_of(Assembly(train, kept=NO_MODES))


def lives_of(assembly: Assembly) -> list[LivesOverPoints]:
    """Return the lives as :func:`train_lives`, on the models that deflection trusts."""
    train = assembly.asked_train
    if not train.operation:
        raise SolidgearError(
            f"{train.name} has no operating point; write [operation] with a torque in its file"
        )
    scenes = {side: shaft.scene for side, shaft in train.shafts.items()}
    unknown, choices = left_open(scenes.values())
    settled = [
        _states(Operating(assembly, choice=choice), train) for choice in (AS_STATED, *choices)
    ]
    return lives_in(train, settled, unknown)


def lives_in(
    train: Train, settled: Sequence[Sequence[OperatingState]], unknown: str = ""
) -> list[LivesOverPoints]:
    """Return the life of every catalogue bearing of a train in states at operating points, as stated
    and then for each choice of `unknown` data; refused without catalogue bearings.
    """
    lives_by_bearing = []
    for side, shaft in train.shafts.items():
        for bearing in shaft.scene.bearings:
            if bearing.catalogue is None:
                continue
            end, oil = f"{side}.{bearing.name}", shaft.scene.lubrication
            points = []
            for states in zip(*settled):
                point = states[0].point
                places = [(s.bearings[end], s.equilibrium.relative[end]) for s in states]
                life = life_of(bearing, oil, unknown, point.speed_of(side, train.turns), places)
                points.append(PointLife(point.label, life, point.share, point.hours))
            name = bearing.name if train.is_one_shaft else end
            lives_by_bearing.append(LivesOverPoints(name, tuple(points)))
    if not lives_by_bearing:
        raise SolidgearError(f"{train.name}: no bearing is described by catalogue data")
    return lives_by_bearing


def _states(operating: Operating, train: Train) -> list[OperatingState]:
    """Return the train at all points, each begun at the one before."""
    states: list[OperatingState] = []
    for point in train.operation:
        states.append(operating.at(point, states[-1] if states else None))
    return states
