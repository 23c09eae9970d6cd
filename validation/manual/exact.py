"""References worked out here: closed forms and exact solutions of the beam equations.

Nothing is imported from the library that is held to them.  SI units throughout.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq


@dataclass(frozen=True)
class Elastic:
    """Isotropic material: Young's modulus, Poisson's ratio, density."""

    E: float
    nu: float
    density: float

    @property
    def G(self) -> float:
        """Shear modulus, Pa."""
        return self.E / (2 * (1 + self.nu))

    @property
    def bar_speed(self) -> float:
        """Speed of long extensional waves in a bar, m/s."""
        return float(np.sqrt(self.E / self.density))

    @property
    def shear_speed(self) -> float:
        """Speed of shear waves, and of torsion in a circular rod, m/s."""
        return float(np.sqrt(self.G / self.density))


STEEL = Elastic(2.07e11, 0.3, 7850.0)


@dataclass(frozen=True)
class Tube:
    """A uniform length of circular shaft: length, outer and inner radius, m."""

    length: float
    outer: float
    inner: float = 0.0

    @property
    def area(self) -> float:
        """Of the section, m^2."""
        return np.pi * (self.outer**2 - self.inner**2)

    @property
    def second(self) -> float:
        """Second moment of area about a diameter, m^4."""
        return np.pi / 4 * (self.outer**4 - self.inner**4)

    def shear_coefficient(self, nu: float) -> float:
        """Hutchinson (2001), J. Appl. Mech. 68, 87, equation 49, in the ratio of the radii."""
        m = (self.inner / self.outer) ** 2
        plain = 7 + 34 * m + 7 * m**2
        once = 12 + 48 * m + 12 * m**2
        twice = 4 + 16 * m + 4 * m**2
        return 6 * (1 + nu) ** 2 * (1 + m) ** 2 / (plain + nu * once + nu**2 * twice)


@dataclass(frozen=True)
class Spring:
    """A spring to ground behind the spans whose number it tells: lateral N/m and tilt N m/rad."""

    after: int
    lateral: float
    tilt: float = 0.0


def beam_frequencies(
    spans: Sequence[Tube],
    springs: Sequence[Spring],
    count: int,
    material: Elastic = STEEL,
    shear: bool = True,
    rotary: bool = True,
) -> list[float]:
    """Bending frequencies, Hz, of a stepped beam with free ends on springs, rigid motions left out.

    State (w, phi, M, Q) with ``w' = phi + Q / kGA``, ``phi' = M / EI``, ``M' = -Q - rho I w^2 phi``
    and ``Q' = -rho A w^2 w`` (Timoshenko, Phil. Mag. 41 (1921), 744), carried over each span
    exactly.  Free ends make a frequency a zero of the determinant of the block that
    takes (w, phi) at one end to (M, Q) at the other.

    Parameters
    ----------
    shear, rotary : bool
        Without both it is the beam of Euler and Bernoulli.
    """
    length = sum(s.length for s in spans)
    stiff = material.E * spans[0].second
    unit = np.sqrt(stiff / (material.density * spans[0].area)) / length**2

    def determinant(wave: float) -> float:
        return _free_ends(wave**2 * unit, spans, springs, material, shear, rotary)

    # in wave numbers over the length the roots lie about pi apart
    low = 0.3
    roots: list[float] = []
    while len(roots) < count:
        roots += zeros(determinant, low, low + 2, 10)
        low += 2
    return [wave**2 * unit / (2 * np.pi) for wave in roots[:count]]


def _free_ends(omega, spans, springs, material, shear, rotary) -> float:
    length = sum(s.length for s in spans)
    # moments and forces in units of EI / L and EI / L^2, lengths in L: all entries of order one
    unit = material.E * spans[0].second
    state = np.eye(4)
    for number, span in enumerate(spans):
        state = _sprung(number, springs, unit, length) @ state
        coefficient = span.shear_coefficient(material.nu)
        kga = coefficient * material.G * span.area * length**2 / unit
        inertia = material.density * span.area * omega**2 * length**4 / unit
        turning = material.density * span.second * omega**2 * length**2 / unit
        field = np.zeros((4, 4))
        field[0, 1] = 1
        field[0, 3] = 1 / kga if shear else 0
        field[1, 2] = unit / (material.E * span.second)
        field[2, 1] = -turning if rotary else 0
        field[2, 3] = -1
        field[3, 0] = -inertia
        state = _carried(field, span.length / length) @ state
    state = _sprung(len(spans), springs, unit, length) @ state
    return float(np.linalg.det(state[2:, :2]))


def _carried(field: np.ndarray, length: float) -> np.ndarray:
    """``exp(A s)`` of a span: its A has eigenvalues ``+-a`` and ``+-i b``.

    So A^2 has a^2 and -b^2, each twice, and any function of it is linear in it; ``exp(A s)`` is
    ``cosh(A s) + A (sinh(A s) / A)``, both functions of A^2.
    """
    square = field @ field
    mean = np.trace(square) / 4
    half = np.sqrt(mean**2 - np.linalg.det(field))
    a, b = np.sqrt(half + mean), np.sqrt(half - mean)
    rising = (square + b**2 * np.eye(4)) / (2 * half)
    turning = np.eye(4) - rising
    even = np.cosh(a * length) * rising + np.cos(b * length) * turning
    odd = np.sinh(a * length) / a * rising + np.sin(b * length) / b * turning
    return even + field @ odd


def _sprung(number: int, springs: Sequence[Spring], unit: float, length: float) -> np.ndarray:
    jump = np.eye(4)
    for spring in springs:
        if spring.after == number:
            jump[3, 0] += spring.lateral * length**3 / unit
            jump[2, 1] += spring.tilt * length / unit
    return jump


def zeros(f: Callable[[float], float], low: float, high: float, pieces: int) -> list[float]:
    """Zeros of a function between two places, one at most in each piece."""
    grid = np.linspace(low, high, pieces + 1)
    values = [f(x) for x in grid]
    return [
        float(brentq(f, x, y, xtol=1e-13 * y, rtol=1e-13))
        for x, y, a, b in zip(grid, grid[1:], values, values[1:])
        if a * b < 0
    ]


def hinged_beam(span: Tube, number: int, material: Elastic = STEEL, shear: bool = True) -> float:
    """Frequency, Hz, of a uniform beam between hinges: sines fit, so the equation is a quadratic.

    With ``q = n pi / L``, ``rho^2 A I / kGA w^4 - (rho A + rho I q^2 + E I rho A q^2 / kGA) w^2 +
    E I q^4 = 0`` (Timoshenko 1921); without shear and rotary inertia ``w = q^2 sqrt(EI / rho A)``.
    """
    q = number * np.pi / span.length
    stiff, mass = material.E * span.second, material.density * span.area
    if not shear:
        return float(q**2 * np.sqrt(stiff / mass) / (2 * np.pi))
    turning = material.density * span.second
    kga = span.shear_coefficient(material.nu) * material.G * span.area
    a = mass * turning / kga
    b = mass + turning * q**2 + stiff * mass * q**2 / kga
    c = stiff * q**4
    # the smaller root, without the difference of near numbers
    omega2 = 2 * c / (b + np.sqrt(b**2 - 4 * a * c))
    return float(np.sqrt(omega2) / (2 * np.pi))


def stepped_torsion(spans: Sequence[Tube], count: int, material: Elastic = STEEL) -> list[float]:
    """Frequencies, Hz, of free torsion of a rod of two spans.

    Angle and torque meet at the step where ``J1 tan k L1 + J2 tan k L2 = 0``, k = w / c_s.
    """
    one, two = spans

    def equation(k: float) -> float:
        left = one.second * np.sin(k * one.length) * np.cos(k * two.length)
        return left + two.second * np.sin(k * two.length) * np.cos(k * one.length)

    length = one.length + two.length
    waves = zeros(equation, 0.1 / length, (count + 2) * np.pi / length, 50 * (count + 2))
    return [k * material.shear_speed / (2 * np.pi) for k in waves[:count]]


def rigid_on_springs(
    body: Tube, places: Sequence[float], lateral: Sequence[float], material: Elastic = STEEL
) -> list[float]:
    """Two frequencies, Hz, of a rigid cylinder on lateral springs in one plane.

    ``(k - w^2 m)(t - w^2 J) = c^2`` with ``k = sum k_i``, ``c = sum k_i s_i``, ``t = sum k_i s_i^2``,
    s from the centre of mass, ``J = m (3 (a^2 + b^2) + L^2) / 12``.
    """
    mass = material.density * body.area * body.length
    inertia = mass * (3 * (body.outer**2 + body.inner**2) + body.length**2) / 12
    arms = [y - body.length / 2 for y in places]
    k = sum(lateral)
    c = sum(ki * s for ki, s in zip(lateral, arms))
    t = sum(ki * s**2 for ki, s in zip(lateral, arms))
    half = (k / mass + t / inertia) / 2
    product = (k * t - c**2) / (mass * inertia)
    root = np.sqrt(half**2 - product)
    return [float(np.sqrt(w2) / (2 * np.pi)) for w2 in (product / (half + root), half + root)]


def ring_frequency(waves: int, wall: float, radius: float, material: Elastic) -> float:
    """Frequency, Hz, of an inextensional ring of a long tube with ``waves`` around."""
    modulus = material.E / (1 - material.nu**2)
    n = waves**2
    omega2 = modulus * wall**2 / 12 * n * (n - 1) ** 2
    omega2 /= material.density * radius**4 * (n + 1)
    return float(np.sqrt(omega2) / (2 * np.pi))
