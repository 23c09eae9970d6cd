"""A linear fit of the logarithms of entries to those of measured frequencies, about one scene."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.optimize import lsq_linear
from scipy.special import stdtrit

from solidgear.errors import SolidgearError
from solidgear.studies.measured.computed import Computed
from solidgear.studies.measured.correlate import DEVIATIONS, on_points_of, peaks_of
from solidgear.studies.measured.data import Measured
from solidgear.studies.measured.same_part import Likeness, alignment_of
from solidgear.studies.measured.varied import Varied

#: standard deviation of a logarithm from which on nothing is known of an entry: a factor of two
UNDETERMINED = math.log(2.0)
#: share of the direction that is not determined from which on an entry belongs to it
SHARE = 0.3
#: two modes may have changed places where that leaves less than this of what is between them; so
#: many exchanges are tried; what is found is the same within a deviation
EXCHANGED, STARTS, SAME = 0.5, 4, 1.0
#: other values fit alike up to this misfit more: odds of one in ninety; and that of a resonance
#: without a sure mode
ALIKE, DOUBT = 9.0, 4.0
#: a variance that is none
TINY = 1e-24


class Fit:
    """A linear fit about one scene."""

    def __init__(
        self,
        measured: Measured,
        varied: Sequence[Varied],
        x: np.ndarray,
        computed: Computed,
        every: np.ndarray,
        sure: float,
    ):
        """Pair and weigh; `every` are derivatives of all modes, at logarithms `x`, and `sure` is
        the least probability of a pair.
        """
        self.measured, self.computed, self.labels = measured, computed, [v.label for v in varied]
        self.low = np.array([one.low for one in varied]) - x
        self.high = np.array([one.high for one in varied]) - x
        on_points = on_points_of(measured, computed)
        seen = on_points.seen if on_points else None
        found = alignment_of(*peaks_of(measured, computed), seen)
        self.likeness = Likeness.of(found)
        likely = found.pairs.argmax(axis=1)
        #: resonance and mode of each pair that is sure enough to be fitted
        self.pairs = [(i, int(j)) for i, j in enumerate(likely) if found.pairs[i, j] >= sure]
        #: one over the deviations of what is known beforehand, and how far off it is
        self.known = 1 / np.array([one.deviation for one in varied])
        self.middle = np.array([one.middle for one in varied]) - x
        unknowns = int(np.count_nonzero(self.known == 0))
        if len(self.pairs) < max(unknowns, 1):
            bare = not np.isfinite(computed.bars).any()
            raise SolidgearError(
                f"identify: resonances with a sure mode: {len(self.pairs)}, fewer than the {unknowns} "
                "entries that are to be found; "
                + (
                    "nothing tells how good the one mesh is: list a coarser one before it"
                    if bare
                    else "vary fewer, or measure more"
                )
            )
        modes = [measured.modes[i] for i, _ in self.pairs]
        at = [j for _, j in self.pairs]
        self.every, self.rows = every, every[at]
        #: (pairs,) measured, Hz
        self.frequencies = np.array([m.frequency for m in modes])
        self.residual = np.log(self.frequencies / [computed.modes[j].frequency_hz for j in at])
        own = np.array([(m.width_hz or 0.0) / m.frequency for m in measured.modes])
        mesh = np.minimum(computed.bars, 1.0) / DEVIATIONS
        #: of every resonance, were it any of the modes
        self.variances = own[:, None] ** 2 + mesh**2
        self.variance = self.variances[tuple(np.transpose(self.pairs))]
        # the scatter that is left counts for all alike, and what is known leaves more of it
        told = float(self.variance.mean())
        size = math.sqrt(told + TINY)
        known = np.vstack([self.rows / size, np.diag(self.known)])
        left, sizes, _ = np.linalg.svd(known, full_matrices=False)
        left = left[:, sizes > 1e-9 * sizes[0]]
        aim = np.concatenate([self.residual / size, self.known * self.middle])
        best = size * (aim - left @ (left.T @ aim))[: len(at)]
        spare = max(len(at) - float(np.sum(left[: len(at)] ** 2)), 1.0)
        whole = float(best @ best) / spare
        self.scatter = math.sqrt(max(whole - told, 0.0))
        # degrees of freedom of what is told in part and estimated in part (Welch and Satterthwaite)
        freedom = spare * (max(whole, told) / max(self.scatter**2, 1e-6 * told, TINY)) ** 2
        #: deviations on either side that hold 95 %
        self.students = float(stdtrit(min(freedom, 1e6), 0.975))
        self.weight = 1 / np.sqrt(self.variance + self.scatter**2 + TINY)
        self.linear = self._weighed(self.rows, self.weight)
        _, self.sizes, self.right = np.linalg.svd(self.linear, full_matrices=False)
        sizes, right = self.sizes, self.right
        kept = np.maximum(sizes, 1e-30)
        #: of the logarithms of entries
        self.covariance = (right.T / kept**2) @ right

    def step(
        self,
        residual: np.ndarray | None = None,
        rows: np.ndarray | None = None,
        moved: np.ndarray | float = 0.0,
        weight: np.ndarray | None = None,
    ) -> np.ndarray:
        """Change of the logarithms of entries within their bounds; none along what the data do not
        tell. Other residuals and derivatives are those at logarithms `moved` from here, or of other
        pairs with weights of their own.
        """
        residual = self.residual if residual is None else residual
        weight = self.weight if weight is None else weight
        aim = np.concatenate([residual * weight, self.known * (self.middle - moved)])
        low, high = self.low - moved, self.high - moved
        linear = self.linear if rows is None else self._weighed(rows, weight)
        left, sizes, right = np.linalg.svd(linear, full_matrices=False)
        told = sizes > 1 / UNDETERMINED
        step = ((left.T @ aim)[told] / sizes[told]) @ right[told]
        if np.all((low <= step) & (step <= high)):
            return step
        return lsq_linear(linear, aim, (low, high)).x

    def _weighed(self, rows: np.ndarray, weight: np.ndarray) -> np.ndarray:
        """Derivatives of frequencies over their deviations, and of what is known beforehand."""
        return np.vstack([rows * weight[:, None], np.diag(self.known)])

    def exchanges(self, farthest: float) -> list[np.ndarray]:
        """Changes of the logarithms of entries by which two modes of a family change places, as two
        bearings do that are nearly alike, or one takes a resonance that was left out, be it instead
        of its own; those that fit best first, and change
        no logarithm by more than `farthest`.
        """
        logs = np.log([one.frequency for one in self.measured.modes])
        modes, pairs = self.computed.modes, {j: i for i, j in self.pairs}
        left_out = set(range(len(logs))) - set(pairs.values())
        moves = [
            {a: pairs[b], b: pairs[a]}
            for a, b in combinations(pairs, 2)
            if modes[a].name.family == modes[b].name.family
        ] + [{j: i} for j in range(len(modes)) for i in left_out]
        now = np.log([mode.frequency_hz for mode in modes])
        begun = now.copy()
        begun[list(pairs)] = logs[list(pairs.values())]
        out = []
        for move in moves:
            j, i = (np.array(list(part)) for part in zip(*(pairs | move).items()))
            aim, weight = (
                logs[i] - now[j],
                1 / np.sqrt(self.variances[i, j] + self.scatter**2 + TINY),
            )
            change = self.step(aim, self.every[j], weight=weight)
            left = aim - self.every[j] @ change
            moved = np.isin(j, list(move))
            done = abs(left[moved]) < EXCHANGED * abs(logs[i] - begun[j])[moved]
            apart = float(np.linalg.norm(self._weighed(self.every[j], weight) @ change))
            if done.all() and apart > SAME and abs(change).max() <= farthest:
                misfit = float(np.sum((left * weight) ** 2)) + DOUBT * (len(logs) - len(j))
                out.append((misfit, change))
        return [change for _, change in sorted(out, key=lambda one: one[0])][:STARTS]

    def apart(self, change: np.ndarray) -> float:
        """Size of a change of logarithms, in deviations."""
        return float(np.linalg.norm(self.sizes * (self.right @ change)))

    def deviations(self) -> np.ndarray:
        """(entries,) standard deviations of logarithms."""
        return np.sqrt(np.diag(self.covariance))

    def correlations(self) -> np.ndarray:
        """(entries, entries) correlations."""
        size = self.deviations()
        return self.covariance / np.outer(size, size)

    @property
    def determined(self) -> bool:
        """Tell whether no direction is left open."""
        return bool(self.sizes[-1] * UNDETERMINED >= 1)

    def refuse_undetermined(self) -> None:
        """Refuse entries of which a direction is not told by the data."""
        if self.determined:
            return
        deviation = 1 / max(float(self.sizes[-1]), 1e-30)
        direction = self.right[-1]
        among = [
            f"{label} {'up' if part > 0 else 'down'}"
            for label, part in zip(
                self.labels, direction * np.sign(direction[abs(direction).argmax()])
            )
            if abs(part) >= SHARE * abs(direction).max()
        ]
        said, out = f"leave {among[0]} open", "leave it out"
        if len(among) > 1:
            said, out = f"cannot separate {' and '.join(among)}", "leave one of them out"
        raise SolidgearError(
            f"identify: these resonances {said}: {_factor(deviation)}; {out}, or measure a mode that "
            "it moves"
        )


@dataclass(frozen=True, eq=False)
class End:
    """Logarithms that a search ended at, and its last step."""

    x: np.ndarray
    fit: Fit
    step: np.ndarray

    def misfit(self, scatter: float) -> float:
        """Twice what the logarithm of the likelihood lacks, at a scatter of all frequencies."""
        fit = self.fit
        left = fit.residual - fit.rows @ self.step
        unpaired = len(fit.measured.modes) - len(fit.pairs)
        known = fit.known * (fit.middle - self.step)
        own = left**2 / (fit.variance + scatter**2 + TINY)
        return float(own.sum() + known @ known + DOUBT * unpaired)


def best_of(ends: Sequence[End]) -> End:
    """The one that fits best, at the least scatter of all."""
    scatter = min(end.fit.scatter for end in ends)
    return min(ends, key=lambda end: end.misfit(scatter))


def _factor(deviation: float) -> str:
    """Standard deviation of a logarithm in words."""
    return (
        "however far it is changed that way, they move by less than their scatter"
        if deviation > 10
        else f"they leave it open by a factor of {math.exp(deviation):.3g} either way"
    )
