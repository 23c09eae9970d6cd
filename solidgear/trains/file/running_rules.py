"""Rules for torsional springs, torques and speeds of a train, one sentence for each problem."""

from __future__ import annotations

from collections.abc import Iterator
from math import isclose, pi

from solidgear.core import Scene, SceneError, listed, nearest
from solidgear.core.scene.load_rules import duty_problems
from solidgear.core.scene.units import TYPED
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.shafting import Shafting


def spring_problems(train: Shafting) -> Iterator[SceneError]:
    """Yield problems of torsional springs: unknown ports, places off their shafts."""
    for name, rotor in train.rotors.items():
        spring, scene = rotor.spring, train.shafts[rotor.shaft].scene
        ports = [s.name for s in scene.stations]
        key, word = ("at", spring.at) if spring.at is not None else ("from", spring.from_)
        names = ports if key == "at" else ["start", "end", *ports]
        if word not in names:
            yield SceneError(
                f"unknown port of the {rotor.shaft}'s shaft{nearest(word, names)}; "
                f"known here: {listed(names)}",
                path=(*train.rotor_path(name), "spring", key),
            )
        elif key == "from" and word in ports and word in ("start", "end"):
            yield SceneError(
                f"is the {word} of the {rotor.shaft}'s shaft, and a station is called so as "
                "well; give the station another name",
                path=(*train.rotor_path(name), "spring", key),
            )
        elif key == "from":
            yield from _on_the_shaft(train, name, rotor.shaft)


def _on_the_shaft(train: Shafting, rotor: str, side: str) -> Iterator[SceneError]:
    try:
        train.shaft(side)
    except SceneError as error:
        reason = f"is not a place on the {side}'s shaft: {error.problems[0].reason}"
        yield SceneError(reason, path=(*train.rotor_path(rotor), "spring", "position"))


def running_problems(train: Shafting) -> Iterator[SceneError]:
    """Yield problems of operating points: torques and speeds against the teeth, held shafts."""
    if not train.operation:
        return
    lacking = [
        f"[{k}]" for k, rotors in (("engine", train.engines), ("load", train.loads)) if not rotors
    ]
    if lacking:
        reason = (
            "a torque comes in at the engine and goes out at the load: write "
            f"{' and '.join(lacking)} with inertia and spring, or leave [operation] out"
        )
        yield SceneError(reason, path=("operation",))
        return
    if not any(flow is None or flow for flow in train.flows.values()):
        reason = (
            f"engine and load both turn with the {train.reference}: no mesh carries their torque"
        )
        yield SceneError(reason, path=(*train.rotor_path(train.loads[0]), "shaft"))
        return
    for k, point in enumerate(train.operation):
        yield from (
            problem.located(None, prefix=("operation", k)) for problem in _point(train, point)
        )
    yield from duty_problems(train.operation, "operation", "operating point")
    for side, rotors in train.shafts.items():
        scene = rotors.scene
        holding = [b.name for b in scene.bearings if b.matrix is not None and b.matrix[4][4] > 0]
        if holding:
            yield SceneError(
                f"a torque must turn the {side}'s shaft, but {listed(holding)} of its scene holds "
                "its rotation: leave kthy out, or use another hold than clamped",
                path=("operation",),
            )
        yield from _speeds(train, side, scene)


def _point(train: Shafting, point: OperatingPoint) -> Iterator[SceneError]:
    """Yield problems of an operating point against the teeth, and of forces at unknown ports."""
    if point.of not in train.torque_turns:
        sides = train.torque_turns
        reason = f"is not a shaft that the torque passes; write one of {listed(sides)}"
        yield SceneError(reason + nearest(point.of, sides), path=("of",))
        return
    yield from _against_teeth(train, point)
    ports = {side: [s.name for s in shaft.scene.stations] for side, shaft in train.shafts.items()}
    for i, force in enumerate(point.force):
        side, _, port = force.at.partition(".")
        if port not in ports.get(side, ()):
            known_ports = ", ".join(f"{s}.{p}" for s, names in ports.items() for p in names)
            reason = f"names no port of a shaft; known here: {known_ports}"
            yield SceneError(reason, path=("force", i, "at"))


def _against_teeth(train: Shafting, point: OperatingPoint) -> Iterator[SceneError]:
    """Yield problems of a torque and speed at the other end that contradict the teeth."""
    first, last = train.reference, train.output
    side = first if point.of == last else last
    torque, speed = point.torque_of(side, train.torque_turns), point.speed_of(side, train.turns)
    output = point.output_torque
    if output is not None and not isclose(abs(output), abs(torque), rel_tol=TYPED):
        yield SceneError(
            f"{point.torque:.6g} N m on the {point.of} are balanced by {abs(torque):.6g} N m on "
            f"the {side} (teeth {train.ratio:.4f} to 1, no losses); correct one, or leave it out",
            path=("output_torque",),
        )
    if point.output_speed is None:
        return
    if speed is None:
        yield SceneError("checks a speed; write speed as well", path=("output_speed",))
    elif not isclose(point.output_speed, speed, rel_tol=TYPED):
        yield SceneError(
            f"the teeth turn the {side} at {speed * 30 / pi:.6g} rpm; correct one, or leave it out",
            path=("output_speed",),
        )


def _speeds(train: Shafting, side: str, scene: Scene) -> Iterator[SceneError]:
    """Yield problems of speeds of bearings that are not those of their shaft."""
    for bearing in scene.bearings:
        bearing_speed = bearing.catalogue.speed if bearing.catalogue is not None else 0.0
        for k, point in enumerate(train.operation):
            speed = point.speed_of(side, train.turns) if point.of in train.turns else None
            if (
                bearing_speed
                and speed is not None
                and not isclose(bearing_speed, speed, rel_tol=TYPED)
            ):
                yield SceneError(
                    f"turns the {side}'s shaft at {speed * 30 / pi:.6g} rpm, and the "
                    f"catalogue data of its bearing {bearing.name} name {bearing_speed * 30 / pi:.6g} "
                    "rpm; correct one, or leave the bearing's speed out",
                    path=("operation", k, "speed"),
                )
                break
