"""How far what bends a tooth reaches along the face: slices beside teeth in 3D.

    python -m validation.tooth_spread

A slope of the mate's flank presses on places of equal radius over the whole face of one wheel, through
what a line contact gives way by under 300 N/mm.  Compared is the load on the last slice, which decides
the face load factor, for wheels of several counts, widths and rims, at three heights of the tooth: the
length of the layer in slices with which it is that of teeth in 3D, and the difference with the usual
one.  Rows go to validation/results/tooth_spread.json; two minutes of processor time.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from solidgear.core.gears.wheel import Wheel
from solidgear.teeth.compliance.flank import FlankCompliance
from solidgear.teeth.compliance.plane import PlaneTeeth
from solidgear.teeth.compliance.slices import SPREAD, Slices
from solidgear.teeth.compliance.solid import SolidTeeth
from solidgear.teeth.contact.local import Elasticity, LineContact
from validation.common import kept

MODULE, LOAD = 4e-3, 3e5
#: teeth, face width and rim below the root in modules
WHEELS = (
    (17, 5.0, 3.0),
    (23, 5.0, 4.0),
    (23, 10.0, 4.0),
    (30, 7.5, 4.0),
    (30, 7.5, 1.5),
    (40, 5.0, 4.0),
    (60, 3.0, 4.0),
    (100, 5.0, 4.0),
    (100, 10.0, 4.0),
    (-60, 6.0, 2.0),
)
#: modules beyond the reference circle, towards the tip
HEIGHTS = (-0.4, 0.0, 0.6)
#: slices per module of face
SLICES = 2


def end_load(teeth: FlankCompliance, r: float, z: np.ndarray, step: float) -> float:
    """Return the load on the last slice under a slope that opens the face by 1 m at its end, N."""
    law = LineContact((Elasticity(), Elasticity()), (teeth.depth, teeth.depth))
    surface = law.compliances(LOAD, 2 * MODULE)[0] / 2 / step
    matrix = teeth.matrix(np.zeros(len(z), int), np.full(len(z), r), z)
    return float(np.linalg.solve(matrix + surface * np.eye(len(z)), z / z.max())[-1])


def compared(wheel: Wheel, solid: SolidTeeth, plane: PlaneTeeth, height: float) -> dict[str, float]:
    """Return the length of the layer at a height of the tooth in modules, and by how much the load on
    the end is off with the usual one.
    """
    r = wheel.radius + wheel.sign * (height + wheel.shift) * MODULE
    z, face = solid.middles, wheel.face_width
    step = face / len(z)
    expected = end_load(solid, r, z, step)

    def off(spread: float) -> float:
        return end_load(Slices(plane, face, len(z), spread=spread), r, z, step) / expected - 1

    return {"height": height, "spread": brentq(off, 0.3, 4.0, xtol=1e-3), "off": off(SPREAD)}


def main() -> None:
    """Solve all wheels, print and keep the rows."""
    rows = []
    for count, face, rim in WHEELS:
        shift = 0.2 if 0 < count < 20 else 0.0
        wheel = Wheel(count, MODULE, shift=shift, face_width=face * MODULE)
        hold = wheel.root - wheel.sign * rim * MODULE
        solid = SolidTeeth(wheel, hold=hold, slices=round(SLICES * face))
        plane = PlaneTeeth(wheel, hold=hold)
        for height in HEIGHTS:
            row = {"teeth": count, "face": face, "rim": rim}
            row |= compared(wheel, solid, plane, height)
            rows.append(row)
            print({name: round(value, 3) for name, value in row.items()}, flush=True)
    spreads, off = (np.array([row[name] for row in rows]) for name in ("spread", "off"))
    total = {
        "mean": float(spreads.mean()),
        "deviation": float(spreads.std()),
        "largest off": float(np.abs(off).max()),
    }
    print(total)
    kept("tooth_spread", {"rows": rows, "all": total})


if __name__ == "__main__":
    main()
