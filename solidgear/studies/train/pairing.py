"""Pairs of modes of two mixes of models of a train, or of two trains, by motions of ports and not by
number.

Of two trains these are the ports that both have: the lumped points of both shafts, engine and load
always, bearings and further ports where they are called alike.  Modes that find no partner so, and
all of them where hands or apexes differ and shapes are mirrored, belong together by the motion that
names them, in order of frequency.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solidgear.scene.train_housing import HOUSING
from solidgear.solve.neighbours import best_assignment
from solidgear.studies.beside import all_pairs
from solidgear.studies.change import BarredMode, ModePair
from solidgear.studies.train.housing import BOX
from solidgear.studies.train.meshes import mesh_bars
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.naming import driven, mode_names
from solidgear.studies.train.strain import strain_shares
from solidgear.system.modes import SystemModes
from solidgear.system.system import System

#: two modes whose motions of the ports are less alike than this are different ones
ALIKE = 0.3
#: of two partners alike, how much a factor of e in frequency counts against one, and the most it does
APART, MOST = 0.05, 4.0
#: modes of a mix are looked for up to this times the highest frequency of the other's
BEYOND = 1.7
#: relative; no error bar of a frequency is smaller: rounding of bodies and their reduction
ROUNDING = 1e-9


def seen_modes(
    workshop: Workshop, system: System, highest: float, ends: Sequence[str] | None = None
):
    """Modes of a system up to a frequency, Hz, and motions (m, n) of ports in the n elastic ones,
    one at least: rotations times the length of the shaft, and rotations of engine and load. `ends`
    are the ports that are looked at, as ``side.port``; by default all.
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
    """Elastic modes of one mix and their partners among those of another, by their places, from
    frequencies (n,), (k,) and motions (m, n), (m, k) as of :func:`seen_modes`; of several that are
    alike, the one at the nearest frequency.

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
    """Modal assurance criterion (n, k), 0 to 1, of every pair of columns (m, n), (m, k)."""
    size = np.outer((one**2).sum(axis=0), (other**2).sum(axis=0))
    return (one.T @ other) ** 2 / np.maximum(size, np.finfo(float).tiny)


@dataclass(frozen=True)
class SeenMode(BarredMode):
    """An elastic mode of one of the trains; it has no bar without a harmonic shaft."""

    driven: bool
    #: of its strain energy, as of :func:`solidgear.studies.train.strain.strain_shares`
    shares: dict[str, float]


#: a pair of modes of two trains, told by the motions of shared ports
SeenPair = ModePair[SeenMode]


def shared_ports(one: Workshop, other: Workshop) -> tuple[list[str], list[str]]:
    """Ports of both trains that stand for each other, in the same order: the lumped points, and
    those that are called alike.
    """
    mains = [[f"{s}.{shop.scenes[s].port.name}" for s in shop.scenes] for shop in (one, other)]
    its = ports_of(other)
    alike = [end for end in ports_of(one) if end in its and end not in (*mains[0], *mains[1])]
    return [*mains[0], *alike], [*mains[1], *alike]


def told_modes(
    shop: Workshop, system: System, found: SystemModes, rungs: dict[str, str]
) -> tuple[SeenMode, ...]:
    """Elastic modes with their names, error bars and strain energies; the model of each side is
    that of `rungs`.
    """
    names, moved = mode_names(shop, system, found), driven(system, found)
    shares = strain_shares(found.energy, [*shop.scenes])
    elastic = range(found.rigid, len(found.frequency_hz))
    bars = mesh_bars(shop, system, rungs, len(elastic))
    return tuple(
        SeenMode(
            names[k],
            float(found.frequency_hz[k]),
            None
            if bars is None
            else max(float(bars[k - found.rigid] + found.error_bound[k]), ROUNDING),
            bool(moved[k]),
            {name: float(share[k]) for name, share in shares.items()},
        )
        for k in elastic
    )


def mode_pairs(
    modes: Sequence[Sequence[SeenMode]],
    seen: Sequence[np.ndarray],
    highest: float,
    *,
    by_shape: bool,
) -> list[SeenPair]:
    """All modes of both trains, with their partners where they have one, by frequency.

    Motions of the same ports are as of :func:`seen_modes`. Modes that have no partner by shape find
    one by name up to a frequency, Hz, and all of them where not `by_shape`.
    """
    first, other = modes
    hz = [np.array([mode.frequency_hz for mode in own]) for own in (first, other)]
    pairs: list[SeenPair] = []
    if by_shape:
        # what moves no port has no shape to be told by
        mine, its = ([k for k, mode in enumerate(own) if mode.driven] for own in modes)
        motions = seen[0][:, mine], seen[1][:, its]
        alike = mac(*motions)
        found = partners(hz[0][mine], motions[0], hz[1][its], motions[1])
        pairs = [
            ModePair(first[mine[k]], other[its[j]], float(alike[k, j])) for k, j in found.items()
        ]
    return all_pairs(pairs, first, other, _motion, highest if by_shape else math.inf)


def _motion(mode: SeenMode) -> str:
    """Name of a mode without its number."""
    return mode.name.rpartition(" ")[0]
