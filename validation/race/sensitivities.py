"""All derivatives of a shaft beside one more solution of it: processor seconds, in one run."""

from __future__ import annotations

import time
from functools import partial

import solidgear as sg
from validation.common import ROOT
from validation.race.heat import Clock, Heat, Sample
from validation.race.race import Race

SCENES = ("pinion_overhung", "shaft_stepped", "intermediate_shaft")


def derivatives(heat: Heat) -> None:
    """Every number of the file, of first bending and C_zz, against building and solving once."""

    def clocked(name: str, model: str) -> Sample:
        file = ROOT / "geometry" / f"{name}.toml"
        scene, clock = sg.load(file), Clock()

        def solved() -> None:
            body = sg.build(scene, model)
            sg.condense(body, scene, port=scene.port.name)
            sg.modes(body, scene, n=scene.ask.modes)

        solved()  # what is read and compiled at first is nobody's
        start = time.process_time()
        clock.stage("one solution", solved)
        between = time.process_time()
        # which solves once as well
        clock.stage("solved and derived", lambda: sg.sensitivities(file, model, coarser=False))
        end = time.process_time()
        solve, both = between - start, end - between
        ratio = (both - solve) / solve
        facts = {"cpu s of a solution": solve, "of all derivatives": both - solve, "ratio": ratio}
        return clock.sample(**facts)

    for name in SCENES:
        for model in ("harmonic", "timoshenko"):
            heat.add(f"{name}, {model}", partial(clocked, name, model))


SENSITIVITIES = Race(
    "all derivatives of a shaft beside one more solution", {"derivatives": derivatives}
)
