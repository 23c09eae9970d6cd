"""Two trains beside each other: the differences of their files, and the effect on their numbers.
Modes are paired by shape (:mod:`solidgear.trains.modes.pairing`); a peak of the mesh force belongs
to the peak of the partner of the mode.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from time import perf_counter
from typing import Any, ClassVar, NamedTuple

import numpy as np

from solidgear.core import LADDER, SolidgearError, listed, pinned
from solidgear.core.judge.change import Side
from solidgear.core.plain import plain
from solidgear.show.plot import Make
from solidgear.show.run_tables import pairs_of
from solidgear.show.sheet import Section, Sheet
from solidgear.show.table import Column, Table, quantity, text
from solidgear.show.units import ENGINEERING, Units
from solidgear.show.words import hertz, percent
from solidgear.strength.deflection.at_rest import Deflection, deflection, with_ranges
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.shaft import JUDGE, LUMPED, mix_label
from solidgear.trains.assembly.slips import unit_slips
from solidgear.trains.assembly.tooth_stiffness import ToothStiffness, tooth_stiffness
from solidgear.trains.file.layout import PerTurn
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
from solidgear.trains.page import tables as train_tables
from solidgear.trains.page.chart import columns_chart, response_chart
from solidgear.trains.page.files import over_frequency
from solidgear.trains.response.respond import respond
from solidgear.trains.response.response import Peak, TrainResponse
from solidgear.two_designs import at_rest, beside
from solidgear.two_designs.at_rest import misalignment_changes
from solidgear.two_designs.beside import Beside, decibels
from solidgear.two_designs.differences import Difference
from solidgear.two_designs.shares import Bar, shares_chart, shares_table

#: column of the force of the mesh that drives
FORCE = "mesh force [N]"
#: peaks in a verdict, the loudest in either train
LOUDEST = 3
#: a reaction is drawn if it has this share of the largest of its unit in either train
LARGE = 0.2
#: panels of a chart: more do not fit a sheet of paper
MOST_PANELS = 8
#: what the charts of a section say
WORDS = {
    "response": "Dynamic mesh force and transmission error of each model.",
    "housing": (
        "Loads on the mounts of the housing and accelerations of its points, over all three "
        "directions."
    ),
    "shares": "Strain energy of every mode by part.",
}
EXCITED = "Steady response to the transmission error of each file."
REACTIONS = (
    f"From {100 * LARGE:g} % of the largest of their kind on, and the largest of every bearing. "
    "All are in results.json, response_a.csv and response_b.csv."
)
MOTIONS = "In the axes of each shaft's file: y along the shaft, x and z across it."
#: what columns of a unit are
KINDS = {
    "N": "forces",
    "N m": "moments",
    "m": "motions",
    "rad": "rotations",
    "m/s²": "accelerations",
}

#: columns of a response with their titles
Titled = list[tuple[str, str]]


class Top(NamedTuple):
    """The largest amplitude of a column of a response."""

    frequency_hz: float
    size: float


@dataclass(frozen=True, eq=False)
class OneTrain(Side):
    """One of the two trains, by one model of each shaft."""

    assembly: Assembly
    response: TrainResponse  #: named by the label
    #: elastic ones, also some above the highest frequency, where partners may lie
    modes: tuple[SeenMode, ...]
    loaded: Deflection | None  #: at its operating point

    @cached_property
    def tooth_stiffness(self) -> tuple[ToothStiffness, ...]:
        """Stiffness of the meshes whose teeth give it."""
        return tooth_stiffness(self.assembly)

    @property
    def title(self) -> str:
        """Title of the file."""
        return self.assembly.train.called

    def largest(self, column: str) -> Top | None:
        """Return the largest amplitude of a column of the response; None without it."""
        if column not in self.response.columns:
            return None
        size = np.abs(self.response.columns[column])
        k = int(np.nanargmax(size))
        return Top(float(self.response.frequency_hz[k]), float(size[k]))


@dataclass(frozen=True)
class Tops:
    """Largest amplitudes of a column in both trains, of which one may not have it."""

    plain_names = ("a", "b", "decibels")

    a: Top | None
    b: Top | None
    title: str = ""

    @property
    def sides(self) -> list[Top]:
        """Those that there are."""
        return [top for top in (self.a, self.b) if top is not None]

    @property
    def decibels(self) -> float | None:
        """Amplitude in B over that in A, dB."""
        return None if self.a is None or self.b is None else decibels(self.a.size, self.b.size)


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

    @property
    def shift(self) -> float | None:
        """Relative change of the frequency; None for a peak alone."""
        if self.a is None or self.b is None:
            return None
        return self.b.frequency_hz / self.a.frequency_hz - 1

    @property
    def label(self) -> str:
        """Mode that makes the peak in A, and in B where it is another."""
        labels = [peak.mode for peak in (self.a, self.b) if peak is not None]
        return beside.names(labels[0], labels[-1])


@dataclass(frozen=True, repr=False, eq=False)
class TwoTrains(Beside[OneTrain, SeenMode]):
    """Two trains beside each other; `changes` are those of their misalignment, where both have an
    operating point.
    """

    kind: ClassVar[str] = "two trains"

    models: dict[str, str]  #: by shaft, the same in both
    #: by whose transmission error both are driven, as :class:`solidgear.trains.file.pairs.Pair` has it
    mesh: str
    highest_hz: float  #: one mode of each pair at least lies below it
    peaks: tuple[PeakPair, ...]  #: of the mesh force, by frequency

    def told(self, units: Units = ENGINEERING) -> list[str]:
        """Return conclusions, with forces in some units."""
        points = [train.assembly.train.point for train in self.both]
        return [
            beside.inputs(self.inputs),
            _models(self),
            *_of_teeth(self, units),
            *_largest_force(self, units),
            *_loudest(self, units),
            *beside.modes(self.modes, "in the other train"),
            *_largest_reactions(self, units),
            *at_rest.sentences(points, self.loaded, self.changes, units),
            _sure(self),
        ]

    def sheet(self, units: Units = ENGINEERING) -> Sheet:
        """Return the sheet of terminal, page and JSON."""
        sections = _sections(self, units)
        return beside.sheet(
            self,
            units,
            sections,
            [
                beside.input_table(self, beside.SHORT),
                beside.mode_table(self),
                peak_table(self, units),
            ],
            closing=unpublished_lines(self.unpublished),
            lines={
                f"response_{letter}": over_frequency(train.response, self.per_turn(train))
                for letter, train in self.by_letter.items()
            },
            words={
                name: WORDS[s.anchor] for s in sections if s.anchor in WORDS for name in s.charts
            },
        )

    def data(self) -> dict[str, Any]:
        """Return the JSON data of trains alone: all numbers of the page and curves of the charts."""
        trains = self.by_letter.items()
        return {
            "trains": {k: {"file": t.name, **train_data(t.assembly)} for k, t in trains},
            "models": self.models,
            **({"mesh": self.mesh} if len(self.forces) > 1 else {}),
            "highest_hz": self.highest_hz,
            "peaks": self.peaks,
            "largest": {column: self.largest(column) for column in self.columns},
            "responses": {
                letter: {
                    "frequency_hz": train.response.frequency_hz,
                    "amplitude": {c: np.abs(v) for c, v in train.response.columns.items()},
                }
                for letter, train in trains
            },
            "misalignment": {
                n.name: {"unit": n.unit.split()[0], **plain(n.change)} for n in self.changes
            },
            "at_rest": {k: t.loaded.as_dict() for k, t in trains if t.loaded is not None},
            "unpublished": self.unpublished,
            "unpublished_lines": unpublished_lines(self.unpublished),
        }

    @property
    def loaded(self) -> tuple[Deflection | None, Deflection | None]:
        """Both at rest under torque."""
        return self.a.loaded, self.b.loaded

    @property
    def forces(self) -> dict[str, str]:
        """Columns of mesh forces that both have, that of the mesh which drives first, and their
        names.
        """
        train = self.a.assembly.train
        out = {FORCE: _force_of(train.named_mesh(self.mesh))}
        out |= {
            f"mesh force{p.label} [N]": _force_of(p) for p in train.teeth if p.name != self.mesh
        }
        return {c: name for c, name in out.items() if c in self.b.response.columns}

    @property
    def columns(self) -> list[str]:
        """Columns of both responses, by name and unit."""
        return list(dict.fromkeys([*self.a.response.columns, *self.b.response.columns]))

    def largest(self, column: str, title: str = "") -> Tops:
        """Return the largest amplitudes of a column."""
        return Tops(self.a.largest(column), self.b.largest(column), title)

    def decibels(self, column: str) -> float | None:
        """Return the largest amplitude of a column, B over A, in decibels; None where one train has
        none.
        """
        return self.largest(column).decibels

    @property
    def unpublished(self) -> dict[str, str]:
        """Values that no source gives, in either train; where they differ, assumed ones."""
        first, second = (train.assembly.train.unpublished() for train in self.both)
        return {**first, **{k: s for k, s in second.items() if s == "assumed" or k not in first}}

    def per_turn(self, side: OneTrain) -> PerTurn:
        """Return teeth of the mesh that drives which pass in a turn."""
        train = side.assembly.train
        return train.per_turn(train.named_mesh(self.mesh))


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
    >>> pair = two_trains(shops, ("overhung", "straddle"), (), "euler", highest_hz=1000.0)
    >>> [modes.a.name for modes in pair.modes][:2], pair.modes[0].change.verdict
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
    settles = all(model.partition("/")[0] not in LUMPED for model in mix.values())
    trains, motions_of = [], []
    for letter, name, assembly, train_ends in zip("AB", names, assemblies, ends):
        progress(f"{letter}: {mix_label(mix)}")
        response = respond(assembly, *mix.values(), highest_hz=highest, mesh=driver)
        system = assembly.system(*mix.values())
        modes, motions = modes_and_motions(assembly, system, highest * BEYOND, train_ends)
        motions_of.append(motions)
        progress(f"{letter}: error bars of its frequencies")
        barred = barred_modes(assembly, system, modes, mix)
        loaded, point = None, assembly.train.point
        if point is not None and settles:
            progress(f"{letter}: at {point.label}")
            loaded = with_ranges(assembly, deflection(assembly, point, *mix.values()))
        cautions = (*response.parting, *unit_slips(assembly), *response.cautions)
        trains.append(
            OneTrain(
                letter=letter,
                name=name,
                cautions=tuple(dict.fromkeys(cautions)),
                assembly=assembly,
                response=replace(response, name=f"{letter}: {name}"),
                modes=barred,
                loaded=loaded,
            )
        )
    mirrored = _mirrored(first, second)
    pairs = mode_pairs(
        [train.modes for train in trains], motions_of, highest, by_shape=not mirrored
    )
    left_out = sorted({*ports_of(first), *ports_of(second)} - {*ends[0], *ends[1]})
    pairing = "by the motions of the ports that both trains have"
    pairing += f" (all but {', '.join(left_out)})" if left_out else ""
    if mirrored:
        pairing = "by the motion that names them: hands or apexes differ, which mirrors shapes"
    return TwoTrains(
        a=trains[0],
        b=trains[1],
        inputs=tuple(inputs),
        changes=tuple(misalignment_changes([train.loaded for train in trains])),
        modes=tuple(p for p in pairs if p.within(highest)),
        pairing=pairing,
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


# ---------------------------------------------------------------------- sentences
def _of_teeth(pair: TwoTrains, units: Units) -> Iterator[str]:
    """Yield sentences on mesh stiffness that teeth give."""
    for letter, train in pair.by_letter.items():
        for mesh in train.tooth_stiffness:
            yield f"{letter.upper()}: {mesh.sentence(units)}"


def _models(trains: TwoTrains) -> str:
    titles = {s: LADDER[m].title if m in LADDER.bodies else m for s, m in trains.models.items()}
    words = mix_label(titles)
    train = trains.a.assembly.train
    if len({*trains.models.values()}) == 1:
        title = next(iter(titles.values()))
        of_bodies = {*trains.models.values()} <= {*LADDER.bodies}
        words = f"{train.every} shafts as {title}s" if of_bodies else f"{train.every} {title}"
    driver = train.named_mesh(trains.mesh)
    words += f", driven by the {driver.name}" if driver.label else ""
    damping = trains.a.response.damping
    limits = {side.assembly.train.ask.max_frequency for side in trains.both}
    lower = " (the lower of what both files ask for)" if len(limits) > 1 else ""
    return (
        f"Models of both trains: {words}, {damping} losses, up to {trains.highest_hz:g} Hz{lower}."
    )


def _largest_force(trains: TwoTrains, units: Units) -> Iterator[str]:
    for column, name in trains.forces.items():
        tops = trains.largest(column)
        texts = [
            f"{_at(top, units)} in {train.letter}{_of_mode(train, top)}"
            for train, top in zip(trains.both, tops.sides)
        ]
        yield f"Largest {name}: {' and '.join(texts)}{_level(tops.decibels)}."


def _at(top: Top, units: Units) -> str:
    return f"{units.text(top.size, 'N', 4)} at {hertz(top.frequency_hz)} Hz"


def _of_mode(train: OneTrain, top: Top) -> str:
    """Return the mode that makes a peak, in brackets; or the end of a range."""
    mode = next((p.mode for p in train.response.peaks if p.frequency_hz == top.frequency_hz), "")
    if top.frequency_hz == train.response.frequency_hz[-1]:
        mode = "the end of the range"
    return f" ({mode})" if mode else ""


def _level(change: float | None) -> str:
    return "" if change is None else f", {change:+.1f} dB"


def _loudest(trains: TwoTrains, units: Units) -> Iterator[str]:
    def size(pair: PeakPair) -> float:
        return max(p.force for p in (pair.a, pair.b) if p is not None)

    loud = sorted(trains.peaks, key=size, reverse=True)[:LOUDEST]
    for pair in [p for p in trains.peaks if p in loud]:
        a, b = pair.a, pair.b
        if a is not None and b is not None:
            forces = f"{units.number(a.force, 'N', 4)} to {units.text(b.force, 'N', 4)}"
            yield (
                f"The peak of {beside.names(a.mode, b.mode, 'in B ')} moves from "
                f"{hertz(a.frequency_hz)} to {hertz(b.frequency_hz)} Hz ({percent(pair.shift)}), "
                f"its mesh force from {forces} ({pair.decibels:+.1f} dB)."
            )
        for letter, peak, partner in (("A", a, b), ("B", b, a)):
            if peak is not None and partner is None:
                force = units.text(peak.force, "N", 4)
                place = f"{peak.mode}, {hertz(peak.frequency_hz)} Hz"
                yield f"A peak of {letter} alone: {place}, {force}."


def _largest_reactions(trains: TwoTrains, units: Units) -> Iterator[str]:
    texts, tops = [], []
    for train in trains.both:
        forces = [c for c in train.response.columns if " bearing " in c and c.endswith(" [N]")]
        by_column = {c: top for c in forces if (top := train.largest(c))}
        if not by_column:
            return
        column = max(by_column, key=lambda c: by_column[c].size)
        top = by_column[column]
        tops.append(top)
        texts.append(f"{column.removesuffix(' [N]')}, {_at(top, units)} in {train.letter}")
    level = _level(Tops(tops[0], tops[1]).decibels)
    yield f"Largest dynamic force on a bearing: {'; '.join(texts)}{level}."


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
    bearings = [
        b for train in trains.both for s in train.assembly.scenes.values() for b in s.bearings
    ]
    catalogued = any(b.catalogue is not None for b in bearings)
    left_out = ", not open data of catalogue bearings" if catalogued else ""
    return (
        f"Error bars are for frequencies, {percent(max(bars), signed=False)} at most (meshes of "
        f"harmonic shafts, reduction{left_out}); {reason}."
    )


# ---------------------------------------------------------------------- page
def _sections(pair: TwoTrains, units: Units) -> list[Section]:
    responses = [train.response for train in pair.both]
    teeth, teeth_b = (pair.per_turn(train) for train in pair.both)
    shared = teeth if (teeth, teeth.of) == (teeth_b, teeth_b.of) else None

    def section(
        anchor: str,
        title: str,
        words: str,
        groups: Sequence[Titled],
        first: dict[str, Make] | None = None,
        tables: Sequence[Table] = (),
    ) -> Section:
        """Return a section of columns, those of a group on charts of their own."""
        charts = first or {}
        filed = [*charts]
        for k, page in enumerate(_pages(groups)):
            charts[f"{anchor}_{k}"] = partial(columns_chart, responses, page, shared, units)
        columns = [column for group in groups for column in group]
        return Section(
            anchor,
            title,
            words,
            charts,
            [*tables, *largest_tables(pair, columns, units)],
            filed=filed,
        )

    force = partial(response_chart, responses, "", shared, None, {}, units)
    bars = _bars(pair)
    by_unit = [reactions(pair, unit) for unit in ("N", "N m")]
    by_shaft = [motions(pair, shaft) for shaft in pair.models]
    peaks = [peak_table(pair, units)]
    housing = train_tables.housing_columns(pair.columns)
    facts = [
        train_tables.facts(pair.results["trains"][letter], units, f"Train {train.label}")
        for letter, train in pair.by_letter.items()
    ]
    machine = pairs_of(pair.results["environment"], "Environment of the run")
    lines = " ".join(unpublished_lines(pair.unpublished))
    return [
        beside.input_section(pair),
        section("response", "Mesh force", EXCITED, [others(pair)], {"response": force}, peaks),
        Section("modes", "Modes", tables=[beside.mode_table(pair)]),
        section("reactions", "Bearing reactions", REACTIONS, by_unit),
        section("motions", "Motions of the lumped points", MOTIONS, by_shaft),
        section("housing", "Housing", "", [housing]),
        Section(
            "shares",
            "Strain energy",
            "",
            {"shares": partial(shares_chart, bars)},
            [shares_table([bar for _, group in bars for bar in group])],
        ),
        at_rest.section(pair.loaded, pair.changes, units),
        Section("trains", "Both trains", lines, tables=[*facts, machine]),
    ]


def _place(column: str) -> str:
    """Return the shaft or bearing of a column of a component."""
    return column.partition(" [")[0].rpartition(" ")[0]


def _titled(columns: Iterable[str]) -> Titled:
    """Return columns of components with their titles."""
    return [(c, f"{_place(c)}, {c.partition(' [')[0].rpartition(' ')[2]}") for c in columns]


def others(pair: TwoTrains) -> Titled:
    """Return columns of forces of meshes that do not drive, with their titles."""
    return [*pair.forces.items()][1:]


def reactions(pair: TwoTrains, unit: str) -> Titled:
    """Return columns of large bearing reactions of a unit, those of a bearing together."""
    sizes: dict[str, float] = {}
    of_bearing: dict[str, float] = {}
    for column in pair.columns:
        if " bearing " in column and column.endswith(f" [{unit}]"):
            sizes[column] = max(top.size for top in pair.largest(column).sides)
            place = _place(column)
            of_bearing[place] = max(sizes[column], of_bearing.get(place, 0.0))
    turn = [*pair.models]
    order = sorted(of_bearing, key=lambda name: (turn.index(name.partition(" bearing ")[0]), name))
    least = LARGE * max(sizes.values(), default=0.0)
    return _titled(
        column
        for name in order
        for column, size in sizes.items()
        if _place(column) == name and size > 0 and (size == of_bearing[name] or size >= least)
    )


def motions(pair: TwoTrains, shaft: str) -> Titled:
    """Return columns of the motions of the main lumped point of a shaft, with their titles."""
    return _titled(column for column in pair.columns if _place(column) == shaft)


def _pages(groups: Sequence[Titled]) -> Iterator[Titled]:
    """Split columns into groups that share a chart."""
    for group in groups:
        charts = math.ceil(len(group) / MOST_PANELS)
        size = 2 * math.ceil(len(group) / charts / 2) if group else 1  # alike, whole rows of two
        yield from (group[k : k + size] for k in range(0, len(group), size))


def peak_table(pair: TwoTrains, units: Units = ENGINEERING) -> Table:
    """Return peaks of the mesh force side by side."""
    columns = [
        text("its mode", lambda p: p.label),
        Column("A, Hz", lambda p: p.a and p.a.frequency_hz, hertz),
        Column("B, Hz", lambda p: p.b and p.b.frequency_hz, hertz),
        Column("difference", lambda p: p.shift, percent),
        quantity("A", "N", units, lambda p: p.a and p.a.force, 4),
        quantity("B", "N", units, lambda p: p.b and p.b.force, 4),
        Column("B over A", lambda p: p.decibels, "{:+.1f} dB".format),
    ]
    note = "Peaks of the same mode share a row. A dash: no peak in the other train."
    return Table("Peaks of the mesh force", columns, pair.peaks, note, style="ruled")


def largest_tables(pair: TwoTrains, columns: Titled, units: Units = ENGINEERING) -> list[Table]:
    """Return largest amplitudes of columns of the responses, a table for every unit."""
    out = []
    for si, title in KINDS.items():
        dimension = f"{si} moved" if si in ("m", "rad") else si
        heads = [
            text("", lambda tops: tops.title),
            quantity("A", dimension, units, lambda tops: tops.a and tops.a.size, 4),
            Column("A, at Hz", lambda tops: tops.a and tops.a.frequency_hz, hertz),
            quantity("B", dimension, units, lambda tops: tops.b and tops.b.size, 4),
            Column("B, at Hz", lambda tops: tops.b and tops.b.frequency_hz, hertz),
            Column("B over A", lambda tops: tops.decibels, "{:+.1f} dB".format),
        ]
        rows = [pair.largest(c, name) for c, name in columns if c.endswith(f" [{si}]")]
        out.append(Table(f"Largest {title} over frequency", heads, rows))
    return out


def _bars(trains: TwoTrains) -> list[tuple[str, list[Bar]]]:
    """Return the strain energy of every mode by part, A and B in turn, under the first name."""
    out = []
    for pair in trains.modes:
        bars = [
            Bar(letter, mode.name, mode.frequency_hz, mode.shares)
            for letter, mode in (("A", pair.a), ("B", pair.b))
            if mode is not None
        ]
        out.append((bars[0].name, bars))
    return out
