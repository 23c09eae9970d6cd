"""Lumped models of first bending: which pairs of masses exist, and how far each is off.

It illustrates how to:

* condense stiffness and masses to the lumped point,
* see that total mass on static stiffness is no first bending.
"""

from pathlib import Path

import solidgear as sg

GEOMETRY = Path(__file__).parent.parent / "geometry"


def main():
    scene = sg.load(GEOMETRY / "pinion_overhung.toml")
    body = sg.build(scene, "timoshenko")
    modes = sg.modes(body, scene, n=6)
    point, models = sg.synthesise(body, scene, scene.port.name, modes)
    print(f"a static shape holds {100 * point.static_share:.0f} % of the energy of first bending")
    found = {}
    for name, model in models.items():
        found[name] = model.frequency_error if model.feasible else None
        text = f"{100 * model.frequency_error:+.2g} %" if model.feasible else model.verdict
        print(f"{name:13s} {text}")
    return found


if __name__ == "__main__":
    main()
