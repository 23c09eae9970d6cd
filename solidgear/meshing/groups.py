"""Materials of the elements of a mesh file, or of the solids of a STEP file, by groups."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from solidgear.errors import listed, nearest, show
from solidgear.meshing.decks.deck import Deck, Group
from solidgear.meshing.quality import MeshError

#: groups that a sentence names
TOLD = 12


def there_are(names: Sequence[str]) -> str:
    """Groups of a file in a sentence.

    Examples
    --------
    >>> there_are(["core", "sleeve"])
    'there are "core", "sleeve"'
    """
    if not names:
        return "there are no groups of volume elements in it"
    shown = [show(name) for name in names[:TOLD]]
    more = [f"{len(names) - TOLD} more"] if len(names) > TOLD else []
    return f"there are {listed([*shown, *more])}"


def found(name: str, known: Sequence[str]) -> str | None:
    """The name of a group as the file writes it, which the scene may in letters of either size;
    None where there is none.
    """
    if name in known:
        return name
    alike = [other for other in known if other.lower() == name.lower()]
    return alike[0] if len(alike) == 1 else None


def owners(deck: Deck, named: Sequence[str]) -> tuple[np.ndarray, tuple[str, ...]]:
    """Place (ne,) of the group of each element among those with materials of their own, one more
    for the rest; and the groups with elements of the rest. MeshError for a group that is not there,
    or two that share elements.
    """
    by_name = {group.name: group for group in deck.groups}
    owner = np.full(deck.cells.shape[1], len(named))
    for place, name in enumerate(named):
        own = found(name, list(by_name))
        if own is None:
            raise MeshError(
                f"has no group {show(name)}{nearest(name, by_name)}; {there_are(list(by_name))}"
            )
        elements = by_name[own].elements
        taken = np.flatnonzero(owner[elements] != len(named))
        if len(taken):
            other = named[owner[elements[taken[0]]]]
            both = "element is" if len(taken) == 1 else "elements are"
            raise MeshError(
                f"{len(taken)} {both} in both {show(other)} and {show(name)}, one of them "
                f"{_short(deck, int(elements[taken[0]]))}: groups with materials must not overlap; "
                f"{there_are(list(by_name))}"
            )
        owner[elements] = place
    return owner, tuple(g.name for g in deck.groups if (owner[g.elements] == len(named)).any())


def _short(deck: Deck, place: int) -> str:
    return f"in {deck.named(place)}" if deck.lines is not None else deck.named(place)


def material_groups(deck: Deck) -> tuple[str, ...]:
    """Groups that tell materials, where there are at least two that share nothing."""
    groups: list[Group] = [g for g in deck.groups if g.tells]
    apart = [g for g in groups if len(g.elements) < deck.cells.shape[1]]
    return tuple(g.name for g in apart) if len(apart) > 1 else ()
