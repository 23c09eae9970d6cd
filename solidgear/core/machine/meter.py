"""Seconds and peak memory of a stage of work."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from solidgear.core.machine.processes import resident_mb


def processor_seconds() -> float:
    """Return the processor time of this process and of those it has waited for, s: the same on a
    busy machine as on an idle one.
    """
    return sum(os.times()[:4])


class Meter:
    """``seconds`` per stage and the peak resident memory over all of them, ``peak_mb`` (MB of 2**20 bytes).

    Memory is that of the whole process, or what `memory` says, sampled every 20 ms while a stage
    runs.

    Examples
    --------
    >>> meter = Meter()
    >>> with meter.stage("solve"):
    ...     _ = sum(range(1000))
    >>> list(meter.total())
    ['solve', 'total']
    """

    def __init__(self, memory: Callable[[], float | None] = resident_mb):
        self.memory = memory
        self.seconds: dict[str, float] = {}
        self.peak_mb: float | None = None

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Time a block of code; stages of one name add up."""
        stop = threading.Event()

        def watch():
            while True:
                resident = self.memory()
                if resident is None:
                    return
                self.peak_mb = max(self.peak_mb or 0.0, resident)
                if stop.wait(0.02):
                    return

        watcher = threading.Thread(target=watch, daemon=True)
        watcher.start()
        start = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start
            stop.set()
            watcher.join()

    def move(self, source: str, target: str, seconds: float) -> None:
        """Book some seconds of one stage under another name."""
        self.seconds[source] = self.seconds.get(source, 0.0) - seconds
        self.seconds[target] = self.seconds.get(target, 0.0) + seconds

    def total(self) -> dict[str, float]:
        """Return the seconds per stage, and their sum as ``total``."""
        return {**self.seconds, "total": sum(self.seconds.values())}
