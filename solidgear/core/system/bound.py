r"""Bound between the frequencies of a system of reduced parts and those of the bodies themselves.

Every Ritz frequency is too high. By how much at most follows from the known properties of the
fields Y that the parts leave out (:mod:`solidgear.core.reduction.superelement`): y moves no port,
whatever holds the parts, and ``y'My <= y'By / cut``. With ``theta = 1 / w^2``, in a B-orthonormal
basis of Ritz vectors X and of Y the problem ``B^-1 M`` reads

    [[T, E'], [E, C]],      T = diag(theta~),      C <= 1 / cut,      E'E = X'M Y Y' M X,

and the last is the ``defect`` of the parts: further masses at ports do not move with Y. Eigenvalues
above 1/cut are those of ``T + E' (theta - C)^-1 E``, counted alike (Schur complement), and this is
at most ``T + E'E / (t - 1/cut)`` for ``1/cut < t <= theta``. So the k-th true theta lies between
theta~_k and the k-th eigenvalue of that matrix with t = theta~_k: an error of second order, without
any assumption on gaps, for single and repeated frequencies, and no mode can be missed. Zero
frequencies are exact and take no part.

The bound is one in exact arithmetic, on the error of reduction: not on that of a mesh.
"""

from __future__ import annotations

import numpy as np

from solidgear.core.reduction.superelement import Truncation


def frequency_bound(
    omega: np.ndarray, shapes: np.ndarray, truncation: Truncation, n: int
) -> np.ndarray:
    """Return the largest relative error (n,) of the n lowest elastic frequencies, from all Ritz
    frequencies (m,), ascending, rad/s, and mass-normalised shapes (N, m); zero where nothing was
    left out, infinite where nothing is proven.
    """
    if np.isinf(truncation.cut):
        return np.zeros(n)
    theta, limit = 1 / omega**2, 1 / truncation.cut
    weighted = shapes / omega
    excess = weighted.T @ truncation.defect @ weighted
    out = np.full(n, np.inf)
    for k in range(n):
        if theta[k] <= limit:
            break
        above = np.linalg.eigvalsh(np.diag(theta) + excess / (theta[k] - limit))
        out[k] = max(0.0, np.sqrt(above[-1 - k] / theta[k]) - 1)
    return out
