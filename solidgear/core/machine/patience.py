"""Patience with another process, counted in its processor time while it works: a clock on the wall
would end on a busy machine a process that it allows on an idle one.
"""

from __future__ import annotations

import subprocess
import time

from solidgear.core.machine.processes import tree_seconds

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
            processor = tree_seconds(child.pid)
            # what a process took that has ended is not shown everywhere
            taken = clock - begin if processor is None else max(taken, processor)
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
