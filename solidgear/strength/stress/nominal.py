r"""Nominal stress of plain cross-sections under section forces.

    sigma_N = N / A,   sigma_b = M a / I,   tau_t = T a / (2 I),   tau_q = q Q / A

with a the radius of the surface, M and Q the sizes of both components together, and q from 4/3
(solid) to 2 (thin tube), the largest shear at the neutral axis (Timoshenko and Gere, Mechanics of
Materials, 5.9). Loads stand still and the shaft turns: at every point of the surface bending is an
amplitude and the rest a mean.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core import TOUCH

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from solidgear.core.scene import Segment
    from solidgear.strength.stress.section_forces import SectionForces

#: name of the place where the bending moment is largest between loads
LARGEST = "largest M"


@dataclass(frozen=True)
class CrossSection:
    """A ring or a disc."""

    #: outer, inner: radii, m; an inner one of 0 is solid
    outer: float
    inner: float

    @property
    def area(self) -> float:
        """m^2."""
        return math.pi * (self.outer**2 - self.inner**2)

    @property
    def second_moment(self) -> float:
        """Of the area about a diameter, m^4."""
        return math.pi / 4 * (self.outer**4 - self.inner**4)

    @property
    def shear_peak(self) -> float:
        """Largest shear stress over the mean under a transverse force.

        Examples
        --------
        >>> round(CrossSection(0.02, 0.0).shear_peak, 4), round(CrossSection(1.0, 0.999).shear_peak, 3)
        (1.3333, 2.0)
        """
        a, b = self.outer, self.inner
        return 4 / 3 * (a * a + a * b + b * b) / (a * a + b * b)


@dataclass(frozen=True)
class NominalStress:
    """Nominal stress of a cross-section at a radius, in Pa."""

    tension: float  #: N / A, with its sign: a mean
    #: not negative: the amplitude where the shaft turns under loads that stand still
    bending: float
    torsion: float  #: T a / (2 I), with its sign: a mean
    shear: float  #: of the transverse force, at the neutral axis, not negative


@dataclass(frozen=True)
class NominalRow:
    """A cross-section on one side of a place, with forces and stress."""

    y: float  #: m
    segment: str
    names: str  #: of the loads there
    section: CrossSection
    forces: np.ndarray  #: (6,) Q_x, N, Q_z, M_x, T, M_z, N and N m
    stress: NominalStress


def nominal_stress(
    section: CrossSection, forces: np.ndarray, radius: float | None = None
) -> NominalStress:
    """Return the nominal stress of a cross-section under section forces (6,), N and N m, at a
    radius of the surface, m, by default the outer one.

    Examples
    --------
    A shaft of 40 mm under 1 kN m of torque: T / W_t = 16 T / (pi d^3)

    >>> told = nominal_stress(CrossSection(0.02, 0.0), np.array([0, 0, 0, 0, 1000.0, 0]))
    >>> round(told.torsion / 1e6, 3)
    79.577
    """
    a = section.outer if radius is None else radius
    area, second = section.area, section.second_moment
    return NominalStress(
        float(forces[1] / area),
        float(math.hypot(forces[3], forces[5]) * a / second),
        float(forces[4] * a / (2 * second)),
        float(section.shear_peak * math.hypot(forces[0], forces[2]) / area),
    )


def nominal_rows(
    segments: Sequence[Segment],
    forces: SectionForces,
    uneven: Sequence[tuple[float, float]] = (),
) -> tuple[NominalRow, ...]:
    """Return cross-sections on both sides of every place where a load acts, a segment ends or the
    bending moment is largest, in the order of their places, the side before each first; none in
    stretches that are uneven, m, which are neither rings nor discs.
    """
    ends = [segment.y1 for segment in segments[:-1]]
    names = {y: name for y, name in zip(forces.y.tolist(), forces.names) if name}
    if forces.peak is not None:
        names[forces.peak] = LARGEST
    loaded = np.array([*names, np.inf])
    marks = sorted([*names, *(y for y in ends if np.abs(loaded - y).min() > TOUCH)])
    rows = []
    for y in marks:
        for segment, six in _sides(segments, forces, y):
            inside = min(max(y, segment.y0 + 2 * TOUCH), segment.y1 - 2 * TOUCH)
            if any(lo < inside < hi for lo, hi in uneven):
                continue
            inner, outer = segment.radius_at(min(max(y, segment.y0), segment.y1))
            section = CrossSection(outer, inner)
            stress = nominal_stress(section, six)
            rows.append(NominalRow(y, segment.name, names.get(y, ""), section, six, stress))
    return tuple(rows)


def _sides(
    segments: Sequence[Segment], forces: SectionForces, y: float
) -> Iterator[tuple[Segment, np.ndarray]]:
    """Yield the segment and section forces just before a place and just beyond it; once where both
    agree.
    """
    before = next((s for s in segments if s.y0 + TOUCH < y <= s.y1 + TOUCH), None)
    after = next((s for s in segments if s.y0 - TOUCH <= y < s.y1 - TOUCH), None)
    k = int(np.abs(forces.y - y).argmin())
    loaded = abs(forces.y[k] - y) <= TOUCH and bool(forces.names[k])
    if before is not None:
        yield before, forces.left[k] if loaded else forces.at(y)
    if after is not None and (after is not before or loaded):
        yield after, forces.right[k] if loaded else forces.at(y)
