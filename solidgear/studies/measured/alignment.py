"""Which measured resonance is which computed mode, by frequencies, multiplicities and, where they
were measured, shapes, and how sure that is.

Both lists ascend. They are laid beside each other by a hidden Markov model: a step takes one of
each (the same mode), two measured and one computed (a pair that was measured split), one measured
and two computed (two modes too near each other to be told apart), two of each crosswise, or one of
either alone (a spurious peak; a mode that was missed). Logarithms of frequencies of one mode differ
by a common shift, such as that of a modulus which is not known well, and a scatter; both are found
with the pairing (expectation maximisation). Forward and backward sums (Rabiner 1989, Proc. IEEE 77,
257, eqs. 19 to 27) give the probability of every pair, which is what is told.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

#: how likely steps are before any frequency is looked at: one of each, a pair measured split, two
#: computed modes under one peak, a peak or a mode alone
SAME, SPLIT, MERGED, SPURIOUS, MISSED = 0.8, 0.02, 0.02, 0.03, 0.12
#: two crosswise: scatter of both alone decides whether they changed places
CROSSED = SAME**2
#: a single resonance where a pair was computed (a split pair of which one was seen), and a pair
#: where a single one was
HALF, DOUBLE = 0.2, 0.02
#: of a mode called by another family than the computed one
RENAMED = 1e-3
#: what a MAC less than one by the first costs, as a likelihood, and the least it is brought to: noise
#: and a plane a little off leave 0.9 of a shape, another mode less than a half
UNLIKE, OTHER = 0.05, 1e-4
#: shifts of logarithms that are begun with, and the scatter: a modulus is 20 % off at most
SHIFTS, SCATTER = (-0.1, -0.05, -0.02, 0.0, 0.02, 0.05, 0.1), 0.02
#: least scatter; rounding of printed frequencies
LEAST = 2e-5
#: a frequency this many scatters from where it belongs is another
FAR = 6.0
#: rounds until shift and scatter have settled, and starts that are followed
ROUNDS, TRIED = 12, 2


@dataclass(frozen=True)
class Peak:
    """A measured resonance, or a computed mode, as the pairing sees it.

    Attributes
    ----------
    log_frequency : float
    width : float
        Standard deviation of that.
    multiplicity : int or None
        None where nobody looked.
    family : str
        Empty where it is not known.
    """

    log_frequency: float
    width: float
    multiplicity: int | None = None
    family: str = ""


@dataclass(frozen=True, eq=False)
class Alignment:
    """Probabilities of pairs.

    Attributes
    ----------
    pairs : (n, m) ndarray
        That a measured resonance is a computed mode.
    spurious : (n,) ndarray
        That a measured one is none of those computed.
    missed : (m,) ndarray
        That a computed one was not measured.
    shift, scatter : float
        Of logarithms, measured less computed.
    """

    pairs: np.ndarray
    spurious: np.ndarray
    missed: np.ndarray
    shift: float
    scatter: float


#: numbers of measured and computed that a step takes, its log-likelihood, and the pairs it makes
_Step = tuple[int, int, float, tuple[tuple[int, int], ...]]


def align(
    measured: Sequence[Peak], computed: Sequence[Peak], mac: np.ndarray | None = None
) -> Alignment:
    """Lay measured resonances beside computed modes, both by ascending frequency, with the MAC of
    every measured shape (rows) and every mode where there is one.

    Examples
    --------
    >>> found = [Peak(np.log(f), 1e-3) for f in (100.0, 155.0, 301.0)]
    >>> modes = [Peak(np.log(f), 1e-3) for f in (101.0, 156.0, 220.0, 303.0)]
    >>> one = align(found, modes)
    >>> [int(row.argmax()) for row in one.pairs], bool(one.missed[2] > 0.99)
    ([0, 1, 3], True)
    """
    starts = sorted(
        SHIFTS, key=lambda shift: -_Lattice(measured, computed, shift, SCATTER, mac).total
    )
    ends = [_settled(measured, computed, shift, mac) for shift in starts[:TRIED]]
    return max(ends, key=lambda lattice: lattice.total).alignment()


def _settled(
    measured: Sequence[Peak], computed: Sequence[Peak], shift: float, mac: np.ndarray | None
) -> _Lattice:
    """Sums once shift and scatter have settled from a start."""
    apart = np.subtract.outer(
        [one.log_frequency for one in measured], [one.log_frequency for one in computed]
    )
    lattice = _Lattice(measured, computed, shift, SCATTER, mac)
    for _ in range(ROUNDS):
        pairs = lattice.alignment().pairs
        weight = float(pairs.sum())
        if weight < 1e-6:
            break
        shift = float((pairs * apart).sum() / weight)
        # drawn towards what is usual by a tenth of a pair: a scatter of none has no likelihood
        square = float((pairs * (apart - shift) ** 2).sum()) + SCATTER**2 / 10
        scatter = max(math.sqrt(square / (weight + 0.1)), LEAST)
        moved = abs(shift - lattice.shift) + abs(scatter - lattice.scatter)
        lattice = _Lattice(measured, computed, shift, scatter, mac)
        if moved < 1e-3 * scatter:
            break
    return lattice


class _Lattice:
    """Forward and backward sums over all ways to lay two lists beside each other, as logarithms."""

    def __init__(
        self,
        measured: Sequence[Peak],
        computed: Sequence[Peak],
        shift: float,
        scatter: float,
        mac: np.ndarray | None,
    ):
        self.measured, self.computed, self.shift, self.scatter = measured, computed, shift, scatter
        n, m = len(measured), len(computed)
        logs = [one.log_frequency for one in (*measured, *computed)]
        # a peak that is nothing is anywhere in the range
        self.alone = math.log(SPURIOUS / max(max(logs) - min(logs), scatter))
        shaped = np.zeros((n, m)) if mac is None else (mac - 1) / UNLIKE
        shaped = np.maximum(shaped, math.log(OTHER)).tolist()
        self.like = [
            [self._like(one, mode) + like for mode, like in zip(computed, row)]
            for one, row in zip(measured, shaped)
        ]
        self.steps = {at: self._steps(*at) for at in product(range(n + 1), range(m + 1))}
        self.forward = np.full((n + 1, m + 1), -np.inf).tolist()
        self.backward = np.full((n + 1, m + 1), -np.inf).tolist()
        self.forward[0][0] = self.backward[n][m] = 0.0
        for (i, j), steps in self.steps.items():
            here = self.forward[i][j]
            for a, b, log, _ in steps:
                self.forward[i + a][j + b] = _sum(self.forward[i + a][j + b], here + log)
        for (i, j), steps in reversed(self.steps.items()):
            for a, b, log, _ in steps:
                there = log + self.backward[i + a][j + b]
                self.backward[i][j] = _sum(self.backward[i][j], there)
        #: log-likelihood of both lists
        self.total = self.forward[n][m]

    def _like(self, one: Peak, mode: Peak) -> float:
        """Log-density of a measured frequency if it is a computed mode."""
        variance = self.scatter**2 + one.width**2 + mode.width**2
        away = one.log_frequency - mode.log_frequency - self.shift
        if away**2 > FAR**2 * variance:
            return -math.inf
        other = one.family and mode.family and one.family != mode.family
        named = math.log(RENAMED) if other else 0.0
        return named - away**2 / (2 * variance) - math.log(2 * math.pi * variance) / 2

    def _steps(self, i: int, j: int) -> list[_Step]:
        """What may come after some of both lists."""
        n, m = len(self.measured), len(self.computed)
        out: list[_Step] = []
        if i < n:
            out.append((1, 0, self.alone, ()))
        if j < m:
            out.append((0, 1, math.log(MISSED), ()))
        if i == n or j == m:
            return out
        like, here, mode = self.like, self.measured[i], self.computed[j]
        if like[i][j] > -math.inf:
            out.append((1, 1, like[i][j] + math.log(SAME * _alike(here, mode)), ((i, j),)))
        if (
            i + 1 < n
            and mode.multiplicity == 2
            and 2 not in (here.multiplicity, self.measured[i + 1].multiplicity)
        ):
            log = like[i][j] + like[i + 1][j] + math.log(SPLIT)
            out.append((2, 1, log, ((i, j), (i + 1, j))))
        if j + 1 < m:
            log = like[i][j] + like[i][j + 1] + math.log(MERGED)
            out.append((1, 2, log, ((i, j), (i, j + 1))))
        if i + 1 < n and j + 1 < m:
            alike = _alike(here, self.computed[j + 1]) * _alike(self.measured[i + 1], mode)
            log = like[i][j + 1] + like[i + 1][j] + math.log(CROSSED * alike)
            out.append((2, 2, log, ((i, j + 1), (i + 1, j))))
        return [step for step in out if step[2] > -math.inf]

    def alignment(self) -> Alignment:
        """Probabilities of pairs."""
        n, m = len(self.measured), len(self.computed)
        pairs, spurious, missed = np.zeros((n, m)), np.zeros(n), np.zeros(m)
        for (i, j), steps in self.steps.items():
            for a, b, log, made in steps:
                share = math.exp(
                    self.forward[i][j] + log + self.backward[i + a][j + b] - self.total
                )
                for one, mode in made:
                    pairs[one, mode] += share
                spurious[i : i + a] += share * (not made)
                missed[j : j + b] += share * (not made)
        return Alignment(pairs, spurious, missed, self.shift, self.scatter)


def _alike(one: Peak, mode: Peak) -> float:
    """How likely a multiplicity is measured of a mode."""
    if one.multiplicity is None or one.multiplicity == mode.multiplicity:
        return 1.0
    return HALF if one.multiplicity == 1 else DOUBLE


def _sum(a: float, b: float) -> float:
    """Logarithm of the sum of what two logarithms stand for."""
    low, high = (a, b) if a < b else (b, a)
    return high if low == -math.inf else high + math.log1p(math.exp(low - high))
