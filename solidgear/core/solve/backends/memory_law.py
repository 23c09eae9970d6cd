"""Memory of a factor by back ends that do not report it, and before there is a matrix.

Nested dissection of a mesh in three dimensions leaves a factor of the order of the square of the
largest separator. That holds ``n^(2/3)`` unknowns, times the cube root of the entries of a row,
since separators are as thick as an element: fill goes with ``(n nnz)^(2/3)``. On planar meshes of
orders 1 to 12 memory was seen to go with ``n nnz^(1/4)``.
"""

from __future__ import annotations

MB = 2.0**20
#: bytes by (n nnz)^(2/3), of a solid. PARDISO's analysis says 6.6 to 10.7 for 19 matrices of 5,000
#: to 146,000 unknowns, hexahedra and tetrahedra; peaks of SuperLU (minimum degree) were 11 to 18 on
#: four solids, of CHOLMOD 7 to 10; MUMPS's analysis says 1.5 to 1.8 times what CHOLMOD takes
SOLID = {"pardiso": 8.0, "cholmod": 8.5, "mumps": 14.0, "superlu": 14.0}
#: bytes by n nnz^(1/4), of a planar matrix: peaks of SuperLU on six harmonic solids of 4,000 to
#: 130,000 unknowns were 47 to 70
PLANAR = 57.0


def law(name: str, unknowns: float, entries: float, planar: bool = False) -> float:
    """Estimate the peak memory of factoring a matrix by a back end, MB: by the rows, the entries of
    both triangles, and whether it comes from a 1D or 2D mesh.

    Examples
    --------
    Of one shape, factors of solids grow with the power 4/3 of their unknowns:

    >>> small, large = (law("superlu", n, 80 * n) for n in (10_000, 80_000))
    >>> round(large / small, 6)
    16.0
    """
    if planar:
        return PLANAR * unknowns * entries**0.25 / MB
    return SOLID[name] * (unknowns * entries) ** (2 / 3) / MB
