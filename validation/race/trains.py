"""A train, from its file to its modes and its response, and a thousand sets of its bearings."""

from __future__ import annotations

from functools import partial

import numpy as np

import solidgear as sg
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.shaft import JUDGE
from solidgear.trains.response.drive import Drive
from validation.common import ROOT
from validation.race.heat import Check, Clock, Heat, Sample
from validation.race.race import Race

AXLE = ROOT / "geometry" / "axle_overhung.toml"
#: frequencies and sets of bearings, and those of a quick run
FREQUENCIES, SETS = (4000, 200), (1000, 10)
#: sets and frequencies that are compared with the elimination of each
CHECKED, EVERY = 10, 40
#: models of both shafts, and settings of their meshes
MIXES = {
    "harmonic, order 4": ("harmonic", {"harmonic": {"order": 4}}),
    "harmonic, order 3": ("harmonic", {"harmonic": {"order": 3}}),
    "timoshenko": ("timoshenko", {}),
    "lumped/timoshenko": ("lumped/timoshenko", {}),
}


def frequencies(heat: Heat) -> np.ndarray:
    """Hz, at which a train responds."""
    return np.linspace(1.0, 4000.0, FREQUENCIES[heat.quick])


def one_by_one(drive: Drive, hz: np.ndarray) -> np.ndarray:
    """(f,) mesh force, N, every frequency eliminated by itself, without any modes."""
    factor, error = drive.steady.factor("mesh", hz), drive.excitation.error.orders[0]
    unit = drive.steady.solved(hz, drive.load, drive.row[None])[:, 0]
    return drive.stiffness * factor * (unit * error * factor - error)


def bearing_sets(drive: Drive, count: int) -> list[dict[str, np.ndarray]]:
    """Sets of all bearings of a train, each scaled by a factor of its own from a half to two."""
    draw = np.random.default_rng(1)
    scenes = drive.assembly.scenes
    own = {f"{s}.{b.name}": np.array(b.stiffness) for s in scenes for b in scenes[s].bearings}
    return [
        {name: 2 ** draw.uniform(-1, 1) * matrix for name, matrix in own.items()}
        for _ in range(count)
    ]


def another_set(drive: Drive, bearings: dict[str, np.ndarray]) -> Drive:
    """The same reduced shafts on other bearings."""
    return Drive(drive.assembly.with_bearings(bearings), *drive.models)


def response(heat: Heat) -> None:
    """One lane a pair of models."""
    hz = frequencies(heat)
    finest = Assembly(sg.load_train(AXLE), settings={"harmonic": {"order": 5}})
    exact = finest.system("harmonic", "harmonic").modes(8).frequency_hz[1:]

    def clocked(model: str, mesh: dict) -> Sample:
        clock = Clock()
        drive = clock.stage(
            "file to system",
            lambda: Drive(Assembly(sg.load_train(AXLE), settings=mesh), model, model),
        )
        modes = drive.system.modes(8).frequency_hz[1:]
        again = Drive(drive.assembly, *drive.models)
        clock.stage(f"{len(hz)} frequencies, all reactions", lambda: again.columns(hz))
        chosen = bearing_sets(drive, 1)[0]
        clock.stage("a further set of bearings", lambda: another_set(drive, chosen).columns(hz))
        return clock.sample(modes)

    against = Check("modes against order 5", lambda modes: abs(modes / exact - 1).max())
    for name, (model, mesh) in MIXES.items():
        heat.add(name, partial(clocked, model, mesh), checks=[against])


def thousand(heat: Heat) -> None:
    """Many sets of bearings, both shafts solid, every one with all reactions."""
    hz, count = frequencies(heat), SETS[heat.quick]
    drive = Drive(Assembly(sg.load_train(AXLE)), JUDGE, JUDGE)
    sets = bearing_sets(drive, count)

    def clocked() -> Sample:
        clock = Clock()
        clock.stage("all", lambda: [another_set(drive, chosen).columns(hz) for chosen in sets])
        sample = clock.sample()
        sample.facts = {"sets": count, "frequencies": len(hz), "cpu s a set": sample.cpu / count}
        return sample

    def apart(_) -> float:
        worst = 0.0
        for chosen in sets[:: max(1, count // CHECKED)]:
            other = another_set(drive, chosen)
            found = other.columns(hz)["mesh force [N]"][::EVERY]
            worst = max(worst, abs(found / one_by_one(other, hz[::EVERY]) - 1).max())
        return worst

    checks = [Check("mesh force, against the elimination of each frequency", apart)]
    heat.add("harmonic", clocked, checks=checks)


TRAINS = Race(
    "a train from its file to its response, and a thousand sets of bearings",
    {"response": response, "sets": thousand},
)
