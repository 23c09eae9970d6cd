"""Sentences and plain data that two trains and two shafts beside each other share."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any

from solidgear.report.words import hertz, percent
from solidgear.scene.differences import Difference
from solidgear.studies.change import Change, ModePair

#: entries of the input that are named in a sentence
NAMED = 3


def same_file(a: str, b: str) -> str:
    """Sentence on one file that is given twice."""
    what = f"{a} is given twice" if a == b else f"{a} and {b} are one file"
    return f"{what}: nothing differs, and nothing was solved."


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
    """Sentence on how many of some changes are more than their bars; none where some have no bar.

    Parameters
    ----------
    what : str
        Such as ``pairs of modes``.
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
