"""A bearing as its rows of rolling elements: displacement to load and back, and tangent."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from solidgear.bearings.newton import NothingHolds, settle
from solidgear.bearings.row import Contacts
from solidgear.bearings.sliding import FURTHEST, balanced, condensed
from solidgear.errors import SolidgearError
from solidgear.frames import DOF_NAMES

#: what the unit of each component is, and its load's
UNITS = ("N", "N", "N", "N m", "N m", "N m")


class Row(Protocol):
    """Interface of a row of rolling elements; see :mod:`solidgear.bearings.row`."""

    @property
    def pitch(self) -> float:
        """Diameter of the circle of the elements' centres, m."""

    def load(self, motion: np.ndarray) -> np.ndarray:
        """Load (..., 6) that holds the inner ring at motions (..., 6)."""

    def tangent(self, motion: np.ndarray) -> np.ndarray:
        """Its derivative, (..., 6, 6)."""

    def contacts(self, motion: np.ndarray) -> Contacts:
        """Loads of all elements."""


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
    #: where nothing presses them along y, and the stiffness is what is left then
    floats: bool = False

    @cached_property
    def size(self) -> np.ndarray:
        """(6,) motions that count alike: metres, and metres at the pitch radius."""
        turn = 2 / max(row.pitch for row in self.rows)
        return np.array([1.0, 1.0, 1.0, turn, turn, turn])

    def seen(self, motion: np.ndarray) -> np.ndarray:
        """Motions (..., 6) of the inner ring against the outer one, wherever a seat slides."""
        motion = np.asarray(motion, float)
        if not self.floats:
            return motion
        far = np.full(motion.shape[:-1], FURTHEST)
        return balanced(self._load, self._tangent, motion, -far, far)

    def _load(self, motion: np.ndarray) -> np.ndarray:
        return sum((row.load(motion) for row in self.rows), np.zeros(()))

    def _tangent(self, motion: np.ndarray) -> np.ndarray:
        return sum((row.tangent(motion) for row in self.rows), np.zeros(()))

    def load(self, motion: np.ndarray) -> np.ndarray:
        """Load (..., 6) at motions (..., 6)."""
        load = self._load(self.seen(motion))
        if self.floats:
            load[..., 1] = 0.0
        return load

    def tangent(self, motion: np.ndarray) -> np.ndarray:
        """Tangent stiffness (..., 6, 6) at motions (..., 6): symmetric, with a zero row of thy."""
        stiffness = self._tangent(self.seen(motion))
        if self.floats:
            stiffness = condensed(stiffness)
            stiffness[..., 1, :] = stiffness[..., :, 1] = 0.0
        return stiffness

    def contacts(self, motion: np.ndarray) -> tuple[Contacts, ...]:
        """Loads of all elements of all rows at one motion."""
        seen = self.seen(motion)
        return tuple(row.contacts(seen) for row in self.rows)

    def at_work(self, motion: np.ndarray) -> float:
        """Sum of all contact forces at one motion, N, whether or not they balance each other."""
        return float(sum(row.load.sum() for row in self.contacts(motion)))

    def motion(
        self, load: Sequence[float] | np.ndarray, held: Sequence[int] = (), start=None
    ) -> np.ndarray:
        """Motion at which the bearing carries a load.

        Parameters
        ----------
        load : (6,) array_like
            N and N m; the torque about y must be zero.
        held : sequence of int
            Components that stand still and take what load they must, such as ``(3, 5)`` for a shaft
            that cannot tilt.
        start : (6,) ndarray, optional
            Where to begin.

        Returns
        -------
        (6,) ndarray
            m and rad; components that nothing asks for stay at `start`.

        Raises
        ------
        SolidgearError
            If the bearing cannot carry the load.
        """
        wanted = np.array(load, float)
        if wanted[4] != 0.0:
            raise SolidgearError(
                f"a bearing carries no torque about its axis, but {wanted[4]:g} N m are asked of it"
            )
        if self.floats and wanted[1] != 0.0:
            raise SolidgearError(
                f"a floating bearing carries nothing along y, but {wanted[1]:g} N are asked of it"
            )
        begin = np.zeros(6) if start is None else np.array(start, float)
        still = {4, *held} | ({1} if self.floats else set())
        move = [k for k in range(6) if k not in still]

        def whole(x: np.ndarray) -> np.ndarray:
            full = begin.copy()
            full[move] = x
            return full

        try:
            found = settle(
                lambda x: self.load(whole(x))[move],
                lambda x: self.tangent(whole(x))[np.ix_(move, move)],
                wanted[move],
                self.size[move],
                begin[move],
                self.at_work(begin),
            )
        except NothingHolds as error:
            raise SolidgearError(_not_carried(wanted, move, error.direction)) from None
        if found.unbalanced > 1e-6:
            raise SolidgearError(
                f"no equilibrium under {_load_in_words(wanted)}: {found.unbalanced:.1e} of it is left over"
            )
        return self.seen(whole(found.motion))


def _not_carried(load: np.ndarray, move: Sequence[int], direction: np.ndarray) -> str:
    name = DOF_NAMES[move[int(np.argmax(np.abs(direction)))]]
    return f"the bearing cannot carry {_load_in_words(load)}: nothing holds it in {name}"


def _load_in_words(load: np.ndarray) -> str:
    """A load in words, its zeros left out."""
    parts = [f"{v:.6g} {u} in {n}" for v, u, n in zip(load, UNITS, DOF_NAMES) if v != 0.0]
    return " and ".join(parts) or "no load"
