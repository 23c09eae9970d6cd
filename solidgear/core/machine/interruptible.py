"""Long calls into C that Ctrl-C can end.

Python hears a signal between two of its instructions, in the main thread; one call into C that
takes a minute is one instruction.  So the call runs in a second thread and the main thread waits,
where it hears Ctrl-C at once.  The call itself cannot be ended: it is abandoned, runs on at the
lowest priority, and the result is discarded.  The command line then ends the process without
waiting for it (:func:`leave`).

This needs a callee that lets go of Python's lock.  MKL and gmsh (through ctypes), SciPy's SuperLU
and sparse products and numpy's products do; scikit-sparse does not, nor does scipy.linalg, which
this package calls for small dense matrices only.  In a thread that is not the main one, or where
Ctrl-C is not heard by Python, the call is simply made.
"""

from __future__ import annotations

import atexit
import contextvars
import os
import queue
import signal
import sys
import threading
import weakref
from collections.abc import Callable
from pathlib import Path
from typing import Any, NoReturn


def call(function: Callable, *arguments, **options) -> Any:
    """Return the result of a function, or raise the exception; Ctrl-C, or any exception of a signal handler
    meanwhile, ends the wait for it.

    After Ctrl-C the function may still be running: the arguments must not be used again.

    Examples
    --------
    >>> call(divmod, 7, 2)
    (3, 1)
    """
    in_main = threading.current_thread() is threading.main_thread()
    if not in_main or not callable(signal.getsignal(signal.SIGINT)):
        return function(*arguments, **options)
    job = _Job(lambda: function(*arguments, **options))
    try:
        _idle_worker().put(job)
        # Not for ever at once: on Windows a wait without end is deaf.
        while not job.done.wait(0.1):
            pass
    except BaseException:
        _abandon(job)
        raise
    return job.result()


def abandoned() -> bool:
    """Return True while a call that was interrupted is still running."""
    _lost[:] = [job for job in _lost if not job.done.is_set()]
    return bool(_lost)


def leave(code: int | str | None) -> NoReturn:
    """End the process as ``sys.exit`` does; at once if an abandoned call is still running, for it
    cannot be waited for, and libraries that run C code at exit would free the data.
    """
    if abandoned() and (code is None or isinstance(code, int)):
        for stream in (sys.stdout, sys.stderr):
            try:
                stream.flush()
            except (OSError, ValueError):  # closed, or not read
                pass
        os._exit(code or 0)
    sys.exit(code)


class ThreadBound:
    """Holder of a value that only the thread that made it can free, such as a factor of SciPy's SuperLU,
    which keeps its books by thread; it is made in the thread that made the value.

    Where that thread is the worker of :func:`call`, the worker is sent the value when this holder
    dies.  Nothing else may refer to it then.
    """

    def __init__(self, value: object):
        self._box = [value]
        weakref.finalize(self, _free, self._box, threading.current_thread()).atexit = False

    @property
    def value(self) -> Any:
        """The value itself."""
        return self._box[0]


def _free(box: list, maker: threading.Thread) -> None:
    if _worker is not None and maker is _thread and maker is not threading.current_thread():
        _worker.put(_Job(box.clear))
    else:
        box.clear()


class _Job:
    """One call, made in the worker, with its result or exception."""

    def __init__(self, work: Callable[[], Any]):
        self._work, self._context = work, contextvars.copy_context()
        self.done = threading.Event()
        self._value: Any = None
        self._error: BaseException | None = None

    def run(self) -> None:
        try:
            self._value = self._context.run(self._work)
        except BaseException as error:  # every exception belongs to the caller
            self._error = error
        finally:
            del self._work, self._context
            self.done.set()

    def result(self) -> Any:
        try:
            if self._error is not None:
                raise self._error
            return self._value
        finally:
            self._error = None  # the traceback refers to this frame: no cycle


# One worker for all calls: OpenMP keeps a team of threads for every thread that ever called it.
_worker: queue.SimpleQueue | None = None
_thread: threading.Thread
_lost: list[_Job] = []


def _idle_worker() -> queue.SimpleQueue:
    global _worker, _thread
    if _worker is None:
        _worker = queue.SimpleQueue()
        _thread = threading.Thread(
            target=_serve, args=(_worker,), name="solidgear long calls", daemon=True
        )
        _thread.start()
    return _worker


@atexit.register
def _close() -> None:
    """Let the idle worker end: otherwise data of SciPy's SuperLU by thread is not freed in order,
    and Python complains.
    """
    if _worker is not None:
        _worker.put(None)
        _thread.join(1.0)


def _serve(jobs: queue.SimpleQueue) -> None:
    while (job := jobs.get()) is not None:
        job.run()
        del job  # its data can be large


def _abandon(job: _Job) -> None:
    """Leave a call to run on: another worker takes the next one, and this one steps back."""
    global _worker
    if job.done.is_set() or _worker is None:
        return
    _worker.put(None)  # its last one
    _worker = None
    _lost.append(job)
    # Its threads (those of MKL, for instance) are not known: all but this one step back.  Priorities
    # of single threads are Linux's: psutil sets those of processes alone, and where there is no
    # /proc an abandoned call runs on beside the next one as it is.
    main = threading.get_native_id()
    for place in Path("/proc/self/task").glob("*"):
        if int(place.name) != main:
            try:
                os.setpriority(os.PRIO_PROCESS, int(place.name), 19)
            except (OSError, AttributeError):  # it has just ended
                pass


def _forget() -> None:
    """Start without a worker in a forked child, which has only the thread that forked."""
    global _worker
    _worker = None
    _lost.clear()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget)
