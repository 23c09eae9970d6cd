"""Patience with another process: counted by what it takes of the processor, while it works.

A clock on the wall would end on a busy machine what it allows on an idle one.
"""

from __future__ import annotations

import os
import subprocess
import time
from pathlib import Path

from solidgear.machine.control_groups import text_of

#: part of a processor below which a process stands still
STILL = 0.01
#: s between two looks
PAUSE = 0.2


class Patience:
    """Seconds of processor time for a process, or for several one after the other; and as many on the
    wall for one that stands still meanwhile.

    Where the system does not show what a process takes, all of its time counts.

    Parameters
    ----------
    seconds : float

    Attributes
    ----------
    left : float
        What is left of them.
    why : str
        Why the last process was ended; empty if it ended by itself.

    Examples
    --------
    >>> import sys
    >>> patience = Patience(60)
    >>> patience.wait(subprocess.Popen([sys.executable, "-c", ""])), patience.why
    (0, '')
    """

    def __init__(self, seconds: float):
        self.seconds = self.left = seconds
        self.why = ""

    def wait(self, child: subprocess.Popen) -> int:
        """Return code of a process, which is ended where patience is."""
        begin = looked = time.monotonic()
        taken = before = 0.0
        self.why = ""
        while not self.why:
            try:
                code = child.wait(PAUSE)
                break
            except subprocess.TimeoutExpired:
                now = time.monotonic()
            seen = _processor_seconds(child.pid)
            taken = now - begin if seen is None else seen
            if taken > self.left:
                self.why = f"took more than {self.seconds:g} s of processor time"
            elif now - looked > self.seconds:
                if taken - before < STILL * (now - looked):
                    self.why = f"stood still for {self.seconds:g} s"
                looked, before = now, taken
        else:
            child.kill()
            code = child.wait()
        self.left -= taken
        return code


def _processor_seconds(pid: int) -> float | None:
    """Taken by a process and by the children it has waited for; None where that is not shown."""
    told = text_of(Path(f"/proc/{pid}/stat")).rpartition(")")[2].split()
    if len(told) < 15 or not hasattr(os, "sysconf"):
        return None
    return sum(int(field) for field in told[11:15]) / os.sysconf("SC_CLK_TCK")
