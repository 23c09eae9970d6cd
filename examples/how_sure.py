"""How sure a solid is of itself: bands, from meshes each finer in everything that limits them.

It illustrates how to:

* study one model alone,
* read the band of each quantity.
"""

from pathlib import Path

import solidgear as sg
from solidgear.judge.study import study
from solidgear.judge.ties import SCENE

GEOMETRY = Path(__file__).parent.parent / "geometry"


def main():
    scene = sg.load(GEOMETRY / "pinion_overhung.toml")
    rung = study(scene, "harmonic", evidence=False)
    bands = rung.bands[SCENE]
    for name in ("C_zz", "C_thx", "bending 1"):
        print(f"{name:10s} {rung.quantities[name]:.5g}, sure to {100 * bands[name].gci:.2g} %")
    print(f"{len(rung.levels)} meshes, the last with {rung.body.size} unknowns")
    return {name: band.gci for name, band in bands.items()}


if __name__ == "__main__":
    main()
