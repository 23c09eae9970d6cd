"""Jobs in a process of their own, with limits on time and memory: what hangs or grows is an
outcome, not the end of the run.
"""

from __future__ import annotations

import multiprocessing
import resource
import signal
import traceback
from collections.abc import Callable

#: address space of the worker, bytes: SuperLU reserves some ten times what it touches (11 GB for a
#: peak of 0.9), and how much is touched the product watches itself
ROOM = 48 << 30


class Worker:
    """Calls one function in a child process that is started again when it had to be ended.

    Parameters
    ----------
    call : callable
        Of the arguments of `run`; importable by name.
    seconds : float
        Longest a call may take.
    """

    def __init__(self, call: Callable, seconds: float):
        self.call, self.seconds = call, seconds
        self.process = self.pipe = None

    def run(self, *arguments) -> dict:
        """What the call returns, or ``{"crash": one of 'timeout', 'died', traceback}``."""
        if self.process is None or not self.process.is_alive():
            self._start()
        self.pipe.send(arguments)
        try:
            if not self.pipe.poll(self.seconds):
                self.close()
                return {"crash": f"timeout after {self.seconds:g} s"}
            return self.pipe.recv()
        except (EOFError, ConnectionResetError):
            self.process.join(5.0)
            code = self.process.exitcode
            self.close()
            return {"crash": f"died, exit code {code}"}

    def _start(self) -> None:
        context = multiprocessing.get_context("spawn")
        self.pipe, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(theirs, self.call), daemon=True)
        self.process.start()
        theirs.close()

    def close(self) -> None:
        """End the child."""
        if self.process is not None:
            self.process.kill()
            self.process.join()
            self.process = None


def _serve(pipe, call) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_AS, (ROOM, ROOM))
    while True:
        try:
            arguments = pipe.recv()
        except EOFError:
            return
        try:
            pipe.send(call(*arguments))
        except Exception:
            pipe.send({"crash": traceback.format_exc()})
