"""Result of a search for the best design, as numbers and sentences."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, ClassVar

from solidgear.core import Displayed
from solidgear.core.judge.change import Change
from solidgear.variants.optimise.wishes import Wish
from solidgear.variants.sweep.file_task import without_bars


@dataclass(frozen=True)
class Design:
    """A design that was solved."""

    number: int  #: in order; 0 is the file as it is
    values: dict[str, Any]  #: of the entries that vary, SI
    #: value, bar: of the goal, and its error bar
    value: float | None
    bar: float | None
    kept: bool  #: whether every limit is kept with its error bar
    status: str  #: ``ok``, or why it has no numbers
    row: dict[str, Any]  #: all numbers


@dataclass(frozen=True, repr=False, eq=False)
class Optimum(Displayed):
    """Result of a search."""

    shown: ClassVar[str] = "variants.optimise.tables:designs"

    scene: str
    goal: Wish
    keep: tuple[Wish, ...]
    path: tuple[Design, ...]  #: all designs, the file as it is first
    best: Design | None  #: none where no design keeps every limit
    at_end: tuple[str, ...]  #: entries of the best design that are at an end of their range
    how: str = ""  #: the search in words
    model: str | None = None  #: that was given, and has no error bars

    @property
    def gain(self) -> Change | None:
        """Change from the file to the best design; None where one of them has no number."""
        first, best = self.path[0], self.best
        if best is None or first.value is None or best.value is None:
            return None
        return Change(first.value, best.value, first.bar, best.bar)

    @property
    def sentences(self) -> list[str]:
        """Conclusions."""
        return list(_sentences(self))

    @property
    def results(self) -> dict[str, Any]:
        """Plain data that JSON can hold, SI."""
        return {
            "kind": "optimum",
            "scene": self.scene,
            "goal": str(self.goal),
            "keep": [str(wish) for wish in self.keep],
            "best": None if self.best is None else self.best.number,
            "at_end": list(self.at_end),
            "search": self.how,
            "bars": without_bars(self.model) if self.model else "beside each value",
            "gain": None if self.gain is None else self.gain.as_dict(),
            "designs": [
                {
                    "number": design.number,
                    **design.values,
                    "value": design.value,
                    "bar": design.bar,
                    "kept": design.kept,
                    "status": design.status,
                }
                for design in self.path
            ],
            "sentences": self.sentences,
        }


def _sentences(optimum: Optimum) -> Iterator[str]:
    best, gain = optimum.best, optimum.gain
    solved = sum(design.status == "ok" for design in optimum.path)
    if not solved:
        yield f"No design could be solved; the file as it is: {optimum.path[0].status}."
        return
    if best is None:
        limits = ", ".join(map(str, optimum.keep))
        yield f"No design of {solved} keeps {limits}, error bars included."
        yield from _nearest_miss(optimum)
        return
    yield f"{optimum.goal}: {_with_bar(best.value, best.bar)} (SI) at {_listed_values(best)}."
    if optimum.how:
        yield f"Searched: {optimum.how}; {solved} designs solved."
    if best.number == 0:
        yield "No design is better than the file as it is by more than the error bars."
    elif gain is not None:
        file = f"the file as it is, {_with_bar(gain.a, gain.bar_a)}"
        if not optimum.path[0].kept:
            file += ", which misses a limit"
        percent = f"{100 * (gain.relative or 0.0):+.3g} % from {file}"
        if gain.verdict == "no band":
            yield f"{percent}; a model that is given has no error bars."
        elif gain.verdict == "resolved":
            yield f"{percent}."
        else:
            yield (
                f"No gain is claimed over {file}: the difference is within the error bars; a "
                "smaller --tol narrows them."
            )
    count = sum(design is not best and _as_good(optimum, design) for design in optimum.path)
    if count:
        designs = "designs are" if count > 1 else "design is"
        yield f"{count} more {designs} as good within the error bars."
    for label in optimum.at_end:
        yield f"{label} is at the end of its range; a wider range may hold a better design."


def _with_bar(value: float | None, bar: float | None) -> str:
    return f"{value:.6g}" + (f" ± {bar:.2g}" if bar else "")


def _listed_values(design: Design) -> str:
    return ", ".join(f"{label} = {value:.6g}" for label, value in design.values.items())


def _as_good(optimum: Optimum, design: Design) -> bool:
    """True if error bars do not distinguish a design from the best."""
    best = optimum.best
    if best is None or not design.kept or design.value is None or best.value is None:
        return False
    return Change(design.value, best.value, design.bar, best.bar).verdict == "not resolved"


def _nearest_miss(optimum: Optimum) -> Iterator[str]:
    misses = [
        (max(wish.missing(design.row) for wish in optimum.keep), design)
        for design in optimum.path
        if design.status == "ok"
    ]
    if misses:
        short, design = min(misses, key=lambda pair: pair[0])
        yield (
            f"The nearest misses by {100 * short:.3g} % of the limit, at {_listed_values(design)} "
            "(SI)."
        )
