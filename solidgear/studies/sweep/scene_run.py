"""Run a sweep over entries of a scene file: every variant is read, meshed and solved for itself."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from solidgear import __version__
from solidgear.ladder.registry import LADDER
from solidgear.models.limits import number
from solidgear.studies.sweep.curves import Curves, chartable, curves_of
from solidgear.studies.sweep.design import Design
from solidgear.studies.sweep.file_variants import OWN, plain
from solidgear.studies.sweep.rows import tell_in_log
from solidgear.studies.sweep.running import make_rows
from solidgear.studies.sweep.scene_variants import MOST_MODES, SceneTask, scene_variants


@dataclass(frozen=True)
class SceneSummary:
    """Account of a sweep over entries of a scene file.

    Attributes
    ----------
    total, skipped, refused : int
        Variants; of these: rows that were there before, and refused ones.
    whys : dict of str to int
        Why variants are refused, and how many for that reason.
    seconds : float
        Wall seconds of this run.
    repairs : tuple of str
        What was found damaged in the files and how it was mended, a sentence each.
    curves : Curves or None
        The rows as curves, where one number varies.
    columns : dict of str to list
        Values of all rows.
    """

    path: Path
    total: int
    skipped: int
    refused: int
    whys: dict[str, int]
    seconds: float
    repairs: tuple[str, ...]
    curves: Curves | None
    columns: dict[str, list[Any]]


def sweep_scene(
    scene: Path | str,
    design: Design,
    out: Path | str,
    *,
    model: str | None = None,
    tolerance: float | None = None,
    options: Mapping[str, Any] | None = None,
    n: int | None = None,
    jobs: int = 1,
    dask: str | None = None,
    overwrite: bool = False,
    charted: bool = False,
    progress: Callable[[int, int, str], None] = lambda done, total, text: None,
    tell: Callable[[str], None] = tell_in_log,
) -> SceneSummary:
    """Statics and natural frequencies of many variants of a scene, each with its bars, as rows of a
    file.

    Parameters
    ----------
    scene : path
        Of the scene file.
    design : Design
        Entries that vary: any number or word of the file, such as
        ``segment.neck.diameter=30 mm:40 mm:5``. The change is made to the tables of the file, and
        every rule of the file applies.
    out : path
        ``.csv`` or ``.parquet``. Rows already there from the same sweep are kept and not solved
        again.
    model : str, optional
        None for the cheapest mesh whose bars are within the tolerance, variant by variant; of a
        model that is given rows have no bars.
    tolerance : float, optional
        Relative; that of the scene by default.
    options : mapping, optional
        Of the builder of a model that is given.
    n : int, optional
        Natural frequencies of a row; as many as the scene asks for by default.
    jobs, dask, overwrite, charted, progress, tell
        As of :func:`solidgear.studies.sweep.train_run.sweep_train`.

    Raises
    ------
    SolidgearError
        A path or a value that no variant can have, and a file that belongs to another sweep, is
        being written by one or cannot be written. A variant that the rules of the file refuse is no
        error: its row says why.

    Examples
    --------
    >>> import tempfile
    >>> out = Path(tempfile.mkdtemp()) / "rows.csv"
    >>> design = Design(("segment.1.diameter=45 mm,50 mm",))
    >>> found = sweep_scene("geometry/shaft_stepped.toml", design, out, model="timoshenko")
    >>> found.total, found.refused, found.columns["C_zz"][0] > found.columns["C_zz"][1]
    (2, 0, True)
    """
    start = time.perf_counter()
    number("sweep", "jobs", jobs, least=1, whole=True)
    given = {} if model is None else LADDER[model].checked(dict(options or {}))
    variants = scene_variants(Path(scene), design)
    if charted:
        chartable(variants)
    first = variants.first_sound()
    n = variants.scene(first).ask.modes if n is None else n
    number("sweep", "n", n, least=1, below=MOST_MODES + 1, whole=True)
    task = SceneTask(variants, model, tolerance, given, n)
    made = make_rows(
        task,
        len(variants),
        Path(out),
        task.columns,
        _plan(task, first, design),
        jobs=jobs,
        dask=dask,
        overwrite=overwrite,
        progress=progress,
        tell=tell,
    )
    return SceneSummary(
        made.path,
        len(variants),
        made.skipped,
        sum(made.refusals.values()),
        made.refusals,
        time.perf_counter() - start,
        made.repairs,
        curves_of(made.columns, variants),
        made.columns,
    )


def _plan(task: SceneTask, first: int, design: Design) -> dict[str, Any]:
    """Facts that rows depend on, by the file of one variant."""
    part = task.variants.scene(first).body
    return {
        "scene": plain(task.variants.tables(first)[OWN]),
        "part": part and part.model_dump(mode="json"),
        "vary": task.variants.plan,
        "sample": design.plan,
        "model": task.model,
        "set": plain(task.options),
        "tolerance": task.tolerance,
        "n": task.n,
        "version": __version__,
    }
