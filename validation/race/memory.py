"""Memory of a process and of all that it starts, as it runs."""

from __future__ import annotations

import threading
from pathlib import Path
from types import TracebackType

#: s between two looks
STEP = 0.05


class TreePeak:
    """Largest sum of the memory of a process and its descendants, in MB, pages that several share
    counted once; looked at every `STEP` seconds while the block runs.
    """

    def __init__(self, pid: int):
        self.pid = pid
        self.mb = 0.0
        self._over = threading.Event()
        self._watch = threading.Thread(target=self._look, daemon=True)

    def __enter__(self) -> TreePeak:
        self._watch.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._over.set()
        self._watch.join()

    def _look(self) -> None:
        while not self._over.wait(STEP):
            self.mb = max(self.mb, sum(map(proportional_mb, descendants(self.pid))))


def descendants(pid: int) -> list[int]:
    """Return a process and all that it has started and that still run."""
    waiting, family = [pid], []
    while waiting:
        parent = waiting.pop()
        family.append(parent)
        try:
            for task in Path(f"/proc/{parent}/task").iterdir():
                waiting += map(int, (task / "children").read_text().split())
        except OSError:  # it has just ended
            continue
    return family


def proportional_mb(pid: int) -> float:
    """Return the memory of a process, MB, of shared pages its part; zero once it has ended."""
    try:
        lines = Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()
    except OSError:
        return 0.0
    return sum(int(line.split()[1]) for line in lines if line.startswith("Pss:")) / 1024
