"""A bearing as rows of rolling elements: displacement to load and back, and tangent."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from solidgear.bearings.newton import NothingHolds, settle
from solidgear.bearings.ribs import Ribs
from solidgear.bearings.row import Contacts
from solidgear.bearings.sliding import FURTHEST, condense_y, slide_to_balance
from solidgear.core import DOF_NAMES, SolidgearError

#: units of the components of a load
UNITS = ("N", "N", "N", "N m", "N m", "N m")


class Row(Protocol):
    """Interface of a row of rolling elements; see :mod:`solidgear.bearings.row`."""

    @property
    def pitch(self) -> float:
        """Diameter of the circle of the elements' centres, m."""

    def load(self, motion: np.ndarray) -> np.ndarray:
        """Return the load (..., 6) that holds the inner ring at motions (..., 6)."""

    def tangent(self, motion: np.ndarray) -> np.ndarray:
        """Return the derivative of the load, (..., 6, 6)."""

    def contacts(self, motion: np.ndarray) -> Contacts:
        """Return loads of all elements."""


@dataclass(frozen=True)
class RollingBearing:
    """Rows of rolling elements between one inner and one outer ring, or rings that move as one.

    Motions are those of the inner ring, with the shaft, against the outer one; loads are those that
    act on the inner ring from outside, and that the bearing carries.  Both at one reference point
    on the axis, order (x, y, z, thx, thy, thz), SI.

    Examples
    --------
    >>> import numpy as np
    >>> from solidgear.bearings.ball import BallRow
    >>> bearing = RollingBearing((BallRow(count=7, diameter=11.5e-3, pitch=43.5e-3),))
    >>> motion = bearing.motion([1000.0, 0, 0, 0, 0, 0])
    >>> round(float(motion[0]) * 1e6, 2)
    15.11
    >>> stiffness = bearing.tangent(motion)
    >>> bool(np.array_equal(stiffness, stiffness.T))
    True
    """

    rows: tuple[Row, ...]
    #: one of its rings slides along y in its seat, without friction: at every motion the rows stand
    #: where nothing presses them along y, and the stiffness is condensed
    floats: bool = False
    ribs: Ribs | None = None  #: that hold the shaft along y beside the rows

    @cached_property
    def size(self) -> np.ndarray:
        """(6,) motions that count alike: metres, and metres at the pitch radius."""
        turn = 2 / max(row.pitch for row in self.rows)
        return np.array([1.0, 1.0, 1.0, turn, turn, turn])

    def ring_motion(self, motion: np.ndarray) -> np.ndarray:
        """Return the motions (..., 6) of the inner ring against the outer one, at the place to
        which a seat slides.
        """
        motion = np.asarray(motion, float)
        if not self.floats:
            return motion
        limit = np.full(motion.shape[:-1], FURTHEST)
        return slide_to_balance(self._load, self._tangent, motion, -limit, limit)

    @property
    def _carriers(self) -> tuple[Row | Ribs, ...]:
        """Rows, and ribs where there are some."""
        return self.rows if self.ribs is None else (*self.rows, self.ribs)

    def _load(self, motion: np.ndarray) -> np.ndarray:
        return sum((part.load(motion) for part in self._carriers), np.zeros(()))

    def _tangent(self, motion: np.ndarray) -> np.ndarray:
        return sum((part.tangent(motion) for part in self._carriers), np.zeros(()))

    def load(self, motion: np.ndarray) -> np.ndarray:
        """Return the load (..., 6) at motions (..., 6)."""
        load = self._load(self.ring_motion(motion))
        if self.floats:
            load[..., 1] = 0.0
        return load

    def tangent(self, motion: np.ndarray) -> np.ndarray:
        """Return the tangent stiffness (..., 6, 6) at motions (..., 6): symmetric, with a zero row
        of thy.
        """
        stiffness = self._tangent(self.ring_motion(motion))
        if self.floats:
            stiffness = condense_y(stiffness)
            stiffness[..., 1, :] = stiffness[..., :, 1] = 0.0
        return stiffness

    def contacts(self, motion: np.ndarray) -> tuple[Contacts, ...]:
        """Return loads of all elements of all rows at one motion."""
        ring_motion = self.ring_motion(motion)
        return tuple(row.contacts(ring_motion) for row in self.rows)

    def at_work(self, motion: np.ndarray) -> float:
        """Return the sum of all contact forces at one motion, N, whether or not they balance each
        other.
        """
        return float(sum(row.load.sum() for row in self.contacts(motion)))

    def motion(
        self, load: Sequence[float] | np.ndarray, fixed: Sequence[int] = (), start=None
    ) -> np.ndarray:
        """Return the motion (6,), m and rad, at which the bearing carries a load (6,), N and N m.

        The torque about y must be zero. Components `fixed`, such as ``(3, 5)`` for a shaft that
        cannot tilt, stand still and take the load that results; components without stiffness stay
        at `start`. A load that the bearing cannot carry is refused.
        """
        target = np.array(load, float)
        if target[4] != 0.0:
            raise SolidgearError(
                f"a bearing carries no torque about its axis, but the load has {target[4]:g} N m"
            )
        if self.floats and target[1] != 0.0:
            raise SolidgearError(
                f"a floating bearing carries nothing along y, but the load has {target[1]:g} N"
            )
        begin = np.zeros(6) if start is None else np.array(start, float)
        still = {4, *fixed} | ({1} if self.floats else set())
        move = [k for k in range(6) if k not in still]

        def full_motion(x: np.ndarray) -> np.ndarray:
            full = begin.copy()
            full[move] = x
            return full

        try:
            settled = settle(
                lambda x: self.load(full_motion(x))[move],
                lambda x: self.tangent(full_motion(x))[np.ix_(move, move)],
                target[move],
                self.size[move],
                begin[move],
                self.at_work(begin),
            )
        except NothingHolds as error:
            raise SolidgearError(_not_carried(target, move, error.direction)) from None
        if settled.unbalanced > 1e-6:
            raise SolidgearError(
                f"no equilibrium under {_load_in_words(target)}: {settled.unbalanced:.1e} of it is left over"
            )
        return self.ring_motion(full_motion(settled.motion))


def _not_carried(load: np.ndarray, move: Sequence[int], direction: np.ndarray) -> str:
    name = DOF_NAMES[move[int(np.argmax(np.abs(direction)))]]
    return f"the bearing cannot carry {_load_in_words(load)}: nothing holds it in {name}"


def _load_in_words(load: np.ndarray) -> str:
    """Return a load in words, without zeros."""
    parts = [f"{v:.6g} {u} in {n}" for v, u, n in zip(load, UNITS, DOF_NAMES) if v != 0.0]
    return " and ".join(parts) or "no load"
