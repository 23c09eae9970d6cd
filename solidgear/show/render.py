"""Pictures of mode shapes and of shares of an error bar, drawn in a child process.

Without the system's OpenGL libraries VTK does not raise, it takes the process down with a
segmentation fault. So a child draws, the caller reads how it ended, and a failed picture never costs
a number.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core import SolidgearError, whole
from solidgear.core.machine.patience import Patience
from solidgear.show.drawing import ARRAYS, LAST

if TYPE_CHECKING:
    from solidgear.core import Body, ModeSet, Surface

PACKAGES = (
    "apt-get install libgl1 libegl1 libegl-mesa0 libglu1-mesa "
    "libxft2 libxinerama1 libxcursor1 libgomp1"
)
WINDOW = "VTK_DEFAULT_OPENGL_WINDOW"
#: what a child writes to its standard error
SAID = "said.txt"
#: a shape as it is, without a caption
STILL = ((1.0, ""),)


@dataclass(frozen=True, eq=False)
class RenderJob:
    """One picture to draw."""

    surface: Surface
    title: str  #: such as ``harmonic - bending 1 - 2758.0 Hz``
    path: Path  #: of the png
    #: factors on the displacement and what is written over each, side by side
    frames: Sequence[tuple[float, str]] = STILL
    along: bool = True  #: one shaft along y, seen across its motion; else a train, seen from above
    #: (m,) of its faces, in the colours of which it is drawn at rest, and what they are
    shades: np.ndarray | None = None
    shade: str = ""


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


@dataclass(frozen=True)
class RenderResult:
    """Outcome of a :class:`RenderJob`."""

    path: Path  #: holds the new picture if ``ok``; otherwise whatever was there before is untouched
    reason: str = ""  #: one sentence on what went wrong, and what mends it; empty if ``ok``

    @property
    def ok(self) -> bool:
        """True if it was drawn and written."""
        return not self.reason


def render_modes(jobs: Iterable[RenderJob], *, timeout: float = 120) -> list[RenderResult]:
    """Draw deformed shafts over their shape at rest within `seconds` of processor time; return a
    result per job.
    """
    with Drawing(jobs, timeout=timeout) as drawing:
        return drawing.results()


class Drawing:
    """Pictures being drawn by a child, while the caller does something else.

    As a context manager: the child is gone where it is left. It starts with the first picture, ends
    by itself when it has drawn all that it was asked for, or should the caller die, and another
    starts with the next picture: what is solved between them has its memory.
    """

    def __init__(self, jobs: Iterable[RenderJob] = (), *, timeout: float = 120):
        self.jobs: list[RenderJob] = []
        self._first, self._patience = list(jobs), Patience(timeout)
        self._child: subprocess.Popen | None = None
        self._end = ""

    def __enter__(self) -> Drawing:
        self._folder = tempfile.TemporaryDirectory(
            prefix="solidgear-render-", ignore_cleanup_errors=True
        )
        self._windows = _windows()  # the first is the one that is tried
        try:
            for job in self._first:
                self.add(job)
        except BaseException:
            self.__exit__()
            raise
        return self

    def add(self, job: RenderJob) -> None:
        """Begin a picture."""
        self._hand_over(len(self.jobs), job)
        self.jobs.append(job)
        # after a child that failed, `results` tries the other windows
        if not self._end and (self._child is None or self._child.poll() == 0):
            self._end = self._start()

    def __exit__(self, *_) -> None:
        if self._child is not None and self._child.poll() is None:
            self._child.kill()
            self._child.wait()
        self._folder.cleanup()

    def results(self) -> list[RenderResult]:
        """Wait for the pictures and put them in their places; a result a job."""
        if not self.jobs:
            return []
        (self._room / LAST).touch()
        end = self._end or self._wait()
        # A picture may have been handed over as the child ended: no later one ends before `LAST`.
        if not end and not self._answered:
            end = self._start() or self._wait()
        # A child that reached the end of its list has said all there is to say.
        while end and self._windows[1:] and self._patience.remaining > 0:
            self._windows.pop(0)
            end = self._start() or self._wait()
        return [
            RenderResult(job.path, _collect(self._room, i, job.path, end))
            for i, job in enumerate(self.jobs)
        ]

    @property
    def _room(self) -> Path:
        return Path(self._folder.name)

    @property
    def _answered(self) -> bool:
        """Whether every job has its picture, or the reason why there is none."""
        return all(
            any(file.exists() for file in _answers(self._room, i)) for i in range(len(self.jobs))
        )

    def _hand_over(self, index: int, job: RenderJob) -> None:
        """Write a job as files for the child."""
        arrays = {name: getattr(job.surface, name) for name in ARRAYS}
        if job.shades is not None:
            arrays["shades"] = job.shades
        np.savez(self._room / f"{index}.npz", **arrays)
        words = {
            "title": job.title,
            "frames": list(job.frames),
            "along": job.along,
            "shade": job.shade,
        }
        # whole, since the child looks for it
        partial = self._room / f"{index}.part.json"
        partial.write_text(json.dumps(words), encoding="utf-8")
        os.replace(partial, self._room / f"{index}.json")

    def _start(self) -> str:
        """Start a child on the remaining pictures; return why it could not."""
        env = dict(os.environ)
        if window := self._windows[0]:
            env[WINDOW] = window
        # The child must find the same solidgear, wherever the caller runs.
        root = str(Path(__file__).resolve().parents[2])
        env["PYTHONPATH"] = os.pathsep.join(filter(None, [root, env.get("PYTHONPATH")]))
        command = [
            sys.executable,
            "-m",
            "solidgear.show.drawing",
            str(self._room),
            str(os.getpid()),
        ]
        try:
            # into a file: nobody empties a pipe meanwhile
            with (self._room / SAID).open("wb") as errors:
                self._child = subprocess.Popen(
                    command,
                    env=env,
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.DEVNULL,
                    stderr=errors,
                )
        except OSError as error:
            return f"could not be started ({error})"
        return ""

    def _wait(self) -> str:
        """Wait for the child; return how it died, or an empty text."""
        child = self._child
        assert child is not None
        code = self._patience.wait(child)
        if self._patience.reason:
            return self._patience.reason
        if code == 0:
            return ""
        if code < 0:
            return f"was ended by signal {-code}"
        text = (self._room / SAID).read_text(encoding="utf-8", errors="replace")
        last = next((line.strip() for line in reversed(text.splitlines()) if line.strip()), "")
        return f"ended with status {code}" + (f" ({last[:200]})" if last else "")


def _windows() -> list[str | None]:
    """Return VTK windows to try in turn; None leaves the choice to VTK."""
    if not sys.platform.startswith("linux") or WINDOW in os.environ:
        return [None]
    # A display that is set may still be dead, as over a lost ssh connection.
    return ([None] if os.environ.get("DISPLAY") else []) + [
        "vtkEGLRenderWindow",
        "vtkOSOpenGLRenderWindow",
    ]


def _answers(room: Path, index: int) -> tuple[Path, Path]:
    """Return the picture that a child makes of a job, and the reason that it leaves instead."""
    return room / f"{index}.png", room / f"{index}.txt"


def _collect(room: Path, index: int, path: Path, end: str) -> str:
    """Move a finished picture to its place, or return why there is none and how to mend it."""
    drawn, errors = _answers(room, index)
    if errors.exists():
        return f"the picture {path.name} could not be drawn: {errors.read_text(encoding='utf-8')}"
    if drawn.exists():
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with whole(path) as partial:
                shutil.copyfile(drawn, partial)
        except OSError as error:
            return f"the picture {path} could not be written: {error.strerror or error}"
        return ""
    fault = end or "left no picture"
    return f"the drawing process {fault}; on Debian and Ubuntu install OpenGL by `{PACKAGES}`"
