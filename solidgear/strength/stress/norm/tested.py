r"""Fatigue notch factors that DIN 743-2 gives from tests: each a function of the strength.

A factor holds at a diameter of the tests, d_BK, and is turned to that of the part by K_3 (equations
3 and 17). Inputs and results are SI; the norm writes lengths in mm and stress in MPa. Coefficients
agree between two public programs that share no text (hanslhansl/din743, of the norm's edition of
2012; sydgtfzguhgfhtr/ME_Wellennachweis) but for what is said at a function.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from solidgear.strength.stress.din743 import LOADS, Load

#: m; diameters of the tests
KEYED, SPLINED, V_CUT, GROOVED = 40e-3, 29e-3, 15e-3, 30e-3
#: tensile strengths that the norm's table of keyways and press fits covers, Pa
TABLE = (400e6, 1200e6)
#: Rz of the tests of V grooves and rectangular grooves, m
TESTED_ROUGHNESS = 20e-6
#: factor of a second keyway opposite the first
SECOND_KEYWAY = 1.15
#: share of the torsional factor's excess over 1 that bending, and torsion, of a profile have
PROFILES: Mapping[str, tuple[float, float]] = {
    "straight": (0.45, 1.0),
    "serration": (0.65, 1.0),
    "involute": (0.49, 0.75),
}
#: t/d of V grooves between which the norm gives its factor, for a radius of 0.1 mm
V_DEPTH = (0.05, 0.20)
#: A, B, and share of rho* in the radius, of rectangular grooves; largest factor
RECTANGULAR: Mapping[Load, tuple[float, float, float, float]] = {
    "tension": (0.9 * 1.27, 0.9 * 1.17, 2.9, 4.0),
    "bending": (0.9 * 1.14, 0.9 * 1.08, 2.9, 4.0),
    "torsion": (1.48, 0.45, 1.0, 2.5),
}
#: width over depth of a groove below which its factor rises
NARROW = 1.4


def size_of_notch(factor: float, diameter: float) -> float:
    """Return K_3 by the factor of the tests and a diameter, m (DIN 743-2, equation 17).

    Examples
    --------
    >>> [round(size_of_notch(2.5, d), 3) for d in (0.0075, 0.04, 0.15, 0.3)]
    [1.0, 0.956, 0.92, 0.92]
    """
    clipped = min(max(1e3 * diameter, 7.5), 150.0)
    return 1 - 0.2 * math.log10(factor) * math.log10(clipped / 7.5) / math.log10(20)


def at_diameter(factor: float, tested: float, diameter: float) -> float:
    """Return a factor at a diameter, m, from that of the tests (DIN 743-2, equation 3).

    Examples
    --------
    >>> round(at_diameter(2.5, 0.04, 0.04), 3), round(at_diameter(2.5, 0.04, 0.1), 3)
    (2.5, 2.565)
    """
    return factor * size_of_notch(factor, tested) / size_of_notch(factor, diameter)


def keyway(ultimate: float, count: int = 1) -> dict[Load, float]:
    """Return factors of one keyway, or of two opposite each other, by the tensile strength, Pa
    (DIN 743-2, table 1); that for two is put on torsion too, where the programs differ.

    Examples
    --------
    >>> {load: round(beta, 2) for load, beta in keyway(600e6).items()}
    {'tension': 2.47, 'bending': 2.47, 'torsion': 1.48}
    """
    normal = 3.0 * (ultimate / 1e9) ** 0.38
    several = SECOND_KEYWAY if count > 1 else 1.0
    return _alike(several * normal, several * (0.56 * normal + 0.1))


def press_fit(ultimate: float) -> dict[Load, float]:
    """Return factors of a press fit, at the edge of its hub (DIN 743-2, table 1).

    Examples
    --------
    >>> {load: round(beta, 2) for load, beta in press_fit(600e6).items()}
    {'tension': 2.17, 'bending': 2.17, 'torsion': 1.41}
    """
    normal = 2.7 * (ultimate / 1e9) ** 0.43
    return _alike(normal, 0.65 * normal)


def profile(kind: str, ultimate: float) -> dict[Load, float]:
    """Return factors of a splined shaft: straight, serration or involute (DIN 743-2, table 1).

    Examples
    --------
    >>> {load: round(beta, 2) for load, beta in profile("involute", 800e6).items()}
    {'tension': 1.15, 'bending': 1.15, 'torsion': 1.23}
    """
    excess = math.exp(4.2e-7 * (ultimate / 1e6) ** 2) - 1
    bending, torsion = PROFILES[kind]
    return _alike(1 + bending * excess, 1 + torsion * excess)


def v_groove(ultimate: float) -> dict[Load, float]:
    """Return factors of a V groove of 0.1 mm radius, t/d from 0.05 to 0.20 (DIN 743-2, 4.2.3); of
    the additive terms one program alone has them.

    Examples
    --------
    >>> {load: round(beta, 2) for load, beta in v_groove(800e6).items()}
    {'tension': 1.95, 'bending': 1.72, 'torsion': 1.38}
    """
    bending = 0.0923e-8 * ultimate + 0.985
    return {"tension": 0.109e-8 * ultimate + 1.074, "bending": bending, "torsion": 0.8 * bending}


def structure_length(yield_point: float) -> float:
    """Return the radius by which the structure of a steel blunts a corner, rho*, m, by the yield
    point at the size of the part, Pa (DIN 743-2, 4.2.4).

    Examples
    --------
    >>> round(1e3 * structure_length(500e6), 4)
    0.0532
    """
    return 1e-3 * 10 ** -(0.514 + 0.00152e-6 * yield_point)


def rectangular_groove(
    depth: float, width: float, radius: float, yield_point: float
) -> dict[Load, float]:
    """Return factors of a rectangular groove by its depth, width and root radius, m, and the yield
    point at the size of the part, Pa (DIN 743-2, 4.2.4), at most 4, and 2.5 in torsion.

    Examples
    --------
    >>> groove = rectangular_groove(1.25e-3, 1.85e-3, 0.1e-3, 400e6)
    >>> {load: round(beta, 2) for load, beta in groove.items()}
    {'tension': 3.23, 'bending': 2.95, 'torsion': 2.5}
    """
    blunt = structure_length(yield_point)
    narrow = 1.0 if width >= NARROW * depth else 1.08 * (width / depth) ** -0.2
    out: dict[Load, float] = {}
    for load in LOADS:
        constant, slope, share, most = RECTANGULAR[load]
        factor = constant + slope * math.sqrt(depth / (radius + share * blunt))
        out[load] = min(min(factor, most) * narrow, most)
    return out


def _alike(normal: float, torsion: float) -> dict[Load, float]:
    """Return factors of which tension has that of bending."""
    return {"tension": normal, "bending": normal, "torsion": torsion}
