"""Direct solvers for sparse symmetric matrices, all behind the same four names.

A back end takes the matrix as CSR, sorted, and analyses it; then it has ``estimate_mb``, the
memory the numbers will need, and only ``factor()`` takes that memory. After it ``solve(rhs)``,
``negative`` and ``nnz`` can be asked for.

======== ============================ ==================== ========================================
name     what it is                   indefinite matrices  memory estimate
======== ============================ ==================== ========================================
pardiso  MKL PARDISO, LL' or LDL'     yes                  its own, from the analysis
cholmod  SuiteSparse, supernodal LL'  no                   a law: scikit-sparse passes on no count
mumps    MUMPS, LDL'                  yes                  its own, from the analysis
superlu  SciPy's SuperLU, LU          unpivoted            a law: it has no separate analysis
======== ============================ ==================== ========================================
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
import scipy.sparse as sp

from solidgear.core.registry import added
from solidgear.core.solve.backends.cholmod import Cholmod
from solidgear.core.solve.backends.pardiso import Pardiso
from solidgear.core.solve.backends.superlu import SuperLU

BACKENDS: dict[str, Any] = {
    back.name: back for back in (Pardiso, Cholmod, *added("back end").values(), SuperLU)
}
#: those that factor in single precision, and those that keep a factor in files
SINGLE, OUT_OF_CORE = ("pardiso", "superlu"), ("pardiso", "mumps")
#: commands that install what a back end needs, of those that SciPy does not bring
INSTALL = {name: back.install for name, back in BACKENDS.items() if back.install}


@lru_cache
def missing(name: str) -> str:
    """Return the reason why a back end cannot be used, empty if it can.

    Examples
    --------
    >>> missing("superlu")
    ''
    """
    module = BACKENDS[name].package
    try:
        back = BACKENDS[name](sp.identity(2, format="csr"))
        back.factor()
        if np.array_equal(back.solve(np.ones(2)), np.ones(2)):
            return ""
        return f"{module} is not usable (it fails on the unit matrix)"
    except Exception as error:  # a broken library raises OSError, ImportError, AttributeError ...
        return f"{module} is not usable ({type(error).__name__})"
