"""Whole bodies as dense matrices, and what is read off a solution to be compared with theirs."""

import numpy as np

from solidgear.core.scene.closed_form import mass_properties
from validation.side_by_side import side_by_side


def whole(body, without=()):
    """K and M of the blocks of a body side by side, and six rows a port that give its motion."""
    blocks = [b for b in body.blocks if b.name not in without]
    return tuple(matrix.toarray() for matrix in side_by_side(blocks, len(body.ports)))


def bearing_by_hand(bearing):
    """Bearing matrix with the springs in series with its axial stiffness, the ring between them
    eliminated.
    """
    k = np.array(bearing.matrix)
    if bearing.axial_series:
        spring = 1 / sum(1 / s for s in bearing.axial_series)
        k = k - np.outer(k[:, 1], k[1]) / (k[1, 1] + spring)
    return k


def rigid_at(y):
    """(6, 6) motion at y on the axis for unit rigid motions about the origin: translation, th x r."""
    out = np.eye(6)
    for k in range(3):
        out[:3, 3 + k] = np.cross(np.eye(3)[k], [0.0, y, 0.0])
    return out


def every(found):
    """Frequencies of modes, twins twice."""
    return np.array([m.frequency_hz for m in found.modes for _ in range(m.multiplicity)])


def relative(a, b):
    """Largest difference of two 6x6, forces and moments made comparable by the diagonal of the second."""
    d = np.sqrt(np.abs(np.diag(b)))
    d[~(d > 0)] = 1.0 if not (d > 0).any() else np.nanmin(d[d > 0])
    return np.nanmax(np.abs(a - b) / np.outer(d, d))


def mass_matrix(scene):
    """(6, 6) about the origin, by the closed form that tests/test_mesh_quality.py holds to quadrature."""
    p = mass_properties(scene.outline)
    tilt, first = p.ixx + p.mass * p.centre**2, p.mass * p.centre
    out = np.diag([p.mass, p.mass, p.mass, tilt, p.iyy, tilt])
    out[2, 3] = out[3, 2] = first
    out[0, 5] = out[5, 0] = -first
    return out
