"""Computed shapes on measuring points, and how like measured ones they are.

MAC of a measured shape and a mode is the share of it that lies in the span of the mode's shapes
(Allemang 2003, Sound and Vibration 37, 14, eq. 4, where there is one; for a pair the plane of the
measurement is free).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.spatial import cKDTree

from solidgear.body import Body
from solidgear.body.surface import Surface
from solidgear.errors import SolidgearError
from solidgear.studies.measured.computed import Computed
from solidgear.studies.measured.universal import Shapes

#: largest distance of a point from the surface, as a share of the largest radius
OFF = 0.05
#: nearest points of the surface whose triangles are tried
NEAR = 4


class OnPoints:
    """Motions of a body's surface at measuring points.

    Parameters
    ----------
    numbers : sequence of int
        Of the points.
    points : (p, 3) ndarray
        m.

    Raises
    ------
    SolidgearError
        For a point that is off the surface.
    """

    def __init__(self, body: Body, numbers: Sequence[int], points: np.ndarray):
        self.body = body
        self.corners, self.weights = _places(body.surface({}), numbers, points)

    def of(self, vector: Mapping[int, np.ndarray]) -> np.ndarray:
        """(p, 3) displacements by unknowns of blocks."""
        moved = self.body.surface(vector).displacement[self.corners]
        return np.einsum("pc,pcx->px", self.weights, moved)


def mac_of(measured: Shapes, computed: Computed) -> np.ndarray:
    """MAC of all measured shapes (rows) and all modes of a body.

    Raises
    ------
    SolidgearError
        For a point that is off the surface.
    """
    places = OnPoints(computed.body, measured.numbers.tolist(), measured.points)
    seen = np.any(measured.values != 0, axis=0)
    out = np.zeros((len(measured.values), len(computed.modes)))
    rows = measured.values[:, seen]
    whole = np.sum(np.abs(rows) ** 2, axis=1)
    for j, mode in enumerate(computed.modes):
        span = np.column_stack([places.of(vector)[seen] for vector in mode.vectors])
        left, size, _ = np.linalg.svd(span, full_matrices=False)
        # a mode that no point sees spans nothing
        left = left[:, size > 1e-6 * max(size[0], np.finfo(float).tiny)]
        out[:, j] = np.sum(np.abs(rows @ left) ** 2, axis=1) / whole
    return out


def _places(
    still: Surface, numbers: Sequence[int], points: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Corners of the triangle that is nearest to every point, and their weights."""
    faces = still.faces
    triangles = np.concatenate(
        [np.reshape(part, (-1, 3)) for part in (faces[:, :3], faces[:, [0, 2, 3]], still.triangles)]
    )
    near = cKDTree(still.points).query(points, NEAR)[1]
    radius = float(np.hypot(still.points[:, 0], still.points[:, 2]).max())
    corners, weights = [], []
    for number, point, around in zip(numbers, points, near):
        tried = triangles[np.any(np.isin(triangles, around), axis=1)]
        weight = np.array([_weights(still.points[one], point) for one in tried])
        there = np.einsum("tc,tcx->tx", weight, still.points[tried])
        away = np.linalg.norm(there - point, axis=1)
        best = int(away.argmin())
        if away[best] > OFF * radius:
            raise SolidgearError(
                f"measuring point {number} at x, y, z = {', '.join(f'{x:.6g}' for x in point)} m is "
                f"{away[best]:.3g} m off the surface, more than {100 * OFF:.0f} % of the largest "
                "radius; points are told in the scene's frame, y along the axis"
            )
        corners.append(tried[best])
        weights.append(weight[best])
    return np.array(corners), np.array(weights)


def _weights(corners: np.ndarray, point: np.ndarray) -> np.ndarray:
    """Shares of a triangle's corners in the point of it that is near another."""
    sides = (corners[1:] - corners[0]).T
    s, t = np.clip(np.linalg.lstsq(sides, point - corners[0], rcond=None)[0], 0.0, 1.0)
    return np.array([max(1 - s - t, 0.0), s, t]) / (max(1 - s - t, 0.0) + s + t)
