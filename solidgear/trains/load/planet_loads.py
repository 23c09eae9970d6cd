"""Loads of an operating point on members of planetary stages apart from those of teeth: weight, and
centrifugal forces of planets, by names of members in the model and the axes of the stage.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from solidgear.core import System
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.stages import StageAtWork
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.system.planetary_members import Planet

#: of the weight of all planets at their distance from the axis
ROUNDING = 1e-9


def weights(assembly: Assembly, stage: StageAtWork, point: OperatingPoint) -> dict[str, np.ndarray]:
    """Return the weight (6,) of planets, and of a supported ring, N."""
    turn, _ = assembly.places[stage.stage.shafts[0]]
    falling = np.r_[(turn @ stage.axes).T @ point.gravity, np.zeros(3)]
    table = stage.stage.table
    out = {name: table.planet.mass * falling for name in stage.planets}
    if table.ring is not None:
        out["ring"] = table.ring.mass * falling
    return out


def centrifugal(
    assembly: Assembly, stage: StageAtWork, point: OperatingPoint
) -> dict[str, np.ndarray]:
    """Return the centrifugal force (6,) of every planet, N; zero at a point without a speed."""
    speed = point.speed_of(stage.stage.shafts[1], assembly.train.turns) or 0.0
    size = stage.stage.table.planet.mass * speed**2 * stage.stage.teeth.pin_radius
    return {name: size * np.r_[p.axes[:, 0], np.zeros(3)] for name, p in _members(stage)}


def centrifugal_load(assembly: Assembly, system: System, point: OperatingPoint) -> np.ndarray:
    """Return the (N,) load of the centrifugal forces of all planets on a system of the train."""
    out = np.zeros(system.size)
    for stage in assembly.stages.values():
        for name, force in centrifugal(assembly, stage, point).items():
            along = stage.model.parts[name].ports["centre"].axes
            end = f"{stage.planets[name]}.centre"
            out += system.load({end: np.kron(np.eye(2), along.T) @ force})
    return out


def carrier_torques(assembly: Assembly, point: OperatingPoint) -> dict[str, float]:
    """Return the torque about the axis of the scene, N m, that keeps each carrier from turning by
    the weight of planets at unequal angles, by the port that carries the pins.
    """
    out = {}
    for stage in assembly.stages.values():
        pins = {name: stage.model.carrier.radius * p.axes[:, 0] for name, p in _members(stage)}
        falling = weights(assembly, stage, point)
        moments = [np.cross(pin, falling[name][:3])[1] for name, pin in pins.items()]
        largest = sum(np.linalg.norm(falling[name]) for name in pins) * stage.model.carrier.radius
        if abs(sum(moments)) > ROUNDING * largest:
            out[stage.ends[1]] = -stage.way * float(sum(moments))
    return out


def _members(stage: StageAtWork) -> Iterator[tuple[str, Planet]]:
    """Return planets by their names in the model."""
    return zip(stage.planets, stage.model.planets)
