"""Lengths in sentences on teeth."""

from __future__ import annotations


def in_mm(length: float) -> str:
    """Write a length, m, in millimetres."""
    return f"{1e3 * length:.6g} mm"


def in_um(length: float) -> str:
    """Write a small length, m, in micrometres, from a millimetre on in millimetres."""
    if length >= 1e-3:
        return f"{1e3 * length:.4g} mm"
    return f"{round(1e6 * length, 1) + 0.0:.4g} um"
