"""Flexibility that a beam lacks at a sharp shoulder.

Stress cannot fill the thick part right behind a step of the outer radius, as a beam lets it.  The
solid is softer there, by the flexibility of a short piece of the thin shaft.  The length of that
piece, in diameters of the thin shaft, depends on the ratio of the diameters and on the kind of load.

The thick part gives: of another material it gives as its modulus has it, and the missing length goes
with E (in twist with G) of the thin part over that of the thick one.  Measured for moduli of 0.2 to
20 times each other and ratios of diameters of 1.2 to 6 (``of_two_materials`` in
``validation/stability/shoulder_step.py``): from 1.5 on, where the thick part is the softer, the
missing length is 0.88 to 1.09 times that; where it is the stiffer, little is missing at all.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from solidgear.core.scene import Material, Segment

#: ratio of diameters, then missing length of the thin shaft over its diameter in bending, stretch
#: and twist: harmonic solid (order 6, four layers) less beam, for a solid steel shaft two diameters
#: long on a thick part of one and a half diameters (``validation/stability/shoulder_step.py``).  In
#: twist the handbooks have 0.125 at a ratio of 2 (Nestorides 1958, A Handbook on Torsional
#: Vibration, sec. 1: junction effect).
MISSING = np.array(
    [
        [1.0, 0.0, 0.0, 0.0],
        [1.05, 0.0079, 0.0048, 0.0049],
        [1.1, 0.0223, 0.0149, 0.0140],
        [1.2, 0.0553, 0.0416, 0.0351],
        [1.3, 0.0860, 0.0714, 0.0549],
        [1.5, 0.1340, 0.1297, 0.0857],
        [1.75, 0.1728, 0.1934, 0.1105],
        [2.0, 0.1968, 0.2460, 0.1257],
        [2.5, 0.2223, 0.3253, 0.1418],
        [3.0, 0.2342, 0.3812, 0.1493],
        [4.0, 0.2440, 0.4537, 0.1555],
        [6.0, 0.2492, 0.5286, 0.1587],
    ]
)

#: ratio of diameters and ratio of moduli: below the first and beyond the second, the stiffer part is
#: no longer the thicker one, and not even the sign of the missing length is that of one material
SMALL_STEP, ALIKE = 1.2, 2.0


def grown(ratio: float, thin: Material, thick: Material) -> tuple[float, float]:
    """Return the factors on the missing length of one material where there are two, in bending and
    stretch, and in twist, at a ratio of diameters; zeros where the missing length is unknown.

    Examples
    --------
    >>> from solidgear.core.scene import STEEL
    >>> aluminium = STEEL.with_changes(E=STEEL.E / 3)
    >>> [round(x, 6) for x in grown(2.0, STEEL, aluminium)], grown(1.1, STEEL, aluminium)
    ([3.0, 3.0], (0.0, 0.0))
    """
    stiffer = thin.E / thick.E
    if ratio < SMALL_STEP and not 1 / ALIKE <= stiffer <= ALIKE:
        return 0.0, 0.0
    return stiffer, stiffer * (1 + thick.nu) / (1 + thin.nu)


@dataclass(frozen=True)
class Hinge:
    """Compliance of a shoulder, to be added to the first element of the thick part."""

    y: float  #: of the step, m
    ahead: bool  #: whether the thick part lies at larger y
    bend: float  #: rad/(N m)
    stretch: float  #: m/N
    twist: float  #: rad/(N m)


def hinges(segments: Sequence[Segment]) -> tuple[Hinge, ...]:
    """Return the compliances of all steps of the outer radius between segments that lie end to end.

    Examples
    --------
    >>> from solidgear import Segment
    >>> thin = Segment.cylinder("thin", length=0.2, diameter=0.05)
    >>> thick = Segment.cylinder("thick", y0=0.2, length=0.2, diameter=0.1)
    >>> (step,) = hinges((thin, thick))
    >>> stiff = thin.material.E * 3.141592653589793 / 64 * 0.05**4
    >>> step.ahead, round(step.bend * stiff / 0.05, 4)  # of the thin diameter
    (True, 0.1968)
    """
    out = []
    for a, b in zip(segments, segments[1:]):
        ahead = b.outer0 > a.outer1
        thin, thick = (a, b) if ahead else (b, a)
        outer, inner = (a.outer1, a.inner1) if ahead else (b.outer0, b.inner0)
        ratio = max(a.outer1, b.outer0) / outer
        if ratio <= 1 + 1e-9:
            continue
        bend, stretch, twist = (
            2 * outer * np.interp(ratio, MISSING[:, 0], column) for column in MISSING.T[1:]
        )
        material = thin.material
        straight, turned = grown(ratio, material, thick.material)
        second = np.pi / 4 * (outer**4 - inner**4)
        area = np.pi * (outer**2 - inner**2)
        shear = material.E / (2 * (1 + material.nu))
        out.append(
            Hinge(
                b.y0,
                ahead,
                float(straight * bend / (material.E * second)),
                float(straight * stretch / (material.E * area)),
                float(turned * twist / (2 * shear * second)),
            )
        )
    return tuple(out)
