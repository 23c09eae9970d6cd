"""Stiffness of teeth in plane strain beside ISO 6336-1 and a published pair.

    python -m validation.tooth_stiffness

Specific stiffness of spur pairs under 300 N/mm, in N/(mm um): the largest of a single pair of teeth and
the mean over the cycle, by finite elements of solid wheels without the motion of their bodies, and by
the norm: its theory, and that times 0.8, which measurements ask for.

The pair of twice 20 teeth, module 10 mm, face 30 mm, 200 GPa is published with 3.6228e8 N/m for a single
and 6.5072e8 N/m for a double pair, as scripts for ROSS quote it; whether bodies are in them is not said
there.  Of its mass, 6.57 kg, a bore of 67 mm follows, 5.4 modules below the roots.  With the body held
there ours is softer, without the body stiffer; the published double pair is 1.80 times the single one,
ours there 1.42 times, and 1.75 times where teeth do not know of each other.
Rows go to validation/results/tooth_stiffness.json; some 10 s of processor time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.core.gears.norm import norm_stiffness
from solidgear.core.gears.wheel import Wheel
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.teeth.compliance.plane import PlaneTeeth
from solidgear.teeth.compliance.slices import Slices
from solidgear.teeth.contact.cycle import mesh_cycle
from solidgear.teeth.contact.cylindrical import CylindricalPair
from solidgear.teeth.contact.local import Elasticity, LineContact
from validation.common import kept

MODULE, FACE, LOAD = 4e-3, 20e-3, 3e5
#: teeth of both wheels and profile shift of the first
PAIRS = ((23, 57, 0.0), (20, 40, 0.0), (17, 103, 0.145), (40, 40, 0.0), (62, 62, 0.0))
#: holds of the published pair, modules below the root
HOLDS = (2.0, 4.0, 4.5, 5.4, 6.0)
STEEL = Elasticity()
POSITIONS = 64
UNIT = 1e9


@dataclass(frozen=True, eq=False)
class Loose(Slices):
    """Teeth of which each gives way under its load alone."""

    def matrix(self, tooth: np.ndarray, r: np.ndarray, z: np.ndarray) -> np.ndarray:
        return np.where(tooth[:, None] == tooth, super().matrix(tooth, r, z), 0.0)


def stiffness(
    wheels: WheelPair,
    kind: type[Slices] = Slices,
    elasticity: Elasticity = STEEL,
    hold: float | None = None,
) -> dict[str, float]:
    """Return the stiffness over the cycle on the path alone, by the number of lines that carry, N/m:
    of wheels that are held some modules below the roots with their bodies, of solid wheels without.
    """
    teeth = [
        kind(
            PlaneTeeth(
                wheel,
                hold=None if hold is None else wheel.root - hold * wheel.module,
                elasticity=elasticity,
                body=hold is not None,
            ),
            wheels.face_width,
            1,
        )
        for wheel in (wheels.first, wheels.second)
    ]
    law = LineContact((elasticity, elasticity), (teeth[0].depth, teeth[1].depth))
    pair = CylindricalPair(wheels, (teeth[0], teeth[1]), law, slices=1, beyond=0.0)
    torque = LOAD * wheels.face_width * wheels.first.base
    cycle = mesh_cycle(pair, torque, wheels.first.base, 1, positions=POSITIONS)
    lines = np.array([len(position.shares) for position in cycle.positions])
    return {
        "single least": float(cycle.secant[lines == 1].min()),
        "single": float(cycle.secant[lines == 1].max()),
        "double least": float(cycle.secant[lines == 2].min()),
        "double": float(cycle.secant[lines == 2].max()),
        "mean": float(cycle.secant.mean()),
    }


def main() -> None:
    """Solve all pairs, print and keep the rows."""
    rows = []
    for first, second, shift in PAIRS:
        wheels = WheelPair(
            Wheel(first, MODULE, shift=shift, face_width=FACE),
            Wheel(second, MODULE, face_width=FACE),
        )
        solved = stiffness(wheels)
        norm = norm_stiffness(wheels)
        row = {"teeth": f"{first}/{second}", "contact ratio": wheels.contact_ratio}
        row |= {name: value / FACE / UNIT for name, value in solved.items()}
        row |= {
            "norm, theory": norm.theoretical / UNIT,
            "norm, single": norm.single / UNIT,
            "norm, mean": norm.mesh / UNIT,
        }
        rows.append(row)
        print({name: v if isinstance(v, str) else round(v, 2) for name, v in row.items()})
    published = []
    softer = Elasticity(2e11)
    wheel = Wheel(20, 10e-3, face_width=30e-3)
    for hold in (*HOLDS, None):
        for kind in (Slices, Loose):
            solved = stiffness(WheelPair(wheel, wheel), kind, softer, hold)
            row = {"hold": hold, "coupled": kind is Slices, **solved}
            published.append(row)
            print(row)
    kept("tooth_stiffness", {"norm": rows, "published": published})


if __name__ == "__main__":
    main()
