"""What smearing teeth into their pitch cone costs, and what a smaller cone with the missing mass
costs.

    python -m validation.teeth [--quick]

The head of the overhung pinion with teeth of several counts, proportions and spiral angles, by one
sector, against cones drawn as sectors with the same sizes of elements, so that errors of the mesh
cancel in part. The lumped point follows the mean motion of the head's material. The second cone
runs above the roots by a fifth of the tooth and carries on the lumped point the mass and inertia
that it lacks. Rows go to validation/results/teeth/.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass

import numpy as np

import solidgear as sg
from solidgear.cuts.features import Teeth
from solidgear.cuts.sector.body import sector
from validation.common import ROOT, results_folder, write_rows

#: share of the depth of a tooth, above its root, at which the stiffest like cone runs
STIFF = 0.2
#: count, addendum, dedendum, spiral angle in degrees; the second line has the heights of bevel teeth
#: taken square to the cone, times the cosine of its angle
CASES = (
    (14, 1.0, 1.2, 0),
    (14, 0.9245, 1.1094, 0),
    (14, 1.0, 1.2, 35),
    (14, 0.6, 0.7, 0),
    (10, 1.0, 0.9, 0),
    (20, 1.0, 1.2, 0),
    (20, 1.0, 1.2, 35),
    (30, 1.0, 1.2, 0),
    (45, 1.0, 1.2, 0),
)
QUICK = CASES[:1]


@dataclass
class Numbers:
    """Of one model of the head."""

    quantities: dict[str, float]
    mass: np.ndarray
    coupling: float


def numbers(scene: sg.Scene, count: int, refinement: float) -> Numbers:
    """Compliance, modes and rigid mass of a scene by a sector."""
    body = sector(scene, refinement=refinement, count=count, material_port=True)
    c = sg.condense(body, scene, "pinion").compliance
    modes = sg.modes(body, scene, n=9)
    out = {"C_zz": c[2, 2], "C_thx": c[3, 3]}
    for name in ("bending 1", "bending 2", "torsion 1", "axial 1"):
        found = modes.named(name)
        assert found is not None, name
        out[name] = found.frequency_hz
    free = _free_flexibility(body)
    coupling = free[1, 4] / np.sqrt(free[1, 1] * free[4, 4])
    return Numbers(out, body.mass_matrix(), float(coupling))


def _free_flexibility(body) -> np.ndarray:
    """(6, 6) of the lumped point with all motions of the last bearing held."""
    firm = {f"k{c}{c}": 1e12 for c in "xyz"} | {f"kth{c}": 1e12 for c in "xyz"}
    last = body.ports[-1]
    held = sg.Bearing(name=last.name, y=last.y, seat_width=0.04, stiffness=firm)
    return sg.condense(body, [held], "pinion").compliance


def cone(scene: sg.Scene, share: float) -> sg.Scene:
    """The plain scene with its head scaled across."""
    segments = tuple(
        s.with_changes(outer0=share * s.outer0, outer1=share * s.outer1) if s.name == "head" else s
        for s in scene.segments
    )
    return scene.plain.with_changes(segments=segments)


def lacking(scene: sg.Scene, lack: np.ndarray) -> sg.PointMass:
    """The rigid mass of a 6 x 6 matrix about the origin, on the lumped point."""
    mass = lack[0, 0]
    centre = lack[2, 3] / mass
    tilt = lack[3, 3] - mass * centre**2
    return sg.PointMass(
        name="teeth",
        mass=mass,
        inertia=[tilt, lack[4, 4], tilt],
        offset=[0.0, centre - scene.port.y, 0.0],
        on="pinion",
    )


def measured(cases, refinement: float):
    """One row a case and a model."""
    pinion = sg.load(ROOT / "geometry" / "pinion_overhung.toml")
    for count, addendum, dedendum, spiral in cases:
        teeth = Teeth(
            name="teeth",
            segment="head",
            count=count,
            addendum=addendum,
            dedendum=dedendum,
            spiral_angle=f"{spiral} deg",
        )
        truth = numbers(pinion.with_changes(features=(teeth,)), count, refinement)
        share = teeth.root + STIFF * (teeth.tip - teeth.root)
        small = cone(pinion, share)
        plain = numbers(pinion, count, refinement)
        bare = sector(small, refinement=refinement, count=count, material_port=True)
        extra = lacking(small, truth.mass - bare.mass_matrix())
        heavy = numbers(small.with_changes(masses=(extra,)), count, refinement)
        case = {"count": count, "addendum": addendum, "dedendum": dedendum, "spiral": spiral}
        for model, one in (("pitch cone", plain), (f"cone {share:.3f} + mass", heavy)):
            row = {**case, "model": model}
            for name, value in one.quantities.items():
                row[name] = value / truth.quantities[name] - 1
            row["mass"] = plain.mass[0, 0] / truth.mass[0, 0] - 1
            row["polar inertia"] = plain.mass[4, 4] / truth.mass[4, 4] - 1
            row["coupling y, thy"] = truth.coupling
            yield row


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="one case on a coarse mesh")
    quick = parser.parse_args().quick
    rows = []
    for row in measured(QUICK if quick else CASES, 0.5 if quick else 1.4):
        rows.append(row)
        print(
            ", ".join(
                f"{k} {v:+.2e}" if isinstance(v, float) else f"{k} {v}" for k, v in row.items()
            ),
            flush=True,
        )
    write_rows(results_folder("teeth") / "rows.csv", rows)


if __name__ == "__main__":
    main()
