r"""Port of a toothed wheel: a cylinder in its rim, and the mean motion of it as a rigid body.

The mean motion of the whole cylinder is ``G^-1 sum_j R_j b' u_j``: b are the loads of rigid motions on
the part in one pitch, R_j turns pitch 0 to pitch j, G is the Gram matrix of rigid motions on the whole.
Loads on the port act as the transpose.  Both are waves 0 and 1 and no other, so that with the
responses P_n of the loads b and ``A_n = sum_j R_j exp(2 pi i n j / z)``

    C_port = G^-1 (A_0 P_0 A_0^H + 2 Re A_1 P_1 A_1^H) G^-1 / z.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from solidgear.core.frames import rotation
from solidgear.core.meshing.lobatto import gauss
from solidgear.core.models.solid.block import rigid_motions
from solidgear.teeth.compliance.solid_mesh import SweptPitch, directions

#: points of quadrature around a pitch and along a layer
AROUND, ALONG = 12, 2


@dataclass(frozen=True, eq=False)
class Port:
    """Part of a port that lies in one pitch."""

    loads: sp.csr_matrix  #: (3 n, 6) nodal loads of the rigid motions, times area
    gram: np.ndarray  #: (6, 6) products of the rigid motions, times area

    def compliance(self, responses: np.ndarray, count: int) -> np.ndarray:
        """Return the (6, 6) mean motion of the whole port by loads spread over it, about the origin,
        from the (2, 6, 6) responses of the loads to waves 0 and 1.
        """
        pitches = np.arange(count)
        turns = np.array([rotation(2, -2 * np.pi * j / count) for j in pitches])
        total = np.linalg.inv((turns @ self.gram @ turns.transpose(0, 2, 1)).sum(axis=0))
        motion = np.zeros((6, 6))
        for wave, times in ((0, 1), (1, 2)):
            sums = np.tensordot(np.exp(2j * np.pi * wave * pitches / count), turns, 1)
            motion += times * (sums @ responses[wave] @ sums.conj().T).real
        return total @ motion @ total / count


def port_of(mesh: SweptPitch, radius: float, pitch: float) -> Port:
    """Return the port on a cylinder, by the pitch angle."""
    around, weights = gauss(AROUND)
    points = radius * directions((around - 0.5) * pitch)
    cells, local = mesh.inside(points)
    n = mesh.solid.nodes.shape[1]
    loads = np.zeros((n, 3, 6))
    share, part = gauss(ALONG)
    steps = np.diff(mesh.ends)[:, None]
    z, along = (mesh.ends[:-1, None] + steps * share).ravel(), (steps * part).ravel()
    shape, nodes = mesh.shapes(
        np.repeat(cells, len(z)), np.repeat(local, len(z), axis=0), np.tile(z, AROUND)
    )
    places = mesh.places(points[:, None], z)
    motion = rigid_motions(places.reshape(-1, 3).T).reshape(-1, 3, 6)
    area = np.outer(weights * radius * pitch, along).ravel()
    gram = np.einsum("k,kia,kib->ab", area, motion, motion)
    np.add.at(loads, nodes, np.einsum("bk,k,kia->bkia", shape, area, motion))
    return Port(sp.csr_matrix(loads.reshape(3 * n, 6)), gram)
