"""Arrangements of two single bearings, O or X: which way each holds the shaft.

In an O arrangement (back to back) the lower bearing along y keeps the shaft from moving towards
+y and the upper one from moving towards -y; in X (face to face) the other way round.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Annotated, Any, NamedTuple

from pydantic import BeforeValidator, Field

from solidgear.bearings.catalogue import (
    SPELLINGS,
    WAYS,
    Catalogue,
    PairWord,
    arrangement_word,
)
from solidgear.core import SceneError, Written, listed, nearest, show

#: word and, where there is more than one pair, names of the two bearings
Words = tuple[tuple[str, tuple[str, ...] | None], ...]


class Pair(NamedTuple):
    """Two single bearings that hold a shaft against each other."""

    arrangement: str
    bearings: tuple[int, ...]  #: places of both in the list of a file

    def ways(self, places: Iterable[float]) -> Iterator[tuple[int, str]]:
        """Yield the place in the list and the direction held of both, from their y, m."""
        upward = [k for _, k in sorted(zip(places, self.bearings))]
        return zip(upward, WAYS[self.arrangement])


def _read_words(value: Any) -> Any:
    """Return words with names of bearings; a single word is for the only pair."""
    if isinstance(value, tuple):
        return value
    pairs: list[tuple[str, tuple[str, ...] | None]] = []
    entries = value.items() if isinstance(value, Mapping) and value else ((value, None),)
    for word, names in entries:
        arrangement = arrangement_word(word)
        if not isinstance(arrangement, str) or arrangement not in WAYS:
            near = nearest(word, ["O", "X", *WAYS]) if isinstance(word, str) else ""
            reason = f'must be "O" (back to back) or "X" (face to face){near}'
            raise SceneError(reason, value=show(word))
        if names is None:
            pairs.append((arrangement, None))
            continue
        several = isinstance(names, list) and any(isinstance(name, list) for name in names)
        for pair in names if several else [names]:
            pair_names = []
            if isinstance(pair, list):
                pair_names = [name for name in pair if isinstance(name, str)]
            if len(set(pair_names)) != 2 or len(pair) != 2:
                reason = f'write the names of two bearings, as {word} = ["A", "B"]'
                raise SceneError(
                    f"{reason}; of more, holds at each", path=(word,), value=show(pair)
                )
            pairs.append((arrangement, tuple(pair_names)))
    return tuple(pairs)


Names = Annotated[list[str], Field(min_length=2, max_length=2)]
Arrangement = Annotated[
    Words,
    BeforeValidator(_read_words),
    Written(PairWord | Annotated[dict, Written(dict.fromkeys(SPELLINGS, Names | list[Names]))]),
]


def read_pairs(words: Words, tables: Sequence[Mapping[str, Any]]) -> list[Pair] | None:
    """Read the pairs of bearings that words of a file name; return None where catalogue data are wrong
    by themselves, so that words cannot be judged.
    """
    if words and any(_problem_keys(table) - {("holds",)} for table in tables):
        return None
    names = [str(table.get("name")) for table in tables]
    free = [k for k, table in enumerate(tables) if _needs_holds(table)]
    pairs: list[Pair] = []
    for word, pair in words:
        if pair is None and len(free) != 2:
            names_of_free = f": {listed(names[k] for k in free)}" if free else ""
            raise SceneError(
                "needs two single bearings with a contact angle and without holds, and this scene "
                f"has {len(free)}{names_of_free}; name two of them, as "
                'arrangement = {O = ["A", "B"]}',
                path=("arrangement",),
            )
        for name in pair or ():
            _check(name, names, tables, pairs)
        pairs.append(Pair(word, tuple(names.index(name) for name in pair) if pair else tuple(free)))
    return pairs


def _check(
    name: str, names: Sequence[str], tables: Sequence[Mapping[str, Any]], pairs: Sequence[Pair]
) -> None:
    """Refuse a name that is no single bearing without a direction."""
    reason = ""
    if name not in names:
        reason = (
            f"no bearing is called {show(name)}{nearest(name, names)}; there are {listed(names)}"
        )
    elif any(names.index(name) in pair.bearings for pair in pairs):
        reason = f"{show(name)} is in two pairs"
    elif not _needs_holds(table := tables[names.index(name)]):
        data = table.get("catalogue")
        reason = f"{show(name)} is not a single bearing with a contact angle, as a pair needs"
        if isinstance(data, Mapping) and "holds" in data:
            reason = f"{show(name)} has holds as well: leave one of them out"
    if reason:
        raise SceneError(reason, path=("arrangement",))


def _problem_keys(table: Mapping[str, Any]) -> set[tuple]:
    """Return the keys of problems of a bearing's catalogue data; none without such data."""
    if "catalogue" not in table:
        return set()
    data = table["catalogue"]
    try:
        Catalogue(**data if isinstance(data, Mapping) else {})
    except SceneError as error:
        return {problem.path for problem in error.problems}
    return set()


def _needs_holds(table: Mapping[str, Any]) -> bool:
    """Return True for catalogue data that lack only the direction in which they hold the shaft."""
    return _problem_keys(table) == {("holds",)}


def readable_tables(
    tables: Sequence[Mapping[str, Any]], paired: Sequence[Pair] | None
) -> list[dict[str, Any]]:
    """Return tables of bearings with a provisional direction for bearings of pairs, until their
    places are known; where the words are wrong, for all without one, so that it is not missing too.
    """
    if paired is None:
        turned = [k for k, table in enumerate(tables) if _needs_holds(table)]
    else:
        turned = [k for pair in paired for k in pair.bearings]
    return [
        {**table, "catalogue": {**table["catalogue"], "holds": "+y"}} if k in turned else {**table}
        for k, table in enumerate(tables)
    ]


class Pairs:
    """The key ``arrangement`` as the reader of scene files asks for it."""

    Words = Arrangement
    read_pairs = staticmethod(read_pairs)
    readable_tables = staticmethod(readable_tables)
