"""Kinks of laws: where their slope, or the force of a damper in contact, leaps."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from solidgear.nonlinear.model import Remainder
from solidgear.nonlinear.sway import Line
from solidgear.system.law import Force, Gap, RadialGap


class Kink(NamedTuple):
    """One edge of a law at T instants; what it adds is ``(jump gap + damper its rate) into``."""

    gap: np.ndarray  #: (T,) how far beyond it, m
    into: np.ndarray  #: (T, m) slope of that over the stretches
    jump: float  #: of the stiffness, N/m
    damper: float  #: that sets in at once, N s/m
    bend: np.ndarray | None = None  #: (T, m, m) slope of ``into``
    turning: np.ndarray | None = None  #: (T, m) rate of ``into`` where the line turns, 1/s

    @property
    def crossed(self) -> np.ndarray:
        """Instants of a period between which and the next the edge lies."""
        on = self.gap > 0
        first = np.flatnonzero(on[:-1] != on[1:])
        return first if on[0] == on[-1] else np.append(first, len(on) - 1)

    def speed(self, stretch: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """(T,) rate of the gap."""
        own = (self.into * rate).sum(axis=1)
        return own if self.turning is None else own + (self.turning * stretch).sum(axis=1)


def kinks(own: Remainder, stretch: np.ndarray, line: Line | None = None) -> Iterator[Kink]:
    """All kinks of all laws, from stretches (T, m)."""
    for law, at in own.laws:
        if isinstance(law, RadialGap):
            yield _circle(law, at, stretch)
            continue
        damper = law.damper if isinstance(law, Gap) and not law.ramp else 0.0
        for row in own.rows_of(at):
            into, turning = np.zeros_like(stretch), None
            if line is not None and at in line.links:
                turning = np.zeros_like(stretch)
                turning[:, at] = line.slope[:, at]
                into[:, at] = line.share[:, at]
            else:
                into[:, row] = 1.0
            along = (into * stretch).sum(axis=1)
            for edge, jump in law.kinks:
                # a side that carries nothing has no damper either
                yield Kink(along - edge, into, jump, damper * float(np.sign(jump)), None, turning)


def _circle(law: RadialGap, at: slice, stretch: np.ndarray) -> Kink:
    away = np.linalg.norm(stretch[:, at], axis=1)
    safe = np.where(away > 0, away, 1.0)[:, None]
    into = np.zeros_like(stretch)
    into[:, at] = stretch[:, at] / safe
    bend = np.zeros((*stretch.shape, stretch.shape[1]))
    own = into[:, at]
    bend[:, at, at] = (np.eye(own.shape[1]) - own[:, :, None] * own[:, None, :]) / safe[:, None]
    return Kink(away - law.clearance, into, law.radial, 0.0, bend)


def continued(
    own: Remainder,
    beyond: Sequence[bool],
    stretch: np.ndarray,
    rate: np.ndarray,
    factor: np.ndarray | None,
    line: Line | None,
) -> Force:
    """The excess of the laws were each of their kinks on one side all the time: smooth, so that
    a step in time may go a little too far before it is cut at the kink.
    """
    excess, _ = own.excess(stretch, rate, factor, line)
    for on, kink in zip(beyond, kinks(own, stretch, line)):
        off = float(on) - (kink.gap > 0)
        if not off.any():
            continue
        into = kink.into if factor is None else kink.into * factor
        outer = into[:, :, None] * kink.into[:, None, :]
        added = off * (kink.jump * kink.gap + kink.damper * kink.speed(stretch, rate))
        value = excess.value - added[:, None] * into
        by = excess.by_stretch - (off * kink.jump)[:, None, None] * outer
        if kink.bend is not None:
            by = by - (off * kink.jump * kink.gap)[:, None, None] * kink.bend
        excess = Force(value, by, excess.by_rate - (off * kink.damper)[:, None, None] * outer)
    return excess
