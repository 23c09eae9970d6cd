"""Modes of two trains that belong together.

They do by the motions of the ports that both trains have: the lumped points of both shafts, engine
and load always, bearings and further ports where they are called alike.  Modes that find no partner
so, and all of them where hands or apexes differ and shapes are mirrored, belong together by the
motion that names them, in order of frequency.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solidgear.studies.beside import all_pairs
from solidgear.studies.change import BarredMode, ModePair
from solidgear.studies.train.meshes import mesh_bars
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.naming import driven, mode_names
from solidgear.studies.train.pairing import mac, partners, ports_of
from solidgear.studies.train.strain import strain_shares
from solidgear.system.modes import SystemModes
from solidgear.system.system import System

#: relative; no error bar of a frequency is smaller: rounding of bodies and their reduction
ROUNDING = 1e-9


@dataclass(frozen=True)
class SeenMode(BarredMode):
    """An elastic mode of one of the trains; it has no bar without a harmonic shaft.

    Attributes
    ----------
    driven : bool
        Whether it moves a port at all.
    shares : dict of str to float
        Of its strain energy, as of :func:`solidgear.studies.train.strain.strain_shares`.
    """

    driven: bool
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
    """Elastic modes with their names, error bars and strain energies.

    Parameters
    ----------
    rungs : dict of str to str
        Model of each side.
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

    Parameters
    ----------
    modes : sequence of sequence of SeenMode
        Of both trains.
    seen : sequence of (m, n) ndarray
        Their motions of the same ports, as of :func:`solidgear.studies.train.pairing.seen_modes`.
    highest : float
        Hz, up to which modes that have no partner by shape find one by name.
    by_shape : bool
        False to pair all of them by name.
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
