"""Block Lanczos for the largest eigenvalues of ``A^-1 M``, started from a good guess.

One factorisation of A is at hand and a solve with eight right-hand sides costs little more than
one, so eight directions are driven at a time. Twins are found together whatever their symmetry,
because a block holds both. The basis is kept orthogonal in the mass norm in full (Golub and
Underwood 1977; Grimes, Lewis and Simon 1994): it has some tens of columns, which cost little beside
the solves. Where modes lie so close that it would outgrow its room, its best half goes on (Wu and
Simon 2000, SIAM J. Matrix Anal. Appl. 22, 602), still in blocks.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.core.solve.inertia_relief import Linear


@dataclass(frozen=True)
class Eigenpairs:
    """Eigenpairs of ``A^-1 M u = theta u``."""

    theta: np.ndarray  #: (k,) descending
    vectors: np.ndarray  #: (n, k) mass-orthonormal
    columns: int  #: solves that were spent
    converged: bool


#: columns that may be spent, in those of a full basis
PATIENCE = 20


def block_lanczos(
    operator: Linear,
    mass: Linear,
    start: np.ndarray,
    wanted: int,
    *,
    tolerance: float = 1e-9,
    most: int = 400,
    seed: int = 1,
) -> Eigenpairs:
    """Find the `wanted` largest eigenvalues of a symmetric positive operator ``A^-1 f`` in the mass
    inner product, with a basis of at most `most` vectors; not converged after `PATIENCE` of these.

    Parameters
    ----------
    start : (n, p) ndarray
        First block. Shapes that are orthogonal to it (by symmetry, say) are found only through
        rounding: add random columns.
    tolerance : float
        Largest ``|A^-1 M u - theta u| / theta`` in the mass norm; eigenvalues are good to the
        square of it over the relative gap.
    seed : int
        Of the directions that replace an exhausted block.

    Examples
    --------
    Both of a pair of equal eigenvalues are found:

    >>> value = np.array([9.0, 9.0, 4.0, 1.0, 0.5])
    >>> start = np.random.default_rng(0).standard_normal((5, 2))
    >>> pairs = block_lanczos(lambda f: value[:, None] * f, lambda u: u, start, wanted=3)
    >>> np.round(pairs.theta, 9)
    array([9., 9., 4.])
    """
    n, width = start.shape
    most = min(most, n)
    generator = np.random.default_rng(seed)
    # Column order: slices of leading columns stay contiguous, and the direct solvers want it.
    basis, heavy = (np.empty((n, most + width), order="F") for _ in range(2))
    small = np.zeros((most + width,) * 2)
    k = spent = 0
    block, loaded, _ = _orthonormal(start, mass(start))
    while True:
        p = block.shape[1]
        basis[:, k : k + p], heavy[:, k : k + p] = block, loaded
        old, k = k, k + p
        q, mq = basis[:, :k], heavy[:, :k]
        ahead = operator(loaded)
        spent += p
        column = mq.T @ ahead
        small[:k, old:k], small[old:k, :k] = column, column.T
        block, loaded, coupling = _outside(ahead, column, q, mq, mass)
        if k < min(wanted, n) and block.shape[1]:
            continue
        every, turn = np.linalg.eigh((small[:k, :k] + small[:k, :k].T) / 2)
        every, turn = every[::-1], turn[:, ::-1]
        theta, s = every[:wanted], turn[:, :wanted]
        residual = np.linalg.norm(coupling @ s[old:], axis=0)
        converged = k >= min(wanted, n) and bool((residual <= tolerance * np.abs(theta)).all())
        if not converged and not block.shape[1] and k < n:
            # The space is invariant: all that the start block can reach is found. Go on where it
            # could not look.
            fresh = operator(generator.standard_normal((n, width)))
            block, loaded, _ = _outside(fresh, mq.T @ fresh, q, mq, mass)
        full = k + block.shape[1] > most
        kept = max(most // 2, wanted)
        if converged or not block.shape[1] or full and (spent > PATIENCE * most or kept >= k):
            return Eigenpairs(theta, q @ s, spent, converged)
        if full:
            basis[:, :kept], heavy[:, :kept] = q @ turn[:, :kept], mq @ turn[:, :kept]
            small[:kept, :kept] = np.diag(every[:kept])
            k = kept


def _orthonormal(x, heavy, least: float = 0.0):
    """Return mass-orthonormal columns that span ``x``, their product with the mass, and the
    coefficients of ``x`` on them; `heavy` is the product of ``x`` with the mass.

    Columns shorter than ``least`` and directions that are the rounding of others are left out.
    """
    gram = x.T @ heavy
    length = np.sqrt(np.maximum(np.diag(gram), 0.0))
    if x.shape[1] == 1 and length[0] > least:
        return x / length, heavy / length, length[:, None]
    unit = np.where(length > least, 1 / np.where(length > 0, length, 1.0), 0.0)
    w, v = np.linalg.eigh((gram + gram.T) / 2 * np.outer(unit, unit))
    keep = w > 1e-12
    root = np.sqrt(w[keep])
    turn = unit[:, None] * v[:, keep] / root
    return x @ turn, heavy @ turn, (v[:, keep] * root).T * length


def _outside(x, inside, basis, heavy, mass):
    """Return mass-orthonormal columns of the part of ``x`` outside the basis, their product with
    the mass, and the coefficients of ``x`` on them.

    ``inside = heavy.T @ x``. Twice is enough (Parlett 1998, section 6.9), with the columns brought
    to unit length in between.
    """
    rounding = 1e-13 * float(np.linalg.norm(inside))
    rest = x - basis @ inside
    y, loaded, first = _orthonormal(rest, mass(rest), rounding)
    again = heavy.T @ y
    y, loaded, second = _orthonormal(y - basis @ again, loaded - heavy @ again)
    return y, loaded, second @ first
