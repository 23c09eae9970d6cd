"""How sure a solid is of itself: error bars, from meshes each finer in everything that limits them.

It illustrates how to:

* study one model alone,
* read the error bar of each quantity.
"""

from pathlib import Path

import solidgear as sg
from solidgear.core.judge.study import study
from solidgear.core.judge.ties import SCENE

GEOMETRY = Path(__file__).parent.parent / "geometry"


def main():
    scene = sg.load(GEOMETRY / "pinion_overhung.toml")
    found = study(scene, "harmonic", evidence=False)
    bars = found.error_bars[SCENE]
    for name in ("C_zz", "C_thx", "bending 1"):
        print(f"{name:10s} {found.quantities[name]:.5g}, sure to {100 * bars[name].width:.2g} %")
    print(f"{len(found.levels)} meshes, the last with {found.body.size} unknowns")
    return {name: bar.width for name, bar in bars.items()}


if __name__ == "__main__":
    main()
