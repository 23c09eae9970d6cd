"""A process is waited for by what it takes of the processor, whatever else the machine does."""

import subprocess
import time
from types import SimpleNamespace

import pytest

from solidgear.core.machine import patience
from solidgear.core.machine.isolated import IsolatedError, isolated
from solidgear.core.machine.patience import Patience


class Child:
    """A process on a clock of our own, which takes some part of a processor."""

    def __init__(self, monkeypatch, share, needs=1e9):
        self.now, self.share, self.needs, self.pid = 0.0, share, needs, 1
        monkeypatch.setattr(patience, "time", SimpleNamespace(monotonic=lambda: self.now))
        monkeypatch.setattr(patience, "tree_seconds", lambda pid: self.now * self.share)
        self.killed = False

    def wait(self, seconds=None):
        if self.killed:
            return -9
        self.now += seconds
        if self.now * self.share >= self.needs:
            return 0
        raise subprocess.TimeoutExpired("", seconds)

    def kill(self):
        self.killed = True


def test_a_process_that_has_a_twentieth_of_a_processor_ends_its_work(monkeypatch):
    child, waiting = Child(monkeypatch, 0.05, needs=20.0), Patience(25.0)
    assert waiting.wait(child) == 0 and not waiting.reason
    assert child.now == pytest.approx(400.0, abs=1.0)  # on the wall, 16 times its patience
    # what is left is for the next process: 5 s
    assert waiting.remaining == pytest.approx(5.0, abs=0.1)


@pytest.mark.parametrize(
    "share, after, says",
    [
        (0.5, 50.0, "took more than 25 s of processor time"),
        (0.001, 25.0, "made no progress for 25 s"),
    ],
)
def test_patience_ends_with_processor_time_or_where_nothing_is_done(
    monkeypatch, share, after, says
):
    child, waiting = Child(monkeypatch, share), Patience(25.0)
    assert waiting.wait(child) == -9
    assert waiting.reason == says and child.now == pytest.approx(after, abs=1.0)


def test_a_function_that_never_returns_is_ended():
    """One that works and one that sleeps."""
    with pytest.raises(
        IsolatedError, match="took more than 0.5 s of processor time|made no progress"
    ):
        isolated(eval, "[None for _ in iter(int, 1)]", seconds=0.5)
    begin = time.process_time()
    with pytest.raises(IsolatedError, match="made no progress for 1 s"):
        isolated(time.sleep, 600, seconds=1.0)
    assert time.process_time() - begin < 1.0
