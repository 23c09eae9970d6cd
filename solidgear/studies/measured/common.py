"""Differences between measured and computed frequencies: common to all, and what is left beside it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtri, stdtrit

#: pairs from which on both are told
FEWEST = 3


@dataclass(frozen=True)
class Common:
    """Differences of pairs as a shift that is common to all and a scatter beside it, relative.

    Attributes
    ----------
    off, reach : float
        Shift, computed over measured, and how far it may be off, of 95 % (Student).
    scatter, low, high : float
        Standard deviation, and the ends of its interval of 95 % (chi-square).
    """

    count: int
    off: float
    reach: float
    scatter: float
    low: float
    high: float

    @classmethod
    def of(cls, relative: Sequence[float]) -> Common | None:
        """Estimates from differences of independent pairs; None from too few."""
        count, free = len(relative), len(relative) - 1
        if count < FEWEST:
            return None
        scatter = float(np.std(relative, ddof=1))
        reach = float(stdtrit(free, 0.975)) * scatter / math.sqrt(count)
        low, high = (scatter * math.sqrt(free / float(chdtri(free, p))) for p in (0.025, 0.975))
        return cls(count, float(np.mean(relative)), reach, scatter, low, high)

    @property
    def sentence(self) -> str:
        """Conclusion."""
        told = f"{100 * self.off:+.2g} ± {100 * self.reach:.1g} %"
        left = (
            f"{100 * self.scatter:.2g} % is left beside it ({self.count} sure pairs; with 95 %, "
            f"{100 * self.low:.2g} to {100 * self.high:.2g} %)"
        )
        if abs(self.off) <= self.reach:
            return f"No shift is common to all ({told}); {left}."
        return (
            f"Common to all is {told}, as a modulus, a density or a length that is not right makes it; "
            f"{left}."
        )
