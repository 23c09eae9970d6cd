"""Entries that are to be found, and a linear fit of their logarithms to those of measured
frequencies, about one scene.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.optimize import lsq_linear
from scipy.special import stdtrit

from solidgear.core import DIMENSIONS, SceneError, SolidgearError, show
from solidgear.core.scene.open_range import FACTOR, PLUS_MINUS, Uncertain, range_ends
from solidgear.core.scene.paths import Keys, Tables, entry, keys_of, label_of
from solidgear.core.scene.units import quantity
from solidgear.measured.computed import Computed
from solidgear.measured.correlate import DEVIATIONS, on_points_of, peaks_of
from solidgear.measured.data import Measured
from solidgear.measured.same_part import Likeness, alignment_of
from solidgear.variants.sweep.entries import in_si

#: standard deviation of a logarithm from which on nothing is known of an entry: a factor of two
UNDETERMINED = math.log(2.0)
#: share of the direction that is not determined from which on an entry belongs to it
SHARE = 0.3
#: two modes may have changed places where that leaves less than this share of their distance; number
#: of exchanges that are tried; results are the same within a deviation
EXCHANGED, STARTS, SAME = 0.5, 4, 1.0
#: other values fit alike up to this misfit more: odds of one in ninety; and that of a resonance
#: without a sure mode
ALIKE, DOUBT = 9.0, 4.0
#: a variance that is none
TINY = 1e-24


@dataclass(frozen=True)
class Varied:
    """An entry of a scene file; logarithms are of the value over that in the file."""

    keys: Keys
    label: str  #: its path
    before: float  #: in the file, SI
    #: low, high: bounds of the logarithm
    low: float = -math.inf
    high: float = math.inf
    #: middle, deviation: of the logarithm, as it is known beforehand; an infinite deviation where
    #: it is not
    middle: float = 0.0
    deviation: float = math.inf

    @property
    def begin(self) -> float:
        """Logarithm at which a search begins."""
        return min(max(self.middle, self.low), self.high)

    @property
    def prior(self) -> tuple[float, float] | None:
        """Prior value, and the deviation of the logarithm."""
        if math.isinf(self.deviation):
            return None
        return self.before * math.exp(self.middle), self.deviation


def varied_of(
    texts: Iterable[str], tables: Tables, ranges: Sequence[Uncertain] | None = None
) -> tuple[Varied, ...]:
    """Return entries of ``PATH``, ``PATH=180 GPa : 220 GPa`` (bounds) and ``PATH=206 GPa ± 3 %`` (a
    value that is known to one standard deviation); ranges of the scene hold where a text gives
    none.
    """
    entries = [_varied(text, tables, ranges or ()) for text in texts]
    if not entries:
        raise SolidgearError('nothing is varied; give for example `vary` "material.E"')
    if len({entry.keys for entry in entries}) < len(entries):
        raise SolidgearError("`vary`: the same entry is given twice")
    bounded = any(math.isfinite(entry.high) or math.isfinite(entry.deviation) for entry in entries)
    if ranges is not None and not bounded:
        raise SolidgearError("`priors`: [uncertain] of the file has no range for a varied entry")
    return tuple(entries)


def _varied(text: str, tables: Tables, ranges: Sequence[Uncertain]) -> Varied:
    path, equals, range_text = (part.strip() for part in text.partition("="))
    try:
        keys = keys_of(path, tables)
        value = entry(keys, tables)
        before = in_si(value)
        if value is None:
            raise SceneError("is not in the file, where the search takes its first value from")
        if before is None or not before > 0:
            raise SceneError(
                f"is {show(value, 40)} in the file; identify needs a number above zero to begin "
                "with"
            )
        label = label_of(keys, tables)
        if equals:
            low, high = sorted(range_ends(range_text, before, _dimension(value, range_text)))
            return _with_range(Varied(keys, label, before), range_text, low / before, high / before)
    except SceneError as error:
        raise SolidgearError(f"`vary` {text}: {error}") from None
    out = Varied(keys, label, before)
    for stated in ranges:
        # a range of all of a bearing's stiffness is one of each entry
        if f"{label}.".startswith(f"{stated.path}."):
            return _with_range(out, stated.said, stated.low, stated.high)
    return out


def _with_range(entry: Varied, range_text: str, low: float, high: float) -> Varied:
    """Return the entry with a range, times the value in the file."""
    if not 0 < low < high:
        raise SceneError(
            'must be two ends above zero such as "180 GPa : 220 GPa", or a value and its standard '
            'deviation, which is less than the value, such as "206 GPa ± 3 %"',
            value=show(range_text),
        )
    a, b, middle = (math.log(factor) for factor in (low, high, (low + high) / 2))
    if PLUS_MINUS.fullmatch(range_text):
        return Varied(entry.keys, entry.label, entry.before, middle=middle, deviation=(b - a) / 2)
    if not a <= 0 <= b:
        raise SceneError(
            f"bounds must contain the file's value, {entry.before:.6g} in SI, where the search "
            "begins",
            value=show(range_text),
        )
    return Varied(entry.keys, entry.label, entry.before, low=a, high=b)


def _dimension(value: object, range_text: str) -> str:
    """Return the dimension of an entry, by the unit or, where the file has a plain number, by that
    of a range.
    """
    for word in (value, *PLUS_MINUS.sub(r"\1:\2", range_text).split(":")):
        for name in DIMENSIONS if isinstance(word, str) else ():
            try:
                quantity(word, name)
            except SceneError:
                continue
            if name != FACTOR:
                return name
    return FACTOR


class Fit:
    """Linear fit about one scene."""

    def __init__(
        self,
        measured: Measured,
        varied: Sequence[Varied],
        x: np.ndarray,
        computed: Computed,
        all_rows: np.ndarray,
        sure: float,
    ):
        """Pair and weigh; `all_rows` are derivatives of all modes, at logarithms `x`, and `sure` is
        the least probability of a pair.
        """
        self.measured, self.computed, self.labels = measured, computed, [v.label for v in varied]
        self.low = np.array([entry.low for entry in varied]) - x
        self.high = np.array([entry.high for entry in varied]) - x
        on_points = on_points_of(measured, computed)
        likeness = on_points.likeness if on_points else None
        alignment = alignment_of(*peaks_of(measured, computed), likeness)
        self.likeness = Likeness.of(alignment)
        likely = alignment.pairs.argmax(axis=1)
        #: resonance and mode of each pair that is sure enough to be fitted
        self.pairs = [(i, int(j)) for i, j in enumerate(likely) if alignment.pairs[i, j] >= sure]
        #: one over the deviations of prior values, and their distance
        self.prior_weight = 1 / np.array([entry.deviation for entry in varied])
        self.prior = np.array([entry.middle for entry in varied]) - x
        unknowns = int(np.count_nonzero(self.prior_weight == 0))
        if len(self.pairs) < max(unknowns, 1):
            bare = not np.isfinite(computed.bars).any()
            raise SolidgearError(
                f"identify: {len(self.pairs)} resonances have a sure mode, fewer than the "
                f"{unknowns} entries to find; "
                + (
                    "one mesh has no error bar: list a coarser one before it"
                    if bare
                    else "vary fewer, or measure more"
                )
            )
        modes = [measured.modes[i] for i, _ in self.pairs]
        mode_numbers = [j for _, j in self.pairs]
        self.all_rows, self.rows = all_rows, all_rows[mode_numbers]
        #: (pairs,) measured, Hz
        self.frequencies = np.array([m.frequency for m in modes])
        self.residual = np.log(
            self.frequencies / [computed.modes[j].frequency_hz for j in mode_numbers]
        )
        widths = np.array([(m.width_hz or 0.0) / m.frequency for m in measured.modes])
        mesh = np.minimum(computed.bars, 1.0) / DEVIATIONS
        #: of every resonance, were it any of the modes
        self.variances = widths[:, None] ** 2 + mesh**2
        self.variance = self.variances[tuple(np.transpose(self.pairs))]
        # the remaining scatter counts for all resonances; prior values leave more of it
        stated = float(self.variance.mean())
        size = math.sqrt(stated + TINY)
        system = np.vstack([self.rows / size, np.diag(self.prior_weight)])
        left_vectors, sizes, _ = np.linalg.svd(system, full_matrices=False)
        left_vectors = left_vectors[:, sizes > 1e-9 * sizes[0]]
        target = np.concatenate([self.residual / size, self.prior_weight * self.prior])
        misfit = size * (target - left_vectors @ (left_vectors.T @ target))[: len(mode_numbers)]
        spare = max(len(mode_numbers) - float(np.sum(left_vectors[: len(mode_numbers)] ** 2)), 1.0)
        variance = float(misfit @ misfit) / spare
        self.scatter = math.sqrt(max(variance - stated, 0.0))
        # degrees of freedom of a variance stated in part, estimated in part (Welch, Satterthwaite)
        freedom = spare * (max(variance, stated) / max(self.scatter**2, 1e-6 * stated, TINY)) ** 2
        #: deviations on either side that hold 95 %
        self.students = float(stdtrit(min(freedom, 1e6), 0.975))
        self.weight = 1 / np.sqrt(self.variance + self.scatter**2 + TINY)
        self.linear = self._weighed(self.rows, self.weight)
        _, self.sizes, self.right = np.linalg.svd(self.linear, full_matrices=False)
        sizes, right = self.sizes, self.right
        stable_sizes = np.maximum(sizes, 1e-30)
        #: of the logarithms of entries
        self.covariance = (right.T / stable_sizes**2) @ right

    def step(
        self,
        residual: np.ndarray | None = None,
        rows: np.ndarray | None = None,
        moved: np.ndarray | float = 0.0,
        weight: np.ndarray | None = None,
    ) -> np.ndarray:
        """Return the change of the logarithms of entries within their bounds; none along directions
        that the data leave open. Other residuals and derivatives are those at logarithms `moved`
        from here, or of other pairs with their weights.
        """
        residual = self.residual if residual is None else residual
        weight = self.weight if weight is None else weight
        target = np.concatenate([residual * weight, self.prior_weight * (self.prior - moved)])
        low, high = self.low - moved, self.high - moved
        linear = self.linear if rows is None else self._weighed(rows, weight)
        left_vectors, sizes, right = np.linalg.svd(linear, full_matrices=False)
        determined = sizes > 1 / UNDETERMINED
        step = ((left_vectors.T @ target)[determined] / sizes[determined]) @ right[determined]
        if np.all((low <= step) & (step <= high)):
            return step
        return lsq_linear(linear, target, (low, high)).x

    def _weighed(self, rows: np.ndarray, weight: np.ndarray) -> np.ndarray:
        """Return derivatives of frequencies over their deviations, and of prior values."""
        return np.vstack([rows * weight[:, None], np.diag(self.prior_weight)])

    def exchanges(self, farthest: float) -> list[np.ndarray]:
        """Return changes of the logarithms of entries, at most `farthest`, by which two modes of a
        family change places, as two similar bearings do, or a mode takes a resonance that was left
        out in place of the present one; best fits first.
        """
        logs = np.log([mode.frequency for mode in self.measured.modes])
        modes, pairs = self.computed.modes, {j: i for i, j in self.pairs}
        left_out = set(range(len(logs))) - set(pairs.values())
        moves = [
            {a: pairs[b], b: pairs[a]}
            for a, b in combinations(pairs, 2)
            if modes[a].name.family == modes[b].name.family
        ] + [{j: i} for j in range(len(modes)) for i in left_out]
        computed_logs = np.log([mode.frequency_hz for mode in modes])
        begun = computed_logs.copy()
        begun[list(pairs)] = logs[list(pairs.values())]
        out = []
        for move in moves:
            j, i = (np.array(list(part)) for part in zip(*(pairs | move).items()))
            target, weight = (
                logs[i] - computed_logs[j],
                1 / np.sqrt(self.variances[i, j] + self.scatter**2 + TINY),
            )
            change = self.step(target, self.all_rows[j], weight=weight)
            residual = target - self.all_rows[j] @ change
            moved = np.isin(j, list(move))
            reached = abs(residual[moved]) < EXCHANGED * abs(logs[i] - begun[j])[moved]
            distance = float(np.linalg.norm(self._weighed(self.all_rows[j], weight) @ change))
            if reached.all() and distance > SAME and abs(change).max() <= farthest:
                misfit = float(np.sum((residual * weight) ** 2)) + DOUBT * (len(logs) - len(j))
                out.append((misfit, change))
        return [change for _, change in sorted(out, key=lambda fit: fit[0])][:STARTS]

    def distance(self, change: np.ndarray) -> float:
        """Return the size of a change of logarithms, in deviations."""
        return float(np.linalg.norm(self.sizes * (self.right @ change)))

    def deviations(self) -> np.ndarray:
        """Return standard deviations (entries,) of logarithms."""
        return np.sqrt(np.diag(self.covariance))

    def correlations(self) -> np.ndarray:
        """Return correlations (entries, entries)."""
        size = self.deviations()
        return self.covariance / np.outer(size, size)

    @property
    def determined(self) -> bool:
        """Return whether no direction is left open."""
        return bool(self.sizes[-1] * UNDETERMINED >= 1)

    def refuse_undetermined(self) -> None:
        """Refuse entries that have a direction which the data leave open."""
        if self.determined:
            return
        deviation = 1 / max(float(self.sizes[-1]), 1e-30)
        direction = self.right[-1]
        parts = [
            f"{label} {'up' if part > 0 else 'down'}"
            for label, part in zip(
                self.labels, direction * np.sign(direction[abs(direction).argmax()])
            )
            if abs(part) >= SHARE * abs(direction).max()
        ]
        problem, advice = f"leave {parts[0]} open", "leave it out"
        if len(parts) > 1:
            problem, advice = f"cannot separate {' and '.join(parts)}", "leave one of them out"
        reach = f"they leave a factor of {math.exp(min(deviation, 10)):.3g} either way"
        if deviation > 10:
            reach = "any change of them that way moves the resonances by less than their scatter"
        raise SolidgearError(
            f"identify: these resonances {problem}: {reach}; {advice}, or measure a mode that it moves"
        )


@dataclass(frozen=True, eq=False)
class End:
    """Logarithms at which a search ended, and the last step."""

    x: np.ndarray
    fit: Fit
    step: np.ndarray

    def misfit(self, scatter: float) -> float:
        """Return the missing logarithm of the likelihood times two, at a scatter of all
        frequencies.
        """
        fit = self.fit
        residual = fit.residual - fit.rows @ self.step
        unpaired = len(fit.measured.modes) - len(fit.pairs)
        prior_misfit = fit.prior_weight * (fit.prior - self.step)
        terms = residual**2 / (fit.variance + scatter**2 + TINY)
        return float(terms.sum() + prior_misfit @ prior_misfit + DOUBT * unpaired)


def best_of(ends: Sequence[End]) -> End:
    """Return the end that fits best, at the least scatter of all."""
    scatter = min(end.fit.scatter for end in ends)
    return min(ends, key=lambda end: end.misfit(scatter))
