"""Everything a comparison leaves in its folder."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from solidgear.comparison.page.html import drawn_charts, write_report
from solidgear.core import SolidgearError
from solidgear.show.folder import begun, prepare
from solidgear.show.outputs import OUTPUTS
from solidgear.show.page_parts import data_uri
from solidgear.show.render import Drawing, RenderJob, render_modes
from solidgear.show.sheet import write_json
from solidgear.show.turning import Turned, turned
from solidgear.show.viewer import TURNED, Turning

if TYPE_CHECKING:
    from solidgear.core import Body, ModeSet, Record, Solution
    from solidgear.show.render import RenderResult

MODE = "bending 1"


def write_all(
    record: Record,
    solutions: dict[str, Solution],
    out: str | os.PathLike,
    *,
    renders: bool,
    progress: Callable[[str], None],
) -> Path:
    """Write results.json, renders, files for other programs and the report; see
    :meth:`solidgear.comparison.models.Comparison.write_report`.

    The record gains ``files``, what was written beside it, and ``left_out``, a sentence for what
    could not be drawn or written. After an interrupt there are numbers and a report, and no shapes:
    who has pressed Ctrl-C does not want to wait for them.
    """
    record.left_out = []
    shapes = solutions if record.complete else {}
    with begun(out) as folder:
        # Numbers first: whatever happens to pictures, they are there.  What is about to be
        # written is listed before it is.
        record.files = [
            "report.html",
            *(output.name(m) for m in shapes for output in OUTPUTS),
            *(f"mode_{m}.png" for m in shapes if renders),
            *([TURNED] if shapes and renders else []),
        ]
        write_json(folder / "results.json", record.as_dict())
        if renders and shapes:
            progress("renders")
        jobs = _jobs(record, shapes, folder) if renders else {}
        # They are drawn in a process beside this one, which writes and draws the rest meanwhile.
        with Drawing(jobs.values()) as drawing:
            for model, solution in shapes.items():
                for output in OUTPUTS:
                    what, target = f"{output.what} of {model}", folder / output.name(model)
                    _try(record, what, output.write, solution, target)
            progress("report")
            drawn = drawn_charts(record, folder)
            _note(record, jobs, drawing.results())
        if renders and shapes:
            _try(record, "viewer of mode shapes", _write_turned, record, shapes, folder)
        record.files = [
            name for name in record.files if name == "report.html" or (folder / name).exists()
        ]
        write_json(folder / "results.json", record.as_dict())
        write_report(record, folder, drawn=drawn)
    return folder


def _try(record: Record, name: str, action: Callable[..., Any], *arguments: Any) -> Any:
    """Return the result of an action that numbers do not depend on; a failure becomes a warning
    and None.
    """
    try:
        return action(*arguments)
    except OSError:
        raise
    except Exception as error:
        _leave_out(record, f"{name} left out: {error}")
        return None


def _leave_out(record: Record, sentence: str) -> None:
    record.left_out.append(sentence)
    record.warnings.append(sentence)


def _jobs(record: Record, shapes: dict[str, Solution], folder: Path) -> dict[str, RenderJob]:
    """Return the pictures to be drawn, by model."""
    jobs: dict[str, RenderJob] = {}
    for model, solution in shapes.items():
        name = _drawn_mode(solution.modes)
        if name is None:
            continue
        path = folder / f"mode_{model}.png"
        path.unlink(missing_ok=True)  # whoever made it, it must not pass for this run's
        drawn = Drawn(solution.body, solution.modes, record.name(model))
        job = _try(record, f"render of {model}", drawn.job, name, path)
        if job is not None:
            jobs[model] = job
    return jobs


def _note(record: Record, jobs: Iterable[str], results: Iterable[RenderResult]) -> None:
    """Record the pictures that were drawn, and why others were left out."""
    reasons: dict[str, list[str]] = {}
    for model, result in zip(jobs, results):
        if result.ok:
            record.images[model] = result.path.name
        else:
            reasons.setdefault(result.reason, []).append(model)
    for reason, models in reasons.items():
        _leave_out(record, f"render of {', '.join(models)} left out: {reason}")


def _write_turned(record: Record, shapes: dict[str, Solution], folder: Path) -> None:
    """Write the page of mode shapes, the most detailed models first."""
    still = ""
    models: list[Turned] = []
    for key, solution in reversed(shapes.items()):
        if solution.body.geometry is None or _drawn_mode(solution.modes) is None:
            continue
        models.append(turned(solution.body, solution.modes, record.name(key), models))
        if not still and key in record.images:
            still = data_uri(key, folder / record.images[key]) or ""
    if models:
        title = record.scene.get("title") or record.scene.get("name") or ""
        Turning(tuple(models), title).write(folder / TURNED, still=still)


def _drawn_mode(modes: ModeSet) -> str | None:
    """Return the mode that a report shows: first bending, else the lowest elastic one."""
    if modes.named(MODE):
        return MODE
    for mode in modes.modes:
        if mode.frequency_hz > 0:
            return mode.name
    return None


@dataclass(frozen=True, eq=False)
class Drawn:
    """A body, its modes, and what it is called in a picture or page."""

    body: Body
    modes: ModeSet
    title: str

    def job(self, name: str, path: Path) -> RenderJob:
        """Return a picture of the mode of that name.

        Raises
        ------
        SolidgearError
            If there is none.
        """
        mode = self.modes.named(name)
        if mode is None:
            have = ", ".join(m.name for m in self.modes.modes)
            raise SolidgearError(
                f"mode {name!r}: the {self.title} has none of that name; it has {have}"
            )
        title = f"{self.title}: {mode.name}, {mode.frequency_hz:.1f} Hz"
        return RenderJob(self.body.surface(mode.vectors[0]), title, path)


def render_mode(drawn: Drawn, name: str, path: Path) -> Path:
    """Draw one mode of one body.

    Raises
    ------
    SolidgearError
        If there is no such mode, or nothing can be drawn here (the sentence says what mends it).
    """
    job = drawn.job(name, path)
    prepare(path.parent)
    try:
        (result,) = render_modes([job])
    except OSError as error:  # the drawing process is handed its shape in a temporary file
        raise SolidgearError(
            f"--out {path}: drawing stopped ({error.strerror or error}); "
            "free some space there and in the folder for temporary files"
        ) from error
    if not result.ok:
        raise SolidgearError(result.reason)
    return result.path


def turn_modes(drawn: Sequence[Drawn], path: Path, title: str, name: str) -> tuple[Path, str]:
    """Write a page of all modes to turn; return its path and why it has no picture for print."""
    prepare(path.parent)
    models: list[Turned] = []
    for drawing in drawn:
        drawing.job(name, path)
        models.append(turned(drawing.body, drawing.modes, drawing.title, models))
    still, sentence = "", ""
    with tempfile.TemporaryDirectory(prefix="solidgear-turn-") as folder:
        try:
            picture = render_mode(drawn[0], name, Path(folder) / "mode.png")
            still = data_uri("mode", picture) or ""
        except SolidgearError as error:
            sentence = f"no picture for print in {path.name}: {error}"
    return Turning(tuple(models), title, name).write(path, still=still), sentence
