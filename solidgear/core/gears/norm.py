r"""Tooth stiffness and face load factor by the norm, without a solve (ISO 6336-1:2019, method B).

The theoretical single stiffness is Weber and Banaschek's for a solid wheel, as a series in the virtual
numbers of teeth ``zn = z / (cos^2 beta_b cos beta)`` and the profile shifts:

    q' = 0.04723 + 0.15551 / zn1 + 0.25791 / zn2 - 0.00635 x1 - 0.11654 x1 / zn1 - 0.00193 x2
         - 0.24188 x2 / zn2 + 0.00529 x1^2 + 0.00182 x2^2        (mm um/N),
    c'th = 1 / q',    c' = c'th CM CR CB cos beta,    c_gamma_alpha = c' (0.75 eps_alpha + 0.25),

with CM = 0.8, which measurements ask for, CR = 1 for solid wheels and CB for another rack; below
100 N/mm c' falls with the fourth root of the line load.  All of them count the transverse error per
transverse force.  They are those of steel; for other materials they are multiplied by

    E / E_steel,    E = 2 E1 E2 / (E1 + E2),    E_steel = 206 GPa.

A face that lies askew by F over its width b, under the force per width q, has the face load factor

    K_H beta = 1 + F c / (2 q)  up to 2,  sqrt(2 F c / q)  beyond,    c = 0.85 c_gamma_alpha,

for then the load falls to nothing within the face (clause 7).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, degrees, sqrt

from solidgear.core.gears.wheel_pair import WheelPair

#: N/(mm um) in N/m per m
UNIT = 1e9
#: modulus of elasticity of the norm's steel, N/m^2
STEEL = 2.06e11
#: what measurements leave of the theory; line load below which it falls, N/m
CORRECTION, LEAST_LINE_LOAD = 0.8, 1e5
#: of the mesh stiffness that counts along the face
ALONG_FACE = 0.85


@dataclass(frozen=True)
class NormStiffness:
    """Stiffnesses of a pair of wheels with solid bodies, N/m per m of face."""

    theoretical: float  #: c'th
    single: float  #: c'
    mesh: float  #: c_gamma_alpha


def norm_stiffness(
    wheels: WheelPair,
    line_load: float | None = None,
    moduli: tuple[float, float] = (STEEL, STEEL),
) -> NormStiffness:
    """Return the stiffnesses by the norm; `line_load` in N/m of the transverse force per face width,
    by default large enough, `moduli` of elasticity of both wheels in N/m^2.

    Examples
    --------
    >>> from solidgear.core.gears.wheel import Rack, Wheel
    >>> rack = Rack(dedendum=1.2)
    >>> steel = norm_stiffness(WheelPair(Wheel(23, 4e-3, rack=rack), Wheel(57, 4e-3, rack=rack)))
    >>> [round(c / 1e9, 3) for c in (steel.theoretical, steel.single, steel.mesh)]
    [17.089, 13.671, 20.686]
    """
    first, second = wheels.first, wheels.second
    base_helix, helix = wheels.base_helix, first.helix_angle
    z1 = first.count / (cos(base_helix) ** 2 * cos(helix))
    x1, x2 = first.shift, second.shift
    if second.teeth < 0:  # a ring counts as a rack
        z2, x2 = float("inf"), 0.0
    else:
        z2 = second.count / (cos(base_helix) ** 2 * cos(helix))
    softness = 0.04723 + 0.15551 / z1 + 0.25791 / z2 - 0.00635 * x1 - 0.11654 * x1 / z1
    softness += -0.00193 * x2 - 0.24188 * x2 / z2 + 0.00529 * x1**2 + 0.00182 * x2**2
    theoretical = UNIT / softness * material_factor(*moduli)
    single = theoretical * CORRECTION * cos(helix) * _rack_factor(wheels)
    if line_load is not None and line_load < LEAST_LINE_LOAD:
        single *= (line_load / LEAST_LINE_LOAD) ** 0.25
    return NormStiffness(theoretical, single, single * (0.75 * wheels.contact_ratio + 0.25))


def material_factor(first: float, second: float) -> float:
    """Return E / E_steel of wheels with these moduli of elasticity, N/m^2.

    Examples
    --------
    >>> round(material_factor(206e9, 3e9), 4)
    0.0287
    """
    return 2 * first * second / (first + second) / STEEL


def _rack_factor(wheels: WheelPair) -> float:
    """Return CB of a rack that is not the one of ISO 53 with a dedendum of 1.2, the mean of both."""
    factors = [
        (1 + 0.5 * (1.2 - wheel.rack.dedendum))
        * (1 - 0.02 * (20 - degrees(wheel.rack.pressure_angle)))
        for wheel in (wheels.first, wheels.second)
    ]
    return sum(factors) / 2


def norm_face_load_factor(askew: float, line_load: float, stiffness: float) -> float:
    """Return K_H beta of a face askew by `askew`, m over its width, under a transverse force per width,
    N/m, with the mesh stiffness c_gamma_alpha, N/m per m.

    Examples
    --------
    >>> round(norm_face_load_factor(10e-6, 300e3, 20e9), 3)
    1.283
    """
    share = abs(askew) * ALONG_FACE * stiffness / (2 * line_load)
    return 1 + share if share <= 1 else sqrt(4 * share)
