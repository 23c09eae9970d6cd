"""A fillet as a rating by DIN 743 sees it: form factors and gradients of the shaft's solid, beside
the formulas of the norm.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from solidgear.strength.stress import din743
from solidgear.strength.stress.din743 import LOADS, Load
from solidgear.strength.stress.rated_notch import NotchFactors, Steel
from solidgear.strength.stress.rating_lines import BY_GRADIENT_HARD, Line

if TYPE_CHECKING:
    from solidgear.strength.stress.notch import FilletFactors

#: lines that are attributes of a :class:`FatigueFactor`
FACTORS = {
    "alpha": "form",
    "alpha (norm)": "norm_form",
    "G'": "gradient",
    "G' (norm)": "norm_gradient",
    "n": "support",
    "beta": "notch",
    "beta (norm)": "norm_notch",
}


@dataclass(frozen=True)
class FatigueFactor:
    """Fatigue notch factor of one load: form factor over support number."""

    #: form, gradient, support, notch: kt and G' (1/m) of the solid, n and Kf = beta
    form: float
    gradient: float
    support: float
    notch: float
    #: norm_form, norm_gradient, norm_notch: alpha and G' by the norm's formulas, and beta from them
    norm_form: float
    norm_gradient: float
    norm_notch: float


@dataclass(frozen=True)
class FilletNotch:
    """A fillet at the root of a step, its form factors raised by so many error bars."""

    fillet: FilletFactors
    large: float  #: larger diameter of the shoulder, m
    bars: float = 0.0

    @property
    def diameter(self) -> float:
        """Diameter of the cylinder that the fillet runs into, m."""
        return 2 * self.fillet.section.outer

    @property
    def hollow(self) -> bool:
        """Whether it has a bore."""
        return self.fillet.section.inner > 0

    @property
    def revolved(self) -> bool:
        """Whether the notch runs around the shaft."""
        return True

    @property
    def tested_roughness(self) -> float | None:
        """None, since its factors are not of tests."""
        return None

    def by_load(self, steel: Steel) -> dict[Load, FatigueFactor]:
        """Return fatigue notch factors in a steel."""
        small, radius = 2 * self.fillet.corner.r, self.fillet.corner.radial
        out: dict[Load, FatigueFactor] = {}
        for load in LOADS:
            factor = self.fillet.factors[load]
            form = factor.value + self.bars * factor.bar
            support = din743.support(factor.gradient, steel.yield_point, steel.hard)
            alpha = din743.form_factor(load, self.large, small, radius)
            slope = din743.gradient(load, self.large, small, radius)
            norm = max(alpha / din743.support(slope, steel.yield_point, steel.hard), 1.0)
            notch = max(form / support, 1.0)
            out[load] = FatigueFactor(form, factor.gradient, support, notch, alpha, slope, norm)
        return out

    def factors(self, steel: Steel) -> NotchFactors:
        """Return the notch factors in a steel."""
        factors = self.by_load(steel)
        return NotchFactors(
            notch={load: factor.notch for load, factor in factors.items()},
            rise={load: factor.form for load, factor in factors.items()},
            peak={load: factor.form for load, factor in factors.items()},
            lines=tuple(_lines(factors, steel)),
        )


def _lines(factors: Mapping[Load, FatigueFactor], steel: Steel) -> list[Line]:
    sources = {"n": BY_GRADIENT_HARD} if steel.hard else {}
    return [
        Line(symbol, {k: getattr(f, name) for k, f in factors.items()}, sources.get(symbol, ""))
        for symbol, name in FACTORS.items()
    ]
