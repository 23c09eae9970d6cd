"""Two trains compared: the differences of their files, and the effect on their numbers. Modes are
paired by shape (:mod:`solidgear.trains.modes.pairing`); a peak of the mesh force belongs to the
peak of the partner of the mode.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from solidgear.comparison.two import beside
from solidgear.comparison.two.beside import Beside, decibels
from solidgear.comparison.two.differences import Difference
from solidgear.comparison.two.two_trains_page import write_two_trains
from solidgear.core import LADDER, SolidgearError, listed, pinned
from solidgear.core.judge.change import Change, Side
from solidgear.core.machine.environment import environment
from solidgear.core.plain import plain
from solidgear.show.units import ENGINEERING, Units, units_named
from solidgear.show.words import hertz, percent
from solidgear.strength.deflection.at_rest import Deflection, deflection, with_ranges
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.shaft import JUDGE, LUMPED, mix_label
from solidgear.trains.assembly.slips import unit_slips
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import PlanetMesh
from solidgear.trains.judge.comparison import train_data
from solidgear.trains.modes.modes import unpublished_lines
from solidgear.trains.modes.pairing import (
    BEYOND,
    SeenMode,
    SeenPair,
    barred_modes,
    mode_pairs,
    modes_and_motions,
    ports_of,
    shared_ports,
)
from solidgear.trains.response.respond import respond
from solidgear.trains.response.response import Peak, TrainResponse

#: column of the force of the mesh that drives
FORCE = "mesh force [N]"
#: peaks in a verdict, the loudest in either train
LOUDEST = 3


@dataclass(frozen=True, eq=False)
class OneTrain(Side):
    """One of the two trains, by one model of each shaft."""

    assembly: Assembly
    response: TrainResponse  #: named by the label
    #: elastic ones, also some above the highest frequency, where partners may lie
    modes: tuple[SeenMode, ...]
    loaded: Deflection | None  #: at its operating point

    @property
    def title(self) -> str:
        """Title of the file."""
        return self.assembly.train.called

    def largest(self, column: str) -> tuple[float, float] | None:
        """Return frequency, Hz, and size of the largest amplitude of a column of the response; None
        without it.
        """
        if column not in self.response.columns:
            return None
        size = np.abs(self.response.columns[column])
        k = int(np.nanargmax(size))
        return float(self.response.frequency_hz[k]), float(size[k])


@dataclass(frozen=True)
class PeakPair:
    """A peak of the mesh force of one train and the partner; either may be missing."""

    plain_names = ("a", "b", "decibels")

    a: Peak | None
    b: Peak | None

    @property
    def decibels(self) -> float | None:
        """Second force over the first in decibels; None for a peak alone."""
        return None if self.a is None or self.b is None else decibels(self.a.force, self.b.force)


@dataclass(frozen=True, repr=False, eq=False)
class TwoTrains(Beside[OneTrain, SeenMode]):
    """Two trains compared."""

    models: dict[str, str]  #: by shaft, the same in both
    #: by whose transmission error both are driven, as :class:`solidgear.trains.file.pairs.Pair` has it
    mesh: str
    highest_hz: float  #: one mode of each pair at least lies below it
    peaks: tuple[PeakPair, ...]  #: of the mesh force, by frequency

    def told(self, units: Units = ENGINEERING) -> list[str]:
        """Return conclusions, with forces in some units."""
        return _conclusions(self, units)

    @cached_property
    def results(self) -> dict[str, Any]:
        """Plain data for JSON, SI."""
        return _results(self)

    def write_report(self, out: str | os.PathLike, *, units: str = "engineering") -> Path:
        """Write results.json, both responses as tables, charts and report.html into a folder, in
        such units; return the path of the page.
        """
        return write_two_trains(self, out, units_named(units))

    @property
    def forces(self) -> dict[str, str]:
        """Columns of mesh forces that both have, that of the mesh which drives first, and their
        names.
        """
        pairs = self.a.assembly.train.teeth
        out = {FORCE: _force_of(self.a.assembly.train.named_mesh(self.mesh))}
        out |= {f"mesh force{p.label} [N]": _force_of(p) for p in pairs if p.name != self.mesh}
        return {c: name for c, name in out.items() if c in self.b.response.columns}

    @property
    def columns(self) -> list[str]:
        """Columns of both responses, by name and unit."""
        return list(dict.fromkeys([*self.a.response.columns, *self.b.response.columns]))

    def decibels(self, column: str) -> float | None:
        """Return the largest amplitude of a column, B over A, in decibels; None where one train has
        none.
        """
        tops = [train.largest(column) for train in self.both]
        return None if tops[0] is None or tops[1] is None else decibels(tops[0][1], tops[1][1])

    @property
    def unpublished(self) -> dict[str, str]:
        """Values that no source gives, in either train; where they differ, assumed ones."""
        first, second = (train.assembly.train.unpublished() for train in self.both)
        return {**first, **{k: s for k, s in second.items() if s == "assumed" or k not in first}}

    def misalignment(self) -> list[tuple[str, str, str, Change]]:
        """Return name, unit, meaning and change of the numbers of misalignment; empty unless both
        have an operating point.
        """
        if self.a.loaded is None or self.b.loaded is None:
            return []
        misalignment_b = {m.name: m for m in self.b.loaded.misalignment}
        return [
            (m.name, m.unit, m.meaning, Change(m.value, measure_b.value, m.bar, measure_b.bar))
            for m in self.a.loaded.misalignment
            if (measure_b := misalignment_b.get(m.name)) is not None
        ]


def _force_of(pair: Pair | PlanetMesh) -> str:
    return f"force of the {pair.name}" if pair.label else "mesh force"


@pinned
def two_trains(
    assemblies: Sequence[Assembly],
    names: Sequence[str],
    inputs: Sequence[Difference] = (),
    *models: str,
    mesh: str | None = None,
    highest_hz: float | None = None,
    progress: Callable[[str], None] = lambda text: None,
) -> TwoTrains:
    """Compare two trains by one model for all shafts or one for each, `JUDGE` by default; the
    transmission error of one mesh drives both, by default the first of the first train, up to a
    frequency, Hz, by default the lower of those that both ask for.

    Examples
    --------
    >>> import solidgear as sg
    >>> files = "geometry/axle_overhung.toml", "geometry/axle_straddle.toml"
    >>> shops = [Assembly(sg.load_train(file)) for file in files]
    >>> found = two_trains(shops, ("overhung", "straddle"), (), "euler", highest_hz=1000.0)
    >>> [pair.a.name for pair in found.modes][:2], found.modes[0].change.verdict
    (['load torsion 1', 'gear torsion 1'], 'no band')
    """
    start = perf_counter()
    first, second = assemblies
    if [*first.scenes] != [*second.scenes]:
        shafts = [
            f"{name} has the shafts {listed(assembly.scenes)}"
            for name, assembly in zip(names, assemblies)
        ]
        raise SolidgearError(
            f"{' and '.join(shafts)}: to compare two trains, give their shafts the same names in the "
            "same order"
        )
    mix = first.models_by_shaft(models or (JUDGE,))
    driver = first.train.named_mesh(mesh).name
    second.train.named_mesh(driver)
    highest = highest_hz or min(assembly.train.ask.max_frequency for assembly in assemblies)
    ends = shared_ports(first, second)
    trains, motions_of = [], []
    for letter, name, assembly, train_ends in zip("AB", names, assemblies, ends):
        progress(f"{letter}: {mix_label(mix)}")
        train, motions = _one_train(
            letter, name, assembly, mix, driver, highest, train_ends, progress
        )
        trains.append(train)
        motions_of.append(motions)
    mirrored = _mirrored(first, second)
    pairs = mode_pairs(
        [train.modes for train in trains], motions_of, highest, by_shape=not mirrored
    )
    left_out = sorted({*ports_of(first), *ports_of(second)} - {*ends[0], *ends[1]})
    paired = "by the motions of the ports that both trains have"
    paired += f" (all but {', '.join(left_out)})" if left_out else ""
    if mirrored:
        paired = "by the motion that names them: hands or apexes differ, which mirrors shapes"
    return TwoTrains(
        a=trains[0],
        b=trains[1],
        inputs=tuple(inputs),
        modes=tuple(p for p in pairs if p.within(highest)),
        pairing=paired,
        seconds=perf_counter() - start,
        models=mix,
        mesh=driver,
        highest_hz=highest,
        peaks=_peak_pairs(trains[0].response.peaks, trains[1].response.peaks, pairs),
    )


def _mirrored(a: Assembly, b: Assembly) -> bool:
    """Check whether the shafts of two trains are not in the same axes."""
    members_b = {pair.name: pair.members for pair in b.train.pairs}
    return any(
        member.apex != members_b[pair.name][role].apex
        or member.hand != members_b[pair.name][role].hand
        for pair in a.train.pairs
        if pair.name in members_b
        for role, member in pair.members.items()
    )


def _one_train(
    letter: str,
    name: str,
    assembly: Assembly,
    mix: dict[str, str],
    mesh: str,
    highest: float,
    ends: list[str],
    progress: Callable[[str], None],
) -> tuple[OneTrain, np.ndarray]:
    """Return one of the trains, and the motions of some ports in the modes."""
    models = tuple(mix.values())
    response = respond(assembly, *models, highest_hz=highest, mesh=mesh)
    response = replace(response, name=f"{letter}: {name}")
    system = assembly.system(*models)
    system_modes, motions = modes_and_motions(assembly, system, highest * BEYOND, ends)
    progress(f"{letter}: error bars of its frequencies")
    modes = barred_modes(assembly, system, system_modes, mix)
    loaded = None
    settles = all(model.partition("/")[0] not in LUMPED for model in models)
    if assembly.train.point is not None and settles:
        progress(f"{letter}: at {assembly.train.point.label}")
        loaded = with_ranges(assembly, deflection(assembly, assembly.train.point, *models))
    cautions = (*response.parting, *unit_slips(assembly), *response.cautions)
    distinct = tuple(dict.fromkeys(cautions))
    return OneTrain(
        letter=letter,
        name=name,
        cautions=distinct,
        assembly=assembly,
        response=response,
        modes=modes,
        loaded=loaded,
    ), motions


def _peak_pairs(
    first: Sequence[Peak], second: Sequence[Peak], pairs: Sequence[SeenPair]
) -> tuple[PeakPair, ...]:
    partner = {p.a.name: p.b.name for p in pairs if p.a is not None and p.b is not None}
    remaining = list(second)
    out = []
    for peak in first:
        partner_peak = next((p for p in remaining if p.mode == partner.get(peak.mode)), None)
        if partner_peak is not None:
            remaining.remove(partner_peak)
        out.append(PeakPair(peak, partner_peak))
    out += [PeakPair(None, peak) for peak in remaining]
    return tuple(sorted(out, key=lambda p: (p.a or p.b).frequency_hz))  # type: ignore[union-attr]  # never both


def _conclusions(trains: TwoTrains, units: Units = ENGINEERING) -> list[str]:
    """Return conclusions: the effect of the change, the part of it that is resolved, and the
    models.
    """
    return [
        beside.inputs(trains.inputs),
        _models(trains),
        *_largest_force(trains, units),
        *_loudest(trains, units),
        *beside.modes(trains.modes, "in the other train"),
        *_largest_reactions(trains, units),
        *_at_rest(trains, units),
        _sure(trains),
    ]


def _models(trains: TwoTrains) -> str:
    titles = {s: LADDER[m].title if m in LADDER.bodies else m for s, m in trains.models.items()}
    words = mix_label(titles)
    if len({*trains.models.values()}) == 1:
        count_word, (title, *_) = trains.a.assembly.train.every, titles.values()
        of_bodies = {*trains.models.values()} <= {*LADDER.bodies}
        words = f"{count_word} shafts as {title}s" if of_bodies else f"{count_word} {title}"
    driver = trains.a.assembly.train.named_mesh(trains.mesh)
    words += f", driven by the {driver.name}" if driver.label else ""
    damping = trains.a.response.damping
    limits = {train.assembly.train.ask.max_frequency for train in trains.both}
    lower = " (the lower of what both files ask for)" if len(limits) > 1 else ""
    return (
        f"Models of both trains: {words}, {damping} losses, up to {trains.highest_hz:g} Hz{lower}."
    )


def _largest_force(trains: TwoTrains, units: Units) -> Iterator[str]:
    for column, name in trains.forces.items():
        tops = [_top(train, column) for train in trains.both]
        texts = [
            f"{units.text(size, 'N', 4)} at {hertz(hz)} Hz in {train.letter}{_of_mode(train, hz)}"
            for train, (hz, size) in zip(trains.both, tops)
        ]
        yield f"Largest {name}: {' and '.join(texts)}{_in_decibels(tops)}."


def _top(train: OneTrain, column: str) -> tuple[float, float]:
    """Return frequency, Hz, and size of the largest amplitude of a column that exists."""
    top = train.largest(column)
    assert top is not None
    return top


def _of_mode(train: OneTrain, hz: float) -> str:
    """Return the mode that makes a peak, in brackets; or the end of a range."""
    mode = next((p.mode for p in train.response.peaks if p.frequency_hz == hz), "")
    if hz == train.response.frequency_hz[-1]:
        mode = "the end of the range"
    return f" ({mode})" if mode else ""


def _in_decibels(tops: Sequence[Any]) -> str:
    change = beside.decibels(tops[0][1], tops[1][1])
    return "" if change is None else f", {change:+.1f} dB"


def _loudest(trains: TwoTrains, units: Units) -> Iterator[str]:
    def size(pair: PeakPair) -> float:
        return max(p.force for p in (pair.a, pair.b) if p is not None)

    loud = sorted(trains.peaks, key=size, reverse=True)[:LOUDEST]
    for pair in [p for p in trains.peaks if p in loud]:
        if pair.a is None or pair.b is None:
            train, peak = (trains.a, pair.a) if pair.a is not None else (trains.b, pair.b)
            assert peak is not None
            force = units.text(peak.force, "N", 4)
            yield f"A peak of {train.letter} alone: {peak.mode}, {hertz(peak.frequency_hz)} Hz, {force}."
            continue
        a, b = pair.a, pair.b
        shift = percent(b.frequency_hz / a.frequency_hz - 1)
        forces = f"{units.number(a.force, 'N', 4)} to {units.text(b.force, 'N', 4)}"
        yield (
            f"The peak of {beside.both_names(a.mode, b.mode)} moves from {hertz(a.frequency_hz)} to "
            f"{hertz(b.frequency_hz)} Hz ({shift}), its mesh force from {forces} "
            f"({pair.decibels:+.1f} dB)."
        )


def _largest_reactions(trains: TwoTrains, units: Units) -> Iterator[str]:
    texts, tops = [], []
    for train in trains.both:
        forces = [c for c in train.response.columns if " bearing " in c and c.endswith(" [N]")]
        if not forces:
            return
        column = max(forces, key=lambda c: _top(train, c)[1])
        hz, size = _top(train, column)
        tops.append((hz, size))
        place = column.removesuffix(" [N]")
        texts.append(f"{place}, {units.text(size, 'N', 4)} at {hertz(hz)} Hz in {train.letter}")
    yield f"Largest dynamic force on a bearing: {'; '.join(texts)}{_in_decibels(tops)}."


def _at_rest(trains: TwoTrains, units: Units) -> Iterator[str]:
    points = [train.assembly.train.point for train in trains.both]
    if points[0] is None and points[1] is None:
        return
    if points[0] is None or points[1] is None:
        loaded_train = trains.b if points[0] is None else trains.a
        yield f"Under torque nothing is compared: {loaded_train.letter} alone has an operating point."
        return
    changes = trains.misalignment()
    if not changes:
        yield "Under torque nothing is compared: lumped shafts have no bearings of their own."
        return
    texts = [
        f"{name} {units.number(c.a, unit, 3)} to {units.text(c.b, unit, 3)}"
        + (f" ({c.verdict})" if c.band is not None else "")
        for name, unit, _, c in changes
    ]
    label = points[0].label
    place = label if label == points[1].label else f"{label} (A) and {points[1].label} (B)"
    yield f"Misalignment at {place}: {'; '.join(texts)}."
    letters_by_range: dict[str, list[str]] = {}
    for train in trains.both:
        for m in train.loaded.misalignment if train.loaded else ():
            if m.open is not None:
                low, high = units.number(m.open[0], m.unit, 3), units.text(m.open[1], m.unit, 3)
                letters_by_range.setdefault(f"{m.name} {low} to {high}", []).append(train.letter)
    if letters_by_range:
        letters = [train.letter for train in trains.both]
        ranges = [
            r if in_trains == letters else f"{r} ({in_trains[0]})"
            for r, in_trains in letters_by_range.items()
        ]
        yield f"Range from the data of bearings, shared by both: {'; '.join(ranges)}."


def _sure(trains: TwoTrains) -> str:
    bars = [m.bar for p in trains.modes for m in (p.a, p.b) if m is not None and m.bar is not None]
    reason = (
        "amplitudes have none, and depend on losses and transmission error as given in both files"
    )
    if not bars:
        return (
            "No error bars without a harmonic shaft, so that no difference is called resolved; "
            f"{reason}."
        )
    stations = [
        b for train in trains.both for s in train.assembly.scenes.values() for b in s.bearings
    ]
    catalogued = any(getattr(b, "catalogue", None) is not None for b in stations)
    left_out = ", not open data of catalogue bearings" if catalogued else ""
    return (
        f"Error bars are for frequencies, {percent(max(bars), signed=False)} at most (meshes of "
        f"harmonic shafts, reduction{left_out}); {reason}."
    )


def _results(trains: TwoTrains) -> dict[str, Any]:
    """Return plain data for JSON, SI: all numbers of the page and the curves of the charts."""
    by_letter = dict(zip("ab", trains.both))
    loaded = {
        key: train.loaded.as_dict() for key, train in by_letter.items() if train.loaded is not None
    }
    return {
        "kind": "two trains",
        "trains": {
            key: {"file": train.name, **train_data(train.assembly)}
            for key, train in by_letter.items()
        },
        "models": trains.models,
        **({"mesh": trains.mesh} if len(trains.forces) > 1 else {}),
        "highest_hz": trains.highest_hz,
        "differences": plain(trains.inputs),
        "sentences": _conclusions(trains),
        "paired": trains.pairing,
        "modes": plain(trains.modes),
        "peaks": plain(trains.peaks),
        "largest": {column: _largest(trains, column) for column in trains.columns},
        "responses": {key: _curves(train) for key, train in by_letter.items()},
        "misalignment": {
            name: {"unit": unit.split()[0], **plain(change)}
            for name, unit, _, change in trains.misalignment()
        },
        "at_rest": loaded,
        "cautions": trains.cautions,
        "unpublished": trains.unpublished,
        "unpublished_lines": unpublished_lines(trains.unpublished),
        "environment": environment(),
        "seconds_total": trains.seconds,
    }


def _largest(trains: TwoTrains, column: str) -> dict[str, Any]:
    tops = [train.largest(column) for train in trains.both]
    data: dict[str, Any] = {
        key: None if top is None else dict(zip(("frequency_hz", "size"), top))
        for key, top in zip("ab", tops)
    }
    return data | {"decibels": trains.decibels(column)}


def _curves(train: OneTrain) -> dict[str, Any]:
    columns = train.response.columns.items()
    amplitude = {name: np.abs(values) for name, values in columns}
    return plain({"frequency_hz": train.response.frequency_hz, "amplitude": amplitude})
