"""Preload: by force, by displacement, by a spring."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from solidgear.bearings.ball import BallRow
from solidgear.bearings.roller import RollerRow
from solidgear.bearings.row import Contacts
from solidgear.bearings.sliding import FURTHEST, balanced, condensed
from solidgear.errors import SolidgearError


def pushed(row: BallRow | RollerRow, force: float) -> BallRow | RollerRow:
    """A row with a contact angle whose rings are pushed together until it presses with a force
    along y, N; refuses a force that no push brings.
    """
    still, most = np.zeros(6), row.side * FURTHEST
    if row.side * replace(row, preload=FURTHEST).load(still)[1] < force:
        raise SolidgearError(f"no push along y preloads this row with {force:g} N")
    low, high = np.array(min(0.0, most)), np.array(max(0.0, most))
    # a push of the inner ring is a motion of it along y
    found = balanced(
        row.load, row.tangent, still, low, high, lambda y: np.full_like(y, row.side * force)
    )
    return replace(row, preload=float(row.side * found[1]))


@dataclass(frozen=True)
class SprungRow:
    """A row whose outer ring slides along y on a spring.

    The ring goes where contacts and spring balance; at rest they do with the row as it is pushed.
    With the ring's motion w the energy is that of the row at ``q - w e_y`` and of the spring, least
    in w: the load is the row's there, the tangent the row's with y condensed.
    """

    row: BallRow | RollerRow  #: pushed by the spring's force
    spring: float  #: N/m

    @property
    def pitch(self) -> float:
        """As of the row."""
        return self.row.pitch

    def _seen(self, motion: np.ndarray) -> np.ndarray:
        """Motion of the inner ring as the sliding outer ring sees it."""
        motion = np.asarray(motion, float)
        rest = float(self.row.load(np.zeros(6))[1])
        # the spring takes what the row presses beyond its preload: k w = F(q - w) - F(0)
        y = motion[..., 1]
        most = abs(rest) / self.spring
        return balanced(
            self.row.load,
            self.row.tangent,
            motion,
            np.minimum(y, 0.0) - most,
            np.maximum(y, 0.0) + most,
            lambda t: rest + self.spring * (y - t),
            self.spring,
        )

    def load(self, motion: np.ndarray) -> np.ndarray:
        """Load that holds the inner ring at motions (..., 6)."""
        return self.row.load(self._seen(motion))

    def tangent(self, motion: np.ndarray) -> np.ndarray:
        """Its derivative, (..., 6, 6)."""
        return condensed(self.row.tangent(self._seen(motion)), self.spring)

    def contacts(self, motion: np.ndarray) -> Contacts:
        """Loads of all elements."""
        return self.row.contacts(self._seen(motion))
