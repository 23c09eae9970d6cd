"""Mesh of a meridian with the unknowns of a harmonic solid on it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from skfem import Element, ElementQuad1, ElementQuad2, MeshQuad1
from skfem.element import ElementQuadP

from solidgear.core.body.surface import Surface
from solidgear.core.errors import SolidgearError
from solidgear.core.kernel.assembly import reference, unknowns
from solidgear.core.meshing.meridian import Meridian
from solidgear.core.models.harmonic.drawing import surface
from solidgear.core.models.harmonic.families import Family


@dataclass(frozen=True)
class HarmonicMesh:
    """Mesh of a meridian with the unknowns of one component of the displacement."""

    mesh: MeshQuad1
    element: Element
    dofs: np.ndarray  #: (nb, ne)
    meridian: Meridian
    order: int
    uncut: Meridian  #: before cells were cut towards corners
    parent: np.ndarray  #: (ne,) cell of ``uncut`` of every cell

    @property
    def size(self) -> int:
        """Number of unknowns of one component."""
        return int(self.dofs.max()) + 1

    def edge_unknowns(self, cells: np.ndarray, direction: int, value: float) -> np.ndarray:
        """Return the unknowns of cells that do not vanish on a local edge, where a coordinate has a
        value.
        """
        # more points than the highest function has zeros on an edge
        along = np.linspace(0.0, 1.0, self.order + 4)[1:-1]
        points = np.empty((2, len(along)))
        points[direction], points[1 - direction] = value, along
        alive = np.abs(reference(self.element, points)[0]).max(axis=1) > 1e-12
        return np.unique(self.dofs[alive][:, cells])

    @cached_property
    def on_axis(self) -> np.ndarray:
        """Mask of the unknowns with a share on the axis."""
        flat = self.meridian
        radius = np.abs(flat.points[0][flat.cells[[0, 3]][:, flat.inner]])
        cells = flat.inner[(radius < 1e-9 * flat.points[0].max()).all(axis=0)]
        out = np.zeros(self.size, bool)
        out[self.edge_unknowns(cells, 0, 0.0)] = True
        return out

    def whole(self, family: Family, u: np.ndarray) -> np.ndarray:
        """Return the unknowns (n, c, ...) of a family from those that the axis leaves free."""
        keep = family.free(self.on_axis)
        if keep.sum() != len(u):
            raise SolidgearError(
                f"a shape of harmonic n = {max(family.waves, 0)} has {len(u)} values where its mesh "
                f"has {int(keep.sum())} unknowns"
            )
        out = np.zeros((*keep.shape, *u.shape[1:]))
        out[keep] = u
        return out

    def surface(self, moved: Mapping[str, np.ndarray]) -> Surface:
        """Return the outline of the meridian turned around the axis."""
        return surface(self, moved)

    def rows(self, name: str, chosen: np.ndarray) -> np.ndarray:
        """Return the displacements (3 k, n) of points of the surface by the unknowns of a block."""
        from solidgear.core.models.harmonic.drawing import rows  # start-up: of responses alone

        return rows(self, name, chosen)

    def volume(self) -> None:
        """Return None: the mesh is that of a meridian."""
        return None


def harmonic_mesh(
    flat: Meridian,
    order: int,
    uncut: Meridian | None = None,
    parent: np.ndarray | None = None,
) -> HarmonicMesh:
    """Number the unknowns of quadrilaterals of some order on a meridian."""
    mesh = MeshQuad1(flat.points, flat.cells, sort_t=False)
    element = {1: ElementQuad1, 2: ElementQuad2}.get(order, lambda: ElementQuadP(order))()
    if parent is None:
        parent = np.arange(flat.cells.shape[1])
    return HarmonicMesh(mesh, element, unknowns(mesh, element), flat, order, uncut or flat, parent)
