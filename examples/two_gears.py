"""Two gears on one shaft: what one does when the other is pushed, and what the housing takes of it.

It illustrates how to:

* condense a shaft to two lumped points at once,
* read compliance and twist between them,
* put bearings into a stiffer or a rigid housing.
"""

from pathlib import Path

import solidgear as sg

GEOMETRY = Path(__file__).parent.parent / "geometry"


def main():
    scene = sg.load(GEOMETRY / "intermediate_shaft.toml")
    body = sg.build(scene, "harmonic", order=4, layers=1)
    both = sg.condense(body, scene, port=("wheel", "pinion"))
    push = 1e3 * both.between("wheel", "pinion")[2, 2]
    print(f"1 kN at the pinion moves the wheel by {1e6 * push:.2f} um")
    twist = both.between("wheel", "pinion", "stiffness")[4, 4]
    print(f"the shaft between them twists by 1 mrad under {-1e-3 * twist:.0f} N m")

    rigid = scene.with_changes(housing=None)  # the same body: bearings are not part of it
    bolted = sg.condense(body, rigid, port=("wheel", "pinion"))
    share = 1 - bolted.between("wheel", "wheel")[2, 2] / both.between("wheel", "wheel")[2, 2]
    print(f"{100 * share:.0f} % of the compliance at the wheel is that of the box on its feet")
    return {"push": float(push), "twist": float(-twist), "share": float(share)}


if __name__ == "__main__":
    main()
