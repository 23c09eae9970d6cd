"""Lives of the bearings of a train over its operating points."""

from __future__ import annotations

from solidgear.bearings.bearing_life import left_open, life_of
from solidgear.bearings.duty import LivesOverPoints, PointLife
from solidgear.bearings.solved import AS_STATED
from solidgear.core import SolidgearError
from solidgear.core.ladder import LADDER
from solidgear.core.loading import SHAFT
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.file.train import Train
from solidgear.trains.load.operation import Operating
from solidgear.trains.load.state import OperatingState


def train_lives(train: Train) -> list[LivesOverPoints]:
    """Return the life of every catalogue bearing of a train at all operating points, or of a shaft
    alone in all cases of its loads; refused without points or catalogue bearings.
    """
    if not train.operation:
        raise SolidgearError(
            f"{train.name} has no operating point; write [operation] with a torque in its file"
        )
    train = _of_revolution(train)
    scenes = {side: shaft.scene for side, shaft in train.shafts.items()}
    unknown, choices = left_open(scenes.values())
    assembly = Assembly(train, solves_teeth=False)  # as they settle
    settled = [
        _states(Operating(assembly, choice=choice), train) for choice in (AS_STATED, *choices)
    ]
    lives_by_bearing = []
    for side, scene in scenes.items():
        for bearing in scene.bearings:
            if bearing.catalogue is None:
                continue
            end, points = f"{side}.{bearing.name}", []
            for k, point in enumerate(train.operation):
                places = [(s[k].bearings[end], s[k].equilibrium.relative[end]) for s in settled]
                speed = point.speed_of(side, train.turns)
                life = life_of(bearing, scene.lubrication, unknown, speed, places)
                points.append(PointLife(point.label, life, point.share, point.hours))
            name = bearing.name if train.is_one_shaft else end
            lives_by_bearing.append(LivesOverPoints(name, tuple(points)))
    if not lives_by_bearing:
        raise SolidgearError(f"{train.name}: no bearing is described by catalogue data")
    return lives_by_bearing


def _of_revolution(train: Train) -> Train:
    """Return a train whose shafts the model of settling solves."""
    # what is cut out moves the load of a bearing by a small part of a small part
    shafts = {
        side: shaft.with_changes(scene=shaft.scene.plain)
        for side, shaft in train.shafts.items()
        if LADDER[SHAFT].unfit(shaft.scene)
    }
    return train.with_changes(shafts={**train.shafts, **shafts}) if shafts else train


def _states(operating: Operating, train: Train) -> list[OperatingState]:
    """Return the train at all points, each begun at the one before."""
    states: list[OperatingState] = []
    for point in train.operation:
        states.append(operating.at(point, states[-1] if states else None))
    return states
