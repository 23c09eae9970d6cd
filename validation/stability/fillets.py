"""What a fillet changes: compliances and first bending of a stepped shaft, against a sharp shoulder.

D134 over 68 mm on D90, 276 mm in all, on the bearings of the overhung pinion at 96 and 246 mm, the
lumped point on a surface from 14 to 34 mm.  The harmonic solid, order 5.
"""

from __future__ import annotations

import solidgear as sg
from solidgear import Port, Scene, Segment
from solidgear.core.judge.quantities import change
from solidgear.core.judge.solving import solve
from solidgear.core.scene import Chamfer, Fillet
from validation.shipped import GEOMETRY

SHARES = (0.0, 0.02, 0.05, 0.10)
NAMES = ("C_zz", "C_thx", "bending 1", "torsion 1")


def shaft(*blends) -> Scene:
    """The shaft with some fillets or chamfers at 68 mm."""
    pinion = sg.load(GEOMETRY / "pinion_overhung.toml")
    parts = [
        Segment.cylinder("head", length=0.068, diameter=0.134),
        Segment.cylinder("shaft", length=0.208, diameter=0.09, y0=0.068),
    ]
    bearings = [b.with_changes(y=y) for b, y in zip(pinion.bearings, (0.096, 0.246))]
    port = Port(y=0.024, lo=0.014, hi=0.034)
    steel = pinion.material
    # a fillet of 9 mm would run into a seat of 40 mm
    bearings = [b.with_changes(seat_width=0.036) for b in bearings]
    return Scene.from_parts(parts, steel, bearings, port, blends=blends)


def values(scene: Scene, layers: int) -> dict[str, float]:
    """Quantities of one scene."""
    found = solve(scene, "harmonic", order=5, layers=layers, edge_layers=2)
    return found.quantities


def main() -> None:
    """Print the effects."""
    sharp = values(shaft(), 5)
    print(f"{'r / d':>16}" + "".join(f"{name:>12}" for name in NAMES))
    for share in SHARES[1:]:
        for blend in (
            Fillet(name="f", y=0.068, radius=share * 0.09),
            Chamfer(name="c", y=0.068, length=share * 0.09),
        ):
            found = values(shaft(blend), 2)
            row = (100 * (change(found, sharp, name) or 0.0) for name in NAMES)
            print(f"{blend.kind:>10}{share:6.2f}" + "".join(f"{x:+11.2f}%" for x in row))


if __name__ == "__main__":
    main()
