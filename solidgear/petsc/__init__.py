"""Factors by MUMPS and PETSc."""
