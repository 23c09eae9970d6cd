"""Corners of a meridian at which stress is singular, or a load jumps."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.body import Port
from solidgear.core.meshing.meridian import Meridian

if TYPE_CHECKING:
    from solidgear.core.scene import Scene

#: rad beyond a straight angle from which on a corner is re-entrant
BENT = 0.02


def singular_vertices(
    scene: Scene, ports: Sequence[Port], flat: Meridian, tangents: np.ndarray
) -> dict[int, tuple[str, float]]:
    """Return the vertices of a mesh at which displacements are not smooth: kind, and angle of the
    material there, rad.

    Kinds are ``re-entrant``, ``rigid`` (end of a seat that cannot deform), ``section`` (a plane
    that carries a load), ``material`` or ``load`` (end of another seat). `tangents` (ne, 4, 2, 2)
    are the derivatives of position (last) along both coordinates at the corners of every cell.
    """
    points, tol = flat.points, 1e-9 * scene.length
    outside = _outside(flat)
    angle = np.zeros(points.shape[1])
    # towards the next and the previous corner, in the sense of the walk
    for corner, (first, second, turn) in enumerate(
        ((0, 1, (1, 1)), (1, 0, (1, -1)), (0, 1, (-1, -1)), (1, 0, (-1, 1)))
    ):
        u = tangents[:, corner, first] * turn[0]
        v = tangents[:, corner, second] * turn[1]
        cross = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
        np.add.at(angle, flat.cells[corner], np.arctan2(cross, np.einsum("ix,ix->i", u, v)))
    out = {int(v): "re-entrant" for v in np.flatnonzero(outside & (angle > np.pi + BENT))}
    stations = {s.name: s for s in scene.stations}
    surface = np.zeros(points.shape[1], bool)
    surface[flat.cells[1:3, flat.outer]] = True
    for port in ports:
        station = stations[port.name]
        section = port.attachment == "section"
        kind = "load" if port.attachment == "average" else port.attachment
        candidates = outside if section else surface
        for y in [station.y] if section else [station.lo, station.hi]:
            for number in np.flatnonzero(candidates & (np.abs(points[1] - y) < tol)):
                vertex = int(number)
                # a rigid seat that ends in a corner is the sharpest of all
                if kind == "rigid" or out.get(vertex, "load") == "load":
                    out[vertex] = kind
    for vertex in _joined(scene, flat):
        if outside[vertex]:
            out.setdefault(vertex, "material")
    return {vertex: (kind, float(angle[vertex])) for vertex, kind in out.items()}


def _outside(flat: Meridian) -> np.ndarray:
    """Return a mask of the vertices on the surface, the ends of the axis included where faces meet
    it.
    """
    sides = np.sort(
        np.concatenate([flat.cells[[a, b]] for a, b in ((0, 1), (1, 2), (2, 3), (3, 0))], axis=1),
        axis=0,
    )
    edges, times = np.unique(sides, axis=1, return_counts=True)
    tol = 1e-9 * flat.points[0].max()
    on_axis = (np.abs(flat.points[0][edges]) < tol).all(axis=0)
    out = np.zeros(flat.points.shape[1], bool)
    out[edges[:, (times == 1) & ~on_axis]] = True
    return out


def _joined(scene: Scene, flat: Meridian) -> list[int]:
    """Return the vertices at which materials of different stiffness meet."""
    laws = [(s.material.shear_modulus, s.material.nu) for s in scene.segments]
    number = {law: k for k, law in enumerate(dict.fromkeys(laws))}
    if len(number) == 1:
        return []
    law_of_cell = np.array([number[laws[s]] for s in flat.segment])
    least = np.full(flat.points.shape[1], len(laws))
    most = np.full(flat.points.shape[1], -1)
    for corner in range(4):
        np.minimum.at(least, flat.cells[corner], law_of_cell)
        np.maximum.at(most, flat.cells[corner], law_of_cell)
    return [int(v) for v in np.flatnonzero(least < most)]
