"""Two trains or two shafts beside each other: numbers, sentences and plain data that both share."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Generic, TypeVar

import numpy as np

from solidgear.report.words import hertz, percent
from solidgear.scene.differences import Difference
from solidgear.studies.change import BarredMode, Change, ModePair

#: entries of the input that are named in a sentence
NAMED = 3


@dataclass(frozen=True, eq=False)
class Side:
    """One of the two."""

    #: letter, name: ``A`` or ``B``, and what it is called
    letter: str
    name: str
    cautions: tuple[str, ...]

    @property
    def label(self) -> str:
        """Letter and name, as in legends."""
        return f"{self.letter}: {self.name}"


S = TypeVar("S", bound=Side)
M = TypeVar("M", bound=BarredMode)


@dataclass(frozen=True, repr=False, eq=False)
class Beside(Generic[S, M]):
    """Two of a kind beside each other."""

    a: S
    b: S
    inputs: tuple[Difference, ...]  #: of their files, or fields
    modes: tuple[ModePair[M], ...]  #: by frequency
    pairing: str  #: how modes belong together, in words
    seconds: float

    @property
    def both(self) -> tuple[S, S]:
        """Both of them."""
        return self.a, self.b

    @property
    def cautions(self) -> list[str]:
        """Cautions of both, each with whose it is unless it is of both."""
        alike = [text for text in self.a.cautions if text in self.b.cautions]
        own = [f"{one.letter}: {t}" for one in self.both for t in one.cautions if t not in alike]
        return [*alike, *own]


def all_pairs(
    alike: Sequence[ModePair[M]],
    first: Sequence[M],
    other: Sequence[M],
    called: Callable[[M], str],
    highest: float = math.inf,
) -> list[ModePair[M]]:
    """All modes of two lists, both by ascending frequency: in the pairs that are alike in shape, by
    what they are `called` up to a frequency, Hz, or alone.
    """
    waiting: dict[str, list[M]] = {}
    for mode in other:
        if mode.frequency_hz <= highest and mode not in [p.b for p in alike]:
            waiting.setdefault(called(mode), []).append(mode)
    out = [*alike]
    for mode in first:
        if mode not in [p.a for p in alike]:
            named = waiting.get(called(mode)) if mode.frequency_hz <= highest else None
            out.append(ModePair(mode, named.pop(0) if named else None))
    out += [ModePair(None, mode) for mode in other if mode not in [p.b for p in out]]
    return sorted(out, key=lambda p: (p.a or p.b).frequency_hz)  # type: ignore[union-attr]  # never both


def decibels(one: float, other: float) -> float | None:
    """Of an amplitude over another; None where either is zero."""
    return float(20 * np.log10(other / one)) if one > 0 and other > 0 else None


def inputs(found: Sequence[Difference]) -> str:
    """Sentence on the entries in which two inputs differ."""
    numbers = [d for d in found if not d.in_words]
    if not found:
        return "Nothing differs in the input."
    if not numbers:
        return "The input differs in words alone (titles, sources): no number can."
    paths = [d.path for d in numbers[:NAMED]]
    more = f" and {len(numbers) - NAMED} more" if len(numbers) > NAMED else ""
    one = len(numbers) == 1
    return f"{len(numbers)} entr{'y' if one else 'ies'} of the input differ{'s' * one}: {', '.join(paths)}{more}."


def resolved(changes: Sequence[Change], what: str) -> Iterator[str]:
    """Sentence on how many of some changes, such as ``pairs of modes``, are more than their bars;
    none where some have no bar.
    """
    verdicts = [change.verdict for change in changes]
    count, sure = len(verdicts), verdicts.count("resolved")
    if not verdicts or "no band" in verdicts:
        return
    many = {0: "none", count: "all"}.get(sure, str(sure))
    differ = "differs" if sure == 1 else "differ"
    rest = ", the rest do not" if 0 < sure < count else ""
    yield f"Of {count} {what} {many} {differ} by more than both bars (resolved){rest}."


def modes(found: Sequence[ModePair[Any]], where: str) -> Iterator[str]:
    """Sentences on pairs of modes: what is resolved, what moves most, and what is alone.

    Parameters
    ----------
    where : str
        Of partners, such as ``in the other train``.
    """
    pairs = [(p, p.change) for p in found if p.change is not None]
    yield from resolved([change for _, change in pairs], "pairs of modes")
    # a name alone does not make two shapes one, where shapes can be told
    alike = [pair for pair in pairs if pair[0].mac is not None] or pairs
    moved = max(alike, key=lambda pair: abs(pair[1].relative or 0.0), default=None)
    if moved is not None and moved[1].verdict != "not resolved":
        yield f"Moves most: {_moved(*moved)}."
    for letter, alone in (
        ("A", [p.a for p in found if p.b is None]),
        ("B", [p.b for p in found if p.a is None]),
    ):
        told = [f"{m.name} ({hertz(m.frequency_hz)} Hz)" for m in alone if m is not None]
        if told:
            yield f"Without a partner {where}, of {letter}: {', '.join(told)}."


def both_names(a: str, b: str) -> str:
    """A mode by its name, or by both of its names."""
    return a if a == b else f"{a} (in B {b})"


def _moved(pair: ModePair[Any], change: Change) -> str:
    assert pair.a is not None and pair.b is not None
    name = both_names(pair.a.name, pair.b.name)
    return f"{name}, from {hertz(change.a)} to {hertz(change.b)} Hz ({percent(change.relative)})"


def plain_pair(pair: ModePair[Any]) -> dict[str, Any]:
    """Pair of modes as plain data that JSON can hold."""
    own = {key: None if m is None else asdict(m) for key, m in (("a", pair.a), ("b", pair.b))}
    change = pair.change
    return {**own, "mac": pair.mac, "frequency": None if change is None else change.as_dict()}
