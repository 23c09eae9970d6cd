"""solidgear's own lanes: one scene to compliance and modes, seconds by stage, in this process or in
one of its own.

As a process:  python ours.py job.json   (a job: scene, fidelity, options, modes; the answer goes to standard output)
"""

from __future__ import annotations

import gc
import json
import sys
import time
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

# Torsion is free in the scene: a peer's stiffness matrix would be singular, so both sides get the
# same spring (about that of a coupling).
TORSION = 1e6  # N m/rad


@dataclass(frozen=True)
class Run:
    """One run: ``stages`` in wall seconds, ``cpu`` seconds in all, the numbers, and the body they
    came from.
    """

    stages: dict[str, float]
    cpu: float
    unknowns: int
    compliance: object
    stiffness: object
    modes: object
    body: object


def held(path, attachment: str):
    """The scene with torsion held at every bearing and its seats attached as asked; the lumped
    point stays averaged.
    """
    import numpy as np

    import solidgear as sg

    scene = sg.load(path)
    bearings = []
    for bearing in scene.bearings:
        k = np.array(bearing.matrix)
        k[4, 4] += TORSION
        bearings.append(bearing.with_changes(matrix=k, attachment=attachment))
    return scene.with_changes(bearings=tuple(bearings))


def solve(scene, fidelity: str, options: dict, modes: int = 10, *, free: bool = False) -> Run:
    """A fresh body, its factor, the compliance at the lumped port and its modes, as a user would
    call for them.

    Parameters
    ----------
    scene : Scene
    fidelity : str
    options : dict
        Of the builder.
    modes : int
    free : bool
        Modes of the free shaft and no loads.
    """
    import solidgear as sg
    from solidgear.solve.statics import factors

    gc.collect()
    cpu, clock = time.process_time(), [time.perf_counter()]
    with _assembly_seconds(fidelity) as assembly:
        body = sg.build(scene, fidelity, **options)
    clock.append(time.perf_counter())
    factors(body)
    clock.append(time.perf_counter())
    at_port = None if free else sg.condense(body, scene, scene.port.name)
    clock.append(time.perf_counter())
    found = sg.modes(body, () if free else scene, n=modes)
    clock.append(time.perf_counter())
    build, factor, loads, shapes = (b - a for a, b in zip(clock, clock[1:]))
    stages = {
        "mesh": build - assembly[0],
        "assembly": assembly[0],
        "factor": factor,
        "loads": loads,
        "modes": shapes,
    }
    cpu = time.process_time() - cpu
    return Run(
        stages,
        cpu,
        body.size,
        None if free else at_port.compliance,
        None if free else at_port.stiffness,
        found,
        body,
    )


def free(body, modes: int = 10):
    """Modes of a body without supports."""
    import solidgear as sg

    return sg.modes(body, (), n=modes)


@contextmanager
def _assembly_seconds(fidelity: str):
    """Seconds a solid spends in its matrices, as a list of one; zero for other bodies, where mesh
    and assembly are one stage.
    """
    spent = [0.0]
    if fidelity != "solid":
        yield spent
        return
    from solidgear.models.solid import block as solid_block

    plain = solid_block._matrices

    def timed(*args, **kwargs):
        start = time.perf_counter()
        try:
            return plain(*args, **kwargs)
        finally:
            spent[0] += time.perf_counter() - start

    solid_block._matrices = timed
    try:
        yield spent
    finally:
        solid_block._matrices = plain


def whole(
    path, attachment: str, fidelity: str, options: dict, modes: int = 10, *, limit: float = 900.0
) -> tuple[dict, float]:
    """Wall seconds (as the one stage) and processor seconds of a process that imports, loads the
    scene and solves it.
    """
    import tempfile

    from validation.peers.process import run

    with tempfile.TemporaryDirectory(prefix="ours-") as name:
        job = Path(name) / "job.json"
        job.write_text(
            json.dumps(
                {
                    "scene": str(path),
                    "attachment": attachment,
                    "fidelity": fidelity,
                    "options": options,
                    "modes": modes,
                }
            )
        )
        root = str(Path(__file__).resolve().parents[2])
        seconds, cpu, _ = run(
            [sys.executable, str(Path(__file__).resolve()), str(job)],
            Path(name),
            limit=limit,
            extra={"PYTHONPATH": root},
        )
    return {"whole process": seconds}, cpu


def _child(path: str) -> None:
    from solidgear.machine.threads import pin

    pin()
    job = json.loads(Path(path).read_text())
    done = solve(
        held(job["scene"], job["attachment"]), job["fidelity"], job["options"], job["modes"]
    )
    print(
        json.dumps(
            {
                "compliance": done.compliance.tolist(),
                "frequency_hz": done.modes.frequency_hz.tolist(),
            }
        )
    )


if __name__ == "__main__":
    _child(sys.argv[1])
