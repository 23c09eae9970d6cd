"""Outcome of a search: its designs, the best of them, and the record of how it was searched."""

from __future__ import annotations

from dataclasses import dataclass

from solidgear.core.judge.change import Change
from solidgear.variants.optimise.front import FrontTrace
from solidgear.variants.optimise.pool import Design
from solidgear.variants.optimise.search import Trace
from solidgear.variants.optimise.wish import Wish
from solidgear.variants.sweep.entries import Entry


@dataclass(frozen=True, repr=False, eq=False)
class Outcome:
    """Designs of a search, and how it was searched."""

    scene: str
    goals: tuple[Wish, ...]
    keep: tuple[Wish, ...]
    path: tuple[Design, ...]  #: all designs, the file as it is first
    best: Design | None  #: by the first goal; none where no design keeps every limit
    #: of two goals: designs none of which is beaten in both
    front: tuple[Design, ...]
    at_end: tuple[str, ...]  #: entries of the best design that are at an end of their range
    entries: tuple[Entry, ...]  #: entries that vary
    trace: Trace | FrontTrace  #: record of the search
    most: int  #: designs at most
    followed: tuple[str, ...]  #: sentences on entries that follow
    #: why values have no error bars; empty where they have
    unbarred: str = ""
    solved: str = ""  #: how every design was solved, in words
    cautions: tuple[str, ...] = ()  #: sentences on what the numbers leave out

    @property
    def goal(self) -> Wish:
        """First goal."""
        return self.goals[0]

    @property
    def gain(self) -> Change | None:
        """Change from the file to the best design; None where one of them has no number, and of two
        goals.
        """
        first, best = self.path[0], self.best
        if self.front or best is None or first.value is None or best.value is None:
            return None
        return Change(first.value, best.value, first.bar, best.bar)
