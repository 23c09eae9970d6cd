"""Tip relief against transmission error: how much is right for which load.

It illustrates how to:

* describe a pair of wheels, and ask for its contact ratio,
* give the teeth of each their compliance, in plane strain of the whole wheel,
* solve their contact over a mesh cycle, for several reliefs and loads.

Without relief the error grows with the load.  Relief that makes up for what teeth give way by under a
load leaves the least error there, and more at any other (Harris, Proc. IMechE 172, 1958, 87).
"""

import numpy as np

import solidgear as sg
from solidgear.core.gears.flank_shape import FlankShape
from solidgear.teeth.compliance.plane import PlaneTeeth
from solidgear.teeth.compliance.slices import Slices
from solidgear.teeth.contact.cycle import mesh_cycle
from solidgear.teeth.contact.cylindrical import CylindricalPair
from solidgear.teeth.contact.local import LineContact
from solidgear.trains.file.flanks import ReliefTable
from solidgear.trains.file.mesh_teeth import reliefs

FACE = 20e-3
RELIEFS = (0.0, 10e-6, 20e-6, 30e-6)  # at the tips of both wheels, m
LOADS = 1e3 * np.array([25, 50, 100, 200, 300, 400, 500, 600])  # per face width, N/m


def main(amounts=RELIEFS, loads=LOADS):
    """Peak-to-peak transmission error by relief, in micrometres, over the load in N/mm."""
    wheels = sg.WheelPair(sg.Wheel(23, 4e-3, face_width=FACE), sg.Wheel(57, 4e-3, face_width=FACE))
    print(f"contact ratio {wheels.contact_ratio:.3f}")

    # Straight teeth under an even load: one slice is the whole face.
    teeth = [Slices(PlaneTeeth(wheel), FACE, 1) for wheel in (wheels.first, wheels.second)]
    steel = [side.plane.elasticity for side in teeth]
    law = LineContact(tuple(steel), tuple(side.depth for side in teeth))

    error = {}
    for amount in amounts:
        # by default relief begins where a second pair of teeth comes in
        tips = [reliefs(wheels, k, ReliefTable(tip=amount))[0] for k in (0, 1)]
        shapes = tuple(FlankShape(face_width=FACE, tip=tip) for tip in tips)
        pair = CylindricalPair(wheels, tuple(teeth), law, shapes, slices=1)
        base = wheels.first.base
        cycles = [mesh_cycle(pair, load * FACE * base, base, 1) for load in loads]
        error[amount] = 1e6 * np.array([cycle.peak_to_peak for cycle in cycles])
        least = int(error[amount].argmin())
        print(
            f"relief {1e6 * amount:2.0f} um: least error {error[amount][least]:.2f} um "
            f"at {loads[least] / 1e3:.0f} N/mm"
        )
    return {"load": loads / 1e3, "error": error}


if __name__ == "__main__":
    main()
