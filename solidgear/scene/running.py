"""Problems of what drives a train and of how it runs."""

from __future__ import annotations

from collections.abc import Iterator
from math import isclose, pi
from typing import TYPE_CHECKING

from solidgear.errors import SceneError, listed, nearest
from solidgear.scene.layout import RATIO_TYPED
from solidgear.scene.model import Scene
from solidgear.scene.operation import operation_problems

if TYPE_CHECKING:
    from solidgear.scene.train import Train


def spring_problems(train: Train) -> Iterator[SceneError]:
    """Problems of torsional springs: ports that are not there, places off their shafts.

    Yields
    ------
    SceneError
    """
    for name, rotor in train.rotors.items():
        spring, scene = rotor.spring, train.shafts[rotor.shaft].scene
        ports = [s.name for s in scene.stations]
        key, word = ("at", spring.at) if spring.at is not None else ("from", spring.from_)
        known = ports if key == "at" else ["start", "end", *ports]
        if word not in known:
            yield SceneError(
                f"unknown port of the {rotor.shaft}'s shaft{nearest(word, known)}; "
                f"known here: {listed(known)}",
                path=(name, "spring", key),
            )
        elif key == "from" and word in ports and word in ("start", "end"):
            yield SceneError(
                f"is the {word} of the {rotor.shaft}'s shaft, and a station is called so as "
                "well; give the station another name",
                path=(name, "spring", key),
            )
        elif key == "from":
            yield from _on_the_shaft(train, name, rotor.shaft)


def _on_the_shaft(train: Train, rotor: str, side: str) -> Iterator[SceneError]:
    try:
        train.shaft(side)
    except SceneError as error:
        reason = f"is no place on the {side}'s shaft: {error.problems[0].reason}"
        yield SceneError(reason, path=(rotor, "spring", "position"))


def running_problems(train: Train) -> Iterator[SceneError]:
    """Problems of operating points: torques and speeds that the teeth contradict, shafts that do not turn.

    Yields
    ------
    SceneError
    """
    if not train.operation:
        return
    if len(train.joints) >= len(train.shafts):
        reason = "how meshes in a loop share a torque is not told by their teeth; leave it out"
        yield SceneError(reason, path=("operation",))
        return
    ports = {side: [s.name for s in own.scene.stations] for side, own in train.shafts.items()}
    turns = {side: train.turns[side] for pair in train.power for side in pair.shafts}
    ends = train.rotors["engine"].shaft, train.rotors["load"].shaft
    if not turns:
        reason = f"engine and load both turn with the {ends[0]}: no mesh carries their torque"
        yield SceneError(reason, path=("load", "shaft"))
        return
    yield from operation_problems(train.operation, turns, ends, ports)
    for side, own in train.shafts.items():
        scene = own.scene
        held = [b.name for b in scene.bearings if b.matrix is not None and b.matrix[4][4] > 0]
        if held:
            yield SceneError(
                f"a torque has to turn the {side}'s shaft, and {listed(held)} of its scene "
                "holds its rotation: leave kthy out, or hold it in another way than clamped",
                path=("operation",),
            )
        yield from _speeds(train, side, scene)


def _speeds(train: Train, side: str, scene: Scene) -> Iterator[SceneError]:
    """Speeds that bearings of a shaft name and that it does not have."""
    for bearing in scene.bearings:
        own = bearing.catalogue.speed if bearing.catalogue is not None else 0.0
        for k, point in enumerate(train.operation):
            speed = point.speed_of(side, train.turns) if point.of in train.turns else None
            if own and speed is not None and not isclose(own, speed, rel_tol=RATIO_TYPED):
                yield SceneError(
                    f"turns the {side}'s shaft at {speed * 30 / pi:.6g} rpm, and the "
                    f"catalogue data of its bearing {bearing.name} name {own * 30 / pi:.6g} "
                    "rpm; correct one, or leave the bearing's speed out",
                    path=("operation", k, "speed"),
                )
                break
