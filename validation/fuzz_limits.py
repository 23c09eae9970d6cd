"""Limits on time and memory for what runs inside, so that a hang or a leak is a finding."""

from __future__ import annotations

import contextlib
import resource
import signal
import warnings
from collections.abc import Iterator
from pathlib import Path

STUCK = 60.0  # s of wall time, for what waits without computing
ROOM = 3 << 30  # bytes a case may add to the process


class Overrun(BaseException):
    """A case took too long; no handler of `Exception` may swallow it."""


@contextlib.contextmanager
def watched(limit: float) -> Iterator[None]:
    """Time and memory limits on what runs inside, and warnings made errors."""

    def stop(*_):
        raise Overrun

    old = {number: signal.signal(number, stop) for number in (signal.SIGPROF, signal.SIGALRM)}
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    held = (
        int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
        if Path("/proc/self/statm").exists()
        else 0
    )
    resource.setrlimit(resource.RLIMIT_AS, (held + ROOM if held else soft, hard))
    signal.setitimer(signal.ITIMER_PROF, limit)
    signal.setitimer(signal.ITIMER_REAL, max(STUCK, 2 * limit))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.setitimer(signal.ITIMER_REAL, 0)
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
        for number, handler in old.items():
            signal.signal(number, handler)
