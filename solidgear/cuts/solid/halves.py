"""A part with a mirror plane from one half of it: two blocks that cannot mix.

Motions that are symmetric about the plane keep the nodes on it in the plane; antisymmetric ones move
them at right angles to it. Energies and integrals over seats are twice those of the half.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp

from solidgear.core import Block, Surface
from solidgear.core.body.surface import Volume
from solidgear.core.kernel.attachment import Attached, with_ports
from solidgear.core.models.solid.block import Facets, rigid_motions, seats_of
from solidgear.core.models.solid.drawing import copied
from solidgear.core.models.solid.enriched import enrichment
from solidgear.core.models.solid.matrices import _matrices, rigid_part, weighed
from solidgear.core.models.solid.mesh import SolidMesh

if TYPE_CHECKING:
    from solidgear.core import Scene

#: by the axis at right angles to the plane: name and port components of the symmetric and of the
#: antisymmetric motions
PARTS: dict[int, tuple[tuple[str, tuple[int, ...]], tuple[str, tuple[int, ...]]]] = {
    0: (("plane_z", (1, 2, 3)), ("across_x", (0, 4, 5))),
    2: (("plane_x", (0, 1, 5)), ("across_z", (2, 3, 4))),
}


def half_blocks(
    mesh: SolidMesh, scene: Scene, wanted: Sequence, facets_of: Facets, axis: int
) -> tuple[Block, Block]:
    """Return the symmetric and the antisymmetric block of a whole part from the mesh of its half,
    whose cut faces lie in the plane at right angles to an axis, 0 or 2; refuse a seat without faces
    on the half.
    """
    materials = [segment.material for segment in scene.segments]
    k, m = _matrices(mesh, materials)
    m = m.tocsr()
    n = mesh.nodes.shape[1]
    rigid, y = rigid_motions(mesh.nodes), np.repeat(mesh.nodes[1], 3)
    on_plane = np.abs(mesh.nodes[axis]) < 1e-9 * scene.length
    seats = seats_of(mesh, scene, wanted, facets_of)
    means = [None if s.rigid else weighed(s.pieces(mesh), s.place, n) for s in seats]
    across = np.zeros(3, bool)
    across[axis] = True
    corners = mesh.mesh.p[axis, mesh.mesh.facets]
    plane = np.flatnonzero((np.abs(corners) < 1e-9 * scene.length).all(axis=0))
    blocks = []
    for (name, components), fixed in zip(PARTS[axis], (across, ~across)):
        free = np.flatnonzero(~(on_plane[:, None] & fixed).ravel())
        ports = []
        for seat, mean in zip(seats, means):
            if mean is None:
                mask = np.zeros((n, 3), bool)
                mask[mesh.facet_unknowns(seat.facets)] = True
                ports.append(Attached(seat.place, held=mask.ravel()[free]))
            else:
                ports.append(Attached(seat.place, rigid_part(*mean, components)[:, free]))
        block = Block(
            name,
            components,
            (2 * k[free][:, free]).tocsr(),
            (2 * m[free][:, free]).tocsr(),
            rigid[free][:, list(components)],
            y[free],
            planar=False,
            expand=sp.identity(3 * n, format="csc")[:, free].tocsr(),
            enrich=partial(enrichment, mesh, materials, seats, components, (plane, fixed), 2),
        )
        blocks.append(with_ports(block, ports))
    return blocks[0], blocks[1]


@dataclass(frozen=True, eq=False)
class HalfDrawing:
    """A whole part drawn from the mesh of its half."""

    mesh: SolidMesh
    axis: int  #: at right angles to the mirror plane

    @property
    def solved(self) -> SolidMesh:
        """The mesh among whose cells error bars are shared: that of the half."""
        return self.mesh

    def surface(self, moved: Mapping[str, np.ndarray]) -> Surface:
        """Return both halves, the second as a mirror image of the first."""
        first, second = self._halves(moved)
        surface, image = self.mesh.surface({"full": first}), self.mesh.surface({"full": second})
        mirror = np.diag(self._flip)
        return copied(surface, [(np.eye(3), surface.displacement), (mirror, image.displacement)])

    def _halves(self, moved: Mapping[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """Return the unknowns of the half, and of the other one before it is turned over."""
        kinds = dict(zip((name for name, _ in PARTS[self.axis]), (1.0, -1.0)))
        zero = np.zeros(3 * self.mesh.nodes.shape[1])
        first = sum((vector for name, vector in moved.items() if name in kinds), zero)
        second = sum((kinds[name] * v for name, v in moved.items() if name in kinds), zero)
        return first, second

    @property
    def _flip(self) -> np.ndarray:
        return np.where(np.arange(3) == self.axis, -1.0, 1.0)

    @property
    def nodes(self) -> np.ndarray:
        """Nodes (3, 2 n) of both halves, m; those in the plane are there twice."""
        return np.hstack([self.mesh.nodes, self._flip[:, None] * self.mesh.nodes])

    @property
    def dofs(self) -> np.ndarray:
        """Nodes (nb, 2 ne) of the elements of both halves."""
        return np.hstack([self.mesh.dofs, self.mesh.nodes.shape[1] + self.mesh.dofs])

    def motion(self, moved: Mapping[str, np.ndarray]) -> np.ndarray:
        """Return the displacements (2 n, 3) of the nodes."""
        first, second = (half.reshape(-1, 3) for half in self._halves(moved))
        return np.vstack([first, second * self._flip])

    def volume(self) -> Volume | None:
        """Return None: there is no single mesh of the whole part."""
        return None
