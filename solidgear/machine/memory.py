"""Memory that this process may still take: of the machine, of its control groups, of what the user
allows.
"""

from __future__ import annotations

import mmap
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path

from solidgear.errors import SolidgearError
from solidgear.machine.control_groups import control_groups, text_of


class NoRoom(SolidgearError):
    """Refusal of what does not fit into memory, or cannot be numbered.

    Attributes
    ----------
    what : str
        What was asked for, what it would take and what there is, in words.
    need_mb, free_mb : float
        Infinite for what no memory would hold, and where the system does not tell.
    """

    def __init__(
        self, what: str, need_mb: float, free_mb: float, instead: str = "use a coarser mesh"
    ):
        self.what, self.need_mb, self.free_mb = what, need_mb, free_mb
        super().__init__(f"{what}; {instead}")

    def of_model(self, model: str, instead: str) -> NoRoom:
        """The same of a model, with what to do instead."""
        return NoRoom(f"{model}: {self.what}", self.need_mb, self.free_mb, instead)


def megabytes(amount: float) -> str:
    """A number of megabytes, to what it is worth."""
    return f"{amount:.0f}" if amount >= 10 else f"{amount:.2g}"


def require(need_mb: float, what: str, by: str = "", free: float | None = None) -> None:
    """Refuse (:class:`NoRoom`) what does not fit into what is free now, or was before a part of
    the need was taken, unless it is small; told is what needs it, such as ``120 unknowns``, and
    what factors them.
    """
    free = available_mb() if free is None else free
    if free is not None and need_mb > max(free, SMALL_MB):
        needs = f"{what} need about {megabytes(need_mb)} MB{f' to factor by {by}' if by else ''}"
        raise NoRoom(f"{needs}, {megabytes(free)} MB are free", need_mb, free)


@dataclass
class Run:
    """Memory of one run."""

    #: what the process held when it began; None before that, and where the system does not tell
    base_mb: float | None = None
    #: the largest peak that was told beforehand (see :func:`expect`)
    expected_mb: float | None = None


_run: ContextVar[Run | None] = ContextVar("the run that this is part of", default=None)

#: what is not refused for want of memory, MB: a beam, or a coarse solid
SMALL_MB = 25.0
#: told of unknowns, and of memory in MB
Listener = Callable[[int, float], None]
_listener: ContextVar[Listener | None] = ContextVar("who is told what factors take", default=None)

# cgroup v1 writes "no limit" as the largest multiple of a page; anything above an exabyte is none.
UNLIMITED = 2**60


def available_mb(root: str | Path = "/") -> float | None:
    """Memory that can still be taken.

    The least of ``MemAvailable``, the room below the limit of every control group (v1 and v2) this
    process is in, what a limit of address space (``ulimit -v``) leaves, and the environment variable
    ``SOLIDGEAR_MEMORY_MB``, which can only lower it (see :func:`one_run`).

    Parameters
    ----------
    root : path
        Where ``proc`` and ``sys`` are looked for.

    Returns
    -------
    float or None
        MB of 2**20 bytes; None where the system does not show it.

    Raises
    ------
    SolidgearError
        If ``SOLIDGEAR_MEMORY_MB`` is not a number above zero.
    """
    root = Path(root)
    found = [*_machine(root), *_groups(root), *_address_space(root)]
    text = os.environ.get("SOLIDGEAR_MEMORY_MB", "").strip()
    if text:
        try:
            allowed = float(text)
        except ValueError:
            allowed = 0.0
        if not 0 < allowed < float("inf"):
            raise SolidgearError(
                f"SOLIDGEAR_MEMORY_MB = {text!r}: must be a number of megabytes above zero"
            )
        run = _run.get()
        base = None if run is None else run.base_mb
        held = 0.0 if base is None else max(0.0, (resident_mb() or base) - base)
        found.append(max(0.0, allowed - held))
    return min(found, default=None)


@contextmanager
def one_run() -> Iterator[Run]:
    """Within it, ``SOLIDGEAR_MEMORY_MB`` limits what is taken from here on in all, not what each
    body may take by itself; a run within a run is part of it.

    Yields
    ------
    Run
    """
    with one_command() as run:
        begin()
        yield run


@contextmanager
def one_command() -> Iterator[Run]:
    """The same, of a run that begins with its first body (:func:`begin`): what large libraries take is
    not counted.

    Yields
    ------
    Run
    """
    run = _run.get() or Run()
    token = _run.set(run)
    try:
        yield run
    finally:
        _run.reset(token)


@contextmanager
def anew() -> Iterator[None]:
    """Within it, what the run has taken so far does not count: for what would be in its place."""
    token = _run.set(Run(resident_mb()))
    try:
        yield
    finally:
        _run.reset(token)


def begin() -> None:
    """From here on count what the run takes, if it has not begun."""
    run = _run.get()
    if run is not None and run.base_mb is None:
        run.base_mb = resident_mb()


@contextmanager
def listening(hear: Listener) -> Iterator[None]:
    """Within it, ``hear(unknowns, mb)`` is told of every factor before it is made."""
    token = _listener.set(hear)
    try:
        yield
    finally:
        _listener.reset(token)


def tell(unknowns: int, more_mb: float) -> None:
    """Tell whoever listens of a factor that will be made."""
    hear = _listener.get()
    if hear is not None:
        hear(unknowns, more_mb)


def expect(more_mb: float) -> None:
    """Note that so much memory (MB) will be taken beyond what the process holds now."""
    run, now = _run.get(), resident_mb()
    if run is not None and now is not None:
        run.expected_mb = max(run.expected_mb or 0.0, now + more_mb)


def resident_mb() -> float | None:
    """Resident memory of this process, MB of 2**20 bytes; None where the system does not show it."""
    try:
        pages = int(Path("/proc/self/statm").read_text().split()[1])
    except OSError:
        return None
    return pages * mmap.PAGESIZE / 2**20


def _machine(root: Path) -> Iterator[float]:
    for line in text_of(root / "proc/meminfo").splitlines():
        if line.startswith("MemAvailable:"):
            yield int(line.split()[1]) / 1024


def _groups(root: Path) -> Iterator[float]:
    for place, unified in control_groups(root, "memory"):
        names = (
            ("memory.max", "memory.current", "inactive_file")
            if unified
            else ("memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file")
        )
        ceiling, taken = (text_of(place / name).strip() for name in names[:2])
        if ceiling.isdigit() and taken.isdigit() and int(ceiling) < UNLIMITED:
            # Cached files count as used but are given back on demand.
            cached = _field(text_of(place / "memory.stat"), names[2])
            yield max(0, int(ceiling) - int(taken) + cached) / 2**20


def _address_space(root: Path) -> Iterator[float]:
    """Below a limit of address space, of which a process takes more than it holds."""
    rows = text_of(root / "proc/self/limits").splitlines()
    soft = next((row.split()[3] for row in rows if row.startswith("Max address space")), "")
    taken = text_of(root / "proc/self/statm").split()
    if soft.isdigit() and taken:
        yield max(0, int(soft) - int(taken[0]) * mmap.PAGESIZE) / 2**20


def _field(text: str, name: str) -> int:
    return next(
        (int(line.split()[1]) for line in text.splitlines() if line.startswith(name + " ")), 0
    )
