r"""Linear remainder of a system, seen from the links with a law.

With s the stretches of those links less their transmission errors e, K the system with the tangents
k and c of the laws, and f the laws,

    M q'' + C q' + K q = load + D (k e + c e') + D p,      p = k s + c s' - f(s, s').

The excess p is nothing while no link leaves the piece of the law at the operating point: the motion
is then the linear one to the last digit.  Modes up to the highest frequency asked move; those above
it give way like springs, at once and without loss, since nothing resolves them and an undamped one
would be a pole under some harmonic.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from solidgear.backlash.solver.sway import Line, Sway
from solidgear.core import SolidgearError, System
from solidgear.core.system.law import Force, Law
from solidgear.core.system.links import RowSpring
from solidgear.core.system.steady import lost_stiffness

#: how losses count: the damping ratio eta / 2 of every mode, or dampers of parts and links
KINDS = ("modal", "viscous")
#: a free motion that stretches a link by less than this share of other motions leaves it alone
STILL = 1e-9
#: share of a static flexibility that is rounding
LOOSE = 1e-7


@dataclass(frozen=True, eq=False)
class Remainder:
    """Linear remainder that links with a law move against."""

    omega: np.ndarray  #: (r,) of the modes that move, rad/s
    #: (r, r) damping in these modes, mass-normalised, rad/s, the tangents c of the laws within
    losses: np.ndarray
    shapes: np.ndarray  #: (m, r) stretch of every row of the links in each mode
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
    #: (o, m) stretch of the rows by these forces in the modes that are flexibility, m
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
        """Return whether a law varies over the cycle of the excitation."""
        return bool(self.cycle.any()) or self.sway is not None

    def rows_of(self, link: slice) -> range:
        """Return the rows of a link on each of which the law acts separately."""
        turns = self.sway is not None and link in self.sway.links
        return range(link.start, link.start + 1 if turns else link.stop)

    def line(self, angle: np.ndarray, omega: float | np.ndarray) -> Line | None:
        """Return places at which laws act at angles (T,) of the excitation; None where no line
        turns.
        """
        return None if self.sway is None else self.sway.line(np.asarray(angle), omega)

    def factor(self, angle: np.ndarray) -> np.ndarray:
        """Return the factor (T, m) of forces at angles (T,) of the excitation."""
        n = np.arange(1, len(self.cycle) + 1)
        return 1 + (np.exp(1j * np.asarray(angle)[:, None] * n) @ self.cycle).real

    def forces(
        self,
        stretch: np.ndarray,
        rate: np.ndarray,
        factor: np.ndarray | None = None,
        line: Line | None = None,
    ) -> Force:
        """Return forces of all laws, from stretches and rates (T, m), the factor they are
        multiplied by, and where they act.
        """
        if factor is not None:
            force = self.forces(stretch, rate, None, line)
            wide = factor[..., None]
            return Force(factor * force.value, wide * force.by_stretch, wide * force.by_rate)
        t, m = stretch.shape
        if len(self.laws) == 1 and line is None:
            return self.laws[0][0].force(stretch, rate)
        out = Force(np.zeros((t, m)), np.zeros((t, m, m)), np.zeros((t, m, m)))
        for law, rows in self.laws:
            if line is not None and rows in line.links:
                force = line.force(law, rows, stretch, rate)
            else:
                force = law.force(stretch[:, rows], rate[:, rows])
            out.value[:, rows] = force.value
            out.by_stretch[:, rows, rows], out.by_rate[:, rows, rows] = (
                force.by_stretch,
                force.by_rate,
            )
        return out

    @property
    def drags(self) -> bool:
        """Return whether a force depends on a rate."""
        return any(law.drags for law, _ in self.laws)

    def excess(
        self,
        stretch: np.ndarray,
        rate: np.ndarray,
        factor: np.ndarray | None = None,
        line: Line | None = None,
    ) -> tuple[Force, bool]:
        """Return p and the tangents, as :meth:`forces`, and whether there is any force."""
        forces = self.forces(stretch, rate, factor, line)
        value = stretch @ self.stiffness - forces.value
        if self.drags:
            value = value + rate @ self.damper
        excess = Force(value, self.stiffness - forces.by_stretch, self.damper - forces.by_rate)
        return excess, bool(forces.value.any())

    @cached_property
    def state(self) -> np.ndarray:
        """Return the matrix (2r, 2r) of ``(omega q, q')``, in which energies of both kinds count
        alike.
        """
        w = np.diag(self.omega)
        return np.block([[np.zeros_like(w), w], [-w, -self.losses]])

    def generator(self, more: np.ndarray, drag: np.ndarray) -> np.ndarray:
        """Return the matrix (..., 2r, 2r) of small motions where the tangents of p over stretches
        and rates are (..., m, m).
        """
        r = len(self.omega)
        still = np.linalg.inv(np.eye(self.rows) - self.flexible @ more) @ self.shapes
        out = np.broadcast_to(self.state, (*more.shape[:-2], 2 * r, 2 * r)).copy()
        out[..., r:, :r] += self.shapes.T @ more @ still / self.omega
        out[..., r:, r:] += self.shapes.T @ drag @ still
        return out

    @cached_property
    def modes(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return poles (2r,), rad/s, their shapes (2r, 2r) in the state, what the rows (m,) push in them
        (2r, m), and stretches and rates of the rows by them (2, m, 2r).
        """
        value, right = np.linalg.eig(self.state)
        r = len(self.omega)
        inputs = np.linalg.solve(right, np.vstack([np.zeros((r, self.rows)), self.shapes.T]))
        outputs = np.stack([(self.shapes / self.omega) @ right[:r], self.shapes @ right[r:]])
        return value, right, inputs, outputs

    @cached_property
    def _poles(self) -> tuple[np.ndarray, np.ndarray]:
        """Return poles (2r,), rad/s, and residues (2r, m, m) of the receptance."""
        value, _, inputs, (out, _) = self.modes
        return value, out.T[:, :, None] * inputs[:, None, :]

    def receptance(self, omega: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the stretch under unit forces on the rows in the modes that move, (n, m, m)
        complex, m/N, at frequencies (n,), rad/s, and the derivative over them.
        """
        value, residue = self._poles
        near = 1 / (1j * np.asarray(omega, float)[:, None] - value)
        flat = residue.reshape(len(value), -1)
        shape = (len(near), self.rows, self.rows)
        return (near @ flat).reshape(shape), (-1j * near**2 @ flat).reshape(shape)

    @cached_property
    def hangs(self) -> bool:
        """Return whether only the laws hold the system: without their forces it has no rest."""
        still = self.receptance(np.zeros(1))[0][0].real + self.flexible
        free = np.eye(self.rows) - still @ self.stiffness
        return bool(np.linalg.svd(free, compute_uv=False)[-1] < LOOSE)

    @cached_property
    def _forced_residues(self) -> np.ndarray:
        """Return residues (o, 2r, m) of the stretch under the forces of every order."""
        _, right = np.linalg.eig(self.state)
        r = len(self.omega)
        inputs = np.linalg.solve(right, np.vstack([np.zeros((r, len(self.push))), self.push.T]))
        return inputs.T[:, :, None] * ((self.shapes / self.omega) @ right[:r]).T

    def growth(self, omega):
        """Return the factor of forces at a frequency, or frequencies."""
        return omega**2 if self.unbalance else 1.0 + 0.0 * omega

    def linear(self, omega: float, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the stretch of the linear system in harmonics 0 to `count` of the excitation,
        (count + 1, m) complex, and the derivative over the frequency.
        """
        out = np.zeros((count + 1, self.rows), complex)
        slope = np.zeros_like(out)
        out[0] = self.mean
        orders = slice(1, min(count, len(self.error)) + 1)
        n = np.arange(1, orders.stop)
        h, change = self.receptance(n * omega)
        e = self.error[: len(n)]
        push = e @ self.stiffness + 1j * n[:, None] * omega * (e @ self.drag)
        grow = 1j * n[:, None] * (e @ self.drag)
        out[orders] = (h @ push[..., None])[..., 0] + e @ self.stiffness @ self.flexible - e
        slope[orders] = (n[:, None, None] * change @ push[..., None] + h @ grow[..., None])[..., 0]
        if self.push.any():
            near = 1 / (1j * n[:, None] * omega - self._poles[0])
            pushed, rise = self._forced_residues[: len(n)], 2 / omega if self.unbalance else 0.0
            moved = np.einsum("nk,nkm->nm", near, pushed) + self.gives[: len(n)]
            changed = np.einsum("nk,nkm->nm", -1j * n[:, None] * near**2, pushed)
            out[orders] += self.growth(omega) * moved
            slope[orders] += self.growth(omega) * (changed + rise * moved)
        return out, slope

    def slower(self, periods: int) -> Remainder:
        """Return the same remainder in a cycle of so many periods of the excitation."""

        def at_multiples(coefficients: np.ndarray) -> np.ndarray:
            out = np.zeros((periods * len(coefficients), coefficients.shape[1]), complex)
            out[periods - 1 :: periods] = coefficients
            return out

        slow = self._with_orders(at_multiples)
        grown = periods**2 if self.unbalance else 1
        return replace(slow, push=grown * slow.push, gives=grown * slow.gives)

    def scaled(self, share: float) -> Remainder:
        """Return the same remainder under a share of the excitation and of the variation of the
        laws.
        """
        return self._with_orders(lambda coefficients: share * coefficients)

    def _with_orders(self, change: Callable[[np.ndarray], np.ndarray]) -> Remainder:
        error, cycle, push, gives = map(change, (self.error, self.cycle, self.push, self.gives))
        sway = self.sway and replace(self.sway, orders=change(self.sway.orders))
        return replace(self, error=error, cycle=cycle, push=push, gives=gives, sway=sway)


def remainder(
    system: System,
    *,
    loss: Mapping[str, float] | None = None,  # factors of parts and links, beside dampers of laws
    kind: str = "modal",
    matched_hz: float = 0.0,  # at which viscous dampers have these loss factors
    load: np.ndarray | None = None,  # (N,) constant, such as torques of both ends of a train
    errors: Mapping[str, Sequence[complex]] | None = None,  # m: ``Re(e exp(i n w t))``
    cycles: Mapping[str, Sequence[complex]] | None = None,
    sways: Mapping[str, tuple[RowSpring, np.ndarray]] | None = None,
    forces: Sequence[np.ndarray] = (),  # (N,) complex on the coordinates
    unbalance: bool = False,
    highest_hz: float = np.inf,  # modes above it are flexibility
) -> Remainder:
    """Build the remainder of a system whose links with a law are
    :class:`solidgear.core.system.RowSpring`.

    Losses are of one of `KINDS`. Transmission errors of links, how links vary (`cycles`: forces are
    multiplied by ``1 + sum Re(c exp(i n w t))``), how the line of action of links of one row turns
    (`sways`: further rows between the same ports and (o, r) shares of each) and forces are given by
    orders from 1. With `unbalance` forces are at 1 rad/s and grow with the square of the frequency.
    Refused are a system without a link with a law, one whose free motion stretches such a link, and
    one without a mode below the highest frequency.
    """
    if kind not in KINDS:
        raise SolidgearError(f"losses of the kind {kind!r} are unknown; use {', '.join(KINDS)}")
    if kind == "viscous" and not matched_hz > 0:
        raise SolidgearError(
            "viscous losses need the frequency, in Hz, at which their loss factors hold"
        )
    sways = dict(sways or {})
    laws: list[tuple[Law, slice]] = []
    links: list[tuple[str, RowSpring]] = []
    stretch = [np.zeros((0, system.size))]
    for name, link in system.links.items():
        if isinstance(link, RowSpring) and link.law is not None:
            turned = [link, sways[name][0]] if name in sways else [link]
            rows = np.vstack(
                [row_link.stretch(*map(system.port, link.ends)) for row_link in turned]
            )
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
    static = system.static(load)
    loss = dict(loss or {})
    orders = max([1, len(forces), *(len(e) for e in (errors or {}).values())])
    error = np.zeros((orders, len(rows)), complex)
    cycle = np.zeros((max([1, *(len(c) for c in (cycles or {}).values())]), len(rows)), complex)
    sway = np.zeros((max([1, *(len(c) for _, c in sways.values())]), len(rows)), complex)
    turning: tuple[slice, ...] = ()
    for (name, link), (law, place) in zip(links, laws):
        k = link.stiffness
        eye = np.eye(place.stop - place.start)
        if name in sways:
            shares = sways[name][1]
            sway[: len(shares), place.start + 1 : place.stop] = shares
            turning = (*turning, place)
            eye[1:] = 0.0
        stiffness[place, place] = k * eye
        carried = float(k * (rows[place] @ static)[0])
        damper[place, place] = law.damping(carried) * eye
        if kind == "viscous":
            drag[place, place] = loss.get(name, 0.0) * k / (2 * np.pi * matched_hz) * eye
        for out, by_link in ((error, errors or {}), (cycle, cycles or {})):
            coefficients = np.asarray(by_link.get(name, ()), complex)
            out[: len(coefficients), place] = coefficients[:, None]
        error[:, place] *= np.diag(eye)
    frequencies, shapes = system.elastic
    stretch_shapes = rows @ shapes
    free = np.abs(rows @ system.free).max(initial=0.0)
    if free > STILL * np.abs(stretch_shapes).max():
        raise SolidgearError("a link with a law is stretched by a free motion; hold the system")
    lost_energy = lost_stiffness(system, loss)
    moving = frequencies <= 2 * np.pi * highest_hz
    if not moving.any():
        raise SolidgearError(
            f"no mode of the system lies below {highest_hz:g} Hz; the lowest is at "
            f"{frequencies[0] / (2 * np.pi):.4g} Hz"
        )
    omega, moving_shapes = frequencies[moving], stretch_shapes[:, moving]
    if kind == "modal":
        losses = np.diag(np.diag(lost_energy)[moving] / omega)
    else:
        losses = lost_energy[np.ix_(moving, moving)] / (2 * np.pi * matched_hz)
    soft = stretch_shapes[:, ~moving] / frequencies[~moving]
    pushed = np.zeros((orders, len(frequencies)), complex)
    for row, force in zip(pushed, forces):
        row[:] = np.asarray(force) @ shapes
    return Remainder(
        omega=omega,
        losses=losses + moving_shapes.T @ damper @ moving_shapes,
        shapes=moving_shapes,
        flexible=soft @ soft.T,
        mean=rows @ static,
        stiffness=stiffness,
        damper=damper,
        drag=drag + damper,
        laws=tuple(laws),
        error=error,
        cycle=cycle,
        push=pushed[:, moving],
        gives=pushed[:, ~moving] / frequencies[~moving] @ soft.T,
        unbalance=unbalance,
        sway=Sway(sway, turning) if turning else None,
    )
