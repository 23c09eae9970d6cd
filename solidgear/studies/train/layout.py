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
from solidgear.scene.power import shares_of
from solidgear.scene.train import Train
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
        itself, and for flanks of two meshes that turn the shaft between them the same way, so that no
        torque passes.
    """
    found = {pair.name: contact(pair, coast) for pair in train.pairs}
    _, ways = _turning(train, found)
    for before, after in combinations(train.pairs, 2):
        between = [side for side in before.shafts if side in after.shafts]
        if between and ways[before.name] * ways[after.name] < 0:
            side = between[0]
            role = "pinion" if after.shafts[0] == side else "gear"
            raise SceneError(
                f"the flanks of {before.name} and of {after.name} turn the {side} the same way, so "
                "that no torque passes it: name the other flank of one of them",
                path=(*after.paths[role], "loaded_side"),
            )
    return found


def _turning(
    train: Train, found: Mapping[str, Contact]
) -> tuple[dict[str, float], dict[str, float]]:
    """Turns of all shafts about the axes of their own scenes in one of the engine's; and by mesh the
    sign of that one, if teeth that push are to pass power from engines to loads, 0 where it is not
    told.
    """
    turns: dict[str, float] = {}
    for side, pair in outward(train, train.reference):
        if pair is None:
            turns[side] = 1.0
            continue
        other = next(s for s in pair.shafts if s != side)
        own, there = (force_on(pair, s, found[pair.name])[4] for s in (side, other))
        turns[side] = -turns[other] * there / own
    out = {}
    for k, pair in enumerate(train.pairs):
        one, two = (force_on(pair, s, found[pair.name])[4] * turns[s] for s in pair.shafts)
        if one * two > 0:
            raise SceneError(
                f"closes a loop in which the other meshes turn the {pair.shafts[1]} the other way: the "
                "loop cannot turn; leave a mesh out, or put an idler into it",
                path=("mesh", k, "between"),
            )
        if (off := abs(one / two + 1)) > LOCKED:
            raise SceneError(
                f"closes a loop in which lever arms turn the {pair.shafts[1]} by {100 * off:.2g} % other "
                "than the rest of it, so that it is locked: let lines of action follow from gear "
                "geometry (pressure_angle), or give them all digits",
                path=("mesh", k, "between"),
            )
        out[pair.name] = -float(np.sign(one) * _away(train, pair))
    return turns, out


def _away(train: Train, pair: Pair) -> float:
    """Sign of the power from the first gear to the second: in a loop away from engines, to loads."""
    flow = train.flows[pair.name]
    if flow is not None:
        return float(np.sign(flow))
    engines, loads = (
        {train.rotors[name].shaft for name in names} for names in (train.engines, train.loads)
    )
    one, two = pair.shafts
    return float(np.sign((one in engines) + (two in loads) - (two in engines) - (one in loads)))


def force_on(pair: Pair, side: str, met: Contact) -> np.ndarray:
    """(6,) load of the teeth on a shaft at its gear's lumped point for 1 N along the line of action,
    in the axes of its scene.
    """
    return met.pinion.vector if side == pair.shafts[0] else -met.gear.vector


def mesh_forces(
    train: Train, found: Mapping[str, Contact], point: OperatingPoint
) -> dict[str, float]:
    """Forces of the teeth along their lines of action without losses, N, by mesh; zero of one that the
    torque does not pass.  Meshes of a loop are not among them, for the teeth alone do not tell theirs.
    """
    turns, _ = _turning(train, found)
    out, power = {}, _power(train, turns, point)
    for pair in train.pairs:
        if (flow := train.flows[pair.name]) is not None:
            side = pair.shafts[0]
            speed = force_on(pair, side, found[pair.name])[4] * turns[side]
            out[pair.name] = float(abs(flow) * power / abs(speed))
    return out


def _power(train: Train, turns: Mapping[str, float], point: OperatingPoint) -> float:
    """All of the power in one turn of the engine's shaft, by the lever arms, N m."""
    return abs(point.torque * turns[point.of]) / train.carried[point.of]


def rotor_torques(
    train: Train, found: Mapping[str, Contact], point: OperatingPoint
) -> dict[str, float]:
    """Torques of engines and loads about the axes of their shafts' scenes, N m."""
    turns, ways = _turning(train, found)
    power = _power(train, turns, point) * next(filter(None, ways.values()), 1.0)
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
        turn, at = _across(pair, found[pair.name], scenes)
        one, other = pair.shafts
        if side == other:
            turned, origin = out[one]
            out[side] = turned @ turn, origin + turned @ at
        else:
            turned, origin = out[other]
            out[side] = turned @ turn.T, origin - turned @ turn.T @ at
    for k, pair in enumerate(train.pairs):
        turn, at = _across(pair, found[pair.name], scenes)
        (turned, origin), (there, end) = (out[side] for side in pair.shafts)
        off = np.linalg.norm(origin + turned @ at - end) / np.linalg.norm(at)
        if off > CLOSES or np.abs(turned @ turn - there).max() > CLOSES:
            raise SceneError(
                f"closes a loop whose other meshes place the {pair.shafts[1]} elsewhere, by "
                f"{100 * off:.3g} % of the distance: correct azimuth, radii or gear_position",
                path=("mesh", k, "between"),
            )
    return out


def _across(pair: Pair, met: Contact, scenes: Mapping[str, Scene]) -> Place:
    """Place of the second shaft of a mesh in the axes of the first one's scene."""
    c, s = np.cos(pair.mesh.shaft_angle), np.sin(pair.mesh.shaft_angle)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    turn = axes_of(pair, "pinion") @ turn @ axes_of(pair, "gear").T
    y = [
        next(p.y for p in scenes[side].ports if p.name == port)
        for side, port in zip(pair.shafts, pair.ports)
    ]
    pinion = np.array([0.0, y[0], 0.0]) + met.pinion.point
    gear = np.array([0.0, y[1], 0.0]) + met.gear.point
    return turn, pinion - turn @ gear
