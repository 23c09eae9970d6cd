"""3D solid of a shaft with features: curved tetrahedra, in two half models where there is a mirror
plane.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from solidgear.body import Block, Body
from solidgear.kernel.room import assemblable
from solidgear.meshing.featured import FeaturedMesh, featured_mesh, submesh
from solidgear.meshing.quality import check_mesh
from solidgear.models.kinds import CYCLIC
from solidgear.models.solid.block import Facets, body_of, free_block, mesh_facts
from solidgear.models.solid.halves import HalfDrawing, half_blocks
from solidgear.models.solid.mesh import SolidMesh, _isoparametric
from solidgear.models.solid.plan import tetrahedra_of
from solidgear.models.solid.seat_faces import Seats
from solidgear.scene.shaft import resolved


def meshed(scene, plan: dict, refinement: float, half: bool, edges: bool = False) -> FeaturedMesh:
    """The mesh of a scene with features; ``plan`` holds planes, circles and sizes, and ``edges``
    asks for smaller elements at the re-entrant edges of features.
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


def featured_body(
    scene: Any, wanted: Sequence, made: FeaturedMesh, refinement: float, *, plain: bool = False
) -> Body:
    """Free body of a meshed scene with its features cut out or, `plain`, left in: two blocks where
    there is a mirror plane, one where there is none. SolidgearError if no face is left of a seat,
    MeshError for inverted elements.
    """
    keep = np.ones(len(made.cut), bool) if plain else ~made.cut
    mesh = made.mesh if plain else submesh(made.mesh, keep)
    quality = replace(check_mesh(mesh), straightened=made.quality.straightened)
    solid = _isoparametric(mesh, "tet10", made.segment[keep])
    facets = _facets(solid, scene)
    if made.plane is None:
        blocks: tuple[Block, ...] = (free_block(solid, scene, wanted, facets),)
        drawing: SolidMesh | HalfDrawing = solid
    else:
        blocks = half_blocks(solid, scene, wanted, facets, made.plane)
        drawing = HalfDrawing(solid, made.plane)
    facts = {
        **mesh_facts(solid, quality, copies=1 if made.plane is None else 2),
        "refinement": refinement,
        "features": [f.name for f in resolved(scene)],
        "mirror_plane": "none" if made.plane is None else f"{'xyz'[made.plane]} = 0",
        # nothing promises twins: what is split is split
        "round": False,
        "pair_tolerance": 0.0,
    }
    return body_of(scene, wanted, blocks, facts, drawing)


def _facets(solid: SolidMesh, scene: Any) -> Facets:
    """Facets of seats on what is left of surfaces of revolution, and on teeth."""
    around = [f for f in resolved(scene) if f.sort == CYCLIC]
    if not around:
        return Seats(solid, scene.segments, clipped=False)
    from solidgear.models.sector.mesh import seats  # slow to import, and seldom needed

    return seats(solid, solid.mesh.p, scene, around)
