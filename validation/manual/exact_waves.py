"""Waves in a circular cylinder: the frequency equation of Pochhammer and Chree.

Nothing is imported from the library that is held to it.  SI units throughout.
"""

from __future__ import annotations

import numpy as np
from scipy.special import jv, jvp

from validation.manual.exact import STEEL, Elastic, zeros


def bending_wave(wave: float, radius: float, material: Elastic = STEEL) -> float:
    """Frequency, Hz, of the lowest bending wave ``exp(i k y)`` of a cylinder, k = ``wave`` in 1/m.

    Looked for between a half and the whole of Euler's frequency, ``k^2 sqrt(E a^2 / 4 rho)``.
    """
    euler = wave**2 * np.sqrt(material.E * radius**2 / 4 / material.density)

    def equation(omega: float) -> float:
        return _traction(omega, wave, radius, material).imag

    return zeros(equation, 0.5 * euler, euler, 60)[0] / (2 * np.pi)


def _traction(omega: float, wave: float, a: float, material: Elastic) -> complex:
    """Determinant of the tractions of a free lateral surface, one wave around.

    From ``u = grad phi + curl(chi e_y) + curl curl(psi e_y)`` with ``phi = J_1(p r) cos t cos ky``,
    ``chi = J_1(q r) sin t cos ky``, ``psi = J_1(q r) cos t sin ky``, ``p^2 = w^2 / c_l^2 - k^2`` and
    ``q^2 = w^2 / c_s^2 - k^2`` (Love, Theory of Elasticity, sec. 199 to 202).
    """
    lame = material.E * material.nu / (1 + material.nu) / (1 - 2 * material.nu)
    fast = (lame + 2 * material.G) / material.density
    p = np.sqrt(complex(omega**2 / fast - wave**2))
    q = np.sqrt(complex(omega**2 / material.shear_speed**2 - wave**2))
    f, df, ddf = (s * jvp(1, p * a, n) if n else jv(1, p * a) for n, s in enumerate((1, p, p**2)))
    h, dh, ddh = (s * jvp(1, q * a, n) if n else jv(1, q * a) for n, s in enumerate((1, q, q**2)))
    k = wave
    # a column for each potential: displacements and their derivatives with the radius
    ur = np.array([df, h / a, k * dh])
    ut = np.array([-f / a, -dh, -k * h / a])
    uy = np.array([-k * f, 0, q**2 * h])
    ur_r = np.array([ddf, dh / a - h / a**2, k * ddh])
    ut_r = np.array([-df / a + f / a**2, -ddh, -k * dh / a + k * h / a**2])
    uy_r = np.array([-k * df, 0, q**2 * dh])
    # strains where u_r ~ cos t cos ky, u_t ~ sin t cos ky, u_y ~ cos t sin ky
    dilation = ur_r + (ut + ur) / a + k * uy
    normal = lame * dilation + 2 * material.G * ur_r
    around = material.G * (-ur / a + ut_r - ut / a)
    along = material.G * (-k * ur + uy_r)
    rows = np.array([normal, around, along]) * a**2 / material.G
    return complex(np.linalg.det(rows / np.abs(rows).max(axis=0)))
