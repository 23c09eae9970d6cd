"""Opening of natural frequencies of a train by spin, from the modes at rest.

Every shaft adds a coupling times the turns of that shaft (:mod:`solidgear.core.solve.spin`); the sense in which
shafts turn is left out, so that the contributions of two of them are added up.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from solidgear.core import LADDER, System, as_supports
from solidgear.core.judge.at_rest import opened_words
from solidgear.core.solve.spin import couplings, opened
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.meshes import mesh_bars
from solidgear.trains.modes.naming import mode_names


def fastest_turns(assembly: Assembly) -> float:
    """Return the turns in a second of the engine's shaft at the fastest operating point; zero where
    none has a speed.
    """
    train = assembly.train
    speeds = [point.speed_of(train.reference, train.turns) or 0.0 for point in train.operation]
    return max(map(abs, speeds), default=0.0) / (2 * np.pi)


def spin_cautions(
    assembly: Assembly,
    system: System,
    models: Mapping[str, str],
    limit: float,
    turns: float | None = None,
) -> list[str]:
    """Return a sentence on the modes up to a limit, Hz, that spin opens by more than the error bar
    of the meshes, or the tolerance of the file; none without a speed. Turns of the engine's
    shaft in a second are by default those at the fastest operating point.
    """
    train, turns = assembly.train, turns or fastest_turns(assembly)
    count = int((system.elastic[0] <= 2 * np.pi * limit).sum())
    if not turns or not count:
        return []
    modes = system.modes(count)
    hz, shapes = modes.frequency_hz[modes.rigid :], modes.shapes[:, modes.rigid :]
    coupling = np.zeros((len(hz), len(hz)))
    for side, model in models.items():
        if model not in LADDER.bodies or side not in system.parts:
            continue
        body = assembly.shaft_model(side, model).body
        fields = system.expand(side, shapes)
        mode_fields = [{b: field[:, k] for b, field in fields.items()} for k in range(len(hz))]
        coupling_of_shaft = couplings(body, as_supports(assembly.scenes[side]), mode_fields)
        if coupling_of_shaft is not None:
            coupling += abs(train.turns[side] * turns * coupling_of_shaft)
    opening = opened(hz, coupling, 1.0)
    names = mode_names(assembly, system, modes)[modes.rigid :]
    bars = mesh_bars(assembly, system, models, count)
    bars_by_name = {} if bars is None else dict(zip(names, map(float, bars)))
    speed_text = f"at {60 * turns:.6g} rpm of the {train.reference}"
    return opened_words(
        dict(zip(names, opening / hz)), bars_by_name, train.ask.tolerance, speed_text
    )
