"""Meshes of a train on its shafts, the places of the shafts, and the force that a torque brings to
each mesh.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

import numpy as np

from solidgear.errors import SceneError
from solidgear.scene import Scene
from solidgear.scene.gears import Pair
from solidgear.scene.layout import outward
from solidgear.scene.operation import OperatingPoint
from solidgear.scene.planetary import Stage
from solidgear.scene.power import shares_of
from solidgear.scene.train import Joint, Train
from solidgear.studies.train.contact import Contact, axes_of, contact

#: shafts of a loop of meshes that end this far from where they began, of the distance, do not meet
CLOSES = 1e-6
#: relative; speeds about a loop that differ by more strain teeth, which then turn nowhere
LOCKED = 1e-10
#: turn (3, 3) and origin (3,), m, of a shaft's scene in the axes of the first one
Place = tuple[np.ndarray, np.ndarray]


def contacts(train: Train, coast: bool | None = None) -> dict[str, Contact]:
    """Contact of every mesh, by its name.

    Raises
    ------
    SceneError
        As :func:`solidgear.studies.train.contact.contact`, for a loop of meshes that turns against
        itself, and for flanks of two meshes that turn what is between them the same way, so that no
        torque passes.
    """
    found = {pair.name: contact(pair, coast) for pair in train.pairs}
    _, ways = _turning(train, found)
    for before, after in combinations(train.pairs, 2):
        if ways[before.name] * ways[after.name] < 0:
            both = (side for side in before.shafts if side in after.shafts)
            between, first = next(both, None), after.shafts[0]
            role = "pinion" if between in (None, first) else "gear"
            raise SceneError(
                f"the flanks of {before.name} and of {after.name} turn the {between or first} the same "
                "way, so that no torque passes it: name the other flank of one of them",
                path=(*after.paths[role], "loaded_side"),
            )
    return found


def _turning(
    train: Train, found: Mapping[str, Contact]
) -> tuple[dict[str, float], dict[str, float]]:
    """Turns of all shafts about the axes of their own scenes in one of the engine's; and by mesh the
    sign of that one, if teeth that push are to pass power from engines to loads, and by stage, if its
    sun drives about +y; 0 where it is not told.
    """
    turns: dict[str, float] = {}
    for side, joint in outward(train, train.reference):
        if joint is None:
            turns[side] = 1.0
            continue
        other = next(s for s in joint.shafts if s != side)
        own, there = (torque_on(joint, s, found) for s in (side, other))
        turns[side] = -turns[other] * there / own
    out = {}
    for k, joint in enumerate(train.joints):
        one, two = (torque_on(joint, s, found) * turns[s] for s in joint.shafts)
        if one * two > 0:
            raise SceneError(
                f"closes a loop in which the other meshes turn the {joint.shafts[1]} the other way: the "
                "loop cannot turn; leave a mesh out, or put an idler into it",
                path=("mesh", k, "between"),
            )
        if (off := abs(one / two + 1)) > LOCKED:
            raise SceneError(
                f"closes a loop in which lever arms turn the {joint.shafts[1]} by {100 * off:.2g} % other "
                "than the rest of it, so that it is locked: let lines of action follow from gear "
                "geometry (pressure_angle), or give them all digits",
                path=("mesh", k, "between"),
            )
        out[joint.name] = -float(np.sign(one) * _away(train, joint))
    return turns, out


def _away(train: Train, joint: Joint) -> float:
    """Sign of the power from the first shaft to the second: in a loop away from engines, to loads."""
    flow = train.flows[joint.name]
    if flow is not None:
        return float(np.sign(flow))
    engines, loads = (
        {train.rotors[name].shaft for name in names} for names in (train.engines, train.loads)
    )
    one, two = joint.shafts
    return float(np.sign((one in engines) + (two in loads) - (two in engines) - (one in loads)))


def _engine_way(train: Train, ways: Mapping[str, float], coast: bool) -> float:
    """Sign of the torque of the engine about y of its scene: by the flanks of meshes; without any that
    tells, a positive one is about +y.
    """
    told = (ways[pair.name] for pair in train.pairs)
    return next(filter(None, told), -1.0 if coast else 1.0)


def senses(train: Train, found: Mapping[str, Contact], coast: bool | None = None) -> dict[str, str]:
    """Sense in which every shaft turns, right-handed about y of its own scene: ``+y`` or ``-y``, by the
    flanks that carry; torque and speed of the engine turn the same way where it drives.
    """
    point = train.point
    coast = coast if coast is not None else point is not None and point.coast
    turns, ways = _turning(train, found)
    engine = _engine_way(train, ways, coast)
    forward = -engine if coast else engine
    return {side: "+y" if forward * turn > 0 else "-y" for side, turn in turns.items()}


def senses_told(found: Mapping[str, str]) -> str:
    """The same in words."""
    each = ", ".join(f"{side} {sense}" for side, sense in found.items())
    return f"turning, right-handed about y of each shaft's scene: {each}"


def sun_ways(
    train: Train, found: Mapping[str, Contact], coast: bool | None = None
) -> dict[str, tuple[float, float]]:
    """Ways in which the sun of each stage drives its planets, and turns, 1 about +y of its scene or -1,
    by the torque of the engine; it drives about +y where no torque passes.
    """
    point = train.point
    coast = coast if coast is not None else point is not None and point.coast
    turns, ways = _turning(train, found)
    engine = _engine_way(train, ways, coast)
    forward = -engine if coast else engine
    return {
        one.name: (engine * ways[one.name] or 1.0, forward * float(np.sign(turns[one.shafts[0]])))
        for one in train.stages
    }


def force_on(pair: Pair, side: str, met: Contact) -> np.ndarray:
    """(6,) load of the teeth on a shaft at its gear's lumped point for 1 N along the line of action,
    in the axes of its scene.
    """
    return met.pinion.vector if side == pair.shafts[0] else -met.gear.vector


def torque_on(joint: Joint, side: str, found: Mapping[str, Contact]) -> float:
    """Torque on a shaft about y of its scene for 1 N in a mesh, or, while its sun drives about +y, in
    that of every planet of a stage with the sun, N m.
    """
    if isinstance(joint, Stage):
        return joint.levers[side == joint.shafts[1]]
    return float(force_on(joint, side, found[joint.name])[4])


def mesh_forces(
    train: Train, found: Mapping[str, Contact], point: OperatingPoint
) -> dict[str, float]:
    """Forces of the teeth along their lines of action without losses, N, by mesh; of a planetary stage
    the mean over its planets, by its name; zero where no torque passes.  Meshes of a loop are not
    among them, for the teeth alone do not tell theirs.
    """
    turns, _ = _turning(train, found)
    out, power = {}, _power(train, turns, point)
    for joint in train.joints:
        if (flow := train.flows[joint.name]) is not None:
            side = joint.shafts[0]
            speed = torque_on(joint, side, found) * turns[side]
            out[joint.name] = float(abs(flow) * power / abs(speed))
    return out


def _power(train: Train, turns: Mapping[str, float], point: OperatingPoint) -> float:
    """All of the power in one turn of the engine's shaft, by the lever arms, N m."""
    if point.of not in train.carried:
        raise SceneError(
            f"no torque passes the {point.of}: it comes in at [engine] and goes out at [load]; write "
            "both with inertia and spring",
            path=(),
        )
    return abs(point.torque * turns[point.of]) / train.carried[point.of]


def rotor_torques(
    train: Train, found: Mapping[str, Contact], point: OperatingPoint
) -> dict[str, float]:
    """Torques of engines and loads about the axes of their shafts' scenes, N m."""
    turns, ways = _turning(train, found)
    power = _power(train, turns, point) * _engine_way(train, ways, point.coast)
    shares = shares_of(train).items()
    return {name: share * power / turns[train.rotors[name].shaft] for name, share in shares}


def places(
    train: Train, found: Mapping[str, Contact], scenes: Mapping[str, Scene]
) -> dict[str, Place]:
    """Places of all shafts but the first, in the axes of that one's scene.

    Raises
    ------
    SceneError
        For a loop of meshes whose shafts do not come together.
    """
    out: dict[str, Place] = {}
    for side, pair in outward(train, next(iter(scenes))):
        if pair is None:
            out[side] = np.eye(3), np.zeros(3)
            continue
        turn, at = _across(pair, found, scenes)
        one, other = pair.shafts
        if side == other:
            turned, origin = out[one]
            out[side] = turned @ turn, origin + turned @ at
        else:
            turned, origin = out[other]
            out[side] = turned @ turn.T, origin - turned @ turn.T @ at
    for k, pair in enumerate(train.pairs):
        turn, at = _across(pair, found, scenes)
        (turned, origin), (there, end) = (out[side] for side in pair.shafts)
        off = np.linalg.norm(origin + turned @ at - end) / np.linalg.norm(at)
        if off > CLOSES or np.abs(turned @ turn - there).max() > CLOSES:
            raise SceneError(
                f"closes a loop whose other meshes place the {pair.shafts[1]} elsewhere, by "
                f"{100 * off:.3g} % of the distance: correct azimuth, radii or gear_position",
                path=("mesh", k, "between"),
            )
    return out


def _across(pair: Joint, found: Mapping[str, Contact], scenes: Mapping[str, Scene]) -> Place:
    """Place of the second shaft of a mesh in the axes of the first one's scene; of a stage, where
    both are on one axis and their axes parallel.
    """
    y = [
        next(p.y for p in scenes[side].ports if p.name == port)
        for side, port in zip(pair.shafts, pair.ports)
    ]
    if isinstance(pair, Stage):
        return np.eye(3), np.array([0.0, y[0] - y[1], 0.0])
    met = found[pair.name]
    c, s = np.cos(pair.mesh.shaft_angle), np.sin(pair.mesh.shaft_angle)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    turn = axes_of(pair, "pinion") @ turn @ axes_of(pair, "gear").T
    pinion = np.array([0.0, y[0], 0.0]) + met.pinion.point
    gear = np.array([0.0, y[1], 0.0]) + met.gear.point
    return turn, pinion - turn @ gear
