"""What teeth in contact cost, in processor seconds.

    python -m validation.teeth_costs

One wheel of 23 teeth in plane strain and in 3D, then 23/57 with a helix of 15 degrees: the compliance of
both wheels is there after the first position, 32 positions of a mesh cycle, and a torque curve of ten
points by 32 positions.  Rows go to validation/results/teeth_costs.json; a minute or two.
"""

from __future__ import annotations

from collections.abc import Callable
from math import radians
from time import process_time
from typing import Literal

import numpy as np

from solidgear.core.gears.wheel import Wheel
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.teeth.compliance.flank import FlankCompliance
from solidgear.teeth.contact.cycle import mesh_cycle
from solidgear.teeth.contact.cylindrical import CylindricalPair
from solidgear.teeth.contact.local import Elasticity, LineContact
from solidgear.teeth.contact.solver import loads
from solidgear.teeth.train_teeth import TeethModel, WheelBody
from validation.common import kept, stamp

FACE, TORQUE = 20e-3, 260.0
HOLDS = (25e-3, 60e-3)


def seconds(work: Callable[[], object]) -> float:
    """Return the processor time of some work, s."""
    start = process_time()
    work()
    return process_time() - start


def pair_by(name: Literal["slices", "solid"]) -> CylindricalPair:
    """Return both wheels with the teeth of a model."""
    helix, model = radians(15), TeethModel(name)
    pinion, gear = (Wheel(teeth, 4e-3, helix, face_width=FACE) for teeth in (23, 57))
    wheels = WheelPair(pinion, gear)
    first, second = (
        model.compliance(wheel, WheelBody(Elasticity(), hold, hand, FACE, 0.0))
        for wheel, hold, hand in zip((wheels.first, wheels.second), HOLDS, (1, -1))
    )
    law = LineContact((Elasticity(), Elasticity()), (first.depth, second.depth))
    return CylindricalPair(wheels, (first, second), law, slices=model.slices)


def ask(teeth: FlankCompliance, wheel: Wheel) -> None:
    """Ask a wheel for one compliance, which builds it."""
    teeth.matrix(np.zeros(1, int), np.array([wheel.radius]), np.zeros(1))


def costs(name: Literal["slices", "solid"]) -> dict[str, float]:
    """Return what a model costs, s."""
    pair = pair_by(name)
    wheels, base = pair.wheels, pair.wheels.first.base
    row = {
        "one wheel": seconds(lambda: ask(pair.compliances[0], wheels.first)),
        "other wheel": seconds(lambda: ask(pair.compliances[1], wheels.second)),
        "first position": seconds(lambda: loads(pair, TORQUE, 0.0)),
    }
    row["32 positions"] = seconds(lambda: mesh_cycle(pair, TORQUE, base, pair.slices))
    row["ten torques"] = seconds(
        lambda: [mesh_cycle(pair, TORQUE * k / 10, base, pair.slices) for k in range(1, 11)]
    )
    return row


def main() -> None:
    """Measure both models, print and keep the rows."""
    rows = {}
    names: tuple[Literal["slices", "solid"], ...] = ("slices", "solid")
    for name in names:
        rows[name] = costs(name)
        print(name, {what: round(value, 2) for what, value in rows[name].items()}, flush=True)
    kept("teeth_costs", {"processor seconds": rows, "made": stamp()})


if __name__ == "__main__":
    main()
