"""What spin does to natural frequencies of a train, from the modes at rest.

Every shaft adds a coupling times the turns of that shaft (:mod:`solidgear.core.solve.spin`); the sense in which
shafts turn is left out: where two couple the same modes, the contributions are added up.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from solidgear.core import LADDER, System, as_supports, listed
from solidgear.core.judge.at_rest import Moved, moved_beyond
from solidgear.core.solve.spin import Whirl, couplings, whirled
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.meshes import mesh_bars
from solidgear.trains.modes.naming import mode_names

#: modes beyond those shown that take part in their whirl: three digits, as of a shaft
BEYOND = 10


def fastest_turns(assembly: Assembly) -> float:
    """Return the turns in a second of the engine's shaft at the fastest operating point; zero where
    none has a speed.
    """
    train = assembly.train
    speeds = [point.speed_of(train.reference, train.turns) or 0.0 for point in train.operation]
    return max(map(abs, speeds), default=0.0) / (2 * np.pi)


def spin_moved(
    assembly: Assembly,
    system: System,
    models: Mapping[str, str],
    limit: float,
    turns: float | None = None,
) -> Moved | None:
    """Return the modes up to a limit, Hz, that spin moves by more than the error bar of the meshes, or
    the tolerance of the file; None without a speed. Turns of the engine's shaft in a second are by
    default those at the fastest operating point.
    """
    train, turns = assembly.train, turns or fastest_turns(assembly)
    count = int((system.elastic[0] <= 2 * np.pi * limit).sum())
    if not turns or not count:
        return None
    # modes beyond those shown take part in their whirl
    modes = system.modes(count + BEYOND, bounded=count)
    hz, shapes = modes.frequency_hz[modes.rigid :], modes.shapes[:, modes.rigid :]
    of_shafts, left_out = [], []
    for side, model in models.items():
        if model not in LADDER.bodies or side not in system.parts:
            left_out.append(side)
            continue
        body = assembly.shaft_model(side, model).body
        fields = system.expand(side, shapes)
        mode_fields = [{b: field[:, k] for b, field in fields.items()} for k in range(len(hz))]
        coupling = couplings(body, as_supports(assembly.scenes[side]), mode_fields)
        of_shafts.append(train.turns[side] * turns * coupling)
    if not of_shafts:
        return None
    moved = whirled(hz, _added_up(np.array(of_shafts)), 1.0) / hz - 1
    names = mode_names(assembly, system, modes)[modes.rigid :]
    bars = mesh_bars(assembly, system, models, count)
    bars_by_name = {} if bars is None else dict(zip(names, map(float, bars)))
    moves = {name: Whirl(float(way), float(way), False) for name, way in zip(names, moved[:count])}
    how = f", without {listed(left_out)}, no elastic body" if left_out else ""
    speed, tolerance = 2 * np.pi * turns, train.ask.tolerance
    return moved_beyond(moves, bars_by_name, tolerance, speed, of=train.reference, how=how)


def _added_up(of_shafts: np.ndarray) -> np.ndarray:
    """Return the couplings (k, k) of all shafts (s, k, k) as if each turned in the sense that adds to
    the largest.
    """
    largest = np.abs(of_shafts).argmax(axis=0)
    sign = np.sign(np.take_along_axis(of_shafts, largest[None], axis=0)[0])
    return sign * np.abs(of_shafts).sum(axis=0)
