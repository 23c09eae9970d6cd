"""The axis about which most of a surface is round, wherever it lies.

Normals of a surface of revolution meet its axis: with its direction d and moment m, and a normal n
at x, ``d . (x * n) + m . n = 0``, which is linear. Triangles have their normals to a part of their
size; corners lie on the surface itself, and all corners of a triangle on a cylinder are as far from
the axis. So normals find the axis roughly, and distances of corners to the last digits. Sides that
miss it by more than others weigh less and less, in both.
"""

from __future__ import annotations

import numpy as np

#: rounds of weighing: residuals fall to rounding in some ten
ROUNDS = 40
#: residuals that normals of triangles have by themselves, and corners, over the size of the part
ROUGH, FINE = 3e-2, 1e-9


def shared_axis(points: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return a point (3,) on the axis, m, and the direction (3,), of length one; of a surface that
    is round about nothing, of some line.

    Examples
    --------
    >>> turn = 2 * np.pi * np.arange(24) / 24
    >>> ring = np.array([2 + np.cos(turn), 0 * turn, np.sin(turn)])
    >>> points = np.hstack([ring, ring + [[0], [3], [0]]])
    >>> k, after = np.arange(24), (np.arange(24) + 1) % 24
    >>> sides = np.hstack([[k, after, 24 + k], [after, 24 + after, 24 + k]])
    >>> foot, along = shared_axis(points, sides)
    >>> abs(along).round(9).tolist(), abs(foot[[0, 2]]).round(9).tolist()
    ([0.0, 1.0, 0.0], [2.0, 0.0])
    """
    middle = points.mean(axis=1, keepdims=True)
    size = float(np.abs(points - middle).max())
    corners = ((points - middle) / size)[:, triangles]
    foot, along = _refined(corners, *_rough(corners))
    return middle[:, 0] + size * foot, along


def _rough(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the axis by the normals of triangles, with corners (3, 3, t)."""
    a, b, c = corners.transpose(1, 0, 2)
    normal = np.cross((b - a).T, (c - a).T)
    area = np.linalg.norm(normal, axis=1)
    normal /= np.maximum(area, 1e-300)[:, None]
    rows = np.hstack([np.cross(corners.mean(axis=1).T, normal), normal])
    weight = area
    for _ in range(ROUNDS):
        gram = (rows * weight[:, None]).T @ rows
        # of all lines with a direction of length one
        dd, dm, mm = gram[:3, :3], gram[:3, 3:], gram[3:, 3:]
        back = -np.linalg.pinv(mm, rcond=1e-12) @ dm.T
        along = np.linalg.eigh(dd + dm @ back)[1][:, 0]
        residual = rows @ np.concatenate([along, back @ along])
        weight = area / (residual**2 + ROUGH**2)
    return np.cross(along, back @ along), along


def _refined(corners, foot, along) -> tuple[np.ndarray, np.ndarray]:
    """Return the axis by the distances of corners from it."""
    a, b, c = corners.transpose(1, 0, 2)
    area = np.linalg.norm(np.cross((b - a).T, (c - a).T), axis=1)
    near = ROUGH
    for _ in range(ROUNDS):
        side = np.linalg.svd(along[None])[2][1:]
        arm = corners - foot[:, None, None]
        height = np.einsum("i,ict->ct", along, arm)
        across = np.einsum("ki,ict->kct", side, arm)
        radius = np.maximum(np.linalg.norm(across, axis=0), 1e-12)
        out = across / radius
        # of a shift along either side, and a tilt towards it
        slope = np.concatenate([-out, -out * height])
        residual = (radius - radius.mean(axis=0)).ravel()
        slope = (slope - slope.mean(axis=1, keepdims=True)).reshape(4, -1)
        # faces across the axis say nothing of it
        steep = np.ptp(height, axis=0) > 1e-6
        share = np.tile(area * steep, 3)
        weight = share / (residual**2 + near**2)
        step = np.linalg.lstsq(
            (slope * weight) @ slope.T, -(slope * weight) @ residual, rcond=1e-12
        )[0]
        foot = foot + step[:2] @ side
        along = along + step[2:] @ side
        along /= np.linalg.norm(along)
        near = max(FINE, near / 2)
    return foot - (foot @ along) * along, along
