"""The task of a sweep of a shaft: bearings alone on one body, all else variant by variant."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from solidgear.core import LADDER, SolidgearError, Source, document_of
from solidgear.core.arguments import checked
from solidgear.variants.sweep.bearing_task import (
    BearingTask,
    bars_of_rows,
    bearing_task,
    settled_for_sweep,
)
from solidgear.variants.sweep.bearing_variants import BearingVariants, bearing_variants
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.file_task import Task
from solidgear.variants.sweep.scene_task import asked_of, scene_task
from solidgear.variants.sweep.shaft_numbers import ANSWER
from solidgear.variants.sweep.train_task import train_task

#: relative error that a reduction to the seats may leave in frequencies
REDUCED = 1e-6


def task_of(
    source: Source,
    design: Design,
    *,
    progress: Callable[[str], None] = lambda _: None,
    **how: Any,
) -> Task[Any]:
    """Return the task of a sweep of a shaft or train; parameters as of :func:`solidgear.sweep`, and
    `progress`, called with a sentence at every step before the rows.
    """
    document = document_of(source)
    if document.describes_train:
        return checked(train_task, "sweep")(document, design, **how)
    return checked(shaft_task, "sweep")(document, design, progress=progress, **how)


def shaft_task(
    source: Source,
    design: Design,
    *,
    model: str | None = None,
    tolerance: float | str | None = None,
    options: Mapping[str, Any] | None = None,
    n: int | None = None,
    reduction_tolerance: float | None = None,
    ask: Iterable[str] = (),
    progress: Callable[[str], None] = lambda _: None,
) -> Task[Any]:
    """Return the task of a sweep of a shaft: one body does for all where bearings alone vary."""
    kinds = asked_of(ask)
    if kinds == (ANSWER,) and not (design.one_at_a_time or design.table or design.keep_sum):
        sets = bearing_variants(source, design.vary, design.sample, design.seed)
        if sets is not None:
            reduced = REDUCED if reduction_tolerance is None else reduction_tolerance
            return _one_body(sets, model, tolerance, options or {}, n, reduced, progress)
    if reduction_tolerance is not None:
        raise SolidgearError(
            "`reduction_tolerance` is that of one body for many bearing sets, and here more varies"
        )
    return scene_task(
        source, design, model=model, tolerance=tolerance, options=options, n=n, ask=kinds
    )


def _one_body(
    variants: BearingVariants,
    model: str | None,
    tolerance: float | str | None,
    options: Mapping[str, Any],
    n: int | None,
    reduced: float,
    progress: Callable[[str], None],
) -> BearingTask:
    """Return the task of bearings on the mesh asked for, or the cheapest that does for all of them."""
    variants.first_sound()
    if model is not None:
        chosen = LADDER[model].checked(dict(options))
        return bearing_task(variants, model=model, options=chosen, n=n, tolerance=reduced)
    settled = settled_for_sweep(variants, tolerance, progress=progress)
    progress("bars of natural frequencies")
    task = bearing_task(
        variants,
        model=settled.rung,
        options=settled.options,
        n=n,
        tolerance=reduced,
        bars=bars_of_rows(variants, settled, n or variants.scene.ask.modes),
        judged_on=settled.judged_on,
    )
    task.settled = settled
    return task
