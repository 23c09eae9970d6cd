"""Kinks of laws: where their slope, or the force of a damper in contact, leaps."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from solidgear.backlash.solver.model import Remainder
from solidgear.backlash.solver.sway import Line
from solidgear.core.system.law import Force, Gap, RadialGap


class Kink(NamedTuple):
    """Edge of a law at T instants; it adds ``(jump gap + damper gap') direction`` to the force."""

    gap: np.ndarray  #: (T,) how far beyond it, m
    direction: np.ndarray  #: (T, m) slope of that over the stretches
    jump: float  #: of the stiffness, N/m
    damper: float  #: that sets in at once, N s/m
    bend: np.ndarray | None = None  #: (T, m, m) slope of ``into``
    turning: np.ndarray | None = None  #: (T, m) rate of ``into`` where the line turns, 1/s

    @property
    def crossed(self) -> np.ndarray:
        """Return instants of a period between which and the next the edge lies."""
        outside = self.gap > 0
        first = np.flatnonzero(outside[:-1] != outside[1:])
        return first if outside[0] == outside[-1] else np.append(first, len(outside) - 1)

    def speed(self, stretch: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """Return the rate (T,) of the gap."""
        speed = (self.direction * rate).sum(axis=1)
        return speed if self.turning is None else speed + (self.turning * stretch).sum(axis=1)


def kinks(remainder: Remainder, stretch: np.ndarray, line: Line | None = None) -> Iterator[Kink]:
    """Yield all kinks of all laws, from stretches (T, m)."""
    for law, rows in remainder.laws:
        if isinstance(law, RadialGap):
            yield _circle(law, rows, stretch)
            continue
        damper = law.damper if isinstance(law, Gap) and not law.ramp else 0.0
        for row in remainder.rows_of(rows):
            direction, turning = np.zeros_like(stretch), None
            if line is not None and rows in line.links:
                turning = np.zeros_like(stretch)
                turning[:, rows] = line.slope[:, rows]
                direction[:, rows] = line.share[:, rows]
            else:
                direction[:, row] = 1.0
            along = (direction * stretch).sum(axis=1)
            for edge, jump in law.kinks:
                # a side that carries nothing has no damper either
                yield Kink(
                    along - edge, direction, jump, damper * float(np.sign(jump)), None, turning
                )


def _circle(law: RadialGap, rows: slice, stretch: np.ndarray) -> Kink:
    away = np.linalg.norm(stretch[:, rows], axis=1)
    safe = np.where(away > 0, away, 1.0)[:, None]
    direction = np.zeros_like(stretch)
    direction[:, rows] = stretch[:, rows] / safe
    bend = np.zeros((*stretch.shape, stretch.shape[1]))
    radial = direction[:, rows]
    bend[:, rows, rows] = (
        np.eye(radial.shape[1]) - radial[:, :, None] * radial[:, None, :]
    ) / safe[:, None]
    return Kink(away - law.clearance, direction, law.radial, 0.0, bend)


def continued(
    remainder: Remainder,
    sides: Sequence[bool],
    stretch: np.ndarray,
    rate: np.ndarray,
    factor: np.ndarray | None,
    line: Line | None,
) -> Force:
    """Return the excess of the laws as if each of their kinks stayed on one side: smooth, so that a
    step in time may go a little too far before it is cut at the kink.
    """
    excess, _ = remainder.excess(stretch, rate, factor, line)
    for side, kink in zip(sides, kinks(remainder, stretch, line)):
        difference = float(side) - (kink.gap > 0)
        if not difference.any():
            continue
        direction = kink.direction if factor is None else kink.direction * factor
        outer = direction[:, :, None] * kink.direction[:, None, :]
        added = difference * (kink.jump * kink.gap + kink.damper * kink.speed(stretch, rate))
        value = excess.value - added[:, None] * direction
        slope = excess.by_stretch - (difference * kink.jump)[:, None, None] * outer
        if kink.bend is not None:
            slope = slope - (difference * kink.jump * kink.gap)[:, None, None] * kink.bend
        excess = Force(
            value, slope, excess.by_rate - (difference * kink.damper)[:, None, None] * outer
        )
    return excess
