"""A row of balls at speed: centrifugal force and gyroscopic moment.

At speed a ball's two contact angles differ, and its centre finds its place between the grooves.
With o the vector from the outer groove's centre to the ball's and i from there to the inner
groove's, ``i + o = s`` (:mod:`solidgear.bearings.ball`), it is in equilibrium where

    Q_i n_i - Q_o n_o + (F_c, 0) + (2 M_g / D) (-sin a_o, cos a_o) = 0        (radial, axial)

(Jones 1960; Harris and Kotzalas, Advanced Concepts, 5th ed., ch. 3, outer raceway control:
the outer ring alone takes the gyroscopic moment).  With g = D / Dpw and the inner ring turning,

    w_m / w = (1 - g cos a_i) / (1 + cos(a_i - a_o)),         F_c = m (Dpw / 2) w_m^2,
    tan b   = sin a_o / (cos a_o + g),
    M_g     = J w w_m tan b / (g (P_o + P_i)),                J = m D^2 / 10,
    P_o = (cos a_o + tan b sin a_o) / (1 + g cos a_o),
    P_i = (cos a_i + tan b sin a_i) / (1 - g cos a_i).

The tangent is implicit differentiation of that equilibrium, with the turning of both angles in F_c
and M_g.  Inertia is no spring: the tangent is not quite symmetric.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.bearings.ball import BallRow
from solidgear.bearings.hertz import POINT_POWER, Point
from solidgear.bearings.row import FELT, Contacts, six
from solidgear.errors import SolidgearError

#: kg/m^3, bearing steel
DENSITY = 7800.0
#: of the largest force on a ball; and N, below which rounding of positions is felt
_BALANCED, _NEGLIGIBLE, _MOST = 1e-11, 1e-9, 200


@dataclass(frozen=True)
class SpinningBalls:
    """A row of balls whose inner ring turns; the outer one stands.

    Attributes
    ----------
    row : BallRow
    speed : float
        rad/s.
    density : float
        Of the balls, kg/m^3.

    Examples
    --------
    The outer ring carries the balls as well, and its contact angle falls:

    >>> import numpy as np
    >>> row = BallRow(count=16, diameter=22.225e-3, pitch=125.26e-3, angle=np.radians(40))
    >>> fast = SpinningBalls(row, speed=1047.0)
    >>> inner, outer = fast.angles(np.array([0.0, 40e-6, 0, 0, 0, 0]))
    >>> bool(inner[0] > outer[0])
    True
    """

    row: BallRow
    speed: float
    density: float = DENSITY

    @property
    def pitch(self) -> float:
        """As of the row."""
        return self.row.pitch

    @property
    def mass(self) -> float:
        """Of a ball, kg."""
        return self.density * np.pi / 6 * self.row.diameter**3

    def _grooves(self) -> tuple[tuple[Point, float], tuple[Point, float]]:
        """Contact and free distance of groove and ball centre, inner and outer."""
        row = self.row
        inner, outer = row.rings
        return (
            (inner, (row.inner - 0.5) * row.diameter),
            (outer, (row.outer - 0.5) * row.diameter),
        )

    def _inertia(self, a_i: np.ndarray, a_o: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Forces (..., 2) of inertia on a ball, and their derivative (..., 2, 2) by both angles."""
        g = self.row.diameter / self.row.pitch
        s_i, c_i, s_o, c_o = np.sin(a_i), np.cos(a_i), np.sin(a_o), np.cos(a_o)
        apart = 1 + np.cos(a_i - a_o)
        orbit = (1 - g * c_i) / apart
        orbit_i = g * s_i / apart + orbit * np.sin(a_i - a_o) / apart
        orbit_o = -orbit * np.sin(a_i - a_o) / apart
        tan = s_o / (c_o + g)
        tan_o = (1 + g * c_o) / (c_o + g) ** 2
        below_o, below_i = 1 + g * c_o, 1 - g * c_i
        p = (c_o + tan * s_o) / below_o + (c_i + tan * s_i) / below_i
        p_i = (-s_i + tan * c_i) / below_i - (c_i + tan * s_i) * g * s_i / below_i**2
        p_o = (-s_o + tan * c_o + tan_o * s_o) / below_o + tan_o * s_i / below_i
        p_o = p_o + (c_o + tan * s_o) * g * s_o / below_o**2
        heavy = self.mass * self.row.pitch / 2 * self.speed**2
        pull = heavy * orbit**2
        pull_i, pull_o = 2 * heavy * orbit * orbit_i, 2 * heavy * orbit * orbit_o
        # twice the moment over the diameter
        factor = 2 * self.mass * self.row.diameter / 10 * self.speed**2 / g
        turn = factor * orbit * tan / p
        turn_i = factor * tan * (orbit_i / p - orbit * p_i / p**2)
        turn_o = factor * ((orbit_o * tan + orbit * tan_o) / p - orbit * tan * p_o / p**2)
        force = np.stack([pull - turn * s_o, turn * c_o], axis=-1)
        by_inner = np.stack([pull_i - turn_i * s_o, turn_i * c_o], axis=-1)
        by_outer = np.stack(
            [pull_o - turn_o * s_o - turn * c_o, turn_o * c_o - turn * s_o], axis=-1
        )
        return force, np.stack([by_inner, by_outer], axis=-1)

    def _balance(self, s: np.ndarray, o: np.ndarray):
        """Forces on balls (..., n, 2) for s and o, derivatives by s and by o, inner force and
        stiffness.
        """
        (inner, free_i), (outer, free_o) = self._grooves()
        q_i, k_i, a_i, turn_i = _contact(s - o, inner.constant, free_i)
        q_o, k_o, a_o, turn_o = _contact(o, outer.constant, free_o)
        force, by_angle = self._inertia(a_i, a_o)
        by_i = by_angle[..., :, :1] * turn_i[..., None, :]
        by_o = by_angle[..., :, 1:] * turn_o[..., None, :]
        return q_i - q_o + force, k_i + by_i, -k_i - k_o - by_i + by_o, q_i, k_i

    def _settled(self, motion: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Vectors s and o (..., n, 2) at which the balls are in equilibrium."""
        row = self.row
        own = np.asarray(motion, float)[..., FELT]
        s = np.stack([row.start[k] + own @ row._felt[k].T for k in (0, 1)], axis=-1)
        (_, free_i), (outer, free_o) = self._grooves()
        length = np.linalg.norm(s, axis=-1, keepdims=True)
        # half of a static approach, and as far outwards as the centrifugal force alone presses
        half = np.maximum(length - free_i - free_o, 0.0) / 2
        o = s / length * (free_o + half)
        pull = self._inertia(np.zeros(1), np.zeros(1))[0][0, 0]
        o[..., 0] += (pull / outer.constant) ** (1 / POINT_POWER)
        # a ball that touches nothing goes where it is pushed
        soft = 1e-9 * row.constant * np.sqrt(row.diameter) * np.eye(2)
        reach = 0.02 * row.diameter
        for _ in range(_MOST):
            miss, _, by_o, press, _ = self._balance(s, o)
            left, wanted = np.abs(miss).max(axis=-1), np.abs(press).max(axis=-1) + pull
            open_ = left > _BALANCED * wanted + _NEGLIGIBLE * 1e-3
            step = -np.linalg.solve(by_o - soft, miss[..., None])[..., 0]
            size = np.maximum(np.linalg.norm(step, axis=-1), 1e-30)
            step = step * (np.minimum(1.0, reach / size) * open_)[..., None]
            way, moved = self._shortened(s, o, step, left, open_)
            if not moved.any():
                break
            o = o + way[..., None] * step
        if np.all(left <= 1e-8 * wanted + _NEGLIGIBLE):
            return s, o
        raise SolidgearError(
            f"no equilibrium of the balls at {self.speed:.6g} rad/s: they are thrown outwards "
            "beyond what the grooves hold"
        )

    def _shortened(self, s, o, step, left, open_):
        """Part of the step that every ball takes, and which balls come nearer by it."""
        way = np.where(open_, 1.0, 0.0)
        for _ in range(12):
            trial = np.abs(self._balance(s, o + way[..., None] * step)[0]).max(axis=-1)
            better = open_ & (trial < (1 - 1e-3 * way) * left)
            if np.array_equal(better, open_):
                break
            way = np.where(open_ & ~better, way / 2, way)
        return np.where(better, way, 0.0), better

    def angles(self, motion: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Contact angles (..., n) at the inner and the outer ring, rad."""
        s, o = self._settled(motion)
        i = s - o
        return np.arctan2(i[..., 1], i[..., 0]), np.arctan2(o[..., 1], o[..., 0])

    def load(self, motion: np.ndarray) -> np.ndarray:
        """Load (..., 6) that holds the inner ring at motions (..., 6), N and N m."""
        press = self._balance(*self._settled(motion))[3]
        radial, axial = self.row._felt
        return six(press[..., 0] @ radial + press[..., 1] @ axial)

    def tangent(self, motion: np.ndarray) -> np.ndarray:
        """Derivative of the load, (..., 6, 6), exact."""
        _, by_s, by_o, _, k_i = self._balance(*self._settled(motion))
        follows = -np.linalg.solve(by_o, by_s)
        plane = k_i @ (np.eye(2) - follows)
        felt = self.row._felt
        small = np.einsum("ani,...nab,bnj->...ij", felt, plane, felt)
        out = np.zeros((*small.shape[:-2], 6, 6))
        out[..., np.array(FELT)[:, None], np.array(FELT)] = small
        return out

    def contacts(self, motion: np.ndarray) -> Contacts:
        """Loads and angles at the inner ring, pressures at both."""
        s, o = self._settled(motion)
        (inner, free_i), (outer, free_o) = self._grooves()
        q_i, _, a_i, _ = _contact(s - o, inner.constant, free_i)
        q_o, *_ = _contact(o, outer.constant, free_o)
        load, under = np.linalg.norm(q_i, axis=-1), np.linalg.norm(q_o, axis=-1)
        angle = np.where(load > 0, a_i, np.nan)
        return Contacts(self.row.azimuth, load, angle, inner.pressure(load), outer.pressure(under))


def _contact(between: np.ndarray, constant: float, free: float):
    """Force (..., 2) along the vector between two centres, its derivative, the angle and its
    gradient.
    """
    length = np.linalg.norm(between, axis=-1)
    normal = between / length[..., None]
    approach = np.maximum(length - free, 0.0)
    press = constant * approach**POINT_POWER
    slope = POINT_POWER * constant * np.sqrt(approach)
    along = normal[..., :, None] * normal[..., None, :]
    across = np.eye(2) - along
    stiffness = slope[..., None, None] * along + (press / length)[..., None, None] * across
    angle = np.arctan2(normal[..., 1], normal[..., 0])
    turn = np.stack([-normal[..., 1], normal[..., 0]], axis=-1) / length[..., None]
    return press[..., None] * normal, stiffness, angle, turn
