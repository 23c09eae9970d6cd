"""Peak memory of a factorisation, estimated for back ends that cannot say it themselves."""

from __future__ import annotations

from dataclasses import dataclass

import scipy.sparse as sp

# Peak memory of a factorisation in MB = c (n / 1e4)^a (entries / 1e6)^b, fitted to peaks of
# resident memory measured on the shipped overhung pinion: solids of all element types with 4 800 to
# 92 000 unknowns, harmonic blocks of 10 000 to 51 000 (order 2 to 8). Estimate over measured:
# superlu 0.68 to 1.41 (ten solids), 0.97 to 1.04 (five planar); cholmod 0.75 to 1.16 (eleven), 0.97
# to 1.02. Graded hexahedra are at the low end: fitted without the largest of them, its memory came
# out as 0.47 (superlu) and 0.64 (cholmod) of the measured. So these separate a model that fits from
# one that is hopeless; they do not decide whether one just fits.
LAWS = {
    ("superlu", False): (74.9, 0.778, 0.540),
    ("superlu", True): (18.6, 0.0, 0.836),
    ("cholmod", False): (46.7, 0.455, 0.631),
    ("cholmod", True): (18.6, 0.0, 0.924),
}


@dataclass(frozen=True)
class Outline:
    """A matrix that is not there yet: how large it will be.

    Attributes
    ----------
    shape : (float, float)
    nnz : float
        Entries.
    """

    shape: tuple[float, float]
    nnz: float


def law(name: str, matrix: sp.csr_matrix | Outline, planar: bool) -> float:
    """Estimated peak memory of a back end that gives no estimate itself.

    Parameters
    ----------
    name : {'superlu', 'cholmod'}
    matrix : (n, n) sparse or Outline
    planar : bool
        Whether it comes from a 1D or 2D mesh.

    Returns
    -------
    float
        MB.
    """
    factor, by_unknowns, by_entries = LAWS[name, planar]
    return factor * (matrix.shape[0] / 1e4) ** by_unknowns * (matrix.nnz / 1e6) ** by_entries
