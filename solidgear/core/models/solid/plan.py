"""Plan of a 3D mesh: places of the lines and sizes of its elements, before it is made."""

from __future__ import annotations

from math import pi

from solidgear.core.kernel.room import assemblable
from solidgear.core.meshing.element_size import rough_cells
from solidgear.core.meshing.grading import Grading
from solidgear.core.meshing.layout import layout
from solidgear.core.models.kinds import CUTS
from solidgear.core.models.limits import countable
from solidgear.core.registry import addition
from solidgear.core.scene.shaft import resolved

#: tetrahedra that a layer adds around each edge on a line
PER_LINE = 35.0


def hexahedra_layout(
    scene,
    attachments=None,
    *,
    relative_size,
    size,
    layers,
    edge_layers,
    radial_layers,
    ratio,
    around,
    refinement,
):
    """Return the mesh lines of :func:`solidgear.core.models.solid.body.solid` in hexahedra and the cells
    around, before anything is meshed; parameters as there.
    """
    countable("solid", scene, size or relative_size * scene.outline.least_radius, refinement)
    grading = Grading(
        layers,
        edge_layers,
        radial_layers,
        ratio,
        relative_size,
        size,
        reach=0.7,
        radial_reach=0.5,
        refinement=refinement,
        core=True,
        # quadratic sides: what layers do at a sharp corner, more of them do at a round one
        corner_cells=max(1, layers),
    )
    return layout(scene, grading, attachments), turns_of(around, refinement)


def tetrahedra_of(
    scene, plan: dict, refinement: float, *, edges: bool = False, layers: int = 0
) -> float:
    """Estimate the number of tetrahedra in a scene with its cuts; ``plan`` is that of
    :func:`tetrahedra_plan`, ``edges`` asks for smaller ones at re-entrant edges, and `layers` are those
    towards concave edges.
    """
    radii = {s.name: s.outer0 for s in scene.segments}
    cuts = [f for f in resolved(scene) if f.sort == CUTS]
    fine_lines = addition("question of features", "fine lines")
    fine = [fine_lines(f, radii[f.segment], refinement, edges) for f in cuts]
    sizes = {name: plan[name] for name in ("circles", "size", "graded_size")}
    graded = plan["graded_size"] or plan["size"]
    lines = sum(2 * pi * edge.r / graded for edge in scene.outline.edges if edge.angle > pi)
    lines += sum(length / least for length, least, _ in fine)
    return rough_cells(scene.outline, fine=fine, **sizes) + layers * PER_LINE * lines


def usual_size(scene) -> float:
    """Return the element edge of tetrahedra at refinement 1, away from singular places, m."""
    return scene.outline.largest_radius / 3


def turns_of(around: int, refinement: float) -> int:
    """Return the hexahedra around at some refinement."""
    return max(8, 4 * int(round(around * refinement / 4)))


def assemblable_plan(scene, wanted, *, refinement, layers, **sizes) -> dict:
    """Return :func:`tetrahedra_plan`, refused where matrices of as many tetrahedra find no room."""
    plan = tetrahedra_plan(scene, wanted, refinement=refinement, layers=layers, **sizes)
    assemblable(tetrahedra_of(scene, plan, refinement, layers=layers), 10)
    return plan


def tetrahedra_plan(scene, wanted, *, size, graded_size, refinement, around, layers=0) -> dict:
    """Return the arguments of :func:`~solidgear.core.meshing.tetrahedra.tetrahedra` for the stations
    ``wanted`` with their attachments.

    What layers leave of an error lies around them, where elements that grow fast from a small radius to
    a size by the largest one are far too large; and at convex edges there is none to be small for.
    """
    size = countable("solid", scene, size or usual_size(scene), refinement) / refinement
    graded_size = (graded_size / refinement) if graded_size else size / 4
    planes = sorted({s.y for s, a in wanted if a == "section"})
    circles = sorted({y for s, a in wanted if a != "section" for y in (s.lo, s.hi)})
    # Meshes of one sequence are similar only if the circumference is refined with the rest.
    turns = max(8, int(round(max(16, around) * refinement)))
    plan = {
        "planes": planes,
        "circles": circles,
        "size": size,
        "graded_size": None if graded_size >= size else graded_size,
        "around": turns,
    }
    if layers:
        plan |= {"reach": scene.outline.largest_radius, "convex": False}
    return plan
