"""Beam finite element for stepped, tapered and hollow shafts: Euler-Bernoulli and Timoshenko.

One element serves both theories and any taper. Its stiffness is the inverse of the tip flexibility
of the element clamped at one end, integrated over the true section; its mass is consistent with the
displacement field of that static problem. A uniform element is the textbook one. Nothing here is
shared with the solid builders: that independence is what makes a comparison worth having.

All elements of a beam are made at once. Their shape and material may be complex, so that a derivative
is an imaginary part (Squire and Trapp 1998, SIAM Review 40, 110), without a difference.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from solidgear.core.scene import Segment

_GAUSS = np.polynomial.legendre.leggauss(8)
_POWERS = np.arange(len(_GAUSS[0]))
#: coefficients of the polynomial through values at the Gauss points
_THROUGH = np.linalg.inv(np.vander(_GAUSS[0], increasing=True))
#: integrates values at the Gauss points of (-1, 1) from its left end to each of them
_INTEGRAL = np.column_stack(
    [(_GAUSS[0] ** (j + 1) - (-1.0) ** (j + 1)) / (j + 1) for j in _POWERS]
) @ _THROUGH  # fmt: skip


def shear_coefficient(nu, outer, inner):
    """Return the Timoshenko shear coefficient of a circular tube of radii in m (Hutchinson 2001, J.
    Appl. Mech. 68, eq. 49).

    For a solid circle it is ``6 (1+nu)^2 / (7 + 12 nu + 4 nu^2)``.

    Examples
    --------
    >>> round(float(shear_coefficient(0.3, outer=0.045, inner=0.0)), 4)
    0.9252
    >>> round(float(shear_coefficient(0.3, outer=0.045, inner=0.0449)), 3)  # a thin tube
    0.565
    """
    a2, b2 = np.square(outer), np.square(inner)
    top = 6 * (1 + nu) ** 2 * (a2 + b2) ** 2
    bottom = (
        7 * a2**2
        + 34 * a2 * b2
        + 7 * b2**2
        + nu * (12 * a2**2 + 48 * a2 * b2 + 12 * b2**2)
        + nu**2 * (4 * a2**2 + 16 * a2 * b2 + 4 * b2**2)
    )
    return top / bottom


@dataclass(frozen=True, eq=False)
class Elements:
    """Elements of a beam, each field (e,): their ends (m), and the ends, radii (m) and material
    (SI) of the segment that each lies in.
    """

    left: np.ndarray
    right: np.ndarray
    y0: np.ndarray
    y1: np.ndarray
    outer0: np.ndarray
    outer1: np.ndarray
    inner0: np.ndarray
    inner1: np.ndarray
    E: np.ndarray
    nu: np.ndarray
    density: np.ndarray

    @classmethod
    def of(cls, segments: Sequence[Segment], nodes: np.ndarray) -> Elements:
        """Return the elements between nodes, m."""
        owner = owners(segments, nodes)
        shapes = np.array([[getattr(s, name) for name in SHAPE] for s in segments])[owner].T
        matter = np.array([[getattr(s.material, name) for name in MATTER] for s in segments])
        return cls(nodes[:-1], nodes[1:], *shapes, *matter[owner].T)

    def only(self, places: np.ndarray) -> Elements:
        """Return the elements at some places."""
        return Elements(**{f.name: getattr(self, f.name)[places] for f in fields(self)})


#: fields of a segment and of its material that make an element
SHAPE = ("y0", "y1", "outer0", "outer1", "inner0", "inner1")
MATTER = ("E", "nu", "density")


def owners(segments: Sequence[Segment], nodes: np.ndarray) -> np.ndarray:
    """Return the place (e,) of the segment of every element."""
    middle = (nodes[1:] + nodes[:-1]) / 2
    ends = np.array([s.y1 for s in segments])
    return np.minimum(np.searchsorted(ends, middle), len(ends) - 1)


class Section:
    """Section properties of elements at their Gauss points (distances s from their left ends).

    Parameters
    ----------
    elements : Elements
    head : {'cone', 'mean'}
        Follow the taper, or take mean radii.
    kappa : {'hutchinson', 'cowper'}
        Shear coefficient.

    Attributes
    ----------
    length : (e,) ndarray
        m.
    s, w : (e, q) ndarray
        Gauss points and weights, m.
    bend, shear, stretch, twist : (e, q) ndarray
        ``E I`` (N m^2), ``kappa G A`` (N), ``E A`` (N) and ``G J`` (N m^2).
    mass, rotary, polar : (e, q) ndarray
        ``rho A`` (kg/m), ``rho I`` and ``rho J`` (kg m).
    """

    def __init__(self, elements: Elements, head: str, kappa: str):
        x, w = _GAUSS
        e = elements
        self.length = e.right - e.left
        self.s = self.length[:, None] * (x + 1) / 2
        self.w = self.length[:, None] * w / 2
        t = (e.left - e.y0)[:, None] + self.s
        t = t / (e.y1 - e.y0)[:, None] if head == "cone" else np.full_like(t, 0.5)
        a = e.outer0[:, None] + t * (e.outer1 - e.outer0)[:, None]
        b = e.inner0[:, None] + t * (e.inner1 - e.inner0)[:, None]
        modulus, nu, density = e.E[:, None], e.nu[:, None], e.density[:, None]
        area = np.pi * (a**2 - b**2)
        second = np.pi / 4 * (a**4 - b**4)
        g = modulus / (2 * (1 + nu))
        self.bend = modulus * second
        # Cowper (1966), J. Appl. Mech. 33, 335: 6 (1 + nu) / (7 + 6 nu)
        factor = (
            shear_coefficient(nu, a, b) if kappa == "hutchinson" else 6 * (1 + nu) / (7 + 6 * nu)
        )
        self.shear = factor * g * area
        self.stretch = modulus * area
        self.twist = 2 * g * second
        self.mass = density * area
        self.rotary = density * second
        self.polar = 2 * self.rotary

    def soften(self, bend: np.ndarray, stretch: np.ndarray, twist: np.ndarray) -> None:
        """Add compliances (e,), rad/(N m), m/N and rad/(N m), spread evenly over the length; shear
        and inertia stay.
        """
        self.bend = 1 / (1 / self.bend + (bend / self.length)[:, None])
        self.stretch = 1 / (1 / self.stretch + (stretch / self.length)[:, None])
        self.twist = 1 / (1 / self.twist + (twist / self.length)[:, None])

    def integral(self, values: np.ndarray) -> np.ndarray:
        """Return the integrals (e, q, k) from the left end to each Gauss point, exact for the
        polynomial through the values there.
        """
        return (self.length / 2)[:, None, None] * (_INTEGRAL @ values)


def bending_matrices(c: Section, shear: bool, rotary: bool, mass: str):
    """Return stiffness and mass (e, n, n) of bending elements on ``(z, thx)`` at both ends, then internal
    unknowns (n is 4, with internal unknowns 5 or 6; N/m, N, N m, and kg, kg m, kg m^2), and their
    deflection and turn at the Gauss points (e, 2, q, n).

    With shear (Timoshenko) the static field has constant shear in an element, which alone converges
    with the square of its length.  Two internal fields, those of a clamped element under a uniform
    force and a uniform moment, lift that to the fourth power; they store no energy together with the
    nodal fields.

    Examples
    --------
    >>> import numpy as np
    >>> from solidgear import Segment
    >>> rod = Segment.cylinder("rod", length=0.6, diameter=0.02)
    >>> section = Section(Elements.of([rod], np.array([0.0, 0.6])), head="cone", kappa="hutchinson")
    >>> k, m, _ = bending_matrices(section, shear=False, rotary=False, mass="consistent")
    >>> round(float(k[0, 0, 0] * 0.6**3 / section.bend[0, 0]), 9)  # 12 E I / L^3
    12.0
    """
    lever, ones = c.length[:, None] - c.s, np.ones_like(c.s)
    none = np.zeros_like(c.s)
    soft = np.stack([1 / c.bend, 1 / c.shear if shear else none], axis=1)
    # Clamped at the left.  With dz/dy = thx a tip force bends by L - s, a tip moment by 1, a
    # uniform force by (L - s)^2 / 2 and a uniform moment by L - s.  First row moments, second row
    # shear forces.
    tip = np.stack([np.stack([lever, ones], -1), np.stack([ones, none], -1)], axis=1)
    spread = np.stack([np.stack([lever**2 / 2, lever], -1), np.stack([lever, none], -1)], axis=1)

    def product(a, weight, b):
        a, b = ((part.reshape(len(part), -1, part.shape[-1])) for part in (a, b))
        return (a * weight.reshape(len(a), -1, 1)).transpose(0, 2, 1) @ b

    def energy(a, b):
        return product(a, c.w[:, None] * soft, b)

    def field(inner):
        """Return deflection and turn along the cantilever for internal moments and forces."""
        turn = c.integral(inner[:, 0] * soft[:, 0, :, None])
        slope = turn + inner[:, 1] * soft[:, 1, :, None]
        return np.stack([c.integral(slope), turn], axis=1)

    resist = np.linalg.inv(energy(tip, tip))
    # rigid motion of the right end less that of the left
    difference = np.zeros((len(lever), 2, 4), lever.dtype)
    difference[:, [0, 1, 0, 1], [0, 1, 2, 3]] = -1.0, -1.0, 1.0, 1.0
    difference[:, 0, 1] = -c.length
    carried = resist @ difference
    k = difference.transpose(0, 2, 1) @ carried
    shape = field(tip) @ carried[:, None]
    shape[:, 0, :, 0] += 1.0
    shape[:, 1, :, 1] += 1.0
    shape[:, 0, :, 1] += c.s
    inertia = np.stack([c.mass, c.rotary if rotary else none], axis=1)
    if mass == "lumped":
        halves = [(c.w[:, None] * inertia)[:, :, part].sum(-1) for part in _HALVES]
        return k, np.concatenate(halves, axis=1)[:, None] * np.eye(4), shape
    if shear:
        spread = spread[..., : 1 + rotary]
        clamped = spread - tip @ (resist @ energy(tip, spread))[:, None]
        size = np.diagonal(energy(clamped, clamped), axis1=1, axis2=2)
        # Brought to the size of the nodal stiffness, for a well-scaled matrix.
        clamped = clamped * np.sqrt(k[:, :1, 0] / size)[:, None, None]
        nodal, n = k, 5 + rotary
        inside = energy(clamped, clamped)
        k = np.zeros((len(lever), n, n), np.result_type(nodal, inside))
        k[:, :4, :4], k[:, 4:, 4:] = nodal, inside
        shape = np.concatenate([shape, field(clamped)], axis=3)
    return k, product(shape, c.w[:, None] * inertia, shape), shape


#: Gauss points of the left and of the right half
_HALVES = (_GAUSS[0] < 0, _GAUSS[0] > 0)


def rod_matrices(c: Section, rigidity, inertia, mass: str):
    """Return stiffness and mass (e, 2, 2) of tapered bars in stretch or twist, ``consistent`` or
    ``lumped``, by ``E A`` and ``rho A``, or ``G J`` and ``rho J``, at the Gauss points; and their
    motion (e, q, 2) there.
    """
    compliance = (c.w / rigidity).sum(axis=1)[:, None, None]
    k = np.array([[1.0, -1.0], [-1.0, 1.0]]) / compliance
    right = c.integral(1 / rigidity[..., None]) / compliance
    shape = np.concatenate([1 - right, right], axis=2)
    m = shape.transpose(0, 2, 1) @ ((c.w * inertia)[..., None] * shape)
    if mass == "lumped":
        m = m.sum(axis=1)[:, None] * np.eye(2)
    return k, m, shape


def surface(e: Elements, lo: np.ndarray, hi: np.ndarray):
    """Return quadrature on the outer surface of parts of elements between two places, m: places (e,
    q) along the shaft, radii there, and weights of the length along the surface, m; and the
    interpolation (e, q, q) from the Gauss points of the element.
    """
    x, w = _GAUSS
    y = (lo + hi)[:, None] / 2 + (hi - lo)[:, None] / 2 * x
    local = (2 * y - (e.left + e.right)[:, None]) / (e.right - e.left)[:, None]
    powers = [np.ones_like(local)]
    for _ in _POWERS[1:]:
        powers.append(powers[-1] * local)
    slope = ((e.outer1 - e.outer0) / (e.y1 - e.y0))[:, None]
    r = e.outer0[:, None] + slope * (y - e.y0[:, None])
    length = (hi - lo)[:, None] / 2 * np.sqrt(1 + slope**2)
    return y, r, w * length, np.stack(powers, axis=-1) @ _THROUGH
