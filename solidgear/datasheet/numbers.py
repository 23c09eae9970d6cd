"""Numbers of a shaft with both error bars: answered anew, or those of a comparison that is there."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from solidgear.core import LADDER, OpenNumbers, Quantity, Record, Scene
from solidgear.core.judge.answer import answer, asked_for
from solidgear.datasheet.facts import Amount, Figure, Frequency, Range, Remark, Trust
from solidgear.show.remarks import open_ranges
from solidgear.trains.assembly.shaft import JUDGE

Progress = Callable[[str], None]
#: frequencies that a sheet lists beside the numbers asked for
FREQUENCIES = tuple(map(Quantity, ("bending 1", "bending 2", "axial 1", "torsion 1")))


@dataclass(frozen=True)
class Numbers:
    """Numbers of a shaft, and the model that they come from."""

    wanted: tuple[Quantity, ...]  #: those that are judged
    by_name: Mapping[Quantity, Figure]
    trust: Trust
    ranges: OpenNumbers

    @property
    def figures(self) -> tuple[Figure, ...]:
        """Numbers asked for."""
        return tuple(self.by_name[q] for q in self.wanted if q in self.by_name)

    @property
    def frequencies(self) -> tuple[Frequency, ...]:
        """Natural frequencies, asked for or not."""
        figures = [figure for name, figure in self.by_name.items() if name.is_frequency]
        return tuple(Frequency(f.name, f.value, f.bar, f.open) for f in figures)

    def cautions(self) -> Iterator[Remark]:
        """Yield cautions on the numbers."""
        bars = [figure.bar for figure in self.figures if figure.bar is not None]
        if not self.trust.reached and bars:
            tolerance = Amount(100 * self.trust.tolerance, "%", None)
            yield Remark(
                "caution tolerance",
                {"bar": Amount(100 * max(bars), "%", 2), "tolerance": tolerance},
            )
        for name in self.ranges.lost:
            yield Remark("caution lost", {"name": name})


def answered_numbers(scene: Scene, tol: float | str | None, progress: Progress) -> Numbers:
    """Return the numbers of a shaft from the cheapest model that can show them."""
    progress("numbers")
    wanted = asked_for(scene, ())
    names = [*wanted]
    if LADDER[JUDGE].can_model(scene):  # of other solids every further number is dear
        names += [q for q in FREQUENCIES if q not in wanted]
    answered = answer(scene, tol, names)
    progress("what the data leave open")
    ranges = open_ranges(scene)
    figures = {
        v.quantity: _figure(v.quantity, v.value, v.bar, ranges)
        for v in answered.values
        if not v.zero
    }
    model, tolerance = answered.rung, answered.tolerance
    return Numbers(wanted, figures, _trust(model, tolerance, wanted, figures), ranges)


def recorded_numbers(record: Record, scene: Scene) -> Numbers:
    """Return the numbers that a comparison has of the model it trusts, or else of its reference."""
    wanted, verdict = asked_for(scene, ()), record.verdict
    key = verdict.trust or verdict.reference or next(reversed(record.models), "")
    model, figures = record.model(key), {}
    for name in dict.fromkeys((*wanted, *FREQUENCIES)):
        mode = model.mode(name) if name.is_frequency else None
        value = mode.frequency_hz if mode is not None else None
        if not name.is_frequency:
            value = model.value(name)
        if value:
            figures[name] = _figure(name, value, model.bars.get(name), record.open)
    trust = _trust(key, scene.ask.tolerance, wanted, figures)
    return Numbers(wanted, figures, trust, record.open)


def _figure(name: Quantity, value: float, bar: float | None, ranges: OpenNumbers) -> Figure:
    """Return a number with both error bars."""
    number = ranges.of(name)
    open_: Range = None
    if number is not None and number.total is not None:
        open_ = number.total.low or 0.0, number.total.high or 0.0
    finite = bar if bar is not None and math.isfinite(bar) else None
    return Figure(str(name), value, name.unit, finite, open_)


def _trust(
    model: str, tolerance: float, wanted: tuple[Quantity, ...], figures: Mapping[Quantity, Figure]
) -> Trust:
    """Return the model of numbers, with the widest error bars of those asked for."""
    judged_figures = {name: figures[name] for name in wanted if name in figures}
    bars = {name: f.bar for name, f in judged_figures.items() if f.bar is not None}
    reached = len(bars) == len(judged_figures) and all(bar <= tolerance for bar in bars.values())
    return Trust(
        model=model,
        tolerance=tolerance,
        reached=bool(bars) and reached,
        static_bar=max((bar for name, bar in bars.items() if not name.is_frequency), default=None),
        frequency_bar=max((bar for name, bar in bars.items() if name.is_frequency), default=None),
    )
