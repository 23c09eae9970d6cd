"""Result of a search for the best design, in numbers and words."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, ClassVar

from solidgear.core.display import Displayed
from solidgear.core.judge.change import Change
from solidgear.variants.optimise.wishes import Wish
from solidgear.variants.sweep.bearing_task import without_bars


@dataclass(frozen=True)
class Design:
    """A design that was solved."""

    number: int  #: in order; 0 is the file as it is
    values: dict[str, Any]  #: of what varies, SI
    #: value, bar: of the goal
    value: float | None
    bar: float | None
    kept: bool  #: whether every limit is kept with its bar
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
    how: str = ""  #: what was searched
    model: str | None = None  #: that was given, and has no bars

    @property
    def gain(self) -> Change | None:
        """From the file to the best design; None where one of them has no number."""
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
            "keep": [str(one) for one in self.keep],
            "best": None if self.best is None else self.best.number,
            "at_end": list(self.at_end),
            "search": self.how,
            "bars": without_bars(self.model) if self.model else "beside each value",
            "gain": None if self.gain is None else self.gain.as_dict(),
            "designs": [
                {
                    "number": one.number,
                    **one.values,
                    "value": one.value,
                    "bar": one.bar,
                    "kept": one.kept,
                    "status": one.status,
                }
                for one in self.path
            ],
            "sentences": self.sentences,
        }


def _sentences(found: Optimum) -> Iterator[str]:
    best, gain = found.best, found.gain
    solved = sum(one.status == "ok" for one in found.path)
    limits = ", ".join(map(str, found.keep))
    if not solved:
        yield f"No design could be solved; the file as it is: {found.path[0].status}."
        return
    if best is None:
        yield f"No design of {solved} keeps {limits}, error bars included."
        yield from _nearest_miss(found)
        return
    values = ", ".join(f"{label} = {value:.6g}" for label, value in best.values.items())
    told = _with_bar(best.value, best.bar)
    yield f"{found.goal}: {told} (SI) at {values}."
    if found.how:
        yield f"Searched: {found.how}; {solved} designs solved."
    if best.number == 0:
        yield "No design is better than the file as it is, as far as the error bars tell."
    elif gain is not None:
        file = f"the file as it is, {_with_bar(gain.a, gain.bar_a)}"
        if not found.path[0].kept:
            file += ", which misses a limit"
        if gain.verdict == "no band":
            yield f"{100 * (gain.relative or 0.0):+.3g} % from {file}; a model that is given has no error bars."
        elif gain.verdict == "resolved":
            yield f"{100 * (gain.relative or 0.0):+.3g} % from {file}."
        else:
            yield (
                f"No gain is claimed over {file}: the difference is within the error bars of both; a "
                "smaller --tol tells them apart."
            )
    like = [one for one in found.path if one is not best and _as_good(found, one)]
    if like:
        yield (
            f"{len(like)} more {'designs are' if len(like) > 1 else 'design is'} as good within the "
            "error bars."
        )
    for label in found.at_end:
        yield f"{label} is at the end of its range: a wider one may hold a better design."


def _with_bar(value: float | None, bar: float | None) -> str:
    return f"{value:.6g}" + (f" ± {bar:.2g}" if bar else "")


def _as_good(found: Optimum, one: Design) -> bool:
    """Tell whether bars do not tell a design from the best."""
    best = found.best
    if best is None or not one.kept or one.value is None or best.value is None:
        return False
    return Change(one.value, best.value, one.bar, best.bar).verdict == "not resolved"


def _nearest_miss(found: Optimum) -> Iterator[str]:
    misses = [
        (max(wish.missing(one.row) for wish in found.keep), one)
        for one in found.path
        if one.status == "ok"
    ]
    if misses:
        short, one = min(misses, key=lambda pair: pair[0])
        values = ", ".join(f"{label} = {value:.6g}" for label, value in one.values.items())
        yield f"The nearest misses by {100 * short:.3g} % of the limit, at {values} (SI)."
