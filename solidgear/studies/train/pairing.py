"""Pairs of modes of two mixes of models of a train, by motions of all ports and not by number."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from solidgear.judge.correlation import best_assignment
from solidgear.scene.train_housing import HOUSING
from solidgear.studies.train.housing import BOX
from solidgear.studies.train.models import Workshop
from solidgear.system.system import System

#: two modes whose motions of the ports are less alike than this are different ones
ALIKE = 0.3
#: of two partners alike, how much a factor of e in frequency counts against one, and the most it does
APART, MOST = 0.05, 4.0
#: modes of a mix are looked for up to this times the highest frequency of the other's
BEYOND = 1.7


def seen_modes(
    workshop: Workshop, system: System, highest: float, ends: Sequence[str] | None = None
):
    """Modes up to a frequency, and how they are seen at the ports.

    Parameters
    ----------
    highest : float
        Hz; the first elastic mode is always there.
    ends : sequence of str, optional
        Ports that are looked at, as ``side.port``; by default all.

    Returns
    -------
    SystemModes
    (m, n) ndarray
        Motions of these ports in the n elastic ones, rotations times the length of the shaft, and
        rotations of engine and load.
    """
    count = max(1, int((system.elastic[0] <= 2 * np.pi * highest).sum()))
    found = system.modes(count)
    elastic = found.shapes[:, found.rigid :]
    lengths = {side: scene.length for side, scene in workshop.scenes.items()}
    lengths[HOUSING] = max(lengths.values())
    for stage in workshop.stages.values():
        lengths |= dict.fromkeys(stage.bodies, stage.stage.teeth.pin_radius)
    scale = {part: np.array([1.0] * 3 + [own] * 3)[:, None] for part, own in lengths.items()}
    ends = ports_of(workshop) if ends is None else ends
    rows = [scale[end.partition(".")[0]] * (system.motion(end) @ elastic) for end in ends]
    rows += [
        workshop.scenes[side].length * (system.motion(name)[4:5] @ elastic)
        for name, side in ((name, rotor.shaft) for name, rotor in workshop.train.rotors.items())
    ]
    return found, np.vstack(rows)


def ports_of(workshop: Workshop) -> list[str]:
    """Ports of all shafts, the lumped point of each before its others, centres of planets and that of
    the housing.
    """
    scenes = workshop.scenes.items()
    out = [f"{side}.{s.name}" for side, scene in scenes for s in scene.stations]
    out += [f"{name}.centre" for stage in workshop.stages.values() for name in stage.bodies]
    return out + [BOX] * (workshop.train.housing is not None)


def partners(
    hz: np.ndarray, seen: np.ndarray, other_hz: np.ndarray, other_seen: np.ndarray
) -> dict[int, int]:
    """Elastic modes of one mix and their partners among those of another; of several that are alike,
    the one at the nearest frequency.

    Parameters
    ----------
    hz, other_hz : (n,), (k,) ndarray
        Frequencies of elastic modes.
    seen, other_seen : (m, n), (m, k) ndarray
        As of :func:`seen_modes`.

    Returns
    -------
    dict of int to int
        From places in the first to places in the second; modes without a partner are left out.

    Examples
    --------
    >>> seen = np.eye(3)
    >>> partners(np.array([1.0, 2, 3]), seen, np.array([1.1, 1.9]), seen[:, [1, 0]])
    {0: 1, 1: 0}
    """
    alike = mac(seen, other_seen)
    near = np.abs(np.log(hz[:, None] / other_hz[None, :]))
    mine, its = best_assignment(alike - APART * np.minimum(near, MOST))
    return {int(k): int(j) for k, j in zip(mine, its) if alike[k, j] >= ALIKE}


def mac(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Modal assurance criterion of every pair of columns.

    Parameters
    ----------
    one, other : (m, n), (m, k) ndarray

    Returns
    -------
    (n, k) ndarray
        0 to 1.
    """
    size = np.outer((one**2).sum(axis=0), (other**2).sum(axis=0))
    return (one.T @ other) ** 2 / np.maximum(size, np.finfo(float).tiny)
