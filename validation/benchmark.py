"""Seconds and peak memory of the main job and of the quickest useful answer, as whole processes.

    python -m validation.benchmark [--runs 5]

Figures asked for on two cores: compare within 60 s, harmonic stiffness within 3 s, start-up
included.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time

from validation.common import ROOT, results_folder, show, write_rows

SCENE = str(ROOT / "geometry" / "pinion_overhung.toml")
JOBS = {
    "import numpy": ([sys.executable, "-c", "import numpy"], None),
    "solidgear --help": ([sys.executable, "-m", "solidgear.cli", "--help"], None),
    "stiffness --fidelity timoshenko": (
        [sys.executable, "-m", "solidgear.cli", "stiffness", SCENE, "--fidelity", "timoshenko"],
        None,
    ),
    "stiffness --fidelity harmonic": (
        [sys.executable, "-m", "solidgear.cli", "stiffness", SCENE, "--fidelity", "harmonic"],
        3.0,
    ),
    "compare": ([sys.executable, "-m", "solidgear.cli", "compare", SCENE, "--out"], 60.0),
}


def run(command: list[str]) -> float:
    """Wall seconds of one whole process."""
    env = {**os.environ, "PYTHONPATH": str(ROOT)}
    with tempfile.TemporaryDirectory() as folder:
        if command[-1] == "--out":
            command = [*command, folder]
        start = time.perf_counter()
        subprocess.run(
            command, env=env, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        return time.perf_counter() - start


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--runs", type=int, default=5)
    runs = parser.parse_args().runs
    times: dict[str, list[float]] = {name: [] for name in JOBS}
    for _ in range(runs):
        # interleaved, so that a noisy spell of the machine hits every job alike
        for name, (command, _) in JOBS.items():
            times[name].append(run(command))
    base = statistics.median(times["import numpy"])
    rows = [
        {
            "job": name,
            "median s": round(statistics.median(t), 3),
            "min s": round(min(t), 3),
            "max s": round(max(t), 3),
            "over import numpy": round(statistics.median(t) / base, 1),
            "asked s": JOBS[name][1],
        }
        for name, t in times.items()
    ]
    show(f"whole processes, {runs} interleaved runs", rows)
    write_rows(results_folder("benchmark") / "rows.csv", rows)


if __name__ == "__main__":
    main()
