"""Measured shapes as points to be turned, beside the shapes of the modes that they are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.sparse.csgraph import minimum_spanning_tree
from scipy.spatial import distance_matrix

from solidgear.report.packing import Mesh
from solidgear.report.turning import Member, Turned, together
from solidgear.studies.measured.correlate import Correlation
from solidgear.studies.measured.shapes import OnPoints

#: modes that a page has room for
MOST = 16
#: size of a point, as a share of the longest side of all
SIZE = 0.012
#: corners of an octahedron and its middle, and its faces
CORNERS = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1], [0, 0, 0]])
FACES = np.array(
    [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
)


def turned_beside(found: Correlation) -> tuple[Turned, ...]:
    """Measured points and the computed surface in all modes that have a partner, in one scale and of
    one sign; of a pair of shapes the combination that was measured. Empty without measured shapes.
    """
    measured, computed = found.measured.shapes, found.computed
    # of two resonances that are one mode the first
    numbers = {p.computed.name: p.number - 1 for p in found.pairs[::-1] if p.computed is not None}
    modes = [mode for mode in computed.modes if str(mode.name) in numbers][:MOST]
    if measured is None or not modes:
        return ()
    places = OnPoints(computed.body, measured.numbers.tolist(), measured.points)
    seen = np.any(measured.values != 0, axis=0)
    moved = [_real(measured.values[numbers[str(mode.name)]]) for mode in modes]
    vectors = []
    for mode, shape in zip(modes, moved):
        span = np.column_stack([places.of(vector)[seen] for vector in mode.vectors])
        parts = np.linalg.lstsq(span, shape[seen], rcond=1e-6)[0]
        blocks = mode.vectors[0].keys() | mode.vectors[-1].keys()
        vectors.append(
            {k: sum(c * v[k] for c, v in zip(parts, mode.vectors) if k in v) for k in blocks}
        )
    named = [(str(mode.name), mode.frequency_hz) for mode in modes]
    member = Member(computed.body, np.eye(3), np.zeros(3), [[one] for one in vectors])
    own = together(computed.mesh, named, [member])
    shapes = []
    for one, vector, shape in zip(own.shapes, vectors, moved):
        raw = computed.body.surface(vector).displacement[own.mesh.source]
        factor = np.vdot(raw, one.displacement) / np.vdot(raw, raw)
        each = np.repeat(factor * shape, len(CORNERS), axis=0)
        hertz = found.measured.modes[numbers[one.name]].frequency
        shapes.append(replace(one, frequency_hz=hertz, displacement=each))
    return Turned("measured", _mesh(measured.points), tuple(shapes)), own


def _real(shape: np.ndarray) -> np.ndarray:
    """A complex shape in the phase in which it is largest."""
    return np.real(shape * np.exp(-0.5j * np.angle(np.sum(shape**2))))


def _mesh(points: np.ndarray) -> Mesh:
    """Points as octahedra, joined by the shortest tree of lines."""
    size = SIZE * float(np.ptp(points, axis=0).max())
    corners = (points[:, None] + size * CORNERS).reshape(-1, 3)
    first = len(CORNERS) * np.arange(len(points))
    tree = minimum_spanning_tree(distance_matrix(points, points)).tocoo()
    middle = len(CORNERS) - 1
    lines = np.column_stack([first[tree.row], first[tree.col]]) + middle
    faces = (first[:, None, None] + FACES).reshape(-1, 3)
    return Mesh(corners, faces, lines, np.repeat(np.arange(len(points)), len(CORNERS)))
