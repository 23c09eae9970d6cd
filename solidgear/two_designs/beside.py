"""Two designs of a kind beside each other: their numbers, modes and inputs, and what every kind says
and shows of them.
"""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar, Generic, TypeVar

import numpy as np

from solidgear.core import COMPLIANCE, BarredMode, ByName, Quantity, Sheeted, environment
from solidgear.core.judge.change import Change, ModePair, Side
from solidgear.core.plain import plain
from solidgear.show.command import caution
from solidgear.show.sheet import Section, Sheet, Terminal, write_folder
from solidgear.show.table import WORD, Cell, Column, Table, text
from solidgear.show.units import ENGINEERING, Units, in_ascii, units_named
from solidgear.show.words import hertz, percent, seconds
from solidgear.two_designs.differences import Difference

#: entries of the input that are named in a sentence, and letters of each
NAMED, WIDTH = 3, 30
#: letters of an entry on a page and in a terminal
LONG, SHORT = 60, 34
#: keys of results.json in their order; either kind has some of its own
KEYS = (
    "kind shafts trains models mesh tolerance highest_hz differences sentences numbers under_loads "
    "asked open paired modes alone peaks largest responses misalignment at_rest cautions unpublished "
    "unpublished_lines environment seconds_total"
).split()

S = TypeVar("S", bound=Side)
M = TypeVar("M", bound=BarredMode)


@dataclass(frozen=True)
class NumberChange:
    """A number of both designs."""

    name: str  #: quantity, ``mass``, or a number of the misalignment
    unit: str  #: SI
    change: Change
    #: the difference is relative to this: for couplings the geometric mean of both diagonal
    #: entries of A, else the number of A
    scale: float
    partner: str = ""  #: name of the mode of B where that is another one, else nothing

    @property
    def relative(self) -> float | None:
        """Difference over the scale; None where that is zero."""
        return self.change.difference / self.scale if self.scale else None

    @property
    def verdict(self) -> str:
        """``resolved``, ``not resolved`` or ``no band``."""
        return self.change.verdict

    @property
    def better(self) -> str:
        """Letter of the shaft that is stiffer, or higher in frequency, by more than both error
        bars; empty where neither is.
        """
        name = Quantity(self.name)
        if self.verdict != "resolved" or name.is_coupling:
            return ""
        return "B" if (self.change.difference > 0) != (name.kind == COMPLIANCE) else "A"


@dataclass(frozen=True, repr=False, eq=False)
class Beside(ByName[NumberChange], Sheeted, ABC, Generic[S, M]):
    """Two designs of a kind beside each other."""

    kind: ClassVar[str]  #: in words

    a: S
    b: S
    inputs: tuple[Difference, ...]  #: differences of their files, or fields
    changes: tuple[NumberChange, ...]
    modes: tuple[ModePair[M], ...]  #: by frequency
    pairing: str  #: how modes are paired, in words
    seconds: float

    @property
    def both(self) -> tuple[S, S]:
        """Both sides."""
        return self.a, self.b

    @property
    def by_letter(self) -> dict[str, S]:
        """Sides by their letters in files."""
        return {"a": self.a, "b": self.b}

    @property
    def by_name(self) -> dict[str, NumberChange]:
        """Changes of numbers by their names."""
        return {number.name: number for number in self.changes}

    @property
    def cautions(self) -> list[str]:
        """Cautions of both; one that is not shared begins with the letter of the side."""
        shared = [text for text in self.a.cautions if text in self.b.cautions]
        single = [
            f"{side.letter}: {text}"
            for side in self.both
            for text in side.cautions
            if text not in shared
        ]
        return [*shared, *single]

    @property
    def sentences(self) -> list[str]:
        """Conclusions in engineering units."""
        return self.told()

    @abstractmethod
    def told(self, units: Units = ENGINEERING) -> list[str]:
        """Return the conclusions, with their numbers in the given units."""

    @abstractmethod
    def sheet(self, units: Units = ENGINEERING) -> Sheet:
        """Return the sheet of terminal, page and JSON."""

    @abstractmethod
    def data(self) -> dict[str, Any]:
        """Return the JSON data of this kind alone."""

    @cached_property
    def results(self) -> dict[str, Any]:
        """Plain data that JSON can hold, SI."""
        data = {
            "kind": self.kind,
            "differences": self.inputs,
            "sentences": self.sentences,
            "paired": self.pairing,
            "modes": self.modes,
            "cautions": self.cautions,
            "environment": environment(),
            "seconds_total": self.seconds,
            **self.data(),
        }
        return plain({key: data[key] for key in sorted(data, key=KEYS.index)})

    def write_report(self, out: str | os.PathLike, *, units: str = "engineering") -> Path:
        """Write results.json and report.html into a folder.

        Parameters
        ----------
        out : path
            The folder.
        units : {'engineering', 'si', 'us'}
            Units of the page; results.json is SI always.

        Returns
        -------
        pathlib.Path
            The page.

        Raises
        ------
        SolidgearError
            If the folder cannot be written, or units are unknown.
        """
        return write_folder(self.sheet(units_named(units)), Path(out))[0]


def sheet(
    pair: Beside[S, M],
    units: Units,
    sections: Sequence[Section],
    printed: Sequence[Table],
    *,
    sentences_first: bool = False,
    closing: Sequence[str] = (),
    lines: Mapping[str, Table] | None = None,
    words: Mapping[str, str] | None = None,
) -> Sheet:
    """Return the sheet of two designs: sections of the page, tables and last lines of a terminal."""
    heading = [f"{side.label}, {side.title}" for side in pair.both]
    verdict = pair.told(units)
    sentences = [in_ascii(sentence) for sentence in verdict]
    if sentences_first:
        heading, sentences = [*heading, *sentences], []
    return Sheet(
        name="report",
        json_name="results",
        title=" beside ".join(dict.fromkeys(side.title for side in pair.both)),
        lead=f"solidgear report on {pair.kind}: {'; '.join(side.label for side in pair.both)}.",
        tables=(),
        data=pair.results,
        lines=lines or {},
        verdict=verdict,
        notes=[f"Whole run: {seconds(pair.seconds)} s."],
        cautions=pair.cautions,
        sections=sections,
        terminal=Terminal(
            heading=heading,
            tables=printed,
            closing=[*closing, *map(caution, pair.cautions)],
            results=sentences,
        ),
        words=words or {},
    )


# ---------------------------------------------------------------------- inputs
def inputs(differences: Sequence[Difference]) -> str:
    """Return a sentence on the entries in which two inputs differ."""
    numbers = [d for d in differences if not d.in_words]
    if not differences:
        return "Nothing differs in the input."
    if not numbers:
        return "Only words differ in the input (titles, sources), so that no number does."
    changes = []
    for difference in numbers[:NAMED]:
        a, b = difference.texts(WIDTH)
        if a is None or b is None:
            changes.append(f"{difference.path} {'added' if a is None else 'removed'}")
        else:
            changes.append(f"{difference.path} from {a} to {b}")
    more = f" and {len(numbers) - NAMED} more" if len(numbers) > NAMED else ""
    return f"Changed: {'; '.join(changes)}{more}."


def input_section(pair: Beside[S, M]) -> Section:
    """Return the section of the entries that differ."""
    words = "" if pair.inputs else inputs(pair.inputs)
    return Section("input", "Input", words, tables=[input_table(pair)])


def input_table(pair: Beside[S, M], width: int = LONG) -> Table:
    """Return entries in which the files differ, each in at most so many letters."""
    rows = [[difference.path, *difference.texts(width)] for difference in pair.inputs]
    note = "A dash: not in that file."
    if any(str(cell).endswith("...") for row in rows for cell in row):
        note += " Entries that end in dots are whole in results.json."
    columns = [text("entry"), text("A"), text("B")]
    return Table("Input that differs", columns, rows, note, style="ruled")


# ---------------------------------------------------------------------- modes
def modes(mode_pairs: Sequence[ModePair[M]], place: str) -> Iterator[str]:
    """Yield sentences on pairs of modes: which are resolved, which moves most, and which are alone;
    ``place`` says where partners are missing, such as ``in the other train``.
    """
    pairs = [(p, p.change) for p in mode_pairs if p.change is not None]
    yield from resolved([change for _, change in pairs], "pairs of modes")
    # a name alone does not make two shapes one, where shapes can be compared
    by_shape = [pair for pair in pairs if pair[0].mac is not None] or pairs
    moved = max(by_shape, key=lambda pair: abs(pair[1].relative or 0.0), default=None)
    if moved is not None and moved[1].verdict != "not resolved":
        name, change = mode_label(moved[0], "in B "), moved[1]
        hz = f"from {hertz(change.a)} to {hertz(change.b)} Hz"
        yield f"Largest change: {name}, {hz} ({percent(change.relative)})."
    for letter, alone in (
        ("A", [p.a for p in mode_pairs if p.b is None]),
        ("B", [p.b for p in mode_pairs if p.a is None]),
    ):
        labels = [f"{m.name} ({hertz(m.frequency_hz)} Hz)" for m in alone if m is not None]
        if labels:
            yield f"Only in {letter}, without a partner {place}: {', '.join(labels)}."


def resolved(changes: Sequence[Change], plural: str) -> Iterator[str]:
    """Yield a sentence on how many changes of numbers called ``plural``, such as ``pairs of
    modes``, exceed their error bars; none where a change has no error bar.
    """
    verdicts = [change.verdict for change in changes]
    count, sure = len(verdicts), verdicts.count("resolved")
    if not verdicts or "no band" in verdicts:
        return
    how_many = {0: "None of", count: "All"}.get(sure, f"{sure} of")
    yield f"{how_many} {count} {plural} changed by more than their error bars."


def mode_table(pair: Beside[S, M]) -> Table:
    """Return natural frequencies side by side, with the verdict on each difference."""
    columns = [
        text("mode", mode_label),
        Column("A, Hz", lambda p: p.a and p.a.frequency_hz, hertz),
        Column("B, Hz", lambda p: p.b and p.b.frequency_hz, hertz),
        Column("difference", lambda p: p.change and relative(p.change, abs(p.change.a))),
    ]
    note = f"Paired {pair.pairing}. "
    if any(p.change is not None and p.change.band is not None for p in pair.modes):
        columns.append(Column("both error bars", lambda p: p.change and band(p.change)))
        columns.append(Column("", lambda p: p.verdict, kind=WORD, name="verdict"))
        note += (
            "Both error bars: their sum, relative to A; a smaller difference is not resolved, "
            "which is not agreement. "
        )
    columns.append(Column("MAC", lambda p: p.mac, "{:.2f}".format))
    note += (
        "MAC: likeness of both shapes; a dash: paired by name, so that shapes may differ, or "
        "without a partner."
    )
    return Table("Natural frequencies", columns, pair.modes, note, style="ruled")


def mode_label(pair: ModePair[M], of_b: str = "B: ") -> str:
    """Return the name of a mode in A, and in B where it is another."""
    labels = [mode.name for mode in (pair.a, pair.b) if mode is not None]
    return names(labels[0], labels[-1], of_b)


def names(a: str, b: str, of_b: str = "B: ") -> str:
    """Return a name in A, and in B where it is another."""
    return a if a == b else f"{a} ({of_b}{b})"


def relative(change: Change, scale: float) -> Cell:
    """Return the difference over a scale, in per cent, marked where it is within the error bars."""
    share = change.difference / scale if scale else None
    look = "unresolved" if change.verdict == "not resolved" else ""
    return Cell(share, look, percent(share))


def band(change: Change) -> Cell | None:
    """Return the sum of both error bars over A, in per cent."""
    if change.band is None or not change.a:
        return None
    share = change.band / abs(change.a)
    return Cell(share, "", percent(share, signed=False))


def decibels(a: float, b: float) -> float | None:
    """Return the level of an amplitude b over another, dB; None where either is zero."""
    return float(20 * np.log10(b / a)) if a > 0 and b > 0 else None
