"""A matrix that has been factored: the solver, and how the factor was made."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from solidgear.core.factoring import Factoring
from solidgear.core.machine.interruptible import call
from solidgear.core.solve.single import Refining


class Ranks(Protocol):
    """A matrix factored by ranks of processes, which find modes as well."""

    steps: int  #: most iterations of a solution; 0 for a direct factor

    def modes(
        self, wanted: int, load, through, inner, free, tolerance: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the lowest eigenpairs of the matrix with springs."""


# Unknowns from which on a call can take so long that Ctrl-C must be heard meanwhile; handing it
# over costs 0.1 ms.
LONG = 5_000


@dataclass
class Factor:
    """Result of :func:`solidgear.core.solve.factor.factorise`."""

    backend: str  #: ``pardiso``, ``cholmod``, ``mumps`` or ``superlu``
    reason: str  #: why this back end was taken
    _solve: Callable[[np.ndarray], np.ndarray]
    estimate_mb: float | None = None  #: memory it was expected to need, MB
    nnz: int | None = None  #: entries of the factor, where the back end reports them
    factoring: Factoring = Factoring()  #: precision, and where it is kept
    refining: Refining | None = None  #: of a factor in single precision
    ranks: Ranks | None = None  #: of a factor by MUMPS in PETSc, which finds modes as well

    @property
    def label(self) -> str:
        """Name of the back end, with unusual properties of the factor."""
        unusual = [self.factoring.words] if self.factoring.words else []
        if self.refining is not None:
            unusual.append(f"{self.refining.steps} refinements in double")
        return self.backend + (f" ({', '.join(unusual)})" if unusual else "")

    def solve(self, rhs: np.ndarray) -> np.ndarray:
        """Solve for one (n,) or several (n, k) right-hand sides."""
        return call_interruptibly(len(rhs), self._solve, rhs)


@dataclass
class Indefinite(Factor):
    """Result of :func:`solidgear.core.solve.factor.indefinite`."""

    negative: int = 0  #: number of negative eigenvalues


def call_interruptibly(n, function, *arguments, **options):
    """Call a function so that Ctrl-C can end it, if the unknowns are so many that it may last."""
    return call(function, *arguments, **options) if n >= LONG else function(*arguments, **options)
