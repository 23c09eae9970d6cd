"""Bearings: tangents a second, and the equilibrium of the axle on a body reduced to its ports."""

from __future__ import annotations

from functools import partial

import numpy as np

import solidgear as sg
from solidgear.bearings.ball import BallRow
from solidgear.bearings.roller import RollerRow
from solidgear.bearings.solved import solved
from solidgear.bearings.spinning import SpinningBalls
from solidgear.core.solve.statics import flexibility
from validation.race.heat import Clock, Heat, Sample
from validation.race.race import Race
from validation.thesis.bearings import axle

ANGULAR = BallRow(16, 22.225e-3, 125.26e-3, 0.698)
ROWS = {
    "16 balls": ANGULAR,
    "16 rollers in 30 slices": RollerRow(16, 12e-3, 0.1, length=18e-3, angle=0.26),
    "16 balls at 10,000 r/min": SpinningBalls(ANGULAR, 1047.0),
}
TOGETHER, ALONE = 2000, 100


def tangents(heat: Heat) -> None:
    """Many motions at once, and one at a time."""
    size = np.array([1e-5, 1e-5, 1e-5, 2e-4, 0, 2e-4])
    motions = np.random.default_rng(0).normal(size=(TOGETHER, 6)) * size

    def clocked(row) -> Sample:
        clock = Clock()
        clock.stage("together", lambda: row.tangent(motions))
        clock.stage("one by one", lambda: [row.tangent(motion) for motion in motions[:ALONE]])
        together, alone = clock.stages.values()
        rates = {"a second, together": TOGETHER / together, "a second, one by one": ALONE / alone}
        return clock.sample(**rates)

    for name, row in ROWS.items():
        heat.add(name, partial(clocked, row))


def equilibria(heat: Heat) -> None:
    """The axle on its bearings at load."""
    scene = axle("32218", 5e3, 20e3)

    def clocked(fidelity: str) -> Sample:
        clock = Clock()
        body = clock.stage("body", lambda: sg.build(scene, fidelity))
        # kept with the body: what is left is ports and contacts
        clock.stage("to its ports", lambda: flexibility(body))
        found = clock.stage("equilibrium", lambda: solved(scene, body))
        assert found.equilibrium is not None
        return clock.sample(iterations=found.equilibrium.iterations)

    for fidelity in ("timoshenko", "harmonic"):
        heat.add(fidelity, partial(clocked, fidelity), counted=["equilibrium"])


BEARINGS = Race(
    "tangents of bearings a second, and equilibria",
    {"tangents": tangents, "equilibrium": equilibria},
    rounds=5,
)
