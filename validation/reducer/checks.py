"""Checks of the motion in time: another integrator, two base frequencies, energy, and its cost."""

from __future__ import annotations

import time

import numpy as np

from validation.reducer.design import Design
from validation.reducer.dynamics import EVERY, RUNOUT, STEPS, Seen
from validation.reducer.independent import envelope
from validation.reducer.multibody import Reducer
from validation.reducer.sidebands import Stage
from validation.reducer.stepping import run
from validation.reducer.study import SETS

#: instants of a turn that are compared
INSTANTS = STEPS // EVERY


def checked(in_time: dict[str, Seen]) -> dict[str, float]:
    """Worst of everything, relative.

    ``envelope``: largest and least contact forces over a turn from rest, by both integrators, on two
    bearings.  ``sidebands``: amplitudes by two base frequencies and in time, of the main line of the
    mesh.  ``energy``: lost sight of, of what was passed back and forth, of all designs.  ``second``:
    processor seconds of a second at 8000 r/min on ideal joints.
    """
    bodies = Reducer(Design(), 2, runout=RUNOUT).bodies
    steps = run(bodies, STEPS, settling=0, every=EVERY).force[:, 0]
    known = envelope(bodies, 1.0, INSTANTS, 1e-6)
    worst = max(
        np.abs(side(steps, axis=0) / side(known, axis=0) - 1).max() for side in (np.max, np.min)
    )
    return {
        "envelope": float(worst),
        "sidebands": max(_sidebands(Stage(Reducer(Design(teeth=t)))) for t in SETS),
        "energy": max(float(np.abs(one.unbalanced).max()) for one in in_time.values()),
        "second": _second(),
    }


def _second() -> float:
    ideal = Reducer(Design(), 0).bodies
    turns = int(np.ceil(ideal.speed[0] / (2 * np.pi)))
    began = time.process_time()
    run(ideal, STEPS, turns=turns, settling=0, every=EVERY)
    return time.process_time() - began


def _sidebands(stage: Stage) -> float:
    both = stage.balance()
    lines = both.force_lines(both.solve())
    motion = run(stage.bodies, STEPS, every=EVERY)
    mesh, main = stage.reducer.orders["planetary"], np.abs(lines[1, 0]).min()
    off = [
        np.abs(motion.line(j * mesh + k)[0] - np.abs(line)).max()
        for (j, k), line in lines.items()
        if j and k
    ]
    return float(max(off) / main)
