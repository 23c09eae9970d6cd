"""Seconds from a train file to its modes and its response, answers compared first.

python -m validation.axle_speed
"""

from __future__ import annotations

from time import perf_counter

import numpy as np

import solidgear as sg
from solidgear.studies.axle.models import Workshop
from solidgear.studies.axle.respond import Drive
from solidgear.system.links import BearingSpring
from solidgear.system.system import System
from validation.common import ROOT, results_folder, show, write_rows

RUNS, FREQUENCIES = 5, 4000
MIXES = (("harmonic", "harmonic"), ("timoshenko", "timoshenko"), ("lumped/timoshenko",) * 2)
MESHES = {4: {"harmonic": {"order": 4}}, 3: {"harmonic": {"order": 3}}}


def timed(function, runs: int = RUNS):
    """What a function gives, and its median time, s."""
    seconds = []
    for _ in range(runs):
        start = perf_counter()
        out = function()
        seconds.append(perf_counter() - start)
    return out, float(np.median(seconds))


def everything(drive: Drive, hz: np.ndarray) -> None:
    """Mesh force, transmission error, all reactions and both motions."""
    drive.mesh(hz)
    drive.reactions(hz)
    for end in ("pinion.pinion", "gear.gear"):
        drive.motion(hz, drive.system.motion(end))


def another_set(drive: Drive, factor: float) -> Drive:
    """The same reduced shafts with one bearing stiffer."""
    links = dict(drive.system.links)
    spring = links["pinion.1"]
    assert isinstance(spring, BearingSpring)
    links["pinion.1"] = BearingSpring(spring.at, factor * spring.stiffness)
    out = Drive(drive.workshop, *drive.rungs)
    out.system = System(drive.system.parts, links)
    out.steady = type(drive.steady)(out.system, drive.steady.loss)
    return out


def main() -> None:
    """Measure, and show the table."""
    train = sg.load_train(ROOT / "geometry" / "axle_overhung.toml")
    hz = np.linspace(1.0, 4000.0, FREQUENCIES)
    finest = Workshop(train, settings={"harmonic": {"order": 5}}).system("harmonic", "harmonic")
    exact = finest.modes(8).frequency_hz[1:]
    sg.build(train.pinion.scene, "harmonic", order=2)  # libraries are loaded
    rows = []
    for mix in MIXES:
        for order, mesh in MESHES.items() if mix[0] == "harmonic" else ((0, {}),):

            def built(mix=mix, mesh=mesh):
                shop = Workshop(train, settings=mesh)
                return Drive(shop, *mix)

            drive, making = timed(built, 3 if order else RUNS)
            error = np.abs(drive.system.modes(8).frequency_hz[1:] / exact - 1).max()
            _, modal = timed(lambda d=drive: everything(Drive(d.workshop, *d.rungs), hz))
            _, further = timed(lambda d=drive: everything(another_set(d, 1.1), hz))
            name = f"{mix[0]}, order {order}" if order else mix[0]
            rows.append(
                {
                    "both shafts": name,
                    "modes against order 5": f"{error:.1e}",
                    "file to system s": making,
                    f"{FREQUENCIES} frequencies, all reactions s": modal,
                    "a further set of bearings s": further,
                }
            )
    write_rows(results_folder("axle_speed") / "seconds.csv", rows)
    show("A train, from its file to its response", rows)


if __name__ == "__main__":
    main()
