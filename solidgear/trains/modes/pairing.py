"""Pairs of modes of two mixes of models of a train, or of two trains, by motions of ports and not by
number.

Of two trains these are the ports that both have: the lumped points of both shafts, engine and load
always, bearings and further ports with the same name.  Modes that find no partner so, and
all of them where hands or apexes differ and shapes are mirrored, belong together by the motion that
names them, in order of frequency.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solidgear.core import BarredMode, System
from solidgear.core.judge.change import ModePair, all_pairs
from solidgear.core.solve.neighbours import best_assignment
from solidgear.core.system.modes import SystemModes
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.housing import BOX
from solidgear.trains.assembly.meshes import mesh_bars
from solidgear.trains.file.housing import HOUSING
from solidgear.trains.load.strain import strain_shares
from solidgear.trains.modes.naming import driven, mode_names

#: two modes whose motions of the ports are less similar than this are different
ALIKE = 0.3
#: between similar partners, the cost of a factor of e in frequency, and the largest factor that counts
APART, MOST = 0.05, 4.0
#: modes of a mix are looked for up to this times the highest frequency of the other's
BEYOND = 1.7
#: relative; no error bar of a frequency is smaller: rounding of bodies and their reduction
ROUNDING = 1e-9


def modes_and_motions(
    assembly: Assembly, system: System, highest: float, ends: Sequence[str] | None = None
):
    """Return the modes of a system up to a frequency, Hz, and motions (m, n) of ports in the n
    elastic ones, at least one: rotations times the length of the shaft, and rotations of engine
    and load; `ends` are the ports, as ``side.port``, by default all.
    """
    count = max(1, int((system.elastic[0] <= 2 * np.pi * highest).sum()))
    modes = system.modes(count)
    elastic = modes.shapes[:, modes.rigid :]
    lengths = {side: scene.length for side, scene in assembly.scenes.items()}
    lengths[HOUSING] = max(lengths.values())
    for stage in assembly.stages.values():
        lengths |= dict.fromkeys(stage.bodies, stage.stage.teeth.pin_radius)
    scale = {part: np.array([1.0] * 3 + [length] * 3)[:, None] for part, length in lengths.items()}
    ends = ports_of(assembly) if ends is None else ends
    rows = [scale[end.partition(".")[0]] * (system.motion(end) @ elastic) for end in ends]
    rows += [
        assembly.scenes[side].length * (system.motion(name)[4:5] @ elastic)
        for name, side in ((name, rotor.shaft) for name, rotor in assembly.train.rotors.items())
    ]
    return modes, np.vstack(rows)


def ports_of(assembly: Assembly) -> list[str]:
    """Return the ports of all shafts, the lumped point of each shaft first, centres of
    planets and that of the housing.
    """
    scenes = assembly.scenes.items()
    ports = [f"{side}.{s.name}" for side, scene in scenes for s in scene.stations]
    ports += [f"{name}.centre" for stage in assembly.stages.values() for name in stage.bodies]
    if assembly.train.housing is not None:
        ports.append(BOX)
    return ports


def partners(
    hz: np.ndarray, motions: np.ndarray, other_hz: np.ndarray, other_motions: np.ndarray
) -> dict[int, int]:
    """Return for elastic modes of a mix the numbers of their partners in another, from frequencies
    (n,), (k,) and motions (m, n), (m, k) of :func:`modes_and_motions`; of several similar ones,
    that at the nearest frequency.

    Examples
    --------
    >>> seen = np.eye(3)
    >>> partners(np.array([1.0, 2, 3]), seen, np.array([1.1, 1.9]), seen[:, [1, 0]])
    {0: 1, 1: 0}
    """
    similarity = mac(motions, other_motions)
    near = np.abs(np.log(hz[:, None] / other_hz[None, :]))
    rows, columns = best_assignment(similarity - APART * np.minimum(near, MOST))
    return {int(k): int(j) for k, j in zip(rows, columns) if similarity[k, j] >= ALIKE}


def mac(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the modal assurance criterion (n, k), 0 to 1, of every pair of columns (m, n), (m, k)."""
    size = np.outer((a**2).sum(axis=0), (b**2).sum(axis=0))
    return (a.T @ b) ** 2 / np.maximum(size, np.finfo(float).tiny)


@dataclass(frozen=True)
class SeenMode(BarredMode):
    """An elastic mode of one of the trains; it has no error bar without a harmonic shaft."""

    driven: bool
    #: of its strain energy, as of :func:`solidgear.trains.load.strain.strain_shares`
    shares: dict[str, float]


#: a pair of modes of two trains, by the motions of shared ports
SeenPair = ModePair[SeenMode]


def shared_ports(a: Assembly, b: Assembly) -> tuple[list[str], list[str]]:
    """Return ports of both trains that stand for each other, in the same order: the lumped points,
    and those with the same name.
    """
    mains = [
        [f"{s}.{assembly.scenes[s].port.name}" for s in assembly.scenes] for assembly in (a, b)
    ]
    ports_b = ports_of(b)
    shared = [end for end in ports_of(a) if end in ports_b and end not in (*mains[0], *mains[1])]
    return [*mains[0], *shared], [*mains[1], *shared]


def barred_modes(
    assembly: Assembly, system: System, modes: SystemModes, models: dict[str, str]
) -> tuple[SeenMode, ...]:
    """Return the elastic modes with their names, error bars and strain energies; `models` gives the
    model of each side.
    """
    names, is_driven = mode_names(assembly, system, modes), driven(system, modes)
    shares = strain_shares(modes.energy, [*assembly.scenes])
    elastic = range(modes.rigid, len(modes.frequency_hz))
    bars = mesh_bars(assembly, system, models, len(elastic))
    return tuple(
        SeenMode(
            names[k],
            float(modes.frequency_hz[k]),
            None
            if bars is None
            else max(float(bars[k - modes.rigid] + modes.error_bound[k]), ROUNDING),
            bool(is_driven[k]),
            {name: float(share[k]) for name, share in shares.items()},
        )
        for k in elastic
    )


def mode_pairs(
    modes: Sequence[Sequence[SeenMode]],
    motions: Sequence[np.ndarray],
    highest: float,
    *,
    by_shape: bool,
) -> list[SeenPair]:
    """Return all modes of both trains, with their partners where they have one, by frequency.
    Motions of the same ports are those of :func:`modes_and_motions`; modes without a partner by
    shape are paired by name up to a frequency, Hz, and all of them where not `by_shape`.
    """
    first, second = modes
    pairs: list[SeenPair] = []
    if by_shape:
        # a mode that moves no port has no shape to be paired by
        (a, hz_a, moved_a), (b, hz_b, moved_b) = map(_driven, modes, motions)
        similarity = mac(moved_a, moved_b)
        pairs = [
            ModePair(a[k], b[j], float(similarity[k, j]))
            for k, j in partners(hz_a, moved_a, hz_b, moved_b).items()
        ]
    return all_pairs(pairs, first, second, _motion, highest if by_shape else math.inf)


def _driven(
    modes: Sequence[SeenMode], motions: np.ndarray
) -> tuple[list[SeenMode], np.ndarray, np.ndarray]:
    """Return the modes that move ports, their frequencies, Hz, and their motions."""
    numbers = [k for k, mode in enumerate(modes) if mode.driven]
    chosen = [modes[k] for k in numbers]
    return chosen, np.array([mode.frequency_hz for mode in chosen]), motions[:, numbers]


def _motion(mode: SeenMode) -> str:
    """Return the name of a mode without the number."""
    return mode.name.rpartition(" ")[0]
