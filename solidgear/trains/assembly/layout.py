"""Meshes of a train on the shafts, the places of the shafts, and the force that a torque brings to
each mesh.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

import numpy as np

from solidgear.core import Scene, SceneError
from solidgear.trains.file.layout import outward
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import Stage
from solidgear.trains.file.power import shares_of
from solidgear.trains.file.shafting import Joint
from solidgear.trains.file.train import Train
from solidgear.trains.load.contact import Contact, axes_of, contact

#: shafts of a loop of meshes that end this far from where they began, of the distance, do not meet
CLOSES = 1e-6
#: relative; speeds about a loop that differ by more strain teeth, which then turn nowhere
LOCKED = 1e-10
#: turn (3, 3) and origin (3,), m, of a shaft's scene in the axes of the first one
Place = tuple[np.ndarray, np.ndarray]


def contacts(train: Train, coast: bool | None = None) -> dict[str, Contact]:
    """Return the contact of every mesh by name; refused for a loop of meshes that turns against
    itself, and for flanks of two meshes that turn the shaft between them the same way, so that
    no torque passes.
    """
    mesh_contacts = {pair.name: contact(pair, coast) for pair in train.pairs}
    _, signs = _turns_and_signs(train, mesh_contacts)
    for before, after in combinations(train.pairs, 2):
        if signs[before.name] * signs[after.name] < 0:
            shared_shafts = (side for side in before.shafts if side in after.shafts)
            shared, first = next(shared_shafts, None), after.shafts[0]
            role = "pinion" if shared in (None, first) else "gear"
            raise SceneError(
                f"the flanks of {before.name} and {after.name} turn the {shared or first} the "
                "same way, so that no torque passes it; name the other flank of one of them",
                path=(*after.paths[role], "loaded_side"),
            )
    return mesh_contacts


def _turns_and_signs(
    train: Train, mesh_contacts: Mapping[str, Contact]
) -> tuple[dict[str, float], dict[str, float]]:
    """Return the turns of all shafts about the axes of their own scenes in one turn of the
    engine's; and by mesh the sign of that turn if teeth that push are to pass power from engines
    to loads, by stage if its sun drives about +y, 0 where the file leaves it open.
    """
    turns: dict[str, float] = {}
    for side, joint in outward(train, train.reference):
        if joint is None:
            turns[side] = 1.0
            continue
        neighbour = next(s for s in joint.shafts if s != side)
        torque, neighbour_torque = (torque_on(joint, s, mesh_contacts) for s in (side, neighbour))
        turns[side] = -turns[neighbour] * neighbour_torque / torque
    signs = {}
    for k, joint in enumerate(train.joints):
        power_in, power_out = (torque_on(joint, s, mesh_contacts) * turns[s] for s in joint.shafts)
        if power_in * power_out > 0:
            raise SceneError(
                f"closes a loop in which the other meshes turn the {joint.shafts[1]} the other way: the "
                "loop cannot turn; leave a mesh out, or put an idler into it",
                path=("mesh", k, "between"),
            )
        if (mismatch := abs(power_in / power_out + 1)) > LOCKED:
            raise SceneError(
                f"closes a loop that is locked, since its lever arms turn the {joint.shafts[1]} "
                f"by {100 * mismatch:.2g} % more or less than the other meshes do; give pressure_angle "
                "in place of lines of action, or give these all digits",
                path=("mesh", k, "between"),
            )
        signs[joint.name] = -float(np.sign(power_in) * _power_sign(train, joint))
    return turns, signs


def _power_sign(train: Train, joint: Joint) -> float:
    """Return the sign of the power from the first shaft to the second: in a loop away from engines,
    to loads.
    """
    flow = train.flows[joint.name]
    if flow is not None:
        return float(np.sign(flow))
    engines, loads = (
        {train.rotors[name].shaft for name in names} for names in (train.engines, train.loads)
    )
    first, second = joint.shafts
    return float(
        np.sign((first in engines) + (second in loads) - (second in engines) - (first in loads))
    )


def _engine_sign(train: Train, signs: Mapping[str, float], coast: bool) -> float:
    """Return the sign of the torque of the engine about y of the scene: by the flanks of meshes;
    where none defines it, a positive torque is about +y.
    """
    mesh_signs = (signs[pair.name] for pair in train.pairs)
    return next(filter(None, mesh_signs), -1.0 if coast else 1.0)


def _motion(
    train: Train, mesh_contacts: Mapping[str, Contact], coast: bool | None
) -> tuple[dict[str, float], dict[str, float], float, float]:
    """Return turns and signs, and the signs of the engine's torque and of its rotation; `coast` is
    by default that of the operating point.
    """
    if coast is None:
        coast = train.point is not None and train.point.coast
    turns, signs = _turns_and_signs(train, mesh_contacts)
    engine = _engine_sign(train, signs, coast)
    return turns, signs, engine, -engine if coast else engine


def senses(
    train: Train, mesh_contacts: Mapping[str, Contact], coast: bool | None = None
) -> dict[str, str]:
    """Return the sense in which every shaft turns, right-handed about y of each scene: ``+y`` or
    ``-y``, by the flanks that carry; torque and speed of the engine turn the same way where it
    drives.
    """
    turns, _, _, forward = _motion(train, mesh_contacts, coast)
    return {side: "+y" if forward * turn > 0 else "-y" for side, turn in turns.items()}


def senses_sentence(by_shaft: Mapping[str, str]) -> str:
    """Return the senses in words."""
    senses = ", ".join(f"{side} {sense}" for side, sense in by_shaft.items())
    return f"turning, right-handed about y of each shaft's scene: {senses}"


def sun_ways(
    train: Train, mesh_contacts: Mapping[str, Contact], coast: bool | None = None
) -> dict[str, tuple[float, float]]:
    """Return for the sun of each stage the ways in which it drives its planets and in which it
    turns, 1 about +y of its scene or -1, by the torque of the engine; it drives about +y where
    no torque passes.
    """
    turns, signs, engine, forward = _motion(train, mesh_contacts, coast)
    return {
        stage.name: (
            engine * signs[stage.name] or 1.0,
            forward * float(np.sign(turns[stage.shafts[0]])),
        )
        for stage in train.stages
    }


def force_on(pair: Pair, side: str, contact: Contact) -> np.ndarray:
    """Return the (6,) load of the teeth on a shaft at the gear's lumped point for 1 N along the
    line of action, in the axes of the scene.
    """
    return contact.pinion.vector if side == pair.shafts[0] else -contact.gear.vector


def torque_on(joint: Joint, side: str, mesh_contacts: Mapping[str, Contact]) -> float:
    """Return the torque on a shaft about y of the scene for 1 N in a mesh, or, while its sun drives
    about +y, in the mesh of every planet of a stage with the sun, N m.
    """
    if isinstance(joint, Stage):
        return joint.levers[side == joint.shafts[1]]
    return float(force_on(joint, side, mesh_contacts[joint.name])[4])


def mesh_forces(
    train: Train, mesh_contacts: Mapping[str, Contact], point: OperatingPoint
) -> dict[str, float]:
    """Return the forces of the teeth along their lines of action without losses, N, by mesh, of a
    planetary stage the mean over the planets; zero where no torque passes. Meshes of a loop are
    left out, for the teeth alone do not define their forces.
    """
    if train.is_one_shaft:
        return {}
    turns, _ = _turns_and_signs(train, mesh_contacts)
    forces, power = {}, _power(train, turns, point)
    for joint in train.joints:
        if (flow := train.flows[joint.name]) is not None:
            side = joint.shafts[0]
            speed = torque_on(joint, side, mesh_contacts) * turns[side]
            forces[joint.name] = float(abs(flow) * power / abs(speed))
    return forces


def _power(train: Train, turns: Mapping[str, float], point: OperatingPoint) -> float:
    """Return all of the power in one turn of the engine's shaft, by the lever arms, N m."""
    if point.of not in train.carried:
        raise SceneError(
            f"no torque passes the {point.of}: it comes in at [engine] and goes out at [load]; write "
            "both with inertia and spring",
            path=(),
        )
    return abs(point.torque * turns[point.of]) / train.carried[point.of]


def rotor_torques(
    train: Train, mesh_contacts: Mapping[str, Contact], point: OperatingPoint
) -> dict[str, float]:
    """Return the torques of engines and loads about the axes of their shafts' scenes, N m."""
    if train.is_one_shaft:
        return {}
    turns, signs = _turns_and_signs(train, mesh_contacts)
    power = _power(train, turns, point) * _engine_sign(train, signs, point.coast)
    shares = shares_of(train).items()
    return {name: share * power / turns[train.rotors[name].shaft] for name, share in shares}


def places(
    train: Train, mesh_contacts: Mapping[str, Contact], scenes: Mapping[str, Scene]
) -> dict[str, Place]:
    """Return the places of all shafts in the axes of the first shaft's scene; refused for a loop of
    meshes whose shafts do not come together.
    """
    by_shaft: dict[str, Place] = {}
    for side, pair in outward(train, next(iter(scenes))):
        if pair is None:
            by_shaft[side] = np.eye(3), np.zeros(3)
            continue
        turn, offset = _across(pair, mesh_contacts, scenes)
        first, second = pair.shafts
        if side == second:
            axes, origin = by_shaft[first]
            by_shaft[side] = axes @ turn, origin + axes @ offset
        else:
            axes, origin = by_shaft[second]
            by_shaft[side] = axes @ turn.T, origin - axes @ turn.T @ offset
    for k, pair in enumerate(train.pairs):
        turn, offset = _across(pair, mesh_contacts, scenes)
        (axes, origin), (second_axes, second_origin) = (by_shaft[side] for side in pair.shafts)
        gap = np.linalg.norm(origin + axes @ offset - second_origin) / np.linalg.norm(offset)
        if gap > CLOSES or np.abs(axes @ turn - second_axes).max() > CLOSES:
            raise SceneError(
                f"closes a loop whose other meshes place the {pair.shafts[1]} elsewhere, by "
                f"{100 * gap:.3g} % of the distance: correct azimuth, radii or gear_position",
                path=("mesh", k, "between"),
            )
    return by_shaft


def _across(
    pair: Joint, mesh_contacts: Mapping[str, Contact], scenes: Mapping[str, Scene]
) -> Place:
    """Return the place of the second shaft of a mesh in the axes of the first one's scene; of a
    stage both are on one axis, and their axes are parallel.
    """
    y = [
        next(p.y for p in scenes[side].ports if p.name == port)
        for side, port in zip(pair.shafts, pair.ports)
    ]
    if isinstance(pair, Stage):
        return np.eye(3), np.array([0.0, y[0] - y[1], 0.0])
    contact = mesh_contacts[pair.name]
    c, s = np.cos(pair.mesh.shaft_angle), np.sin(pair.mesh.shaft_angle)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    turn = axes_of(pair, "pinion") @ turn @ axes_of(pair, "gear").T
    pinion = np.array([0.0, y[0], 0.0]) + contact.pinion.point
    gear = np.array([0.0, y[1], 0.0]) + contact.gear.point
    return turn, pinion - turn @ gear
