"""Factors by MUMPS and PETSc."""

import solidgear.core.solve.backends  # noqa: F401  # first, for back ends hold that of this room
