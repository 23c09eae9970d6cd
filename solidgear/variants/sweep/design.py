"""Designs of sweeps over entries of files: all combinations, one at a time, a Latin hypercube, or a
table of one's own.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core.errors import SolidgearError
from solidgear.core.scene.paths import Tables
from solidgear.variants.sweep.entries import (
    Entry,
    Kept,
    Owner,
    entries_of,
    entries_of_table,
    kept_of,
)
from solidgear.variants.sweep.spans import product, sample

#: entries that a study looks at beside those it was given, such as operating points
Further = Callable[[tuple[Entry, ...]], tuple[Entry, ...]]


@dataclass(frozen=True)
class Design:
    """Entries that vary in a sweep, and in which combinations."""

    vary: tuple[str, ...] = ()  #: ``PATH=VALUES``, see :mod:`solidgear.variants.sweep.entries`
    sample: int | None = None  #: points of a Latin hypercube, in place of all combinations
    seed: int = 0  #: of the hypercube
    #: the file as it is, then each value of each entry with all others as in the file
    one_at_a_time: bool = False
    table: Path | None = None  #: of variants, in place of `vary`
    keep_sum: tuple[str, ...] = ()  #: ``PATH+PATH``: sums that stay what they are in the file

    def points(
        self,
        files: Mapping[str, Tables],
        owner: Owner,
        further: Further = lambda _: (),
        *,
        example: str,
    ) -> tuple[tuple[Entry, ...], np.ndarray, tuple[Kept, ...]]:
        """Entries that vary, (n, entries) their values in every variant, and sums that are kept.

        Parameters
        ----------
        files : mapping of str to mapping
            Tables by the name of their file.
        further : callable
            Gives entries that are looked at beside those that were asked for.
        example : str
            Of something to vary, told where nothing is.

        Raises
        ------
        SolidgearError
            For texts and tables that cannot be read, designs that exclude each other, and too many
            variants.
        """
        if self.table is None:
            varied, values = entries_of(self.vary, files, owner), None
        else:
            self._alone()
            varied, values = entries_of_table(self.table, files, owner)
        kept = kept_of(self.keep_sum, files, owner, varied)
        varied += (more := further(varied))
        if not varied:
            raise SolidgearError(f'nothing is varied; give for example --vary "{example}"')
        if values is not None:
            turns = itertools.product(*(one.values for one in more))
            rows = [(*row, *turn) for row, turn in itertools.product(values, turns)]
            return varied, np.array(rows, float), kept
        if self.one_at_a_time:
            if self.sample is not None:
                raise SolidgearError("give one of --sample and --one-at-a-time")
            return varied, _in_turn(varied), kept
        return varied, self.drawn(varied), kept

    def drawn(self, varied: tuple[Entry, ...]) -> np.ndarray:
        """(n, entries) all combinations of values, or points of the hypercube."""
        if self.sample is None:
            return product(varied)
        return sample(varied, self.sample, self.seed)

    def _alone(self) -> None:
        others = {
            "--vary": self.vary,
            "--sample": self.sample,
            "--one-at-a-time": self.one_at_a_time,
        }
        given = [option for option, value in others.items() if value]
        if given:
            raise SolidgearError(f"--table {self.table}: says all variants; leave out {given[0]}")

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
        return out or None


def _in_turn(varied: tuple[Entry, ...]) -> np.ndarray:
    """The file as it is, then one entry after the other."""
    rows = [[math.nan] * len(varied)]
    for k, one in enumerate(varied):
        for value in one.values:
            rows.append([math.nan] * len(varied))
            rows[-1][k] = value
    return np.array(rows, float)
