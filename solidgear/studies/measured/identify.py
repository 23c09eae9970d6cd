"""Entries of a scene from measured resonances: which the data can tell, their values, and how sure
both they and what is predicted from them are.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Sequence

import numpy as np

from solidgear.body import as_supports
from solidgear.errors import SceneError, SolidgearError, show
from solidgear.scene import Scene
from solidgear.scene.paths import Keys, Tables, changed, entry, keys_of, label_of
from solidgear.scene.toml_file import parse
from solidgear.solve.adjoint import of_mode
from solidgear.studies.loading import scene_of
from solidgear.studies.measured.alignment import align
from solidgear.studies.measured.computed import Computed, computed_like, computed_up_to
from solidgear.studies.measured.correlate import DEVIATIONS, SURE, peaks_of
from solidgear.studies.measured.data import Measured
from solidgear.studies.measured.identified import Fitted, Identification, Identified, Predicted
from solidgear.studies.measured.shapes import mac_of
from solidgear.studies.measured.sprung import Sprung
from solidgear.studies.sensitivity.derivatives import Derivatives
from solidgear.studies.sweep.bench import surface
from solidgear.studies.sweep.entries import in_si

Progress = Callable[[str], None]
#: rounds of Gauss and Newton, the largest change of a logarithm in one, and the one that is none
ROUNDS, LONGEST, NONE = 12, 0.5, 1e-7
#: change of a logarithm that is none between rounds
NEARER = 1e-5
#: rounds in which pairs count from a lower probability on
EARLY, LIKELY = 2, 0.5
#: standard deviation of a logarithm from which on nothing is known of an entry: a factor of two
UNDETERMINED = math.log(2.0)
#: of the logarithm of an entry, to either side, for derivatives
STEP = 1e-4
#: of the logarithm of entries, along what is not told where it begins
NUDGE = 0.03
#: share of the direction that is not determined from which on an entry belongs to it
SHARE = 0.3
#: frequencies beyond the measured ones are looked for in steps of this factor
WIDER = 1.15


def identify(
    scene: str | os.PathLike,
    measured: Measured,
    vary: Iterable[str],
    *,
    tol: float = 2e-4,
    predict: int = 0,
    progress: Progress = lambda _: None,
) -> Identification:
    """Find entries of a scene file from measured resonances, by least squares of the logarithms of
    frequencies (Gauss and Newton, with exact derivatives).

    Resonances are paired with modes anew in every round; those whose mode is not sure are left out
    and told. Each weighs by its own uncertainty and the bar of its mode; the scatter that is left
    widens all deviations where it is larger.

    Parameters
    ----------
    scene : path
        Of the scene file.
    vary : iterable of str
        Paths of entries that leave the shape as it is: of materials, springs, masses.
    tol : float
        Relative, that bars of modes are brought to.
    predict : int
        Modes beyond the highest measured resonance that are predicted.

    Raises
    ------
    SolidgearError
        For a path that names no positive number, entries that the data do not determine, with the
        direction, and fewer resonances than entries.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> file = pathlib.Path(tempfile.mkdtemp()) / "rod.toml"
    >>> _ = file.write_text('material = { E = "200 GPa", nu = 0.3, density = "7850 kg/m^3" }\\n'
    ...     'segment = [{ kind = "cylinder", name = "rod", length = "0.6 m", diameter = "20 mm" }]\\n'
    ...     'port = { at = "rod.middle", attach_to = "rod" }\\n')
    >>> peaks = Measured(uncertainty=1e-3, mode=[{"frequency": f} for f in (254.4, 699.1, 1363.7)])
    >>> found = identify(file, peaks, ["material.E"])
    >>> round(found["material.E"].value / 1e9), found.rms < 2e-3
    (210, True)
    """
    study = _Study(os.fspath(scene), measured, tuple(vary), tol, progress)
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
    ):
        self.path, self.measured, self.tol, self.progress = path, measured, tol, progress
        self.tables = parse(path)
        self.keys = [self._keys(one) for one in vary]
        if not self.keys:
            raise SolidgearError('nothing is varied; give for example --vary "material.E"')
        if len(set(self.keys)) < len(self.keys):
            raise SolidgearError("--vary: the same entry is given twice")
        self.labels = [label_of(keys, self.tables) for keys in self.keys]
        self.before = np.array([self._number(keys) for keys in self.keys])
        self.x = np.zeros(len(self.keys))
        here = surface(self.scene_at(self.x))
        #: whether all that is varied leaves the body as it is
        self.on_springs = all(
            surface(self.scene_at(own)) == here for own in STEP * np.eye(len(self.keys))
        )

    def _keys(self, path: str) -> Keys:
        try:
            return keys_of(path, self.tables)
        except SceneError as error:
            raise SolidgearError(f"--vary {path}: {error}") from None

    def _number(self, keys: Keys) -> float:
        value = in_si(entry(keys, self.tables))
        if value is None or not value > 0:
            raise SolidgearError(
                f"--vary {label_of(keys, self.tables)}: the file holds "
                f"{show(entry(keys, self.tables), 40)}, and what is identified begins at a number "
                "above zero"
            )
        return value

    def tables_at(self, x: np.ndarray) -> Tables:
        """Tables with the logarithms of entries moved by `x`."""
        tables = self.tables
        for keys, value in zip(self.keys, self.before * np.exp(x)):
            tables = changed(tables, keys, float(value))
        return tables

    def scene_at(self, x: np.ndarray) -> Scene:
        return scene_of(self.tables_at(x), self.path)

    def found(self, predict: int) -> Identification:
        highest = self.measured.modes[-1].frequency
        computed: Computed | None = None
        for turn in range(ROUNDS):
            scene = self.scene_at(self.x)
            if computed is None:
                computed = computed_up_to(scene, highest, self.tol, self.progress)
            else:
                self.progress(f"round {turn + 1}")
                computed = computed_like(computed, scene)
            # far from the data pairs are doubtful, and the likelier half of them leads there
            fit = _Fit(self, computed, LIKELY if turn < EARLY else SURE)
            if turn == 0 and not fit.determined:
                # where planes are alike to first order no frequency tells them apart; a little off it
                # may
                self.x = self.x + NUDGE * fit.right[-1]
                continue
            step = fit.step(fit.rows, fit.residual)
            if turn >= EARLY and abs(step).max() < max(NONE, 1e-2 * fit.deviations().min()):
                self.x = self.x + step
                break
            self.x = self.x + (self._nearer(fit, computed) if self.on_springs else _short(step))
        else:
            raise SolidgearError(
                f"identify: no values were settled on in {ROUNDS} rounds; the last change was "
                f"{100 * abs(step).max():.2g} %: begin nearer, or vary fewer entries"
            )
        assert computed is not None  # there is a round at least
        values = self.before * np.exp(self.x)
        fit.refuse_undetermined()
        entries = tuple(
            map(Identified, self.labels, self.before.tolist(), values.tolist(), fit.deviations())
        )
        left = fit.residual - fit.rows @ step
        leverage = np.einsum("ip,pq,iq->i", fit.rows, fit.covariance, fit.rows) * fit.weight**2
        out = left / np.maximum(1 - leverage, 1e-12)
        fitted = tuple(
            Fitted(
                str(computed.modes[j].name),
                float(f),
                float(f * math.exp(-a)),
                float(f * math.exp(-b)),
            )
            for (_, j), f, a, b in zip(fit.pairs, fit.measured, left, out)
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
            float(np.sqrt(np.mean(out**2))),
            self._predicted(predict, fit, computed) if predict else (),
            computed.mesh,
            self.tables_at(self.x),
        )

    def _nearer(self, fit: _Fit, computed: Computed) -> np.ndarray:
        """Change of the logarithms of entries that no mesh hangs on, to the least squares of a body that
        is not solved again.
        """
        sprung, x = Sprung(computed), self.x
        for _ in range(ROUNDS):
            at = sprung.at(as_supports(self.scene_at(x)))
            sides = [
                [as_supports(self.scene_at(x + sign * own)) for sign in (-1, 1)]
                for own in STEP * np.eye(len(x))
            ]
            rows = np.column_stack([sprung.slopes(at, *ends) for ends in sides]) / (2 * STEP)
            step = _short(fit.step(rows[fit.at], np.log(fit.measured / at[0][fit.at])))
            x = x + step
            if abs(step).max() < NEARER:
                break
        return x - self.x

    def _predicted(self, count: int, fit: _Fit, before: Computed) -> tuple[Predicted, ...]:
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
        forms = [of_mode(body, as_supports(scene), mode) for mode in computed.modes]
        by = Derivatives(scene, body, forms, computed.rung, computed.options).by
        columns = []
        for own in STEP * np.eye(len(self.keys)):
            columns.append(by(self.scene_at(self.x - own), self.scene_at(self.x + own), 2 * STEP))
        frequencies = np.array([mode.frequency_hz for mode in computed.modes])
        return np.column_stack(columns) / frequencies[:, None]


class _Fit:
    """A linear fit about one scene."""

    def __init__(self, study: _Study, computed: Computed, sure: float):
        self.study = study
        shapes = study.measured.shapes
        mac = None if shapes is None else mac_of(shapes, computed)
        found = align(*peaks_of(study.measured, computed), mac)
        likely = found.pairs.argmax(axis=1)
        #: resonance and mode of each pair that is sure enough to be fitted
        self.pairs = [(i, int(j)) for i, j in enumerate(likely) if found.pairs[i, j] >= sure]
        unknowns = len(study.keys)
        if len(self.pairs) < unknowns:
            raise SolidgearError(
                f"identify: {len(self.pairs)} resonances have a sure mode, fewer than the {unknowns} "
                "entries that are to be found; vary fewer, or measure more"
            )
        every = study.derivatives(computed)
        modes = [study.measured.modes[i] for i, _ in self.pairs]
        self.at = at = [j for _, j in self.pairs]
        self.rows = every[at]
        #: (pairs,) frequencies, Hz
        self.measured = np.array([m.frequency for m in modes])
        self.residual = np.log(self.measured / [computed.modes[j].frequency_hz for j in at])
        own = np.array([(m.width_hz or 0.0) / m.frequency for m in modes])
        mesh = np.array([min(computed.bars[j], 1.0) / DEVIATIONS for j in at])
        variance = own**2 + mesh**2
        # the scatter that is left counts for all alike
        spare = max(len(at) - unknowns, 1)
        best = self.residual - self.rows @ np.linalg.lstsq(self.rows, self.residual, rcond=None)[0]
        self.scatter = math.sqrt(max(float(best @ best) / spare - float(variance.mean()), 0.0))
        self.weight = 1 / np.sqrt(variance + self.scatter**2 + 1e-24)
        _, sizes, right = np.linalg.svd(self.rows * self.weight[:, None], full_matrices=False)
        self.sizes, self.right = sizes, right
        kept = np.maximum(sizes, 1e-30)
        #: of the logarithms of entries
        self.covariance = (right.T / kept**2) @ right

    def step(self, rows: np.ndarray, residual: np.ndarray) -> np.ndarray:
        """Change of the logarithms of entries from (pairs, entries) derivatives and (pairs,) residuals;
        none along what the data do not tell.
        """
        left, sizes, right = np.linalg.svd(rows * self.weight[:, None], full_matrices=False)
        told = sizes > 1 / UNDETERMINED
        return ((left.T @ (residual * self.weight))[told] / sizes[told]) @ right[told]

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
        return len(self.sizes) == len(self.study.keys) and self.sizes[-1] * UNDETERMINED >= 1

    def refuse_undetermined(self) -> None:
        """Refuse entries of which a direction is not told by the data."""
        if self.determined:
            return
        deviation = 1 / max(float(self.sizes[-1]), 1e-30)
        direction = self.right[-1]
        among = [
            f"{label} {'up' if part > 0 else 'down'}"
            for label, part in zip(
                self.study.labels, direction * np.sign(direction[abs(direction).argmax()])
            )
            if abs(part) >= SHARE * abs(direction).max()
        ]
        what = " with ".join(among)
        raise SolidgearError(
            f"identify: these resonances do not tell {what}: any change that way moves them by less "
            f"than their scatter ({_factor(deviation)}); "
            "leave one of them out, or measure a mode that it moves"
        )


def _short(step: np.ndarray) -> np.ndarray:
    """A step, no longer than what one round may go."""
    return step * min(1.0, LONGEST / max(float(abs(step).max()), 1e-300))


def _factor(deviation: float) -> str:
    """Standard deviation of a logarithm in words."""
    return (
        "without any bound"
        if deviation > 10
        else f"standard deviation: a factor of {math.exp(deviation):.3g}"
    )
