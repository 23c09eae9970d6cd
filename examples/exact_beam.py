"""An exact beam beside finite elements: the initial-parameter method on a stepped shaft.

It illustrates how to:

* take spans and stations from a scene,
* check a finite element body against roots of a determinant that share no code with it.
"""

from pathlib import Path

import solidgear as sg
from validation.thesis.krylov import from_scene, krylov

GEOMETRY = Path(__file__).parent.parent / "geometry"


def main():
    scene = sg.load(GEOMETRY / "shaft_stepped.toml").with_attachment("section")
    exact = krylov(*from_scene(scene), n=3).frequency_hz
    # The exact beam has no rotary inertia.
    body = sg.build(scene, "euler", rotary_inertia=False, elements=80)
    modes = [m for m in sg.modes(body, scene, n=8).modes if m.family == "bending"]
    gaps = [m.frequency_hz / f - 1 for m, f in zip(modes, exact, strict=False)]
    for frequency, gap in zip(exact, gaps, strict=True):
        print(f"{frequency:10.3f} Hz, finite elements {gap:+.1e}")
    return {"worst": max(map(abs, gaps))}


if __name__ == "__main__":
    main()
