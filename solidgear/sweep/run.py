"""Run a sweep: the body once, its reduction once, then small problems, row by row."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from solidgear.body import Body
from solidgear.errors import SolidgearError
from solidgear.fidelity import build as build_any
from solidgear.fidelity.options import number
from solidgear.fidelity.size import refuse_too_large
from solidgear.scene import Scene
from solidgear.sweep import vary
from solidgear.sweep.reduced import LEVELS, reduce
from solidgear.sweep.rows import RowFile
from solidgear.sweep.task import Task, columns
from solidgear.sweep.variants import SeatedShaft, Variants
from solidgear.sweep.workers import workers

#: Most seats one body carries.  Every seat end is a mesh line, so the mesh grows with their number; beams grow by a node.  Measured on the overhung
#: pinion at these numbers: harmonic 590k unknowns, 2.8 GB, a minute of one core; solid 120k unknowns, 2.4 GB, as long; a beam less than seconds.
MOST_SEATS = {"euler": 200, "timoshenko": 200, "harmonic": 60, "solid": 12}
#: Variants that the basis is tried on before the run.
PROBES = 24


@dataclass(frozen=True)
class Summary:
    """What a sweep did.

    Attributes
    ----------
    path : Path
    total, skipped, refused, full : int
        Variants; of these: rows that were there before, refused ones, and those whose modes were solved on the body itself (the last two of this run).
    unknowns, seats, basis : int
        Of the body; seats on it; unknowns of the largest small problem. Zero if there was nothing left to do.
    seconds_once, seconds_each : float
        Wall seconds for body and reduction, and per variant of this run.
    """

    path: Path
    total: int
    skipped: int
    refused: int = 0
    full: int = 0
    unknowns: int = 0
    seats: int = 0
    basis: int = 0
    seconds_once: float = 0.0
    seconds_each: float = 0.0


def sweep(
    scene: Scene,
    vary_texts: Iterable[str],
    out: Path | str,
    *,
    fidelity: str = "harmonic",
    options: Mapping[str, Any] | None = None,
    n: int | None = None,
    sample: int | None = None,
    seed: int = 0,
    tolerance: float = 1e-6,
    jobs: int = 1,
    dask: str | None = None,
    overwrite: bool = False,
    build: Callable[..., Body] = build_any,
    progress: Callable[[int, int, str], None] = lambda done, total, text: None,
) -> Summary:
    """Statics and first modes of many bearing sets on one body, as rows of a file.

    Parameters
    ----------
    scene : Scene
    vary_texts : iterable of str
        See :mod:`solidgear.sweep.vary`.
    out : path
        ``.csv`` or ``.parquet``. Rows already there from the same sweep are kept and not solved again.
    fidelity, options
        As for :func:`solidgear.fidelity.build`.
    n : int, optional
        Elastic shapes, twins counted twice; as many as the scene asks for by default.
    sample, seed : int, optional
        Draw so many points of a Latin hypercube instead of taking all combinations.
    tolerance : float
        Relative error of frequencies against the same body solved in full. A variant whose bound exceeds it makes the basis
        larger, and where that does not do it is solved in full.
    jobs : int
        Processes on this machine (joblib).
    dask : str, optional
        Address of a Dask scheduler, whose workers have solidgear installed.
    overwrite : bool
        Discard rows that are there.
    build : callable
        Makes the body from a :class:`solidgear.sweep.variants.SeatedShaft`, a fidelity and options.
    progress : callable
        Called with rows that are there, rows in all, and what is being done.

    Returns
    -------
    Summary

    Raises
    ------
    SolidgearError
        A text that cannot be read, too many seats, or a file that belongs to another sweep. A variant that a scene file could not
        describe is no error: its row says why.
    """
    options = dict(options or {})
    n = scene.ask.modes if n is None else number("sweep", "n", n, least=1, whole=True)
    number("sweep", "jobs", jobs, least=1, whole=True)
    number("sweep", "tolerance", tolerance, above=0, below=1)
    variants = variants_of(scene, vary_texts, sample, seed)
    team = workers(jobs, dask)
    shaft = variants.shaft()
    _check_seats(shaft, scene, fidelity, options)
    refuse_too_large(shaft, fidelity, options)  # before a file of rows is begun
    file = RowFile(Path(out), columns(variants, n), _plan(variants, sample, seed, fidelity, options, n, tolerance), overwrite)
    total, skipped = len(variants), len(file.done)
    todo = [i for i in range(total) if i not in file.done]
    if not todo:
        file.finish()
        return Summary(file.path, total, skipped)
    start = time.perf_counter()
    progress(skipped, total, f"body with {len(shaft.stations) - 1} seats")
    body = build(shaft, fidelity, **options)
    progress(skipped, total, f"reducing {body.size} unknowns")
    solver = _Solver(body, Task(variants, reduce(body, n), n, tolerance))
    solver.settle(todo[:: max(1, len(todo) // PROBES)])
    once, start = time.perf_counter() - start, time.perf_counter()
    refused = full = 0
    size = max(1, min(50, len(todo) // (4 * jobs)))
    for rows in team(lambda: solver.task, [todo[i : i + size] for i in range(0, len(todo), size)]):
        rows = [solver.repaired(row) for row in rows]
        file.append(rows)
        refused += sum(row["status"] != "ok" for row in rows)
        full += sum(row["how"] == "full" for row in rows)
        progress(len(file.done), total, "solving")
    file.finish()
    each = (time.perf_counter() - start) / len(todo)
    return Summary(file.path, total, skipped, refused, full, body.size, len(shaft.stations) - 1, solver.task.reduced.size, once, each)


def variants_of(scene: Scene, texts: Iterable[str], sample: int | None = None, seed: int = 0) -> Variants:
    """The points of a sweep: all combinations of ``--vary`` texts, or a sample of them."""
    axes = vary.axes(scene, texts)
    return Variants(scene, axes, vary.product(axes) if sample is None else vary.sample(axes, sample, seed))


class _Solver:
    """A body, and the task with the smallest basis that has done so far."""

    def __init__(self, body: Body, task: Task):
        self.body, self.task = body, task

    def grow(self) -> bool:
        """Enlarge the basis, once for all; False if it is as large as it gets."""
        level = self.task.reduced.level + 1
        if level == len(LEVELS):
            return False
        self.task = replace(self.task, reduced=reduce(self.body, self.task.n, level))
        return True

    def settle(self, probes: Sequence[int]) -> None:
        """Enlarge the basis until it does for some variants, or stays as it is."""
        while any(map(self.task.weak, self.task.rows(probes))) and self.grow():
            pass

    def repaired(self, row: dict[str, Any]) -> dict[str, Any]:
        """A row within the tolerance."""
        if self.task.weak(row):
            row = self._again(row)  # the basis may have grown since
        while self.task.weak(row) and self.grow():
            row = self._again(row)
        return self.task.in_full(row, self.body) if self.task.weak(row) else row

    def _again(self, row: dict[str, Any]) -> dict[str, Any]:
        return self.task.rows([row["variant"]])[0]


def _check_seats(shaft: SeatedShaft, scene: Scene, fidelity: str, options: Mapping[str, Any]) -> None:
    seats, most = len(shaft.stations) - 1, MOST_SEATS.get(fidelity)
    if most is not None and seats > most:
        raise SolidgearError(
            f"{seats} different seats are more than the {most} one {fidelity} body carries; vary fewer positions, sweep them in parts, or use a cheaper model"
        )
    asked = options.get("attachments") or ()
    if "rigid" in ((asked,) if isinstance(asked, str) else asked) and seats > len(scene.bearings):
        raise SolidgearError("attachments: a rigid seat stiffens the shaft wherever it is meshed, so seats cannot be rigid in a sweep of positions")


def _plan(variants: Variants, sample, seed, fidelity, options, n, tolerance) -> dict[str, Any]:
    from solidgear import __version__

    scene = {key: value for key, value in variants.scene.as_dict().items() if key not in ("title", "name", "source", "ask")}
    axes = {axis.label: [axis.spacing, *axis.values] for axis in variants.axes}
    drawn = None if sample is None else {"points": sample, "seed": seed}
    settings = {key: list(value) if isinstance(value, tuple) else value for key, value in options.items()}
    return {"scene": scene, "vary": axes, "sample": drawn, "fidelity": fidelity, "set": settings, "n": n, "tolerance": tolerance, "version": __version__}
