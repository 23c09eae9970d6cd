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
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.modes.modes import train_modes
from solidgear.trains.response.drive import Drive

GEOMETRY = Path(__file__).parent.parent / "geometry"


def main():
    """First bending mode of the gear by both, and the mesh force at 700 Hz."""
    train = sg.load_train(GEOMETRY / "axle_overhung.toml")
    assembly = Assembly(train, settings={"harmonic": {"order": 2}})
    first, force = {}, {}
    for gear in ("timoshenko", "harmonic"):
        found = train_modes(assembly, "timoshenko", gear, max_frequency=1000.0)
        first[gear] = next(m.frequency_hz for m in found.modes if m.name == "gear bending 1")
        drive = Drive(assembly, "timoshenko", gear)
        force[gear] = float(abs(drive.mesh(np.array([700.0]))[1][0]))
        print(f"gear {gear}: bending at {first[gear]:.0f} Hz, {force[gear]:.0f} N at 700 Hz")
    for line in found.remarks():
        print(line)
    return first, force


if __name__ == "__main__":
    main()
