"""Groups of blocks of a body that bearings and masses on ports couple."""

from __future__ import annotations

import numpy as np

from solidgear.core.body import Body, Supports, component_rows


def decoupled(body: Body, supports: Supports, tolerance: float) -> tuple[np.ndarray, float]:
    """Return the stiffness (6 m, 6 m) of the bearings with negligible couplings between blocks
    removed, and the bound that allows it, zero where nothing was removed; couplings whose bound
    exceeds the tolerance stay.

    If ``|v' D v| <= eps v' K0 v`` for the removed part D and all v, then by Rayleigh's quotient no
    eigenvalue of the supported body moves by more than eps, relative.
    """
    k = supports.stiffness
    if not supports.ports or len(body.blocks) == 1:
        return k, 0.0
    owner = {c: b for b, block in enumerate(body.blocks) for c in block.components}
    block_of = np.array([owner.get(c, -1) for c in list(range(6)) * len(supports.ports)])
    same_block = block_of[:, None] == block_of[None, :]
    retained, removed = np.where(same_block, k, 0.0), np.where(same_block, 0.0, k)
    if not removed.any():
        return k, 0.0
    d = np.sqrt(np.abs(np.diag(k)))
    if removed[d == 0].any():
        return k, 0.0
    resisted = d > 0
    scale = np.outer(d[resisted], d[resisted])
    w, v = np.linalg.eigh(retained[np.ix_(resisted, resisted)] / scale)
    if w[0] < 1e-9:
        return k, 0.0
    half = v / np.sqrt(w)
    bound = float(
        np.abs(
            np.linalg.eigvalsh(half.T @ (removed[np.ix_(resisted, resisted)] / scale) @ half)
        ).max()
    )
    return (retained, bound) if bound <= tolerance else (k, 0.0)


def groups(body: Body, supports: Supports, spring: np.ndarray) -> list[list[int]]:
    """Return indices of blocks that bearings couple, by their stiffness from :func:`decoupled`, or
    masses on ports.
    """
    count = len(body.blocks)
    label = list(range(count))
    rows = [component_rows(range(len(supports.ports)), block.components) for block in body.blocks]
    for i in range(count):
        for j in range(i + 1, count):
            a, b = rows[i], rows[j]
            entries = np.ix_(a, b)
            if a.size and b.size and (np.any(spring[entries]) or np.any(supports.masses[entries])):
                label = [label[i] if x == label[j] else x for x in label]
    out: dict[int, list[int]] = {}
    for i in range(count):
        out.setdefault(label[i], []).append(i)
    return [out[x] for x in sorted(out)]
