"""Modes of a small body by dense factors: a way of its own from beginning to end.

Matrices and springs are put together here, dense factors scaled to a unit diagonal, and values come
from Ritz steps whose residuals are taken in extended precision. Rigid motions are known exactly.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as sla

from validation.side_by_side import side_by_side

EXACT = np.longdouble


def springs_by_hand(scene) -> np.ndarray:
    """(6 m, 6 m) stiffness of all bearings, series springs and housing eliminated as unknowns of
    their own.
    """
    count = len(scene.bearings)
    out = np.zeros((6 * count, 6 * count))
    for i, bearing in enumerate(scene.bearings):
        k = np.array(bearing.matrix)
        if bearing.axial_series:
            spring = 1 / sum(1 / s for s in bearing.axial_series)
            k = k - np.outer(k[:, 1], k[1]) / (k[1, 1] + spring)
        out[6 * i : 6 * i + 6, 6 * i : 6 * i + 6] = k
    if scene.housing_axial and count:
        e = np.tile([0.0, 1.0, 0, 0, 0, 0], count)
        out = out - np.outer(out @ e, out @ e) / (e @ out @ e + scene.housing_axial)
    return out


def springs_lost(scene) -> float:
    """Share that rounding leaves open of the stiffness of stiff bearings in series with soft springs:
    both sides take a difference there.
    """
    stiff = max((b.matrix[1][1] for b in scene.bearings), default=0.0)
    series = [s for b in scene.bearings for s in b.axial_series] + (
        [scene.housing_axial] if scene.housing_axial else []
    )
    return 4 * float(np.finfo(float).eps) * stiff / min(series) if series and stiff else 0.0


class Dense:
    """A body on its bearings as one dense problem, with residuals in extended precision."""

    def __init__(self, body, scene):
        k, m, motions = side_by_side(body.blocks, len(body.ports))
        rigid = np.vstack([b.rigid @ np.eye(6)[list(b.components)] for b in body.blocks])
        springs = springs_by_hand(scene)
        at = motions[6 : 6 + len(springs)].toarray()
        # Ports come in the order of the stations, the lumped point first.
        self.k, self.m, self.rigid = k.astype(EXACT), m.astype(EXACT), rigid.astype(EXACT)
        self.ports, self.springs = at.astype(EXACT), springs.astype(EXACT)
        self.free = _unresisted(at, springs, rigid)
        heavy = self.m @ self.rigid
        self._project = heavy, np.linalg.inv((self.rigid.T @ heavy).astype(float)).astype(EXACT)
        self.shift = 0.1 * body.scale
        a = k.toarray() + at.T @ springs @ at + self.shift * m.toarray()
        self._d = 1 / np.sqrt(np.diag(a))
        self._chol = sla.cho_factor(a * np.outer(self._d, self._d))
        self._m = m

    def stiff(self, x):
        """``K x`` in extended precision; rigid motions, which K resists by rounding only, are taken
        out first.
        """
        elastic = x - self.rigid @ (self._project[1] @ (self._project[0].T @ x))
        elastic = elastic - self.rigid @ (self._project[1] @ (self._project[0].T @ elastic))
        force = self.k @ elastic
        force = force - self._project[0] @ (self._project[1] @ (self.rigid.T @ force))
        return force + self.ports.T @ (self.springs @ (self.ports @ x))

    def solve(self, load):
        """``(K + springs + shift M)^-1 load``, refined until the residual is one of extended
        precision.
        """
        x = np.zeros_like(load)
        left = load
        for _ in range(12):
            step = self._d[:, None] * sla.cho_solve(
                self._chol, self._d[:, None] * left.astype(float)
            )
            x = x + step
            if np.abs(step).max() < 1e-17 * np.abs(x).max():
                break
            left = load - self.stiff(x) - self.shift * (self.m @ x)
        return x

    def values(self, n: int, steps: int = 12) -> tuple[np.ndarray, np.ndarray]:
        """Lowest ``n`` eigenvalues, zeros of unresisted motions left out, and what the last step
        changed, relative.
        """
        size = len(self._d)
        skip = self.free
        wanted = min(n + skip + 6, size)
        chol = np.linalg.cholesky(self._m.toarray() * np.outer(self._d, self._d))
        half = sla.cho_solve(self._chol, chol)
        theta, v = sla.eigh(chol.T @ half, subset_by_index=[size - wanted, size - 1])
        x = (self._d[:, None] * (half @ v))[:, ::-1].astype(EXACT)
        last = None
        for _ in range(steps):
            x = self.solve(self.m @ x)
            x = x / np.sqrt(np.einsum("ij,ij->j", x, self.m @ x))
            for _ in range(2):
                gram, energy = x.T @ (self.m @ x), x.T @ self.stiff(x)
                low = np.linalg.cholesky(gram.astype(float)).astype(EXACT)
                inverse = sla.solve_triangular(
                    low.astype(float), np.eye(len(low)), lower=True
                ).astype(EXACT)
                small = (inverse @ energy @ inverse.T).astype(float)
                w, turn = np.linalg.eigh((small + small.T) / 2)
                x = x @ (inverse.T @ turn.astype(EXACT))
            value = np.sort(
                np.einsum("ij,ij->j", x, self.stiff(x)) / np.einsum("ij,ij->j", x, self.m @ x)
            )
            value = value[skip : skip + n]
            if last is not None:
                change = np.abs(value / last - 1).astype(float)
                if change.max(initial=0.0) < 1e-13:
                    break
            last = value
        return value.astype(float), change


def _unresisted(at, springs, rigid) -> int:
    """Number of rigid motions that no spring resists: of the springs' root on motions brought to
    unit size.
    """
    if not len(springs):
        return 6
    d = np.sqrt(np.abs(np.diag(springs)))
    on = d > 0
    w, v = np.linalg.eigh(springs[np.ix_(on, on)] / np.outer(d[on], d[on]))
    root = (v[:, w > 1e-12] * np.sqrt(w[w > 1e-12])).T * d[on]
    reach = root @ (at @ rigid)[on]
    reach = reach / np.maximum(np.linalg.norm(reach, axis=1, keepdims=True), 1e-300)
    reach = reach / np.maximum(np.linalg.norm(reach, axis=0, keepdims=True), 1e-300)
    s = np.linalg.svd(reach, compute_uv=False)
    return 6 - int((s > 1e-9).sum())
