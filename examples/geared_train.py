"""A geared rotor from its file, with the ring gear as a beam and as a solid.

It illustrates how to:

* read a train of two shafts, and give each a model of its own,
* see named modes of the whole, with what is not published and how sure the reduction is,
* ask for the dynamic mesh force at a frequency.

The ring gear of this rotor is a flat plate.  As a beam it keeps its shape, and the modes in which it
bends come out too high.
"""

from pathlib import Path

import numpy as np

import solidgear as sg

GEOMETRY = Path(__file__).parent.parent / "geometry"


def main():
    """First bending mode of the gear by both, and the mesh force at 700 Hz."""
    train = sg.load_train(GEOMETRY / "axle_overhung.toml")
    first, force = {}, {}
    for gear in ("timoshenko", "harmonic"):
        models = {"pinion": "timoshenko", "gear": gear}
        found = sg.system_modes(train, models, max_frequency=1000.0)
        first[gear] = found["gear bending 1"].frequency_hz
        response = sg.response(train, models, max_frequency=1000.0).responses[0]
        force[gear] = float(abs(np.interp(700.0, response.frequency_hz, response.force)))
        print(f"gear {gear}: bending at {first[gear]:.0f} Hz, {force[gear]:.0f} N at 700 Hz")
    for line in found.solved.remarks():
        print(line)
    return first, force


if __name__ == "__main__":
    main()
