"""A shaft without a file: a free cylinder against the closed form of a slender beam.

It illustrates how to:

* write a scene in Python from segments,
* leave out bearings: rigid motions are exact zeros,
* hold a result against a formula.
"""

import math

import solidgear as sg

LENGTH, DIAMETER = 0.6, 0.02


def main():
    rod = sg.Segment.cylinder("rod", length=LENGTH, diameter=DIAMETER)
    scene = sg.Scene.from_parts([rod])
    steel = sg.STEEL

    # Free-free Euler beam: (4.73 / L)^2 sqrt(E I / rho A) / 2 pi, and sqrt(I / A) = d / 4.
    slender = (4.730041 / LENGTH) ** 2 * math.sqrt(steel.E / steel.density) * DIAMETER / 4
    formula = slender / (2 * math.pi)

    found = {"formula": formula}
    for model in ("euler", "timoshenko", "harmonic"):
        modes = sg.modes(sg.build(scene, model), scene, n=2)
        found[model] = modes.named("bending 1").frequency_hz
        print(f"{model:11s} {found[model]:9.3f} Hz, {modes.evidence['rigid_modes']} at rest")
    print(f"{'formula':11s} {formula:9.3f} Hz")
    return found


if __name__ == "__main__":
    main()
