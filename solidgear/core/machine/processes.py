"""This process and others: their memory, their processor time, and whether they are alive; alike on
Linux, macOS and Windows.

A process that this program starts may be no more than a launcher of the one that works: so it is for
the Python of a virtual environment on Windows, and for ``mpirun``.  What a process takes is therefore
asked of all that it has started as well.
"""

from __future__ import annotations

import functools
import os
import time
from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from psutil import Process

MB = 2**20
#: s after which processes that were started meanwhile are looked for; that takes a millisecond or more
AGAIN = 0.3


def resident_mb() -> float | None:
    """Return the resident memory of this process, MB of 2**20 bytes; None where the system does not
    show it.
    """
    import psutil  # start-up: a hundredth of a second, for programs that build nothing

    try:
        return _process(os.getpid()).memory_info().rss / MB
    except (psutil.Error, OSError):
        return None


@functools.lru_cache(maxsize=1)
def _process(pid: int) -> Process:
    """Return a process, which is asked many times a second."""
    import psutil  # start-up: as in `resident_mb`

    return psutil.Process(pid)


def give_back() -> None:
    """Give memory that was freed back to the system, where it can be asked for: arrays of some
    megabytes leave holes that a process otherwise keeps.
    """
    import psutil  # start-up: as in `resident_mb`

    if hasattr(psutil, "heap_trim"):  # psutil 7.2
        psutil.heap_trim()


def family_memory() -> Callable[[], float | None]:
    """Return a function for the resident memory of this process and of all that come from it, MB of
    2**20 bytes; None where the system does not show it. What they share counts for each.
    """
    members: list[Process] = []
    looked = -AGAIN

    def family_mb() -> float | None:
        nonlocal members, looked
        if time.monotonic() - looked >= AGAIN:
            members, looked = _descendants(), time.monotonic()
        resident = resident_mb()
        return None if resident is None else resident + sum(map(_resident, members))

    return family_mb


def tree_seconds(pid: int) -> float | None:
    """Return the processor time of a process and of all that come from it, s; None where the system
    does not show it.
    """
    import psutil  # start-up: as in `resident_mb`

    try:
        process = psutil.Process(pid)
        return sum(map(_seconds, [process, *process.children(recursive=True)]))
    except (psutil.Error, OSError):
        return None


class Other:
    """Another process, which may end meanwhile; a later one of the same number is not it."""

    def __init__(self, pid: int):
        import psutil  # start-up: as in `resident_mb`

        self._process: Process | None = None
        try:
            self._process = psutil.Process(pid)
        except psutil.NoSuchProcess:
            pass

    @property
    def alive(self) -> bool:
        """Whether it can still do something; True where the system does not show it."""
        import psutil  # start-up: as in `resident_mb`

        if self._process is None or not self._process.is_running():
            return False
        try:
            return self._process.status() != psutil.STATUS_ZOMBIE
        except psutil.NoSuchProcess:
            return False
        except (psutil.Error, OSError):
            return True


def _descendants() -> list[Process]:
    """Return the processes that come from this one, but those that have just split off and share all
    its memory.
    """
    import psutil  # start-up: as in `resident_mb`

    try:
        process = psutil.Process()
        called = process.cmdline()
        return [child for child in process.children(recursive=True) if _called(child) != called]
    except (psutil.Error, OSError):
        return []


def _called(process: Process) -> list[str]:
    """Return the command of a process; none where it has ended or is not shown."""
    import psutil  # start-up: as in `resident_mb`

    try:
        return process.cmdline()
    except (psutil.Error, OSError):
        return []


def _resident(process: Process) -> float:
    """Return the resident memory of a process, MB; 0 where it has ended."""
    import psutil  # start-up: as in `resident_mb`

    try:
        return process.memory_info().rss / MB
    except (psutil.Error, OSError):
        return 0.0


def _seconds(process: Process) -> float:
    """Return the processor time of a process and of those it has waited for, s; 0 where it has ended."""
    import psutil  # start-up: as in `resident_mb`

    try:
        times = process.cpu_times()
    except (psutil.Error, OSError):
        return 0.0
    return times.user + times.system + times.children_user + times.children_system
