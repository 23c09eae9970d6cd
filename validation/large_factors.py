"""One 3D solid by every way to factor it: memory, time and the digits that two of its numbers share.

    python -m validation.large_factors [--size 0.018 --graded 0.0032] [--only double,single]

Every row is a process of its own. Memory is the peak of the factor beyond what the process held before it
(of all ranks together for PETSc, libraries included); seconds are of the wall, and of the processor where it is
this process that works.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from pathlib import Path

from validation.common import ROOT, results_folder, show, write_rows

WAYS = {
    "double": {},
    "single": {"precision": "single"},
    "out of core": {"out_of_core": True},
    "single, out of core": {"precision": "single", "out_of_core": True},
    "petsc, 1 rank": {"engine": "petsc", "ranks": 1},
    "petsc, 2 ranks": {"engine": "petsc", "ranks": 2},
    "gamg, 1 rank": {"engine": "petsc-gamg", "ranks": 1},
    "gamg, 2 ranks": {"engine": "petsc-gamg", "ranks": 2},
}


def _memory(name: str) -> float:
    """A line of the status of this process, MB."""
    text = Path("/proc/self/status").read_text()
    return int(text.split(f"{name}:")[1].split()[0]) / 1024


def _row(way: str, size: float, graded: float) -> dict:
    import numpy as np

    import solidgear as sg
    from solidgear.solve.statics import factors

    scene = sg.load(ROOT / "geometry" / "pinion_overhung.toml")
    mesh = {"element": "tet10", "size": size, "graded_size": graded}
    body = sg.build(scene, "solid", **mesh, **WAYS[way])
    # forget the peak of meshing
    Path("/proc/self/clear_refs").write_text("5")
    held = _memory("VmRSS")
    row = {"way": way, "unknowns": body.size}

    def timed(name, action):
        wall, own = time.perf_counter(), time.process_time()
        result = action()
        row[f"{name}, s"] = round(time.perf_counter() - wall, 2)
        row[f"{name}, s of the processor"] = round(time.process_time() - own, 2)
        return result

    factor = timed("factor", lambda: factors(body)[0])
    row["factor, MB"] = round(_memory("VmHWM") - held)
    rhs = body.blocks[0].mass @ np.random.default_rng(0).standard_normal((body.size, 8))
    timed("eight solutions", lambda: factor.solve(rhs))
    found = timed("statics", lambda: sg.condense(body, scene, scene.port.name))
    row["C_zz"] = float(found.compliance[2, 2])
    if "gamg" not in way:
        modes = timed("six modes", lambda: sg.modes(body, scene, n=6))
        row["bending 1"] = modes.named("bending 1").frequency_hz
    ranks = getattr(factor._solve, "__self__", None)
    if "rank" in way:
        row["factor, MB"] = round(ranks.peak_mb)
        row["iterations"] = ranks.steps
    return row


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--size", type=float, default=0.018, help="m, away from shoulders")
    parser.add_argument("--graded", type=float, default=0.0032, help="m, at shoulders")
    parser.add_argument("--only", default=",".join(WAYS).replace(", ", "+"), help="ways, by commas")
    parser.add_argument("--row", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.row:
        print(json.dumps(_row(given.row, given.size, given.graded)))
        return
    rows = []
    for way in given.only.split(","):
        way = way.replace("+", ", ")
        command = [sys.executable, "-m", "validation.large_factors", "--row", way]
        command += ["--size", str(given.size), "--graded", str(given.graded)]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            rows.append({"way": way, "failed": done.stderr.strip().splitlines()[-1]})
        else:
            rows.append(json.loads(done.stdout.splitlines()[-1]))
        print(rows[-1], flush=True)
        write_rows(results_folder("large_factors") / "rows.csv", rows)
    show("one 3D solid by every way to factor it", rows)


if __name__ == "__main__":
    main()
