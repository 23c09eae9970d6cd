r"""Motion of a remainder whose laws have straight pieces: linear in time between crossings.

While every stretch stays on its piece, the state ``y = (omega q, q')`` with the excitation
``(1, cos n w t, sin n w t)`` beside it obeys one linear equation ``Y' = B Y`` and the stretches are
rows of it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg as sla

from solidgear.errors import SolidgearError
from solidgear.nonlinear.model import Remainder

#: norm of B times a step at most, and terms of the exponential's series within one
SHORT, TERMS = 0.5, 14


@dataclass(frozen=True, eq=False)
class Piece:
    """A combination of pieces: generator B, rows of the stretches and of their rates, and of forces."""

    matrix: np.ndarray
    stretch: np.ndarray
    rate: np.ndarray

    @cached_property
    def size(self) -> float:
        """Norm of the generator."""
        return float(np.abs(self.matrix).sum(axis=1).max())

    def over(self, time: float) -> np.ndarray:
        """Transition over a time."""
        return sla.expm(time * self.matrix)

    def series(self, state: np.ndarray) -> np.ndarray:
        """(TERMS, n) coefficients of the state over time from here."""
        out = np.empty((TERMS, len(state)))
        out[0] = state
        for k in range(1, TERMS):
            out[k] = self.matrix @ out[k - 1] / k
        return out


class Pieces:
    """All pieces of a remainder under an excitation of one frequency, made as they are met.

    Parameters
    ----------
    omega : float
        rad/s.

    Raises
    ------
    SolidgearError
        For a law that has no straight pieces.
    """

    def __init__(self, remainder: Remainder, omega: float):
        if remainder.varies or not all(law.pieces for law, _ in remainder.laws):
            raise SolidgearError(
                "a law that is curved, or varies over the cycle, has no straight pieces in time"
            )
        self.remainder, self.omega = remainder, omega
        self.edges: list[np.ndarray] = []
        self.law = []
        for law, at in remainder.laws:
            self.edges += [np.array(law.edges)] * (at.stop - at.start)
            self.law += [law] * (at.stop - at.start)
        self._made: dict[tuple[int, ...], Piece] = {}

    def name(self, stretch: np.ndarray) -> tuple[int, ...]:
        """Piece that every stretch (m,) is on."""
        return tuple(int(np.searchsorted(e, s)) for e, s in zip(self.edges, stretch))

    def piece(self, name: tuple[int, ...]) -> Piece:
        """The linear equation there."""
        if name not in self._made:
            self._made[name] = self._piece(name)
        return self._made[name]

    def straight(self, name: tuple[int, ...]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Stiffness, damper and offset (m,) of every law on these pieces: ``k s + c v + f``."""
        k, c, f = (np.zeros(len(name)) for _ in range(3))
        for row, (where, edge, law) in enumerate(zip(name, self.edges, self.law)):
            inner = np.concatenate([edge[:1] - 1.0, edge, edge[-1:] + 1.0])
            middle = np.array([[(inner[where] + inner[where + 1]) / 2]])
            own = law.force(middle, np.zeros((1, 1)))
            k[row], c[row] = own.by_stretch[0, 0, 0], own.by_rate[0, 0, 0]
            f[row] = own.value[0, 0] - k[row] * middle[0, 0]
        return k, c, f

    def _piece(self, name: tuple[int, ...]) -> Piece:
        own, m = self.remainder, self.remainder.rows
        k, c, f = self.straight(name)
        r, orders = len(own.omega), len(own.error)
        n = 2 * r + 1 + 2 * orders
        more = own.stiffness - np.diag(k)
        still = np.linalg.inv(np.eye(m) - own.flexible @ more)
        # e and its rate as rows of the state beside y
        e, soft, grown = np.zeros((m, n)), np.zeros((m, n)), own.growth(self.omega)
        spin = np.zeros((n, n))
        for order in range(1, orders + 1):
            at, w = 2 * r + 2 * order - 1, order * self.omega
            spin[at, at + 1], spin[at + 1, at] = -w, w  # cos, sin
            e[:, at], e[:, at + 1] = own.error[order - 1].real, -own.error[order - 1].imag
            gives, push = grown * own.gives[order - 1], grown * own.push[order - 1]
            soft[:, at], soft[:, at + 1] = gives.real, -gives.imag
            spin[r : 2 * r, at], spin[r : 2 * r, at + 1] = push.real, -push.imag
        slope = e @ spin
        base = own.flexible @ own.stiffness - np.eye(m)
        stretch, rate = base @ e + soft, base @ slope + soft @ spin
        stretch[:, :r] += own.seen / own.omega
        rate[:, r : 2 * r] += own.seen
        stretch[:, 2 * r] += own.mean - own.flexible @ f
        stretch, rate = still @ stretch, still @ rate
        push = own.stiffness @ e + own.drag @ slope + more @ stretch
        push += (own.damper - np.diag(c)) @ rate
        push[:, 2 * r] -= f
        matrix = spin
        matrix[: 2 * r, : 2 * r] += own.state
        matrix[r : 2 * r] += own.seen.T @ push
        return Piece(matrix, stretch, rate)
