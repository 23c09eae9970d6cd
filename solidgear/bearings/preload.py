"""Preload: by force, by displacement, by a spring."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from solidgear.bearings.ball import BallRow
from solidgear.bearings.roller import RollerRow
from solidgear.bearings.row import Contacts
from solidgear.bearings.sliding import FURTHEST, condense_y, slide_to_balance
from solidgear.core import SolidgearError


# equal bearings of a scene, and variants of it, push equal rows
@lru_cache(maxsize=256)
def pushed(row: BallRow | RollerRow, force: float) -> BallRow | RollerRow:
    """Return a row with a contact angle whose rings are pushed together until it presses with a
    force along y, N; refuse a force that no push brings.
    """
    zero, most = np.zeros(6), row.side * FURTHEST
    if row.side * replace(row, preload=FURTHEST).load(zero)[1] < force:
        raise SolidgearError(f"no push along y preloads this row with {force:g} N")
    low, high = np.array(min(0.0, most)), np.array(max(0.0, most))
    # a push of the inner ring is a motion of it along y
    motion = slide_to_balance(
        row.load, row.tangent, zero, low, high, lambda y: np.full_like(y, row.side * force)
    )
    return replace(row, preload=float(row.side * motion[1]))


@dataclass(frozen=True)
class SprungRow:
    """Row whose outer ring slides along y on a spring.

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

    def _relative_motion(self, motion: np.ndarray) -> np.ndarray:
        """Return the motion of the inner ring relative to the sliding outer ring."""
        motion = np.asarray(motion, float)
        preload = float(self.row.load(np.zeros(6))[1])
        # the spring takes the force of the row beyond its preload: k w = F(q - w) - F(0)
        y = motion[..., 1]
        most = abs(preload) / self.spring
        return slide_to_balance(
            self.row.load,
            self.row.tangent,
            motion,
            np.minimum(y, 0.0) - most,
            np.maximum(y, 0.0) + most,
            lambda t: preload + self.spring * (y - t),
            self.spring,
        )

    def load(self, motion: np.ndarray) -> np.ndarray:
        """Return the load that holds the inner ring at motions (..., 6)."""
        return self.row.load(self._relative_motion(motion))

    def tangent(self, motion: np.ndarray) -> np.ndarray:
        """Return the derivative of the load, (..., 6, 6)."""
        return condense_y(self.row.tangent(self._relative_motion(motion)), self.spring)

    def contacts(self, motion: np.ndarray) -> Contacts:
        """Return loads of all elements."""
        return self.row.contacts(self._relative_motion(motion))
