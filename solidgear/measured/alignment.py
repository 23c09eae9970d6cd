"""Pairs of measured resonances and computed modes, by frequencies, multiplicities and, where they
were measured, shapes, and how sure that is.

Both lists ascend. They are aligned by a hidden Markov model: a step takes one of each (the same
mode), two measured and one computed (a pair that was measured split), one measured and two computed
(two modes too near each other to be separated), two of each crosswise, three of each in another
order, or one of either alone (a spurious peak; a mode that was missed). Logarithms of frequencies
of one mode differ by a common shift, such as that of a modulus which is not known well, and a
scatter beyond the stated uncertainties; both are estimated with the pairing (expectation
maximisation). Forward and backward sums (Rabiner 1989, Proc. IEEE 77, 257, eqs. 19 to 27) give the
probability of every pair.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import betaln, erf, gammaln

#: how likely steps are before any frequency is looked at: one of each, a pair measured split, a
#: peak or a mode alone
SAME, SPLIT, SPURIOUS, MISSED = 0.8, 0.02, 0.03, 0.12
#: modes nearer than this, relative, are under one peak: the half-power bandwidth at a damping ratio of
#: 0.1 %, assumed where none is stated: the upper end of metal parts that hang freely
BANDWIDTH = 2e-3
#: two crosswise: scatter of both alone decides whether they changed places
CROSSED = SAME**2
#: and so of three, in the orders that no neighbours changing places make of them
TURNED, ORDERS = SAME**3, ((1, 2, 0), (2, 0, 1), (2, 1, 0))
#: a single resonance where a pair was computed (a split pair of which one was seen), and a pair
#: where a single one was
HALF, DOUBLE = 0.2, 0.02
#: of a mode called by another family than the computed one
RENAMED = 1e-3
#: of shapes that are of no mode at all: points that were numbered otherwise
OTHER = 1e-4
#: smallest 1 - MAC that counts
FINEST = 1e-6
#: shifts of logarithms that are begun with, and the scatter; both are then estimated. The
#: outermost are a modulus 20 % off: cast iron of one name has 90 to 130 GPa, steel and aluminium 5 %
SHIFTS, SCATTER = (-0.1, -0.05, -0.02, 0.0, 0.02, 0.05, 0.1), 0.02
#: scatter that is usual beyond stated uncertainties, and how many pairs that counts for: the five
#: measured bodies (validation/experiments) kept 0.09 to 0.5 % with two constants fitted, and a tenth of
#: a pair is overruled by the first few that say otherwise
USUAL, WORTH = 5e-3, 0.1
#: least scatter; rounding of printed frequencies
LEAST = 2e-5
#: a frequency this many scatters from where it belongs is another
FAR = 6.0
#: a probability that is none
TINY = 1e-300
#: rounds until shift and scatter have settled, and starts that are followed
ROUNDS, TRIED = 12, 2


@dataclass(frozen=True)
class Peak:
    """Measured resonance, or computed mode, as the pairing takes it."""

    log_frequency: float
    width: float  #: standard deviation of that
    multiplicity: int | None = None  #: none where nobody looked
    family: str = ""  #: empty where it is not known
    bandwidth: float = BANDWIDTH  #: of a mode, relative: nearer to another it is under one peak


@dataclass(frozen=True, eq=False)
class ShapeLikeness:
    """Likeness of measured and computed shapes."""

    mac: np.ndarray  #: (n, m) not a number where no shape was measured
    components: int  #: real numbers of a shape
    spans: np.ndarray  #: (m,) of those the shapes of a mode fit whatever they are
    #: standard deviation of a component, relative to the root mean square of the shape
    noise: float

    def log_likelihoods(self, modes: Sequence[Peak], scatter: float) -> np.ndarray:
        """Return logarithms (n, m) of how much likelier a shape is if it is a mode than if it is
        none.

        Of a mode, 1 - MAC is the noise outside its span, ``s^2 chi^2(n - d) / n``, and the share
        mixed into it from others of its family by the changes that scatter frequencies, to first
        order ``s_jk / sinh(ln f_j / f_k)`` of each, with the geometric mean of both scatters as one
        spring makes it; the sum has one chi-square of the same mean and variance (Satterthwaite).
        Of a shape that is none 1 - MAC has a beta distribution.
        """
        n, free = self.components, self.components - self.spans
        logs = np.array([peak.log_frequency for peak in modes])
        family = np.array([peak.family for peak in modes])
        distance = np.sinh(np.abs(np.subtract.outer(logs, logs)))
        widths = np.array([math.sqrt(math.hypot(peak.width, scatter)) for peak in modes])
        mixed = np.outer(widths, widths) / np.maximum(distance, 1e-12)
        # of two alone: square of the sine of the angle by which they turn
        mixed = (1 - 1 / np.sqrt(1 + 4 * mixed**2)) / 2
        mixed[(family[:, None] != family) | np.eye(len(modes), dtype=bool)] = 0.0
        mean = self.noise**2 * free / n + mixed.sum(axis=1)
        half_variance = self.noise**4 * free / n**2 + (mixed**2).sum(axis=1)
        defined = (free > 0) & (self.spans > 0)
        free = np.where(defined, free, 1)
        order = mean**2 / np.where(defined, half_variance, 1.0) / 2
        misfit = np.clip(1 - np.nan_to_num(self.mac), FINEST, 1 - FINEST)
        scale, a, b = mean / order, free / 2, self.spans / 2
        as_mode = (
            (order - 1) * np.log(misfit) - misfit / scale - gammaln(order) - order * np.log(scale)
        )
        as_no_mode = (a - 1) * np.log(misfit) + (b - 1) * np.log1p(-misfit) - betaln(a, b)
        out = np.logaddexp(math.log1p(-OTHER) + as_mode - as_no_mode, math.log(OTHER))
        return np.where(defined & np.isfinite(self.mac), out, 0.0)


@dataclass(frozen=True, eq=False)
class Alignment:
    """Probabilities of pairs."""

    pairs: np.ndarray  #: (n, m) that a measured resonance is a computed mode
    spurious: np.ndarray  #: (n,) that a measured one is none of those computed
    missed: np.ndarray  #: (m,) that a computed one was not measured
    #: shift, scatter: of logarithms, measured less computed
    shift: float
    scatter: float


#: by the numbers of both lists that a step takes, and which of its kind it is
_Steps = dict[tuple[int, int, int], np.ndarray]


def align(
    measured: Sequence[Peak],
    computed: Sequence[Peak],
    shapes: ShapeLikeness | None = None,
    shifts: Sequence[float] = SHIFTS,
) -> Alignment:
    """Align measured resonances and computed modes, both by ascending frequency, and by shapes
    where they were measured, beginning with some shifts of logarithms.

    Examples
    --------
    >>> found = [Peak(np.log(f), 1e-3) for f in (100.0, 155.0, 301.0)]
    >>> modes = [Peak(np.log(f), 1e-3) for f in (101.0, 156.0, 220.0, 303.0)]
    >>> one = align(found, modes)
    >>> [int(row.argmax()) for row in one.pairs], bool(one.missed[2] > 0.99)
    ([0, 1, 3], True)
    """
    starts = sorted(
        shifts, key=lambda shift: -_Lattice(measured, computed, shift, SCATTER, shapes).total
    )
    ends = [_settled_lattice(measured, computed, shift, shapes) for shift in starts[:TRIED]]
    return max(ends, key=lambda lattice: lattice.total).alignment()


def _settled_lattice(
    measured: Sequence[Peak], computed: Sequence[Peak], shift: float, shapes: ShapeLikeness | None
) -> _Lattice:
    """Return sums once shift and scatter have settled from a start."""
    differences = np.subtract.outer(
        [peak.log_frequency for peak in measured], [peak.log_frequency for peak in computed]
    )
    stated = (
        np.hypot.outer([peak.width for peak in measured], [peak.width for peak in computed]) ** 2
    )
    lattice = _Lattice(measured, computed, shift, SCATTER, shapes)
    for _ in range(ROUNDS):
        pairs = lattice.alignment().pairs
        weight = float(pairs.sum())
        if weight < 1e-6:
            break
        heavy = pairs / (stated + lattice.scatter**2)
        shift = float((heavy * differences).sum() / heavy.sum())
        # part of the differences that stated uncertainties do not explain
        share = lattice.scatter**2 / (stated + lattice.scatter**2)
        part = (share * (differences - shift)) ** 2 + share * stated
        # drawn towards the usual scatter, for zero has no likelihood; the shift took a pair
        square = float((pairs * part).sum()) + WORTH * USUAL**2
        scatter = max(math.sqrt(square / (max(weight - 1, 0.0) + WORTH)), LEAST)
        moved = abs(shift - lattice.shift) + abs(scatter - lattice.scatter)
        lattice = _Lattice(measured, computed, shift, scatter, shapes)
        if moved < 1e-3 * scatter:
            break
    return lattice


class _Lattice:
    """Forward and backward sums over all ways to align two lists, as logarithms."""

    def __init__(
        self,
        measured: Sequence[Peak],
        computed: Sequence[Peak],
        shift: float,
        scatter: float,
        shapes: ShapeLikeness | None,
    ):
        self.shift, self.scatter = shift, scatter
        shape = len(measured), len(computed)
        shaped = np.zeros(shape) if shapes is None else shapes.log_likelihoods(computed, scatter)
        #: that a sum of two shapes is within noise of one alone: of its angle
        chance = 0.0 if shapes is None else math.log(2 * shapes.noise / math.pi)
        #: log-likelihoods of every step by where it begins
        self.steps = _steps(measured, computed, shift, scatter, shaped, chance)
        self.forward = _sums(self.steps, shape)
        back = {step: logs[::-1, ::-1] for step, logs in self.steps.items()}
        self.backward = _sums(back, shape)[::-1, ::-1]
        #: log-likelihood of both lists
        self.total = float(self.forward[-1, -1])

    def alignment(self) -> Alignment:
        """Return probabilities of pairs."""
        share = {}
        for (a, b, kind), logs in self.steps.items():
            begun = self.forward[: logs.shape[0], : logs.shape[1]]
            share[a, b, kind] = np.exp(begun + logs + self.backward[a:, b:] - self.total)
        pairs = share[1, 1, 0]
        pairs[:-1] += share[2, 1, 0]
        pairs[1:] += share[2, 1, 0]
        pairs[:, :-1] += share[1, 2, 0]
        pairs[:, 1:] += share[1, 2, 0]
        pairs[:-1, 1:] += share[2, 2, 0]
        pairs[1:, :-1] += share[2, 2, 0]
        for kind, order in enumerate(ORDERS):
            for view in _ordered(pairs, order) if (3, 3, kind) in share else ():
                view += share[3, 3, kind]
        spurious, missed = share[1, 0, 0].sum(axis=1), share[0, 1, 0].sum(axis=0)
        return Alignment(pairs, spurious, missed, self.shift, self.scatter)


def _steps(
    measured: Sequence[Peak],
    computed: Sequence[Peak],
    shift: float,
    scatter: float,
    shaped: np.ndarray,
    chance: float,
) -> _Steps:
    n, m = len(measured), len(computed)
    of_measured, of_computed = (
        np.array([peak.log_frequency for peak in peaks]) for peaks in (measured, computed)
    )
    stated = np.array([peak.width for peak in measured])[:, None] ** 2
    moved = scatter**2 + np.array([peak.width for peak in computed]) ** 2
    difference = of_measured[:, None] - of_computed - shift
    name = np.log([[_name_probability(peak, mode) for mode in computed] for peak in measured])
    near = difference**2 <= FAR**2 * (moved + stated)
    likeness = np.where(near, name + _normal(difference, moved + stated), -np.inf) + shaped
    multiplicity = np.log(
        [[_multiplicity_probability(peak, mode) for mode in computed] for peak in measured]
    )
    # a peak that is nothing is anywhere in the range
    logs = np.concatenate([of_measured, of_computed])
    alone = math.log(SPURIOUS / max(float(np.ptp(logs)), scatter))
    pair = np.array([mode.multiplicity == 2 for mode in computed], bool)
    single = np.array([peak.multiplicity != 2 for peak in measured])[:, None]
    split = np.where(pair & single[:-1] & single[1:], math.log(SPLIT), -np.inf)
    # the peak is amid both, which differ by less than can be resolved
    amid = _normal(
        (difference[:, :-1] + difference[:, 1:]) / 2, stated + (moved[:-1] + moved[1:]) / 4
    )
    sigma, gap = np.sqrt(2 * (moved[:-1] + moved[1:])), np.diff(of_computed)
    band = np.array([mode.bandwidth for mode in computed])[:-1]
    merged = (erf((band - gap) / sigma) + erf((band + gap) / sigma)) / 2
    # a shape of both at once is within noise of one alone by chance
    best = np.maximum(shaped[:, :-1], shaped[:, 1:])
    amid += best + np.where(best > 0, chance, 0.0) + name[:, :-1] + name[:, 1:]
    amid = np.where(near[:, :-1] & near[:, 1:], amid, -np.inf)
    crossed = likeness[:-1, 1:] + likeness[1:, :-1] + multiplicity[:-1, 1:] + multiplicity[1:, :-1]
    # frequencies alone cannot distinguish orders of three
    turned = {
        (3, 3, kind): sum(_ordered(likeness + multiplicity, order)) + math.log(TURNED)
        for kind, order in enumerate(ORDERS if shaped.any() else ())
    }
    return {
        (1, 0, 0): np.full((n, m + 1), alone),
        (0, 1, 0): np.full((n + 1, m), math.log(MISSED)),
        (1, 1, 0): likeness + multiplicity + math.log(SAME),
        (2, 1, 0): likeness[:-1] + likeness[1:] + split,
        (1, 2, 0): amid + np.log(np.maximum(SAME * merged, TINY)),
        (2, 2, 0): crossed + math.log(CROSSED),
        **turned,
    }


def _ordered(pairs: np.ndarray, order: Sequence[int]) -> list[np.ndarray]:
    """Return views of a matrix of pairs: three of each from every place on, in an order."""
    n, m = (max(size - 2, 0) for size in pairs.shape)
    return [pairs[k : k + n, column : column + m] for k, column in enumerate(order)]


def _sums(steps: _Steps, shape: tuple[int, int]) -> np.ndarray:
    """Return logarithms (n + 1, m + 1) of sums over all ways from the beginning of both lists."""
    n, m = shape
    out = np.full((n + 1, m + 1), -np.inf)
    missed = np.concatenate([np.zeros((n + 1, 1)), np.cumsum(steps[0, 1, 0], axis=1)], axis=1)
    for i in range(n + 1):
        row = out[i]
        row[0] = 0.0 if i == 0 else -np.inf
        for (a, b, _), logs in steps.items():
            if 0 < a <= i and b <= m:
                row[b:] = np.logaddexp(row[b:], out[i - a, : m + 1 - b] + logs[i - a])
        # any number of modes that were missed
        out[i] = np.logaddexp.accumulate(row - missed[i]) + missed[i]
    return out


def _normal(difference: np.ndarray, variance: np.ndarray) -> np.ndarray:
    """Return logarithms of the density of a normal distribution."""
    return -(difference**2) / (2 * variance) - np.log(2 * np.pi * variance) / 2


def _name_probability(peak: Peak, mode: Peak) -> float:
    """Return the probability that a mode has the name that was measured."""
    return RENAMED if peak.family and mode.family and peak.family != mode.family else 1.0


def _multiplicity_probability(peak: Peak, mode: Peak) -> float:
    """Return the probability that a multiplicity is measured of a mode."""
    if peak.multiplicity is None or peak.multiplicity == mode.multiplicity:
        return 1.0
    return HALF if peak.multiplicity == 1 else DOUBLE
