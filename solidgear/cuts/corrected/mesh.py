"""The 3D mesh of a defect correction, which a solid with cuts and one without share."""

from __future__ import annotations

from dataclasses import replace

from solidgear.core.models.size import Size
from solidgear.core.models.solid.plan import tetrahedra_plan, usual_size
from solidgear.core.scene.shaft import attached_stations
from solidgear.cuts.solid.featured import cut_size, meshed
from solidgear.cuts.solid.meshing import FeaturedMesh

#: how many times smaller elements are at seat ends and shoulders
GRADED = 2.0


def sizes(scene) -> dict[str, float]:
    """Return element edges away from singular places, and at seat ends and shoulders, m, of the 3D mesh
    at refinement 1.

    The mesh error at seat ends and shoulders drops out of the difference, except for its change by a
    feature close to them; that at the edges of features does not.
    """
    size = usual_size(scene)
    return {"size": size, "graded_size": size / GRADED}


def plan_of(scene, refinement: float, attachments: tuple[str, ...] | None) -> dict:
    """Return planes, circles and sizes of the mesh; parameters as for
    :func:`solidgear.cuts.corrected.body.corrected`.
    """
    wanted = [*attached_stations(scene.stations, attachments)]
    by_name = sizes(scene)
    return tetrahedra_plan(
        scene,
        wanted,
        size=by_name["size"],
        graded_size=by_name["graded_size"],
        refinement=refinement,
        around=12,
    )


def meshed_cuts(scene, refinement: float, attachments: tuple[str, ...] | None) -> FeaturedMesh:
    """Make the mesh; parameters as for :func:`plan_of`."""
    plan = plan_of(scene, refinement, attachments)
    return meshed(scene, plan, refinement, True, edges=True)


def corrected_size(scene, refinement: float, attachments: tuple[str, ...] | None) -> Size:
    """Count the solid with cuts and the one without; parameters as for :func:`plan_of`.

    The body itself is small, and so is the harmonic solid beside these.
    """
    cut = cut_size(meshed_cuts(scene, refinement, attachments))
    return replace(cut, matrices=2 * cut.matrices, entries=2 * cut.entries)
