"""Re-bearing sweep against separate runs: how much faster, and how far apart.

    python -m validation.sweep_speed [--samples 20] [--models timoshenko,harmonic,solid] [--fine]

A *separate run* is what a user would do instead, without start-up of Python: build the body with
the seats of that variant alone, condense, solve modes. Its time is the median over a sample spread
over the sweep and is multiplied by the number of variants. Differences are taken twice: against the
direct solution on the mesh of the sweep (what the reduction costs), and against the separate run,
whose mesh has its own seats only (that plus the error of the two meshes).  ``--fine`` adds the
harmonic solid at order 8.
"""

from __future__ import annotations

import argparse
import csv
import statistics
import tempfile
import time
from pathlib import Path

import numpy as np

import solidgear as sg
from solidgear.studies.sweep import sweep
from solidgear.studies.sweep.run import variants_of
from validation.common import ROOT, results_folder, show, write_rows

STIFFNESS = ["bearing.1.kzz=log:8e9:1e11:10", "bearing.2.scale=log:0.1:10:10"]
PLACES = ["bearing.2.position=0.2102453:0.2462453:10"]
CASES = {
    "timoshenko": ("timoshenko", {}, PLACES + STIFFNESS),
    "harmonic": ("harmonic", {}, PLACES + STIFFNESS),
    "solid": ("solid", {}, ["bearing.1.kyy=log:1e8:1e10:10"] + STIFFNESS),
    "harmonic order 8": (
        "harmonic",
        {"order": 8, "layers": 4, "edge_layers": 2},
        ["bearing.2.position=0.2262453,0.2462453"] + STIFFNESS,
    ),
}
MODES = 10


def solve(body, supports):
    """Compliances and frequencies, twins twice."""
    static, modes = sg.condense(body, supports, port="pinion"), sg.modes(body, supports, MODES)
    shapes = [
        m.frequency_hz for m in modes.modes if m.frequency_hz > 0 for _ in range(m.multiplicity)
    ]
    return static, np.array(shapes[:MODES])


def apart(row, static, frequency):
    """Largest relative difference of compliances (diagonal) and of frequencies."""
    swept = np.array([float(row[f"C_{name}"]) for name in ("xx", "yy", "zz", "thx", "thz")])
    c = np.abs(swept / np.diag(static.compliance)[[0, 1, 2, 3, 5]] - 1).max()
    return c, np.abs(
        np.array([float(row[f"f{k}_hz"]) for k in range(1, MODES + 1)]) / frequency - 1
    ).max()


def case(name: str, samples: int) -> dict:
    fidelity, options, axes = CASES[name]
    scene = sg.load(ROOT / "geometry" / "pinion_overhung.toml")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "rows.csv"
        start = time.perf_counter()
        summary = sweep(scene, axes, path, fidelity=fidelity, options=options, n=MODES)
        whole = time.perf_counter() - start
        with path.open(newline="") as f:
            rows = [row for row in csv.DictReader(f) if row["status"] == "ok"]
    variants = variants_of(scene, axes)
    picked = [
        rows[i] for i in np.unique(np.linspace(0, len(rows) - 1, samples).round().astype(int))
    ]
    shared = sg.build(variants.shaft(), fidelity, **options)
    seconds, same, own = [], [], []
    for row in picked:
        variant, supports = variants.supports(int(row["variant"]))
        start = time.perf_counter()
        separate = solve(sg.build(variant, fidelity, **options), variant)
        seconds.append(time.perf_counter() - start)
        own.append(apart(row, *separate))
        same.append(apart(row, *solve(shared, supports)))
    each = statistics.median(seconds)
    same_c, same_f = np.max(same, axis=0)
    own_c, own_f = np.max(own, axis=0)
    return {
        "model": name,
        "variants": summary.total,
        "refused": summary.refused,
        "in full": summary.full,
        "seats": summary.seats,
        "unknowns": summary.unknowns,
        "basis": summary.basis,
        "once s": round(summary.seconds_once, 2),
        "each ms": round(1e3 * summary.seconds_each, 2),
        "sweep s": round(whole, 2),
        f"separate s (median of {len(picked)})": round(each, 3),
        "times faster": round(each * summary.total / whole, 1),
        "same mesh C": float(same_c),
        "same mesh f": float(same_f),
        "largest bound f": max(float(row["error_bound"]) for row in rows),
        "own mesh C": float(own_c),
        "own mesh f": float(own_f),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--samples", type=int, default=20)
    parser.add_argument("--models", default="timoshenko,harmonic,solid")
    parser.add_argument(
        "--fine", action="store_true", help="the harmonic solid at order 8 too (minutes)"
    )
    asked = parser.parse_args()
    names = [m.strip() for m in asked.models.split(",") if m.strip()] + [
        "harmonic order 8"
    ] * asked.fine
    rows = []
    for name in names:
        rows.append(case(name, asked.samples))
        show("re-bearing sweep", [{"": key, "value": value} for key, value in rows[-1].items()])
    write_rows(results_folder("sweep_speed") / "rows.csv", rows)


if __name__ == "__main__":
    main()
