"""Designs of sweeps over entries of files: all combinations, one at a time, a Latin hypercube, or the
user's table.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from solidgear.core import SolidgearError
from solidgear.core.scene.paths import Tables
from solidgear.variants.sweep.entries import (
    MOST,
    Entry,
    KeptSum,
    Owner,
    entries_of,
    entries_of_table,
    kept_sums,
)

#: from the entries that were asked for to those that vary beside them, such as operating points
Further = Callable[[tuple[Entry, ...]], tuple[Entry, ...]]


class DesignPoints(NamedTuple):
    """Points of a design on some files."""

    entries: tuple[Entry, ...]
    values: np.ndarray  #: (n, entries) in every variant
    sums: tuple[KeptSum, ...]


@dataclass(frozen=True)
class Design:
    """Entries that vary in a sweep, and in which combinations."""

    vary: tuple[str, ...] = ()  #: ``PATH=VALUES``, see :mod:`solidgear.variants.sweep.entries`
    sample: int | None = None  #: points of a Latin hypercube, in place of all combinations
    seed: int = 0  #: of the hypercube
    #: the file as it is, then each value of each entry with all others as in the file
    one_at_a_time: bool = False
    table: Path | None = None  #: of variants, in place of `vary`
    keep_sum: tuple[str, ...] = ()  #: ``PATH+PATH``: sums that stay as they are in the file
    #: ``PATH``: diameters that follow the bore of a designation that varies
    follow: tuple[str, ...] = ()
    search: bool = False  #: whether a search chooses the values, from the file as it is

    def points(
        self,
        files: Mapping[str, Tables],
        owner: Owner,
        further: Further = lambda _: (),
        *,
        example: str,
    ) -> DesignPoints:
        """Return the points of the design on files by their names; an error shows the `example`."""
        rows = None
        if self.table is None:
            varied = entries_of(self.vary, files, owner, self.search)
        else:
            self._refuse_others()
            varied, rows = entries_of_table(self.table, files, owner)
        sums = kept_sums(self.keep_sum, files, owner, varied)
        added = further(varied)
        varied += added
        if not varied:
            raise SolidgearError(f'nothing is varied; give for example `vary` "{example}"')
        if self.search:
            turns = [*itertools.product(*(entry.values for entry in added))]
            as_it_is = [math.nan] * (len(varied) - len(added))
            values = np.array([(*as_it_is, *turn) for turn in turns], float)
        elif rows is not None:
            turns = [*itertools.product(*(entry.values for entry in added))]
            values = np.array([(*row, *turn) for row in rows for turn in turns], float)
        elif self.one_at_a_time:
            if self.sample is not None:
                raise SolidgearError("give one of `sample` and `one_at_a_time`")
            values = _one_at_a_time(varied)
        else:
            values = self.drawn(varied)
        return DesignPoints(varied, values, sums)

    def drawn(self, varied: tuple[Entry, ...]) -> np.ndarray:
        """Return (n, entries) all combinations of values, or points of the hypercube."""
        if self.sample is None:
            return product(varied)
        return sample(varied, self.sample, self.seed)

    def _refuse_others(self) -> None:
        options = {
            "`vary`": self.vary,
            "`sample`": self.sample,
            "`one_at_a_time`": self.one_at_a_time,
        }
        for option, value in options.items():
            if value:
                raise SolidgearError(f"`table` {self.table}: says all variants; leave out {option}")

    @property
    def plan(self) -> dict[str, Any] | None:
        """All that rows depend on beside the values of entries."""
        out: dict[str, Any] = {}
        if self.sample is not None:
            out |= {"points": self.sample, "seed": self.seed}
        if self.one_at_a_time:
            out["one_at_a_time"] = True
        if self.keep_sum:
            out["keep_sum"] = list(self.keep_sum)
        if self.follow:
            out["follow"] = list(self.follow)
        return out or None


def _one_at_a_time(varied: tuple[Entry, ...]) -> np.ndarray:
    """Return the file as it is, then one entry after the other."""
    rows = [[math.nan] * len(varied)]
    for k, entry in enumerate(varied):
        for value in entry.values:
            rows.append([math.nan] * len(varied))
            rows[-1][k] = value
    return np.array(rows, float)


def product(axes: Sequence[Entry]) -> np.ndarray:
    """Return (variants, axes) all combinations, the last axis running fastest."""
    total = int(np.prod([float(len(axis.values)) for axis in axes]))
    if total > MOST:
        raise SolidgearError(
            f"{total} variants are more than the {MOST} a sweep takes; use fewer values, or draw some with `sample`"
        )
    return np.array(list(itertools.product(*(axis.values for axis in axes))), float)


def sample(axes: Sequence[Entry], count: int, seed: int) -> np.ndarray:
    """Return (count, axes) a Latin hypercube over the ranges of the axes."""
    if not 1 <= count <= MOST:
        raise SolidgearError(f"`sample` {count}: give a whole number from 1 to {MOST}")
    if seed < 0:
        raise SolidgearError(f"`seed` {seed}: must not be negative")
    from scipy.stats import qmc

    u = qmc.LatinHypercube(d=len(axes), seed=seed).random(count)
    return np.column_stack([axis.draw(u[:, k]) for k, axis in enumerate(axes)])
