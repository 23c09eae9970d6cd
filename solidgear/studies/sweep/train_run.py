"""Run a sweep of a train: bodies once for all variants that share them, row by row."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from solidgear import __version__
from solidgear.errors import SolidgearError, nearest, show
from solidgear.models.limits import number
from solidgear.scene.toml_file import parse
from solidgear.scene.train import Train
from solidgear.studies.sweep.curves import Curves, chartable, curves_of
from solidgear.studies.sweep.design import Design
from solidgear.studies.sweep.file_variants import OWN, plain
from solidgear.studies.sweep.rows import tell_in_log
from solidgear.studies.sweep.running import Made, make_rows
from solidgear.studies.sweep.train_task import ASKED, MOST_MODES, TrainTask
from solidgear.studies.sweep.train_variants import TrainVariants, train_variants
from solidgear.studies.train.layout import contacts
from solidgear.studies.train.misalignment import measured_names
from solidgear.studies.train.models import KEPT
from solidgear.studies.train.shaft import JUDGE, checked_rung

#: most natural frequencies of a row
MOST_SHAPES = 200


@dataclass(frozen=True)
class TrainSummary:
    """Account of a sweep of a train.

    Attributes
    ----------
    total, skipped, refused : int
        Variants; of these: rows that were there before, and refused ones.
    whys : dict of str to int
        Why variants are refused, and how many for that reason.
    bodies : int or None
        Shafts that were meshed and reduced; None where other processes did.
    seconds : float
        Wall seconds of this run.
    cut : int
        Natural frequencies up to the highest frequency that the widest row has and no column holds.
    repairs : tuple of str
        What was found damaged in the files and how it was mended, a sentence each.
    curves : Curves or None
        The rows as curves, where one number varies.
    title : str
        Of the train.
    cautions : tuple of str
        What does not fit together in it but can be solved, of the first variant.
    columns : dict of str to list
        Values of all rows.
    """

    path: Path
    total: int
    skipped: int
    refused: int = 0
    whys: dict[str, int] = field(default_factory=dict)
    bodies: int | None = 0
    seconds: float = 0.0
    cut: int = 0
    repairs: tuple[str, ...] = ()
    curves: Curves | None = None
    title: str = ""
    cautions: tuple[str, ...] = ()
    columns: dict[str, list[Any]] = field(default_factory=dict)


def sweep_train(
    train: Path | str,
    design: Design,
    out: Path | str,
    *,
    pinion: str | None = None,
    gear: str | None = None,
    models: Mapping[str, str] | None = None,
    mesh: str | None = None,
    ask: Iterable[str] = ASKED,
    n: int | None = None,
    max_frequency: float | None = None,
    point: str | None = None,
    every_point: bool = False,
    reduction: str = "rubin",
    kept: int = KEPT,
    local_harmonics: Sequence[int] = (),
    settings: Mapping[Any, Mapping] | None = None,
    jobs: int = 1,
    dask: str | None = None,
    overwrite: bool = False,
    charted: bool = False,
    progress: Callable[[int, int, str], None] = lambda done, total, text: None,
    tell: Callable[[str], None] = tell_in_log,
) -> TrainSummary:
    """Natural frequencies, mesh force and misalignment of many variants of a train, as rows of a
    file.

    Parameters
    ----------
    train : path
        Of the train file.
    design : Design
        Entries that vary: any number or word of the train file, or of the scene of a shaft, such as
        ``pinion.bearing.2.position=140 mm:160 mm:5``. The change is made to the tables of the file,
        and every rule of the file applies.
    out : path
        ``.csv`` or ``.parquet``. Rows already there from the same sweep are kept and not solved
        again.
    pinion, gear : str, optional
        Models of the shafts of these names, as of ``system-modes``; ``harmonic`` by default.
    models : mapping of str to str, optional
        Models of shafts by any name.
    mesh : str, optional
        Whose transmission error drives the train; the first by default.
    ask : iterable of str
        Some of ``system-modes``, ``response`` and ``deflect``: what a row tells, all by default.
    n : int, optional
        Elastic modes of a row; those up to the highest frequency by default.
    max_frequency : float, optional
        Hz; that of the file by default.
    point : str, optional
        Operating point that is looked at, by its name or number; the first by default, or the one
        that varies.
    every_point : bool
        A row for each operating point of the file.
    reduction, kept, settings
        As of :class:`solidgear.studies.train.models.Workshop`.
    local_harmonics : sequence of int
        Of every mesh, in place of those of the file.
    charted : bool
        Refuse at once what no curves can be drawn of.
    jobs : int
        Processes on this machine (joblib), at most eight for each processor.
    dask : str, optional
        Address of a Dask scheduler, whose workers have solidgear installed.
    overwrite : bool
        Discard rows that are there.
    progress : callable
        Called with rows that are there, rows in all, and what is being done.
    tell : callable
        Called with a sentence for every damage to the files that was found and mended.

    Raises
    ------
    SolidgearError
        A path or a value that no variant can have, and a file that belongs to another sweep, is
        being written by one or cannot be written. A variant that the files' rules refuse, or that
        finds no equilibrium, is no error: its row says why.

    Examples
    --------
    >>> import tempfile
    >>> out = Path(tempfile.mkdtemp()) / "rows.csv"
    >>> design = Design(("mesh.stiffness=2e8 N/m:3e8 N/m:3",))
    >>> found = sweep_train("geometry/axle_overhung.toml", design, out, pinion="euler", gear="euler")
    >>> found.total, found.refused, found.bodies
    (3, 0, 2)
    """
    start = time.perf_counter()
    asked = _asked(ask)
    given = {side: one for side, one in (("pinion", pinion), ("gear", gear)) if one is not None}
    given |= models or {}
    for model in given.values():
        checked_rung(model)
    if n is not None:
        number("sweep", "n", n, least=1, below=MOST_SHAPES + 1, whole=True)
    number("sweep", "jobs", jobs, least=1, whole=True)
    variants = train_variants(Path(train), design, point=point, every_point=every_point)
    if local_harmonics:
        tables = variants.files[OWN].get("mesh")
        places = [(k,) for k in range(len(tables))] if isinstance(tables, list) else [()]
        for place in places:
            keys = ("mesh", *place, "local_harmonics")
            variants = variants.with_entry(OWN, keys, list(local_harmonics))
    if charted:
        chartable(variants)
    first = variants.first_sound()
    usual = variants.train(first)
    usual.named_mesh(mesh)
    for side in given:
        usual.named_shaft(side)
    mix = {side: given.get(side, JUDGE) for side in usual.shafts}
    how = reduction, kept, dict(settings or {}), mesh
    task = TrainTask(variants, mix, asked, n, max_frequency, *how)
    made = make_rows(
        task,
        len(variants),
        Path(out),
        task.columns(usual),
        _plan(task, first, usual, design),
        variants.in_turn,
        jobs=jobs,
        dask=dask,
        overwrite=overwrite,
        progress=progress,
        tell=tell,
    )
    found = TrainSummary(made.path, len(variants), made.skipped, title=usual.title or usual.name)
    found = _counted(found, made, task, usual)
    return replace(
        found,
        cautions=tuple(text for met in contacts(usual).values() for text in met.cautions),
        bodies=task.bench.made if jobs == 1 and dask is None else None,
        seconds=time.perf_counter() - start,
        repairs=made.repairs,
        columns=made.columns,
    )


def _asked(ask: Iterable[str]) -> tuple[str, ...]:
    """Kinds of numbers that rows tell, in the usual order."""
    given = list(ask)
    for word in given:
        if word not in ASKED:
            raise SolidgearError(
                f"--ask {show(word, 40)}: a row tells what {', '.join(ASKED)} tell"
                f"{nearest(word, ASKED)}"
            )
    if not given:
        raise SolidgearError(f"--ask: name one or more of {', '.join(ASKED)}")
    return tuple(word for word in ASKED if word in given)


def _counted(found: TrainSummary, made: Made, task: TrainTask, usual: Train) -> TrainSummary:
    """The account of all rows, and their curves where one number varies."""
    widest = max((count for count in made.columns.get("modes", []) if count), default=0)
    drawn = curves_of(made.columns, task.variants, measured_names(usual))
    cut = max(0, widest - MOST_MODES) if task.n is None else 0
    return replace(
        found, refused=sum(made.refusals.values()), whys=made.refusals, cut=cut, curves=drawn
    )


def _plan(task: TrainTask, first: int, usual: Train, design: Design) -> dict[str, Any]:
    """Facts that rows depend on, by the files of one variant."""
    variants = task.variants
    files = {name or "train": plain(t) for name, t in variants.tables(first).items()}
    # what these files name
    cells = [cell.model_dump() for mesh in usual.meshes for cell in mesh.contact_cells]
    parts = [own.scene.body for own in usual.shafts.values()]
    named = {"cells": cells, "parts": [part and part.model_dump(mode="json") for part in parts]}
    settings = {" ".join(key): dict(own) for key, own in task.settings.items()}
    return {
        "files": files,
        **named,
        "scenes": {word: plain(tables) for word, tables in _in_turn(variants)},
        "vary": variants.plan,
        "point": variants.point,
        "sample": design.plan,
        "models": [*task.models.values()],
        "mesh": task.mesh,
        "n": task.n,
        "max_frequency": task.max_frequency,
        "reduction": [task.reduction, task.kept],
        "set": plain(settings),
        "version": __version__,
    }


def _in_turn(variants: TrainVariants) -> Iterator[tuple[str, Any]]:
    """Tables of the scenes that a side has in turn, by the names of their files."""
    for one in variants.entries:
        if one.file == OWN and one.keys[-1] == "scene":
            for word in one.words:
                yield str(word), parse(str(variants.path.parent / str(word)))
