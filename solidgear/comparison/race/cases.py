"""Cases of a chart of error against cost, and the start-up cost of a process before the first one."""

from __future__ import annotations

import json
import logging
import subprocess
import sys
from typing import TYPE_CHECKING

from solidgear.comparison.race.pareto import AUTOMATIC, Row
from solidgear.core import LADDER
from solidgear.core.machine.patience import Patience

if TYPE_CHECKING:
    from solidgear.core import Scene

log = logging.getLogger(__name__)

#: name of the automatic choice among models in rows of a chart, and its tolerances
AUTO = "auto"
TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4)
#: s of processor time that a fresh interpreter may take for its imports
SETUP = 120.0


def plan(scene: Scene, full: bool = False) -> list[Row]:
    """List series of every family, uniform and graded, level by level, and the automatic choice by
    tolerances; of a model that does not fit the scene one row with the reason. With more levels
    when full, up to solids of several hundred thousand unknowns.
    """
    rows = [
        Row(family, label, level, model.name, options)
        for model in LADDER
        if not model.unfit(scene)
        for family, label, all_options in model.series(scene, full)
        for level, options in enumerate(all_options, start=1)
    ]
    unfit = ((model, model.unfit(scene)) for model in LADDER if model.concerns(scene))
    rows += [
        Row(model.family, model.heading, 1, model.name, {}, "failed", reason)
        for model, reason in unfit
        if reason
    ]
    rows += [
        Row(AUTOMATIC, AUTOMATIC, level, AUTO, {"tol": tol})
        for level, tol in enumerate(TOLERANCES, start=1)
    ]
    return sorted(rows, key=lambda row: row.level)


_SETUP = """
import json, time
seconds, start = {}, time.perf_counter()
def lap(name):
    global start
    now = time.perf_counter()
    seconds[name], start = now - start, now
from solidgear.core.machine.threads import pin
pin()
import numpy, scipy.sparse.linalg, scipy.optimize
lap("numpy and scipy")
import solidgear.core.models.harmonic.body, solidgear.core.models.solid.body, solidgear.core.models.beam.body
import solidgear.core.solve.modes, solidgear.core.scene.file
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
    """Measure the seconds that a fresh interpreter pays once before the first model, by purpose;
    empty where none can be started.
    """
    try:
        with subprocess.Popen(
            [sys.executable, "-c", _SETUP],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        ) as child:
            assert child.stdout is not None
            Patience(SETUP).wait(child)
            return json.loads(child.stdout.read().splitlines()[-1])
    except (OSError, ValueError, IndexError) as error:
        log.info("set-up costs: %s", error)
        return {}
