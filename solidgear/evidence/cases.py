"""The cases of a chart of error against cost, and what a process pays once before the first of
them.
"""

from __future__ import annotations

import json
import logging
import subprocess
import sys
from typing import TYPE_CHECKING

from solidgear.evidence.pareto import Row

if TYPE_CHECKING:
    from solidgear.scene import Scene

log = logging.getLogger(__name__)


def plan(scene: Scene, full: bool = False) -> list[Row]:
    """Series of every family, uniform and graded, level by level.

    Parameters
    ----------
    scene : Scene
    full : bool
        More levels, up to solids of several hundred thousand unknowns.
    """
    size = max(max(s.outer0, s.outer1) for s in scene.segments) / 3
    least = min(min(s.outer0, s.outer1) for s in scene.segments)
    flat, even = {"layers": 0, "edge_layers": 0, "size": least}, {"size": size, "graded_size": size}
    orders, more = range(1, 7), (7, 8)
    hexes = {
        "hex8": ((0.65, 1.0, 1.5), (2.0, 2.6)),
        "hex20": ((0.35, 0.65, 1.0), (1.4, 1.9)),
        "hex27": ((0.35, 0.65, 0.85), (1.0, 1.4)),
    }
    even_hexes = {
        "hex8": ((1.0, 1.5, 2.2), (3.0, 3.8)),
        "hex20": ((0.5, 1.0, 1.5), (2.0, 2.8)),
        "hex27": ((0.5, 1.0, 1.3), (1.6, 2.2)),
    }
    tets = {"tet4": ((0.5, 0.8, 1.25), (1.8, 2.4)), "tet10": ((0.4, 0.6, 0.9), (1.2, 1.6))}
    even_tets = {"tet4": ((1.0, 1.8, 2.6), (3.4, 4.4)), "tet10": ((0.7, 1.3, 1.8), (2.4, 3.0))}

    def levels(pair):
        return pair[0] + (pair[1] if full else ())

    series: list[tuple[str, str, str, list[dict]]] = [
        ("lumped", "lumped", "lumped", [{}]),
        ("beam", "Euler", "euler", [{"elements": 1}, {}]),
        ("beam", "Timoshenko", "timoshenko", [{"elements": 1}, {}]),
        (
            "harmonic",
            "harmonic h uniform",
            "harmonic",
            [{"order": 2, **flat, "refinement": s} for s in levels(((0.5, 1.0, 2.0, 4.0), (8.0,)))],
        ),
        (
            "harmonic",
            "harmonic h graded",
            "harmonic",
            [
                {"order": 2, "layers": 4, "edge_layers": 2, "refinement": s}
                for s in levels(((0.5, 1.0, 2.0), (3.0,)))
            ],
        ),
        (
            "harmonic",
            "harmonic p uniform",
            "harmonic",
            [{"order": p, **flat} for p in levels((tuple(orders), more))],
        ),
        (
            "harmonic",
            "harmonic p graded",
            "harmonic",
            [{"order": p, "layers": 3, "edge_layers": 1} for p in levels((tuple(orders), more))],
        ),
    ]
    for grading, extra, steps in (("uniform", even, even_tets), ("graded", {}, tets)):
        series += [
            (
                "tetrahedra",
                f"{e.upper()} {grading}",
                "solid",
                [{"element": e, **extra, "refinement": s} for s in levels(pair)],
            )
            for e, pair in steps.items()
        ]
    for grading, extra, steps in (
        ("uniform", {**flat, "size": 0.6 * least, "radial_layers": 0}, even_hexes),
        ("graded", {}, hexes),
    ):
        series += [
            (
                "hexahedra",
                f"{e.upper()} {grading}",
                "solid",
                [{"element": e, **extra, "refinement": s} for s in levels(pair)],
            )
            for e, pair in steps.items()
        ]
    rows = [
        Row(family, name, k, model, options)
        for family, name, model, all_options in series
        for k, options in enumerate(all_options, start=1)
    ]
    return sorted(rows, key=lambda row: row.level)


_SETUP = """
import json, time
seconds, start = {}, time.perf_counter()
def lap(name):
    global start
    now = time.perf_counter()
    seconds[name], start = now - start, now
from solidgear.machine.threads import pin
pin()
import numpy, scipy.sparse.linalg, scipy.optimize
lap("numpy and scipy")
import solidgear.fidelity.harmonic, solidgear.fidelity.solid, solidgear.fidelity.beam, solidgear.solve.modes, solidgear.scene.file
lap("solidgear and scikit-fem")
try:
    import gmsh
    gmsh.initialize(["gmsh", "-noenv"], readConfigFiles=False)
    lap("gmsh, first use")
    import pypardiso
    pypardiso.PyPardisoSolver(mtype=2)
    lap("MKL, first use")
except Exception:
    pass
print(json.dumps(seconds))
"""


def setup_seconds() -> dict[str, float]:
    """What a fresh interpreter pays once before the first model, s by what for; empty where none
    can be started.
    """
    try:
        done = subprocess.run(
            [sys.executable, "-c", _SETUP], capture_output=True, text=True, timeout=120, check=True
        )
        return json.loads(done.stdout.splitlines()[-1])
    except (OSError, subprocess.SubprocessError, ValueError, IndexError) as error:
        log.info("set-up costs: %s", error)
        return {}
