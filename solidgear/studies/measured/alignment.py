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
from scipy.special import betaln, gammaln

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
#: of shapes that are of no mode at all: points that were numbered otherwise
OTHER = 1e-4
#: least of 1 - MAC that is told from none
FINEST = 1e-6
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
class Seen:
    """How like measured shapes are computed ones.

    Attributes
    ----------
    mac : (n, m) ndarray
        Not a number where no shape was measured.
    components : int
        Real numbers of a shape.
    spans : (m,) ndarray of int
        Of those the shapes of a mode fit whatever they are.
    noise : float
        Standard deviation of a component, relative to the root mean square of the shape.
    """

    mac: np.ndarray
    components: int
    spans: np.ndarray
    noise: float

    def log_likelihoods(self, modes: Sequence[Peak], scatter: float) -> np.ndarray:
        """(n, m) logarithms of how much likelier a shape is if it is a mode than if it is none.

        Of a mode, 1 - MAC is the noise outside its span, ``s^2 chi^2(n - d) / n``, and what is mixed
        into it of others of its family by the changes that scatter frequencies, to first order
        ``scatter / sinh(ln f_j / f_k)`` of each; the sum has one chi-square of the same mean and
        variance (Satterthwaite). Of a shape that is none 1 - MAC has a beta distribution.
        """
        n, free = self.components, self.components - self.spans
        logs = np.array([one.log_frequency for one in modes])
        family = np.array([one.family for one in modes])
        apart = np.sinh(np.abs(np.subtract.outer(logs, logs)))
        mixed = scatter / np.maximum(apart, 1e-12)
        # of two alone: square of the sine of the angle by which they turn
        mixed = (1 - 1 / np.sqrt(1 + 4 * mixed**2)) / 2
        mixed[(family[:, None] != family) | np.eye(len(modes), dtype=bool)] = 0.0
        mean = self.noise**2 * free / n + mixed.sum(axis=1)
        half_variance = self.noise**4 * free / n**2 + (mixed**2).sum(axis=1)
        known = (free > 0) & (self.spans > 0)
        free = np.where(known, free, 1)
        order = mean**2 / np.where(known, half_variance, 1.0) / 2
        away = np.clip(1 - np.nan_to_num(self.mac), FINEST, 1 - FINEST)
        scale, a, b = mean / order, free / 2, self.spans / 2
        one = (order - 1) * np.log(away) - away / scale - gammaln(order) - order * np.log(scale)
        none = (a - 1) * np.log(away) + (b - 1) * np.log1p(-away) - betaln(a, b)
        out = np.logaddexp(math.log1p(-OTHER) + one - none, math.log(OTHER))
        return np.where(known & np.isfinite(self.mac), out, 0.0)


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
    measured: Sequence[Peak], computed: Sequence[Peak], seen: Seen | None = None
) -> Alignment:
    """Lay measured resonances beside computed modes, both by ascending frequency, and by shapes
    where they were measured.

    Examples
    --------
    >>> found = [Peak(np.log(f), 1e-3) for f in (100.0, 155.0, 301.0)]
    >>> modes = [Peak(np.log(f), 1e-3) for f in (101.0, 156.0, 220.0, 303.0)]
    >>> one = align(found, modes)
    >>> [int(row.argmax()) for row in one.pairs], bool(one.missed[2] > 0.99)
    ([0, 1, 3], True)
    """
    starts = sorted(
        SHIFTS, key=lambda shift: -_Lattice(measured, computed, shift, SCATTER, seen).total
    )
    ends = [_settled(measured, computed, shift, seen) for shift in starts[:TRIED]]
    return max(ends, key=lambda lattice: lattice.total).alignment()


def _settled(
    measured: Sequence[Peak], computed: Sequence[Peak], shift: float, seen: Seen | None
) -> _Lattice:
    """Sums once shift and scatter have settled from a start."""
    apart = np.subtract.outer(
        [one.log_frequency for one in measured], [one.log_frequency for one in computed]
    )
    lattice = _Lattice(measured, computed, shift, SCATTER, seen)
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
        lattice = _Lattice(measured, computed, shift, scatter, seen)
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
        seen: Seen | None,
    ):
        self.measured, self.computed, self.shift, self.scatter = measured, computed, shift, scatter
        n, m = len(measured), len(computed)
        logs = [one.log_frequency for one in (*measured, *computed)]
        # a peak that is nothing is anywhere in the range
        self.alone = math.log(SPURIOUS / max(max(logs) - min(logs), scatter))
        self.like = [[self._like(one, mode) for mode in computed] for one in measured]
        shaped = np.zeros((n, m)) if seen is None else seen.log_likelihoods(computed, scatter)
        self.shaped = shaped.tolist()
        #: that a sum of two shapes is within noise of one alone: of its angle
        self.chance = 0.0 if seen is None else math.log(2 * seen.noise / math.pi)
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
        like, shaped = self.like, self.shaped
        here, mode = self.measured[i], self.computed[j]
        log = like[i][j] + shaped[i][j] + math.log(SAME * _alike(here, mode))
        out.append((1, 1, log, ((i, j),)))
        if (
            i + 1 < n
            and mode.multiplicity == 2
            and 2 not in (here.multiplicity, self.measured[i + 1].multiplicity)
        ):
            log = like[i][j] + like[i + 1][j] + shaped[i][j] + shaped[i + 1][j] + math.log(SPLIT)
            out.append((2, 1, log, ((i, j), (i + 1, j))))
        if j + 1 < m:
            # a shape of both at once is within noise of one alone by chance
            one = max(shaped[i][j], shaped[i][j + 1])
            one += self.chance if one > 0 else 0.0
            log = like[i][j] + like[i][j + 1] + one + math.log(MERGED)
            out.append((1, 2, log, ((i, j), (i, j + 1))))
        if i + 1 < n and j + 1 < m:
            alike = _alike(here, self.computed[j + 1]) * _alike(self.measured[i + 1], mode)
            log = like[i][j + 1] + like[i + 1][j] + math.log(CROSSED * alike)
            log += shaped[i][j + 1] + shaped[i + 1][j]
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
