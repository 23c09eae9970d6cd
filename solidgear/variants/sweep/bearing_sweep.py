"""Sweeps of bearings alone: the body once, its reduction once, then small problems, row by row."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from solidgear import __version__
from solidgear.bearings.solved import waiting
from solidgear.core.body import Body
from solidgear.core.errors import SolidgearError, listed
from solidgear.core.ladder import build
from solidgear.core.ladder.registry import LADDER
from solidgear.core.models.limits import number
from solidgear.core.reduction.moments import LEVELS, Reduced, reduce
from solidgear.core.scene import Scene
from solidgear.variants.sweep.bearing_task import Task, columns, without_bars
from solidgear.variants.sweep.bearing_variants import BearingVariants, SeatedShaft
from solidgear.variants.sweep.rows import RowFile, tell_in_log
from solidgear.variants.sweep.workers import workers

#: Most elastic shapes of a row, two columns each; a basis that holds as many is no small problem.
MOST_SHAPES = 1000
#: Variants that the basis is tried on before the run.
PROBES = 24


@dataclass(frozen=True)
class Summary:
    """Account of a sweep."""

    path: Path
    #: total, skipped, refused, full: variants; of these: rows that were there before, refused ones,
    #: and those whose modes were solved on the body itself (the last two of this run)
    total: int
    skipped: int
    refused: int = 0
    full: int = 0
    #: unknowns, seats, basis: of the body; seats on it; unknowns of the largest small problem. Zero
    #: if there was nothing left to do.
    unknowns: int = 0
    seats: int = 0
    basis: int = 0
    #: seconds_once, seconds_each: wall seconds for body and reduction, and per variant of this run
    seconds_once: float = 0.0
    seconds_each: float = 0.0
    #: what was found damaged in the files and how it was mended, a sentence each
    repairs: tuple[str, ...] = ()
    #: why variants are refused, and how many for that reason, of this run
    whys: dict[str, int] = field(default_factory=dict)
    #: of bearings of catalogue data: at which load their stiffness is taken, in a sentence
    settling: str = ""


def sweep(
    variants: BearingVariants,
    out: Path | str,
    *,
    fidelity: str = "harmonic",
    options: Mapping[str, Any] | None = None,
    n: int | None = None,
    tolerance: float = 1e-6,
    bars: Mapping[str, float] | None = None,
    judged_on: int = 0,
    jobs: int = 1,
    dask: str | None = None,
    overwrite: bool = False,
    progress: Callable[[int, int, str], None] = lambda done, total, text: None,
    tell: Callable[[str], None] = tell_in_log,
) -> Summary:
    """Statics and first modes of many bearing sets on one body, as rows of a file.

    Parameters
    ----------
    variants : BearingVariants
        See :func:`solidgear.variants.sweep.bearing_variants.bearing_variants`.
    out : path
        ``.csv`` or ``.parquet``, see :mod:`solidgear.variants.sweep.rows`.
    fidelity, options
        As for :func:`solidgear.core.ladder.build`.
    n : int, optional
        Elastic shapes, twins counted twice; as many as the scene asks for by default.
    tolerance : float
        Relative error of frequencies against the same body solved in full. A variant whose bound
        exceeds it makes the basis larger, and where that does not do it is solved in full.
    bars : mapping of str to float, optional
        Relative, of the mesh, by the names of numbers and modes, as of
        :func:`solidgear.variants.sweep.choice.bars_of_rows`; bars stand in columns beside numbers.
    judged_on : int
        Bearing sets that these are the largest over.
    jobs, dask, overwrite, progress, tell
        As of :func:`solidgear.variants.sweep.file_task.run`.

    Raises
    ------
    SolidgearError
        Values that no variant can have, too many seats, or a file that belongs to another sweep, is
        being written by one, cannot be written, or is damaged beyond repair. A variant that a scene
        file could not describe is no error: its row says why.
    """
    options = dict(options or {})
    scene = variants.scene
    n = scene.ask.modes if n is None else n
    number("sweep", "n", n, least=1, below=MOST_SHAPES + 1, whole=True)
    number("sweep", "jobs", jobs, least=1, whole=True)
    number("sweep", "tolerance", tolerance, above=0, below=1)
    variants.first_sound()
    team = workers(jobs, dask)
    plan = _plan(variants, fidelity, options, n, tolerance)

    total = len(variants)
    said = without_bars(fidelity)
    if bars is not None:
        said = f"of the mesh: the largest over {judged_on} bearing sets"
    with RowFile(
        Path(out), columns(variants, n, bars is not None), plan, total, overwrite, tell
    ) as file:
        skipped, start = len(file.done), time.perf_counter()
        todo = [i for i in range(total) if i not in file.done]
        found = Summary(file.path, total, skipped, settling=_settling(variants))
        if todo:
            shaft = variants.shaft()
            seats = _checked_seats(shaft, scene, fidelity, options)
            progress(skipped, total, f"body with {seats} seats")
            body = build(shaft, fidelity, **options)
            progress(skipped, total, f"reducing {body.size} unknowns")
            basis = reduce(body, n, file.basis or 0)
            solver = _Solver(body, Task(variants, (basis,), n, tolerance, bars or {}, said))
            if file.basis is None:
                # Of all variants, whatever is left of them: the basis is the same after an
                # interruption.
                solver.settle(range(total)[:: max(1, total // PROBES)])
                file.basis = solver.task.bases[0].level
            ready = time.perf_counter()
            size = max(1, min(50, len(todo) // (4 * jobs)))
            parts = [todo[i : i + size] for i in range(0, len(todo), size)]
            for rows in team(lambda: solver.task, parts):
                file.append([solver.repaired(row) for row in rows])
                progress(len(file.done), total, "solving")
            found = replace(
                found,
                refused=solver.whys.total(),
                full=solver.full,
                unknowns=body.size,
                seats=seats,
                basis=solver.task.bases[-1].size,
                seconds_once=ready - start,
                seconds_each=(time.perf_counter() - ready) / len(todo),
                whys=dict(solver.whys),
            )
        file.finish()
    return replace(found, repairs=tuple(file.repairs))


def _settling(variants: BearingVariants) -> str:
    """At which load the stiffness of catalogue bearings is taken in the rows."""
    names = waiting(variants.scene)
    if not names:
        return ""
    which = f"Catalogue {'bearing' if len(names) == 1 else 'bearings'} {', '.join(names)}"
    factors = [one.label for one in variants.entries if variants.multiplies(one)]
    anew = "stiffness under [load]"
    if len(factors) < len(variants.entries):
        anew += ", found anew for every variant"
    if not factors:
        return f"{which}: {anew}."
    return f"{which}: {anew}; {listed(factors)} multiplies it and leaves the loads as they are."


class _Solver:
    """A body, the task with the bases that were needed so far, and what became of its rows."""

    def __init__(self, body: Body, task: Task):
        self.body, self.task = body, task
        self.whys = Counter[str]()
        self.full = 0

    def grow(self) -> bool:
        """Have a larger basis for variants that need it; False if there is none."""
        basis = self._next()
        if basis:
            self.task = replace(self.task, bases=(*self.task.bases, basis))
        return basis is not None

    def settle(self, probes: Sequence[int]) -> None:
        """Begin with a basis that does for some variants, or with the largest."""
        while any(map(self.task.weak, self.task.rows(probes))) and (basis := self._next()):
            self.task = replace(self.task, bases=(basis,))

    def repaired(self, row: dict[str, Any]) -> dict[str, Any]:
        """A row within the tolerance."""
        if row["status"] != "ok":
            self.whys[row["status"]] += 1
            return row
        if self.task.weak(row):
            row = self._again(row)  # there may be a larger basis by now
        while self.task.weak(row) and self.grow():
            row = self._again(row)
        if self.task.weak(row):
            self.full += 1
            row = self.task.in_full(row, self.body)
        return row

    def _next(self) -> Reduced | None:
        level = self.task.bases[-1].level + 1
        return reduce(self.body, self.task.n, level) if level < len(LEVELS) else None

    def _again(self, row: dict[str, Any]) -> dict[str, Any]:
        return self.task.rows([row["variant"]])[0]


def _checked_seats(
    shaft: SeatedShaft, scene: Scene, fidelity: str, options: Mapping[str, Any]
) -> int:
    """Number of seats, which one body must carry."""
    seats, most = len(shaft.stations) - len(scene.ports), LADDER[fidelity].most_seats
    if most is not None and seats > most:
        raise SolidgearError(
            f"{seats} different seats are more than the {most} one {fidelity} body carries; vary "
            "fewer positions, sweep them in parts, or use a cheaper model"
        )
    asked = options.get("attachments") or ()
    kinds = asked if isinstance(asked, (tuple, list)) else (asked,)
    if "rigid" in kinds and seats > len(scene.bearings):
        raise SolidgearError(
            "attachments: a rigid seat stiffens the shaft wherever it is meshed, so seats cannot "
            "be rigid in a sweep of positions"
        )
    return seats


def _plan(variants: BearingVariants, fidelity, options, n, tolerance) -> dict[str, Any]:
    scene = {
        key: value
        for key, value in variants.scene.as_dict().items()
        if key not in ("title", "name", "source", "ask")
    }
    settings = {
        key: list(value) if isinstance(value, tuple) else value for key, value in options.items()
    }
    return {
        "scene": scene,
        **variants.plan,
        "fidelity": fidelity,
        "set": settings,
        "n": n,
        "tolerance": tolerance,
        "version": __version__,
    }
