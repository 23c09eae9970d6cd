"""Designs of a search: each place is solved once, and kept."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from solidgear.core import SolidgearError, nearest
from solidgear.variants.optimise.designs import Designs
from solidgear.variants.optimise.space import SAME, Place, Space
from solidgear.variants.optimise.wish import Rows, Wish

#: relative distance beyond a limit that counts at most
FAR = 10.0
#: loss of a design without numbers, over the largest of all others
REFUSED = 2.0


class EnoughDesigns(Exception):
    """As many designs have been solved as a search may solve."""


class Number(NamedTuple):
    """A number of a design."""

    value: float  #: SI
    bar: float | None  #: its error bar; None where there is none


@dataclass(frozen=True)
class Design:
    """A design that was solved."""

    number: int  #: in order; 0 is the file as it is
    values: dict[str, Any]  #: of the entries that vary and of those that follow, SI
    goals: tuple[Number, ...]  #: number of each goal; empty of a design that was refused
    kept: bool  #: whether every limit is kept with its error bar
    status: str  #: ``ok``, or why it has no numbers
    rows: Rows  #: all numbers; of a train at each operating point
    place: Place | None = None  #: none of a file beyond the ranges

    @property
    def value(self) -> float | None:
        """Number of the first goal; None of a design that was refused."""
        return self.goals[0].value if self.goals else None

    @property
    def bar(self) -> float | None:
        """Error bar of the first goal."""
        return self.goals[0].bar if self.goals else None


class Pool:
    """All designs of a search, `most` at most."""

    def __init__(
        self,
        tried: Designs,
        goals: Sequence[Wish],
        keep: Sequence[Wish],
        most: int,
        progress: Callable[[str], None],
    ):
        self.tried, self.goals, self.keep = tried, tuple(goals), tuple(keep)
        self.most, self.progress = most, progress
        self.space = Space(tried.entries)
        self.designs: list[Design] = []
        self._by_choices: dict[tuple[int, ...], list[Design]] = {}
        self._by_place: dict[Place, Design] = {}

    def solve_file(self) -> Design:
        """Solve the file as it is."""
        values = [float("nan")] * len(self.space.entries)
        return self._solved(values, self.space.place_of_file())

    def solve(self, place: Place) -> Design:
        """Solve a design, or return the one at the same place."""
        solved = self._by_place.get(_rounded(place))
        if solved is not None:
            return solved
        if len(self.designs) >= self.most:
            raise EnoughDesigns
        return self._solved(self.space.values(place), place)

    def cautions(self, design: Design) -> tuple[str, ...]:
        """Return sentences on what the numbers of a design leave out."""
        if design.place is None or not design.goals:
            return ()
        return self.tried.cautions(self.space.values(design.place))

    def _solved(self, values: Sequence[float], place: Place | None) -> Design:
        number = len(self.designs)
        self.progress(f"design {number}")
        varied, rows = self.tried.solve(values)
        status = next((row["status"] for row in rows if row["status"] != "ok"), "ok")
        numbers = []
        if status == "ok":
            numbers = [self._number(wish, rows) for wish in self.goals]
            self._refuse_unknown(rows)
        design = Design(
            number,
            varied,
            tuple(numbers),
            status == "ok" and all(wish.missing(rows) <= 0 for wish in self.keep),
            status,
            rows,
            place,
        )
        self.designs.append(design)
        if place is not None:
            self._by_choices.setdefault(place.choices, []).append(design)
            self._by_place[_rounded(place)] = design
        return design

    def _number(self, wish: Wish, rows: Rows) -> Number:
        value = wish.value(rows)
        if value is None:
            raise self._lacking("goal", wish, rows)
        return Number(*value)

    def _refuse_unknown(self, rows: Rows) -> None:
        """Refuse a limit on a number that the first design with numbers does not have."""
        if any(design.goals for design in self.designs):
            return
        for wish in self.keep:
            if wish.value(rows) is None:
                raise self._lacking("keep", wish, rows)

    def _lacking(self, option: str, wish: Wish, rows: Rows) -> SolidgearError:
        names = self.tried.names(rows[0])
        return SolidgearError(
            f"`{option}` {wish}: a design has no {wish.name}{nearest(wish.name, names)}; it has "
            f"{', '.join(names)}"
        )

    def of_choices(self, choices: tuple[int, ...]) -> list[Design]:
        """Return the designs with values of lists."""
        return self._by_choices.get(choices, [])

    def size(self, goal: int) -> float:
        """Return the size of a goal, that of the first design that has it."""
        values = (abs(design.goals[goal].value) for design in self.designs if design.goals)
        return next(filter(None, values), 1.0)

    def loss(self, design: Design, goal: int = 0) -> float:
        """Return a goal of a design relative to the size, small where it is good; a design that was
        refused is worse than all others.
        """
        upward = self.goals[goal].upward
        if not design.goals:
            values = [d.goals[goal].value for d in self.designs if d.goals]
            return REFUSED * max(map(abs, values), default=1.0) / self.size(goal)
        value = design.goals[goal].value / self.size(goal)
        return -value if upward else value

    def shortfall(self, wish: Wish, design: Design) -> float:
        """Return the relative distance of a design beyond a limit; 0 and less is kept."""
        return float(np.clip(wish.missing(design.rows), -FAR, FAR))


def _rounded(place: Place) -> Place:
    """Return a place to the digits that make it another place."""
    return place._replace(x=tuple(round(x / SAME) * SAME for x in place.x))
