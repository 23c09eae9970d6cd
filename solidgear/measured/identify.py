"""Entries of a scene from measured resonances: which the data can determine, their values, and how
sure both they and predictions from them are.

A solved body on other springs, in the span of its modes and of the static deflections of the
ports.

Springs and masses stay outside, so that another set of them costs an eigenproblem of a hundred
unknowns (Rayleigh and Ritz; the static deflections are the residual attachment modes of MacNeal
1971, Computers & Structures 1, 581). Exact at the springs it was solved on, near beside them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import scipy.linalg as sla
from scipy.optimize import linear_sum_assignment

from solidgear.core import (
    ByName,
    Document,
    Scene,
    Sheeted,
    SolidgearError,
    Source,
    Supports,
    as_supports,
    document_of,
    flexibility,
    pinned,
    read_tolerance,
)
from solidgear.core.errors import names_in
from solidgear.core.loading import scene_of
from solidgear.core.scene.paths import Tables, replace_entry
from solidgear.core.springs import modes_on_springs
from solidgear.measured.computed import Computed, computed_like, computed_up_to
from solidgear.measured.correlate import DEVIATIONS, SURE, placed_in
from solidgear.measured.data import Measured, MeasuredSource, load_measured
from solidgear.measured.fit import ALIKE, SAME, End, Fit, best_of, varied_of
from solidgear.measured.same_part import Likeness
from solidgear.variants.sensitivity.adjoint import mode_form
from solidgear.variants.sensitivity.derivatives import Derivatives
from solidgear.variants.sweep.bench import surface

#: relative; at a bound
EDGE = 1e-6
#: a deviation that is more than this of the one beforehand is no news; and values this many
#: deviations from the prior contradict it
LITTLE, FAR = 0.9, 3.0
#: of the fitted resonances: as many left out are few
FEW = 0.3


@dataclass(frozen=True)
class Identified:
    """An entry of the scene."""

    path: str
    #: before, value: SI; in the file, and by the data
    before: float
    value: float
    deviation: float  #: standard deviation of its logarithm
    #: low, high: ends of the interval of 95 %, cut off at bounds
    low: float
    high: float
    #: value and standard deviation of its logarithm
    prior: tuple[float, float] | None = None

    @property
    def at_bound(self) -> bool:
        """Return whether a bound holds it where it is."""
        return self.value <= self.low * (1 + EDGE) or self.value >= self.high * (1 - EDGE)


@dataclass(frozen=True)
class Fitted:
    """Measured resonance and the mode that the identified scene has there."""

    name: str
    #: measured, computed: Hz
    measured: float
    computed: float
    #: prediction where this resonance is left out of the fit, Hz; None where the others do not
    #: determine it
    left_out: float | None


@dataclass(frozen=True)
class Predicted:
    """A mode beyond the measured ones."""

    name: str
    multiplicity: int
    frequency_hz: float
    #: standard deviation: of the entries, of the scatter of the fit and of the mesh
    deviation_hz: float


@dataclass(frozen=True, repr=False, eq=False)
class Identification(ByName[Identified], Sheeted):
    """Entries identified from measured resonances."""

    shown: ClassVar[str] = "measured.command:entries"
    sheeted: ClassVar[str] = "measured.command:identification_sheet"
    plain_names = (
        "kind",
        "scene",
        ("measurement", "title"),
        "mesh",
        "entries",
        ("fit_alike", "alike"),
        "correlations",
        ("other_part", "likeness"),
        "fitted",
        ("unpaired_hz", "unpaired"),
        "rms",
        "rms_left_out",
        "predicted",
        "sentences",
        "cautions",
    )
    kind = "identification"

    scene: str
    title: str
    entries: tuple[Identified, ...]
    correlations: np.ndarray  #: (p, p) between entries
    fitted: tuple[Fitted, ...]  #: resonances that were fitted
    unpaired: tuple[float, ...]  #: hz; those that were not, since no mode is surely theirs
    rms: float  #: relative differences of fit
    #: of each resonance predicted from the others; None where they determine none
    rms_left_out: float | None
    predicted: tuple[Predicted, ...]
    mesh: str
    tables: Tables  #: of the scene file with the values put in
    likeness: Likeness  #: whether the resonances can be those of this part
    remarks: tuple[str, ...] = ()  #: on how the file of resonances was read
    alike: tuple[tuple[float, ...], ...] = ()  #: other values of all entries, SI, that fit as well
    cautions: tuple[str, ...] = ()  #: sentences on what the computed frequencies leave out

    @property
    def by_name(self) -> dict[str, Identified]:
        """Entries by their paths."""
        return {entry.path: entry for entry in self.entries}

    @property
    def sentences(self) -> list[str]:
        """Conclusions."""
        return list(_sentences(self))


def _sentences(result: Identification) -> Iterator[str]:
    if result.likeness.sentence:
        yield result.likeness.sentence
    for entry in result.entries:
        yield (
            f"{entry.path} = {entry.value:.6g} (SI), standard deviation {100 * entry.deviation:.2g} %; "
            f"the file has {entry.before:.6g}."
        )
        if entry.at_bound:
            yield f"{entry.path} is at its bound: the data ask for a value beyond it."
        if entry.prior is not None:
            yield from _prior_sentences(entry, *entry.prior)
    for values in result.alike:
        listed = ", ".join(f"{e.path} = {v:.6g}" for e, v in zip(result.entries, values))
        yield (
            f"Not the only answer: {listed} (SI) fits these resonances as well; measure shapes or "
            "further modes to decide."
        )
    yield f"{len(result.fitted)} resonances fitted: {100 * result.rms:.2g} % rms" + (
        "."
        if result.rms_left_out is None
        else f"; each predicted from the others: {100 * result.rms_left_out:.2g} % rms."
    )
    if alone := [resonance.name for resonance in result.fitted if resonance.left_out is None]:
        yield (
            f"{', '.join(alone)} would be fitted by any value, since no other resonance moves "
            "with the same entries: measure more of those."
        )
    if result.unpaired:
        listed = ", ".join(f"{frequency:.6g}" for frequency in result.unpaired)
        yield f"Not fitted, since no mode is surely theirs: {listed} Hz."
        if len(result.unpaired) > FEW * len(result.fitted):
            yield (
                "So many not fitted may hide better values: begin nearer, lower --tol, or measure "
                "shapes."
            )
    yield from result.remarks
    correlation = np.abs(result.correlations - np.eye(len(result.entries)))
    if len(result.entries) > 1 and correlation.max() > SURE:
        i, j = np.unravel_index(int(correlation.argmax()), correlation.shape)
        yield (
            f"{result.entries[i].path} and {result.entries[j].path} move the same resonances "
            f"(correlation {result.correlations[i, j]:+.2f}), so that each is less sure than with "
            "the other held."
        )


def _prior_sentences(entry: Identified, middle: float, deviation: float) -> Iterator[str]:
    prior = f"{middle:.6g}, known to {100 * deviation:.2g} % beforehand"
    if entry.deviation > LITTLE * deviation:
        yield f"The data do not determine {entry.path}: it stays as it was, {prior}."
    deviations = abs(math.log(entry.value / middle)) / deviation
    if deviations > FAR:
        yield f"{entry.path} lies {deviations:.2g} standard deviations from {prior}: one of them is wrong."


Progress = Callable[[str], None]
#: rounds of Gauss and Newton, the largest change of a logarithm in one, and the one that is none;
#: of a deviation, that may be left
ROUNDS, LONGEST, NONE, LEFT = 12, 0.5, 1e-7, 1e-2
#: change of a logarithm that is none between rounds, and of a change the share by which a body that
#: is not solved again may be mistaken
NEARER, MISTAKEN = 1e-5, 1e-2
#: rounds in which pairs count from a lower probability on
EARLY, LIKELY = 2, 0.5
#: of the logarithm of an entry, to either side, for derivatives
STEP = 1e-4
#: of the logarithm of entries, along a direction that is open at the start
NUDGE = 0.03
#: a resonance that leaves less than this of itself to the others is predicted from none
ALONE = 1e-6
#: frequencies beyond the measured ones are looked for in steps of this factor
WIDER = 1.15


@pinned
def identify(
    scene: Source,
    measured: MeasuredSource,
    vary: str | Iterable[str],
    *,
    tol: float | str = 2e-4,
    predict: int = 0,
    progress: Progress = lambda _: None,
    priors: bool = False,
) -> Identification:
    """Find entries of a scene from measured resonances, by least squares of the logarithms of
    frequencies (Gauss and Newton, with exact derivatives).

    Resonances are paired with modes anew in every round; those whose mode is not sure are left out
    and reported. Each weighs by the uncertainty and the error bar of the mode; the remaining
    scatter widens all deviations where it is larger. Pairs that may have changed places are tried,
    and values elsewhere that fit as well are reported.

    Parameters
    ----------
    scene : path, dict or Scene
        A scene: its file (TOML), the tables of one, or an object.
    measured : path, dict or Measured
        Resonances, as of :func:`solidgear.correlate`.
    vary : str or iterable of str
        Paths of entries that leave the shape as it is: of materials, springs, masses; with bounds,
        ``"material.E=180 GPa : 220 GPa"``, or with a prior value and standard deviation,
        ``"material.E=206 GPa ± 3 %"``.
    tol : float
        Relative error bar that modes are brought to.
    predict : int
        Modes beyond the highest measured resonance to predict.
    progress : callable
        Called with a sentence at every step.
    priors : bool
        Whether the ranges of the scene's ``[uncertain]`` hold for entries without a prior.

    Returns
    -------
    Identification
        ``entries`` with value and deviation, resonances that were ``fitted``, ``sentences``.

    Raises
    ------
    SolidgearError
        For a path that names no positive number, entries that the data do not determine, with the
        direction, and fewer resonances than entries.

    Examples
    --------
    >>> import solidgear as sg
    >>> rod = {"material": "steel", "port": {"attach_to": "rod", "at": "rod.middle"},
    ...     "segment": [{"kind": "cylinder", "name": "rod", "length": 0.6, "diameter": 0.02}]}
    >>> tap = {"uncertainty": "0.1 %", "mode": [{"frequency": 251.95}, {"frequency": 690.85}]}
    >>> (modulus,) = sg.identify(rod, tap, ["material.E"]).entries
    >>> bool(abs(modulus.value / 207e9 - 0.99) < 0.01)
    True
    """
    search = _Search(
        document_of(scene), load_measured(measured), names_in(vary), tol, progress, priors
    )
    return search.identification(predict)


class _Search:
    """Scene, data, and the point of the search in the space of logarithms of entries."""

    def __init__(
        self,
        document: Document,
        measured: Measured,
        vary: Sequence[str],
        tol: float | str,
        progress: Progress,
        priors: bool,
    ):
        self.path, self.measured, self.progress = document.path, measured, progress
        self.tol = read_tolerance(tol)
        tables = document.tables
        ranges = scene_of(tables, document.path).uncertain if priors else None
        # results may lie outside the ranges that the file states
        self.tables: Tables = {key: table for key, table in tables.items() if key != "uncertain"}
        self.varied = varied_of(vary, self.tables, ranges)
        self.keys = [entry.keys for entry in self.varied]
        self.before = np.array([entry.before for entry in self.varied])
        self.low = np.array([entry.low for entry in self.varied])
        self.high = np.array([entry.high for entry in self.varied])
        self.x = np.array([entry.begin for entry in self.varied])
        self._neighbours: tuple[np.ndarray, list[tuple[Scene, Scene]]] | None = None
        #: whether all that is varied leaves the body as it is
        self.on_springs = all(surface(low) == surface(high) for low, high in self.neighbours())

    def tables_at(self, x: np.ndarray) -> Tables:
        """Return tables with the logarithms of entries moved by `x`."""
        tables = self.tables
        for keys, value in zip(self.keys, self.before * np.exp(x)):
            tables = replace_entry(tables, keys, float(value))
        return tables

    def scene_at(self, x: np.ndarray) -> Scene:
        return scene_of(self.tables_at(x), self.path)

    def neighbours(self) -> list[tuple[Scene, Scene]]:
        """Return scenes on either side of the point of the search, by entries."""
        if self._neighbours is None or self._neighbours[0] is not self.x:
            steps = STEP * np.eye(len(self.x))
            sides = [(self.scene_at(self.x - step), self.scene_at(self.x + step)) for step in steps]
            self._neighbours = self.x, sides
        return self._neighbours[1]

    def search(
        self, x: np.ndarray, computed: Computed | None = None, known_ends: Sequence[End] = ()
    ) -> End:
        """Return the values at which a search from `x` ends, or the known end that it reaches, on
        the mesh of earlier results.
        """
        highest = self.measured.modes[-1].frequency
        # springs are brought to the data within a round
        early = 1 if self.on_springs else EARLY
        self.x = x
        for turn in range(ROUNDS):
            scene = self.scene_at(self.x)
            if computed is None:
                computed = computed_up_to(scene, highest, self.tol, self.progress)
                if not computed.modes:
                    raise SolidgearError(
                        f"identify: {scene.name} has no elastic mode up to {computed.limit:.4g} Hz, "
                        f"and the highest resonance measured is at {highest:.4g} Hz: begin with "
                        "values that are nearer"
                    )
                self.measured = placed_in(self.measured, computed)
            else:
                self.progress(f"round {turn + 1}")
                computed = computed_like(computed, scene)
            # far from the data pairs are doubtful, and the likelier half of them leads there
            sure = LIKELY if turn < early else SURE
            slopes = self.derivatives(computed)
            fit = Fit(self.measured, self.varied, self.x, computed, slopes, sure)
            if turn == 0 and not fit.determined:
                # where planes are alike to first order no frequency separates them; a little off it
                # may
                self.x = np.clip(self.x + NUDGE * fit.right[-1], self.low, self.high)
                continue
            step = fit.step()
            for end in known_ends:
                if fit.distance(self.x + step - end.x) < SAME:
                    return end
            tolerance = max(NONE, LEFT * fit.deviations().min())
            if turn >= early and abs(step).max() < tolerance:
                return End(self.x + step, fit, step)
            if not self.on_springs:
                self.x = self.x + _short(step)
                continue
            step = self._nearer(fit)
            if turn >= early and MISTAKEN * abs(step).max() < tolerance:
                return End(self.x + step, fit, step)
            self.x = self.x + step
        raise SolidgearError(
            f"identify: values still changed by {100 * abs(step).max():.2g} % after {ROUNDS} "
            "rounds; begin nearer, or vary fewer entries"
        )

    def with_exchanges(self, best: End, known_ends: list[End]) -> list[End]:
        """Return known ends, and those that pairs other than the best one's lead to."""
        # no search goes further
        for change in best.fit.exchanges(LONGEST * ROUNDS):
            start = np.clip(best.x + change, self.low, self.high)
            try:
                end = self.search(start, best.fit.computed, known_ends)
            except SolidgearError:
                continue
            if end not in known_ends:
                known_ends = [*known_ends, end]
        return known_ends

    def identification(self, predict: int) -> Identification:
        first = self.search(self.x)
        # other pairs may determine open directions
        ends = self.with_exchanges(first, [first])
        if (end := best_of(ends)) is not first:
            ends = self.with_exchanges(end, ends)
            end = best_of(ends)
        self.x, computed, fit, step = end.x, end.fit.computed, end.fit, end.step
        fit.refuse_undetermined()
        equivalent = tuple(
            tuple((self.before * np.exp(alternative.x)).tolist())
            for alternative in ends
            if alternative is not end
            and alternative.misfit(fit.scatter) < end.misfit(fit.scatter) + ALIKE
        )
        values = self.before * np.exp(self.x)
        reach = np.exp(fit.students * fit.deviations())
        entries = tuple(
            Identified(
                entry.label,
                entry.before,
                value,
                deviation,
                max(value / far, entry.before * math.exp(entry.low)),
                min(value * far, entry.before * math.exp(entry.high)),
                entry.prior,
            )
            for entry, value, deviation, far in zip(
                self.varied, values.tolist(), fit.deviations().tolist(), reach.tolist()
            )
        )
        residual = fit.residual - fit.rows @ step
        leverage = np.einsum("ip,pq,iq->i", fit.rows, fit.covariance, fit.rows) * fit.weight**2
        not_predicted = 1 - leverage < ALONE
        predicted_residual = residual / np.where(not_predicted, 1.0, 1 - leverage)
        fitted = tuple(
            Fitted(
                str(computed.modes[j].name),
                float(f),
                float(f * math.exp(-a)),
                None if not_predictable else float(f * math.exp(-b)),
            )
            for (_, j), f, a, b, not_predictable in zip(
                fit.pairs, fit.frequencies, residual, predicted_residual, not_predicted
            )
        )
        used = {i for i, _ in fit.pairs}
        rms_left_out = None
        if not not_predicted.all():
            rms_left_out = float(np.sqrt(np.mean(predicted_residual[~not_predicted] ** 2)))
        return Identification(
            scene=self.scene_at(self.x).title or self.path,
            title=self.measured.title,
            entries=entries,
            correlations=fit.correlations(),
            fitted=fitted,
            unpaired=tuple(m.frequency for i, m in enumerate(self.measured.modes) if i not in used),
            rms=float(np.sqrt(np.mean(residual**2))),
            rms_left_out=rms_left_out,
            predicted=self._predicted(predict, fit, computed) if predict else (),
            mesh=computed.mesh,
            tables=self.tables_at(self.x),
            likeness=fit.likeness,
            remarks=self.measured.remarks,
            alike=equivalent,
            cautions=computed.cautions,
        )

    def _nearer(self, fit: Fit) -> np.ndarray:
        """Return the change of the logarithms of entries, which do not change the mesh, to the
        least squares of a body that is not solved again.
        """
        sprung, moved = Sprung(fit.computed), np.zeros(len(self.x))
        sides = [(as_supports(low), as_supports(high)) for low, high in self.neighbours()]
        paired = [j for _, j in fit.pairs]
        for _ in range(ROUNDS):
            modes = sprung.modes_on(as_supports(self.scene_at(self.x + moved)))
            rows = np.column_stack([sprung.slopes(modes, *ends) for ends in sides]) / (2 * STEP)
            # most springs grow with their entry; slopes that are not exact cost a turn
            rows = rows[paired] * np.exp(moved)
            residual = np.log(fit.frequencies / modes[0][paired])
            step = _short(fit.step(residual, rows, moved))
            moved = moved + step
            if abs(step).max() < NEARER:
                break
        return moved

    def _predicted(self, count: int, fit: Fit, before: Computed) -> tuple[Predicted, ...]:
        """Return the modes beyond the highest that was measured."""
        highest = max(before.modes[j].frequency_hz for _, j in fit.pairs)
        scene, limit = self.scene_at(self.x), highest
        while True:
            limit *= WIDER
            self.progress(f"modes up to {limit:.4g} Hz")
            computed = computed_up_to(scene, limit, self.tol, before=before)
            higher = [
                k
                for k, m in enumerate(computed.modes)
                if highest * (1 + 1e-6) < m.frequency_hz <= limit
            ]
            if len(higher) >= count or limit > 4 * highest:
                break
        rows = self.derivatives(computed)[higher]
        spread = np.einsum("ip,pq,iq->i", rows, fit.covariance, rows)
        out = []
        for k, variance in zip(higher[:count], spread):
            mode, bar = computed.modes[k], computed.bars[k]
            relative = math.sqrt(variance + fit.scatter**2 + (min(bar, 1.0) / DEVIATIONS) ** 2)
            out.append(
                Predicted(
                    str(mode.name),
                    mode.multiplicity,
                    mode.frequency_hz,
                    relative * mode.frequency_hz,
                )
            )
        return tuple(out)

    def derivatives(self, computed: Computed) -> np.ndarray:
        """Return (modes, entries) derivatives of logarithms."""
        scene, body = computed.scene, computed.body
        forms = [mode_form(body, as_supports(scene), mode) for mode in computed.modes]
        derivative = Derivatives(scene, body, forms, computed.model, computed.options).by
        columns = np.column_stack(
            [derivative(low, high, 2 * STEP) for low, high in self.neighbours()]
        )
        return columns / np.array([mode.frequency_hz for mode in computed.modes])[:, None]


def _short(step: np.ndarray) -> np.ndarray:
    """Return a step that is no longer than one may be."""
    return step * min(1.0, LONGEST / max(float(abs(step).max()), 1e-300))


#: of the largest, that a direction counts from on
LEAST = 1e-12


class Sprung:
    """Modes of a computed set under other springs and masses on the same ports."""

    def __init__(self, computed: Computed):
        body, supports = computed.body, as_supports(computed.scene)
        self.port_rows = supports.rows(body)
        fields = flexibility(body).fields
        self.owner = np.array([j for j, mode in enumerate(computed.modes) for _ in mode.vectors])
        shapes = [shape for mode in computed.modes for shape in mode.vectors]
        ports, stiff, references = [], [], []
        for index, block in enumerate(body.blocks):
            if not block.components:
                continue
            original = block.mirror[0] if block.mirror else index
            shapes_here = [shape[index][:, None] for shape in shapes if index in shape]
            # which bodies that are not of revolution do not keep
            static = fields.get(original, block.rigid)
            spans = np.hstack([*shapes_here, static, block.rigid])
            spans = spans / np.sqrt(np.einsum("nk,nk->k", spans, block.mass @ spans))
            size, turn = np.linalg.eigh(spans.T @ (block.mass @ spans))
            independent = size > LEAST * size[-1]
            basis = spans @ (turn[:, independent] / np.sqrt(size[independent]))
            heavy = block.mass @ basis
            moved = np.zeros((6 * len(body.ports), basis.shape[1]))
            moved[body.rows(block)] = block.ports @ basis
            ports.append(moved)
            stiff.append(basis.T @ (block.stiffness @ basis))
            zero = np.zeros(basis.shape[1])
            references.append([heavy.T @ s[index] if index in s else zero for s in shapes])
        self.ports = np.hstack(ports)[self.port_rows]
        self.stiffness = sla.block_diag(*stiff)
        self.references = np.hstack([np.array(part) for part in references])
        self.hertz = np.array([mode.frequency_hz for mode in computed.modes])
        self.ratio = np.ones(len(self.hertz))
        self.ratio = self.hertz / self.modes_on(supports)[0]

    def modes_on(self, supports: Supports) -> tuple[np.ndarray, np.ndarray]:
        """Return frequencies (modes,) of the same modes on other springs, Hz, and motions (shapes,
        6 m) of the ports in each of their shapes, normalised to the mass.
        """
        heavy = np.eye(len(self.stiffness)) + self.ports.T @ supports.masses @ self.ports
        value, shapes = modes_on_springs(self.stiffness, heavy, self.ports.T @ supports.root)
        overlap = (self.references @ heavy @ shapes) ** 2
        rows, columns = linear_sum_assignment(-overlap)
        square = np.zeros(len(self.hertz))
        count = np.bincount(self.owner, minlength=len(square))
        np.add.at(square, self.owner[rows], np.maximum(value[columns], 0.0))
        free = ~self.references.any(axis=1)  # shapes that move no port
        frequencies = np.sqrt(square / count) / (2 * np.pi) * self.ratio
        motions = np.zeros((len(self.owner), len(self.ports)))
        motions[rows] = (self.ports @ shapes[:, columns]).T
        motions[free] = 0.0
        frequencies[self.owner[free]] = self.hertz[self.owner[free]]
        return frequencies, motions

    def slopes(
        self, modes: tuple[np.ndarray, np.ndarray], low: Supports, high: Supports
    ) -> np.ndarray:
        """Return changes (modes,) of the logarithms of frequencies between two sets of springs,
        from the result of :meth:`modes_on` between them.
        """
        square, motions = (2 * np.pi * modes[0]) ** 2, modes[1]
        stiff, heavy = high.stiffness - low.stiffness, high.masses - low.masses
        changes = np.einsum("sa,ab,sb->s", motions, stiff, motions, optimize=True)
        changes -= square[self.owner] * np.einsum(
            "sa,ab,sb->s", motions, heavy, motions, optimize=True
        )
        return np.bincount(self.owner, changes) / np.bincount(self.owner) / (2 * square)
