"""Torques about the axis of a shaft alone, which nothing else feels: what bearings take of them, and how
far the shaft is turned.

Where b bearings hold the shaft against turning with the stiffness k, the torques t that they take and
the rotation p of the shaft as a whole follow from the twist between them: with the flexibility F of
the free shaft and the rotations g that the loads bring about,

    t / k + F t - p = g,      sum of t = sum of the torques.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from solidgear.core import Scene, System
from solidgear.core.scene.acting import carriers, holders
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.file.train import ALONE
from solidgear.trains.system.equilibrium import FIRM, SystemEquilibrium

#: component of a torque about the axis among the six
ABOUT = 4


def held_torques(
    assembly: Assembly, system: System, loads: Mapping[str, np.ndarray]
) -> dict[str, float]:
    """Return the torques about the axis that bearings of a shaft alone take of loads on ports, N m,
    by the port.
    """
    stiffness = _stiffness(assembly)
    torques = {end: load[ABOUT] * np.eye(6)[ABOUT] for end, load in loads.items() if load[ABOUT]}
    if not torques or not stiffness:
        return {}
    omega, shapes = system.elastic
    rotations = np.array([system.motion(end)[ABOUT] for end in stiffness]) @ shapes / omega
    turned = rotations @ (shapes.T @ system.load(torques) / omega)
    count = len(stiffness)
    matrix = np.zeros((count + 1, count + 1))
    matrix[:count, :count] = np.diag([1 / k for k in stiffness.values()]) + rotations @ rotations.T
    matrix[:count, count], matrix[count, :count] = -1.0, 1.0
    total = sum(load[ABOUT] for load in torques.values())
    torques_held = np.linalg.solve(matrix, np.r_[turned, total])[:count]
    return dict(zip(stiffness, torques_held.tolist()))


def _stiffness(assembly: Assembly) -> dict[str, float]:
    """Return the stiffness of bearings of a shaft alone against turning, N m/rad, by the port."""
    bearings = assembly.scenes[ALONE].bearings
    names = holders(bearings)
    return {
        f"{ALONE}.{b.name}": min(float(b.stiffness[ABOUT, ABOUT]), FIRM)
        for b in bearings
        if b.name in names
    }


def still_station(scene: Scene) -> str:
    """Return the station of a shaft alone that does not turn where no bearing holds it: that where
    torques leave, or else the main lumped point.
    """
    return carriers(scene)[scene.torque_at or scene.port.name]


def turned_back(
    assembly: Assembly, system: System, solved: SystemEquilibrium, held: Mapping[str, float]
) -> SystemEquilibrium:
    """Return the same with the torques that bearings take, turned as these let it; without any the
    place where torques leave, or else the main lumped point, does not turn.
    """
    end, angle = f"{ALONE}.{still_station(assembly.scenes[ALONE])}", 0.0
    load = dict(solved.load)
    if held:
        end = next(iter(held))
        angle = held[end] / _stiffness(assembly)[end]
    for port, torque in held.items():
        load[port] = load[port] + torque * np.eye(6)[ABOUT]
    turning = rotation(system, [ALONE])
    row = system.motion(end)[ABOUT]
    factor = (angle - float(row @ solved.coordinates)) / float(row @ turning)
    return replace(solved, load=load, coordinates=solved.coordinates + factor * turning)


def rotation(system: System, shafts: list[str]) -> np.ndarray:
    """Return the (N,) free motion of the train that moves no seat of a bearing but about the axis."""
    free = system.free
    ends = [f"{side}.{p}" for side in shafts for p in system.parts[side].ports]
    still = np.vstack([system.motion(end)[[0, 1, 2, 3, 5]] for end in ends]) @ free
    _, _, vectors = np.linalg.svd(still)
    return free @ vectors[-1]
