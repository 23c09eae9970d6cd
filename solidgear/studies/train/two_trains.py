"""Two trains beside each other: what differs in their files, and what that does to their numbers.

Modes are paired by shape (:mod:`solidgear.studies.train.pairing`); a peak of the mesh force
belongs to the peak of the partner of its mode.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from solidgear.errors import SolidgearError, listed
from solidgear.machine.threads import pinned
from solidgear.report.two_trains_page import write_two_trains
from solidgear.report.units import ENGINEERING, Units, units_named
from solidgear.scene.differences import Difference
from solidgear.scene.gears import Pair
from solidgear.scene.planetary import PlanetMesh
from solidgear.studies.beside import Beside, Side, decibels
from solidgear.studies.change import Change
from solidgear.studies.train import two_trains_told as told
from solidgear.studies.train.deflection import TrainDeflection, deflection, with_ranges
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.pairing import (
    BEYOND,
    SeenMode,
    SeenPair,
    mode_pairs,
    ports_of,
    seen_modes,
    shared_ports,
    told_modes,
)
from solidgear.studies.train.respond import respond
from solidgear.studies.train.response import Peak, TrainResponse
from solidgear.studies.train.shaft import JUDGE, LUMPED, told_mix
from solidgear.studies.train.slips import slips

#: column of the force of the mesh that drives
FORCE = "mesh force [N]"


@dataclass(frozen=True, eq=False)
class OneTrain(Side):
    """One of the two, by one model of each shaft."""

    workshop: Workshop
    response: TrainResponse  #: named by the label
    #: elastic ones, also some above the highest frequency, where partners may lie
    modes: tuple[SeenMode, ...]
    loaded: TrainDeflection | None  #: at its operating point

    @property
    def title(self) -> str:
        """Title of its file."""
        return self.workshop.train.called

    def largest(self, column: str) -> tuple[float, float] | None:
        """Hz and size of the largest amplitude of a column of the response; None without it."""
        if column not in self.response.columns:
            return None
        size = np.abs(self.response.columns[column])
        k = int(np.nanargmax(size))
        return float(self.response.frequency_hz[k]), float(size[k])


@dataclass(frozen=True)
class PeakPair:
    """A peak of the mesh force of one train and its partner; either may be missing."""

    a: Peak | None
    b: Peak | None

    @property
    def decibels(self) -> float | None:
        """Of the second force over the first; None for a peak alone."""
        return None if self.a is None or self.b is None else decibels(self.a.force, self.b.force)


@dataclass(frozen=True, repr=False, eq=False)
class TwoTrains(Beside[OneTrain, SeenMode]):
    """Two trains beside each other."""

    models: dict[str, str]  #: by shaft, the same in both
    #: by whose transmission error both are driven, as :class:`solidgear.scene.gears.Pair` has it
    mesh: str
    highest_hz: float  #: one mode of each pair at least lies below it
    peaks: tuple[PeakPair, ...]  #: of the mesh force, by frequency

    def told(self, units: Units = ENGINEERING) -> list[str]:
        """Conclusions, with forces in some units."""
        return told.sentences(self, units)

    @cached_property
    def results(self) -> dict[str, Any]:
        """Plain data that JSON can hold, SI."""
        return told.results(self)

    def write_report(self, out: str | os.PathLike, *, units: str = "engineering") -> Path:
        """Write results.json, both responses as tables, charts and report.html into a folder, in such
        units; the path is that of the page.
        """
        return write_two_trains(self, out, units_named(units))

    @property
    def forces(self) -> dict[str, str]:
        """Columns of mesh forces that both have, that of the mesh which drives first, and their names."""
        pairs = self.a.workshop.train.teeth
        out = {FORCE: _force_of(self.a.workshop.train.named_mesh(self.mesh))}
        out |= {f"mesh force{p.label} [N]": _force_of(p) for p in pairs if p.name != self.mesh}
        return {c: name for c, name in out.items() if c in self.b.response.columns}

    @property
    def columns(self) -> list[str]:
        """Columns of both responses, by name and unit."""
        return list(dict.fromkeys([*self.a.response.columns, *self.b.response.columns]))

    def decibels(self, column: str) -> float | None:
        """Of the largest amplitude of a column, B over A; None where one has none."""
        tops = [one.largest(column) for one in self.both]
        return None if tops[0] is None or tops[1] is None else decibels(tops[0][1], tops[1][1])

    @property
    def unpublished(self) -> dict[str, str]:
        """Values that no source gives, in either train; where they differ, assumed ones."""
        first, other = (one.workshop.train.unpublished() for one in self.both)
        return {**first, **{k: s for k, s in other.items() if s == "assumed" or k not in first}}

    def misalignment(self) -> list[tuple[str, str, str, Change]]:
        """Name, unit, meaning and change of what the misalignment of both is told by; empty unless
        both have an operating point.
        """
        if self.a.loaded is None or self.b.loaded is None:
            return []
        its = {m.name: m for m in self.b.loaded.misalignment}
        return [
            (m.name, m.unit, m.meaning, Change(m.value, i.value, m.bar, i.bar))
            for m in self.a.loaded.misalignment
            if (i := its.get(m.name)) is not None
        ]


def _force_of(pair: Pair | PlanetMesh) -> str:
    return f"force of the {pair.name}" if pair.label else "mesh force"


@pinned
def two_trains(
    workshops: Sequence[Workshop],
    names: Sequence[str],
    inputs: Sequence[Difference] = (),
    *models: str,
    mesh: str | None = None,
    highest_hz: float | None = None,
    progress: Callable[[str], None] = lambda text: None,
) -> TwoTrains:
    """Two trains beside each other, by one model for all shafts or one for each, `JUDGE` by
    default.

    The transmission error of one mesh drives both, by default the first of the first, up to a
    frequency, Hz, by default the lower of those that both ask for.

    Examples
    --------
    >>> import solidgear as sg
    >>> files = "geometry/axle_overhung.toml", "geometry/axle_straddle.toml"
    >>> shops = [Workshop(sg.load_train(file)) for file in files]
    >>> found = two_trains(shops, ("overhung", "straddle"), (), "euler", highest_hz=1000.0)
    >>> [pair.a.name for pair in found.modes][:2], found.modes[0].change.verdict
    (['load torsion 1', 'gear torsion 1'], 'no band')
    """
    start = perf_counter()
    first, other = workshops
    if [*first.scenes] != [*other.scenes]:
        has = [
            f"{name} has the shafts {listed(shop.scenes)}" for name, shop in zip(names, workshops)
        ]
        raise SolidgearError(
            f"{' and '.join(has)}: two trains are compared where both call their shafts alike, in "
            "the same sequence"
        )
    mix = first.mix(models or (JUDGE,))
    driver = first.train.named_mesh(mesh).name
    other.train.named_mesh(driver)
    highest = highest_hz or min(shop.train.ask.max_frequency for shop in workshops)
    ends = shared_ports(first, other)
    trains, seen = [], []
    for letter, name, shop, own in zip("AB", names, workshops, ends):
        progress(f"{letter}: {told_mix(mix)}")
        one, motions = _one_train(letter, name, shop, mix, driver, highest, own, progress)
        trains.append(one)
        seen.append(motions)
    mirrored = _mirrored(first, other)
    pairs = mode_pairs([one.modes for one in trains], seen, highest, by_shape=not mirrored)
    left_out = sorted({*ports_of(first), *ports_of(other)} - {*ends[0], *ends[1]})
    paired = "by the motions of the ports that both trains have"
    paired += f" (all but {', '.join(left_out)})" if left_out else ""
    if mirrored:
        paired = "by the motion that names them: hands or apexes differ, which mirrors shapes"
    return TwoTrains(
        trains[0],
        trains[1],
        tuple(inputs),
        tuple(p for p in pairs if p.within(highest)),
        paired,
        perf_counter() - start,
        mix,
        driver,
        highest,
        _peak_pairs(trains[0].response.peaks, trains[1].response.peaks, pairs),
    )


def _mirrored(one: Workshop, other: Workshop) -> bool:
    """True where the shafts of two trains are not in the same axes."""
    its = {pair.name: pair.members for pair in other.train.pairs}
    return any(
        own.apex != its[pair.name][role].apex or own.hand != its[pair.name][role].hand
        for pair in one.train.pairs
        if pair.name in its
        for role, own in pair.members.items()
    )


def _one_train(
    letter: str,
    name: str,
    shop: Workshop,
    mix: dict[str, str],
    mesh: str,
    highest: float,
    ends: list[str],
    progress: Callable[[str], None],
) -> tuple[OneTrain, np.ndarray]:
    """One of the trains, and what its modes move at some ports."""
    rungs = tuple(mix.values())
    response = respond(shop, *rungs, highest_hz=highest, mesh=mesh)
    response = replace(response, name=f"{letter}: {name}")
    system = shop.system(*rungs)
    found, seen = seen_modes(shop, system, highest * BEYOND, ends)
    progress(f"{letter}: how sure its frequencies are")
    modes = told_modes(shop, system, found, mix)
    loaded = None
    at_rest = all(rung.partition("/")[0] not in LUMPED for rung in rungs)
    if shop.train.point is not None and at_rest:
        progress(f"{letter}: at {shop.train.point.label}")
        loaded = with_ranges(shop, deflection(shop, shop.train.point, *rungs))
    cautions = (*response.parting, *slips(shop), *response.cautions)
    own = tuple(dict.fromkeys(cautions))
    return OneTrain(letter, name, own, shop, response, modes, loaded), seen


def _peak_pairs(
    first: Sequence[Peak], other: Sequence[Peak], pairs: Sequence[SeenPair]
) -> tuple[PeakPair, ...]:
    partner = {p.a.name: p.b.name for p in pairs if p.a is not None and p.b is not None}
    left = list(other)
    out = []
    for peak in first:
        its = next((p for p in left if p.mode == partner.get(peak.mode)), None)
        if its is not None:
            left.remove(its)
        out.append(PeakPair(peak, its))
    out += [PeakPair(None, peak) for peak in left]
    return tuple(sorted(out, key=lambda p: (p.a or p.b).frequency_hz))  # type: ignore[union-attr]  # never both
