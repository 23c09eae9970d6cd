"""Motions too large for a linear system: links with laws, by harmonic balance and in time.

``continuation.follow`` shows on a geared pair how a system, laws and a branch are written.
"""
