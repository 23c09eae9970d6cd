"""Memory that the factor of a solid takes, told before it is made."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from solidgear.factoring import Factoring
from solidgear.scene.attached import attached_stations

if TYPE_CHECKING:
    from solidgear.scene.shaft import Shaft

MB = 2.0**20
#: bytes of an entry of a sparse matrix, with its index
ENTRY = 12.0


class Parts(NamedTuple):
    """In how many factors a matrix falls, and per whole matrix: the unknowns of each, the fill of all,
    and what PARDISO estimates for all.
    """

    pieces: int
    share: float
    fill: float
    memory: float


WHOLE = Parts(1, 1.0, 1.0, 1.0)
#: by mirror planes (:mod:`solidgear.solve.symmetry`), on four meshes of 13,000 to 90,000 unknowns: 0.25
#: to 0.27 of the fill, 0.37 to 0.43 of PARDISO's estimate
PIECES = Parts(3, 0.25, 0.265, 0.41)


def parts_of(
    scene: Shaft, element: str, attachments: Sequence[str] | None, factoring: Factoring
) -> Parts:
    """How the matrix of a solid is factored: hexahedra on seats that move freely fall into pieces.

    Parameters
    ----------
    scene : Scene
    element : str
    attachments : tuple of str or None
        Of every station; by default those of the scene.
    factoring : Factoring

    Returns
    -------
    Parts
    """
    ties = {tie for _, tie in attached_stations(scene.stations, attachments)}
    mirrors = element.startswith("hex") and "rigid" not in ties
    return PIECES if mirrors and factoring == Factoring() else WHOLE


def solid_factor_mb(
    unknowns: float,
    entries: float,
    fill: float,
    factoring: Factoring,
    parts: Parts = WHOLE,
    name: str | None = None,
) -> float:
    """Peak memory of factoring the matrix of a solid by a back end, or the one that will be taken.

    PARDISO needs its factor, its copy of the matrix and work by the entry: its own estimate for 47
    meshes within 1 % where the fill is known. In single precision the same with numbers of four
    bytes (five meshes within 1 %); out of core what it keeps of the factor goes with the entries
    (27,000 to 142,000 unknowns; it takes 5 % less than this at most).
    """
    from solidgear.solve.backends.memory_law import Outline, law
    from solidgear.solve.backends.superlu import SINGLE_SHARE
    from solidgear.solve.factor import FactorError, choice
    from solidgear.solve.petsc import elsewhere

    rows = parts.share * unknowns
    matrix = Outline((rows, rows), parts.share * entries)
    fill, entries = parts.fill * fill, parts.pieces * matrix.nnz
    if factoring.engine != "own":
        here = 2 * ENTRY * entries / MB
        return here if elsewhere() else here + ranks_mb(entries, fill, factoring)
    try:
        name = name or choice(matrix, factoring=factoring)[0]
    except FactorError:
        name = "superlu"  # said where it is factored
    single = factoring.precision == "single"
    if name == "pardiso" and factoring.out_of_core:
        return (36.0 if single else 38.0) * entries / MB + 20
    if name == "pardiso":
        number, work = (4.0, 22.5) if single else (8.0, 24.5)
        return (number * 1.05 * fill + work * entries) / MB + 20
    # MUMPS's own estimate was 1.46 to 1.84 times this law on four shafts
    if name == "mumps":
        return parts.pieces * 1.8 * law("cholmod", matrix, False)
    return (
        parts.pieces
        * law(name, matrix, False)
        * (SINGLE_SHARE if single and name == "superlu" else 1.0)
    )


def ranks_mb(entries: float, fill: float, factoring: Factoring) -> float:
    """Memory of all ranks of PETSc together: libraries, rows and numbering of each, and a factor by
    MUMPS or the levels of multigrid. Of three runs of 14,000 and 57,000 unknowns by MUMPS within a
    sixth; multigrid was seen once.
    """
    factor = 10.5 * fill if factoring.engine == "petsc" else 400.0 * entries
    return (factor + 40.0 * entries) / MB + 90.0 * factoring.ranks
