"""Two shafts beside each other: what differs in them, and what that does to their numbers.

Both are solved until every bar is within a tenth of their tolerance, so that a difference which
matters is more than the bars.  A frequency belongs to that of the mode of the same shape where
both shafts are described at the same stations, else to the mode of the same name.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from solidgear.display import Displayed
from solidgear.judge.answer import LEAST_TOLERANCE
from solidgear.judge.correlation import pair_modes
from solidgear.judge.open_record import OpenNumbers
from solidgear.judge.quantities import in_order, judged, size
from solidgear.machine.threads import pinned
from solidgear.quantity import COMPLIANCE, QUANTITIES, Quantity
from solidgear.report.two_shafts_page import write_two_shafts
from solidgear.report.units import ENGINEERING, Units, units_named
from solidgear.scene.differences import Difference, scene_differences
from solidgear.solve.modes import ModeSet
from solidgear.studies import two_shafts_told as told
from solidgear.studies.beside import Beside, all_pairs
from solidgear.studies.budget import beside as left_open
from solidgear.studies.change import BarredMode, Change, ModePair
from solidgear.studies.one_shaft import OneShaft, Progress, one_shaft

if TYPE_CHECKING:
    from solidgear.scene import Scene

#: part of the tolerance that the bars of both are brought to
SHARE = 0.1
#: entries of the other plane that are those of the first unless bearings or features differ
TWINS = {
    Quantity(f"{kind}_{its}"): Quantity(f"{kind}_{own}")
    for kind in "CK"
    for its, own in (("xx", "zz"), ("x,thz", "z,thx"), ("thz", "thx"))
}
#: relative; twins closer than this are one number
SAME = 1e-9


@dataclass(frozen=True)
class NumberChange:
    """A number of both shafts."""

    name: str  #: quantity, or ``mass``
    unit: str  #: SI
    change: Change
    #: what its difference is relative to: of couplings the geometric mean of both diagonal entries
    #: of A, of all else the number of A
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
        """Letter of the one that is stiffer, or higher in frequency, by more than both bars; empty
        where neither is.
        """
        name = Quantity(self.name)
        if self.verdict != "resolved" or name.is_coupling:
            return ""
        return "B" if (self.change.difference > 0) != (name.kind == COMPLIANCE) else "A"


@dataclass(frozen=True, repr=False, eq=False)
class TwoShafts(Beside[OneShaft, BarredMode], Displayed):
    """Two shafts beside each other.

    Attributes
    ----------
    a, b : OneShaft
        ``both``, with their ``cautions``.
    inputs : tuple of Difference
        Of their files, or fields.
    modes : tuple of ModePair
        By frequency.
    pairing : str
        How modes belong together, in words.
    """

    shown: ClassVar[str] = "two_shafts"

    tolerance: float  #: relative, that every bar was brought to
    #: mass, entries of C and K at the lumped points, first frequencies
    changes: tuple[NumberChange, ...]
    alone: dict[str, tuple[str, ...]]  #: numbers that one has and the other does not, by letter
    open: tuple[OpenNumbers, OpenNumbers]  #: what the data of each leave open

    @property
    def asks(self) -> bool:
        """Tell whether a scene names the numbers that it is about."""
        return any(one.scene.ask.quantities for one in self.both)

    @property
    def asked(self) -> list[NumberChange]:
        """Numbers that either scene asks for; the usual ones where none does."""
        names = [
            name
            for one in self.both
            if one.scene.ask.quantities or not self.asks
            for name in judged(one.scene)
        ]
        known = {one.name: one for one in self.changes}
        return [known[name] for name in dict.fromkeys(names) if name in known]

    def __getitem__(self, name: str) -> NumberChange:
        return next(one for one in self.changes if one.name == name)

    @property
    def sentences(self) -> list[str]:
        """Conclusions."""
        return self.told()

    def told(self, units: Units = ENGINEERING) -> list[str]:
        """Conclusions, with their numbers in some units."""
        return told.sentences(self, units)

    @cached_property
    def results(self) -> dict[str, Any]:
        """Plain data that JSON can hold, SI."""
        return told.results(self)

    def write_report(self, out: str | os.PathLike, *, units: str = "engineering") -> Path:
        """Write results.json and report.html into a folder.

        Parameters
        ----------
        out : path
            The folder.
        units : {'engineering', 'si', 'us'}
            Of the page; results.json is SI always.

        Returns
        -------
        pathlib.Path
            Of the page.

        Raises
        ------
        SolidgearError
            If the folder cannot be written, or units are unknown.
        """
        return write_two_shafts(self, out, units_named(units))


@pinned
def two_shafts(
    scenes: Sequence[Scene],
    names: Sequence[str] = (),
    inputs: Sequence[Difference] | None = None,
    progress: Progress = lambda _: None,
) -> TwoShafts:
    """Two shafts beside each other, each by the cheapest solid whose bars are within a tenth of the
    smaller tolerance of both; by default called as the scenes are, with the fields that differ for
    inputs.
    """
    start = perf_counter()
    first, other = scenes
    tol = max(SHARE * min(s.ask.tolerance for s in scenes), LEAST_TOLERANCE)
    its = {port.name for port in other.further_ports}
    points = [port.name for port in first.further_ports if port.name in its]
    a, b = (
        _settled(scene, tol, letter, name, points, progress)
        for letter, name, scene in zip("AB", names or [s.name for s in scenes], scenes)
    )
    pairs, pairing = _paired(a, b)
    changes = (_mass(a, b), *_statics(a, b), *_frequencies(a, b, pairs))
    differ = tuple(scene_differences(first, other) if inputs is None else inputs)
    alone = {
        one.letter: tuple(str(q) for q in in_order(one.values) if q not in second.values)
        for one, second in ((a, b), (b, a))
    }
    progress("what the data leave open")
    ranges = left_open(first), left_open(other)
    spent = perf_counter() - start
    return TwoShafts(a, b, differ, tuple(pairs), pairing, spent, tol, changes, alone, ranges)


def _settled(
    scene: Scene, tol: float, letter: str, name: str, points: list[str], progress: Progress
) -> OneShaft:
    found = one_shaft(scene, tol, letter, name, points, progress=progress)
    found.settled.body.cache.clear()
    return found


def _mass(a: OneShaft, b: OneShaft) -> NumberChange:
    bars = [None if one.mass_bar is None else one.mass_bar * one.mass for one in (a, b)]
    return NumberChange("mass", "kg", Change(a.mass, b.mass, *bars), a.mass)


def _statics(a: OneShaft, b: OneShaft) -> Iterable[NumberChange]:
    for name in in_order(a.values):
        if name.is_frequency or name not in b.values or _twin(a, name) and _twin(b, name):
            continue
        change = Change(a.values[name], b.values[name], a.bar(name), b.bar(name))
        yield NumberChange(str(name), name.unit, change, size(a.values, name))


def _twin(one: OneShaft, name: Quantity) -> bool:
    """True for an entry of the other plane that is that of the first plane over again."""
    if name not in TWINS or TWINS[name] not in one.values:
        return False
    twin = TWINS[name]
    apart = abs(abs(one.values[name]) - abs(one.values[twin]))
    return apart <= SAME * size(one.values, twin)


def _frequencies(
    a: OneShaft, b: OneShaft, pairs: Sequence[ModePair[BarredMode]]
) -> Iterable[NumberChange]:
    """First frequencies, each beside that of the mode that its own belongs to."""
    partners = {p.a.name: (p.b.name, p.change) for p in pairs if p.a and p.b and p.change}
    for name in (q for q in QUANTITIES if q.is_frequency):
        mode = a.modes.named(name)
        if mode is None or str(mode.name) not in partners:
            continue
        its, change = partners[str(mode.name)]
        other = "" if its == mode.name else its
        yield NumberChange(str(name), "Hz", change, abs(change.a), other)


def _paired(a: OneShaft, b: OneShaft) -> tuple[list[ModePair[BarredMode]], str]:
    """Modes of both lists with their partners, and in words how they were found."""
    mine, its = (
        [one.seen(m) for m in one.modes.whole.modes if m.frequency_hz > 0] for one in (a, b)
    )
    alike: list[ModePair[BarredMode]] = []
    words = "by name, for both shafts are not told at the same places along the axis"
    if _same_stations(a.modes, b.modes):
        words = "by the motions of sections along the axis, and by name where no shape is certain"
        for p in pair_modes(b.modes, a.modes):
            partners = [m for m in (p.mode, *p.others) if m is not None and p.certain]
            alike += [ModePair(a.seen(p.reference), b.seen(m), p.mac or None) for m in partners]
    listed = [{str(m.name) for m in one.modes.modes} for one in (a, b)]
    # a partner above the end of the other list is none that is missing
    end = min(max((m.frequency_hz for m in own), default=0.0) for own in (mine, its))
    pairs = [
        pair
        for pair in all_pairs(alike, mine, its, lambda mode: mode.name)
        if any(m is not None and m.name in names for m, names in zip((pair.a, pair.b), listed))
        and (pair.change is not None or pair.within(end))
    ]
    return pairs, words


def _same_stations(one: ModeSet, other: ModeSet) -> bool:
    same = one.stations.shape == other.stations.shape
    return same and bool(np.allclose(one.stations, other.stations))
