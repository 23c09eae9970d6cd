"""Drawing of a beam: the profile as a body of revolution.

A section of a beam is a rigid disc: the case U = V, W linear in r of
:mod:`solidgear.core.body.revolution`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.body.revolution import Rings, Wave, revolve, wave
from solidgear.core.body.surface import Surface
from solidgear.core.scene.corner import SURFACES
from solidgear.core.scene.outline import Outline

if TYPE_CHECKING:
    from solidgear.core.scene.shaft import Shaft


@dataclass(frozen=True, eq=False)
class BeamLine:
    """Nodes of a beam along the profile of the shaft."""

    shaft: Shaft
    nodes: np.ndarray  #: (n,) axial positions, m

    def surface(self, moved: Mapping[str, np.ndarray]) -> Surface:
        """Return the profile of the shaft, each section of it a rigid disc."""
        rings = _profile(self.shaft, self.nodes)
        return revolve(rings, _waves(rings, self.nodes, moved))

    def volume(self) -> None:
        """Return None: a beam has no mesh of the volume."""
        return None


def _waves(rings: Rings, nodes: np.ndarray, moved: Mapping[str, np.ndarray]) -> list[Wave]:
    waves = []
    for name, start in (("bending_z", 0.0), ("bending_x", np.pi / 2)):
        if name in moved:
            # In the x plane the second unknown is -thz, which turns z into x as thx turns y into z.
            lift, tilt = (
                np.interp(rings.y, nodes, moved[name][k : 2 * len(nodes) : 2]) for k in (0, 1)
            )
            waves.append(wave(1, start, lift, lift, -rings.r * tilt))
    if "axial" in moved:
        waves.append(wave(0, 0.0, 0.0, 0.0, np.interp(rings.y, nodes, moved["axial"])))
    if "torsion" in moved:
        turn = np.interp(rings.y, nodes, moved["torsion"])
        waves.append(wave(0, 0.0, 0.0, 0.0, 0.0 * rings.r, rings.r * turn))
    return waves


def _profile(scene: Shaft, nodes: np.ndarray) -> Rings:
    """Return the closed outline of the meridian: up the outer surface, down the bore,
    counter-clockwise in (r, y).
    """
    tol = 1e-9 * scene.length
    along: dict[str, list[tuple[float, float]]] = {surface: [] for surface in SURFACES}
    for piece in Outline(scene.segments).pieces:  # sharp: a beam knows no fillets
        inside = nodes[(nodes > piece.y0 + tol) & (nodes < piece.y1 - tol)]
        y = np.concatenate([[piece.y0], inside, [piece.y1]])
        share = (y - piece.y0) / (piece.y1 - piece.y0)
        along[piece.surface] += zip(piece.r0 + share * (piece.r1 - piece.r0), y)
    loop = np.array(along["outer"] + along["bore"][::-1])
    loop = loop[np.linalg.norm(loop - np.roll(loop, 1, axis=0), axis=1) > tol]
    # Faces across the axis are divided, so that their colours follow the displacement.
    parts, drawn, size = [], [], 0
    for p, q in zip(loop, np.roll(loop, -1, axis=0)):
        n = 1
        if abs(q[1] - p[1]) < tol:
            n = max(1, int(np.ceil(abs(q[0] - p[0]) / (0.03 * scene.length))))
        parts.append(p + np.arange(n)[:, None] / n * (q - p))
        drawn.append(size)
        size += n
    r, y = np.concatenate(parts).T
    ring = np.arange(size)
    return Rings(r, y, np.column_stack([ring, (ring + 1) % size]), np.array(drawn))
