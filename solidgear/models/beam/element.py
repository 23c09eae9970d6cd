"""Beam finite element for stepped, tapered and hollow shafts: Euler-Bernoulli and Timoshenko.

One element serves both theories and any taper. Its stiffness is the inverse of the tip flexibility
of the element clamped at one end, integrated over the true section; its mass is consistent with the
displacement field of that static problem. A uniform element is the textbook one. Nothing here is
shared with the solid builders: that independence is what makes a comparison worth having.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import scipy.linalg as sla

if TYPE_CHECKING:
    from solidgear.scene import Segment

_GAUSS = np.polynomial.legendre.leggauss(8)


def shear_coefficient(nu: float, outer, inner):
    """Timoshenko shear coefficient of a circular tube (Hutchinson 2001, J. Appl. Mech. 68, eq. 49).

    For a solid circle it is ``6 (1+nu)^2 / (7 + 12 nu + 4 nu^2)``.

    Parameters
    ----------
    nu : float
        Poisson's ratio.
    outer, inner : float or ndarray
        Radii, m.

    Returns
    -------
    float or ndarray

    Examples
    --------
    >>> round(float(shear_coefficient(0.3, outer=0.045, inner=0.0)), 4)
    0.9252
    >>> round(float(shear_coefficient(0.3, outer=0.045, inner=0.0449)), 3)  # a thin tube
    0.565
    """
    a, b = np.asarray(outer, float), np.asarray(inner, float)
    a2, b2 = a * a, b * b
    top = 6 * (1 + nu) ** 2 * (a2 + b2) ** 2
    bottom = (
        7 * a2**2
        + 34 * a2 * b2
        + 7 * b2**2
        + nu * (12 * a2**2 + 48 * a2 * b2 + 12 * b2**2)
        + nu**2 * (4 * a2**2 + 16 * a2 * b2 + 4 * b2**2)
    )
    return top / bottom


class Section:
    """Section properties of one element at its Gauss points (distances s from the left end).

    Parameters
    ----------
    segment : Segment
        That the element lies in.
    left, right : float
        Its ends, m.
    head : {'cone', 'mean'}
        Follow the taper, or take mean radii.
    kappa : {'hutchinson', 'cowper'}
        Shear coefficient.

    Attributes
    ----------
    length : float
        m.
    s, w : (q,) ndarray
        Gauss points and weights, m.
    bend, shear, stretch, twist : (q,) ndarray
        ``E I`` (N m^2), ``kappa G A`` (N), ``E A`` (N) and ``G J`` (N m^2).
    mass, rotary, polar : (q,) ndarray
        ``rho A`` (kg/m), ``rho I`` and ``rho J`` (kg m).
    integral : (q, q) ndarray
        Integrates values at the Gauss points from 0 to each of them.
    """

    def __init__(self, segment, left, right, head, kappa):
        x, w = _GAUSS
        self.length = right - left
        self.s = self.length * (x + 1) / 2
        self.w = self.length * w / 2
        if head == "mean":
            a = np.full_like(self.s, (segment.outer0 + segment.outer1) / 2)
            b = np.full_like(self.s, (segment.inner0 + segment.inner1) / 2)
        else:
            t = (left + self.s - segment.y0) / segment.length
            a = segment.outer0 + t * (segment.outer1 - segment.outer0)
            b = segment.inner0 + t * (segment.inner1 - segment.inner0)
        mat = segment.material
        area = np.pi * (a**2 - b**2)
        second = np.pi / 4 * (a**4 - b**4)
        g = mat.E / (2 * (1 + mat.nu))
        self.bend = mat.E * second
        # Cowper (1966), J. Appl. Mech. 33, 335: 6 (1 + nu) / (7 + 6 nu)
        factor = (
            shear_coefficient(mat.nu, a, b)
            if kappa == "hutchinson"
            else 6 * (1 + mat.nu) / (7 + 6 * mat.nu)
        )
        self.shear = factor * g * area
        self.stretch = mat.E * area
        self.twist = 2 * g * second
        self.mass = mat.density * area
        self.rotary = mat.density * second
        self.polar = 2 * self.rotary
        # Integration from 0 to s at the Gauss points, exact for the polynomial through them.
        lagrange = np.linalg.inv(np.vander(x, increasing=True))
        powers = np.empty((len(x), len(x)))
        for j in range(len(x)):
            powers[:, j] = [(xi ** (j + 1) - (-1.0) ** (j + 1)) / (j + 1) for xi in x]
        self.integral = self.length / 2 * powers @ lagrange

    def soften(self, bend: float, stretch: float, twist: float) -> None:
        """Add compliance, spread evenly over the length; shear and inertia stay.

        Parameters
        ----------
        bend, stretch, twist : float
            rad/(N m), m/N and rad/(N m).
        """
        self.bend = 1 / (1 / self.bend + bend / self.length)
        self.stretch = 1 / (1 / self.stretch + stretch / self.length)
        self.twist = 1 / (1 / self.twist + twist / self.length)


def bending_matrices(c: Section, shear: bool, rotary: bool, mass: str):
    """Stiffness, mass and fields of one bending element on ``(z, thx)`` at both ends, then internal
    unknowns.

    With shear the static field has constant shear in an element, which alone converges with the
    square of its length.  Two internal fields, those of a clamped element under a uniform force and
    a uniform moment, lift that to the fourth power; they store no energy together with the nodal
    fields.

    Parameters
    ----------
    shear : bool
        Timoshenko, else Euler-Bernoulli.
    rotary : bool
        Whether sections carry rotary inertia.
    mass : {'consistent', 'lumped'}

    Returns
    -------
    stiffness, mass : (n, n) ndarray
        n is 4, with internal unknowns 5 or 6; N/m, N, N m, and kg, kg m, kg m^2.
    shape : (2, q, n) ndarray
        Deflection and turn at the Gauss points.

    Examples
    --------
    >>> from solidgear import Segment
    >>> rod = Segment.cylinder("rod", length=0.6, diameter=0.02)
    >>> section = Section(rod, 0.0, 0.6, head="cone", kappa="hutchinson")
    >>> k, m, _ = bending_matrices(section, shear=False, rotary=False, mass="consistent")
    >>> round(float(k[0, 0] * 0.6**3 / section.bend[0]), 9)  # 12 E I / L^3
    12.0
    """
    L, s, w = c.length, c.s, c.w
    soft = np.stack([1 / c.bend, 1 / c.shear if shear else np.zeros_like(s)])
    # Clamped at the left.  With dz/dy = thx a tip force bends by L - s, a tip moment by 1, a
    # uniform force by (L - s)^2 / 2 and a uniform moment by L - s.  First row moments, second row
    # shear forces.
    tip = np.stack(
        [
            np.column_stack([L - s, np.ones_like(s)]),
            np.column_stack([np.ones_like(s), np.zeros_like(s)]),
        ]
    )
    spread = np.stack(
        [np.column_stack([(L - s) ** 2 / 2, L - s]), np.column_stack([L - s, np.zeros_like(s)])]
    )

    def energy(a, b):
        return np.einsum("kqi,kq,kqj->ij", a, w * soft, b)

    def field(inner):
        """Deflection and turn along the cantilever for internal moments and forces."""
        turn = c.integral @ (inner[0] * soft[0][:, None])
        return np.stack([c.integral @ (turn + inner[1] * soft[1][:, None]), turn])

    resist = np.linalg.inv(energy(tip, tip))
    carry = np.array([[1.0, L], [0.0, 1.0]])  # rigid motion of the right end under that of the left
    difference = np.hstack([-carry, np.eye(2)])
    k = difference.T @ resist @ difference
    rigid = np.zeros((2, len(s), 4))
    rigid[0, :, 0] = rigid[1, :, 1] = 1.0
    rigid[0, :, 1] = s
    shape = field(tip) @ resist @ difference + rigid
    inertia = np.stack([c.mass, c.rotary if rotary else np.zeros_like(s)])
    if mass == "lumped":
        left = s < L / 2
        ends = [(w * i)[part].sum() for part in (left, ~left) for i in inertia]
        return k, np.diag(ends), shape
    if shear:
        spread = spread[:, :, : 1 + rotary]
        clamped = spread - tip @ (resist @ energy(tip, spread))
        stiff = energy(clamped, clamped)
        # Brought to the size of the nodal stiffness, for a well-scaled matrix.
        clamped = clamped * np.sqrt(k[0, 0] / np.diag(stiff))
        k = sla.block_diag(k, energy(clamped, clamped))
        shape = np.concatenate([shape, field(clamped)], axis=2)
    m = np.einsum("kqi,kq,kqj->ij", shape, w * inertia, shape)
    return k, m, shape


def rod_matrices(c: Section, rigidity, inertia, mass: str):
    """Stiffness, mass and field of a tapered bar in stretch or twist.

    Parameters
    ----------
    rigidity : (q,) ndarray
        ``E A`` or ``G J``.
    inertia : (q,) ndarray
        ``rho A`` or ``rho J``.
    mass : {'consistent', 'lumped'}

    Returns
    -------
    stiffness, mass : (2, 2) ndarray
    shape : (q, 2) ndarray
        Motion at the Gauss points.
    """
    compliance = (c.w / rigidity).sum()
    k = np.array([[1.0, -1.0], [-1.0, 1.0]]) / compliance
    right = c.integral @ (1 / rigidity) / compliance
    shape = np.column_stack([1 - right, right])
    m = shape.T @ ((c.w * inertia)[:, None] * shape)
    if mass == "lumped":
        m = np.diag(m.sum(axis=1))
    return k, m, shape


@dataclass(frozen=True)
class Fields:
    """Displacement fields of one element, at its Gauss points.

    Attributes
    ----------
    left, right : float
        Ends of the element, m.
    bend : (ndarray of int, (2, q, n) ndarray)
        Unknowns, and the deflection and turn that each makes.
    stretch, twist : (ndarray of int, (q, n) ndarray)
        Unknowns, and the motion that each makes.
    """

    segment: Segment
    left: float
    right: float
    bend: tuple[np.ndarray, np.ndarray]
    stretch: tuple[np.ndarray, np.ndarray]
    twist: tuple[np.ndarray, np.ndarray]

    def part(self, lo: float, hi: float):
        """Quadrature on the outer surface of a part of the element.

        Parameters
        ----------
        lo, hi : float
            m.

        Returns
        -------
        y, r : (q,) ndarray
            Places along the shaft, and radii there, m.
        weight : (q,) ndarray
            Of the length along the surface, m.
        lagrange : (q, q) ndarray
            Interpolation from the Gauss points of the element.
        """
        x, w = _GAUSS
        middle, half = (lo + hi) / 2, (hi - lo) / 2
        y = middle + half * x
        local = (2 * y - self.left - self.right) / (self.right - self.left)
        lagrange = np.vander(local, len(x), increasing=True) @ np.linalg.inv(
            np.vander(x, increasing=True)
        )
        segment = self.segment
        slope = (segment.outer1 - segment.outer0) / segment.length
        r = segment.outer0 + slope * (y - segment.y0)
        return y, r, w * half * np.hypot(1.0, slope), lagrange
