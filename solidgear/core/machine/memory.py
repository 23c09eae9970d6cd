"""Memory that this process may still take: of the machine, of the control groups, and by the limit of
the user.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path

from solidgear.core.errors import SolidgearError
from solidgear.core.machine.control_groups import control_groups, text_of
from solidgear.core.machine.processes import MB, resident_mb


class NoRoom(SolidgearError):
    """Refusal of a mesh, matrix or factor that does not fit into memory, or cannot be numbered.

    Attributes
    ----------
    reason : str
        Request, need and free memory, in words.
    need_mb, free_mb : float
        Infinite for a need beyond any memory, and where the system does not show the free memory.
    """

    def __init__(
        self, reason: str, need_mb: float, free_mb: float, instead: str = "use a coarser mesh"
    ):
        self.reason, self.need_mb, self.free_mb = reason, need_mb, free_mb
        super().__init__(f"{reason}; {instead}")

    def of_model(self, model: str, instead: str) -> NoRoom:
        """Return the same refusal of a model, with advice."""
        return NoRoom(f"{model}: {self.reason}", self.need_mb, self.free_mb, instead)


def megabytes(amount: float) -> str:
    """Return a number of megabytes in words, to two digits below ten."""
    return f"{amount:.0f}" if amount >= 10 else f"{amount:.2g}"


def require(need_mb: float, unknowns: str, backend: str = "", free: float | None = None) -> None:
    """Refuse (:class:`NoRoom`) a need beyond the memory that is free now, or was before a part of
    it was taken, unless it is small; ``unknowns``, such as ``120 unknowns``, and the back end that
    factors them are named in the refusal.
    """
    _limit_of_user()  # one that is no number is refused, whatever the need
    if need_mb <= SMALL_MB:
        return
    free = available_mb() if free is None else free
    if free is not None and need_mb > free:
        by = f" to factor by {backend}" if backend else ""
        needs = f"{unknowns} need about {megabytes(need_mb)} MB{by}"
        raise NoRoom(f"{needs}, {megabytes(free)} MB are free", need_mb, free)


@dataclass
class Run:
    """Memory of one run."""

    #: whether somebody reads these numbers; else a base is kept under a limit of the user alone
    watched: bool = False
    #: memory of the process when it began; None before that, and where the system does not show it
    base_mb: float | None = None
    #: the largest peak that was expected (see :func:`expect`), of a run that is watched
    expected_mb: float | None = None


_run: ContextVar[Run | None] = ContextVar("the run that this is part of", default=None)

#: environment variable with the limit of the user, MB
LIMIT = "SOLIDGEAR_MEMORY_MB"
#: needs below this are not refused, MB: a beam, or a coarse solid
SMALL_MB = 25.0
#: called with unknowns, and with memory in MB
Listener = Callable[[int, float], None]
_listener: ContextVar[Listener | None] = ContextVar("who is told what factors take", default=None)

# cgroup v1 writes "no limit" as the largest multiple of a page; anything above an exabyte is none.
UNLIMITED = 2**60


def available_mb(root: str | Path = "/") -> float | None:
    """Return the memory that can still be taken, MB of 2**20 bytes; None where the system does not show it.

    The least of what the machine has available, the room below the limit of every control group of
    Linux (v1 and v2) this process is in, the rest of a limit of address space (``ulimit -v``), and the
    environment variable ``SOLIDGEAR_MEMORY_MB``, a number above zero, which can only lower it (see
    :func:`one_run`). Control groups are looked for in ``proc`` and ``sys`` below ``root``.
    """
    limits = [*_machine(), *_groups(Path(root)), *_address_space()]
    allowed = _limit_of_user()
    if allowed is not None:
        run = _run.get()
        base = None if run is None else run.base_mb
        taken = 0.0 if base is None else max(0.0, (resident_mb() or base) - base)
        limits.append(max(0.0, allowed - taken))
    return min(limits, default=None)


def _limit_of_user() -> float | None:
    """Return the limit of the environment variable, MB; None without one. SolidgearError unless it is
    a number above zero.
    """
    text = os.environ.get(LIMIT, "").strip()
    if not text:
        return None
    try:
        allowed = float(text)
    except ValueError:
        allowed = 0.0
    if not 0 < allowed < float("inf"):
        raise SolidgearError(f"{LIMIT} = {text!r}: must be a number of megabytes above zero")
    return allowed


@contextmanager
def one_run(watched: bool = False) -> Iterator[Run]:
    """Begin a run, in which ``SOLIDGEAR_MEMORY_MB`` limits the memory taken in all, not by each
    body; a run within a run is part of it, and `watched` if one of them is.
    """
    with one_command() as run:
        run.watched |= watched
        begin()
        yield run


@contextmanager
def one_command() -> Iterator[Run]:
    """Open a run that begins with the first body (:func:`begin`): memory of large libraries is not
    counted.
    """
    run = _run.get() or Run()
    token = _run.set(run)
    try:
        yield run
    finally:
        _run.reset(token)


@contextmanager
def fresh_run() -> Iterator[None]:
    """Count memory from zero within it: for models in place of the one that has taken memory so
    far.
    """
    token = _run.set(Run(base_mb=resident_mb()))
    try:
        yield
    finally:
        _run.reset(token)


def begin() -> None:
    """Count the memory of the run from here on, if it has not begun."""
    run = _run.get()
    if run is None or run.base_mb is not None:
        return
    if run.watched or os.environ.get(LIMIT):
        run.base_mb = resident_mb()


@contextmanager
def listening(listener: Listener) -> Iterator[None]:
    """Call ``listener(unknowns, mb)`` before every factor that is made within it."""
    token = _listener.set(listener)
    try:
        yield
    finally:
        _listener.reset(token)


def announce(unknowns: int, more_mb: float) -> None:
    """Announce a factor that will be made to the listener."""
    listener = _listener.get()
    if listener is not None:
        listener(unknowns, more_mb)


def expect(more_mb: float) -> None:
    """Note that so much memory (MB) will be taken beyond the resident memory, in a run that is
    watched.
    """
    run = _run.get()
    if run is not None and run.watched and (resident := resident_mb()) is not None:
        run.expected_mb = max(run.expected_mb or 0.0, resident + more_mb)


def _machine() -> Iterator[float]:
    """Yield the memory of the machine that is free, or is given back on demand."""
    import psutil  # start-up: not for programs that build nothing

    try:
        yield psutil.virtual_memory().available / MB
    except (psutil.Error, OSError):  # a room without /proc
        return


def _groups(root: Path) -> Iterator[float]:
    for place, unified in control_groups(root, "memory"):
        limit, usage, cache = (
            "memory.limit_in_bytes",
            "memory.usage_in_bytes",
            "total_inactive_file",
        )
        if unified:
            limit, usage, cache = "memory.max", "memory.current", "inactive_file"
        ceiling, taken = (text_of(place / name).strip() for name in (limit, usage))
        if ceiling.isdigit() and taken.isdigit() and int(ceiling) < UNLIMITED:
            # Cached files count as used but are given back on demand.
            cached = _field(text_of(place / "memory.stat"), cache)
            yield max(0, int(ceiling) - int(taken) + cached) / MB


def _address_space() -> Iterator[float]:
    """Yield the rest of a limit of address space, of which a process takes more than it holds."""
    try:
        import resource
    except ImportError:  # not on Windows
        return
    import psutil  # start-up: not for programs that build nothing

    soft, _ = resource.getrlimit(resource.RLIMIT_AS)
    if soft == resource.RLIM_INFINITY:
        return
    try:
        yield max(0, soft - psutil.Process().memory_info().vms) / MB
    except (psutil.Error, OSError):
        return


def _field(text: str, name: str) -> int:
    return next(
        (int(line.split()[1]) for line in text.splitlines() if line.startswith(name + " ")), 0
    )
