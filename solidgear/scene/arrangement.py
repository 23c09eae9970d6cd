"""O and X by one word: which way the two single bearings of a pair hold a shaft.

In an O arrangement (back to back) the lower bearing along y keeps the shaft from moving towards
+y and the upper one from moving towards -y; in X (face to face) the other way round.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Annotated, Any, NamedTuple

from pydantic import BeforeValidator

from solidgear.errors import SceneError, listed, nearest, show
from solidgear.scene.catalogue import WAYS, Catalogue, arrangement_word

#: word and, where there is more than one pair, names of the two bearings
Words = tuple[tuple[str, tuple[str, ...] | None], ...]


class Pair(NamedTuple):
    """Two single bearings that hold a shaft against each other."""

    arrangement: str
    bearings: tuple[int, ...]  #: places of both in the list of a file

    def ways(self, places: Iterable[float]) -> Iterator[tuple[int, str]]:
        """Place in the list and direction held of each, from their places along y, m."""
        upward = [k for _, k in sorted(zip(places, self.bearings))]
        return zip(upward, WAYS[self.arrangement])


def _words(value: Any) -> Any:
    """Words with names; a single word is for the only pair there is."""
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
            pair_names = (
                [name for name in pair if isinstance(name, str)] if isinstance(pair, list) else []
            )
            if len(set(pair_names)) != 2 or len(pair) != 2:
                reason = f'write the names of two bearings, as {word} = ["A", "B"]'
                raise SceneError(
                    f"{reason}; of more, holds at each", path=(word,), value=show(pair)
                )
            pairs.append((arrangement, tuple(pair_names)))
    return tuple(pairs)


Arrangement = Annotated[Words, BeforeValidator(_words)]


def pairs(words: Words, tables: Sequence[Mapping[str, Any]]) -> list[Pair] | None:
    """Pairs that the words of a file tell of the tables of its bearings; None where catalogue data
    are wrong by themselves, so that words cannot be judged.
    """
    if words and any(_wrong(table) - {("holds",)} for table in tables):
        return None
    names = [str(table.get("name")) for table in tables]
    free = [k for k, table in enumerate(tables) if _needs_holds(table)]
    found: list[Pair] = []
    for word, pair in words:
        if pair is None and len(free) != 2:
            names_of_free = f": {listed(names[k] for k in free)}" if free else ""
            raise SceneError(
                "stands for two single bearings with a contact angle and without holds, and this "
                f'scene has {len(free)}{names_of_free}; name two of them, as arrangement = {{O = ["A", "B"]}}',
                path=("arrangement",),
            )
        for name in pair or ():
            _check(name, names, tables, found)
        found.append(Pair(word, tuple(names.index(name) for name in pair) if pair else tuple(free)))
    return found


def _check(
    name: str, names: Sequence[str], tables: Sequence[Mapping[str, Any]], pairs: Sequence[Pair]
) -> None:
    """Refuse a name that is no single bearing which waits for its direction."""
    reason = ""
    if name not in names:
        reason = (
            f"no bearing is called {show(name)}{nearest(name, names)}; there are {listed(names)}"
        )
    elif any(names.index(name) in pair.bearings for pair in pairs):
        reason = f"{show(name)} is in two pairs"
    elif not _needs_holds(table := tables[names.index(name)]):
        data = table.get("catalogue")
        reason = f"{show(name)} is no single bearing with a contact angle, which a pair is made of"
        if isinstance(data, Mapping) and "holds" in data:
            reason = f"{show(name)} has holds as well: leave one of both out"
    if reason:
        raise SceneError(reason, path=("arrangement",))


def _wrong(table: Mapping[str, Any]) -> set[tuple]:
    """Keys of the problems of a bearing's catalogue data; none without such data."""
    if "catalogue" not in table:
        return set()
    data = table["catalogue"]
    try:
        Catalogue(**data if isinstance(data, Mapping) else {})
    except SceneError as error:
        return {problem.path for problem in error.problems}
    return set()


def _needs_holds(table: Mapping[str, Any]) -> bool:
    """True for catalogue data that lack nothing but the direction in which they hold the shaft."""
    return _wrong(table) == {("holds",)}


def facing(
    tables: Sequence[Mapping[str, Any]], paired: Sequence[Pair] | None
) -> list[dict[str, Any]]:
    """Tables of bearings that can be read, those of pairs with a direction until their places are
    known; where the words are wrong, all that wait for one: they are not also missing.
    """
    turned = (
        [k for k, table in enumerate(tables) if _needs_holds(table)]
        if paired is None
        else [k for pair in paired for k in pair.bearings]
    )
    return [
        {**table, "catalogue": {**table["catalogue"], "holds": "+y"}} if k in turned else {**table}
        for k, table in enumerate(tables)
    ]
