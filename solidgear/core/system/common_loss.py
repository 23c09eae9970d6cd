r"""Steady motion where all but a few springs have the same loss factor.

With eta0 the common loss and eta0 + d_j that of a few strain rows g_j, in real modes

    (diag(w_r^2 (1 + i eta0) - w^2) + i H' diag(d) H) y = p,      H = rows g_j in modes,

the matrix is diagonal but for as many ranks as there are such rows: for the teeth of two shafts,
one. By Woodbury's identity, with D the diagonal,

    y = D^-1 (p - H' (1 + i diag(d) H D^-1 H')^-1 i diag(d) H D^-1 p),

so no complex modes are needed, and all sums are products of real matrices. A further set of
bearings costs the real modes and these products.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from solidgear.core.errors import SolidgearError
from solidgear.core.system.coupled import Coupled

#: rows that may differ; with more, complex modes are cheaper
MOST_ROWS = 4
#: largest difference over the common loss: at a resonance digits are lost by this factor
MOST_APART = 1e3
#: a mode this many times above the highest frequency is replaced by so many terms of its series, which
#: leaves 4^-20 of it
FAR, TERMS = 4.0, 10
#: frequencies at once, so that a block stays in the cache
CHUNK = 512
#: a load that differs from a combination of the rows by less than this, relative, is one
SAME = 1e-14


@dataclass(frozen=True, eq=False)
class CommonLoss:
    """Loss factor that all springs share, and the excess of a few."""

    eta: float  #: above zero
    rows: np.ndarray  #: (r, N) strain rows of those that differ
    difference: np.ndarray  #: (r,) their loss factors less the common one


def common_loss(system: Coupled, loss: Mapping[str, float]) -> CommonLoss | None:
    """Return the loss factor that most strain rows have, or None where too many differ; parts and
    links without a loss factor have none, and an unknown name is refused.

    Examples
    --------
    >>> from solidgear.core.system import Inertia, System, torsion_spring
    >>> parts = {"motor": Inertia(1.0), "fan": Inertia(1.0)}
    >>> links = {"shaft": torsion_spring("motor", 400.0, "fan"), "seal": torsion_spring("fan", 9.0)}
    >>> found = common_loss(System(parts, links), {"shaft": 0.1, "seal": 0.3})
    >>> found.eta, found.difference
    (0.1, array([0.2]))
    """
    g, rows_of = system.strains
    for name in loss:
        if name not in system.parts and name not in system.links:
            raise SolidgearError(f"a loss factor for {name!r}, which is no part and no link")
    factors = np.zeros(len(g))
    for name, rows in rows_of.items():
        factors[rows] = loss.get(name, 0.0)
    values, count = np.unique(factors, return_counts=True)
    if not len(values):
        return None
    eta = float(values[count.argmax()])
    differ = factors != eta
    if not eta > 0 or differ.sum() > MOST_ROWS or np.abs(factors - eta).max() > MOST_APART * eta:
        return None
    return CommonLoss(eta, g[differ], factors[differ] - eta)


def in_real_modes(
    system: Coupled, common: CommonLoss, w2: np.ndarray, load: np.ndarray, rows: np.ndarray
) -> np.ndarray:
    """Return complex amplitudes (f, q) of the motions `rows` (q, N) in elastic modes, without free
    motions, under a load (N,), at squares of angular frequencies (f,), rad^2/s^2.
    """
    omega, shapes = system.elastic
    push, observed, extra = shapes.T @ load, rows @ shapes, common.rows @ shapes
    weight = np.linalg.lstsq(extra.T, push, rcond=None)[0] if len(extra) else np.zeros(0)
    spanned = np.linalg.norm(push - extra.T @ weight) <= SAME * np.linalg.norm(push)
    sources = extra if spanned else np.vstack([extra, push])
    # every motion that is looked at, under every source
    pairs = (sources[:, None, :] * np.vstack([observed, extra])[None]).reshape(-1, len(omega))
    count, q = len(extra), len(observed)
    sums = _sums(pairs, omega**2, common.eta, w2).reshape(len(sources), q + count, len(w2))
    extra_sums = sums[:count, :q], sums[:count, q:]
    if spanned:
        moved, stretch = (np.tensordot(weight, part, axes=1) for part in extra_sums)
    else:
        moved, stretch = sums[count, :q], sums[count, q:]
    if count:
        lost = 1j * common.difference
        matrix = np.eye(count) + lost[:, None] * extra_sums[1].transpose(2, 1, 0)
        back = np.linalg.solve(matrix, (lost[:, None] * stretch).T[:, :, None])[:, :, 0]
        moved = moved - (extra_sums[0] * back.T[:, None, :]).sum(axis=0)
    return moved.T


def _sums(pairs: np.ndarray, level: np.ndarray, eta: float, w2: np.ndarray) -> np.ndarray:
    """Return ``sum_r pairs_r / (level_r (1 + i eta) - w^2)``, (k, f) complex.

    Far above the highest frequency a term is a power series in ``w^2 / level``; only the sums over
    modes of those are computed at every frequency.
    """
    top = float(w2.max(initial=0.0))
    near = level < FAR**2 * top
    out = np.empty((len(pairs), len(w2)), complex)
    far = level[~near] * (1 + 1j * eta)
    terms = [(pairs[:, ~near] / far) @ (top / far) ** k for k in range(TERMS)]
    series = np.column_stack(terms)
    pairs, level = pairs[:, near], level[near, None]
    for start in range(0, len(w2), CHUNK):
        part = slice(start, start + CHUNK)
        power = (w2[part] / (top or 1.0)) ** np.arange(TERMS)[:, None]
        real = level - w2[part]
        size = real * real + (eta * level) ** 2
        if np.iscomplexobj(pairs):
            out[:, part] = series @ power + pairs @ ((real - 1j * eta * level) / size)
        else:
            out.real[:, part] = series.real @ power + pairs @ (real / size)
            out.imag[:, part] = series.imag @ power - pairs @ (eta * level / size)
    return out
