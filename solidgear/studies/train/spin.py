"""Opening of natural frequencies of a train by spin, from its modes at rest.

Every shaft adds its own coupling times its own turns (:mod:`solidgear.solve.spin`); the sense in which
shafts turn is left out, so that what two of them bring is added up.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from solidgear.body import as_supports
from solidgear.judge.at_rest import opened_words
from solidgear.ladder.registry import LADDER
from solidgear.solve.spin import couplings, opened
from solidgear.studies.train.meshes import mesh_bars
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.naming import mode_names
from solidgear.system.system import System


def fastest(workshop: Workshop) -> float:
    """Turns in a second of the engine's shaft at the fastest operating point; zero where none has a
    speed.
    """
    train = workshop.train
    speeds = [point.speed_of(train.reference, train.turns) or 0.0 for point in train.operation]
    return max(map(abs, speeds), default=0.0) / (2 * np.pi)


def spin_cautions(
    workshop: Workshop,
    system: System,
    rungs: Mapping[str, str],
    limit: float,
    turns: float | None = None,
) -> list[str]:
    """Sentence on the modes of a train up to a frequency, Hz, that spin opens by more than the error bar
    of its meshes, or the tolerance of the file; none without a speed.

    Parameters
    ----------
    rungs : mapping of str to str
        Model of each shaft.
    turns : float, optional
        Of the engine's shaft in a second; by default at the fastest operating point.
    """
    train, turns = workshop.train, turns or fastest(workshop)
    count = int((system.elastic[0] <= 2 * np.pi * limit).sum())
    if not turns or not count:
        return []
    found = system.modes(count)
    hz, shapes = found.frequency_hz[found.rigid :], found.shapes[:, found.rigid :]
    coupling = np.zeros((len(hz), len(hz)))
    for side, rung in rungs.items():
        if rung not in LADDER.bodies or side not in system.parts:
            continue
        body = workshop.shaft(side, rung).body
        fields = system.expand(side, shapes)
        each = [{b: field[:, k] for b, field in fields.items()} for k in range(len(hz))]
        own = couplings(body, as_supports(workshop.scenes[side]), each)
        if own is not None:
            coupling += abs(train.turns[side] * turns * own)
    by = opened(hz, coupling, 1.0)
    names = mode_names(workshop, system, found)[found.rigid :]
    bars = mesh_bars(workshop, system, rungs, count)
    known = {} if bars is None else dict(zip(names, map(float, bars)))
    when = f"at {60 * turns:.6g} rpm of the {train.reference}"
    return opened_words(dict(zip(names, by / hz)), known, train.ask.tolerance, when)
