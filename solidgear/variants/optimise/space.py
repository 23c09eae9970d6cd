"""The space of a search: values of lists and coordinates in ranges."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import NamedTuple

import numpy as np

from solidgear.variants.sweep.entries import Entry, in_si

#: distance in ranges below which two places are the same
SAME = 1e-6


class Place(NamedTuple):
    """A place in the space of a search."""

    choices: tuple[int, ...]  #: number of the value in every list
    x: tuple[float, ...]  #: place in every range, from 0 to 1

    def moved(self, x: Sequence[float] | np.ndarray) -> Place:
        """Return the place with other coordinates in the ranges, no further than their ends."""
        return self._replace(x=tuple(np.clip(x, 0.0, 1.0).tolist()))


@dataclass(frozen=True)
class Space:
    """Entries of a search: those with a list of values, and those with a range."""

    entries: tuple[Entry, ...]

    @cached_property
    def lists(self) -> tuple[Entry, ...]:
        """Entries with a list of values."""
        return tuple(entry for entry in self.entries if not entry.open)

    @cached_property
    def ranges(self) -> tuple[Entry, ...]:
        """Entries with a range."""
        return tuple(entry for entry in self.entries if entry.open)

    @property
    def dimension(self) -> int:
        """Number of ranges."""
        return len(self.ranges)

    @property
    def combinations(self) -> int:
        """Number of combinations of the values of lists."""
        return math.prod(len(entry.values) for entry in self.lists)

    def all_choices(self) -> Iterator[tuple[int, ...]]:
        """Yield all combinations."""
        return product(*(range(len(entry.values)) for entry in self.lists))

    def values(self, place: Place) -> list[float]:
        """Return the values of all entries at a place."""
        choices, coordinates = iter(place.choices), iter(place.x)
        return [
            _between(entry, next(coordinates)) if entry.open else entry.values[next(choices)]
            for entry in self.entries
        ]

    def place_of_file(self) -> Place | None:
        """Return the place of the file; None where an entry of it lies beyond its range or list."""
        choices = [_choice_of_file(entry) for entry in self.lists]
        x = [_coordinate_of_file(entry) for entry in self.ranges]
        if None in choices or None in x:
            return None
        return Place(
            tuple(choice for choice in choices if choice is not None),
            tuple(coordinate for coordinate in x if coordinate is not None),
        )


def _between(entry: Entry, x: float) -> float:
    """Return the value at a place in a range."""
    low, high = entry.values[0], entry.values[-1]
    value = low * (high / low) ** x if entry.spacing == "log" else low + x * (high - low)
    return float(f"{value:.9g}")


def _coordinate_of_file(entry: Entry) -> float | None:
    low, high = (in_si(entry.written(end)) for end in (entry.values[0], entry.values[-1]))
    value = in_si(entry.in_file)
    if value is None or low is None or high is None:
        return None
    if entry.spacing == "log":
        if value * low <= 0:
            return None
        value, low, high = (math.log(abs(number)) for number in (value, low, high))
    x = (value - low) / (high - low)
    return x if 0 <= x <= 1 else None


def _choice_of_file(entry: Entry) -> int | None:
    number = in_si(entry.in_file)
    for k, value in enumerate(entry.values):
        written = entry.written(value)
        if written == entry.in_file or (number is not None and in_si(written) == number):
            return k
    return None
