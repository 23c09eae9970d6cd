r"""Lines of action that turn over the cycle of the excitation.

The row of such a link is that of its mean line and varying shares of a few more: ``r(t) = r_0 + sum
a_j(t) r_j``. All of them are rows of the remainder; the law sees their sum, and its force goes back
to each in its share.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from solidgear.core.system.law import Force, Law


class Line(NamedTuple):
    """Shares of the rows of links whose line turns, at T instants."""

    share: np.ndarray  #: (T, m)
    slope: np.ndarray  #: (T, m) 1/s
    links: tuple[slice, ...]

    def along(self, rows: slice, stretch: np.ndarray) -> np.ndarray:
        """Return the stretch (T,) of a link along the line, from those of all rows (T, m)."""
        return (self.share[:, rows] * stretch[:, rows]).sum(axis=1)

    def with_drift(self, stretch: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """Return rates (T, m), in the first row of each link with that by which the line turns."""
        out = rate.copy()
        for rows in self.links:
            out[:, rows.start] += (self.slope[:, rows] * stretch[:, rows]).sum(axis=1)
        return out

    def force(self, law: Law, rows: slice, stretch: np.ndarray, rate: np.ndarray) -> Force:
        """Return the force of a law on the rows of the link, from stretches and rates of all (T,
        m).
        """
        share, slope = self.share[:, rows], self.slope[:, rows]
        speed = self.along(rows, self.with_drift(stretch, rate))
        scalar = law.force(self.along(rows, stretch)[:, None], speed[:, None])
        outer = share[:, :, None] * share[:, None, :]
        turned = share[:, :, None] * slope[:, None, :]
        by_stretch = scalar.by_stretch * outer + scalar.by_rate * turned
        return Force(scalar.value * share, by_stretch, scalar.by_rate * outer)


@dataclass(frozen=True, eq=False)
class Sway:
    """Fourier coefficients of lines of action that vary over the mesh cycle."""

    #: (o, m) by orders from 1; of the first row of a link none, since that is the mean line
    orders: np.ndarray = field(repr=False)
    links: tuple[slice, ...]  #: rows of links whose line turns

    def line(self, angle: np.ndarray, omega: float | np.ndarray) -> Line:
        """Return shares at angles (T,) of an excitation of a frequency, or frequencies (T, 1),
        rad/s.
        """
        n = 1j * np.arange(1, len(self.orders) + 1)
        turn = np.exp(angle[:, None] * n)
        share = (turn @ self.orders).real
        share[:, [rows.start for rows in self.links]] = 1.0
        return Line(share, omega * ((n * turn) @ self.orders).real, self.links)
