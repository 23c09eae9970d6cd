"""Seconds from a train file to its modes and its response, answers compared first.

python -m validation.axle_speed
"""

from __future__ import annotations

from time import perf_counter, process_time

import numpy as np

import solidgear as sg
from solidgear.studies.train.models import JUDGE, Workshop
from solidgear.studies.train.respond import Drive
from validation.common import ROOT, results_folder, show, write_rows

AXLE = ROOT / "geometry" / "axle_overhung.toml"
RUNS, FREQUENCIES = 5, 4000
SETS, CHECKED, EVERY = 1000, 10, 40
MIXES = (("harmonic", "harmonic"), ("timoshenko", "timoshenko"), ("lumped/timoshenko",) * 2)
MESHES = {4: {"harmonic": {"order": 4}}, 3: {"harmonic": {"order": 3}}}


def timed(function, runs: int = RUNS):
    """What a function gives, its median time and its median processor time, s: on a machine with
    other work the second is what the program itself took.
    """
    seconds, used = [], []
    for _ in range(runs):
        start, processor = perf_counter(), process_time()
        out = function()
        seconds.append(perf_counter() - start)
        used.append(process_time() - processor)
    return out, float(np.median(seconds)), float(np.median(used))


def one_by_one(drive: Drive, hz: np.ndarray) -> np.ndarray:
    """(f,) mesh force, N, every frequency eliminated by itself, without any modes."""
    factor, error = drive.steady.factor("mesh", hz), drive.error.orders[0]
    unit = drive.steady.solved(hz, drive.load, drive.row[None])[:, 0]
    return drive.stiffness * factor * (unit * error * factor - error)


def bearing_sets(drive: Drive, count: int) -> list[dict[str, np.ndarray]]:
    """Sets of all bearings of a train, each scaled by a factor of its own from a half to two."""
    draw = np.random.default_rng(1)
    scenes = drive.workshop.scenes
    own = {f"{s}.{b.name}": np.array(b.stiffness) for s in scenes for b in scenes[s].bearings}
    return [
        {name: 2 ** draw.uniform(-1, 1) * matrix for name, matrix in own.items()}
        for _ in range(count)
    ]


def another_set(drive: Drive, bearings: dict[str, np.ndarray]) -> Drive:
    """The same reduced shafts on other bearings."""
    return Drive(drive.workshop.with_bearings(bearings), *drive.rungs)


def thousand(train, hz: np.ndarray, count: int) -> dict:
    """Seconds of many sets, every one with all reactions, and how far some are from the reference."""
    drive = Drive(Workshop(train), JUDGE, JUDGE)
    sets = bearing_sets(drive, count)
    worst = 0.0
    for chosen in sets[:: max(1, count // CHECKED)]:
        other = another_set(drive, chosen)
        found = other.columns(hz)["mesh force [N]"][::EVERY]
        reference = one_by_one(other, hz[::EVERY])
        worst = max(worst, float(np.abs(found / reference - 1).max()))
    start, processor = perf_counter(), process_time()
    for chosen in sets:
        another_set(drive, chosen).columns(hz)
    seconds, used = perf_counter() - start, process_time() - processor
    return {
        "sets of bearings": count,
        "frequencies": len(hz),
        "wall s": seconds,
        "processor s": used,
        "s a set": used / count,
        "against elimination": f"{worst:.1e}",
    }


def main() -> None:
    """Measure, and show the table."""
    train = sg.load_train(AXLE)
    hz = np.linspace(1.0, 4000.0, FREQUENCIES)
    finest = Workshop(train, settings={"harmonic": {"order": 5}}).system("harmonic", "harmonic")
    exact = finest.modes(8).frequency_hz[1:]
    sg.build(train.pinion.scene, "harmonic", order=2)  # libraries are loaded
    rows = []
    for mix in MIXES:
        for order, mesh in MESHES.items() if mix[0] == "harmonic" else ((0, {}),):

            def built(mix=mix, mesh=mesh):
                shop = Workshop(sg.load_train(AXLE), settings=mesh)
                return Drive(shop, *mix)

            drive, making, used = timed(built, 3 if order else RUNS)
            error = np.abs(drive.system.modes(8).frequency_hz[1:] / exact - 1).max()
            _, modal, swept = timed(lambda d=drive: Drive(d.workshop, *d.rungs).columns(hz))
            chosen = bearing_sets(drive, 1)[0]
            _, further, _ = timed(lambda d=drive, b=chosen: another_set(d, b).columns(hz))
            name = f"{mix[0]}, order {order}" if order else mix[0]
            rows.append(
                {
                    "both shafts": name,
                    "modes against order 5": f"{error:.1e}",
                    "file to system s": making,
                    f"{FREQUENCIES} frequencies, all reactions s": modal,
                    "a further set of bearings s": further,
                    "scene to response, processor s": used + swept,
                }
            )
    write_rows(results_folder("axle_speed") / "seconds.csv", rows)
    show("A train, from its file to its response", rows)
    many = [thousand(train, hz, SETS)]
    write_rows(results_folder("axle_speed") / "sets.csv", many)
    show("Sets of bearings, both shafts solid, all reactions at all frequencies", many)


if __name__ == "__main__":
    main()
