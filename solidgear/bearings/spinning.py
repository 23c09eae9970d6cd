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
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from solidgear.bearings.ball import BallRow
from solidgear.bearings.hertz import POINT_POWER, Point
from solidgear.bearings.row import FELT, Contacts, six
from solidgear.core import SolidgearError
from solidgear.core.body.cache import LastTwo

#: kg/m^3, bearing steel
DENSITY = 7800.0
#: of the largest force on a ball; and N, below which rounding of positions is felt
_BALANCED, _NEGLIGIBLE, _MOST = 1e-10, 1e-9, 100


@dataclass(frozen=True)
class SpinningBalls:
    """A row of balls whose inner ring turns; the outer one stands."""

    row: BallRow
    speed: float  #: rad/s
    density: float = DENSITY  #: of the balls, kg/m^3
    #: where the balls settled, by motion: load and tangent of one motion are asked in turn
    _last: LastTwo[tuple[np.ndarray, np.ndarray]] = field(
        default_factory=LastTwo, init=False, repr=False, compare=False
    )

    @property
    def pitch(self) -> float:
        """As of the row."""
        return self.row.pitch

    @property
    def mass(self) -> float:
        """Of a ball, kg."""
        return self.density * np.pi / 6 * self.row.diameter**3

    def _grooves(self) -> tuple[tuple[Point, float], tuple[Point, float]]:
        """Return the contact and free distance of groove and ball centre, inner and outer."""
        row = self.row
        inner, outer = row.rings
        return (
            (inner, (row.inner - 0.5) * row.diameter),
            (outer, (row.outer - 0.5) * row.diameter),
        )

    def _inertia(self, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the forces (..., 2) of inertia on balls at s, and their derivative (..., 2, 2)."""
        g = self.row.diameter / self.row.pitch
        length = np.linalg.norm(s, axis=-1)
        c, sin = s[..., 0] / length, s[..., 1] / length
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
        force = np.stack([pull - turn * sin, turn * c], axis=-1)
        by_angle = np.stack([pull_a - turn_a * sin - turn * c, turn_a * c - turn * sin], axis=-1)
        angle_by_s = np.stack([-sin, c], axis=-1) / length[..., None]
        return force, by_angle[..., :, None] * angle_by_s[..., None, :]

    def _forces(self, s: np.ndarray, o: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the forces (..., n, 2) along both contacts."""
        (inner, free_i), (outer, free_o) = self._grooves()
        return _force(s - o, inner.constant, free_i), _force(o, outer.constant, free_o)

    def _contacts(self, s: np.ndarray, o: np.ndarray, nearly: float = 0.0):
        """Return the forces (..., n, 2) along both contacts, and their stiffnesses, `nearly` metres
        further.
        """
        (inner, free_i), (outer, free_o) = self._grooves()
        q_i, k_i = _contact(s - o, inner.constant, free_i, nearly)
        q_o, k_o = _contact(o, outer.constant, free_o, nearly)
        return q_i, q_o, k_i, k_o

    def _settled(self, motion: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return vectors s and o (..., n, 2) at which the balls are in equilibrium."""
        felt_motion = np.ascontiguousarray(np.asarray(motion, float)[..., FELT])
        key = felt_motion.shape, felt_motion.tobytes()
        return self._last.on(key, lambda: self._settle(felt_motion))

    def _settle(self, felt_motion: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the equilibrium of the balls, from a static approach on."""
        row = self.row
        s = np.stack([row.start[k] + felt_motion @ row._felt[k].T for k in (0, 1)], axis=-1)
        inertia = self._inertia(s)[0]
        (_, free_i), (outer, free_o) = self._grooves()
        length = np.linalg.norm(s, axis=-1, keepdims=True)
        # half of a static approach, and as far outwards as inertia alone presses
        half = np.maximum(length - free_i - free_o, 0.0) / 2
        pull = np.abs(inertia).max(axis=-1)
        o = s / length * (free_o + half + (pull[..., None] / outer.constant) ** (1 / POINT_POWER))
        nearly = 1e-4 * row.diameter
        for count in range(_MOST):
            # a step must feel a contact that it is about to meet; less and less so
            q_i, q_o, k_i, k_o = self._contacts(s, o, nearly * 0.5**count)
            miss = q_i - q_o + inertia
            imbalance, reference = np.abs(miss).max(axis=-1), np.abs(q_o).max(axis=-1) + pull
            if np.all(imbalance <= _BALANCED * reference + _NEGLIGIBLE * 1e-3):
                return s, o
            step = np.linalg.solve(k_i + k_o, miss[..., None])[..., 0]
            size = np.maximum(np.linalg.norm(step, axis=-1, keepdims=True), 1e-30)
            step = step * np.minimum(1.0, 0.02 * row.diameter / size)
            o = _moved(o, self._step_share(s, o, step, miss, inertia)[..., None] * step)
        if np.all(imbalance <= 1e-8 * reference + _NEGLIGIBLE):
            return s, o
        raise SolidgearError(f"no equilibrium of the balls at {self.speed:.6g} rad/s")

    def _step_share(self, s, o, step, miss, inertia) -> np.ndarray:
        """Return the part of the step that every ball takes: not beyond where the force along it
        has turned.
        """
        first = (miss * step).sum(axis=-1)
        way = np.ones_like(first)
        for _ in range(30):
            q_i, q_o = self._forces(s, _moved(o, way[..., None] * step))
            too_far = ((q_i - q_o + inertia) * step).sum(axis=-1) < -0.5 * first
            if not too_far.any():
                break
            way = np.where(too_far, way / 2, way)
        return way

    def angles(self, motion: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the contact angles (..., n) at the inner and the outer ring, rad."""
        s, o = self._settled(motion)
        i = s - o
        return np.arctan2(i[..., 1], i[..., 0]), np.arctan2(o[..., 1], o[..., 0])

    def load(self, motion: np.ndarray) -> np.ndarray:
        """Return the load (..., 6) that holds the inner ring at motions (..., 6), N and N m."""
        press, _ = self._forces(*self._settled(motion))
        radial, axial = self.row._felt
        return six(press[..., 0] @ radial + press[..., 1] @ axial)

    def tangent(self, motion: np.ndarray) -> np.ndarray:
        """Return the derivative of the load, (..., 6, 6), exact."""
        s, o = self._settled(motion)
        _, _, k_i, k_o = self._contacts(s, o)
        follows = np.linalg.solve(k_i + k_o, k_i + self._inertia(s)[1])
        plane = k_i @ (np.eye(2) - follows)
        felt = self.row._felt
        small = np.einsum("ani,...nab,bnj->...ij", felt, plane, felt)
        out = np.zeros((*small.shape[:-2], 6, 6))
        out[..., np.array(FELT)[:, None], np.array(FELT)] = small
        return out

    def contacts(self, motion: np.ndarray) -> Contacts:
        """Return loads and angles at the inner ring, pressures at both."""
        s, o = self._settled(motion)
        i = s - o
        (inner, _), (outer, _) = self._grooves()
        q_i, q_o = self._forces(s, o)
        load, outer_load = np.linalg.norm(q_i, axis=-1), np.linalg.norm(q_o, axis=-1)
        angle = np.where(load > 0, np.arctan2(i[..., 1], i[..., 0]), np.nan)
        return Contacts(
            self.row.azimuth,
            load,
            angle,
            inner.pressure(load),
            outer.pressure(outer_load),
            load[..., None],
            outer_load[..., None],
        )


def _moved(o: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Return a ball's centre moved around and across the groove: a straight step would leave the
    groove.
    """
    length = np.linalg.norm(o, axis=-1, keepdims=True)
    normal = o / length
    across = np.stack([-normal[..., 1], normal[..., 0]], axis=-1)
    angle = (step * across).sum(axis=-1, keepdims=True) / length
    direction = np.cos(angle) * normal + np.sin(angle) * across
    return (length + (step * normal).sum(axis=-1, keepdims=True)) * direction


def _force(between: np.ndarray, constant: float, free: float) -> np.ndarray:
    """Return the force (..., 2) along the vector between two centres."""
    length = np.sqrt((between**2).sum(axis=-1))
    press = constant * np.maximum(length - free, 0.0) ** POINT_POWER
    return (press / length)[..., None] * between


def _contact(between: np.ndarray, constant: float, free: float, nearly: float):
    """Return the force (..., 2) along the vector between two centres, and the derivative."""
    length = np.linalg.norm(between, axis=-1)
    normal = between / length[..., None]
    press = constant * np.maximum(length - free, 0.0) ** POINT_POWER
    slope = POINT_POWER * constant * np.sqrt(np.maximum(length - free + nearly, 0.0))
    along = normal[..., :, None] * normal[..., None, :]
    across = np.eye(2) - along
    stiffness = slope[..., None, None] * along + (press / length)[..., None, None] * across
    return press[..., None] * normal, stiffness
