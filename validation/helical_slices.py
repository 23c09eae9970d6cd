"""Slices of helical teeth beside teeth in 3D, by helix angle and width of the face: 29 on 47 teeth of 2.5
mm, 10 N m a millimetre of face, both wheels discs as wide as their face.  Some five minutes.

    python validation/helical_slices.py
"""

from __future__ import annotations

from math import radians

from solidgear.core.gears.wheel import Wheel
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.teeth.contact.cycle import MeshCycle, mesh_cycle
from solidgear.teeth.contact.cylindrical import CylindricalPair
from solidgear.teeth.contact.local import Elasticity, LineContact
from solidgear.teeth.train_teeth import TeethModel, WheelBody

#: helix angle in degrees, face width in mm
CASES = ((0, 25), (5, 25), (15, 25), (20, 10), (20, 25), (20, 50), (30, 12), (30, 25), (30, 50))
STEEL = Elasticity()


def cycle(model: TeethModel, helix: float, width: float) -> MeshCycle:
    """Solve a mesh cycle without shafts; degrees, mm."""
    first, second = (
        Wheel(count, 2.5e-3, radians(helix), shift, face_width=1e-3 * width)
        for count, shift in ((29, 0.3), (47, 0.1))
    )
    teeth = tuple(
        model.compliance(wheel, WheelBody(STEEL, None, hand, wheel.face_width, 0.0))
        for wheel, hand in ((first, 1), (second, -1))
    )
    law = LineContact((STEEL, STEEL), (teeth[0].depth, teeth[1].depth))
    pair = CylindricalPair(WheelPair(first, second), (teeth[0], teeth[1]), law, slices=model.slices)
    return mesh_cycle(pair, 10.0 * width, first.base, model.slices, positions=model.positions)


def main() -> None:
    print("helix deg, face mm: tangent N/um, error pp um, KHb by slices; in 3D; stiffer")
    for helix, width in CASES:
        slices, solid = (
            cycle(TeethModel(name, 16, 8), helix, width)  # type: ignore[arg-type]
            for name in ("slices", "solid")
        )
        numbers = [
            f"{1e-6 * c.tangent.mean():.4g} {1e6 * c.peak_to_peak:.3g} {c.face_load_factor:.3f}"
            for c in (slices, solid)
        ]
        off = slices.tangent.mean() / solid.tangent.mean() - 1
        print(f"{helix:>3} {width:>3}: {'; '.join(numbers)}; {100 * off:+.1f} %", flush=True)


if __name__ == "__main__":
    main()
