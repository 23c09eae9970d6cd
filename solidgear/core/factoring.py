"""Choices for the factors of a body, where the usual ones take more memory than there is."""

from __future__ import annotations

from dataclasses import dataclass

#: what a factor may be kept in
PRECISIONS = ("double", "single")
#: who factors: this program, or PETSc in processes of its own, by MUMPS or by multigrid
ENGINES = ("own", "petsc", "petsc-gamg")


@dataclass(frozen=True)
class Factoring:
    """Requests to a solver beyond the choice of a back end.

    Examples
    --------
    >>> Factoring(precision="single").words
    'single precision'
    >>> Factoring().words
    ''
    """

    #: of the factor. Solutions are refined in double precision either way.
    precision: str = "double"
    out_of_core: bool = False  #: whether the factor is kept in files
    #: PETSc in processes of its own: MUMPS, or conjugate gradients on algebraic multigrid
    engine: str = "own"
    ranks: int = 2  #: processes of the engine

    @property
    def words(self) -> str:
        """Settings that are not the usual ones, in words; empty where all are usual."""
        unusual = []
        if self.precision == "single":
            unusual.append("single precision")
        if self.out_of_core:
            unusual.append("out of core")
        if self.engine != "own":
            unusual.append(f"{self.engine} on {self.ranks} ranks")
        return ", ".join(unusual)
