r"""Lines of action that turn over the cycle of the excitation.

The row of such a link is that of its mean line and shares, which vary, of a few more: ``r(t) = r_0 +
sum a_j(t) r_j``.  All of them are rows of the remainder; the law sees what they add up to, and its
force goes back to each in its share.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from solidgear.system.law import Force, Law


class Line(NamedTuple):
    """Shares of the rows of links whose line turns, at T instants."""

    share: np.ndarray  #: (T, m)
    slope: np.ndarray  #: (T, m) 1/s
    links: tuple[slice, ...]

    def along(self, at: slice, stretch: np.ndarray) -> np.ndarray:
        """(T,) stretch of a link along its line, from those of all rows (T, m)."""
        return (self.share[:, at] * stretch[:, at]).sum(axis=1)

    def drifting(self, stretch: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """Rates (T, m) with that by which the line turns in the first row of each link."""
        out = rate.copy()
        for at in self.links:
            out[:, at.start] += (self.slope[:, at] * stretch[:, at]).sum(axis=1)
        return out

    def force(self, law: Law, at: slice, stretch: np.ndarray, rate: np.ndarray) -> Force:
        """Force of a law on the rows of its link, from stretches and rates of all (T, m)."""
        share, slope = self.share[:, at], self.slope[:, at]
        speed = self.along(at, self.drifting(stretch, rate))
        own = law.force(self.along(at, stretch)[:, None], speed[:, None])
        outer = share[:, :, None] * share[:, None, :]
        turned = share[:, :, None] * slope[:, None, :]
        by = own.by_stretch * outer + own.by_rate * turned
        return Force(own.value * share, by, own.by_rate * outer)


@dataclass(frozen=True, eq=False)
class Sway:
    """Shares over the cycle."""

    #: (o, m) by orders from 1; of the first row of a link none, since that is the mean line
    orders: np.ndarray = field(repr=False)
    links: tuple[slice, ...]  #: rows of links whose line turns

    def line(self, angle: np.ndarray, omega: float | np.ndarray) -> Line:
        """Shares at angles (T,) of an excitation of a frequency, or frequencies (T, 1), rad/s."""
        n = 1j * np.arange(1, len(self.orders) + 1)
        turn = np.exp(angle[:, None] * n)
        share = (turn @ self.orders).real
        share[:, [at.start for at in self.links]] = 1.0
        return Line(share, omega * ((n * turn) @ self.orders).real, self.links)
