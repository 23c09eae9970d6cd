"""Meshes of a train on its shafts, the places of the shafts, and the force that a torque brings to
each mesh.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from solidgear.errors import SceneError
from solidgear.scene import Scene
from solidgear.scene.gears import Pair
from solidgear.scene.layout import outward
from solidgear.scene.operation import OperatingPoint
from solidgear.scene.planetary import Stage
from solidgear.scene.train import Joint, Train
from solidgear.studies.train.contact import Contact, axes_of, contact

#: shafts of a loop of meshes that end this far from where they began, of the distance, do not meet
CLOSES = 1e-6
#: turn (3, 3) and origin (3,), m, of a shaft's scene in the axes of the first one
Place = tuple[np.ndarray, np.ndarray]


def contacts(train: Train, coast: bool | None = None) -> dict[str, Contact]:
    """Contact of every mesh, by its name.

    Raises
    ------
    SceneError
        As :func:`solidgear.studies.train.contact.contact`, and for flanks of two meshes that turn the
        shaft between them the same way, so that no torque passes.
    """
    found = {pair.name: contact(pair, coast) for pair in train.pairs}
    ways, way = sun_ways(train, found, coast), train.power
    for before, after in zip(way, way[1:]):
        side = _between(before, after)
        pushes = [torque_on(joint, side, found, ways) for joint in (before, after)]
        if pushes[0] * pushes[1] > 0:
            after = after if isinstance(after, Pair) else before
            assert isinstance(after, Pair)  # stages turn to what is beside them
            role = "pinion" if after.shafts[0] == side else "gear"
            raise SceneError(
                f"the flanks of {before.name} and of {after.name} turn the {side} the same way, so "
                "that no torque passes it: name the other flank of one of them",
                path=(*after.paths[role], "loaded_side"),
            )
    return found


def force_on(pair: Pair, side: str, met: Contact) -> np.ndarray:
    """(6,) load of the teeth on a shaft at its gear's lumped point for 1 N along the line of action,
    in the axes of its scene.
    """
    return met.pinion.vector if side == pair.shafts[0] else -met.gear.vector


def _between(one: Joint, other: Joint) -> str:
    """Shaft that two neighbours on the way of a torque share."""
    return next(side for side in one.shafts if side in other.shafts)


def torque_on(
    joint: Joint, side: str, found: Mapping[str, Contact], ways: Mapping[str, float]
) -> float:
    """Torque on a shaft about y of its scene for 1 N in a mesh, or in that of every planet with the
    sun, N m.
    """
    if isinstance(joint, Stage):
        return ways[joint.name] * joint.levers[side == joint.shafts[1]]
    return float(force_on(joint, side, found[joint.name])[4])


def sun_ways(
    train: Train, found: Mapping[str, Contact], coast: bool | None = None
) -> dict[str, float]:
    """Way in which the sun of each stage drives its planets, 1 about +y of its scene or -1: as the
    flanks of other meshes pass the torque on; without any, so that a positive one of the engine is
    about +y.
    """
    point = train.point
    coast = coast if coast is not None else point is not None and point.coast
    out = {stage.name: 1.0 for stage in train.stages}
    way = train.power
    known = {joint.name for joint in way if isinstance(joint, Pair)}
    if way and not known:
        known = {way[0].name}
        if (torque_on(way[0], train.reference, found, out) > 0) is not coast:
            out[way[0].name] = -1.0
    for one, other in [*zip(way, way[1:]), *zip(way[::-1], way[-2::-1])]:
        if one.name in known and other.name not in known:
            side = _between(one, other)
            if torque_on(one, side, found, out) * torque_on(other, side, found, out) > 0:
                out[other.name] *= -1
            known.add(other.name)
    return out


def mesh_forces(
    train: Train, found: Mapping[str, Contact], point: OperatingPoint
) -> dict[str, float]:
    """Forces of the teeth along their lines of action without losses, N, by mesh, each in balance with
    the next on the shaft between them; zero of one that the torque does not pass; of a planetary
    stage the mean over its planets, by its name.
    """
    out = dict.fromkeys((joint.name for joint in train.joints), 0.0)
    ways = dict.fromkeys(out, 1.0)
    reached = {point.of: abs(point.torque)}
    for _ in train.power:
        for joint in train.power:
            for side, other in (joint.shafts, joint.shafts[::-1]):
                if side in reached and other not in reached:
                    near, far = (torque_on(joint, s, found, ways) for s in (side, other))
                    out[joint.name] = float(reached[side] / abs(near))
                    reached[other] = out[joint.name] * abs(far)
    return out


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
