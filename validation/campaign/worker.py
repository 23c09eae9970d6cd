"""Calls in a process of their own, with limits on time and memory: what hangs or grows is an
outcome, not the end of the run.
"""

from __future__ import annotations

import ctypes
import gc
import multiprocessing
import resource
import signal
import sys
import traceback
from collections.abc import Callable
from typing import Any

from solidgear.core.errors import SolidgearError

#: address space of the worker, bytes: SuperLU reserves some ten times what it touches (11 GB for a
#: peak of 0.9), and how much is touched the product watches itself
ROOM = 48 << 30
#: what a scene or a reference may end with, by one's own fault
REFUSALS = (SolidgearError, ValueError, ArithmeticError, MemoryError)


class Worker:
    """A child process that calls functions, started again when it had to be ended.

    Parameters
    ----------
    seconds : float
        Longest a call may take.
    """

    def __init__(self, seconds: float):
        self.seconds = seconds
        self.process = self.pipe = None

    def call(self, function: Callable, *arguments: Any) -> tuple[Any, str]:
        """Return what a function gave, importable by name, and why it gave nothing, in a line."""
        if self.process is None or not self.process.is_alive():
            self._start()
        self.pipe.send((function, arguments))
        try:
            if not self.pipe.poll(self.seconds):
                self.close()
                return None, f"timeout after {self.seconds:g} s"
            return self.pipe.recv()
        except (EOFError, OSError):
            if self.process is None:
                return None, "ended"
            self.process.join(5.0)
            code = self.process.exitcode
            self.close()
            return None, f"died, exit code {code}"

    def _start(self) -> None:
        context = multiprocessing.get_context("spawn")
        self.pipe, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(theirs,), daemon=True)
        self.process.start()
        theirs.close()

    def close(self) -> None:
        """End the child."""
        if self.process is not None:
            self.process.kill()
            self.process.join()
            self.process = None


def _serve(pipe) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_AS, (ROOM, ROOM))
    while True:
        try:
            function, arguments = pipe.recv()
        except EOFError:
            return
        pipe.send(_called(function, arguments))
        _give_back()


def _give_back() -> None:
    """Memory that is free goes back to the system: glibc keeps what lies between small pieces that
    live on, 50 MB more with every body.
    """
    gc.collect()
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None) if sys.platform == "linux" else None
    if trim is not None:
        trim(0)


def _called(function: Callable, arguments: tuple) -> tuple[Any, str]:
    try:
        return function(*arguments), ""
    except REFUSALS as error:
        told = str(error) or type(error).__name__
    except Exception:
        told = traceback.format_exc()
    return None, told.strip().splitlines()[-1]
