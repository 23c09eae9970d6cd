"""Patience with another process, counted in its processor time while it works: a clock on the wall
would end on a busy machine a process that it allows on an idle one.
"""

from __future__ import annotations

import os
import subprocess
import time
from pathlib import Path

from solidgear.core.machine.control_groups import text_of

#: share of a processor below which a process stands still
STILL = 0.01
#: s between two looks
PAUSE = 0.2


class Patience:
    """Seconds of processor time for a process, or for several one after the other; and as many on the
    wall for one that stands still meanwhile.

    Where the system does not show the processor time of a process, all of its time counts.

    Attributes
    ----------
    remaining : float
        Seconds of processor time.
    reason : str
        Why the last process was ended; empty if it ended by itself.

    Examples
    --------
    >>> import sys
    >>> patience = Patience(60)
    >>> patience.wait(subprocess.Popen([sys.executable, "-c", ""])), patience.reason
    (0, '')
    """

    def __init__(self, seconds: float):
        self.seconds = self.remaining = seconds
        self.reason = ""

    def wait(self, child: subprocess.Popen) -> int:
        """Return the code of a process, which is ended where patience is."""
        begin = checked = time.monotonic()
        taken = checked_taken = 0.0
        self.reason = ""
        while not self.reason:
            try:
                code = child.wait(PAUSE)
                break
            except subprocess.TimeoutExpired:
                clock = time.monotonic()
            processor = _processor_seconds(child.pid)
            taken = clock - begin if processor is None else processor
            if taken > self.remaining:
                self.reason = f"took more than {self.seconds:g} s of processor time"
            elif clock - checked > self.seconds:
                if taken - checked_taken < STILL * (clock - checked):
                    self.reason = f"made no progress for {self.seconds:g} s"
                checked, checked_taken = clock, taken
        else:
            child.kill()
            code = child.wait()
        self.remaining -= taken
        return code


def _processor_seconds(pid: int) -> float | None:
    """Return the processor time of a process and of the children it has waited for; None where that
    is not shown.
    """
    fields = text_of(Path(f"/proc/{pid}/stat")).rpartition(")")[2].split()
    if len(fields) < 15 or not hasattr(os, "sysconf"):
        return None
    return sum(int(field) for field in fields[11:15]) / os.sysconf("SC_CLK_TCK")
