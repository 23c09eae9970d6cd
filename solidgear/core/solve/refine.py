"""Ritz values on the stiffness itself, their error bounds, and the steps that correct them.

An eigensolver that works with a computed inverse of ``A = K + L L' + sigma M`` finds the eigenpairs
of a matrix changed by rounding. Here no part of a value comes from that inverse: energies are taken
from K and from the springs L, with rigid motions split off first, so that no large stiffness has to
cancel. The residual ``r = K u + L L'u - lambda M u`` is measured where it bounds the error: with
``rho = |A^-1 r|_A / |u|_A`` an eigenvalue of ``A, M`` lies within ``rho`` of ``mu = lambda +
sigma``, relative, and within ``rho^2 / gap`` if no other comes nearer than ``gap`` (Temple; Kato
1949; Parlett 1998, section 11.7, for clusters). Where that is not small enough, ``A^-1 r`` is the
correction itself: it joins the basis and the best of both is taken (Knyazev 2001).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.core.solve.inertia_relief import columns
from solidgear.core.solve.supported import EPS, ROUNDED, Supported

#: Modes with no more than this part of their mass in elastic motion are nearly rigid ones on soft
#: springs.
SOFT = 1e-3
#: Relative error of an eigenvalue that is worth a further solve, and how many are tried.
ENOUGH, STEPS = 1e-9, 8
#: Rounding of an energy from which on it is worth products in extended precision, where the
#: processor has it.
COARSE, EXTENDED = 1e-7, np.finfo(np.longdouble).eps < EPS
#: Largest product of two shapes that count as orthogonal.
ASKEW = 1e-5


@dataclass(frozen=True)
class Refined:
    """Eigenpairs in ascending order."""

    value: np.ndarray  #: (k,) rad^2/s^2
    vectors: np.ndarray  #: (n, k) mass-orthonormal
    #: (k,) ``|A^-1 r|_A / |u|_A``, brought from the shifted to the true eigenvalue
    residual: np.ndarray
    #: (k,) bound on the relative error of each value: by the residual, and by the rounding of
    #: its energy
    error: np.ndarray
    noise: np.ndarray  #: (k,) the second part of it
    steps: int  #: corrections that were made

    def worst(self, needed: int) -> float:
        """Return the largest error of the `needed` lowest pairs, rounding left out: no step would
        mend that.
        """
        return float((self.error - self.noise)[:needed].max(initial=0.0))


@dataclass
class _Pairs:
    """Ritz pairs with residual forces, and the rounding of each energy."""

    value: np.ndarray
    u: np.ndarray
    force: np.ndarray
    rounding: np.ndarray


def refine(supported: Supported, vectors: np.ndarray, value: np.ndarray, needed: int) -> Refined:
    """Correct Ritz pairs of a supported body, in a space that is close to invariant, until the
    `needed` lowest are accurate; the others are there for the gaps. `vectors` (n, k) are
    mass-orthonormal shapes and `value` (k,) their eigenvalues, roughly, ascending, rad^2/s^2.
    """
    carried = supported.mass_rigid.T @ vectors
    elastic = np.append(columns(carried, carried) <= 1 - SOFT, True)
    # The lowest, as far as they are nearly rigid: the shift may drown their eigenvalues.  One above
    # an elastic mode is not in that danger.
    count = int(np.argmax(elastic))
    refined = _corrected(supported, vectors, value, needed, count)
    if count:
        rigid, elastic_modes = refined.vectors[:, :count], refined.vectors[:, count:]
        if np.abs(rigid.T @ supported.mass(elastic_modes)).max(initial=0.0) > ASKEW:
            refined = _corrected(supported, vectors, value, needed, 0)
    return refined


def _corrected(supported, vectors, value, needed: int, count: int) -> Refined:
    """Correct Ritz pairs, the first ``count`` of them as nearly rigid modes, until they are
    accurate or only rounding is left.
    """
    best: Refined | None = None
    last: Refined | None = None
    fine = False
    wrong = np.zeros(len(value), bool)
    correction = forces = np.zeros_like(vectors)
    for step in range(STEPS + 1):
        nearly_rigid = np.arange(len(value)) < count
        low, high = wrong & nearly_rigid, wrong & ~nearly_rigid
        stiffness = supported.elastic_extended if fine else supported.elastic
        slow = _soft_modes(supported, stiffness, vectors[:, :count], correction[:, low])
        quick = _modes(
            supported,
            stiffness,
            vectors[:, count:],
            value[count:],
            correction[:, high],
            forces[:, high],
            slow.u,
        )
        value, rounding = (
            np.append(slow.value, quick.value),
            np.append(slow.rounding, quick.rounding),
        )
        if best is not None:
            least = 0.5 * best.value[0] * max(0.0, 1 - 2 * best.error[0])
            if value.min() <= least:
                return best  # a correction that is nothing but rounding
        vectors, forces = np.hstack([slow.u, quick.u]), np.hstack([slow.force, quick.force])
        correction = supported.inverse(forces)
        refined = _judged(supported, value, vectors, forces, correction, rounding, step)
        coarse = EXTENDED and not fine and refined.noise[:needed].max(initial=0.0) > COARSE
        if best is not None and not coarse and refined.worst(needed) > 0.5 * best.worst(needed):
            return min(refined, best, key=lambda x: x.worst(needed))
        best = refined
        wrong = refined.error - refined.noise >= ENOUGH
        if not coarse and not wrong[:needed].any():
            break
        if coarse:
            fine, last, best = True, best, None  # values of the two precisions are not compared
    result = best if best is not None else last
    assert result is not None  # every step leaves one of them
    return result


def _modes(supported, stiffness, u, value, correction, forces, soft) -> _Pairs:
    """Solve Rayleigh and Ritz in the span of shapes and their corrections, without the soft modes."""
    mass = supported.mass
    count = u.shape[1]
    if not count:
        return _Pairs(np.zeros(0), u, u, np.zeros(0))
    basis, loads = u, mass(u) * (value + supported.shift)
    if correction.shape[1]:
        fresh, turn = _outside(correction, np.hstack([soft, u]), mass)
        basis, loads = np.hstack([u, fresh]), np.hstack([loads, forces @ turn])
    heavy = mass(basis)
    gram = basis.T @ heavy
    w, v = np.linalg.eigh((gram + gram.T) / 2)
    turn = v / np.sqrt(w)
    elastic = supported.without_rigid(supported.without_rigid(basis))
    pull = stiffness(elastic)
    stretch = supported.stretch(basis, loads)
    energy = (turn.T @ (elastic.T @ pull + stretch.T @ stretch) @ turn).astype(float)
    w, v = np.linalg.eigh((energy + energy.T) / 2)
    turn = turn @ v[:, :count]
    u, elastic, pull, stretch, heavy = (
        basis @ turn,
        elastic @ turn,
        pull @ turn,
        stretch @ turn,
        heavy @ turn,
    )
    # The small problem gives its eigenvalues to the rounding of the largest; quotients give each to
    # its own.
    value = (columns(elastic, pull) + columns(stretch, stretch)) / columns(u, heavy)
    force = pull + supported.load @ stretch - heavy * value
    return _Pairs(
        value.astype(float), u, force.astype(float), _rounding(supported, u, elastic, stretch)
    )


def _outside(x, base, mass):
    """Return mass-orthonormal columns of the part of ``x`` outside mass-orthonormal ones, and the
    coefficients of ``x`` in them, roughly.

    Columns that are the rounding of larger ones are left out.
    """
    heavy = mass(base)
    length = np.sqrt(columns(x, mass(x)))
    out, scale = x, np.ones(x.shape[1])
    for _ in range(3):
        out = out - base @ (heavy.T @ out)
        size = np.sqrt(columns(out, mass(out)))
        scale = scale * np.where(size > 0, size, np.inf)
        out = out / np.where(size > 0, size, np.inf)
    keep = scale > 1e-8 * length
    w, v = np.linalg.eigh(out[:, keep].T @ mass(out[:, keep]))
    coefficients = np.zeros((x.shape[1], int((w > 1e-6).sum())))
    coefficients[keep] = v[:, w > 1e-6] / np.sqrt(w[w > 1e-6]) / scale[keep, None]
    return out @ (coefficients * scale[:, None]) if keep.any() else out[:, :0], coefficients


def _soft_modes(supported, stiffness, u, correction) -> _Pairs:
    """Solve nearly rigid modes in the span of the rigid motions and of their elastic parts.

    Splitting the rigid part off exactly leaves no large stiffness to cancel: ``K`` sees the elastic
    remainder only.
    """
    count = u.shape[1]
    if not count:
        return _Pairs(np.zeros(0), u, u, np.zeros(0))
    mass = supported.mass
    rigid = supported.rigid
    if supported.free.shape[1]:
        rigid = supported.purge(rigid)
        w, v = np.linalg.eigh(rigid.T @ mass(rigid))
        rigid = rigid @ (v[:, w > 1e-10] / np.sqrt(w[w > 1e-10]))
    remainder = supported.without_rigid(supported.without_rigid(np.hstack([u, correction])))
    size = np.sqrt(columns(remainder, mass(remainder)))
    # below that a remainder of a shape is rounding
    keep = size > 1e-9 * np.append(np.ones(count), np.full(correction.shape[1], 1e-3))
    remainder = remainder[:, keep] / size[keep]
    w, v = np.linalg.eigh(remainder.T @ mass(remainder))
    independent = w > 1e-12
    remainder = remainder @ (v[:, independent] / np.sqrt(w[independent]))
    pull = stiffness(remainder)
    energy = (remainder.T @ pull).astype(float)
    w, v = np.linalg.eigh((energy + energy.T) / 2)
    r = rigid.shape[1]
    elastic = np.zeros((len(w), r + len(w)))
    elastic[:, r:] = (v * np.sqrt(np.maximum(w, 0.0))).T
    basis = np.hstack([rigid, remainder])
    # Singular values of a root keep twice the digits of a soft direction that eigenvalues of its
    # Gram matrix would.
    root = np.vstack([supported.load.T @ basis, elastic])
    s, vt = np.linalg.svd(root)[1:]
    value = np.concatenate([s**2, np.zeros(basis.shape[1] - len(s))])[::-1][:count]
    turn = vt[::-1][:count].T
    u = basis @ turn
    stretch = supported.load.T @ u
    force = pull @ turn[r:] + supported.load @ stretch - mass(u) * value
    return _Pairs(
        value, u, force.astype(float), _rounding(supported, u, remainder @ turn[r:], stretch)
    )


def _rounding(supported, u, elastic, stretch):
    """Return the rounding of each energy by products and by the matrix, rad^2/s^2 (held to dense
    solutions by validation/campaign/cases/modes.py).
    """
    products = np.linalg.norm(supported.diagonal[:, None] * elastic**2, axis=0)
    # A stretch that came from the load (see Supported.stretch) is good to the digits that the
    # motion of its seat would have had at the least.
    lost = np.minimum(EPS * supported.spread(u), EPS / ROUNDED * np.abs(stretch))
    return (
        EPS * 4 * products
        + 2 * np.linalg.norm(stretch * lost, axis=0)
        + supported.spring_rounding(u)
    )


def _judged(supported, value, u, force, correction, rounding, step) -> Refined:
    """Compute the error of each pair from the residuals of all, in the norm of the inverse."""
    mu = value + supported.shift
    rho = np.sqrt(np.maximum(columns(force, correction), 0.0) / mu)
    to_true_value = np.divide(mu, value, out=np.full_like(mu, np.inf), where=value > 0)
    noise = np.divide(rounding, value, out=np.full_like(mu, np.inf), where=value > 0)
    error = np.minimum(rho, _quadratic(mu, rho)) * to_true_value
    return Refined(value, u, rho * to_true_value, error + noise, noise, step)


def _quadratic(mu, rho):
    """Return ``sum rho^2 / gap`` over the cluster around each value for which that is least;
    infinite where that depends on eigenvalues above.
    """
    out = np.full(len(mu), np.inf)
    for i in range(len(mu)):
        a = b = i
        total = rho[i] ** 2
        while b + 1 < len(mu):
            gap_below, gap_above = (mu[a] - mu[a - 1] if a else np.inf), mu[b + 1] - mu[b]
            gap = min(gap_below, gap_above, mu[i]) / mu[i]
            # Neighbours are known to within their own residual.
            gap -= rho[b + 1] + (rho[a - 1] if a else 0.0)
            if gap > 0:
                out[i] = min(out[i], total / gap)
            if gap_below <= gap_above:
                a -= 1
                total += rho[a] ** 2
            else:
                b += 1
                total += rho[b] ** 2
    return out
