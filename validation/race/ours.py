"""solidgear's own lanes: one scene to compliance and modes, seconds by stage, in this process or in
one of its own.
"""

from __future__ import annotations

import gc
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any

from validation.race.heat import Clock, Heat, Lane, Sample
from validation.race.process import called

# Torsion is free in the scene: a peer's stiffness matrix would be singular, so both sides get the
# same spring (about that of a coupling).
TORSION = 1e6  # N m/rad


@dataclass(frozen=True)
class Run:
    """One run: what was clocked, the numbers, and the body they came from; no compliance where the
    shaft is free.
    """

    sample: Sample
    compliance: Any
    stiffness: Any
    modes: Any
    body: Any


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
    """A fresh body, its factor, the compliance at the lumped point and its modes, as a user would
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
    from solidgear.core.solve.shifted import factors

    gc.collect()
    clock, static = Clock(), None
    with _assembly_seconds(fidelity) as assembly:
        body = clock.stage("mesh", lambda: sg.build(scene, fidelity, **options))
    clock.stages |= {"mesh": clock.stages["mesh"] - assembly[0], "assembly": assembly[0]}
    clock.stage("factor", lambda: factors(body))
    if not free:
        static = clock.stage("loads", lambda: sg.condense(body, scene, scene.port.name))
    found = clock.stage("modes", lambda: sg.modes(body, () if free else scene, n=modes))
    sample = clock.sample(found, unknowns=body.size)
    numbers = (static.compliance, static.stiffness) if static else (None, None)
    return Run(sample, *numbers, found, body)


@contextmanager
def _assembly_seconds(fidelity: str) -> Iterator[list[float]]:
    """Seconds a solid spends in its matrices, as a list of one; zero for other bodies, where mesh
    and assembly are one stage.
    """
    spent = [0.0]
    if fidelity != "solid":
        yield spent
        return
    from solidgear.core.models.solid import block, parity

    def timed(plain):
        def taking(*args, **kwargs):
            start = time.perf_counter()
            try:
                return plain(*args, **kwargs)
            finally:
                spent[0] += time.perf_counter() - start

        return taking

    # of hexahedra around the axis, and of all other meshes
    makers = [(parity, "matrices_by_images"), (block, "_matrices")]
    plain = [getattr(module, name) for module, name in makers]
    for (module, name), maker in zip(makers, plain):
        setattr(module, name, timed(maker))
    try:
        yield spent
    finally:
        for (module, name), maker in zip(makers, plain):
            setattr(module, name, maker)


def mine(heat: Heat, who: str, scene, fidelity, options, *, free: bool = False, **more) -> Lane:
    """A lane in this process: a fresh body each time."""
    return heat.add(who, lambda: solve(scene, fidelity, options, free=free).sample, **more)


def whole(heat: Heat, who: str, scene, attachment, fidelity, options, **more) -> Lane:
    """A lane of a whole process: imports, the scene, and all of it."""
    job = {"scene": str(scene), "attachment": attachment}
    job |= {"fidelity": fidelity, "options": options}
    call = partial(called, "validation.race.ours:answered", limit=heat.limit, **job)

    def once() -> Sample:
        done = call()
        return Sample({"whole process": done.wall}, done.cpu)

    return heat.add(who, once, **more)


def answered(scene: str, attachment: str, fidelity: str, options: dict) -> dict:
    """What a process of its own answers, as plain data."""
    from solidgear.core.machine.threads import pin

    pin()
    done = solve(held(scene, attachment), fidelity, options)
    frequency = done.modes.frequency_hz.tolist()
    return {"compliance": done.compliance.tolist(), "frequency_hz": frequency}
