"""Run another program: timed as a whole process, within a time limit, never left behind."""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import time
from pathlib import Path


class PeerError(RuntimeError):
    """A peer did not do its job; the text says which and why."""


def cores() -> int:
    """Cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def run(
    command: list[str],
    folder: Path,
    *,
    limit: float,
    threads: int | None = None,
    extra: dict[str, str] | None = None,
) -> tuple[float, float, str]:
    """Wall seconds, processor seconds and standard output of one whole process.

    Parameters
    ----------
    command : list of str
    folder : Path
        Where it runs.
    limit : float
        Seconds after which it is ended, its children included.
    threads : int, optional
        For OpenMP and the pools of CalculiX; all cores by default.
    extra : dict, optional
        More environment.

    Raises
    ------
    PeerError
        If it ran out of time or returned a non-zero code.
    """
    count = str(threads or cores())
    env = {
        **os.environ,
        "OMP_NUM_THREADS": count,
        "CCX_NPROC_EQUATION_SOLVER": count,
        "CCX_NPROC_STIFFNESS": count,
        "CCX_NPROC_RESULTS": count,
    }
    start, spent = time.perf_counter(), _children()
    # A session of its own, so that whatever it starts can be ended with it.
    child = subprocess.Popen(
        command,
        cwd=folder,
        env={**env, **(extra or {})},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )
    try:
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
    return seconds, _children() - spent, out


def _children() -> float:
    """Processor seconds of all child processes that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def last_words(text: str, lines: int = 3) -> str:
    """The end of what a program printed, on one line."""
    return " / ".join([line.strip() for line in text.splitlines() if line.strip()][-lines:])
