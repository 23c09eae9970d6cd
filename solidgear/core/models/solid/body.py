"""Full 3D solid: tetrahedra on a gmsh mesh, or hexahedra on a structured O-grid.

Elements, quadrature and the numbering of unknowns are scikit-fem's; matrices are assembled in
blocks from one Gram matrix of basis gradients per element.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from solidgear.core.body import Body, Reflection
from solidgear.core.elements import ELEMENTS
from solidgear.core.errors import SolidgearError
from solidgear.core.kernel.room import assemblable
from solidgear.core.meshing.geometry import geometry_error, misshapen
from solidgear.core.meshing.hexahedra import hexahedra
from solidgear.core.meshing.quality import check_mesh
from solidgear.core.meshing.tetrahedra import tetrahedra
from solidgear.core.models.kinds import BODIES, CUTS, CYCLIC, PARTS
from solidgear.core.models.options import thick_enough
from solidgear.core.models.solid.block import body_of, free_block, mesh_facts, mirrored, seat_facets
from solidgear.core.models.solid.images import images_of
from solidgear.core.models.solid.lines import with_layers
from solidgear.core.models.solid.mesh import SolidMesh, _isoparametric
from solidgear.core.models.solid.parity import blocks_by_parity
from solidgear.core.models.solid.plan import assemblable_plan, hexahedra_layout, tetrahedra_plan
from solidgear.core.registry import addition
from solidgear.core.scene.closed_form import moments_of_parts, volume_of
from solidgear.core.scene.shaft import attached_stations, feature_labels, resolved, without_axis

if TYPE_CHECKING:
    from solidgear.core.meshing.quality import MeshQuality
    from solidgear.core.models.solid.block import Facets

#: layers of hexahedra unless others are asked for
LAYERS = 4


def solid(
    scene,
    *,
    element: str = "hex20",
    relative_size: float = 0.4,
    size: float | None = None,
    layers: int | None = None,
    edge_layers: int = 1,
    radial_layers: int = 4,
    ratio: float = 0.35,
    around: int = 12,
    graded_size: float | None = None,
    refinement: float = 1.0,
    attachments: tuple[str, ...] | None = None,
    half: bool = True,
    coarser: int = 0,
) -> Body:
    """Build the free 3D solid of a scene: one block with all six components; of a part with features and
    a mirror plane, two, of the motions that are symmetric about it and of the others; of hexahedra around
    the axis, four, by their parity in two planes; options as in
    :data:`~solidgear.core.models.options.SOLID_OPTIONS`.

    Hexahedra away from singular edges have the size ``relative_size``, tetrahedra a third of the
    largest outer radius, unless ``size`` is given, and at shoulders and seat ends a quarter of
    that; there are at least 16 of these around. The defaults of hexahedra give 1.4e-3 in stiffness at
    37k unknowns on the overhung pinion; 1.2e-2, 6e-3 and 3e-3 at 5k, 7k and 14k come of 1, 2 and 3
    layers of both kinds, none at seat ends and 8 cells around. Ten-node tetrahedra have layers where
    these are asked for: towards concave edges, ends of rigid seats and joints of materials. A part from
    a file is solved whole. Layers thinner than digits and cells around that do not fit are refused.
    """
    grading = {
        "relative_size": relative_size,
        "size": size,
        "layers": layers_of(element, layers),
        "edge_layers": edge_layers,
        "radial_layers": radial_layers,
        "ratio": ratio,
        "around": around,
        "refinement": refinement,
    }
    thick_enough("solid", grading)
    if element.startswith("hex") and around % 4:
        raise SolidgearError(
            f"solid: around = {around} does not fit an O-grid; use a multiple of 4"
        )
    wanted = [*attached_stations(scene.stations, attachments)]
    features = resolved(scene)
    if without_axis(scene) and scene.body.kind == "block":
        block_body = addition("solid body", "block")
        return block_body(scene, wanted, element=element, size=size, refinement=refinement)
    if features:
        if element != "tet10":
            raise SolidgearError(
                f"solid: element = {element} cannot hold {feature_labels(features)} of the scene; "
                "use tet10"
            )
        sizes: dict[str, Any] = {"size": size, "graded_size": graded_size}
        sizes["refinement"] = refinement
        towards = {"layers": layers or 0, "ratio": ratio}
        if all(f.sort in (PARTS, BODIES) for f in features):
            part_body = addition("solid body", PARTS)
            return part_body(scene, wanted, around=around, coarser=coarser, **towards, **sizes)
        if all(f.sort == CYCLIC for f in features):
            return addition("solid body", CYCLIC)(scene, wanted, **sizes)

        plan = tetrahedra_plan(scene, wanted, around=around, layers=layers or 0, **sizes)
        return addition("solid body", CUTS)(scene, wanted, plan, refinement, half, **towards)
    tet = element.startswith("tet")
    reflections: tuple[Reflection, ...] = ()
    if tet:
        body_mesh, facets, quality = tetrahedra_with_layers(
            scene,
            wanted,
            element,
            size=size,
            graded_size=graded_size,
            refinement=refinement,
            around=around,
            layers=layers_of(element, layers),
            ratio=ratio,
        )
    else:
        mesh, segment, quality = _hexes(scene, wanted, grading)
        body_mesh = _isoparametric(mesh, element, segment)
        nodes, reflections = mirrored(body_mesh.nodes, 1e-7 * scene.length)
        body_mesh = replace(body_mesh, nodes=nodes)
        if not _looks_the_same(body_mesh, reflections):
            reflections = ()
        facets = seat_facets(body_mesh, scene.segments, 1e-7 * scene.length)
    if half and len(reflections) > 1:
        blocks = blocks_by_parity(body_mesh, scene, wanted, facets, reflections)
    else:
        blocks = (free_block(body_mesh, scene, wanted, facets),)
    exact = moments_of_parts(scene.outline)
    facts = {
        **mesh_facts(body_mesh, quality),
        "geometry": geometry_error(misshapen(body_mesh.moments(scene.outline), exact)),
        "refinement": refinement,
        # A mesh with fourfold symmetry keeps pairs exactly; a free mesh splits them by its error.
        "pair_tolerance": 2e-3 if tet else 1e-6,
    }
    return body_of(scene, wanted, blocks, facts, body_mesh)


def _looks_the_same(mesh: SolidMesh, reflections: Sequence[Reflection]) -> bool:
    """Return whether the image of every cell is one of the same segment."""
    return all(image.are_alike(mesh.segment) for image in images_of(mesh.mesh.t, reflections))


def _hexes(scene, wanted, grading):
    plan, turns = hexahedra_layout(scene, tuple(dict.fromkeys(a for _, a in wanted)), **grading)
    assemblable(plan.cells * turns, 20)
    mesh, segment = hexahedra(scene, plan, turns)
    return mesh, segment, check_mesh(mesh, volume=volume_of(scene.outline), rtol=1e-3)


def layers_of(element: str, layers: int | None) -> int:
    """Return the layers of an element type: ten-node tetrahedra and hexahedra have those asked for."""
    if element == "tet4":
        return 0
    if layers is None:
        return 0 if element == "tet10" else LAYERS
    return layers


def tetrahedra_with_layers(
    scene, wanted, element, *, layers, ratio, **sizes
) -> tuple[SolidMesh, Facets, MeshQuality]:
    """Mesh a body of revolution with tetrahedra and their layers; return with it the function that gives
    the facets of stations.
    """
    mesh, segment, quality = _tets(scene, wanted, element, layers, **sizes)
    plain = _isoparametric(mesh, element, segment)
    facets = seat_facets(plain, scene.segments, 1e-7 * scene.length)
    if not layers:
        return plain, facets, quality
    materials = [s.material for s in scene.segments]
    split = with_layers(plain, quality, facets, wanted, materials, layers=layers, ratio=ratio)
    return split.mesh, split.facets, split.quality


def _tets(scene, wanted, element, layers, **sizes):
    plan = assemblable_plan(scene, wanted, layers=layers, **sizes)
    curved = tetrahedra(scene.outline, **plan)
    if ELEMENTS[element].order == 2:
        return curved.mesh, curved.segment, curved.quality
    from skfem import MeshTet1

    straight = MeshTet1(curved.mesh.p[:, : curved.mesh.t.max() + 1], curved.mesh.t)
    # Straight sides lose some of the volume by nature; the gate only looks for broken elements.
    quality = check_mesh(straight, volume=volume_of(scene.outline), rtol=5e-2)
    return straight, curved.segment, quality
