"""Weight of shafts, as much as their files have, whatever their models leave out."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from solidgear.core import LADDER, System
from solidgear.core.frames import shift
from solidgear.core.scene.gravity import GRAVITY
from solidgear.core.scene.own_mass import own_mass
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.shaft import RIGID
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.system.equilibrium import weight

#: share of the weight of a shaft that is rounding
ROUNDING = 1e-12


def weight_at_rest(
    assembly: Assembly, system: System, models: Mapping[str, str], point: OperatingPoint
) -> np.ndarray:
    """Return the load (N,) of weight on the coordinates of a system: spread over each shaft as the mass of
    its model, and at its main point what that lacks, such as fillets that a beam leaves out, or has
    beside the axis, which turns with the shaft.
    """
    total = weight(system, point.gravity)
    loads = {}
    for side, model in models.items():
        if model.partition("/")[0] in (*LADDER.bodies, RIGID):
            end = f"{side}.{assembly.scenes[side].port.name}"
            gravity = system.port(end).axes.T @ np.array(point.gravity)
            loads[end] = _lacking(assembly, side, model, gravity)
    return total + system.load(loads)


def _lacking(assembly: Assembly, side: str, model: str, gravity: np.ndarray) -> np.ndarray:
    """Return the load (6,) at the main point of a shaft by which its weight is more than that of a body,
    under gravity (3,) in the axes of its scene, N and N m.
    """
    scene = assembly.scenes[side]
    shaft = own_mass(scene)
    due = (
        shift([0.0, shaft.centre[1] - scene.port.y, 0.0]).T
        @ np.r_[shaft.mass * gravity, np.zeros(3)]
    )
    falling = assembly.shaft_model(side, model).rigid_mass @ np.r_[gravity, np.zeros(3)]
    lacking = due - shift([0.0, -scene.port.y, 0.0]).T @ falling
    least = ROUNDING * shaft.mass * GRAVITY * np.repeat([1.0, scene.length], 3)
    return np.where(np.abs(lacking) > least, lacking, 0.0)
