r"""Motion in time to a tolerance: curved laws, those that vary over the cycle, and speeds that
change.

Where a law has kinks a step is cut at the kink and the next one begins there, each with the law
continued as it was, so that the method keeps the order.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from scipy.integrate import DOP853
from scipy.optimize import brentq

from solidgear.backlash.solver.kinks import continued, kinks
from solidgear.backlash.solver.model import Remainder
from solidgear.backlash.solver.sway import Line
from solidgear.core import SolidgearError

#: looks at a stretch in a period
LOOKS = 128
#: relative, and steps of Newton's method for the flexible modes
TOLERANCE, NEWTON = 1e-7, 20
#: how near in time a kink is found, of its step
LOCATED = 1e-12


class Integrated:
    """Motion of a remainder in time from an angle of the excitation, at one frequency `omega`,
    rad/s, or with one that grows by `ramp`, rad/s^2.
    """

    def __init__(
        self,
        remainder: Remainder,
        omega: float,
        looks: int = LOOKS,
        tolerance: float = TOLERANCE,
        ramp: float = 0.0,
    ):
        self.remainder, self.omega, self.looks = remainder, omega, looks
        self.tolerance, self.ramp = tolerance, ramp
        self._orders = 1j * np.arange(1, len(remainder.error) + 1)
        self._soft, self._eye = bool(remainder.flexible.any()), np.eye(remainder.rows)
        self._sides: list[bool] = []
        self._step: float | None = None
        self._pieces: dict[tuple[bool, ...], tuple[np.ndarray, np.ndarray, np.ndarray]] = {}

    def speed(self, t):
        """Return the frequency of the excitation at a time, rad/s."""
        return self.omega + self.ramp * t

    def angle(self, t):
        """Return the angle of the excitation at a time, rad."""
        return t * (self.omega + self.ramp * t / 2)

    def period(self, modal: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the state (2r,) a period later, and stretches and rates (looks, m) on the way."""
        return self.integrate(modal, np.linspace(0.0, 2 * np.pi / self.omega, self.looks + 1))

    def integrate(
        self, modal: np.ndarray, times: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the state (2r,) at the last of some times (n,), and stretches and rates (n - 1, m)
        at all others, from the state at the first; refuse steps that become too short.
        """
        t, y, k = float(times[0]), modal, 1
        begin = self._stretches(times[:1], y[None], None)
        self._sides = [bool(gap[0] > 0) for gap in self._gaps(times[:1], begin[0])]
        parts = [begin[:2]]
        while t < times[-1]:
            solver = self._solver(t, y, float(times[-1]))
            while solver.status == "running":
                message = solver.step()
                if solver.status == "failed":
                    raise SolidgearError(f"integration in time failed: {message}")
                self._step = solver.step_size
                between = solver.dense_output()
                last = k + int(np.searchsorted(times[k:], solver.t, side="right"))
                instants = np.append(times[k:last], solver.t)
                s, v, _ = self._stretches(instants, between(instants).T, self._sides)
                kink = self._first_kink(solver.t_old, instants, s, between)
                count = last - k if kink is None else int(np.searchsorted(instants[:-1], kink[0]))
                parts.append((s[:count], v[:count]))
                k += count
                t, y = solver.t, solver.y
                if kink is not None:
                    t, y = kink[0], between(kink[0])
                    self._sides[kink[1]] ^= True
                    break
        s, v = (np.concatenate(rows)[: len(times) - 1] for rows in zip(*parts))
        return y, s, v

    def _solver(self, t: float, y: np.ndarray, end: float) -> DOP853:
        step = None if self._step is None else min(self._step, end - t)
        remainder = self.remainder
        straight = remainder.sway is None and all(law.pieces for law, _ in remainder.laws)
        slope = self._straight_slope if straight else self._slope
        return DOP853(slope, t, y, end, rtol=self.tolerance, atol=self._accuracy, first_step=step)

    def _first_kink(
        self, begin: float, instants: np.ndarray, s: np.ndarray, between
    ) -> tuple[float, int] | None:
        """Return time and number of the first kink that is crossed up to the last of some times."""
        first = None
        for number, (gap, side) in enumerate(zip(self._gaps(instants, s), self._sides)):
            changes = np.flatnonzero((gap > 0) != side)
            if not len(changes):
                continue
            before = instants[changes[0] - 1] if changes[0] else begin
            time = self._crossing(number, float(before), float(instants[changes[0]]), between)
            if first is None or time < first[0]:
                first = time, number
        return first

    def _crossing(self, number: int, before: float, after: float, between) -> float:
        def gap(t: float) -> float:
            instant = np.array([t])
            s, _, _ = self._stretches(instant, between(instant).T, self._sides)
            return float(self._gaps(instant, s)[number][0])

        if gap(before) * gap(after) > 0:  # begun on the wrong side by rounding
            return before
        return float(brentq(gap, before, after, xtol=LOCATED * (after - before), rtol=1e-15))

    def _gaps(self, instants: np.ndarray, s: np.ndarray) -> list[np.ndarray]:
        return [kink.gap for kink in kinks(self.remainder, s, self._line(instants))]

    def _line(self, instants: np.ndarray) -> Line | None:
        return self.remainder.line(self.angle(instants), self.speed(instants)[:, None])

    @cached_property
    def _accuracy(self) -> float:
        """Return the accuracy of a state: a share of that of the linear system."""
        remainder = self.remainder
        size = np.abs(remainder.linear(self.omega, len(remainder.error))[0]).max()
        return self.tolerance * float(remainder.omega[0] * size / np.abs(remainder.shapes).max())

    def _stretches(
        self, t: np.ndarray, y: np.ndarray, sides: list[bool] | None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return stretches and rates (T, m) of states (T, 2r), and the force of the excess with the
        excitation; laws are continued beyond their kinks where sides are given.
        """
        remainder, r = self.remainder, len(self.remainder.omega)
        turn, turning = self._excitation(t)
        e, slope = (turn @ remainder.error).real, (turning @ remainder.error).real
        push = e @ remainder.stiffness
        v = y[:, r:] @ remainder.shapes.T - slope
        base = (y[:, :r] / remainder.omega) @ remainder.shapes.T + remainder.mean - e
        line = self._line(t)
        factor = remainder.factor(self.angle(t)) if remainder.varies else None

        def excess(s: np.ndarray, rate: np.ndarray):
            if sides is None:
                return remainder.excess(s, rate, factor, line)[0]
            return continued(remainder, sides, s, rate, factor, line)

        if not remainder.flexible.any():
            return base, v, excess(base, v).value + push + slope @ remainder.drag
        s = base = (
            base + push @ remainder.flexible + self._growth(t) * (turn @ remainder.gives).real
        )
        still, eye = np.zeros_like(s), np.eye(s.shape[1])
        force = excess(s, still)
        for _ in range(NEWTON):
            miss = s - base - force.value @ remainder.flexible
            tangent = eye - remainder.flexible @ force.by_stretch
            step = np.linalg.solve(tangent, miss[..., None])[..., 0]
            s = s - step
            if np.abs(step).max() <= 1e-3 * self.tolerance * np.abs(s).max():
                break
            before, force = force, excess(s, still)
            if (before.by_stretch == force.by_stretch).all():  # straight: it has arrived
                break
        if remainder.drags:
            force = excess(s, v)
        return s, v, force.value + push + slope @ remainder.drag

    def _excitation(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return orders (T, o) of the excitation, and their rates."""
        turn = np.exp(self.angle(t)[:, None] * self._orders)
        return turn, self.speed(t)[:, None] * self._orders * turn

    def _growth(self, t: np.ndarray) -> np.ndarray:
        """Return the factor (T, 1) of forces of unbalance."""
        return self.remainder.growth(self.speed(t))[:, None]

    def _straight(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return stiffness, damper (m, m) and offset (m,) of all laws, continued beyond their
        kinks.
        """
        sides, remainder = tuple(self._sides), self.remainder
        if sides not in self._pieces:
            # anywhere but at an edge, where a law is on no side
            edge = 2 * max(
                (abs(edge) for law, _ in remainder.laws for edge in law.edges), default=0.0
            )
            far = np.full((1, remainder.rows), edge or 1.0)
            excess = continued(remainder, sides, far, 0 * far, None, None)
            stiffness = remainder.stiffness - excess.by_stretch[0]
            offset = (far @ (remainder.stiffness - stiffness) - excess.value)[0]
            self._pieces[sides] = stiffness, remainder.damper - excess.by_rate[0], offset
        return self._pieces[sides]

    @cached_property
    def _table(self) -> tuple[np.ndarray, np.ndarray, list[int]]:
        """Return orders, all that goes round with them as columns, and where each part ends:
        transmission errors, their rates at 1 rad/s, the variation of laws, forces on the other
        modes and on these.
        """
        remainder = self.remainder
        count = max(len(remainder.error), len(remainder.cycle))
        orders = 1j * np.arange(1, count + 1)
        parts = [
            remainder.error,
            self._orders[:, None] * remainder.error,
            remainder.cycle,
            remainder.gives,
            remainder.push,
        ]
        padded = [np.vstack([part, np.zeros((count - len(part), part.shape[1]))]) for part in parts]
        return orders, np.hstack(padded), np.cumsum([part.shape[1] for part in padded]).tolist()

    def _straight_slope(self, t: float, y: np.ndarray) -> np.ndarray:
        """Return the same as :meth:`_slope` where laws are straight and nothing but their size
        varies.
        """
        remainder, r = self.remainder, len(self.remainder.omega)
        angle, speed = self.angle(t), self.speed(t)
        orders, table, (a, b, c, d, _) = self._table
        around = (np.exp(angle * orders) @ table).real
        e, rate, factor = around[:a], speed * around[a:b], 1 + around[b:c]
        stiffness, damper, offset = self._straight()
        offset = factor * offset
        more, force = remainder.stiffness - factor[:, None] * stiffness, remainder.stiffness @ e
        s = remainder.shapes @ (y[:r] / remainder.omega) + remainder.mean - e
        if self._soft:
            s += remainder.flexible @ (force - offset) + remainder.growth(speed) * around[c:d]
            matrix = self._eye - remainder.flexible @ more
            s = s / matrix[0] if len(s) == 1 else np.linalg.solve(matrix, s)
        push = more @ s - offset + force + remainder.drag @ rate
        if remainder.drags:
            push += (remainder.damper - factor[:, None] * damper) @ (
                remainder.shapes @ y[r:] - rate
            )
        out = remainder.state @ y
        out[r:] += push @ remainder.shapes + remainder.growth(speed) * around[d:]
        return out

    def _slope(self, t: float, y: np.ndarray) -> np.ndarray:
        remainder, instant = self.remainder, np.array([t])
        out = remainder.state @ y
        push = self._stretches(instant, y[None], self._sides)[2] @ remainder.shapes
        if remainder.push.any():
            push = (
                push + self._growth(instant) * (self._excitation(instant)[0] @ remainder.push).real
            )
        out[len(remainder.omega) :] += push[0]
        return out
