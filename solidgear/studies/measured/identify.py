"""Entries of a scene from measured resonances: which the data can tell, their values, and how sure
both they and what is predicted from them are.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Sequence

import numpy as np

from solidgear.body import as_supports
from solidgear.errors import SolidgearError
from solidgear.machine.threads import pinned
from solidgear.scene import Scene
from solidgear.scene.paths import Tables, replace_entry
from solidgear.scene.toml_file import parse
from solidgear.solve.adjoint import mode_form
from solidgear.studies.loading import scene_of
from solidgear.studies.measured.computed import Computed, computed_like, computed_up_to
from solidgear.studies.measured.correlate import DEVIATIONS, SURE, placed_in
from solidgear.studies.measured.data import Measured
from solidgear.studies.measured.fit import ALIKE, SAME, End, Fit, best_of
from solidgear.studies.measured.identified import Fitted, Identification, Identified, Predicted
from solidgear.studies.measured.sprung import Sprung
from solidgear.studies.measured.varied import varied_of
from solidgear.studies.sensitivity.derivatives import Derivatives
from solidgear.studies.sweep.bench import surface

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
#: of the logarithm of entries, along what is not told where it begins
NUDGE = 0.03
#: a resonance that leaves less than this of itself to the others is predicted from none
ALONE = 1e-6
#: frequencies beyond the measured ones are looked for in steps of this factor
WIDER = 1.15


@pinned
def identify(
    scene: str | os.PathLike,
    measured: Measured,
    vary: Iterable[str],
    *,
    tol: float = 2e-4,
    predict: int = 0,
    progress: Progress = lambda _: None,
    priors: bool = False,
) -> Identification:
    """Find entries of a scene file from measured resonances, by least squares of the logarithms of
    frequencies (Gauss and Newton, with exact derivatives).

    Resonances are paired with modes anew in every round; those whose mode is not sure are left out
    and told. Each weighs by its own uncertainty and the bar of its mode; the scatter that is left
    widens all deviations where it is larger. Pairs that may have changed places are tried, and values
    elsewhere that fit as well are told.

    Parameters
    ----------
    scene : path
        Of the scene file.
    vary : iterable of str
        Paths of entries that leave the shape as it is: of materials, springs, masses; with bounds as
        in ``"material.E=180 GPa : 220 GPa"``, or with what is known beforehand, to one standard
        deviation, as in ``"material.E=206 GPa ± 3 %"``.
    tol : float
        Relative, that bars of modes are brought to.
    predict : int
        Modes beyond the highest measured resonance that are predicted.
    priors : bool
        Take ranges of the scene's ``[uncertain]`` for entries that have none here.

    Raises
    ------
    SolidgearError
        For a path that names no positive number, entries that the data do not determine, with the
        direction, and fewer resonances than entries.
    """
    study = _Study(os.fspath(scene), measured, tuple(vary), tol, progress, priors)
    return study.found(predict)


class _Study:
    """Scene, data and where in the space of logarithms of entries it stands."""

    def __init__(
        self,
        path: str,
        measured: Measured,
        vary: Sequence[str],
        tol: float,
        progress: Progress,
        priors: bool,
    ):
        self.path, self.measured, self.tol, self.progress = path, measured, tol, progress
        tables = parse(path)
        ranges = scene_of(tables, path).uncertain if priors else None
        # what is found may lie beside the ranges that the file states
        self.tables: Tables = {key: table for key, table in tables.items() if key != "uncertain"}
        self.varied = varied_of(vary, self.tables, ranges)
        self.keys = [one.keys for one in self.varied]
        self.before = np.array([one.before for one in self.varied])
        self.low = np.array([one.low for one in self.varied])
        self.high = np.array([one.high for one in self.varied])
        self.x = np.array([one.begin for one in self.varied])
        self._around: tuple[np.ndarray, list[tuple[Scene, Scene]]] | None = None
        #: whether all that is varied leaves the body as it is
        self.on_springs = all(surface(low) == surface(high) for low, high in self.around())

    def tables_at(self, x: np.ndarray) -> Tables:
        """Tables with the logarithms of entries moved by `x`."""
        tables = self.tables
        for keys, value in zip(self.keys, self.before * np.exp(x)):
            tables = replace_entry(tables, keys, float(value))
        return tables

    def scene_at(self, x: np.ndarray) -> Scene:
        return scene_of(self.tables_at(x), self.path)

    def around(self) -> list[tuple[Scene, Scene]]:
        """Scenes on either side of where it stands, by entries."""
        if self._around is None or self._around[0] is not self.x:
            steps = STEP * np.eye(len(self.x))
            sides = [(self.scene_at(self.x - own), self.scene_at(self.x + own)) for own in steps]
            self._around = self.x, sides
        return self._around[1]

    def settled(
        self, x: np.ndarray, computed: Computed | None = None, known: Sequence[End] = ()
    ) -> End:
        """Values that a search from `x` ends at, or the known end that it comes to; on the mesh of
        what was computed before.
        """
        highest = self.measured.modes[-1].frequency
        # springs are brought to the data within a round
        early = 1 if self.on_springs else EARLY
        self.x = x
        for turn in range(ROUNDS):
            scene = self.scene_at(self.x)
            if computed is None:
                computed = computed_up_to(scene, highest, self.tol, self.progress)
                self.measured = placed_in(self.measured, computed)
            else:
                self.progress(f"round {turn + 1}")
                computed = computed_like(computed, scene)
            # far from the data pairs are doubtful, and the likelier half of them leads there
            sure = LIKELY if turn < early else SURE
            slopes = self.derivatives(computed)
            fit = Fit(self.measured, self.varied, self.x, computed, slopes, sure)
            if turn == 0 and not fit.determined:
                # where planes are alike to first order no frequency tells them apart; a little off it
                # may
                self.x = np.clip(self.x + NUDGE * fit.right[-1], self.low, self.high)
                continue
            step = fit.step()
            for end in known:
                if fit.apart(self.x + step - end.x) < SAME:
                    return end
            done = max(NONE, LEFT * fit.deviations().min())
            if turn >= early and abs(step).max() < done:
                return End(self.x + step, fit, step)
            if not self.on_springs:
                self.x = self.x + _short(step)
                continue
            step = self._nearer(fit)
            if turn >= early and MISTAKEN * abs(step).max() < done:
                return End(self.x + step, fit, step)
            self.x = self.x + step
        raise SolidgearError(
            f"identify: no values were settled on in {ROUNDS} rounds; the last change was "
            f"{100 * abs(step).max():.2g} %: begin nearer, or vary fewer entries"
        )

    def exchanged(self, best: End, known: list[End]) -> list[End]:
        """Ends that are known, and those that other pairs than the best one's lead to."""
        # no search goes further
        for change in best.fit.exchanges(LONGEST * ROUNDS):
            start = np.clip(best.x + change, self.low, self.high)
            try:
                end = self.settled(start, best.fit.computed, known)
            except SolidgearError:
                continue
            if end not in known:
                known = [*known, end]
        return known

    def found(self, predict: int) -> Identification:
        first = self.settled(self.x)
        # what no pair tells here other pairs may tell
        ends = self.exchanged(first, [first])
        if (end := best_of(ends)) is not first:
            ends = self.exchanged(end, ends)
            end = best_of(ends)
        self.x, computed, fit, step = end.x, end.fit.computed, end.fit, end.step
        fit.refuse_undetermined()
        alike = tuple(
            tuple((self.before * np.exp(one.x)).tolist())
            for one in ends
            if one is not end and one.misfit(fit.scatter) < end.misfit(fit.scatter) + ALIKE
        )
        values = self.before * np.exp(self.x)
        reach = np.exp(fit.students * fit.deviations())
        entries = tuple(
            Identified(
                one.label,
                one.before,
                value,
                deviation,
                max(value / far, one.before * math.exp(one.low)),
                min(value * far, one.before * math.exp(one.high)),
                one.prior,
            )
            for one, value, deviation, far in zip(
                self.varied, values.tolist(), fit.deviations().tolist(), reach.tolist()
            )
        )
        left = fit.residual - fit.rows @ step
        leverage = np.einsum("ip,pq,iq->i", fit.rows, fit.covariance, fit.rows) * fit.weight**2
        alone = 1 - leverage < ALONE
        out = left / np.where(alone, 1.0, 1 - leverage)
        fitted = tuple(
            Fitted(
                str(computed.modes[j].name),
                float(f),
                float(f * math.exp(-a)),
                None if own else float(f * math.exp(-b)),
            )
            for (_, j), f, a, b, own in zip(fit.pairs, fit.frequencies, left, out, alone)
        )
        used = {i for i, _ in fit.pairs}
        return Identification(
            self.scene_at(self.x).title or self.path,
            self.measured.title,
            entries,
            fit.correlations(),
            fitted,
            tuple(m.frequency for i, m in enumerate(self.measured.modes) if i not in used),
            float(np.sqrt(np.mean(left**2))),
            None if alone.all() else float(np.sqrt(np.mean(out[~alone] ** 2))),
            self._predicted(predict, fit, computed) if predict else (),
            computed.mesh,
            self.tables_at(self.x),
            fit.likeness,
            self.measured.remarks,
            alike,
        )

    def _nearer(self, fit: Fit) -> np.ndarray:
        """Change of the logarithms of entries that no mesh hangs on, to the least squares of a body that
        is not solved again.
        """
        sprung, moved = Sprung(fit.computed), np.zeros(len(self.x))
        sides = [(as_supports(low), as_supports(high)) for low, high in self.around()]
        paired = [j for _, j in fit.pairs]
        for _ in range(ROUNDS):
            at = sprung.at(as_supports(self.scene_at(self.x + moved)))
            rows = np.column_stack([sprung.slopes(at, *ends) for ends in sides]) / (2 * STEP)
            # most springs grow with their entry; slopes that are not exact cost a turn
            rows = rows[paired] * np.exp(moved)
            residual = np.log(fit.frequencies / at[0][paired])
            step = _short(fit.step(residual, rows, moved))
            moved = moved + step
            if abs(step).max() < NEARER:
                break
        return moved

    def _predicted(self, count: int, fit: Fit, before: Computed) -> tuple[Predicted, ...]:
        """Modes beyond the highest that was measured."""
        highest = max(before.modes[j].frequency_hz for _, j in fit.pairs)
        scene, limit = self.scene_at(self.x), highest
        while True:
            limit *= WIDER
            self.progress(f"modes up to {limit:.4g} Hz")
            computed = computed_up_to(scene, limit, self.tol, before=before)
            beyond = [
                k
                for k, m in enumerate(computed.modes)
                if highest * (1 + 1e-6) < m.frequency_hz <= limit
            ]
            if len(beyond) >= count or limit > 4 * highest:
                break
        rows = self.derivatives(computed)[beyond]
        spread = np.einsum("ip,pq,iq->i", rows, fit.covariance, rows)
        out = []
        for k, own in zip(beyond[:count], spread):
            mode, bar = computed.modes[k], computed.bars[k]
            relative = math.sqrt(own + fit.scatter**2 + (min(bar, 1.0) / DEVIATIONS) ** 2)
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
        """(modes, entries) derivatives of logarithms."""
        scene, body = computed.scene, computed.body
        forms = [mode_form(body, as_supports(scene), mode) for mode in computed.modes]
        by = Derivatives(scene, body, forms, computed.rung, computed.options).by
        columns = np.column_stack([by(low, high, 2 * STEP) for low, high in self.around()])
        return columns / np.array([mode.frequency_hz for mode in computed.modes])[:, None]


def _short(step: np.ndarray) -> np.ndarray:
    """A step that is no longer than one may be."""
    return step * min(1.0, LONGEST / max(float(abs(step).max()), 1e-300))
