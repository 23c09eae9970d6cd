"""Limits on time and memory for what runs inside, so that a hang or a leak is a finding."""

from __future__ import annotations

import contextlib
import resource
import signal
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

STATUS = Path("/proc/self/statm")


class Overrun(BaseException):
    """A case took too long; no handler of `Exception` may swallow it."""


@dataclass(frozen=True)
class Limits:
    """What a case may take.

    Attributes
    ----------
    cpu : float
        Seconds of processor time, since wall time would blame the program for a busy machine.
    wall : float
        Seconds of wall time, for what waits without computing or computes in another process.
    room : int
        Bytes that it may add to the process. Address space that is only reserved is not counted.
    """

    cpu: float = 30.0
    wall: float = 60.0
    room: int = 3 << 30

    @contextlib.contextmanager
    def watched(self) -> Iterator[None]:
        """Limits on what runs inside, and warnings made errors."""

        def stop(number, _):
            cpu = number == signal.SIGPROF
            raise Overrun(
                f"more than {self.cpu:g} s of processor time"
                if cpu
                else f"more than {self.wall:g} s"
            )

        old = {number: signal.signal(number, stop) for number in (signal.SIGPROF, signal.SIGALRM)}
        soft, hard = resource.getrlimit(resource.RLIMIT_DATA)
        if STATUS.exists():
            held = int(STATUS.read_text().split()[5]) * resource.getpagesize()
            resource.setrlimit(resource.RLIMIT_DATA, (held + self.room, hard))
        signal.setitimer(signal.ITIMER_PROF, self.cpu)
        signal.setitimer(signal.ITIMER_REAL, self.wall)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                yield
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)
            signal.setitimer(signal.ITIMER_REAL, 0)
            resource.setrlimit(resource.RLIMIT_DATA, (soft, hard))
            for number, handler in old.items():
                signal.signal(number, handler)
