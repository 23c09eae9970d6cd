"""Lines of a mesh of tetrahedra along which stress is singular, and layers towards them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.meshing.corners import SLOW
from solidgear.core.meshing.edge_layers import Layered, layered
from solidgear.core.meshing.quality import check_mesh
from solidgear.core.models.solid.edges import sharp_edges
from solidgear.core.models.solid.mesh import SolidMesh, _isoparametric

if TYPE_CHECKING:
    from solidgear.core.meshing.quality import MeshQuality
    from solidgear.core.models.solid.block import Facets
    from solidgear.core.scene.parts import Material
    from solidgear.core.scene.shaft import Station


@dataclass(frozen=True)
class LayeredMesh:
    """A mesh with layers towards its singular lines."""

    mesh: SolidMesh
    quality: MeshQuality
    split: Layered
    facets_before: Facets  #: those of the mesh without layers

    def facets(self, station: Station, attachment: str) -> np.ndarray:
        """Return the facets that carry a station."""
        return self.split.facets_in(self.facets_before(station, attachment))


def with_layers(
    m: SolidMesh,
    quality: MeshQuality,
    facets: Facets,
    wanted: Sequence[tuple[Station, str]],
    materials: Sequence[Material],
    *,
    layers: int,
    ratio: float,
    plane: int | None = None,
) -> LayeredMesh:
    """Split ten-node tetrahedra towards the lines along which stress is singular; `materials` are those
    that the elements name, and `plane` is the axis at right angles to the plane of a half.
    """
    rigid = [facets(station, attachment) for station, attachment in wanted if attachment == "rigid"]
    split = layered(m.mesh, singular_lines(m, materials, rigid, plane), layers, ratio)
    if split.mesh is m.mesh:
        return LayeredMesh(m, quality, split, facets)
    return LayeredMesh(
        _isoparametric(split.mesh, m.name, m.segment[split.parents]),
        replace(check_mesh(split.mesh), geometry=quality.geometry),
        split,
        facets,
    )


def singular_lines(
    m: SolidMesh,
    materials: Sequence[Material],
    rigid: Sequence[np.ndarray],
    plane: int | None = None,
) -> np.ndarray:
    """Return the edges of ten-node tetrahedra that have layers: concave ones, ends of rigid seats, given
    as facets, and joints of materials, where stress is so singular that its error shrinks slowly.
    """
    surface = m.boundary
    if plane is not None:
        height = np.abs(m.mesh.p[plane, m.mesh.facets[:, surface]])
        surface = surface[(height > 1e-9 * np.ptp(m.mesh.p)).any(axis=0)]
    sharp = sharp_edges(m, materials, np.concatenate([*rigid, []]).astype(int), surface)
    return np.sort(sharp.numbers[sharp.exponents < SLOW])
