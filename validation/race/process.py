"""Other programs, and functions of this one, as whole processes: timed, within a time limit, never
left behind.
"""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from validation.race.installed import interpreter
from validation.race.memory import TreePeak

ROOT = Path(__file__).resolve().parents[2]
#: one thread for every pool there is
ALONE = dict.fromkeys(("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
#: runs a command and tells its peak memory; small itself, for a child begins with its parent's peak
WATCH = (
    "import resource, subprocess, sys; code = subprocess.call(sys.argv[1:]); "
    "print('PEAK', resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss); sys.exit(code)"
)


class PeerError(RuntimeError):
    """A peer did not do its job; the text says which and why."""


@dataclass(frozen=True)
class Done:
    """A process that ended well: wall and processor seconds, what it printed, and the answer of a
    function.
    """

    wall: float
    cpu: float
    out: str
    answer: Any = None
    tree_mb: float = 0.0  #: largest memory of the process and all that it started, where watched

    @property
    def peak_mb(self) -> float:
        """Largest memory of what `WATCH` ran, MB."""
        return float(self.out.rsplit("PEAK", 1)[1]) / 1024


def cores() -> int:
    """Cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def run(
    command: list[str],
    folder: Path,
    *,
    limit: float = 900.0,
    threads: int | None = None,
    extra: dict[str, str | None] | None = None,
    tree: bool = False,
) -> Done:
    """Run a command as one whole process.

    Parameters
    ----------
    folder : Path
        Where it runs.
    limit : float
        Seconds after which it is ended, its children included.
    threads : int, optional
        For OpenMP and the pools of CalculiX; all cores by default.
    extra : dict, optional
        More environment; None for a variable that is not to be set.
    tree : bool
        Whether to watch the memory of it and of all that it starts.

    Raises
    ------
    PeerError
        If it ran out of time or returned a non-zero code.
    """
    pools = ("EQUATION_SOLVER", "STIFFNESS", "RESULTS")
    names = ["OMP_NUM_THREADS", *(f"CCX_NPROC_{pool}" for pool in pools)]
    told = dict.fromkeys(names, str(threads or cores())) | (extra or {})
    env = {k: v for k, v in {**os.environ, **told}.items() if v is not None}
    start, before = time.perf_counter(), spent(own=False)
    # A session of its own, so that whatever it starts can be ended with it.
    child = subprocess.Popen(
        command,
        cwd=folder,
        env=env,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )
    peak = TreePeak(child.pid)
    try:
        with peak if tree else nullcontext():
            out, _ = child.communicate(timeout=limit)
    except BaseException as error:
        os.killpg(child.pid, signal.SIGKILL)
        child.communicate()
        if isinstance(error, subprocess.TimeoutExpired):
            raise PeerError(f"{Path(command[0]).name} was ended after {limit:g} s") from None
        raise
    seconds = time.perf_counter() - start
    if child.returncode:
        raise PeerError(f"{Path(command[0]).name} returned {child.returncode}: {last_words(out)}")
    return Done(seconds, spent(own=False) - before, out, tree_mb=peak.mb)


def called(
    function: str,
    *,
    limit: float = 900.0,
    threads: int | None = None,
    extra: dict[str, str | None] | None = None,
    python: str = sys.executable,
    **given: Any,
) -> Done:
    """Call a function in a Python process of its own.

    Parameters
    ----------
    function : str
        Module and name, such as ``validation.race.ours:whole``.
    limit, threads, extra
        As of :func:`run`.
    python : str
        Interpreter, such as one that has a peer.
    **given
        What the function is given, and its answer, are plain data.

    Raises
    ------
    PeerError
        If it fails.
    """
    with tempfile.TemporaryDirectory(prefix="race-") as name:
        job, answer = Path(name) / "job.json", Path(name) / "answer.json"
        job.write_text(json.dumps(given))
        command = [python, "-m", "validation.race.process", function, name]
        extra = {"PYTHONPATH": str(ROOT), **(extra or {})}
        done = run(command, ROOT, limit=limit, threads=threads, extra=extra)
        return Done(done.wall, done.cpu, done.out, json.loads(answer.read_text()))


def peer(module: str, function: str, **more: Any) -> dict[str, Any]:
    """What a function answers in a Python that can import a module, with ``cpu`` seconds of the process;
    `more` is as of :func:`called`.

    Raises
    ------
    PeerError
    """
    done = called(function, python=interpreter(module), **more)
    return done.answer | {"cpu": done.cpu}


def spent(own: bool = True) -> float:
    """Processor seconds of the children of this process that have ended, and of itself."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return children.ru_utime + children.ru_stime + (time.process_time() if own else 0.0)


def last_words(text: str, lines: int = 3, letters: int = 300) -> str:
    """The end of what a program printed, on one line."""
    said = [line.strip() for line in text.splitlines() if line.strip()]
    return " / ".join(said[-lines:])[-letters:]


def _child(function: str, folder: Path) -> None:
    """The other end of :func:`called`."""
    from importlib import import_module

    module, _, name = function.partition(":")
    given = json.loads((folder / "job.json").read_text())
    answer = getattr(import_module(module), name)(**given)
    (folder / "answer.json").write_text(json.dumps(answer))


if __name__ == "__main__":
    _child(sys.argv[1], Path(sys.argv[2]))
