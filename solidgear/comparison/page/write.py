"""Everything a comparison leaves in its folder."""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TypeVar

from solidgear.comparison.page.html import drawn_charts, page_template, write_report
from solidgear.core import LADDER, ModeSet, Quantity, Record, Scene, Solution
from solidgear.core.judge.where import least_certain
from solidgear.core.ladder.model import SOLID
from solidgear.core.machine.meter import Meter
from solidgear.core.machine.processes import family_memory
from solidgear.core.quantity import FIRST_BENDING
from solidgear.show.folder import begun
from solidgear.show.outputs import OUTPUTS
from solidgear.show.page_parts import data_uri
from solidgear.show.render import Drawing, Drawn, RenderJob, RenderResult
from solidgear.show.sheet import write_json
from solidgear.show.turning import Turned, turned
from solidgear.show.viewer import TURNED, Turning
from solidgear.show.where_surface import where_surface

R = TypeVar("R")
#: one page to hand on, beside the report
SHEET = "sheet.html"


class Pictures:
    """Pictures of mode shapes and of an error bar, begun as soon as a 3D solid is solved: who draws takes
    as much memory as solving does.
    """

    def __init__(self, drawing: Drawing, out: str | os.PathLike):
        self.drawing, self.folder = drawing, Path(out)
        self.jobs: dict[str, RenderJob] = {}  #: of mode shapes, by model
        self.waiting: list[tuple[str, Solution]] = []  #: models solved before it
        self.error: RenderJob | None = None  #: of the first 3D solid

    def begin_early(self, scene: Scene, model: str, solution: Solution) -> None:
        """Begin the pictures of all models so far with that of a 3D solid, before the report is written;
        why they failed is told there.
        """
        self.waiting.append((model, solution))
        if LADDER[model].family != SOLID or LADDER[model].follows:
            return
        with contextlib.suppress(Exception):
            while self.waiting:
                self.begin(*self.waiting.pop(0))
        with contextlib.suppress(Exception):
            if quantity := least_certain(scene, solution):
                self.begin_error(model, solution, quantity)

    def begin(self, model: str, solution: Solution) -> None:
        """Begin the picture of a model, unless it has none or is begun."""
        name = _drawn_mode(solution.modes)
        if name is not None and model not in self.jobs:
            drawn = Drawn(solution.body, solution.modes, LADDER[model].title)
            self.jobs[model] = drawn.job(name, self.folder / f"mode_{model}.png")
            self.drawing.add(self.jobs[model])

    def begin_error(self, model: str, solution: Solution, quantity: Quantity) -> None:
        """Begin the picture of the cells that an error bar comes from, unless one is begun."""
        if self.error is None:
            title = f"{LADDER[model].title}: error bar of {quantity} by cells"
            path = self.folder / f"error_{model}.png"
            job = where_surface(solution.body, solution.scores[quantity], title, path)
            self.drawing.add(job)
            self.error = job

    @property
    def all_jobs(self) -> list[RenderJob]:
        """Those of mode shapes and of the error bar."""
        return [*self.jobs.values(), *([self.error] if self.error else [])]


def write_all(
    record: Record,
    solutions: dict[str, Solution],
    out: str | os.PathLike,
    *,
    renders: bool,
    began: float,
    progress: Callable[[str], None],
    pictures: Pictures | None = None,
    sheet: Callable[[Path], object] | None = None,
) -> Path:
    """Write results.json, renders, files for other programs and the report; see
    :meth:`solidgear.comparison.models.Comparison.write_report`.

    The run has taken what has passed since it `began`, by ``time.perf_counter``.
    The record gains ``files``, what was written beside it, and ``left_out``, a sentence for what
    could not be drawn or written; `sheet` writes one page to hand on into a file. After an
    interrupt there are numbers and a report, and no shapes: who has pressed Ctrl-C does not want to
    wait for them.
    """
    record.left_out = []
    shapes = solutions if record.complete else {}
    meter = Meter(family_memory())
    with begun(out) as folder, meter.stage("report"):
        # Numbers first: whatever happens to pictures, they are there.  What is about to be
        # written is listed before it is.
        record.files = [
            "report.html",
            *(output.name(m) for m in shapes for output in OUTPUTS),
            *(f"mode_{m}.png" for m in shapes if renders),
            *(f"error_{m}.png" for m in shapes if renders and m == _shaded(record)),
            *([TURNED] if shapes and renders else []),
            *([SHEET] if shapes and sheet else []),
        ]
        write_json(folder / "results.json", record.as_dict())
        if renders and shapes:
            progress("renders")
        # They are drawn in a process beside this one, which writes and draws the rest meanwhile.
        with contextlib.ExitStack() as stack:
            pictures = pictures or Pictures(stack.enter_context(Drawing()), folder)
            for model, solution in shapes.items() if renders else ():
                _try(record, f"render of {model}", partial(pictures.begin, model, solution))
            where, shaded = record.where_solid, shapes.get(_shaded(record))
            if renders and where is not None and shaded is not None:
                quantity = Quantity(where.quantity)
                begin = partial(pictures.begin_error, where.model, shaded, quantity)
                _try(record, "picture of the error bar", begin)
            for job in pictures.all_jobs:
                job.path.unlink(missing_ok=True)  # whoever made it, it must not pass for ours
            for model, solution in shapes.items():
                for output in OUTPUTS:
                    what, target = f"{output.what} of {model}", folder / output.name(model)
                    _try(record, what, partial(output.write, solution, target))
            progress("report")
            drawn = drawn_charts(record, folder)
            viewer = "viewer of mode shapes"
            turning = _try(record, viewer, partial(_turning, record, shapes if renders else {}))
            page_template()  # compiled now
            results = (
                {result.path: result for result in pictures.drawing.results()} if renders else {}
            )
            _note(record, pictures.jobs, results)
            if pictures.error is not None and (result := results.get(pictures.error.path)):
                _note_error(record, result)
        if turning is not None:
            _try(record, viewer, partial(_write_turned, turning, record, shapes, folder))
        if sheet and shapes:
            progress("sheet")
            _try(record, "sheet", partial(sheet, folder / SHEET))
        record.files = [
            name for name in record.files if name == "report.html" or (folder / name).exists()
        ]
        record.seconds_total = time.perf_counter() - began
        peaks = [peak for peak in (record.peak_mb, meter.peak_mb) if peak is not None]
        record.peak_mb_total = max(peaks, default=None)
        write_json(folder / "results.json", record.as_dict())
        write_report(record, folder, drawn=drawn)
    return folder


def _try(record: Record, name: str, action: Callable[[], R]) -> R | None:
    """Return the result of an action that numbers do not depend on; a failure becomes a warning
    and None.
    """
    try:
        return action()
    except OSError:
        raise
    except Exception as error:
        _leave_out(record, f"{name} left out: {error}")
        return None


def _leave_out(record: Record, sentence: str) -> None:
    record.left_out.append(sentence)
    record.warnings.append(sentence)


def _shaded(record: Record) -> str:
    """Return the model on whose surface its error bar is shown; empty without one."""
    return record.where_solid.model if record.where_solid else ""


def _note_error(record: Record, result: RenderResult) -> None:
    """Record the picture of an error bar, or why there is none."""
    if result.ok and record.where_solid is not None:
        record.where_solid.picture = result.path.name
    else:
        _leave_out(record, f"picture of the error bar left out: {result.reason}")


def _note(
    record: Record, jobs: Mapping[str, RenderJob], results: Mapping[Path, RenderResult]
) -> None:
    """Record the pictures that were drawn, and why others were left out."""
    reasons: dict[str, list[str]] = {}
    for model, job in jobs.items():
        result = results.get(job.path)
        if result is None:
            continue
        if result.ok:
            record.images[model] = result.path.name
        else:
            reasons.setdefault(result.reason, []).append(model)
    for reason, models in reasons.items():
        _leave_out(record, f"render of {', '.join(models)} left out: {reason}")


def _turning(record: Record, shapes: dict[str, Solution]) -> Turning | None:
    """Return the page of mode shapes, the most detailed models first; None where nothing moves."""
    models: list[Turned] = []
    for key, solution in reversed(shapes.items()):
        if _turns(solution):
            models.append(turned(solution.body, solution.modes, record.name(key), models))
    if not models:
        return None
    title = record.scene.get("title") or record.scene.get("name") or ""
    turning = Turning(tuple(models), title, cautions=record.warnings)
    turning.packed  # noqa: B018  # now, while pictures are drawn
    return turning


def _write_turned(
    turning: Turning, record: Record, shapes: dict[str, Solution], folder: Path
) -> None:
    """Write the page of mode shapes with the picture of the first model that has one."""
    keys = [key for key in reversed(shapes) if key in record.images and _turns(shapes[key])]
    stills = (data_uri(key, folder / record.images[key]) for key in keys)
    turning.write(folder / TURNED, still=next(filter(None, stills), ""))


def _turns(solution: Solution) -> bool:
    """Return whether a model has a shape to be turned."""
    return solution.body.geometry is not None and _drawn_mode(solution.modes) is not None


def _drawn_mode(modes: ModeSet) -> str | None:
    """Return the mode that a report shows: first bending, else the lowest elastic one."""
    if modes.named(FIRST_BENDING):
        return FIRST_BENDING
    return next((mode.name for mode in modes.modes if mode.frequency_hz > 0), None)
