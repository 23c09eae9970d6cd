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

from solidgear import interruptible
from solidgear.interruptible import abandoned, call

ROOT = Path(__file__).parent.parent
main = threading.main_thread()


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
    thread = threading.Thread(target=lambda: seen.append(call(threading.get_ident) == threading.get_ident()))
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

    # Only threads that are there when a call is abandoned are slowed down, and this process is to stay as it is.
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
from solidgear.interruptible import call, leave
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
    done = subprocess.run([sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True, text=True, timeout=120,
                          preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))  # fmt: skip
    assert (done.returncode, done.stderr) == (130, "") and done.stdout == f"19 {os.getpriority(os.PRIO_PROCESS, 0)}\n"


@pytest.mark.parametrize("code", [None, 0, 3, "a sentence"])
def test_leaving_without_an_abandoned_call_is_an_ordinary_exit(code):
    with pytest.raises(SystemExit) as end:
        interruptible.leave(code)
    assert end.value.code == code


def test_a_forked_child_has_a_thread_of_its_own():
    if not hasattr(os, "fork"):
        pytest.skip("no fork")
    call(lambda: None)
    child = os.fork()
    if child == 0:
        os._exit(call(lambda: 5))
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 5
