"""Size of the 3D solid of a scene, counted on the mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from solidgear.core.elements import SOLVED_AS
from solidgear.core.kernel.room import assemblable
from solidgear.core.meshing.hexahedra import straight_hexahedra
from solidgear.core.models.kinds import BODIES, CUTS, CYCLIC
from solidgear.core.models.size import Size, coupled, size_of_mesh
from solidgear.core.models.solid.body import layers_of, tetrahedra_with_layers
from solidgear.core.models.solid.mesh import basis_of
from solidgear.core.models.solid.plan import hexahedra_layout, tetrahedra_plan
from solidgear.core.registry import addition
from solidgear.core.scene.shaft import attached_stations, resolved

if TYPE_CHECKING:
    from solidgear.core.scene.shaft import Shaft


def solid_size(
    scene: Shaft,
    *,
    element: str,
    size: float | None,
    graded_size: float | None,
    refinement: float,
    around: int,
    half: bool,
    coarser: int,
    layers: int | None,
    ratio: float,
    attachments: tuple[str, ...] | None,
    **grading: Any,
) -> Size:
    """Mesh the 3D solid of a scene and count; parameters as for
    :func:`solidgear.core.models.solid.body.solid`.

    In place of a part from a STEP file its round part is meshed, at the same sizes; a mesh file is
    counted as it is.
    """
    wanted = [*attached_stations(scene.stations, attachments)]
    sorts = {f.sort for f in resolved(scene)}
    sizes = {"size": size, "graded_size": graded_size, "refinement": refinement}
    file = scene.body
    if file is not None and file.counts is not None:
        return _of_file(file)
    if BODIES in sorts:
        mesh = addition("solid mesh", "block")(scene, wanted, element, size, refinement)
        return size_of_mesh(mesh, basis_of(element))
    if sorts == {CYCLIC}:
        mesh, _, _ = addition("solid mesh", CYCLIC)(scene, wanted, **sizes)
        return size_of_mesh(mesh, basis_of("tet10"))
    if CUTS in sorts:
        plan = tetrahedra_plan(scene, wanted, around=around, layers=layers or 0, **sizes)
        return addition("solid size", CUTS)(
            scene, wanted, plan, refinement, half, layers=layers or 0, ratio=ratio
        )
    grading |= {"layers": layers_of(element, layers), "ratio": ratio}
    if element.startswith("tet"):
        sizes |= {"around": around, "layers": grading["layers"], "ratio": ratio}
        solid_mesh, _, _ = tetrahedra_with_layers(scene, wanted, element, **sizes)
        return size_of_mesh(solid_mesh.mesh, basis_of(element))
    grading |= {"around": around, "size": size, "refinement": refinement}
    plan, turns = hexahedra_layout(scene, tuple(dict.fromkeys(a for _, a in wanted)), **grading)
    assemblable(plan.cells * turns, 20)
    mesh, _, _ = straight_hexahedra(scene, plan, turns)
    return size_of_mesh(mesh, basis_of(element), mirrors=half)


def _of_file(file: Any) -> Size:
    kind = basis_of(SOLVED_AS.get(file.element, file.element))
    nodes, pairs = coupled(kind, file.counts)
    return Size(3 * nodes, ((3 * nodes, 9 * pairs),), 9 * pairs)
