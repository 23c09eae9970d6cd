"""Two trains or two shafts beside each other: numbers, sentences and plain data that both share."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import numpy as np

from solidgear.comparison.two.differences import Difference
from solidgear.core import BarredMode
from solidgear.core.judge.change import Change, ModePair, Side
from solidgear.show.words import hertz, percent

#: entries of the input that are named in a sentence
NAMED = 3
#: letters of an entry in a sentence
WIDTH = 30


S = TypeVar("S", bound=Side)
M = TypeVar("M", bound=BarredMode)


@dataclass(frozen=True, repr=False, eq=False)
class Beside(Generic[S, M]):
    """Two of a kind beside each other."""

    a: S
    b: S
    inputs: tuple[Difference, ...]  #: differences of their files, or fields
    modes: tuple[ModePair[M], ...]  #: by frequency
    pairing: str  #: how modes are paired, in words
    seconds: float

    @property
    def both(self) -> tuple[S, S]:
        """Both sides."""
        return self.a, self.b

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


def decibels(a: float, b: float) -> float | None:
    """Return the level of an amplitude b over another, dB; None where either is zero."""
    return float(20 * np.log10(b / a)) if a > 0 and b > 0 else None


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


def modes(mode_pairs: Sequence[ModePair[Any]], place: str) -> Iterator[str]:
    """Yield sentences on pairs of modes: which are resolved, which moves most, and which are alone;
    ``place`` says where partners are missing, such as ``in the other train``.
    """
    pairs = [(p, p.change) for p in mode_pairs if p.change is not None]
    yield from resolved([change for _, change in pairs], "pairs of modes")
    # a name alone does not make two shapes one, where shapes can be compared
    by_shape = [pair for pair in pairs if pair[0].mac is not None] or pairs
    moved = max(by_shape, key=lambda pair: abs(pair[1].relative or 0.0), default=None)
    if moved is not None and moved[1].verdict != "not resolved":
        yield f"Largest change: {_moved(*moved)}."
    for letter, alone in (
        ("A", [p.a for p in mode_pairs if p.b is None]),
        ("B", [p.b for p in mode_pairs if p.a is None]),
    ):
        labels = [f"{m.name} ({hertz(m.frequency_hz)} Hz)" for m in alone if m is not None]
        if labels:
            yield f"Only in {letter}, without a partner {place}: {', '.join(labels)}."


def both_names(a: str, b: str) -> str:
    """Return the name of a mode, or both of its names where they differ."""
    return a if a == b else f"{a} (in B {b})"


def _moved(pair: ModePair[Any], change: Change) -> str:
    assert pair.a is not None and pair.b is not None
    name = both_names(pair.a.name, pair.b.name)
    return f"{name}, from {hertz(change.a)} to {hertz(change.b)} Hz ({percent(change.relative)})"
