"""The one place that says how many threads the linear algebra may use.

OpenBLAS (numpy, scipy) gets one thread: all dense matrices here are small, and its pool fights the one of MKL, which factors the
large sparse ones (five times slower eigensolutions were seen).  MKL and CHOLMOD keep what the machine offers; ``MKL_NUM_THREADS``
narrows it.  Set ``OPENBLAS_NUM_THREADS`` yourself to overrule.
"""

import os
import sys


def pin() -> bool:
    """Give OpenBLAS one thread; False if numpy was imported before and it is too late.

    OpenBLAS reads its setting once, when numpy is first imported, so this must run before that.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    return "numpy" not in sys.modules
