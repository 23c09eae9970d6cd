"""Calls handed to a second thread: the same results and errors, and a wait that a signal ends."""

import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from solidgear.core.machine import interruptible
from solidgear.core.machine.interruptible import ThreadBound, abandoned, call

ROOT = Path(__file__).parent.parent
main = threading.main_thread()


def child(code):
    return subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        timeout=120,
    )


def test_results_and_options_pass_through():
    assert call(lambda a, *, b: (a, b, threading.current_thread() is main), 1, b=2) == (1, 2, False)


def test_errors_pass_through_unchanged():
    error = ValueError("as it was")

    def fail():
        raise error

    for _ in range(2):  # the second thread outlives them
        with pytest.raises(ValueError) as caught:
            call(fail)
        assert caught.value is error
    assert any(entry.name == "fail" for entry in caught.traceback)


@pytest.mark.parametrize("kind", [KeyboardInterrupt, SystemExit, MemoryError])
def test_errors_of_every_kind(kind):
    def fail():
        raise kind

    with pytest.raises(kind):
        call(fail)
    assert not abandoned()


def test_what_is_set_for_a_thread_holds_for_the_call():
    with np.errstate(divide="raise"):
        with pytest.raises(FloatingPointError):
            call(lambda: np.ones(1) / 0)


def test_calls_use_one_thread():
    """OpenMP keeps a team of threads for each that calls it."""
    assert call(threading.get_ident) == call(threading.get_ident)


def test_in_another_thread_the_call_is_simply_made():
    seen = []
    thread = threading.Thread(
        target=lambda: seen.append(call(threading.get_ident) == threading.get_ident())
    )
    thread.start()
    thread.join()
    assert seen == [True]


def test_a_call_inside_a_call_is_simply_made():
    assert call(lambda: call(threading.get_ident) == threading.get_ident())


@pytest.mark.parametrize("handler", [signal.SIG_IGN, signal.SIG_DFL])
def test_where_ctrl_c_is_not_heard_the_call_is_simply_made(handler):
    before = signal.signal(signal.SIGINT, handler)
    try:
        assert call(threading.current_thread) is main
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_an_interrupted_call_is_left_to_itself_and_the_next_one_works():
    begun, go_on = threading.Event(), threading.Event()

    def long():
        begun.set()
        go_on.wait()

    def press():
        begun.wait()
        os.kill(os.getpid(), signal.SIGINT)

    # Only threads that are there when a call is abandoned are slowed down, and this process is to
    # stay as it is.
    presser = threading.Thread(target=press)
    presser.start()
    with pytest.MonkeyPatch.context() as patch, pytest.raises(KeyboardInterrupt):
        patch.setattr(os, "setpriority", lambda *_: None)
        call(long)
    presser.join()
    assert abandoned()
    assert call(lambda: 7) == 7  # by another thread: the first is still waiting
    assert abandoned()
    go_on.set()
    for _ in range(1000):
        if not abandoned():
            break
        time.sleep(0.01)
    assert not abandoned() and call(lambda: 8) == 8


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="priorities of single threads")
def test_an_abandoned_call_gets_out_of_the_way():
    code = """
import os, signal, threading
signal.signal(signal.SIGINT, signal.default_int_handler)  # even where this process was told not to hear it
from solidgear.core.machine.interruptible import call, leave
numbers = []
def long():
    numbers.append(threading.get_native_id())
    threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT)).start()
    threading.Event().wait()
try:
    call(long)
except KeyboardInterrupt:
    print(os.getpriority(os.PRIO_PROCESS, numbers[0]), os.getpriority(os.PRIO_PROCESS, 0))
leave(130)
"""
    done = child(code)
    assert (done.returncode, done.stderr) == (
        130,
        "",
    ) and done.stdout == f"19 {os.getpriority(os.PRIO_PROCESS, 0)}\n"


@pytest.mark.parametrize("code", [None, 0, 3, "a sentence"])
def test_leaving_without_an_abandoned_call_is_an_ordinary_exit(code):
    with pytest.raises(SystemExit) as end:
        interruptible.leave(code)
    assert end.value.code == code


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork")
def test_a_forked_child_has_a_thread_of_its_own():
    # a child of a small process: to fork this one, the system may want as much memory again
    code = """
import os
from solidgear.core.machine.interruptible import call
call(lambda: None)
child = os.fork()
if child == 0:
    os._exit(call(lambda: 5))
print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""
    done = child(code)
    assert (done.stdout, done.stderr) == ("5\n", "")


class Heavy:
    """Notes the thread in which it is freed."""

    def __init__(self, freed):
        self.freed = freed

    def __del__(self):
        self.freed.append(threading.current_thread())


@pytest.mark.parametrize("made_by_worker", [True, False])
def test_what_a_thread_made_is_freed_by_that_thread(made_by_worker):
    freed: list[threading.Thread] = []

    def make():
        return ThreadBound(Heavy(freed)), threading.current_thread()

    held, maker = call(make) if made_by_worker else make()
    assert (maker is main) != made_by_worker and held.value.freed is freed
    del held
    call(lambda: None)  # the worker takes one job after the other
    assert freed == [maker]


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
@pytest.mark.long
def test_factors_of_superlu_are_given_back():
    # SciPy frees what SuperLU took only in the thread that took it: 40 factors of 1.2 MB each would
    # stay.
    code = """
import gc, re
import numpy as np, scipy.sparse as sp
from solidgear.core.solve import factor, factored
factored.LONG = 0
def taken():
    gc.collect()
    return int(re.search(r"VmRSS:\\s+(\\d+)", open("/proc/self/status").read())[1]) / 1024
line = sp.diags_array([2.01, -1.0, -1.0], offsets=[0, 1, -1], shape=(60, 60))
plate = sp.kronsum(line, line).tocsr()
sizes = []
for _ in range(60):
    made = factor.factorise(plate, backend="superlu")
    sizes.append(taken())
print(sizes[-1] - sizes[19])
"""
    done = child(code)
    assert done.stderr == "" and float(done.stdout) < 15
