"""How many threads the linear algebra gets, whatever was imported first and whatever the shell
exports.
"""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from solidgear.core.machine import threads
from solidgear.core.solve.backends import missing

ROOT = Path(__file__).parent.parent
VARIABLES = ("OPENBLAS_NUM_THREADS", "GOTO_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
#: numbers of threads of every OpenBLAS that is loaded
NUMBERS = """
import numpy, scipy.linalg, threadpoolctl
def numbers():
    return sorted({p["num_threads"] for p in threadpoolctl.threadpool_info() if p["internal_api"] == "openblas"})
def set_all(n):
    for lib in threadpoolctl.ThreadpoolController().select(internal_api="openblas").lib_controllers:
        lib.set_num_threads(n)
"""


def said(code, **variables):
    """What a fresh interpreter prints."""
    env = (
        {k: v for k, v in os.environ.items() if k not in VARIABLES}
        | variables
        | {"PYTHONPATH": str(ROOT)}
    )
    done = subprocess.run(
        [sys.executable, "-c", code], env=env, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.split("\n")[:-1]


def test_numpy_first_is_held_to_one_thread_inside_and_gets_its_own_back():
    """As in the README's example, in a shell that exports OMP_NUM_THREADS; the machine may have one
    processor, so two are asked for by hand.
    """
    code = (
        NUMBERS
        + """
set_all(2)
import solidgear as sg
from solidgear.core.machine import threads
scene = sg.load("geometry/pinion_overhung.toml")
seen = []
import solidgear.core.models.beam.body as beam
real = beam.beam
import functools
beam.beam = functools.wraps(real)(lambda *a, **k: (seen.append(numbers()), real(*a, **k))[1])
body = sg.build(scene, "timoshenko")
print(seen[0], numbers())
import solidgear.core.solve.modes as solve
real_parts = solve.solved_parts
solve.solved_parts = lambda *a, **k: (seen.append(numbers()), real_parts(*a, **k))[1]
sg.modes(body, scene, n=2)
print(seen[1], numbers())
try:
    sg.condense(body, scene, port="nowhere")
except Exception:
    print(numbers())
"""
    )
    assert said(f"import os; os.chdir({str(ROOT)!r})" + code, OMP_NUM_THREADS="2") == [
        "[1] [2]",
        "[1] [2]",
        "[2]",
    ]


def test_a_number_that_a_site_has_chosen_is_held_to_one_inside_and_kept_outside():
    """Two threads that wait for each other took three times the processor time of one."""
    code = (
        NUMBERS
        + """
set_all(2)
from solidgear.core.machine import threads
with threads.single():
    print(numbers())
print(numbers(), repr(threads.pin()), numbers())
"""
    )
    kept = ["[1]", "[2] '' [2]"]
    assert said(code, OPENBLAS_NUM_THREADS="2", SOLIDGEAR_BACKEND="superlu") == kept
    if not missing("pardiso"):
        assert said(code, OPENBLAS_NUM_THREADS="2") == ["[1]", "[2] '2' [1]"]


@pytest.mark.parametrize(
    ("variable", "line"),
    [
        ("OMP_NUM_THREADS", ""),
        pytest.param(
            "OPENBLAS_NUM_THREADS",
            "OPENBLAS_NUM_THREADS=2 is not kept: dense matrices are small here and take one "
            "thread; PARDISO takes all cores granted",
            marks=pytest.mark.skipif(bool(missing("pardiso")), reason="needs MKL"),
        ),
    ],
)
def test_the_command_line_has_one_thread_whatever_is_exported(variable, line):
    code = (
        "import solidgear.app"
        + NUMBERS
        + "from solidgear.show.command import Progress; print(numbers(), Progress.first)"
    )
    assert said(code, **{variable: "2"}) == [f"[1] {line}"]


def test_pin_tells_a_numpy_that_is_there_already():
    assert said(
        NUMBERS
        + "set_all(2)\nfrom solidgear.core.machine import threads\nthreads.pin()\nprint(numbers())"
    ) == ["[1]"]


def test_calls_inside_calls_and_beside_them_restore_the_number_once(monkeypatch):
    class Library:
        number = 4

        def get_num_threads(self):
            return self.number

        def set_num_threads(self, n):
            self.number = n

    library = Library()
    monkeypatch.delenv("OPENBLAS_NUM_THREADS", raising=False)
    monkeypatch.setattr(threads, "_openblas", lambda: (library,))

    @threads.pinned
    def work(depth):
        assert library.number == 1
        if depth:
            work(depth - 1)
        assert library.number == 1  # the inner one has not given it back
        if depth == 2:
            raise KeyError

    with pytest.raises(KeyError):
        work(2)
    assert library.number == 4
    first, second = threads.single(), threads.single()
    first.__enter__(), second.__enter__()
    first.__exit__(None, None, None)
    assert library.number == 1  # someone else is still inside
    second.__exit__(None, None, None)
    assert library.number == 4


@pytest.mark.skipif(
    bool(missing("pardiso")) or not hasattr(os, "sched_setaffinity"), reason="needs MKL and Linux"
)
def test_mkl_takes_no_more_threads_than_processors():
    """One processor granted, four threads asked for by the shell: a factorisation must start none
    beside its own.
    """
    code = """
import os
os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
import scipy.sparse as sp
from solidgear.core.solve.factor import factorise
n = 4000
matrix = sp.diags([4.0, -1.0, -1.0, -0.5, -0.5], [0, 1, -1, 90, -90], shape=(n, n)).tocsr()
before = len(os.listdir("/proc/self/task"))
factor = factorise(matrix, "pardiso")
print(factor.backend, len(os.listdir("/proc/self/task")) - before)
"""
    assert said(code, OMP_NUM_THREADS="4") == ["pardiso 0"]
