"""Fillets of the round part of a file, in place of the short cones that follow them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from solidgear.core.errors import SceneError
from solidgear.core.scene.blends import Fillet

if TYPE_CHECKING:
    from solidgear.core.scene.model import Scene
    from solidgear.core.scene.outline import Torus
    from solidgear.core.scene.parts import Segment

#: relative to the radius of an arc: distance of its ends from those of a quarter of a turn
QUARTER = 1e-3


def filleted(scene: Scene) -> Scene:
    """Return the round part of a scene with a fillet for every quarter of a turn at the root of an
    outer shoulder, other arcs as cones; a scene of segments, or of a part whose fillets reach into a
    seat, unchanged. Segments keep their names, and those of cones go.
    """
    body = scene.body
    if body is None or not body.tori:
        return scene
    segments, blends = list(scene.segments), list[Fillet]()
    for torus in body.tori:
        fillet = _fillet(torus, segments)
        blends += [fillet] if fillet else []
    try:
        return scene.with_changes(segments=tuple(segments), blends=tuple(blends), body=None)
    except SceneError:
        return scene


def _fillet(torus: Torus, segments: list[Segment]) -> Fillet | None:
    """Return the fillet of an arc, and replace its cones in `segments` by the cylinder that it runs
    into; None where the arc is no such fillet.
    """
    near, radius = QUARTER * torus.radius, torus.r - torus.radius
    at_start = abs(torus.y0 - torus.y) < near and abs(torus.y1 - torus.y - torus.radius) < near
    at_end = abs(torus.y1 - torus.y) < near and abs(torus.y - torus.y0 - torus.radius) < near
    cones = [k for k, s in enumerate(segments) if s.y0 > torus.y0 - near and s.y1 < torus.y1 + near]
    if not (torus.hollow and (at_start or at_end) and cones):
        return None
    before, after = cones[0] - 1, cones[-1] + 1
    cylinder_index, far_index = (before, after) if at_start else (after, before)
    if not (0 <= cylinder_index < len(segments) and 0 <= far_index < len(segments)):
        return None
    cylinder = segments[cylinder_index]
    bores = {
        bore for s in (cylinder, *(segments[k] for k in cones)) for bore in (s.inner0, s.inner1)
    }
    is_cylinder = abs(cylinder.outer0 - radius) < near and abs(cylinder.outer1 - radius) < near
    if not is_cylinder or len(bores) > 1:
        return None
    place = segments[far_index].y0 if at_start else segments[far_index].y1
    reach = {"y1": place} if at_start else {"y0": place}
    replaced = sorted([cylinder_index, *cones])
    segments[replaced[0] : replaced[-1] + 1] = [cylinder.with_changes(**reach)]
    end = "end" if at_start else "start"
    return Fillet(name=f"{cylinder.name}.{end}", y=place, radius=torus.radius)
