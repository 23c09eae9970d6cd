"""How sure a solid is of itself: error bars, from meshes each finer in everything that limits them.

It illustrates how to:

* ask for numbers within a tolerance,
* read the error bar of each.
"""

from pathlib import Path

import solidgear as sg

GEOMETRY = Path(__file__).parent.parent / "geometry"


def main():
    pinion = GEOMETRY / "pinion_overhung.toml"
    found = sg.answer(pinion, "0.5 %", ["C_zz", "C_thx", "bending 1"])
    for value in found.values:
        print(f"{value.quantity:10s} {value.value:.5g}, sure to {100 * value.bar:.2g} %")
    meshes = [step for step in found.steps if step.unknowns]
    print(f"{len(meshes)} meshes, the last with {meshes[-1].unknowns} unknowns")
    return {str(value.quantity): value.bar for value in found.values}


if __name__ == "__main__":
    main()
