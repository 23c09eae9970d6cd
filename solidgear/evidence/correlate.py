"""Mode correlation between fidelities: MAC on axis stations, subspace MAC for degenerate pairs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.solve.modes import Mode, ModeSet


@dataclass(frozen=True)
class Partner:
    """A mode and the reference mode most like it."""

    mode: str
    partner: str
    mac: float
    frequency_hz: float
    reference_hz: float
    relative: float


@dataclass(frozen=True)
class Correlation:
    """MAC matrix between two mode sets.

    Attributes
    ----------
    rows, columns : tuple of str
        Names of the modes of the model and of the reference.
    values : (rows, columns) ndarray
        0 to 1.
    partners : tuple of Partner
        One per row, rigid modes left out.
    """

    rows: tuple[str, ...]
    columns: tuple[str, ...]
    values: np.ndarray
    partners: tuple[Partner, ...]


def subspace_mac(a: np.ndarray, b: np.ndarray, gram: np.ndarray) -> float:
    """MAC of two subspaces of station motions.

    The mean of the squared cosines of the principal angles in the inner product ``gram``; for single
    modes the usual MAC.  Degenerate pairs come out in any orientation, single MACs
    of their members mean nothing.

    Parameters
    ----------
    a, b : (k, n), (l, n) ndarray
        Shapes as rows.
    gram : (n, n) ndarray
        Symmetric positive semidefinite.
    """

    def orthonormal(x):
        w, v = np.linalg.eigh(x @ gram @ x.T)
        keep = w > 1e-12 * w.max(initial=0.0)
        return (v[:, keep] / np.sqrt(w[keep])).T @ x

    qa, qb = orthonormal(a), orthonormal(b)
    if not len(qa) or not len(qb):
        return 0.0
    cosines = np.linalg.svd(qa @ gram @ qb.T, compute_uv=False)
    return float(min(1.0, (cosines**2).sum() / min(len(qa), len(qb))))


def correlate(model: ModeSet, reference: ModeSet) -> Correlation:
    """Correlate two mode sets, with the section masses of the reference as weights.

    Raises
    ------
    ValueError
        If the sets were made on different stations.
    """
    if not np.allclose(model.stations, reference.stations):
        raise ValueError("the two mode sets were projected on different stations")

    def elastic(s: ModeSet) -> list[Mode]:
        return [m for m in s.modes if m.frequency_hz > 0]

    mine, theirs = elastic(model), elastic(reference)
    values = np.array(
        [[subspace_mac(_rows(a), _rows(b), reference.gram) for b in theirs] for a in mine]
    ).reshape(len(mine), len(theirs))
    partners = []
    for i, a in enumerate(mine):
        if not theirs:
            break
        j = int(values[i].argmax())
        b = theirs[j]
        partners.append(Partner(a.name, b.name, float(values[i, j]), a.frequency_hz, b.frequency_hz, a.frequency_hz / b.frequency_hz - 1))
    return Correlation(tuple(a.name for a in mine), tuple(b.name for b in theirs), values, tuple(partners))


def _rows(mode: Mode) -> np.ndarray:
    return mode.motions.reshape(len(mode.motions), -1)


@dataclass(frozen=True)
class Pairing:
    """A mode of the reference and the mode of the model with its shape."""

    reference: Mode
    mode: Mode | None
    mac: float
    certain: bool


def pair_modes(model: ModeSet, reference: ModeSet) -> tuple[Pairing, ...]:
    out = []
    for r in reference.modes:
        if r.frequency_hz > 0:
            m = model.named(r.name)
            out.append(Pairing(r, m, 1.0, m is not None))
    return tuple(out)
