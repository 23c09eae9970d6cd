"""Finite elements without a model: assembly, shapes of cells, ties, local problems."""
