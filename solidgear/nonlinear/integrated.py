r"""Motion in time to a tolerance: curved laws, those that vary over the cycle, and speeds that change.

Where a law has kinks a step is cut at the kink and the next one begins there, each with the law
continued as it was, so that the method keeps its order.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from scipy.integrate import DOP853
from scipy.optimize import brentq

from solidgear.errors import SolidgearError
from solidgear.nonlinear.kinks import continued, kinks
from solidgear.nonlinear.model import Remainder
from solidgear.nonlinear.sway import Line

#: looks at a stretch in a period
LOOKS = 128
#: relative, and steps of Newton's method for what gives way at once
TOLERANCE, NEWTON = 1e-7, 20
#: how near in time a kink is found, of its step
LOCATED = 1e-12


class Integrated:
    """A remainder in time from an angle of the excitation, at one frequency or under a ramp.

    Parameters
    ----------
    omega : float
        Of the excitation at the beginning, rad/s.
    ramp : float
        How it grows, rad/s^2.
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
        self._beyond: list[bool] = []
        self._step: float | None = None
        self._pieces: dict[tuple[bool, ...], tuple[np.ndarray, np.ndarray, np.ndarray]] = {}

    def speed(self, t):
        """Frequency of the excitation, rad/s."""
        return self.omega + self.ramp * t

    def angle(self, t):
        """Of the excitation, rad."""
        return t * (self.omega + self.ramp * t / 2)

    def period(self, modal: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """State (2r,) a period later, and stretches and rates (looks, m) on the way."""
        return self.over(modal, np.linspace(0.0, 2 * np.pi / self.omega, self.looks + 1))

    def over(
        self, modal: np.ndarray, times: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """State (2r,) at the last of some times (n,), and stretches and rates (n - 1, m) at all
        others, from the state at the first.

        Raises
        ------
        SolidgearError
            If steps become too short.
        """
        t, y, k = float(times[0]), modal, 1
        begin = self._seen(times[:1], y[None], None)
        self._beyond = [bool(gap[0] > 0) for gap in self._gaps(times[:1], begin[0])]
        seen = [begin[:2]]
        while t < times[-1]:
            solver = self._solver(t, y, float(times[-1]))
            while solver.status == "running":
                told = solver.step()
                if solver.status == "failed":
                    raise SolidgearError(f"integration in time failed: {told}")
                self._step = solver.step_size
                between = solver.dense_output()
                last = k + int(np.searchsorted(times[k:], solver.t, side="right"))
                at = np.append(times[k:last], solver.t)
                s, v, _ = self._seen(at, between(at).T, self._beyond)
                met = self._met(solver.t_old, at, s, between)
                count = last - k if met is None else int(np.searchsorted(at[:-1], met[0]))
                seen.append((s[:count], v[:count]))
                k += count
                t, y = solver.t, solver.y
                if met is not None:
                    t, y = met[0], between(met[0])
                    self._beyond[met[1]] ^= True
                    break
        s, v = (np.concatenate(rows)[: len(times) - 1] for rows in zip(*seen))
        return y, s, v

    def _solver(self, t: float, y: np.ndarray, end: float) -> DOP853:
        step = None if self._step is None else min(self._step, end - t)
        own = self.remainder
        straight = own.sway is None and all(law.pieces for law, _ in own.laws)
        slope = self._straight_slope if straight else self._slope
        return DOP853(slope, t, y, end, rtol=self.tolerance, atol=self._least, first_step=step)

    def _met(
        self, begin: float, at: np.ndarray, s: np.ndarray, between
    ) -> tuple[float, int] | None:
        """Time and number of the first kink that is crossed up to the last of some times."""
        found = None
        for number, (gap, on) in enumerate(zip(self._gaps(at, s), self._beyond)):
            gone = np.flatnonzero((gap > 0) != on)
            if not len(gone):
                continue
            before = at[gone[0] - 1] if gone[0] else begin
            when = self._crossing(number, float(before), float(at[gone[0]]), between)
            if found is None or when < found[0]:
                found = when, number
        return found

    def _crossing(self, number: int, before: float, after: float, between) -> float:
        def gap(t: float) -> float:
            at = np.array([t])
            s, _, _ = self._seen(at, between(at).T, self._beyond)
            return float(self._gaps(at, s)[number][0])

        if gap(before) * gap(after) > 0:  # begun on the wrong side by rounding
            return before
        return float(brentq(gap, before, after, xtol=LOCATED * (after - before), rtol=1e-15))

    def _gaps(self, at: np.ndarray, s: np.ndarray) -> list[np.ndarray]:
        return [kink.gap for kink in kinks(self.remainder, s, self._line(at))]

    def _line(self, at: np.ndarray) -> Line | None:
        return self.remainder.line(self.angle(at), self.speed(at)[:, None])

    @cached_property
    def _least(self) -> float:
        """Accuracy of a state: a share of that of the linear system."""
        own = self.remainder
        size = np.abs(own.linear(self.omega, len(own.error))[0]).max()
        return self.tolerance * float(own.omega[0] * size / np.abs(own.seen).max())

    def _seen(
        self, t: np.ndarray, y: np.ndarray, beyond: list[bool] | None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Stretches and rates (T, m) of states (T, 2r), and the force of the excess with the
        excitation; of laws continued beyond their kinks where told on which side.
        """
        own, r = self.remainder, len(self.remainder.omega)
        turn, turning = self._turned(t)
        e, slope = (turn @ own.error).real, (turning @ own.error).real
        given = e @ own.stiffness
        v = y[:, r:] @ own.seen.T - slope
        base = (y[:, :r] / own.omega) @ own.seen.T + own.mean - e
        line = self._line(t)
        factor = own.factor(self.angle(t)) if own.varies else None

        def excess(s: np.ndarray, rate: np.ndarray):
            if beyond is None:
                return own.excess(s, rate, factor, line)[0]
            return continued(own, beyond, s, rate, factor, line)

        if not own.flexible.any():
            return base, v, excess(base, v).value + given + slope @ own.drag
        s = base = base + given @ own.flexible + self._grown(t) * (turn @ own.gives).real
        still, eye = np.zeros_like(s), np.eye(s.shape[1])
        force = excess(s, still)
        for _ in range(NEWTON):
            left = s - base - force.value @ own.flexible
            tangent = eye - own.flexible @ force.by_stretch
            step = np.linalg.solve(tangent, left[..., None])[..., 0]
            s = s - step
            if np.abs(step).max() <= 1e-3 * self.tolerance * np.abs(s).max():
                break
            before, force = force, excess(s, still)
            if (before.by_stretch == force.by_stretch).all():  # straight: it has arrived
                break
        if own.drags:
            force = excess(s, v)
        return s, v, force.value + given + slope @ own.drag

    def _turned(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Orders (T, o) of the excitation, and their rates."""
        turn = np.exp(self.angle(t)[:, None] * self._orders)
        return turn, self.speed(t)[:, None] * self._orders * turn

    def _grown(self, t: np.ndarray) -> np.ndarray:
        """(T, 1) what forces of unbalance are multiplied by."""
        return self.remainder.growth(self.speed(t))[:, None]

    def _straight(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Stiffness, damper (m, m) and offset (m,) of all laws, continued beyond their kinks."""
        beyond, own = tuple(self._beyond), self.remainder
        if beyond not in self._pieces:
            # anywhere but at an edge, where a law is on no side
            at = 2 * max((abs(edge) for law, _ in own.laws for edge in law.edges), default=0.0)
            far = np.full((1, own.rows), at or 1.0)
            excess = continued(own, beyond, far, 0 * far, None, None)
            stiffness = own.stiffness - excess.by_stretch[0]
            offset = (far @ (own.stiffness - stiffness) - excess.value)[0]
            self._pieces[beyond] = stiffness, own.damper - excess.by_rate[0], offset
        return self._pieces[beyond]

    @cached_property
    def _table(self) -> tuple[np.ndarray, np.ndarray, list[int]]:
        """Orders, all that goes round with them side by side, and where each of it ends: transmission
        errors, their rates at 1 rad/s, what laws vary by, forces on the other modes and on these.
        """
        own = self.remainder
        count = max(len(own.error), len(own.cycle))
        orders = 1j * np.arange(1, count + 1)
        parts = [own.error, self._orders[:, None] * own.error, own.cycle, own.gives, own.push]
        whole = [np.vstack([one, np.zeros((count - len(one), one.shape[1]))]) for one in parts]
        return orders, np.hstack(whole), np.cumsum([one.shape[1] for one in whole]).tolist()

    def _straight_slope(self, t: float, y: np.ndarray) -> np.ndarray:
        """The same as :meth:`_slope` where laws are straight and nothing but their size varies."""
        own, r = self.remainder, len(self.remainder.omega)
        angle, speed = self.angle(t), self.speed(t)
        orders, table, (a, b, c, d, _) = self._table
        around = (np.exp(angle * orders) @ table).real
        e, rate, factor = around[:a], speed * around[a:b], 1 + around[b:c]
        stiffness, damper, offset = self._straight()
        offset = factor * offset
        more, given = own.stiffness - factor[:, None] * stiffness, own.stiffness @ e
        s = own.seen @ (y[:r] / own.omega) + own.mean - e
        if self._soft:
            s += own.flexible @ (given - offset) + own.growth(speed) * around[c:d]
            left = self._eye - own.flexible @ more
            s = s / left[0] if len(s) == 1 else np.linalg.solve(left, s)
        push = more @ s - offset + given + own.drag @ rate
        if own.drags:
            push += (own.damper - factor[:, None] * damper) @ (own.seen @ y[r:] - rate)
        out = own.state @ y
        out[r:] += push @ own.seen + own.growth(speed) * around[d:]
        return out

    def _slope(self, t: float, y: np.ndarray) -> np.ndarray:
        own, at = self.remainder, np.array([t])
        out = own.state @ y
        push = self._seen(at, y[None], self._beyond)[2] @ own.seen
        if own.push.any():
            push = push + self._grown(at) * (self._turned(at)[0] @ own.push).real
        out[len(own.omega) :] += push[0]
        return out
