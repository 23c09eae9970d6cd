"""Doubt that measured resonances are those of the part that a scene describes.

A modulus or a density that is wrong moves all frequencies of a part by one factor. The scatter
beside it is small: 0.09 to 0.5 % of the five measured bodies (validation/experiments), and below
0.9 % of nine in ten random shafts whose Poisson's ratio is anywhere from 0.25 to 0.34 where the
scene has 0.3, or whose every length and diameter is 0.5 % off. Peaks of another shaft, laid beside
the modes as well as may be, keep 5 % in the median.

Where peaks scatter so, a modulus that is far off is tried too, from half to twice the one of the
scene.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtri, stdtrit

from solidgear.measured.alignment import SHIFTS, Alignment, Peak, ShapeLikeness, align

#: largest scatter beside a common shift, relative, that is left of one part
SAME_PART = 0.01
#: pairs that a scatter takes, and the share of resonances with a mode below which most have none
FEWEST, MOST_OF_THEM = 3, 0.5
#: shifts of logarithms of a modulus that is far off, half to twice; they are believed where this share
#: of the resonances, and as many as that, then scatter by less than those of one part
FAR_SHIFTS = tuple(sign * k / 20 for k in range(3, 8) for sign in (-1, 1))
BELIEVED, FEWEST_FAR = 0.75, 4


@dataclass(frozen=True)
class Common:
    """Differences of pairs as a shift that is common to all and a scatter beside it, relative."""

    count: int
    #: off, reach: shift, computed over measured, and how far it may be off, of 95 % (Student)
    off: float
    reach: float
    #: scatter, low, high: standard deviation, and the ends of its interval of 95 % (chi-square)
    scatter: float
    low: float
    high: float

    @classmethod
    def of(cls, relative: Sequence[float]) -> Common | None:
        """Return estimates from differences of independent pairs; None from too few."""
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
        shift = f"{100 * self.off:+.2g} ± {100 * self.reach:.1g} %"
        scatter = (
            f"{100 * self.scatter:.2g} % scatter remains ({self.count} sure pairs; with 95 %, "
            f"{100 * self.low:.2g} to {100 * self.high:.2g} %)"
        )
        if abs(self.off) <= self.reach:
            return f"No common shift ({shift}); {scatter}."
        return f"Common shift {shift}, as from a wrong modulus, density or length; {scatter}."


@dataclass(frozen=True)
class Likeness:
    """Likeness of measured resonances to those of one part, whatever the modulus."""

    plain_names = ("in_question", "scatter", ("scatter_at_least", "least"))

    #: resonances, pairs: measured, and those of them that have a mode
    resonances: int
    pairs: int
    shift: float  #: common to all logarithms, measured less computed
    scatter: float  #: standard deviation beyond the shift and the stated uncertainties

    @classmethod
    def of(cls, alignment: Alignment) -> Likeness:
        """Return the likeness by the pairs that are likelier than none."""
        paired = alignment.pairs.max(axis=1, initial=0.0) >= alignment.spurious
        return cls(len(paired), int(paired.sum()), alignment.shift, alignment.scatter)

    @property
    def least(self) -> float:
        """Lower end of the interval of 95 % of the scatter (chi-square)."""
        freedom = self.pairs - 1
        if freedom < 1:
            return 0.0
        return self.scatter * math.sqrt(freedom / float(chdtri(freedom, 0.025)))

    @property
    def scattered(self) -> bool:
        """Return whether they scatter by more than those of one part."""
        return self.pairs >= FEWEST and self.least > SAME_PART

    @property
    def lonely(self) -> bool:
        """Return whether most have no mode."""
        return self.resonances >= FEWEST and self.pairs <= MOST_OF_THEM * self.resonances

    @property
    def believed(self) -> bool:
        """Return whether a shift that is far off explains the resonances."""
        many = self.pairs > BELIEVED * self.resonances
        return many and self.pairs >= FEWEST_FAR and self.scatter < SAME_PART

    @property
    def in_question(self) -> bool:
        """Return whether they may be those of another part."""
        return self.scattered or self.lonely

    @property
    def sentence(self) -> str:
        """Doubt that they are of the part of the scene; empty where there is none."""
        scatter_clause = (
            f"{self.pairs} pairs scatter by {100 * self.scatter:.2g} % about their common shift "
            f"(at least by {100 * self.least:.2g} %, with 95 % confidence), and a wrong modulus "
            f"or density of the same part leaves {100 * SAME_PART:.0f} % at most"
        )
        if self.scattered:
            return (
                f"This may be another part: {scatter_clause}. If it is the right one, dimensions, masses or "
                "bearings of the scene are wrong."
            )
        if self.lonely:
            return (
                f"This may be another part: {self.pairs or 'none'} of {self.resonances} resonances "
                f"{'has' if self.pairs < 2 else 'have'} a mode."
            )
        if self.scatter > SAME_PART and self.pairs > 1:
            return f"Too few pairs to show that this is the part in the scene: {scatter_clause}."
        return ""

    @property
    def condition(self) -> str:
        """Modulus that this part would have; empty where that is no surprise."""
        if self.sentence or abs(self.shift) < max(SHIFTS):
            return ""
        return (
            "They belong to this part only if its modulus over its density is "
            f"{math.exp(2 * self.shift):.2g} times the scene's."
        )


def alignment_of(
    measured: Sequence[Peak], computed: Sequence[Peak], shapes: ShapeLikeness | None = None
) -> Alignment:
    """Return the likeliest alignment; of a modulus that is far off where no other can be of one
    part.
    """
    near = align(measured, computed, shapes)
    if not Likeness.of(near).sentence:
        return near
    far = align(measured, computed, shapes, FAR_SHIFTS)
    return far if Likeness.of(far).believed else near
