"""Tolerance of a quarter turn of what is attached to a shaft: twins need bearings and masses that
it leaves as they are.
"""

from __future__ import annotations

import numpy as np

from solidgear.body import Supports
from solidgear.frames import rotation


def alike(supports: Supports) -> float:
    """Bound on the relative change of any eigenvalue by a quarter turn of the bearings, and of the
    masses on ports; infinite where the change is not small.

    If ``|v' D v| <= eps v' K v`` for the change D of the stiffness K, then no eigenvalue of the
    supported body moves by more than eps (Rayleigh), and likewise for a change of the mass.

    Examples
    --------
    >>> round(alike(Supports(("A",), np.diag([1e8, 0.0, 1e8, 0.0, 0.0, 0.0]))), 12)
    0.0
    >>> round(alike(Supports(("A",), np.diag([1e8, 0.0, 2e8, 0.0, 0.0, 0.0]))), 12)
    1.0
    """
    if not supports.ports:
        return 0.0
    turned = _turned(supports.stiffness)
    return turned if supports.inertia is None else turned + _turned(supports.inertia)


def _turned(k: np.ndarray) -> float:
    """Largest change of ``v' k v`` by a quarter turn, relative; infinite where it is not small."""
    turn = np.kron(np.eye(len(k) // 6), rotation(1, np.pi / 2))
    change = turn @ k @ turn.T - k
    size = np.sqrt(np.abs(np.diag(k)))
    on = size > 0
    scale = np.outer(size[on], size[on])
    if np.abs(change[~on]).max(initial=0.0) > 1e-12 * np.abs(k).max(initial=0.0):
        return np.inf
    w, v = np.linalg.eigh(k[np.ix_(on, on)] / scale)
    relative = change[np.ix_(on, on)] / scale
    good = w > 1e-9
    if np.abs(v[:, ~good].T @ relative).max(initial=0.0) > 1e-12:
        return np.inf
    half = v[:, good] / np.sqrt(w[good])
    return float(np.abs(np.linalg.eigvalsh(half.T @ relative @ half)).max(initial=0.0))
