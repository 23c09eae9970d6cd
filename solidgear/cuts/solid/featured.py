"""3D solid of a shaft with features: curved tetrahedra, in two half models where there is a mirror
plane.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core import Block, Body
from solidgear.core.kernel.room import assemblable
from solidgear.core.meshing.quality import check_mesh
from solidgear.core.models.kinds import CYCLIC
from solidgear.core.models.size import Size, size_of_mesh
from solidgear.core.models.solid.block import Facets, body_of, free_block, mesh_facts
from solidgear.core.models.solid.mesh import SolidMesh, _isoparametric, basis_of
from solidgear.core.models.solid.plan import tetrahedra_of
from solidgear.core.models.solid.seat_faces import Seats
from solidgear.core.scene.shaft import resolved
from solidgear.cuts.solid.halves import HalfDrawing, half_blocks
from solidgear.cuts.solid.meshing import FeaturedMesh, featured_mesh, submesh

if TYPE_CHECKING:
    from solidgear.core import Scene


def meshed(scene, plan: dict, refinement: float, half: bool, edges: bool = False) -> FeaturedMesh:
    """Mesh a scene with features; ``plan`` holds planes, circles and sizes, and ``edges`` asks for
    smaller elements at the re-entrant edges of features.
    """
    assemblable(tetrahedra_of(scene, plan, refinement, edges=edges), 10)
    return featured_mesh(
        scene.outline,
        resolved(scene),
        **plan,
        refinement=refinement,
        half=half,
        edges=edges,
    )


def cut_body(scene: Scene, wanted: Sequence, plan: dict, refinement: float, half: bool) -> Body:
    """Build the free body of a scene with cuts; parameters as for :func:`meshed`."""
    return featured_body(scene, wanted, meshed(scene, plan, refinement, half), refinement)


def featured_body(
    scene: Scene,
    wanted: Sequence,
    cut_mesh: FeaturedMesh,
    refinement: float,
    *,
    plain: bool = False,
) -> Body:
    """Build the free body of a meshed scene with its features cut out or, `plain`, left in: two
    blocks where there is a mirror plane, one where there is none; refuse a seat without faces and
    inverted elements.
    """
    keep = np.ones(len(cut_mesh.cut), bool) if plain else ~cut_mesh.cut
    mesh = cut_mesh.mesh if plain else submesh(cut_mesh.mesh, keep)
    quality = replace(check_mesh(mesh), geometry=cut_mesh.quality.geometry)
    solid = _isoparametric(mesh, "tet10", cut_mesh.segment[keep])
    facets = _facets(solid, scene)
    if cut_mesh.plane is None:
        blocks: tuple[Block, ...] = (free_block(solid, scene, wanted, facets),)
        drawing: SolidMesh | HalfDrawing = solid
    else:
        blocks = half_blocks(solid, scene, wanted, facets, cut_mesh.plane)
        drawing = HalfDrawing(solid, cut_mesh.plane)
    facts = {
        **mesh_facts(solid, quality, copies=1 if cut_mesh.plane is None else 2),
        "refinement": refinement,
        "features": [f.name for f in resolved(scene)],
        "mirror_plane": "none" if cut_mesh.plane is None else f"{'xyz'[cut_mesh.plane]} = 0",
        # no symmetry promises twins
        "round": False,
        "pair_tolerance": 0.0,
    }
    return body_of(scene, wanted, blocks, facts, drawing)


def cut_size_of(scene: Scene, plan: dict, refinement: float, half: bool) -> Size:
    """Mesh a scene with cuts and count; parameters as for :func:`meshed`."""
    return cut_size(meshed(scene, plan, refinement, half))


def cut_size(cut_mesh: FeaturedMesh) -> Size:
    """Count a mesh without its cuts."""
    mesh = submesh(cut_mesh.mesh, ~cut_mesh.cut)
    if cut_mesh.plane is None:
        return size_of_mesh(mesh, basis_of("tet10"))
    halves = size_of_mesh(mesh, basis_of("tet10"), parts=2)
    # of a node on the mirror plane one half has one component and the other two
    on_plane = int((np.abs(mesh.doflocs[cut_mesh.plane]) < 1e-9).sum())
    return replace(halves, unknowns=halves.unknowns - 3 * on_plane)


def _facets(solid: SolidMesh, scene: Scene) -> Facets:
    """Return the facets of seats on the rest of surfaces of revolution, and on teeth."""
    cyclic = [f for f in resolved(scene) if f.sort == CYCLIC]
    if not cyclic:
        return Seats(solid, scene.segments, clipped=False)
    from solidgear.cuts.sector.mesh import seats  # slow to import, and seldom needed

    return seats(solid, solid.mesh.p, scene, cyclic)
