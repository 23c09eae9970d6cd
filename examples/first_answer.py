"""First answer: stiffness at the gear and natural frequencies of a shaft from a file.

It illustrates how to:

* read a scene,
* build it by one model,
* condense it to its lumped point, and solve its modes on the bearings.
"""

from pathlib import Path

import solidgear as sg

GEOMETRY = Path(__file__).parent.parent / "geometry"


def main():
    # A scene holds what is modelled: segments, bearings and the point the gear is lumped to.
    scene = sg.load(GEOMETRY / "pinion_overhung.toml")

    # A body is the free shaft.  "harmonic" is exact elasticity of a body of revolution.
    body = sg.build(scene, "harmonic")

    # Bearings come in here: the 6x6 at the pinion, order x y z thx thy thz.
    at_pinion = sg.condense(body, scene, port="pinion")
    lateral = at_pinion.compliance[2, 2]

    modes = sg.modes(body, scene, n=6)
    print(f"one newton in z moves the pinion by {1e9 * lateral:.3f} nm")
    for mode in modes.modes:
        print(f"{mode.name:16s} {mode.frequency_hz:9.1f} Hz")
    return {"C_zz": lateral, "bending 1": modes.named("bending 1").frequency_hz}


if __name__ == "__main__":
    main()
