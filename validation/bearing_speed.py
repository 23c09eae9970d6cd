"""How fast bearings are: tangents a second, and the equilibrium of the axle on a reduced body.

python -m validation.bearing_speed
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

import solidgear as sg
from solidgear.bearings.ball import BallRow
from solidgear.bearings.roller import RollerRow
from solidgear.bearings.solved import solved
from solidgear.bearings.spinning import SpinningBalls
from solidgear.solve.statics import flexibility
from validation.common import results_folder, show, write_rows
from validation.thesis.bearings import axle

ANGULAR = BallRow(16, 22.225e-3, 125.26e-3, 0.698)
ROWS = {
    "16 balls": ANGULAR,
    "16 rollers in 30 slices": RollerRow(16, 12e-3, 18e-3, 0.1, 0.26),
    "16 balls at 10,000 r/min": SpinningBalls(ANGULAR, 1047.0),
}


def best(work: Callable[[], object], runs: int = 5) -> float:
    """Median wall time of some runs, s."""
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return float(np.median(times))


def tangents() -> list[dict]:
    """Tangents a second, many motions at once and one at a time."""
    size = np.array([1e-5, 1e-5, 1e-5, 2e-4, 0, 2e-4])
    motions = np.random.default_rng(0).normal(size=(2000, 6)) * size
    rows = []
    for name, row in ROWS.items():
        together = best(lambda row=row: row.tangent(motions))
        alone = best(lambda row=row: [row.tangent(motion) for motion in motions[:100]])
        rows.append({"row": name, "a second, together": 2000 / together, "one by one": 100 / alone})
    return rows


def equilibria() -> list[dict]:
    """Wall time of the axle's equilibrium once its body is reduced to its ports."""
    rows = []
    for fidelity in ("timoshenko", "harmonic"):
        scene = axle("32218", 5e3, 20e3)
        body = sg.build(scene, fidelity)
        start = time.perf_counter()
        flexibility(body)  # kept with the body: what is left is ports and contacts
        reduced = time.perf_counter() - start
        found = solved(scene, body)
        assert found.equilibrium is not None
        rows.append(
            {
                "body": fidelity,
                "to its ports, ms": 1e3 * reduced,
                "equilibrium, ms": 1e3 * best(lambda s=scene, b=body: solved(s, b)),
                "iterations": found.equilibrium.iterations,
            }
        )
    return rows


def main() -> None:
    """Measure, print and keep."""
    for title, rows in (("tangents", tangents()), ("equilibrium of the axle", equilibria())):
        show(title, rows)
        write_rows(results_folder("bearing_speed") / f"{title.split()[0]}.csv", rows)


if __name__ == "__main__":
    main()
