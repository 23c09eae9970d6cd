"""Port of a toothed wheel: a cylinder in its rim, and the mean motion of it as a rigid body."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from solidgear.core.models.solid.block import rigid_motions
from solidgear.core.frames import rotation
from solidgear.core.kernel.lobatto import gauss
from solidgear.teeth.compliance.ring import Ring
from solidgear.teeth.compliance.solid_mesh import SweptPitch, directions

#: points around a pitch and along a layer that a mean is taken from
AROUND, ALONG = 12, 2


@dataclass(frozen=True, eq=False)
class Port:
    """Part of a port that lies in one pitch."""

    loads: sp.csr_matrix  #: (3 n, 6) nodal loads whose work is that of a rigid motion's, times area
    gram: np.ndarray  #: (6, 6) the same between rigid motions

    @classmethod
    def on(cls, mesh: SweptPitch, radius: float, pitch: float) -> Port:
        """Return the port on a cylinder."""
        x, w = gauss(AROUND)
        points = radius * directions((x - 0.5) * pitch)
        cells, at = mesh.inside(points)
        n = mesh.solid.nodes.shape[1]
        loads, gram = np.zeros((n, 3, 6)), np.zeros((6, 6))
        steps, weights = gauss(ALONG)
        for low, high in zip(mesh.ends, mesh.ends[1:]):
            for step, weight in zip(steps, weights):
                z = low + (high - low) * step
                shape, nodes = mesh.shapes(cells, at, z)
                place = mesh.places(points, np.asarray(z))
                area = w * weight * (high - low)
                motion = rigid_motions(place.T).reshape(-1, 3, 6)
                gram += np.einsum("k,kia,kib->ab", area, motion, motion)
                np.add.at(loads, nodes, np.einsum("bk,k,kia->bkia", shape, area, motion))
        return cls(sp.csr_matrix(loads.reshape(3 * n, 6)), gram)

    def compliance(self, ring: Ring, columns: slice) -> np.ndarray:
        """Return the (6, 6) mean motion of the whole port by loads spread over it, about the origin;
        in the condensed pitch the loads have these columns, and their work these rows.
        """
        pitch, count = ring.pitch, ring.count
        turns = [rotation(2, -2 * np.pi * j / count) for j in range(count)]
        inverse = np.linalg.inv(sum(turn @ self.gram @ turn.T for turn in turns))
        local = [turn.T @ inverse for turn in turns]
        amplitudes = [
            sum(np.conj(ring.phase(wave * j)) * part for j, part in enumerate(local))
            for wave in range(count // 2 + 1)
        ]
        waves = ring.waves(pitch.loads[:, columns], amplitudes)
        return sum(
            part.T @ (pitch.readings[columns] @ ring.sides(waves, j) + pitch.direct[columns, columns] @ part)
            for j, part in enumerate(local)
        )
