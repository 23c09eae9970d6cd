"""Whole processes: the main job and the quickest useful answer, commands beside another checkout, and
one answer through the API whose caller imported numpy before.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from functools import partial
from pathlib import Path

import numpy as np

from validation.race.checkouts import answering, comparing, training
from validation.race.heat import Check, Heat, Sample
from validation.race.process import ALONE, ROOT, called, run
from validation.race.race import Race

SCENE = str(ROOT / "geometry" / "pinion_overhung.toml")


def whole_process(command: list[str]) -> Sample:
    """A command from start to end, in a folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        done = run([sys.executable, *command], Path(folder), extra={"PYTHONPATH": str(ROOT)})
    return Sample({"all": done.wall}, done.cpu)


def main_job(heat: Heat) -> None:
    """Commands beside the import of numpy; seconds asked for are those on two cores."""
    program = ["-m", "solidgear.app"]
    jobs: dict[str, tuple[list[str], float | None]] = {
        "solidgear --help": (["--help"], None),
        "stiffness -f timoshenko": (["stiffness", SCENE, "-f", "timoshenko"], None),
        "stiffness -f harmonic": (["stiffness", SCENE, "-f", "harmonic"], 3.0),
        "compare": (["compare", SCENE, "--out", "."], 60.0),
    }
    base = heat.add("import numpy", partial(whole_process, ["-c", "import numpy"]))
    for name, (command, within) in jobs.items():
        if not (heat.quick and name == "compare"):
            lane = heat.add(name, partial(whole_process, program + command), within=within)
            heat.ratio(f"{name} / import numpy", lane, base)


def answer() -> dict:
    """The second harmonic answer of a process in which numpy has opened its pools."""
    np.linalg.svd(np.ones((300, 300)))
    import time

    import solidgear as sg

    scene = sg.load(SCENE)
    for _ in range(2):
        start, cpu = time.perf_counter(), time.process_time()
        body = sg.build(scene, "harmonic")
        stiffness = sg.condense(body, scene, "pinion").stiffness
        found = sg.modes(body, scene, 10).frequency_hz
        seconds = time.perf_counter() - start
    numbers = [float(stiffness[2, 2]), *found.tolist()]
    return {"seconds": seconds, "cpu": time.process_time() - cpu, "numbers": numbers}


@contextmanager
def busy() -> Iterator[None]:
    """A process beside that keeps a processor busy."""
    child = subprocess.Popen([sys.executable, "-c", "while True: pass"])
    try:
        yield
    finally:
        child.kill()
        child.wait()


def pools(heat: Heat, beside: Callable = nullcontext) -> None:
    """Thread pools as numpy opens them and as set by hand, against one thread from the start."""

    def once(variables: dict[str, str]) -> Sample:
        with beside():
            extra = dict.fromkeys(ALONE) | variables
            found = called("validation.race.commands:answer", extra=extra).answer
        return Sample({"answer": found["seconds"]}, found["cpu"], np.array(found["numbers"]))

    base = heat.add("one thread", partial(once, {"OPENBLAS_NUM_THREADS": "1"}))

    def apart(found: np.ndarray) -> float:
        # torsion is free: its frequency is rounding
        return (abs(found - base.answer) / abs(base.answer).clip(min=1.0)).max()

    same = Check("numbers", apart, 1e-9, "the same solution")
    ways = {"numpy first": {}, "OMP_NUM_THREADS=2": {"OMP_NUM_THREADS": "2"}}
    for name, variables in ways.items():
        lane = heat.add(name, partial(once, variables), checks=[same])
        heat.ratio(f"one thread / {name}: no more than 1.2 times", base, lane, 1 / 1.2)


COMMANDS = Race(
    "whole commands, start-up included, beside another checkout",
    {"main": main_job, "compare": comparing, "answer": answering, "trains": training},
)
THREADS = Race(
    "a harmonic answer through the API, by thread pools of numpy",
    {"as it is": pools, "one processor busy": partial(pools, beside=busy)},
    rounds=5,
)
