"""3D solid of a part from a STEP or mesh file."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from solidgear.core import Body, SolidgearError
from solidgear.core.elements import SOLVED_AS
from solidgear.core.machine.isolated import IsolatedError, isolated
from solidgear.core.meshing.element_size import size_formulas
from solidgear.core.meshing.placing import Placing
from solidgear.core.meshing.quality import MeshError
from solidgear.core.meshing.revolved import graded_corners
from solidgear.core.meshing.tetrahedra import check_filling
from solidgear.core.models.solid.plan import assemblable_plan
from solidgear.parts import step
from solidgear.parts.own_mesh import solid_body
from solidgear.parts.part_file import file_mesh

if TYPE_CHECKING:
    from solidgear.core import Scene
    from solidgear.core.scene import Material
    from solidgear.parts.body_file import BodyFile, CoarseMesh

#: seconds after which a mesh is given up
MESH_SECONDS = 900.0
#: planes across a part reach beyond its largest radius by this factor
BEYOND = 1.1


def part_body(
    scene: Scene,
    wanted: Sequence,
    *,
    size: float | None,
    graded_size: float | None,
    refinement: float,
    around: int,
    coarser: int,
    layers: int,
    ratio: float,
) -> Body:
    """Build the free body, in one block, of the part of a scene with a ``body``; sizes as for
    :func:`solidgear.core.models.solid.body.solid`, and so are `layers` and their ratio, while a mesh
    file is meshed already, and ``coarser`` counts back in its list.

    Refused where the file has changed since the scene was read, where no face lies on a seat, and
    where it cannot be meshed.
    """
    file: BodyFile | None = scene.body
    assert file is not None
    source = _read(file, coarser)
    place = Placing(file.unit, file.turn, file.foot)
    facts = {"file": source.name, "refinement": refinement, "coarser": coarser}
    named = tuple(g.name for g in file.groups if g.name)
    materials = file.materials(scene.material) if file.groups else None
    if file.kind == "mesh":
        part = _meshed(source, file_mesh, source.path, source.sha256, place, named)
        # elements of first order give the shape only, since they lock in bending: on a rod of 16 faces
        # around tetrahedra miss the deflection by -7.7 %, those of second order with straight sides by
        # +2.3 %, the loss of section by flat faces; a thin bar of eight-node bricks vibrates at 3.3
        # times its frequency, of twenty nodes on the same cells within 0.1 %
        element = SOLVED_AS.get(part.element, part.element)
        if element != part.element:
            facts["file_element"] = part.element
        free = file.edges is not None
        if free:
            wanted = [(s, a) for s, a in wanted if s.patch is not None]
        for station, _ in wanted:
            if free and station.patch.name not in part.patches:
                raise SolidgearError(
                    f"{source.name} has no group of surfaces {station.patch.name!r}"
                )
        body = solid_body(
            part.mesh,
            scene,
            element=element,
            wanted=wanted,
            clipped=True,
            facts=facts | {"axis": not free},
            owner=part.owner if materials else None,
            materials=materials,
            patches=part.patches,
        )
        return replace(body, scale=_rough_scale(file, scene.material)) if free else body
    plan = step_plan(
        scene,
        wanted,
        size=size,
        graded_size=graded_size,
        refinement=refinement,
        around=around,
        layers=layers,
    )
    filling, owner = _meshed(
        file, isolated, step.mesh, file.path, place, plan, named, seconds=MESH_SECONDS
    )
    # four times the loss of volume by the arcs
    rtol = max(2e-3, 15.0 / plan["around"] ** 4 * 4)
    quality = check_filling(filling, volume=file.volume, rtol=rtol)
    # volume missing at the surface counts twice in the second moments of a full section
    lost = 2 * abs(quality.volume / file.volume - 1)
    facts["geometry"] = max(quality.geometry, lost)
    return solid_body(
        filling.mesh,
        scene,
        element="tet10",
        wanted=wanted,
        clipped=False,
        facts=facts,
        owner=owner if materials else None,
        materials=materials,
        layers=layers,
        ratio=ratio,
    )


def _read(file: BodyFile, coarser: int) -> BodyFile | CoarseMesh:
    """Return the file of a part, or of one of its coarser meshes; refuse it where it has changed
    since the scene was read.
    """
    if coarser > len(file.coarser):
        raise SolidgearError(
            f"solid: coarser = {coarser}, and the scene lists {len(file.coarser)} meshes coarser than "
            f"{file.name}"
        )
    source = file if coarser == 0 else file.coarser[-coarser]
    try:
        same = hashlib.sha256(Path(source.path).read_bytes()).hexdigest() == source.sha256
    except OSError as error:
        raise SolidgearError(f"{source.name} cannot be opened: {error.strerror}") from None
    if not same:
        raise SolidgearError(f"{source.name} has changed since the scene was read: read it again")
    return source


def _rough_scale(file: BodyFile, material: Material) -> float:
    """Estimate the lowest elastic eigenvalue, rad^2/s^2, of a rod as long as a body and of its
    volume, or of half a wave of shear along it.
    """
    assert file.edges is not None
    length = max(file.edges)
    wave = material.E / material.density * (4.73 / length) ** 4 * file.volume / length
    return min(wave / (4 * math.pi), (math.pi / length) ** 2 * material.E / material.density / 3)


def _meshed(file: BodyFile | CoarseMesh, function: Any, *arguments: Any, **limits: Any) -> Any:
    """Call a mesher, with its errors as those of the file."""
    try:
        return function(*arguments, **limits)
    except IsolatedError as error:
        raise MeshError(f"{file.name} cannot be meshed: the mesher {error}") from None
    except MeshError as error:
        raise MeshError(f"{file.name} {error}") from None


def step_plan(
    scene: Scene, wanted: Sequence, *, size, graded_size, refinement, around, layers=0
) -> dict:
    """Return cuts and sizes of the mesh of a STEP part for :func:`solidgear.parts.step.mesh`,
    those of the round part inside it; sizes and layers as for
    :func:`solidgear.core.models.solid.body.solid`.
    """
    plan = assemblable_plan(
        scene,
        wanted,
        size=size,
        graded_size=graded_size,
        refinement=refinement,
        around=around,
        layers=layers,
    )
    corners = graded_corners(
        scene.outline, plan["planes"], plan["circles"], plan.get("convex", True)
    )
    graded = plan["graded_size"] or plan["size"]
    largest = scene.outline.largest_radius
    return {
        "circles": [(y, r) for y in plan["circles"] for r in _radii(scene, y)],
        "planes": [(y, BEYOND * largest) for y in plan["planes"]],
        "formulas": size_formulas(
            scene.outline,
            corners,
            plan["size"],
            plan["graded_size"],
            plan.get("reach"),
            plan["around"],
        ),
        "size": plan["size"],
        "graded": graded,
        "around": plan["around"],
    }


def _radii(scene, y: float) -> list[float]:
    """Return the radius of a circle around the outer surface; none where the surface ends or steps
    there.
    """
    near = 1e-6 * scene.length
    segments = [s for s in scene.segments if s.y0 - near < y < s.y1 + near]
    radii = [s.radius_at(min(max(y, s.y0), s.y1))[1] for s in segments]
    if y < near or y > scene.length - near or max(radii) - min(radii) > near:
        return []
    return radii[:1]
