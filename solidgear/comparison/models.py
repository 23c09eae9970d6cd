"""Comparison of one scene by every model, with one verdict."""

from __future__ import annotations

import functools
import gc
import logging
import os
import time
from collections.abc import Callable, Collection
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, overload

from solidgear.comparison.page.write import Pictures, write_all
from solidgear.comparison.recording import Findings, recorded
from solidgear.core import (
    HARMONIC,
    LADDER,
    OpenNumbers,
    Record,
    Scene,
    SolidgearError,
    Solution,
    Source,
    change,
    is_train,
    load,
    name_of_source,
    pinned,
    without_axis,
)
from solidgear.core.display import Displayed
from solidgear.core.judge.causes import SHOWN, attachment_causes, beam_causes, shoulder_cause
from solidgear.core.judge.lumped import synthesise_all
from solidgear.core.judge.quantities import usual
from solidgear.core.judge.study import study
from solidgear.core.judge.ties import SECTION
from solidgear.core.judge.verdict import trusted
from solidgear.core.ladder.meshes import FREE
from solidgear.core.ladder.model import LUMPED, SOLID
from solidgear.core.machine.memory import one_run
from solidgear.core.machine.meter import Meter
from solidgear.core.machine.processes import give_back
from solidgear.core.registry import addition, needed
from solidgear.core.scene.rules import without_point
from solidgear.guards.check import notices
from solidgear.guards.models import cells_around
from solidgear.show.remarks import may_be_open
from solidgear.show.units import units_named

log = logging.getLogger(__name__)
Progress = Callable[[str], None]
Solved = Callable[[str, Solution], None]


def nothing(model: str, solution: Solution) -> None:
    """Do nothing with a solution."""


@dataclass(repr=False)
class Comparison(Displayed):
    """Result of a comparison."""

    shown: ClassVar[str] = "comparison"

    scene: Scene
    record: Record  #: contents of ``results.json``
    solutions: dict[str, Solution]  #: bodies and mode shapes behind the record, by model
    #: when the run began, by ``time.perf_counter``, s
    began: float = field(default_factory=time.perf_counter)

    def let_matrices_go(self) -> None:
        """Give back the memory of what is solved: a report draws and writes, and needs shapes alone."""
        self.solutions = {model: s.without_matrices() for model, s in self.solutions.items()}
        gc.collect()  # guards hold them in circles
        give_back()

    @property
    def results(self) -> dict:
        """The record as plain data."""
        return self.record.as_dict()

    def write_report(
        self,
        out: str | os.PathLike,
        *,
        renders: bool = True,
        units: str = "engineering",
        progress: Progress = lambda _: None,
        pictures: Pictures | None = None,
        sheet: str = "",
    ) -> Path:
        """Write results.json, report.html, mode_*.png and files for other programs into a folder.

        Parameters
        ----------
        out : path
            The folder.
        renders : bool
            Draw mode shapes.
        units : {'engineering', 'si', 'us'}
            Units of the page; results.json is SI always.
        progress : callable
            Called with a sentence at every step.
        pictures : Pictures, optional
            Those that were begun while models were being solved.
        sheet : {'', 'en', 'de'}
            Language of ``sheet.html``, one page to hand on; without one there is none.

        Returns
        -------
        pathlib.Path
            The folder.

        Raises
        ------
        SolidgearError
            If the folder cannot be written, or units are unknown.
        """
        self.record.shown_in = units_named(units).name
        page = None
        if sheet:
            recorded_sheet = needed("sheet", "of a record", "sheet.html")
            page = functools.partial(recorded_sheet, self.record, self.scene, sheet)
        return write_all(
            self.record,
            self.solutions,
            out,
            renders=renders,
            began=self.began,
            progress=progress,
            pictures=pictures,
            sheet=page,
        )


@overload
def compare(
    source: Scene,
    models: tuple[str, ...] | None = None,
    *,
    settings: dict[str, dict] | None = None,
    progress: Progress = ...,
    solved: Solved = ...,
) -> Comparison: ...


@overload
def compare(
    source: Source,
    models: Any = None,
    *,
    settings: dict[str, dict] | None = None,
    progress: Progress = ...,
    solved: Solved = ...,
) -> Any: ...


@pinned
def compare(
    source: Source,
    models: Source | tuple[str, ...] | None = None,
    *,
    settings: dict[str, dict] | None = None,
    progress: Progress = lambda _: None,
    solved: Solved = nothing,
) -> Any:
    """Solve a scene or a train with several models and compare them; or two of them beside each
    other.

    Solids are solved on ever finer meshes until their error bars are small enough: a tenth of the
    tolerance of the scene for the harmonic solid, which judges, all of it for the 3D solid. Where
    the harmonic solid is that sure, the 3D solid is a check, and ends with the first mesh whose
    numbers are within the tolerance of it, or differ by more than both error bars as on the mesh
    before.

    Parameters
    ----------
    source : path, dict, Scene or Train
        A scene or train: its file (TOML), the tables of one, or an object.
    models : tuple of str, path, dict, Scene or Train, optional
        Models of the ladder (lumped, euler, timoshenko, harmonic, solid); all by default. The
        lumped one needs one of the others. Another scene in their place is compared with
        the first, each solved as by :func:`answer`; another train, both by harmonic solids. A train
        alone is judged by every mix of models, as by :func:`judge`.
    settings : dict, optional
        Builder options per model, such as ``{"harmonic": {"order": 8}}``.  Options that concern the
        mesh fix it: that mesh and two coarser ones are solved.
    progress : callable
        Called with a sentence at every step.
    solved : callable
        Called with the name and the solution of every model as soon as it is there.

    Returns
    -------
    Comparison
        After Ctrl-C with the models solved so far, ``record.complete`` False.
    TwoShafts, TwoTrains
        For two: ``inputs`` that differ, ``changes`` of numbers with both error bars, ``modes`` in
        pairs, ``sentences``, ``write_report(out)``.
    TrainComparison
        For a train.

    Raises
    ------
    SolidgearError
        For an unknown model, a scene beside a train, or settings of two scenes.  A model that fails
        is reported as not valid, and the others go on.

    Examples
    --------
    >>> import solidgear as sg
    >>> rod = sg.Segment.cylinder("rod", length=0.6, diameter=0.02)
    >>> comparison = sg.compare(sg.Scene.from_parts([rod]), models=("euler",))
    >>> comparison.record.verdict.sentences
    ['Not judged: no solid was run, and a beam has no error bar.']
    >>> thicker = sg.Segment.cylinder("rod", length=0.6, diameter=0.022)
    >>> shafts = sg.compare(sg.Scene.from_parts([rod]), sg.Scene.from_parts([thicker]))
    >>> shafts["mass"].verdict, round(shafts["mass"].relative, 4)
    ('resolved', 0.21)
    """
    if not isinstance(models, tuple | list | None):
        if settings:
            raise SolidgearError(
                "settings are for models of one scene; for two the program chooses"
            )
        beside = needed("compare", "two designs", "the comparison of two designs")
        return beside(source, models, progress=progress, read=_with_axis)
    if not isinstance(source, Scene) and is_train(source):
        if models or settings:
            raise SolidgearError("models and settings are for one shaft; a train is judged by all")
        return needed("compare", "train", name_of_source(source))(source, progress=progress)
    scene = _with_axis(source)
    models = LADDER.names if models is None else tuple(models)
    check_models(models)
    options = {m: dict((settings or {}).get(m, {})) for m in LADDER.bodies}
    findings = Findings()
    overall, began = Meter(), time.perf_counter()
    with overall.stage("all"), one_run(watched=True) as run:
        try:
            _run(scene, models, options, findings, progress, solved)
            progress("what the data leave open")
            findings.open_ = _opened(scene)
        except KeyboardInterrupt:
            findings.complete = False
            progress("interrupted; keeping what is there")
    record = recorded(scene, findings)
    record.seconds_total = record.seconds_solved = overall.seconds["all"]
    record.peak_mb_total = record.peak_mb = overall.peak_mb
    record.expected_peak_mb = run.expected_mb
    return Comparison(scene, record, findings.solutions, began)


def _with_axis(source: Source) -> Scene:
    """Return a scene that has several models."""
    scene = load(source)
    if without_axis(scene):
        raise SolidgearError(
            "compare: a body without an axis has one model, the 3D solid; run solidgear modes and "
            "stiffness"
        )
    if not scene.ports:
        raise without_point(scene)
    return scene


def _opened(scene: Scene) -> OpenNumbers:
    """Return the ranges of numbers by open inputs of a scene."""
    opened = addition("remark", "open numbers") if may_be_open(scene) else None
    return opened(scene) if opened else OpenNumbers()


def _run(
    scene: Scene, models, options, findings: Findings, progress: Progress, solved: Solved
) -> None:
    lumped = bool(set(LADDER.of(LUMPED)) & set(models))
    # a model that was named is reported where it does not fit
    bodies = LADDER.fit(scene) if set(models) >= set(LADDER.names) else LADDER.bodies
    for model in (m for m in bodies if m in models):
        try:
            chosen = _circumference(scene, model, options[model], findings)
            # A count takes a second factor.  One by a cheaper solid counts for a dearer one, whose
            # modes are paired with its own.
            counted = not _after_a_solid(model, findings.solutions)
            solution = study(
                scene,
                model,
                chosen,
                counted=counted,
                progress=progress,
                keep=functools.partial(findings.solutions.__setitem__, model),
                reference=_checked(scene, model, findings.solutions),
            )
        except (SolidgearError, MemoryError) as error:
            findings.failed[model] = str(error) or "not enough memory"
            log.warning("%s failed: %s", model, findings.failed[model])
            continue
        except KeyboardInterrupt as interrupt:
            if str(interrupt):
                findings.failed[model] = str(interrupt)
            raise
        findings.solutions[model] = solution
        solved(model, solution)
        # A dearer solid's lumped models are those of the cheaper one within error bars, at ten times
        # the price.
        if lumped and not _after_a_solid(model, findings.lumped):
            progress(f"lumped: synthesis from {model}")
            findings.lumped |= synthesise_all(scene, {model: solution}, log.info)
        if solution.scores:
            progress(f"{model}: where the error comes from")
            findings.add_places(scene, solution)
        # Factors are the largest thing a body holds, and no further solution is needed.
        solution.body.cache.clear()
        give_back()
    if findings.solutions:
        progress("guards")
        findings.guards = notices(scene, findings.solutions)
    findings.causes = _causes(scene, findings.solutions, options, progress)


def _after_a_solid(model: str, done: Collection[str]) -> bool:
    """Return True where a model is a solid and another solid is done."""
    solids = LADDER.of(SOLID)
    return model in solids and any(s in done for s in solids if s != model)


def _checked(scene: Scene, model: str, solutions: dict[str, Solution]) -> Solution | None:
    """Return the solution that a solid only checks: one on the exact geometry, of small error."""
    reference, _ = trusted(solutions, scene.ask.tolerance, usual(scene))
    if reference is None or LADDER[model].family != SOLID or not LADDER[reference].follows:
        return None
    return solutions[reference]


def _circumference(scene: Scene, model: str, options: dict, findings: Findings) -> dict:
    """Return the options of a model that divides the circumference into cells, with as many cells
    as the modes need that the harmonic solid found in the range asked for.
    """
    harmonic = findings.solutions.get("harmonic")
    if "around" not in LADDER[model].options or harmonic is None or "around" in options:
        return options
    families = harmonic.modes.evidence.get("families", [])
    ovalising = [row["n"] for row in families if (row["n"] or 0) > 1 and row["modes_below"]]
    waves = max(ovalising, default=1)
    if waves < 2:
        return options
    return {**options, "around": cells_around(scene, waves)}


def check_models(models: tuple[str, ...]) -> None:
    """Refuse unknown models, and the lumped model alone, in one sentence."""
    unknown = [m for m in models if m not in LADDER]
    if unknown or not set(models) & set(LADDER.bodies):
        raise SolidgearError(
            f"models: {', '.join(unknown or models) or 'none given'}; choose from "
            f"{', '.join(LADDER.names)}, and not lumped alone"
        )


def _causes(scene: Scene, solutions: dict[str, Solution], options, progress: Progress) -> list:
    out = []
    progress("causes: switching assumptions one at a time")
    try:
        if "timoshenko" in solutions:
            out += beam_causes(scene)
        for model in LADDER.of(SOLID):
            if model in solutions:
                variants = solutions[model].variants.items()
                out += attachment_causes({a: v.quantities for a, v in variants}, model)
        harmonic, beam = solutions.get("harmonic"), solutions.get("timoshenko")
        if harmonic and beam and SECTION in harmonic.ties and SECTION in beam.ties:
            solid, timoshenko = harmonic.ties[SECTION].quantities, beam.ties[SECTION].quantities
            gap = {name: change(timoshenko, solid, name) for name in SHOWN}
            mesh = HARMONIC
            if options["harmonic"]:
                mesh = {k: v for k, v in harmonic.options.items() if k not in FREE}
            cause = shoulder_cause(scene, gap, mesh, progress)
            if cause:
                out.append(cause)
    except SolidgearError as error:
        log.warning("causes skipped: %s", error)
    return out
