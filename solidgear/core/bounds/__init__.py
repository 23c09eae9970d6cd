"""Bounds of the error of harmonic solids by local problems, and meshes that follow it."""
