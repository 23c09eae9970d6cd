"""Re-bearing sweep against separate runs: how much faster, and how far apart.

A *separate run* is what a user would do instead, without start-up of Python: build the body with
the seats of that variant alone, condense, solve modes. Its time is the median over a sample spread
over the sweep and is multiplied by the number of variants. Differences are taken twice: against the
direct solution on the mesh of the sweep (what the reduction costs), and against the separate run,
whose mesh has its own seats only (that plus the error of the two meshes).
"""

from __future__ import annotations

import csv
import functools
import statistics
import tempfile
import time
from functools import partial
from pathlib import Path

import numpy as np

import solidgear as sg
from solidgear.variants.sweep.bearing_task import bearing_task
from solidgear.variants.sweep.bearing_variants import bearing_variants
from solidgear.variants.sweep.file_task import run
from validation.common import ROOT
from validation.race.heat import Check, Clock, Heat, Sample
from validation.race.process import spent
from validation.race.race import Race

STIFFNESS = ["bearing.1.kzz=log:8e9:1e11:10", "bearing.2.scale=log:0.1:10:10"]
#: counted from bearing 1, as in the file
PLACES = ["bearing.2.position=0.114:0.15:10"]
CASES = {
    "timoshenko": ("timoshenko", {}, PLACES + STIFFNESS),
    "harmonic": ("harmonic", {}, PLACES + STIFFNESS),
    "solid": ("solid", {}, ["bearing.1.kyy=log:1e8:1e10:10"] + STIFFNESS),
    "harmonic order 8": (
        "harmonic",
        {"order": 8, "layers": 4, "edge_layers": 2},
        ["bearing.2.position=0.13,0.15"] + STIFFNESS,
    ),
}
MODES = 10
COMPLIANCES = ("xx", "yy", "zz", "thx", "thz")


def solve(body, supports):
    """Compliances and frequencies, twins twice."""
    static, modes = sg.condense(body, supports, port="pinion"), sg.modes(body, supports, MODES)
    shapes = [
        m.frequency_hz for m in modes.modes if m.frequency_hz > 0 for _ in range(m.multiplicity)
    ]
    return static, np.array(shapes[:MODES])


def apart(row, static, frequency) -> tuple[float, float]:
    """Largest relative difference of compliances (diagonal) and of frequencies."""
    compliance = np.array([float(row[f"C_{name}"]) for name in COMPLIANCES])
    swept = np.array([float(row[f"f{k}_hz"]) for k in range(1, MODES + 1)])
    diagonal = np.diag(static.compliance)[[0, 1, 2, 3, 5]]
    return np.abs(compliance / diagonal - 1).max(), np.abs(swept / frequency - 1).max()


def model(heat: Heat, name: str) -> None:
    """One sweep, and runs of some of its variants."""
    fidelity, options, axes = CASES[name]
    variants = bearing_variants(ROOT / "geometry" / "pinion_overhung.toml", axes)

    def swept() -> Sample:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "rows.csv"
            clock = Clock()
            found = clock.stage(
                "sweep",
                lambda: run(bearing_task(variants, model=fidelity, options=options, n=MODES), path),
            )
            sample = clock.sample()
            with path.open(newline="") as f:
                sample.answer = [row for row in csv.DictReader(f) if row["status"] == "ok"]
        for fact in ("total", "refused", "full", "seats", "unknowns", "basis", "seconds_each"):
            sample.facts[fact] = getattr(found, fact)
        sample.facts["largest bound f"] = max(float(r["reduction_bound"]) for r in sample.answer)
        return sample

    once = heat.add("one sweep", swept)

    def picked() -> list[dict]:
        rows = once.answer
        count = 3 if heat.quick else int(heat.settings["samples"])
        return [
            rows[i] for i in np.unique(np.linspace(0, len(rows) - 1, count).round().astype(int))
        ]

    def separate() -> Sample:
        seconds, answers, before = [], [], spent()
        for row in picked():
            variant, _ = variants.supports(int(row["variant"]))
            start = time.perf_counter()
            answers.append(solve(sg.build(variant, fidelity, **options), variant))
            seconds.append(time.perf_counter() - start)
        total = once.samples[0].facts["total"]
        each = statistics.median(seconds)
        cpu = (spent() - before) / len(answers) * total
        return Sample({"all": each * total}, cpu, answers, {"each s": each, "sample": len(answers)})

    @functools.cache
    def on_the_shared_mesh() -> list:
        shared = sg.build(variants.shaft(), fidelity, **options)
        return [solve(shared, variants.supports(int(row["variant"]))[1]) for row in picked()]

    def far(answers: list, which: int) -> float:
        return max(apart(row, *found)[which] for row, found in zip(picked(), answers))

    checks = []
    for i, what in enumerate(("compliance", "frequencies")):
        shared = f"{what} on the mesh of the sweep"
        checks.append(Check(shared, lambda _, i=i: far(on_the_shared_mesh(), i)))
        checks.append(Check(f"{what} on a mesh of its own", partial(far, which=i)))
    runs = heat.add("separate runs, from a sample", separate, checks=checks)
    heat.ratio("separate runs / one sweep", runs, once)


SWEEP = Race(
    "one re-bearing sweep against separate runs",
    {name: partial(model, name=name) for name in CASES},
    rounds=1,
    settings={"samples": 20},
)
