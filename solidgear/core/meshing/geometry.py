"""Geometry of a mesh beside that of the shaft: moments of every segment against the closed form.

No estimate on a mesh sees that it is not the shaft. The energy of a segment whose sections stay plane,
and its kinetic energy as a rigid body, are integrals of squares of linear functions of the place. So
the extremes of the ratio of such integrals, of the mesh over the closed form, say by how much a segment
is at most softer or stiffer, lighter or heavier, than it should be.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING

import numpy as np
from scipy.linalg import eigh
from skfem.quadrature import get_quadrature

from solidgear.core.meshing.quality import MeshError
from solidgear.core.scene.closed_form import parts_of

if TYPE_CHECKING:
    from skfem import Element, Mesh

    from solidgear.core.scene.outline import Outline

#: share of a moment that curved elements may lack or have too much: what arcs leave where there are
#: sixteen around is less
MOST = 1e-4
#: share beyond which a curved mesh stands for another shaft
REFUSED = 1e-2
#: elements looked at at once
BATCH = 4000


def most_misshapen(around: int) -> float:
    """Return the share of a moment that curved elements may be off by, with a number of them around:
    a quarter of what their arcs would lose, were they not moved outwards.
    """
    return max(MOST, (pi / around) ** 4 / 30 / 4)


@dataclass(frozen=True)
class Misshapen:
    """Moments of a part of a mesh beside the closed form, relative, both zero or more."""

    part: int  #: as :func:`~solidgear.core.scene.closed_form.parts_of` counts them
    lost: float  #: that the mesh has too little
    gained: float  #: that it has too much

    @property
    def error(self) -> float:
        """The larger of both."""
        return max(self.lost, self.gained)


def misshapen(moments: np.ndarray, exact: np.ndarray) -> list[Misshapen]:
    """Compare moments (k, 4, 4) of the parts of a mesh with those of the shaft."""
    out = []
    for k, (of_mesh, of_shaft) in enumerate(zip(moments, exact)):
        ratios = eigh(of_mesh - of_shaft, of_shaft, eigvals_only=True)
        out.append(Misshapen(k, max(-float(ratios[0]), 0.0), max(float(ratios[-1]), 0.0)))
    return out


def geometry_error(shapes: Sequence[Misshapen]) -> float:
    """Return by how much energies of a mesh may be off, relative to each other: the most that a part
    has lost, and the most that one has gained.
    """
    lost = max((shape.lost for shape in shapes), default=0.0)
    return lost + max((shape.gained for shape in shapes), default=0.0)


def refuse_misshapen(shapes: Sequence[Misshapen], outline: Outline) -> None:
    """Refuse a curved mesh of another shaft."""
    worst = max(shapes, key=lambda shape: shape.error)
    if worst.error > REFUSED:
        of_segments = parts_of(outline).of_segments
        inside = [s for s, k in zip(outline.segments, of_segments) if k == worst.part]
        raise MeshError(
            f"the mesh from y = {inside[0].y0:g} to {inside[-1].y1:g} m is {100 * worst.error:.2g} % "
            f"off in volume or second moments, more than {REFUSED:.0%}, since edges of elements that "
            "would fold are straight: raise refinement or around, or set a smaller graded_size"
        )


def moments_of(mesh: Mesh, segment: np.ndarray, outline: Outline) -> np.ndarray:
    """Integrate over the parts of a mesh as :func:`moments_of_cells` does; (ne,) segments of the
    elements.
    """
    places = mesh.doflocs[:, mesh.dofs.element_dofs]
    return moments_of_cells(mesh.elem(), places, segment, outline)


def moments_of_cells(
    element: Element, places: np.ndarray, segment: np.ndarray, outline: Outline
) -> np.ndarray:
    """Integrate the products (n, 4, 4) of 1, x, y and z over every part, y from the middle of it, m;
    (3, nb, ne) places of the nodes of elements, and (ne,) segments that they lie in.
    """
    parts = parts_of(outline)
    owner = parts.of_segments[segment]
    return moments_of_groups(element, places, owner, parts.middles)


def moments_of_groups(
    element: Element, places: np.ndarray, owner: np.ndarray, beside: np.ndarray
) -> np.ndarray:
    """Integrate the products (k, 4, 4) of 1, x, y and z over groups of cells, y from a place (k,) of
    each, m; (3, nb, ne) places of the nodes of elements, (ne,) groups that they belong to.
    """
    points, weights = get_quadrature(element.refdom, _degree(element))
    value, slope = _tabulated(element, points)
    out = np.zeros((len(beside), 4, 4))
    for first in range(0, len(owner), BATCH):
        batch = slice(first, first + BATCH)
        nodes = places[:, :, batch]
        det = np.linalg.det(np.einsum("jbe,ibq->eqji", nodes, slope, optimize=True))
        place = np.ones((4, *det.shape))
        place[1:] = np.einsum("jbe,bq->jeq", nodes, value, optimize=True)
        place[2] -= beside[owner[batch]][:, None]
        products = np.einsum("ieq,jeq,eq->eij", place, place, det * weights, optimize=True)
        np.add.at(out, owner[batch], products)
    return out


def whole_moments(moments: np.ndarray, maps: Sequence[np.ndarray]) -> np.ndarray:
    """Return the moments of a body of which a mesh is one part and orthogonal maps (3, 3) make all
    parts.
    """
    copies = np.zeros((len(maps), 4, 4))
    copies[:, 0, 0] = 1.0
    copies[:, 1:, 1:] = maps
    return np.einsum("kij,njl,kml->nim", copies, moments, copies, optimize=True)


def _tabulated(element: Element, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return values (nb, q) and slopes (3, nb, q) of an element."""
    values, slopes = zip(*(element.lbasis(points, i) for i in range(len(element.doflocs))))
    return np.array(values), np.array(
        [[np.broadcast_to(slope[axis], points.shape[1:]) for slope in slopes] for axis in range(3)]
    )


def _degree(element: Element) -> int:
    """Return the degree of the square of a place times det J, of cubes in each coordinate."""
    linear = len(element.doflocs) == element.refdom.nnodes
    if element.refdom.nnodes == 4:
        return 2 if linear else 7
    return 4 if linear else 9
