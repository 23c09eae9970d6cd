"""Motions too large for a linear system: links with laws, by harmonic balance and in time."""
