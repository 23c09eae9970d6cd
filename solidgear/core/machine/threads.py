"""The one place that decides how many threads the linear algebra may use.

================= ================== ==============================================================
pool              gets               why
================= ================== ==============================================================
OpenBLAS of       one                every dense matrix here is small, and its pool, spinning
numpy, scipy                         between calls, fights the one that factors
MKL (PARDISO)     all granted        nearly all the arithmetic of a 3D solid is its factorisation
BLAS under        one if it is       the same variable steers it, and is kept where it is set and
CHOLMOD, MUMPS    OpenBLAS           they factor because PARDISO is absent
================= ================== ==============================================================

Granted are the processors this process may run on (the affinity), less if a control group grants
fewer: a container with ``--cpus``, which MKL does not see, stops threads beyond that in turns.
MKL takes ``OMP_NUM_THREADS`` at its word, also above the processors granted; then its threads wait
for each other in turns, so the number is held down around every call.

OpenBLAS reads ``OPENBLAS_NUM_THREADS`` once, when numpy is first imported, and ``OMP_NUM_THREADS``
in its absence.  The command line sets it before that (:func:`pin`), over what a site has set where
PARDISO factors, and says so.  A program that imports numpy first has the limit for as long as it is
inside this package (:func:`pinned`), and its previous number back afterwards.

Measured on the shipped overhung pinion (two cores, busy with other work, runs in turn): with numpy
imported first and two threads, body, compliance and ten modes took 3.4 and 5.1 times as long as
pinned on the harmonic solid, 1.7 on the 3D one.  The loss comes from threads that wait for each
other: on an idle machine it is smaller.
"""

from __future__ import annotations

import functools
import math
import os
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import ParamSpec, TypeVar

from solidgear.core.machine.control_groups import control_groups, text_of

P = ParamSpec("P")
R = TypeVar("R")
VARIABLE = "OPENBLAS_NUM_THREADS"


def pin() -> str:
    """Give OpenBLAS one thread for the life of this process, and return the number that a site has set
    and that is not kept; where another library than PARDISO factors, a number that is set is kept
    but inside :func:`single`.

    Best before numpy is imported; an OpenBLAS that is running already is set as well.
    """
    stated = os.environ.get(VARIABLE, "")
    if stated == "1" or (stated and not _pardiso_factors()):
        return ""
    os.environ[VARIABLE] = "1"
    if "numpy" in sys.modules:
        for library in _openblas():
            library.set_num_threads(1)
    return stated


def _pardiso_factors() -> bool:
    """Return True where PARDISO is installed, and no other library is chosen."""
    chosen = os.environ.get("SOLIDGEAR_BACKEND") or "pardiso"
    return chosen == "pardiso" and find_spec("pypardiso") is not None


def pinned(function: Callable[P, R]) -> Callable[P, R]:
    """Decorate a function: OpenBLAS has one thread while it runs, and the previous number afterwards.

    Examples
    --------
    >>> @pinned
    ... def inverse(matrix):
    ...     import numpy as np
    ...     return np.linalg.inv(matrix)
    >>> inverse([[2.0]])
    array([[0.5]])
    """

    @functools.wraps(function)
    def inner(*args: P.args, **kwargs: P.kwargs) -> R:
        with single():
            return function(*args, **kwargs)

    return inner


# Threads that are inside, and numbers to restore when the last one leaves: there is one number for
# the whole process.
_lock = threading.Lock()
_inside = 0
_before: list[tuple] = []


@contextmanager
def single() -> Iterator[None]:
    """Keep OpenBLAS on one thread; costs a microsecond where it has no more, nothing where its
    variable says one.
    """
    global _inside
    if os.environ.get(VARIABLE) == "1":
        yield
        return
    with _lock:
        _inside += 1
        if _inside == 1:
            for library in _openblas():
                number = library.get_num_threads()
                if number != 1:
                    _before.append((library, number))
                    library.set_num_threads(1)
    try:
        yield
    finally:
        with _lock:
            _inside -= 1
            if not _inside:
                while _before:
                    library, number = _before.pop()
                    library.set_num_threads(number)


@functools.cache
def _openblas() -> tuple:
    """Return the OpenBLAS libraries of numpy and scipy, which bring one each."""
    import scipy.linalg  # noqa: F401  (loads both)
    from threadpoolctl import ThreadpoolController

    return tuple(ThreadpoolController().select(internal_api="openblas").lib_controllers)


def usable_cores(root: str | Path = "/") -> int:
    """Return the processors this process may use, at least 1: its affinity, or the grant of a control
    group (v1 or v2), whichever is less; ``proc`` and ``sys`` are looked for below ``root``.

    Examples
    --------
    >>> usable_cores() >= 1
    True
    """
    return max(1, min([_affinity(), *(math.ceil(share) for share in _shares(Path(root)))]))


def _affinity() -> int:
    """Return the processors that this process may run on; macOS binds none."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    import psutil  # start-up: Linux says so itself

    process = psutil.Process()
    if hasattr(process, "cpu_affinity"):
        return len(process.cpu_affinity())
    return os.cpu_count() or 1


def _shares(root: Path):
    """Yield the processors granted by every control group of this process."""
    for place, unified in control_groups(root, "cpu"):
        if unified:
            words = text_of(place / "cpu.max").split()
        else:
            words = [text_of(place / f"cpu.cfs_{name}_us").strip() for name in ("quota", "period")]
        # "max" or -1: no limit
        if len(words) == 2 and all(word.isdigit() for word in words) and int(words[1]) > 0:
            quota, period = map(int, words)
            yield quota / period
