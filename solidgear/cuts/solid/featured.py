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
from solidgear.core.models.solid.lines import LayeredMesh, with_layers
from solidgear.core.models.solid.mesh import SolidMesh, _isoparametric, basis_of
from solidgear.core.models.solid.plan import tetrahedra_of
from solidgear.core.models.solid.seat_faces import Seats
from solidgear.core.scene.shaft import resolved
from solidgear.cuts.solid.halves import HalfDrawing, half_blocks
from solidgear.cuts.solid.meshing import FeaturedMesh, featured_mesh, submesh

if TYPE_CHECKING:
    from skfem import MeshTet2

    from solidgear.core import Scene


def meshed(
    scene, plan: dict, refinement: float, half: bool, edges: bool = False, layers: int = 0
) -> FeaturedMesh:
    """Mesh a scene with features; ``plan`` holds planes, circles and sizes, ``edges`` asks for
    smaller elements at the re-entrant edges of features, and there is to be room for `layers`.
    """
    assemblable(tetrahedra_of(scene, plan, refinement, edges=edges, layers=layers), 10)
    return featured_mesh(
        scene.outline,
        resolved(scene),
        **plan,
        refinement=refinement,
        half=half,
        edges=edges,
    )


def cut_body(
    scene: Scene,
    wanted: Sequence,
    plan: dict,
    refinement: float,
    half: bool,
    *,
    layers: int,
    ratio: float,
) -> Body:
    """Build the free body of a scene with cuts; parameters as for :func:`meshed`, and the ratio of the
    layers.
    """
    cut_mesh = meshed(scene, plan, refinement, half, layers=layers)
    return featured_body(scene, wanted, cut_mesh, refinement, layers=layers, ratio=ratio)


def featured_body(
    scene: Scene,
    wanted: Sequence,
    cut_mesh: FeaturedMesh,
    refinement: float,
    *,
    plain: bool = False,
    layers: int = 0,
    ratio: float = 1.0,
) -> Body:
    """Build the free body of a meshed scene with its features cut out or, `plain`, left in: two
    blocks where there is a mirror plane, one where there is none, with layers of a ratio towards
    singular lines; refuse a seat without faces and inverted elements.
    """
    split = _with_layers(scene, wanted, cut_mesh, plain, layers, ratio)
    solid, quality, facets = split.mesh, split.quality, split.facets
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


def _with_layers(
    scene: Scene,
    wanted: Sequence,
    cut_mesh: FeaturedMesh,
    plain: bool,
    layers: int,
    ratio: float,
) -> LayeredMesh:
    """Return the mesh of a scene without its cuts or, `plain`, with them, and with layers."""
    keep = np.ones(len(cut_mesh.cut), bool) if plain else ~cut_mesh.cut
    mesh = cut_mesh.mesh if plain else submesh(cut_mesh.mesh, keep)
    solid = _isoparametric(mesh, "tet10", cut_mesh.segment[keep])
    return with_layers(
        solid,
        replace(check_mesh(mesh), geometry=cut_mesh.quality.geometry),
        _facets(solid, scene),
        wanted,
        [segment.material for segment in scene.segments],
        layers=layers,
        ratio=ratio,
        plane=cut_mesh.plane,
    )


def cut_size_of(
    scene: Scene,
    wanted: Sequence,
    plan: dict,
    refinement: float,
    half: bool,
    *,
    layers: int,
    ratio: float,
) -> Size:
    """Mesh a scene with cuts and count; parameters as for :func:`cut_body`."""
    cut_mesh = meshed(scene, plan, refinement, half, layers=layers)
    if not layers:
        return cut_size(cut_mesh)
    split = _with_layers(scene, wanted, cut_mesh, False, layers, ratio)
    return _size_of(split.mesh.mesh, cut_mesh.plane)


def cut_size(cut_mesh: FeaturedMesh) -> Size:
    """Count a mesh without its cuts."""
    return _size_of(submesh(cut_mesh.mesh, ~cut_mesh.cut), cut_mesh.plane)


def _size_of(mesh: MeshTet2, plane: int | None) -> Size:
    """Count a mesh, of a half where there is a plane."""
    if plane is None:
        return size_of_mesh(mesh, basis_of("tet10"))
    halves = size_of_mesh(mesh, basis_of("tet10"), parts=2)
    # of a node on the mirror plane one half has one component and the other two
    on_plane = int((np.abs(mesh.doflocs[plane]) < 1e-9).sum())
    return replace(halves, unknowns=halves.unknowns - 3 * on_plane)


def _facets(solid: SolidMesh, scene: Scene) -> Facets:
    """Return the facets of seats on the rest of surfaces of revolution, and on teeth."""
    cyclic = [f for f in resolved(scene) if f.sort == CYCLIC]
    if not cyclic:
        return Seats(solid, scene.segments, clipped=False)
    from solidgear.cuts.sector.mesh import seats  # slow to import, and seldom needed

    return seats(solid, solid.mesh.p, scene, cyclic)
