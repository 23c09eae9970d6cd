r"""Bodies in contact, step by step, many designs at once.

With coordinates q about the uniform turning, rows G of contacts that turn with the carrier's angle
``a = W t`` against what stands still, and cycles y of teeth in mesh,

    M q'' + C q' + K q + G(a)' F = f(a),        F = y(a) k law(s, s'),        s = G(a) q - e(a).

Steps are those of Newmark with constant mean acceleration, which adds no damping and none of whose
stiff modes grow.  A step is solved for the contact forces alone, by Newton's method.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, fields

import numpy as np

from solidgear.core.errors import SolidgearError
from solidgear.core.machine.threads import pinned
from solidgear.core.system.law import Gap

#: step times the fastest mode of the contacts, rad: a sixth of its period
COARSE = 1.0
#: of Newton's method: steps, and change relative to the largest force
NEWTON, ARRIVED = 40, 1e-9
#: at rest: halvings of a step that leads up, and share of a mean tangent that teeth apart have
HALVINGS, LEAST = 8, 0.02


@dataclass(frozen=True, eq=False)
class Bodies:
    """So many designs b of n coordinates and m contacts.

    Attributes
    ----------
    mass, damping, stiffness : (b, n, n) ndarray
    rows : (3, b, m, n) ndarray
        That stand still, and those that go with cosine and sine of the carrier's angle.
    load : (3, b, n) ndarray
        Likewise.
    law : Gap
        Of a contact of unit stiffness; `drive` (b, m) multiplies it.
    order, cycle : (b, m) and (o, b, m) complex ndarray
        Mesh cycles in a turn, and how teeth in contact vary by orders of them around one.
    error_order, error : (b, m) and (b, m) complex ndarray
        Times a transmission error comes in a turn, and how large it is, m.
    speed : (b,) ndarray
        Of the carrier, rad/s.
    mean : (b, m) ndarray
        Force of every contact by statics, N.
    """

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    rows: np.ndarray
    load: np.ndarray
    law: Gap
    drive: np.ndarray
    order: np.ndarray
    cycle: np.ndarray
    error_order: np.ndarray
    error: np.ndarray
    speed: np.ndarray
    mean: np.ndarray

    def tangents(self) -> np.ndarray:
        """(b, m) stiffness of all contacts under their mean forces, N/m."""
        depth = (self.mean / self.drive) ** (1 / self.law.exponent)
        return self.law.exponent * self.mean / depth

    def fastest(self) -> np.ndarray:
        """(b,) highest natural frequency on these tangents, rad/s."""
        g = self.rows[0] + self.rows[1]
        held = self.stiffness + g.transpose(0, 2, 1) @ (self.tangents()[..., None] * g)
        return np.sqrt(np.linalg.eigvals(np.linalg.solve(self.mass, held)).real.max(axis=1))

    def turned(self, parts: np.ndarray, angle: float) -> tuple[np.ndarray, np.ndarray]:
        """Rows or loads at an angle of the carrier, and their derivative over it."""
        c, s = np.cos(angle), np.sin(angle)
        return parts[0] + c * parts[1] + s * parts[2], c * parts[2] - s * parts[1]

    def teeth(self, angle: float) -> tuple[np.ndarray, np.ndarray]:
        """(b, m) what contacts are multiplied by, and its derivative over the angle."""
        n = 1j * np.arange(1, len(self.cycle) + 1)[:, None, None] * self.order
        turned = self.cycle * np.exp(n * angle)
        return 1 + turned.sum(axis=0).real, (n * turned).sum(axis=0).real

    def off(self, angle: float) -> tuple[np.ndarray, np.ndarray]:
        """(b, m) transmission errors, and their derivative over the angle."""
        turned = self.error * np.exp(1j * self.error_order * angle)
        return turned.real, (1j * self.error_order * turned).real

    def forces(self, scale: np.ndarray, s: np.ndarray, v: np.ndarray):
        """(b, m) forces and both tangents."""
        own = self.law.force(s, v)
        diagonal = (np.diagonal(one, axis1=1, axis2=2) for one in own[1:])
        return scale * own.value, *(scale * one for one in diagonal)

    def pressed(self, drive: np.ndarray, s: np.ndarray) -> np.ndarray:
        """(b, m) energy of all contacts, J."""
        power = self.law.exponent + 1
        return drive * np.maximum(np.abs(s) - self.law.half_gap, 0.0) ** power / power

    def rest(self) -> np.ndarray:
        """(b, n) equilibrium at the beginning, teeth in their mean contact: least energy."""
        g, _ = self.turned(self.rows, 0.0)
        load, _ = self.turned(self.load, 0.0)
        across = g.transpose(0, 2, 1)
        depth = self.law.half_gap + (self.mean / self.drive) ** (1 / self.law.exponent)
        q = _times(np.linalg.pinv(g), depth)
        nothing = np.zeros_like(depth)

        def energy(q):
            bent = (q * (_times(self.stiffness, q) / 2 - load)).sum(axis=1)
            return bent + self.pressed(self.drive, _times(g, q)).sum(axis=1)

        for _ in range(NEWTON):
            force, tangent, _ = self.forces(self.drive, _times(g, q), nothing)
            # teeth apart take some of their mean tangent along, so that no motion is free on the way
            tangent = np.maximum(tangent, LEAST * self.tangents())
            left = load - _times(self.stiffness, q) - _times(across, force)
            step = _solved(self.stiffness + across @ (tangent[..., None] * g), left)
            if np.abs(step).max() <= ARRIVED * np.abs(q).max():
                return q + step
            before = energy(q)
            for _ in range(HALVINGS):
                worse = energy(q + step) > before
                step = np.where(worse[:, None], step / 2, step)
            q = q + step
        raise SolidgearError("the bodies find no rest on their contacts")


def _times(matrix: np.ndarray, vector: np.ndarray) -> np.ndarray:
    return (matrix @ vector[..., None])[..., 0]


def _solved(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    return np.linalg.solve(matrix, right[..., None])[..., 0]


def together(some: list[Bodies]) -> Bodies:
    """Designs of one size as one; of one law."""
    out = {"law": some[0].law}
    for one in fields(Bodies):
        if one.name != "law":
            axis = 1 if one.name in ("rows", "load", "cycle") else 0
            out[one.name] = np.concatenate([getattr(own, one.name) for own in some], axis)
    return Bodies(**out)


@dataclass(frozen=True, eq=False)
class Motion:
    """Some turns of the carrier, at equal angles.

    Attributes
    ----------
    force : (t, b, m) ndarray
        Of all contacts, N.
    place : (t, b, n) ndarray
    turns : int
    energy : dict of str to (b,) ndarray
        Of the whole run beside the uniform turning, J: ``supplied`` by loads, errors, turning
        directions and teeth that come and go, ``stored`` at its end beyond its beginning, ``lost`` in
        dampers, ``passed`` back and forth.
    """

    force: np.ndarray
    place: np.ndarray
    turns: int
    energy: dict[str, np.ndarray] = field(default_factory=dict)

    @property
    def unbalanced(self) -> np.ndarray:
        """(b,) energy that is neither stored nor lost, of what was passed back and forth."""
        own = self.energy
        return (own["supplied"] - own["stored"] - own["lost"]) / own["passed"]

    def line(self, order: int, values: np.ndarray | None = None) -> np.ndarray:
        """Amplitude at a multiple of the carrier's frequency, of the forces or of others."""
        values = self.force if values is None else values
        wave = np.exp(-2j * np.pi * self.turns * order * np.arange(len(values)) / len(values))
        return 2 * np.abs(np.tensordot(wave, values, (0, 0))) / len(values)


@pinned
def run(
    bodies: Bodies,
    steps: int,
    turns: int = 1,
    settling: int = 2,
    every: int = 8,
    progress: Callable[[float], None] = lambda share: None,
) -> Motion:
    """Motion over turns of the carrier, from rest.

    Parameters
    ----------
    steps : int
        A turn.
    settling : int
        Turns before those that are kept.
    every : int
        Steps from one kept instant to the next.

    Raises
    ------
    SolidgearError
        For a step that is too coarse for the contacts.
    """
    h = 2 * np.pi / bodies.speed / steps
    fine = COARSE / bodies.fastest()
    worst = int(np.argmax(h / fine))
    if h[worst] > fine[worst]:
        raise SolidgearError(
            f"a step of {1e6 * h[worst]:.3g} us is too coarse for the contact, whose fastest mode "
            f"takes {1e6 * 2 * np.pi * fine[worst] / COARSE:.3g} us; "
            f"take {int(np.ceil(steps * h[worst] / fine[worst]))} steps a turn or more"
        )
    stepper = _Stepper(bodies, h[:, None])
    kept_force, kept_place = [], []
    for k in range((settling + turns) * steps):
        if k >= settling * steps and k % every == 0:
            kept_force.append(stepper.force)
            kept_place.append(stepper.q)
        stepper.step(2 * np.pi * (k + 1) / steps)
        if k % steps == 0:
            progress(k / ((settling + turns) * steps))
    return Motion(np.array(kept_force), np.array(kept_place), turns, stepper.energy())


class _Stepper:
    def __init__(self, bodies: Bodies, h: np.ndarray):
        self.own, self.h = bodies, h
        wide = h[..., None]
        self.solid = np.linalg.inv(
            bodies.mass + wide / 2 * bodies.damping + wide**2 / 4 * bodies.stiffness
        )
        self.gives = np.array([self.solid @ rows.transpose(0, 2, 1) for rows in bodies.rows])
        self.q = bodies.rest()
        self.v = np.zeros_like(self.q)
        self.seen = self._seen(0.0)
        s, rate = self._stretch(self.q, self.v)
        self.force = bodies.forces(self.seen["scale"], s, rate)[0]
        g, load = self.seen["rows"][0], self.seen["load"]
        left = load - _times(bodies.stiffness, self.q) - _times(g.transpose(0, 2, 1), self.force)
        self.a = _solved(bodies.mass, left)
        self.sums = dict.fromkeys(("supplied", "lost", "passed"), 0.0)
        self.power = self._power(s, rate)
        self.first = self._stored(s)

    def _seen(self, angle: float) -> dict:
        own = self.own
        w = own.speed[:, None]
        rows, slope = own.turned(own.rows, angle)
        teeth, change = own.teeth(angle)
        error, moves = own.off(angle)
        return {
            "rows": (rows, w[..., None] * slope),
            "load": own.turned(own.load, angle)[0],
            "scale": own.drive * teeth,
            "change": own.drive * change * w,
            "error": (error, w * moves),
        }

    def _stretch(self, q, v):
        (rows, slope), (error, moves) = self.seen["rows"], self.seen["error"]
        return _times(rows, q) - error, _times(rows, v) + _times(slope, q) - moves

    def _power(self, s, rate) -> dict[str, np.ndarray]:
        """Supplied, lost and passed, W."""
        own, (_, slope), (_, moves) = self.own, self.seen["rows"], self.seen["error"]
        side = np.sign(s)
        depth = np.maximum(np.abs(s) - own.law.half_gap, 0.0)
        elastic = side * self.seen["scale"] * depth**own.law.exponent
        by_teeth = own.pressed(self.seen["change"], s)
        driven = self.force * (_times(slope, self.q) - moves) + by_teeth
        pressed = elastic * rate
        rubbed = self.force * rate - pressed
        slowed = (self.v * _times(own.damping, self.v)).sum(axis=1)
        return {
            "supplied": driven.sum(axis=1) + (self.seen["load"] * self.v).sum(axis=1),
            "lost": slowed + rubbed.sum(axis=1),
            "passed": np.abs(pressed).sum(axis=1),
        }

    def _stored(self, s) -> np.ndarray:
        own = self.own
        pressed = own.pressed(self.seen["scale"], s)
        moving = (self.v * _times(own.mass, self.v)).sum(axis=1) / 2
        bent = (self.q * _times(own.stiffness, self.q)).sum(axis=1) / 2
        return pressed.sum(axis=1) + moving + bent

    def step(self, angle: float) -> None:
        """One step, to an angle of the carrier."""
        own, h = self.own, self.h
        self.seen = self._seen(angle)
        rows, slope = self.seen["rows"]
        gives = self.own.turned(self.gives, angle)[0]
        q = self.q + h * self.v + h**2 / 4 * self.a
        v = self.v + h / 2 * self.a
        free = _times(
            self.solid, self.seen["load"] - _times(own.damping, v) - _times(own.stiffness, q)
        )
        q_free, v_free = q + h**2 / 4 * free, v + h / 2 * free
        s_free, rate_free = self._stretch(q_free, v_free)
        wide = h[..., None]
        push = rows @ gives
        by = wide**2 / 4 * push
        by_rate = wide / 2 * push + wide**2 / 4 * (slope @ gives)
        force = self._contacts(s_free, rate_free, by, by_rate)
        self.force = force
        self.a = free - _times(gives, force)
        self.q, self.v = q + h**2 / 4 * self.a, v + h / 2 * self.a
        s, rate = self._stretch(self.q, self.v)
        self.last = s
        before, self.power = self.power, self._power(s, rate)
        for name, sums in self.sums.items():
            self.sums[name] = sums + h[:, 0] / 2 * (before[name] + self.power[name])

    def _contacts(self, s, rate, by, by_rate) -> np.ndarray:
        force = self.force
        eye = np.eye(force.shape[1])
        least = ARRIVED * np.abs(self.own.mean).max()
        for _ in range(NEWTON):
            told, stiff, drag = self.own.forces(
                self.seen["scale"], s - _times(by, force), rate - _times(by_rate, force)
            )
            left = told - force
            if np.abs(left).max() <= least:
                return told
            jacobian = eye + stiff[..., None] * by + drag[..., None] * by_rate
            force = force + _solved(jacobian, left)
        raise SolidgearError(
            f"contact forces of a step of {1e6 * self.h.max():.3g} us are not found; "
            "the step is too coarse for the contact, take a finer one"
        )

    def energy(self) -> dict[str, np.ndarray]:
        return {**self.sums, "stored": self._stored(self.last) - self.first}
