r"""Motion of a remainder whose laws have straight pieces: linear in time between crossings.

While every stretch stays on a piece, the state ``y = (omega q, q')`` with the excitation
``(1, cos n w t, sin n w t)`` beside it obeys one linear equation ``Y' = B Y`` and the stretches are
rows of it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg as sla

from solidgear.backlash.solver.model import Remainder
from solidgear.core import SolidgearError

#: norm of B times a step at most, and terms of the exponential's series within one
SHORT, TERMS = 0.5, 14


@dataclass(frozen=True, eq=False)
class Piece:
    """Combination of pieces: generator B, and rows of the stretches and of their rates."""

    matrix: np.ndarray
    stretch: np.ndarray
    rate: np.ndarray

    @cached_property
    def size(self) -> float:
        """Return the norm of the generator."""
        return float(np.abs(self.matrix).sum(axis=1).max())

    def over(self, time: float) -> np.ndarray:
        """Return the transition over a time."""
        return sla.expm(time * self.matrix)

    def series(self, state: np.ndarray) -> np.ndarray:
        """Return coefficients (TERMS, n) of the state over time from the beginning."""
        out = np.empty((TERMS, len(state)))
        out[0] = state
        for k in range(1, TERMS):
            out[k] = self.matrix @ out[k - 1] / k
        return out


class Pieces:
    """All pieces of a remainder under an excitation of one frequency, rad/s, computed when they are
    met; a law without straight pieces is refused.
    """

    def __init__(self, remainder: Remainder, omega: float):
        if remainder.varies or not all(law.pieces for law, _ in remainder.laws):
            raise SolidgearError(
                "a law that is curved, or varies over the cycle, has no straight pieces in time"
            )
        self.remainder, self.omega = remainder, omega
        self.edges: list[np.ndarray] = []
        self.law = []
        for law, rows in remainder.laws:
            self.edges += [np.array(law.edges)] * (rows.stop - rows.start)
            self.law += [law] * (rows.stop - rows.start)
        self._known: dict[tuple[int, ...], Piece] = {}

    def name(self, stretch: np.ndarray) -> tuple[int, ...]:
        """Return the piece on which every stretch (m,) lies."""
        return tuple(int(np.searchsorted(e, s)) for e, s in zip(self.edges, stretch))

    def piece(self, name: tuple[int, ...]) -> Piece:
        """Return the linear equation on some pieces."""
        if name not in self._known:
            self._known[name] = self._piece(name)
        return self._known[name]

    def straight(self, name: tuple[int, ...]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return stiffness, damper and offset (m,) of every law on these pieces: ``k s + c v + f``."""
        k, c, f = (np.zeros(len(name)) for _ in range(3))
        for row, (place, edge, law) in enumerate(zip(name, self.edges, self.law)):
            inner = np.concatenate([edge[:1] - 1.0, edge, edge[-1:] + 1.0])
            middle = np.array([[(inner[place] + inner[place + 1]) / 2]])
            force = law.force(middle, np.zeros((1, 1)))
            k[row], c[row] = force.by_stretch[0, 0, 0], force.by_rate[0, 0, 0]
            f[row] = force.value[0, 0] - k[row] * middle[0, 0]
        return k, c, f

    def _piece(self, name: tuple[int, ...]) -> Piece:
        remainder, m = self.remainder, self.remainder.rows
        k, c, f = self.straight(name)
        r, orders = len(remainder.omega), len(remainder.error)
        n = 2 * r + 1 + 2 * orders
        more = remainder.stiffness - np.diag(k)
        still = np.linalg.inv(np.eye(m) - remainder.flexible @ more)
        # e and its rate as rows of the state beside y
        e, soft, grown = np.zeros((m, n)), np.zeros((m, n)), remainder.growth(self.omega)
        spin = np.zeros((n, n))
        for order in range(1, orders + 1):
            column, w = 2 * r + 2 * order - 1, order * self.omega
            spin[column, column + 1], spin[column + 1, column] = -w, w  # cos, sin
            e[:, column], e[:, column + 1] = (
                remainder.error[order - 1].real,
                -remainder.error[order - 1].imag,
            )
            gives, push = grown * remainder.gives[order - 1], grown * remainder.push[order - 1]
            soft[:, column], soft[:, column + 1] = gives.real, -gives.imag
            spin[r : 2 * r, column], spin[r : 2 * r, column + 1] = push.real, -push.imag
        slope = e @ spin
        base = remainder.flexible @ remainder.stiffness - np.eye(m)
        stretch, rate = base @ e + soft, base @ slope + soft @ spin
        stretch[:, :r] += remainder.shapes / remainder.omega
        rate[:, r : 2 * r] += remainder.shapes
        stretch[:, 2 * r] += remainder.mean - remainder.flexible @ f
        stretch, rate = still @ stretch, still @ rate
        push = remainder.stiffness @ e + remainder.drag @ slope + more @ stretch
        push += (remainder.damper - np.diag(c)) @ rate
        push[:, 2 * r] -= f
        matrix = spin
        matrix[: 2 * r, : 2 * r] += remainder.state
        matrix[r : 2 * r] += remainder.shapes.T @ push
        return Piece(matrix, stretch, rate)
