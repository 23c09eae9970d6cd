"""Measured shapes as points to be turned, beside the shapes of the modes that they are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.sparse.csgraph import minimum_spanning_tree
from scipy.spatial import distance_matrix

from solidgear.measured.correlate import Correlation
from solidgear.measured.shapes import SurfacePoints
from solidgear.show.packing import Mesh
from solidgear.show.turning import Member, Turned, together

#: modes that a page has room for
MOST = 16
#: size of a point, as a share of the longest side of all
SIZE = 0.015
#: corners of an octahedron and its middle, and its faces
CORNERS = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1], [0, 0, 0]])
FACES = np.array(
    [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
)


#: thickness of a rod over that of a point; places around it, and its sides
ROD, RING = 0.45, np.exp(2j * np.pi * np.arange(3) / 3)
SIDES = np.array([[0, 1, 3], [1, 4, 3], [1, 2, 4], [2, 5, 4], [2, 0, 5], [0, 3, 5]])


def turned_beside(correlation: Correlation) -> tuple[Turned, ...]:
    """Return measured points and the computed surface in all modes that have a partner, in one
    scale and of one sign; of a pair of shapes the combination that was measured. Empty without
    measured shapes.
    """
    measured, computed = correlation.measured.on_points, correlation.computed
    if measured is None:
        return ()
    # of two resonances that are one mode the first; not every resonance has a shape
    numbers = {
        pair.computed.name: pair.number - 1
        for pair in correlation.pairs[::-1]
        if pair.computed is not None and measured.values[pair.number - 1].any()
    }
    modes = [mode for mode in computed.modes if str(mode.name) in numbers][:MOST]
    if not modes:
        return ()
    places = SurfacePoints(computed.body, measured.numbers.tolist(), measured.points)
    measured_points = np.any(measured.values != 0, axis=0)
    moved = [_real(measured.values[numbers[str(mode.name)]]) for mode in modes]
    vectors = []
    for mode, shape in zip(modes, moved):
        span = np.column_stack([places.motion(vector)[measured_points] for vector in mode.vectors])
        parts = np.linalg.lstsq(span, shape[measured_points], rcond=1e-6)[0]
        blocks = mode.vectors[0].keys() | mode.vectors[-1].keys()
        vectors.append(
            {k: sum(c * v[k] for c, v in zip(parts, mode.vectors) if k in v) for k in blocks}
        )
    names = [(str(mode.name), mode.frequency_hz) for mode in modes]
    member = Member(computed.body, np.eye(3), np.zeros(3), [[v] for v in vectors])
    turned = together(computed.mesh, names, [member])
    mesh, shapes = _mesh(measured.points), []
    for turned_shape, vector, shape in zip(turned.shapes, vectors, moved):
        raw = computed.body.surface(vector).displacement[turned.mesh.source]
        factor = np.vdot(raw, turned_shape.displacement) / np.vdot(raw, raw)
        displacement = factor * shape[mesh.source]
        hertz = correlation.measured.modes[numbers[turned_shape.name]].frequency
        shapes.append(replace(turned_shape, frequency_hz=hertz, displacement=displacement))
    return Turned("measured", mesh, tuple(shapes)), turned


def _real(shape: np.ndarray) -> np.ndarray:
    """Return a complex shape in the phase in which it is largest."""
    return np.real(shape * np.exp(-0.5j * np.angle(np.sum(shape**2))))


def _mesh(points: np.ndarray) -> Mesh:
    """Return points as octahedra, joined by rods along the shortest tree."""
    size = SIZE * float(np.ptp(points, axis=0).max())
    tree = minimum_spanning_tree(distance_matrix(points, points)).tocoo()
    first = len(CORNERS) * np.arange(len(points))
    corners, faces = [points[:, None] + size * CORNERS], [first[:, None, None] + FACES]
    source = [np.repeat(np.arange(len(points)), len(CORNERS))]
    for k, (a, b) in enumerate(zip(tree.row, tree.col)):
        along = points[b] - points[a]
        across = np.cross(along, np.eye(3)[np.abs(along).argmin()])
        sides = np.array([across, np.cross(along, across) / np.linalg.norm(along)])
        ring = ROD * size / np.linalg.norm(across) * np.column_stack([RING.real, RING.imag]) @ sides
        corners.append(np.array([points[a] + ring, points[b] + ring]))
        faces.append(len(CORNERS) * len(points) + 2 * len(RING) * k + SIDES)
        source.append(np.repeat([a, b], len(RING)))
    lines = np.column_stack([first[tree.row], first[tree.col]]) + len(CORNERS) - 1
    return Mesh(
        np.concatenate([part.reshape(-1, 3) for part in corners]),
        np.concatenate([part.reshape(-1, 3) for part in faces]),
        lines,
        np.concatenate(source),
    )
