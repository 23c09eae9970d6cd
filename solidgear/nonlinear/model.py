r"""The linear remainder of a system, seen from its links with a law.

With s the stretches of those links less their transmission errors e, K the system with the tangents k
and c of its laws, and f the laws,

    M q'' + C q' + K q = load + D (k e + c e') + D p,      p = k s + c s' - f(s, s').

The excess p is nothing while no link leaves the piece of its law at the operating point: the motion
is then the linear one to the last digit.  Modes up to the highest frequency asked move; those above
it give way like springs, at once and without loss, since nothing resolves them and an undamped one
would be a pole under some harmonic.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.nonlinear.sway import Line, Sway
from solidgear.system.law import Force, Law
from solidgear.system.links import RowSpring
from solidgear.system.steady import lost_stiffness
from solidgear.system.system import System

#: how losses count: the damping ratio eta / 2 of every mode, or dampers of parts and links
KINDS = ("modal", "viscous")
#: a free motion that stretches a link by less than this of what others do leaves it alone
STILL = 1e-9
#: share of a static flexibility that is rounding
LOOSE = 1e-7


@dataclass(frozen=True, eq=False)
class Remainder:
    """Linear remainder that links with a law move against."""

    omega: np.ndarray  #: (r,) of the modes that move, rad/s
    #: (r, r) damping in these modes, mass-normalised, rad/s, the tangents c of the laws within
    losses: np.ndarray
    seen: np.ndarray  #: (m, r) stretch of every row of the links in each mode
    flexible: np.ndarray  #: (m, m) flexibility of the other modes between these rows, m/N
    mean: np.ndarray  #: (m,) stretch of the linear system under its constant load, m
    #: stiffness, damper: (m, m) tangents of the laws, N/m and N s/m
    stiffness: np.ndarray
    damper: np.ndarray
    drag: np.ndarray  #: (m, m) damping that acts on the rate of the transmission error, N s/m
    laws: tuple[tuple[Law, slice], ...]  #: and their rows
    #: (o, m) transmission error e of each row, by orders from 1, m
    error: np.ndarray = field(repr=False)
    #: (o, m) how the force of each row varies with the angle of the excitation: one, and these
    #: orders
    cycle: np.ndarray = field(repr=False)
    #: (o, r) forces on the modes by orders from 1, mass-normalised
    push: np.ndarray = field(repr=False)
    #: (o, m) what they stretch the rows by in the modes that are flexibility, m
    gives: np.ndarray = field(repr=False)
    #: these forces are those at 1 rad/s and grow with the square of the frequency
    unbalance: bool = False
    #: how the line of action of links turns over the cycle
    sway: Sway | None = field(repr=False, default=None)

    @property
    def rows(self) -> int:
        """Number m of stretches."""
        return len(self.mean)

    @property
    def varies(self) -> bool:
        """True if a law varies over the cycle of the excitation."""
        return bool(self.cycle.any()) or self.sway is not None

    def rows_of(self, at: slice) -> range:
        """Rows of a link on each of which its law acts by itself."""
        turns = self.sway is not None and at in self.sway.links
        return range(at.start, at.start + 1 if turns else at.stop)

    def line(self, angle: np.ndarray, omega: float | np.ndarray) -> Line | None:
        """Places at which laws act at angles (T,) of the excitation; None where no line turns."""
        return None if self.sway is None else self.sway.line(np.asarray(angle), omega)

    def factor(self, angle: np.ndarray) -> np.ndarray:
        """(T, m) what forces are multiplied by at angles (T,) of the excitation."""
        n = np.arange(1, len(self.cycle) + 1)
        return 1 + (np.exp(1j * np.asarray(angle)[:, None] * n) @ self.cycle).real

    def forces(
        self,
        stretch: np.ndarray,
        rate: np.ndarray,
        factor: np.ndarray | None = None,
        line: Line | None = None,
    ) -> Force:
        """Forces of all laws, from stretches and rates (T, m), what they are multiplied by, and
        where they act.
        """
        if factor is not None:
            own = self.forces(stretch, rate, None, line)
            each = factor[..., None]
            return Force(factor * own.value, each * own.by_stretch, each * own.by_rate)
        t, m = stretch.shape
        if len(self.laws) == 1 and line is None:
            return self.laws[0][0].force(stretch, rate)
        out = Force(np.zeros((t, m)), np.zeros((t, m, m)), np.zeros((t, m, m)))
        for law, at in self.laws:
            if line is not None and at in line.links:
                own = line.force(law, at, stretch, rate)
            else:
                own = law.force(stretch[:, at], rate[:, at])
            out.value[:, at] = own.value
            out.by_stretch[:, at, at], out.by_rate[:, at, at] = own.by_stretch, own.by_rate
        return out

    @property
    def drags(self) -> bool:
        """True if a force depends on a rate."""
        return any(law.drags for law, _ in self.laws)

    def excess(
        self,
        stretch: np.ndarray,
        rate: np.ndarray,
        factor: np.ndarray | None = None,
        line: Line | None = None,
    ) -> tuple[Force, bool]:
        """p and its tangents, as :meth:`forces`, and whether there is any force."""
        own = self.forces(stretch, rate, factor, line)
        value = stretch @ self.stiffness - own.value
        if self.drags:
            value = value + rate @ self.damper
        found = Force(value, self.stiffness - own.by_stretch, self.damper - own.by_rate)
        return found, bool(own.value.any())

    @cached_property
    def state(self) -> np.ndarray:
        """(2r, 2r) matrix of ``(omega q, q')``: energies of both kinds alike."""
        w = np.diag(self.omega)
        return np.block([[np.zeros_like(w), w], [-w, -self.losses]])

    def generator(self, more: np.ndarray, drag: np.ndarray) -> np.ndarray:
        """(..., 2r, 2r) matrix of small motions where the tangents of p are (..., m, m), over the
        stretches and over their rates.
        """
        r = len(self.omega)
        still = np.linalg.inv(np.eye(self.rows) - self.flexible @ more) @ self.seen
        out = np.broadcast_to(self.state, (*more.shape[:-2], 2 * r, 2 * r)).copy()
        out[..., r:, :r] += self.seen.T @ more @ still / self.omega
        out[..., r:, r:] += self.seen.T @ drag @ still
        return out

    @cached_property
    def _poles(self) -> tuple[np.ndarray, np.ndarray]:
        """Poles (2r,), rad/s, and residues (2r, m, m) of the receptance."""
        value, right = np.linalg.eig(self.state)
        r = len(self.omega)
        into = np.linalg.solve(right, np.vstack([np.zeros((r, self.rows)), self.seen.T]))
        out = (self.seen / self.omega) @ right[:r]
        return value, out.T[:, :, None] * into[:, None, :]

    def receptance(self, omega: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Stretch under unit forces on the rows in the modes that move, and its derivative.

        Parameters
        ----------
        omega : (n,) ndarray
            rad/s.

        Returns
        -------
        (n, m, m) complex ndarray, (n, m, m) complex ndarray
            m/N, and m s/(N rad).
        """
        value, residue = self._poles
        near = 1 / (1j * np.asarray(omega, float)[:, None] - value)
        flat = residue.reshape(len(value), -1)
        shape = (len(near), self.rows, self.rows)
        return (near @ flat).reshape(shape), (-1j * near**2 @ flat).reshape(shape)

    @cached_property
    def hangs(self) -> bool:
        """True if nothing but its laws holds it: without any force of theirs it has no rest."""
        still = self.receptance(np.zeros(1))[0][0].real + self.flexible
        free = np.eye(self.rows) - still @ self.stiffness
        return bool(np.linalg.svd(free, compute_uv=False)[-1] < LOOSE)

    @cached_property
    def _pushed(self) -> np.ndarray:
        """(o, 2r, m) residues of the stretch under the forces of every order."""
        _, right = np.linalg.eig(self.state)
        r = len(self.omega)
        into = np.linalg.solve(right, np.vstack([np.zeros((r, len(self.push))), self.push.T]))
        return into.T[:, :, None] * ((self.seen / self.omega) @ right[:r]).T

    def growth(self, omega):
        """Factor of forces at a frequency, or frequencies."""
        return omega**2 if self.unbalance else 1.0 + 0.0 * omega

    def linear(self, omega: float, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Stretch of the linear system in harmonics 0 to `count` of the excitation, (count + 1, m)
        complex, and its derivative over the frequency.
        """
        out = np.zeros((count + 1, self.rows), complex)
        slope = np.zeros_like(out)
        out[0] = self.mean
        here = slice(1, min(count, len(self.error)) + 1)
        n = np.arange(1, here.stop)
        h, by = self.receptance(n * omega)
        e = self.error[: len(n)]
        push = e @ self.stiffness + 1j * n[:, None] * omega * (e @ self.drag)
        grow = 1j * n[:, None] * (e @ self.drag)
        out[here] = (h @ push[..., None])[..., 0] + e @ self.stiffness @ self.flexible - e
        slope[here] = (n[:, None, None] * by @ push[..., None] + h @ grow[..., None])[..., 0]
        if self.push.any():
            near = 1 / (1j * n[:, None] * omega - self._poles[0])
            pushed, rise = self._pushed[: len(n)], 2 / omega if self.unbalance else 0.0
            moved = np.einsum("nk,nkm->nm", near, pushed) + self.gives[: len(n)]
            changed = np.einsum("nk,nkm->nm", -1j * n[:, None] * near**2, pushed)
            out[here] += self.growth(omega) * moved
            slope[here] += self.growth(omega) * (changed + rise * moved)
        return out, slope

    def slower(self, periods: int) -> Remainder:
        """The same told by a cycle of so many periods of its excitation."""

        def at_multiples(own: np.ndarray) -> np.ndarray:
            out = np.zeros((periods * len(own), own.shape[1]), complex)
            out[periods - 1 :: periods] = own
            return out

        slow = self._with_orders(at_multiples)
        grown = periods**2 if self.unbalance else 1
        return replace(slow, push=grown * slow.push, gives=grown * slow.gives)

    def scaled(self, share: float) -> Remainder:
        """The same under a share of its excitation and of what varies."""
        return self._with_orders(lambda own: share * own)

    def _with_orders(self, other: Callable[[np.ndarray], np.ndarray]) -> Remainder:
        error, cycle, push, gives = map(other, (self.error, self.cycle, self.push, self.gives))
        sway = self.sway and replace(self.sway, orders=other(self.sway.orders))
        return replace(self, error=error, cycle=cycle, push=push, gives=gives, sway=sway)


def remainder(
    system: System,
    *,
    loss: Mapping[str, float] | None = None,
    kind: str = "modal",
    matched_hz: float = 0.0,
    load: np.ndarray | None = None,
    errors: Mapping[str, Sequence[complex]] | None = None,
    cycles: Mapping[str, Sequence[complex]] | None = None,
    sways: Mapping[str, tuple[RowSpring, np.ndarray]] | None = None,
    forces: Sequence[np.ndarray] = (),
    unbalance: bool = False,
    highest_hz: float = np.inf,
) -> Remainder:
    """The remainder of a system whose links with a law are :class:`solidgear.system.RowSpring`.

    Parameters
    ----------
    loss : mapping of str to float
        Loss factors of parts and links, beside the dampers of laws.
    kind : {'modal', 'viscous'}
        Damping ratio ``eta / 2`` of each mode of the linear system, or dampers that have the loss
        factor at one frequency.
    matched_hz : float
        That frequency.
    load : (N,) ndarray, optional
        Constant, such as torques of both ends of a train.
    errors : mapping of str to sequence of complex
        Transmission error of links by orders from 1, m: ``Re(e exp(i n w t))``.
    cycles : mapping of str to sequence of complex
        How links vary by orders from 1: forces are multiplied by ``1 + sum Re(c exp(i n w t))``.
    sways : mapping of str to (RowSpring, (o, r) complex ndarray)
        How the line of action of links of one row turns: further rows between the same ports, and
        how much of each by orders from 1, ``sum Re(c exp(i n w t))``.
    forces : sequence of (N,) complex array_like
        On the coordinates by orders from 1, such as :meth:`solidgear.system.System.load` gives.
    unbalance : bool
        Those are at 1 rad/s and grow with the square of the frequency.
    highest_hz : float
        Modes above it are flexibility.

    Raises
    ------
    SolidgearError
        If no link has a law, a free motion stretches one, or no mode is below the highest frequency.
    """
    if kind not in KINDS:
        raise SolidgearError(f"losses of the kind {kind!r} are unknown; use {', '.join(KINDS)}")
    if kind == "viscous" and not matched_hz > 0:
        raise SolidgearError("viscous losses need the frequency, in Hz, at which they are told")
    sways = dict(sways or {})
    laws: list[tuple[Law, slice]] = []
    links: list[tuple[str, RowSpring]] = []
    stretch = [np.zeros((0, system.size))]
    for name, link in system.links.items():
        if isinstance(link, RowSpring) and link.law is not None:
            turned = [link, sways[name][0]] if name in sways else [link]
            rows = np.vstack([one.stretch(*map(system.port, link.ends)) for one in turned])
            begin = sum(map(len, stretch))
            laws.append((link.law, slice(begin, begin + len(rows))))
            links.append((name, link))
            stretch.append(rows)
    if not laws:
        raise SolidgearError("no link of this system has a law; without one it is linear")
    rows = np.vstack(stretch)
    load = np.zeros(system.size) if load is None else np.asarray(load, float)
    stiffness = np.zeros((len(rows),) * 2)
    damper, drag = np.zeros_like(stiffness), np.zeros_like(stiffness)
    held = system.static(load)
    loss = dict(loss or {})
    orders = max([1, len(forces), *(len(e) for e in (errors or {}).values())])
    error = np.zeros((orders, len(rows)), complex)
    cycle = np.zeros((max([1, *(len(c) for c in (cycles or {}).values())]), len(rows)), complex)
    sway = np.zeros((max([1, *(len(c) for _, c in sways.values())]), len(rows)), complex)
    turning: tuple[slice, ...] = ()
    for (name, link), (law, at) in zip(links, laws):
        k = link.stiffness
        eye = np.eye(at.stop - at.start)
        if name in sways:
            shares = sways[name][1]
            sway[: len(shares), at.start + 1 : at.stop] = shares
            turning = (*turning, at)
            eye[1:] = 0.0
        stiffness[at, at] = k * eye
        carried = float(k * (rows[at] @ held)[0])
        damper[at, at] = law.damping(carried) * eye
        if kind == "viscous":
            drag[at, at] = loss.get(name, 0.0) * k / (2 * np.pi * matched_hz) * eye
        for out, given in ((error, errors or {}), (cycle, cycles or {})):
            told = np.asarray(given.get(name, ()), complex)
            out[: len(told), at] = told[:, None]
        error[:, at] *= np.diag(eye)
    whole, shapes = system.elastic
    seen = rows @ shapes
    free = np.abs(rows @ system.free).max(initial=0.0)
    if free > STILL * np.abs(seen).max():
        raise SolidgearError("a link with a law is stretched by a free motion; hold the system")
    lost = lost_stiffness(system, loss)
    kept = whole <= 2 * np.pi * highest_hz
    if not kept.any():
        raise SolidgearError(
            f"no mode of the system lies below {highest_hz:g} Hz; the lowest is at "
            f"{whole[0] / (2 * np.pi):.4g} Hz"
        )
    omega, own = whole[kept], seen[:, kept]
    if kind == "modal":
        losses = np.diag(np.diag(lost)[kept] / omega)
    else:
        losses = lost[np.ix_(kept, kept)] / (2 * np.pi * matched_hz)
    soft = seen[:, ~kept] / whole[~kept]
    pushed = np.zeros((orders, len(whole)), complex)
    for row, force in zip(pushed, forces):
        row[:] = np.asarray(force) @ shapes
    return Remainder(
        omega,
        losses + own.T @ damper @ own,
        own,
        soft @ soft.T,
        rows @ held,
        stiffness,
        damper,
        drag + damper,
        tuple(laws),
        error,
        cycle,
        pushed[:, kept],
        pushed[:, ~kept] / whole[~kept] @ soft.T,
        unbalance,
        Sway(sway, turning) if turning else None,
    )
