"""How a seat is tied to its bearing moves a stubby pinion more than beam against solid does.

It illustrates how to:

* make a variant of a scene,
* compare the three attachments on one model.
"""

from pathlib import Path

import solidgear as sg

GEOMETRY = Path(__file__).parent.parent / "geometry"


def main():
    scene = sg.load(GEOMETRY / "pinion_overhung.toml")
    found = {}
    for attachment in ("average", "section", "rigid"):
        # Two rigid seats may share no material: the lumped point keeps its own tie.
        bearings = [b.with_changes(attachment=attachment) for b in scene.bearings]
        variant = scene.with_changes(bearings=tuple(bearings))
        body = sg.build(variant, "harmonic", order=4, layers=2)
        found[attachment] = sg.modes(body, variant, n=4).named("bending 1").frequency_hz
        print(f"{attachment:8s} first bending {found[attachment]:8.1f} Hz")
    return found


if __name__ == "__main__":
    main()
