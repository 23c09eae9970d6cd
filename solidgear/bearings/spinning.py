"""A row of balls at speed: centrifugal force and gyroscopic moment.

At speed a ball's two contact angles differ, and the centre finds a place between the grooves.
With o the vector from the outer groove's centre to the ball's and i from there to the inner
groove's, ``i + o = s`` (:mod:`solidgear.bearings.ball`), it is in equilibrium where

    Q_i n_i - Q_o n_o + (F_c, 0) + (2 M_g / D) (-sin a, cos a) = 0        (radial, axial)

(Jones 1960; Harris and Kotzalas, Advanced Concepts, 5th ed., ch. 3, outer raceway control: the
outer ring alone takes the gyroscopic moment).  With g = D / Dpw and the inner ring turning,

    w_m / w = (1 - g cos a) / 2,            F_c = m (Dpw / 2) w_m^2,
    tan b   = sin a / (cos a + g),
    M_g     = J w w_m tan b / (g P),        J = m D^2 / 10,
    P       = (cos a + tan b sin a) (1 / (1 + g cos a) + 1 / (1 - g cos a)).

The angle a of the ball's own motion is that of s, between the two contact angles: a ball that has
left the inner ring has no angle there.  (With both angles in these formulas a 218 at 10,000 r/min
under 17.8 kN comes out at 45.4 and 37.4 degrees instead of 45.1 and 37.7.)  For a given s the rest
is a convex problem of the ball. The tangent is implicit differentiation of this equilibrium, with
the turning of a in F_c and M_g. Inertia is no spring: the tangent is not quite symmetric.

Vectors in the plane of a ball are complex numbers here, radial + i axial: a few operations on all
balls take the place of a small matrix of each.  A contact of stiffness k along its unit normal n and
t across answers a motion v, of conjugate v*, with ``(k + t)/2 v + (k - t)/2 n^2 v*``.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np

from solidgear.bearings.ball import BallRow
from solidgear.bearings.hertz import POINT_POWER
from solidgear.bearings.row import FELT, Contacts, six
from solidgear.core import SolidgearError
from solidgear.core.body.cache import LastTwo

#: kg/m^3, bearing steel
DENSITY = 7800.0
#: of the largest force on a ball; and N, below which rounding of positions is felt
_BALANCED, _NEGLIGIBLE, _MOST = 1e-11, 1e-9, 100


class _Pressed(NamedTuple):
    """Balls between their grooves, (..., 2, n): at the inner and at the outer ring."""

    between: np.ndarray  #: vectors i and o between the centres of grooves and balls
    length: np.ndarray  #: of these vectors
    approach: np.ndarray  #: length beyond that at which ball and groove just touch
    across: np.ndarray  #: stiffnesses across the vectors, force over length
    force: np.ndarray  #: along the vectors


class _Stiffness(NamedTuple):
    """Stiffness of balls against motions in their planes."""

    mean: np.ndarray  #: (..., n) of both principal stiffnesses
    #: (..., n) half of their difference, times the square of the normal of the first
    turned: np.ndarray

    def force(self, motion: np.ndarray) -> np.ndarray:
        """Return the forces of motions (..., n)."""
        return self.mean * motion + self.turned * motion.conj()

    def motion(self, force: np.ndarray) -> np.ndarray:
        """Return the motions under forces (..., n)."""
        determinant = self.mean**2 - np.abs(self.turned) ** 2
        return (self.mean * force - self.turned * force.conj()) / determinant


@dataclass(frozen=True)
class SpinningBalls:
    """A row of balls whose inner ring turns; the outer one stands."""

    row: BallRow
    speed: float  #: rad/s
    density: float = DENSITY  #: of the balls, kg/m^3
    #: the balls in equilibrium, by motion: load and tangent of one motion are asked in turn
    _last: LastTwo[_Pressed] = field(default_factory=LastTwo, init=False, repr=False, compare=False)

    @property
    def pitch(self) -> float:
        """As of the row."""
        return self.row.pitch

    @property
    def mass(self) -> float:
        """Of a ball, kg."""
        return self.density * np.pi / 6 * self.row.diameter**3

    @cached_property
    def _constants(self) -> np.ndarray:
        """(2, 1) of the contacts at the inner and at the outer ring."""
        return np.array([[ring.constant] for ring in self.row.rings])

    @cached_property
    def _free(self) -> np.ndarray:
        """(2, 1) distances of the centres of groove and ball that just touch, m."""
        return (np.array([[self.row.inner], [self.row.outer]]) - 0.5) * self.row.diameter

    @cached_property
    def _felt(self) -> np.ndarray:
        """(n, 5) motion of the inner groove's centre at every ball."""
        radial, axial = self.row._felt
        return radial + 1j * axial

    @cached_property
    def _products(self) -> np.ndarray:
        """(4 n, 25) products of the components of these, first of the component that moves."""
        felt = self.row._felt
        return (felt[None, :, :, :, None] * felt[:, None, :, None, :]).reshape(-1, 25)

    def _inertia(self, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the forces (..., n) of inertia on balls at s, and the derivative by the angle."""
        g = self.row.diameter / self.row.pitch
        normal = _outwards(s)
        c, sin = normal.real, normal.imag
        orbit, orbit_a = (1 - g * c) / 2, g * sin / 2
        tan = sin / (c + g)
        tan_a = (1 + g * c) / (c + g) ** 2
        # P = (c + tan sin) 2 / (1 - g^2 c^2)
        below = 1 - (g * c) ** 2
        p = 2 * (c + tan * sin) / below
        p_a = 2 * (-sin + tan_a * sin + tan * c) / below - p * 2 * g**2 * c * sin / below
        heavy = self.mass * self.row.pitch / 2 * self.speed**2
        pull, pull_a = heavy * orbit**2, 2 * heavy * orbit * orbit_a
        # twice the moment over the diameter
        factor = 2 * self.mass * self.row.diameter / 10 * self.speed**2 / g
        turn = factor * orbit * tan / p
        turn_a = factor * (orbit_a * tan + orbit * tan_a) / p - turn * p_a / p
        return pull + 1j * turn * normal, pull_a + (1j * turn_a - turn) * normal

    def _pressed(self, s: np.ndarray, o: np.ndarray) -> _Pressed:
        """Return balls at o between grooves whose centres are s apart."""
        between = np.stack([s - o, o], axis=-2)
        length = np.abs(between)
        # a groove is an arc: past its centre a ball meets nothing
        approach = np.where(between.real > 0, length, 0.0) - self._free
        across = self._constants * np.maximum(approach, 0.0) ** POINT_POWER / length
        return _Pressed(between, length, approach, across, across * between)

    def _stiffness(self, balls: _Pressed, nearly: float = 0.0) -> tuple[_Stiffness, _Stiffness]:
        """Return the stiffness of the inner contacts and of both together, `nearly` metres further."""
        touching = np.where(np.abs(balls.approach) < nearly, nearly, balls.approach)
        along = POINT_POWER * self._constants * np.sqrt(np.maximum(touching, 0.0))
        half = (along - balls.across) / 2
        mean, turned = half + balls.across, half * (balls.between / balls.length) ** 2
        inner = _Stiffness(mean[..., 0, :], turned[..., 0, :])
        return inner, _Stiffness(mean.sum(axis=-2), turned.sum(axis=-2))

    def _settled(self, motion: np.ndarray) -> _Pressed:
        """Return the balls in equilibrium at motions (..., 6)."""
        radial, axial = self.row.centres(motion)
        s = radial + 1j * axial
        return self._last.on((s.shape, s.tobytes()), lambda: self._settle(s))

    def _settle(self, s: np.ndarray) -> _Pressed:
        """Return the equilibrium of the balls, from that of the motion before on."""
        inertia, _ = self._inertia(s)
        pull = np.abs(inertia)
        last = self._last.latest
        o = self._at_first(s, pull)
        if last is not None and last.force.shape[:-2] == s.shape[:-1]:
            # the outer groove goes on pressing, unless the motion is far away
            went_on = last.between[..., 1, :]
            misses = [np.abs(self._miss(self._pressed(s, at), inertia)) for at in (went_on, o)]
            o = np.where(misses[0] < misses[1], went_on, o)
        balls = self._pressed(s, o)
        nearly = 1e-4 * self.row.diameter
        for count in range(_MOST):
            miss = self._miss(balls, inertia)
            imbalance = np.abs(miss)
            reference = np.abs(balls.force[..., 1, :]) + pull
            balanced = imbalance <= _BALANCED * reference + _NEGLIGIBLE * 1e-3
            # one step at least: two near motions must differ by more than what is left unbalanced
            if count and balanced.all():
                return balls
            # a step must feel a contact that it is about to meet; less and less so
            _, both = self._stiffness(balls, nearly * 0.5**count)
            balls = self._stepped(s, balls, both.motion(miss), miss, inertia, balanced)
        if np.all(imbalance <= 1e-8 * reference + _NEGLIGIBLE):
            return balls
        raise SolidgearError(f"no equilibrium of the balls at {self.speed:.6g} rad/s")

    @staticmethod
    def _miss(balls: _Pressed, inertia: np.ndarray) -> np.ndarray:
        """Return the forces (..., n) on balls that nothing balances."""
        return balls.force[..., 0, :] - balls.force[..., 1, :] + inertia

    def _at_first(self, s: np.ndarray, pull: np.ndarray) -> np.ndarray:
        """Return vectors o with half of a static approach, and as far outwards as inertia alone
        presses.
        """
        length = np.abs(s)
        half = np.maximum(length - self._free.sum(), 0.0) / 2
        alone = (pull / self.row.rings[1].constant) ** (1 / POINT_POWER)
        return _outwards(s) * (self._free[1] + half + alone)

    def _stepped(self, s, balls: _Pressed, step, miss, inertia, balanced) -> _Pressed:
        """Return the balls after a step, of each not beyond where the force along it has turned, nor
        off both grooves, where nothing would bring it back; of balls in balance that force is
        rounding.
        """
        size = np.maximum(np.abs(step), 1e-30)
        step = step * np.minimum(1.0, 0.02 * self.row.diameter / size)
        first = (miss.conj() * step).real
        share = np.ones_like(first)
        for _ in range(30):
            moved = self._pressed(s, _moved(balls, share * step))
            left = self._miss(moved, inertia)
            turned = (left.conj() * step).real < -0.5 * first
            too_far = (turned | (moved.approach < 0).all(axis=-2)) & ~balanced
            if not too_far.any():
                break
            share = np.where(too_far, share / 2, share)
        return moved

    def angles(self, motion: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the contact angles (..., n) at the inner and the outer ring, rad."""
        angles = np.angle(self._settled(motion).between)
        return angles[..., 0, :], angles[..., 1, :]

    def load(self, motion: np.ndarray) -> np.ndarray:
        """Return the load (..., 6) that holds the inner ring at motions (..., 6), N and N m."""
        press = self._settled(motion).force[..., 0, :]
        return six((press.conj() @ self._felt).real)

    def tangent(self, motion: np.ndarray) -> np.ndarray:
        """Return the derivative of the load, (..., 6, 6), exact."""
        balls = self._settled(motion)
        inner, both = self._stiffness(balls)
        radial, axial = self.row.centres(motion)
        s = radial + 1j * axial
        _, by_angle = self._inertia(s)
        weights = []
        # where the groove has ended nothing moves
        for unit, moves in zip((1.0 + 0j, 1j), self.row.turns(radial, axial)):
            moved = unit * moves
            by_inertia = by_angle * (moved * s.conj()).imag / np.maximum(np.abs(s), 1e-30) ** 2
            follows = both.motion(inner.force(moved) + by_inertia)
            press = inner.force(moved - follows)
            weights += [press.real, press.imag]
        small = np.concatenate(weights, axis=-1) @ self._products
        out = np.zeros((*small.shape[:-1], 6, 6))
        out[..., np.array(FELT)[:, None], np.array(FELT)] = small.reshape(*small.shape[:-1], 5, 5)
        return out

    def contacts(self, motion: np.ndarray) -> Contacts:
        """Return loads and angles at the inner ring, pressures at both."""
        balls = self._settled(motion)
        load, outer_load = np.moveaxis(np.abs(balls.force), -2, 0)
        angle = np.where(load > 0, np.angle(balls.between[..., 0, :]), np.nan)
        inner, outer = self.row.rings
        return Contacts(
            self.row.azimuth,
            load,
            angle,
            inner.pressure(load),
            outer.pressure(outer_load),
            load[..., None],
            outer_load[..., None],
        )


def _outwards(s: np.ndarray) -> np.ndarray:
    """Return the directions of s; across the shaft where an inner ring is off them."""
    return np.where(s.real > 0, s / np.maximum(np.abs(s), 1e-30), 1.0)


def _moved(balls: _Pressed, step: np.ndarray) -> np.ndarray:
    """Return centres o of balls moved around and across the outer groove: a straight step would
    leave the groove.
    """
    length = balls.length[..., 1, :]
    normal = balls.between[..., 1, :] / length
    along = step * normal.conj()
    return (length + along.real) * normal * np.exp(1j * along.imag / length)
