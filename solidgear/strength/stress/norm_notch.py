"""Notches with factors of the norm alone: from tests, by form factors, and several at one place."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from solidgear.strength.stress import din743
from solidgear.strength.stress.din743 import LOADS, Load
from solidgear.strength.stress.nominal import CrossSection, NominalStress, nominal_stress
from solidgear.strength.stress.norm.tested import at_diameter, size_of_notch
from solidgear.strength.stress.rated_notch import ByLoad, NotchFactors, RatedNotch, Steel
from solidgear.strength.stress.rating_lines import BY_GRADIENT, BY_GRADIENT_HARD, Line

#: source of the factor of notches that meet
TOGETHER = "assumed: FKM guideline, of notches that meet: 1 + sum of (beta - 1)"
Tested = Callable[[Steel], dict[Load, float]]


@dataclass(frozen=True)
class Section:
    """The section that the nominal stress of a notch is taken in."""

    outer: float  #: diameter, m
    inner: float = 0.0  #: of the bore, m
    hole: float = 0.0  #: of a cross hole, whose strip the section lacks, m

    def nominal(self, forces: np.ndarray) -> NominalStress:
        """Return the nominal stress under section forces (6,); of a cross hole where it is largest
        as the shaft turns (DIN 743-2, 5.2.3).
        """
        section = CrossSection(self.outer / 2, self.inner / 2)
        plain = nominal_stress(section, forces)
        if not self.hole:
            return plain
        strip = self.hole * (self.outer - self.inner)
        cubes = self.hole * (self.outer**3 - self.inner**3)
        second = section.second_moment - cubes / 12
        twist = 2 * section.second_moment - cubes / 12
        radius = self.outer / 2
        return replace(
            plain,
            tension=float(forces[1] / (section.area - strip)),
            bending=float(math.hypot(forces[3], forces[5]) * radius / second),
            torsion=float(forces[4] * radius / twist),
        )


@dataclass(frozen=True)
class NormNotch:
    """What all of these notches have."""

    section: Section
    source: str  #: of its factors
    revolved: bool = field(kw_only=True)  #: whether it runs around the shaft

    @property
    def diameter(self) -> float:
        """Diameter of nominal stress and of K_2, m."""
        return self.section.outer

    @property
    def hollow(self) -> bool:
        """Whether the section has a bore."""
        return self.section.inner > 0


@dataclass(frozen=True)
class NotchByTests(NormNotch):
    """A notch with factors from tests at a diameter, m, and a roughness, m, or zero where it is in
    the factors.
    """

    tested: Tested
    tested_diameter: float
    tested_roughness: float | None

    def factors(self, steel: Steel) -> NotchFactors:
        """Return the notch factors in a steel."""
        tested = self.tested(steel)
        beta = {k: at_diameter(tested[k], self.tested_diameter, self.diameter) for k in LOADS}
        beta = {load: max(factor, 1.0) for load, factor in beta.items()}
        there = {k: size_of_notch(tested[k], self.tested_diameter) for k in LOADS}
        here = {k: size_of_notch(tested[k], self.diameter) for k in LOADS}
        diameter = f"d_BK {1e3 * self.tested_diameter:g} mm"
        lines = (
            Line("beta (d_BK)", tested, f"{self.source}, {diameter}"),
            Line("K_3 (d_BK)", there),
            Line("K_3 (d)", here),
            Line("beta", beta, "DIN 743-2, eq. 3: beta(d_BK) K_3(d_BK)/K_3(d)"),
        )
        return NotchFactors(beta, rise=beta, peak=None, lines=lines)


@dataclass(frozen=True)
class NotchByForm(NormNotch):
    """A notch with form factors and stress gradients, 1/m, by formulas."""

    form: ByLoad
    gradient: ByLoad

    @property
    def tested_roughness(self) -> float | None:
        """None, since its factors are not of tests."""
        return None

    def factors(self, steel: Steel) -> NotchFactors:
        """Return the notch factors in a steel."""
        support = {
            load: din743.support(self.gradient[load], steel.yield_point, steel.hard)
            for load in LOADS
        }
        beta = {load: max(self.form[load] / support[load], 1.0) for load in LOADS}
        lines = (
            Line("alpha", self.form, self.source),
            Line("G'", self.gradient, "DIN 743-2, table 3"),
            Line("n", support, BY_GRADIENT_HARD if steel.hard else BY_GRADIENT),
            Line("beta", beta),
        )
        return NotchFactors(beta, rise=self.form, peak=self.form, lines=lines)


@dataclass(frozen=True)
class MeetingNotches:
    """A notch that others meet: the excess of every factor over one adds (FKM guideline, 6th ed.
    2012, of notches that meet), on the section of the first.
    """

    first: RatedNotch
    others: tuple[RatedNotch, ...]

    @property
    def diameter(self) -> float:
        """Diameter of nominal stress and of K_2, m."""
        return self.first.diameter

    @property
    def hollow(self) -> bool:
        """Whether the section has a bore."""
        return self.first.hollow

    @property
    def revolved(self) -> bool:
        """Whether all run around the shaft."""
        return all(notch.revolved for notch in (self.first, *self.others))

    @property
    def tested_roughness(self) -> float | None:
        """Roughness of the tests of the first."""
        return self.first.tested_roughness

    def factors(self, steel: Steel) -> NotchFactors:
        """Return the notch factors in a steel."""
        each = [notch.factors(steel) for notch in (self.first, *self.others)]
        beta = {load: 1 + sum(part.notch[load] - 1 for part in each) for load in LOADS}
        lines = (line for part in each for line in part.lines)
        # the others alone may raise the yield point by less
        return NotchFactors(beta, each[0].rise, None, (*lines, Line("beta", beta, TOGETHER)))
