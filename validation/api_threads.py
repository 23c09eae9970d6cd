"""What a program pays that imports numpy before solidgear: one harmonic answer through the API.

    python -m validation.api_threads [--runs 5]

A child process builds the overhung pinion as a harmonic solid, condenses it and solves ten modes.
It is run with the thread pools that numpy opens by itself, with OMP_NUM_THREADS=2, and with one
thread in OpenBLAS from the start, in turns, on the machine as it is and beside a process that
keeps a processor busy.  Asked: the first two within 1.2 times the last.  Answers are compared
first.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys

from validation.common import ROOT, results_folder, show, write_rows

ANSWER = """
import json, time
import numpy
numpy.linalg.svd(numpy.ones((300, 300)))
import solidgear as sg
scene = sg.load("geometry/pinion_overhung.toml")
def once():
    start = time.perf_counter()
    body = sg.build(scene, "harmonic")
    stiffness = sg.condense(body, scene, "pinion").stiffness
    found = sg.modes(body, scene, 10).frequency_hz
    return time.perf_counter() - start, [stiffness[2, 2], *found]
once()
print(json.dumps(once()))
"""
VARIABLES = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
WAYS = {
    "numpy first": {},
    "OMP_NUM_THREADS=2": {"OMP_NUM_THREADS": "2"},
    "one thread": {"OPENBLAS_NUM_THREADS": "1"},
}


def run(variables: dict[str, str]) -> tuple[float, list[float]]:
    """Seconds and numbers of one answer."""
    env = {k: v for k, v in os.environ.items() if k not in VARIABLES}
    command = [sys.executable, "-c", ANSWER]
    done = subprocess.run(
        command,
        env=env | variables | {"PYTHONPATH": str(ROOT)},
        cwd=ROOT,
        check=True,
        capture_output=True,
        text=True,
    )
    seconds, numbers = json.loads(done.stdout.splitlines()[-1])
    return seconds, numbers


def measured(runs: int) -> dict[str, float]:
    """Median seconds of every way, run in turns."""
    seconds: dict[str, list[float]] = {name: [] for name in WAYS}
    first: list[float] = []
    for _ in range(runs):
        for name, variables in WAYS.items():
            spent, numbers = run(variables)
            first = first or numbers
            far = max(abs(a - b) / max(abs(b), 1.0) for a, b in zip(numbers, first))
            if far > 1e-9:
                raise SystemExit(f"{name}: another answer, {far:.1e} off")
            seconds[name].append(spent)
    return {name: statistics.median(s) for name, s in seconds.items()}


def main() -> int:
    """Command line; the exit code is 1 if a ratio is above 1.2."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--runs", type=int, default=5)
    runs = parser.parse_args().runs
    rows = []
    for beside in ("as it is", "one processor busy"):
        busy = None
        if beside != "as it is":
            busy = subprocess.Popen([sys.executable, "-c", "while True: pass"])
        try:
            found = measured(runs)
        finally:
            if busy is not None:
                busy.kill()
                busy.wait()
        base = found["one thread"]
        for name, seconds in found.items():
            ratio = seconds / base
            rows.append(
                {"machine": beside, "pools": name, "s": f"{seconds:.3f}", "ratio": f"{ratio:.2f}"}
            )
    show(f"one harmonic answer through the API, {runs} runs in turns", rows)
    write_rows(results_folder("api_threads") / "rows.csv", rows)
    return int(any(float(row["ratio"]) > 1.2 for row in rows))


if __name__ == "__main__":
    sys.exit(main())
