"""Pictures of mode shapes, drawn in a child process.

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
import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from solidgear.body.surface import Surface

PACKAGES = (
    "apt-get install libgl1 libegl1 libegl-mesa0 libglu1-mesa "
    "libxft2 libxinerama1 libxcursor1 libgomp1"
)
WINDOW = "VTK_DEFAULT_OPENGL_WINDOW"
ARRAYS = ("points", "displacement", "faces", "triangles", "lines")
#: a shape as it is, without a caption
STILL = ((1.0, ""),)


@dataclass(frozen=True, eq=False)
class RenderJob:
    """One picture to draw.

    Attributes
    ----------
    surface : Surface
    title : str
        Such as ``harmonic - bending 1 - 2758.0 Hz``.
    path : str or Path
        Of the png.
    frames : sequence of (float, str)
        Factors on the displacement and what is written over each, side by side.
    along : bool
        One shaft along y, seen across its motion; else two shafts, seen from above.
    """

    surface: Surface
    title: str
    path: str | Path
    frames: Sequence[tuple[float, str]] = STILL
    along: bool = True


@dataclass(frozen=True)
class RenderResult:
    """How a :class:`RenderJob` ended.

    Attributes
    ----------
    ok : bool
    path : Path
        Holds the new picture if ``ok``; otherwise whatever was there before is untouched.
    reason : str
        One sentence on what went wrong, and what mends it; empty if ``ok``.
    no_renderer : bool
        Whether the reason is that this machine cannot draw at all.
    """

    ok: bool
    path: Path
    reason: str = ""
    no_renderer: bool = False


def render_modes(jobs: Iterable[RenderJob], *, timeout: float = 120) -> list[RenderResult]:
    """Draw deformed shafts, coloured by displacement, over their shape at rest.

    Parameters
    ----------
    jobs : iterable of RenderJob
    timeout : float
        For all of them together, s.

    Returns
    -------
    list of RenderResult
        One per job, in order. Nothing is raised for a picture that could not be drawn or written.
    """
    jobs = list(jobs)
    if not jobs:
        return []
    deadline = time.monotonic() + timeout
    with tempfile.TemporaryDirectory(prefix="solidgear-render-") as folder:
        room = Path(folder)
        arrays = {
            f"{i}.{name}": getattr(job.surface, name)
            for i, job in enumerate(jobs)
            for name in ARRAYS
        }
        np.savez(room / "surfaces.npz", **arrays)
        told = [{"title": j.title, "frames": list(j.frames), "along": j.along} for j in jobs]
        (room / "jobs.json").write_text(json.dumps(told), encoding="utf-8")
        end = ""
        for window in _windows():
            end = _child(room, window, deadline - time.monotonic())
            # A child that reached the end of its list has said all there is to say.
            if not end or deadline - time.monotonic() <= 0:
                break
        works = (room / "window").exists()
        return [
            _collect(room, i, Path(job.path), end, works, timeout) for i, job in enumerate(jobs)
        ]


def _windows() -> list[str | None]:
    """VTK windows to try in turn; None leaves the choice to VTK."""
    if not sys.platform.startswith("linux") or WINDOW in os.environ:
        return [None]
    # A display that is set may still be dead, as over a lost ssh connection.
    return ([None] if os.environ.get("DISPLAY") else []) + [
        "vtkEGLRenderWindow",
        "vtkOSOpenGLRenderWindow",
    ]


def _child(room: Path, window: str | None, seconds: float) -> str:
    """Run one child on what is still to be drawn; returns how it died, or nothing."""
    env = dict(os.environ)
    if window:
        env[WINDOW] = window
    # The child must find the same solidgear, wherever the caller runs.
    here = str(Path(__file__).resolve().parents[2])
    env["PYTHONPATH"] = os.pathsep.join(filter(None, [here, env.get("PYTHONPATH")]))
    command = [sys.executable, "-m", "solidgear.report.drawing", str(room)]
    try:
        done = subprocess.run(
            command,
            env=env,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=max(seconds, 0.1),
            errors="replace",
        )
    except subprocess.TimeoutExpired:
        return "timeout"
    except OSError as error:
        return f"could not be started ({error})"
    if done.returncode == 0:
        return ""
    if done.returncode < 0:
        return f"was ended by signal {-done.returncode}"
    last = next((line.strip() for line in reversed(done.stderr.splitlines()) if line.strip()), "")
    return f"ended with status {done.returncode}" + (f" ({last[:200]})" if last else "")


def _collect(
    room: Path, index: int, path: Path, end: str, works: bool, timeout: float
) -> RenderResult:
    """Move a finished picture to its place, or say why there is none."""
    from solidgear.machine.whole_file import whole

    drawn, said = room / f"{index}.png", room / f"{index}.txt"
    if said.exists():
        return RenderResult(
            False,
            path,
            f"the picture {path.name} could not be drawn: {said.read_text(encoding='utf-8')}",
        )
    if drawn.exists():
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with whole(path) as partial:
                shutil.copyfile(drawn, partial)
        except OSError as error:
            return RenderResult(
                False, path, f"the picture {path} could not be written: {error.strerror or error}"
            )
        return RenderResult(True, path)
    if end == "timeout":
        return RenderResult(
            False,
            path,
            f"the picture {path.name} was not drawn within {timeout:g} s; allow more time, "
            f"or on Debian and Ubuntu mend OpenGL by `{PACKAGES}`",
        )
    what = end or "left no picture"
    return RenderResult(
        False,
        path,
        f"the drawing process {what}; on Debian and Ubuntu OpenGL is mended by `{PACKAGES}`",
        not works,
    )
