"""Surfaces and their motions in few bytes, for a page that has to hold them.

Points come meridian by meridian, so that each is close to the one before and moves nearly as it
does. Whole numbers of a step take the place of coordinates, differences of successive ones that of
the numbers, and these are deflated (RFC 1950). The script of the page undoes it with the browser's
own ``DecompressionStream``.
"""

from __future__ import annotations

import base64
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from solidgear.core import Surface

#: points nearer than this share of the length are one
SAME = 1e-8
#: a direction that lies along no edge or symmetry of a shaft
ODD = np.array([0.4379, 0.7411, 0.5089])
#: edges at which the surface turns by more than this stay sharp, and are drawn
CREASE = np.cos(np.radians(32))
#: sectors about the axis in which points are numbered; with 48 or 192 most pages are larger
SECTORS = 96


@dataclass(frozen=True, eq=False)
class Mesh:
    """A surface of triangles."""

    points: np.ndarray  #: (n, 3) m; on a sharp edge there is one for either side of it
    triangles: np.ndarray  #: (m, 3) normals point out of the material
    edges: np.ndarray  #: (l, 2) sharp ones
    source: np.ndarray  #: (n,) places of the points in the surface that they were taken from


def mesh_of(surface: Surface) -> Mesh:
    """Return triangles of a drawn surface, welded where two pieces of it meet and split at sharp
    edges.
    """
    triangles = _triangles(surface)
    piece, edges = _creased(surface.points, triangles)
    source = np.empty(piece.max() + 1, int)
    source[piece] = triangles.ravel()  # all corners of a piece are at one point
    order = _along_meridians(surface.points[source])
    number = np.argsort(order)
    rows = number[piece].reshape(-1, 3)
    lowest = np.argmin(rows, axis=1)[:, None]
    rows = np.take_along_axis(rows, (lowest + np.arange(3)) % 3, axis=1)
    return Mesh(surface.points[source[order]], _sorted(rows), _sorted(number[edges]), source[order])


def _triangles(surface: Surface) -> np.ndarray:
    """Return triangles of a surface between points of which none coincide."""
    points = surface.points
    number = np.arange(len(points))
    for first, second in _pairs(points, SAME * np.ptp(points, axis=0).max()):
        np.minimum.at(number, second, first)
    triangles = number[np.concatenate([_halved(points, surface.faces), surface.triangles])]
    corners = np.sort(triangles, axis=1)
    flat = (np.diff(corners, axis=1) == 0).any(axis=1)
    # Where two bodies are welded face to face, neither face is of the surface.
    place = (corners[:, 0] * len(points) + corners[:, 1]) * len(points) + corners[:, 2]
    order = np.argsort(place)
    again = np.flatnonzero(np.diff(place[order]) == 0)
    twin = np.zeros(len(place), bool)
    twin[order[again]] = twin[order[again + 1]] = True
    return triangles[~flat & ~twin]


def _pairs(points: np.ndarray, near: float) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yield the numbers of points no further apart than a distance, the lower ones and the higher
    ones: of all that lie as near along an odd direction, which are few.

    A tree of scipy.spatial takes longer to import than pages take to draw.
    """
    along = points @ ODD
    order = np.argsort(along, kind="stable")
    along = along[order]
    for step in range(1, len(points)):
        candidates = np.flatnonzero(along[step:] - along[:-step] <= near)
        if not len(candidates):
            return
        pairs = np.sort([order[candidates], order[candidates + step]], axis=0)
        apart = np.linalg.norm(points[pairs[0]] - points[pairs[1]], axis=1)
        first, second = pairs[:, apart <= near]
        yield first, second


def _halved(points: np.ndarray, quads: np.ndarray) -> np.ndarray:
    """Return quadrilaterals as two triangles each, along the shorter diagonal."""
    first, second = (
        np.linalg.norm(points[quads[:, i + 2]] - points[quads[:, i]], axis=1) for i in (0, 1)
    )
    rolled = np.where((second < first)[:, None], np.roll(quads, -1, axis=1), quads)
    return np.concatenate([rolled[:, [0, 1, 2]], rolled[:, [0, 2, 3]]])


def _creased(points: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Split points where edges are sharp: new point of every corner, and the sharp edges."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    a, b, c = points[triangles.T]
    normal = np.cross(b - a, c - a)
    normal /= np.maximum(np.linalg.norm(normal, axis=1), np.finfo(float).tiny)[:, None]
    corner = np.arange(triangles.size)
    following = np.roll(corner.reshape(-1, 3), -1, axis=1).ravel()
    start, end = triangles.ravel(), triangles.ravel()[following]
    # An edge runs the other way round in the triangle beyond it.
    forward, backward = start * len(points) + end, end * len(points) + start
    order = np.argsort(forward)
    beyond = order[np.searchsorted(forward, backward, sorter=order).clip(max=len(forward) - 1)]
    cosine = np.einsum("ij,ij->i", normal[corner // 3], normal[beyond // 3])
    sharp = (forward[beyond] != backward) | (cosine < CREASE)
    joins = corner[~sharp], following[beyond[~sharp]]
    graph = coo_matrix((np.ones(len(joins[0])), joins), shape=(len(corner), len(corner)))
    _, piece = connected_components(graph, directed=False)
    edges = sharp & (start < end)
    return piece, np.column_stack([piece[edges], piece[following[edges]]])


def _along_meridians(points: np.ndarray) -> np.ndarray:
    """Order of points sector by sector about the axis, to and fro along it."""
    x, y, z = points.T / np.ptp(points, axis=0).max()
    sector = np.rint(np.arctan2(x, z) * SECTORS / (2 * np.pi)) % SECTORS
    along = np.where(sector % 2, -1, 1) * y
    return np.lexsort((np.hypot(x, z).round(4), along.round(4), sector))


def _sorted(rows: np.ndarray) -> np.ndarray:
    """Return rows by their first number, then by the others."""
    return rows[np.lexsort(rows.T[::-1])]


def packed(values: np.ndarray, step: float = 1) -> str:
    """Pack values as deflated differences of whole steps below 2^30, in base64."""
    steps = np.diff(np.rint(values / step).astype(np.int64), prepend=0)
    counts = (2 * np.abs(steps) - (steps < 0)).astype("<u4")
    # All low bytes first: they differ, and the others seldom do.
    planes = counts.view(np.uint8).reshape(-1, 4).T
    return base64.b64encode(zlib.compress(planes.tobytes())).decode()
