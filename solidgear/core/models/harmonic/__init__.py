"""Axisymmetric-harmonic solids."""
