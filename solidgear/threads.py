"""The one place that says how many threads the linear algebra may use.

======================== ======================= ==========================================================================
pool                     gets                    why
======================== ======================= ==========================================================================
OpenBLAS of numpy, scipy one                     every dense matrix here is small, and its pool, spinning between calls,
                                                 fights the one that factors
MKL (PARDISO)            what is offered         nearly all the arithmetic of a 3D solid is its factorisation
BLAS under CHOLMOD,      one if it is OpenBLAS   the same variable steers it; set ``OPENBLAS_NUM_THREADS`` yourself where
MUMPS                                            CHOLMOD or MUMPS factors because PARDISO is absent
======================== ======================= ==========================================================================

Offered are the processors this process may run on (its affinity, which MKL respects by itself), less if a control group grants
fewer: a container with ``--cpus``, which MKL does not see, stops threads beyond that in turns.
Variables already set are never overruled.

Measured on the shipped overhung pinion (two cores, both busy with other work; three interleaved runs, MKL as back end): ten modes with
OpenBLAS on two threads take 4 to 11 times as long as pinned on the harmonic solid, 5 to 8 times on a 3D solid of 10 000 unknowns; the
factorisation is the same within the noise.  The loss comes from threads that wait for each other: on an idle machine it is smaller.
"""

from __future__ import annotations

import math
import os
import sys
from pathlib import Path

from solidgear.control_groups import control_groups, text_of


def pin() -> bool:
    """Give OpenBLAS one thread and MKL no more than the processors granted; False if OpenBLAS could not be told.

    OpenBLAS reads its setting once, when numpy is first imported, so this belongs before that.  Where numpy came first, a
    running OpenBLAS is told through threadpoolctl, if that is installed.
    """
    chosen = "OPENBLAS_NUM_THREADS" in os.environ
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    if "OMP_NUM_THREADS" not in os.environ and offered() < _affinity():
        os.environ.setdefault("MKL_NUM_THREADS", str(offered()))
    return "numpy" not in sys.modules or chosen or _pin_running()


def _pin_running() -> bool:
    try:
        from threadpoolctl import ThreadpoolController
    except ImportError:
        return False
    found = ThreadpoolController().select(internal_api="openblas")
    for library in found.lib_controllers:
        library.set_num_threads(1)
    return True


def offered(root: str | Path = "/") -> int:
    """Processors this process may use: its affinity, or what a control group (v1 or v2) grants, whichever is less.

    Parameters
    ----------
    root : path
        Where ``proc`` and ``sys`` are looked for.
    """
    return max(1, min([_affinity(), *(math.ceil(share) for share in _shares(Path(root)))]))


def _affinity() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _shares(root: Path):
    """Processors granted by every control group of this process."""
    for place, unified in control_groups(root, "cpu"):
        both = text_of(place / "cpu.max").split() if unified else [text_of(place / f"cpu.cfs_{name}_us").strip() for name in ("quota", "period")]
        if len(both) == 2 and all(part.isdigit() for part in both) and int(both[1]) > 0:  # "max" or -1: no limit
            yield int(both[0]) / int(both[1])
