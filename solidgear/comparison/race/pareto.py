"""Error against cost: discretisations of one scene, and those that no other beats in both.

The error is that against the model that judges the scene, refined; the error bar of that model is
the floor: no smaller error is resolved.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from statistics import median

import numpy as np

from solidgear.core import C_ZZ, FIRST_BENDING
from solidgear.core.machine.environment import environment

#: charted quantities, as named in `quantities`
CHARTED = (C_ZZ, FIRST_BENDING)
#: the family and the series of the automatic choice
AUTOMATIC = "automatic"


@dataclass
class Row:
    """One discretisation and the result."""

    family: str  #: lumped, beam, harmonic, tetrahedra or hexahedra
    series: str  #: cases of ever higher cost belong to one series, such as ``HEX20 graded``
    level: int  #: place in the series, from 1
    model: str  #: lumped, euler, timoshenko, harmonic or solid
    options: dict  #: of the builder
    status: str = "waiting"  #: ``waiting``, ``ok``, ``failed`` or ``left out``
    reason: str = ""  #: why it failed, was left out, lacks a number or has fewer runs
    unknowns: int | None = None
    #: wall seconds of every run; of a failed case the seconds until it failed
    samples: list[float] = field(default_factory=list)
    #: values, errors, like_for_like: by quantity: SI value; ``|value / reference - 1|``; for beams
    #: and lumped models the same against the reference with section ties. ``errors`` also has ``C
    #: 6x6``: the largest ``|dC_ij| / sqrt(C_ii C_jj)`` over the motions that something resists.
    values: dict[str, float] = field(default_factory=dict)
    errors: dict[str, float] = field(default_factory=dict)
    like_for_like: dict[str, float] = field(default_factory=dict)
    #: s of processor time of every run, which a budget counts; not written
    processor_seconds: list[float] = field(default_factory=list, compare=False)

    @property
    def seconds(self) -> float | None:
        """Median wall time, s."""
        return median(self.samples) if self.samples else None


@dataclass
class Race:
    """Rows of a chart of error against cost, and their reference."""

    scene: dict
    #: ``model`` (its title), ``options``, ``unknowns``, ``seconds``, and by quantity ``values``,
    #: ``bands`` and ``like_for_like``
    reference: dict
    rows: list[Row]
    setup: dict[str, float]  #: seconds a process pays once, by purpose
    #: runs, modes: runs asked for; elastic shapes that every model is asked for
    runs: int
    modes: int
    budget: float  #: allowed for the rows, s of processor time
    seconds: float = 0.0  #: used for all, the reference included
    complete: bool = True  #: false after an interrupt
    environment: dict = field(default_factory=environment)

    def error(self, row: Row, quantity: str) -> float | None:
        """Return the error of a row, never below the error bar of the reference; None where the row
        has none.
        """
        error = row.errors.get(quantity)
        if row.status != "ok" or error is None:
            return None
        return max(error, self.reference["bands"][quantity])

    def sure_error(self, row: Row, quantity: str) -> float | None:
        """Return the largest of the error a user makes, the one like for like, and those of finer
        levels of the series.

        A cancellation of errors earns no place on the front: neither a tie that makes up for a
        beam's stiffness, nor a coarse mesh whose error changes sign and so beats finer ones of the
        same series.
        """
        error = self.error(row, quantity)
        if error is None:
            return None
        finer = [
            self.error(r, quantity) or 0.0
            for r in self.rows
            if r.series == row.series and r.level > row.level
        ]
        return max(error, row.like_for_like.get(quantity, 0.0), *finer)

    def resolved(self, row: Row, quantity: str) -> bool:
        """Return whether the error of a row lies above the error bar of the reference."""
        return row.errors.get(quantity, 0.0) > self.reference["bands"][quantity]

    def front(self, quantity: str, cost: str = "seconds") -> list[Row]:
        """Return the rows on the Pareto front of a quantity over ``seconds`` or ``unknowns``,
        cheapest first.
        """
        places = front(
            [getattr(row, cost) for row in self.rows],
            [self.sure_error(row, quantity) for row in self.rows],
        )
        return [self.rows[k] for k in places]


def front(cost: Sequence[float | None], error: Sequence[float | None]) -> list[int]:
    """Return the places of the points that no other beats: none is at least as good in both and
    better in one.

    In ascending order of cost; points with None or NaN take no part, and the first of equal ones
    counts.
    """
    points = [
        (c, e, k)
        for k, (c, e) in enumerate(zip(cost, error))
        if c is not None and e is not None and np.isfinite(c) and np.isfinite(e)
    ]
    out, best = [], np.inf
    for _, e, k in sorted(points):
        if e < best:
            out.append(k)
            best = e
    return out
