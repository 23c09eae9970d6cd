"""A scene with everything resolved, as plain data: places, matrices, outlines and loads in SI."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from solidgear.core.scene.acting import acting_loads
from solidgear.core.scene.bearing_stiffness import stiffness_entries

if TYPE_CHECKING:
    from solidgear.core.scene.model import Scene


def resolved(scene: Scene) -> dict[str, Any]:
    """Return everything of a scene whose bearings have a stiffness, as plain data for JSON."""
    data = scene.model_dump(mode="json")
    for key in ("masses", "loads", "cases", "features", "blends", "further_ports", "uncertain"):
        if not data[key]:
            del data[key]
    for row, corner in zip(data.get("blends", ()), scene.corners):
        lo, hi = corner.span
        row |= {"edge": "root" if corner.root else "rim", "lo": lo, "hi": hi}
        row |= {"corner": [corner.r, corner.y], "outline": [list(p) for p in corner.points()]}
        row |= {"owner": scene.segments[corner.owner].name}
    for row, segment in zip(data["segments"], scene.segments):
        row["length"] = segment.length
    for row, bearing in zip(data["bearings"], scene.bearings):
        row |= {
            "lo": bearing.lo,
            "hi": bearing.hi,
            "stiffness": bearing.stiffness.tolist(),
            "entries": stiffness_entries(row.pop("matrix")),
        }
        if bearing.scale == 1:
            del row["scale"]
        for key in ("catalogue", "support", "hold", "face", "housing"):
            if row[key] is None:
                del row[key]
        if bearing.housing is not None:
            row["housing"] = bearing.housing.entries
    if scene.housing is not None:
        data["housing"] = {"y": scene.housing.y, "entries": scene.housing.entries}
    for key in ("load", "torque_at", "turns", "weight", "lubrication", "body", "housing"):
        if data[key] is None:
            del data[key]
    for key in ("groups", "told", "mixed", "remarks"):
        if not data.get("body", {}).get(key, True):
            del data["body"][key]
    for row, mass in zip(data.get("masses", ()), scene.masses):
        carrier = next(s for s in scene.stations if s.name == mass.station)
        row |= {"y": carrier.y, "lo": carrier.lo, "hi": carrier.hi}
        row |= {"attachment": carrier.attachment, "matrix": mass.matrix.tolist()}
    for row, load in zip(data.get("loads", ()), scene.loads):
        given = {key: value for key, value in row.items() if value is not None}
        row.clear()
        row |= given | {"station": load.station}
    if scene.loads:
        data["acting"] = [
            {"name": load.name, "station": load.station, "y": load.y, "load": load.six.tolist()}
            for load in acting_loads(scene)
        ]
    return data | {"length": scene.length, "steps": list(scene.steps)}
