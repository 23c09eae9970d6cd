"""From a `Scene` to the tables of a file, which read back equal: the inverse of
:mod:`solidgear.core.scene.file`.

Numbers are in SI, and places are counted from the start of the shaft, whatever words a file had.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.core.scene.bearing_stiffness import stiffness_entries
from solidgear.core.scene.materials import MATERIALS, by_name
from solidgear.core.scene.model_table import entry_of, table_of
from solidgear.core.scene.tables import parts
from solidgear.core.scene.uncertain import written_range
from solidgear.core.scene.units import POSITION_DECIMALS

if TYPE_CHECKING:
    from solidgear.core.scene.housing import Elastic
    from solidgear.core.scene.model import Scene
    from solidgear.core.scene.parts import Material, Segment
    from solidgear.core.scene.patches import Patch
    from solidgear.core.scene.point_mass import PointMass
    from solidgear.core.scene.shaft_load import ShaftLoad
    from solidgear.core.scene.stations import Bearing, Port

Table = dict[str, Any]
#: tables without a part in the stiffness of bearings at their load
_BESIDE = ("title", "name", "source", "lubrication", "uncertain", "ask")


def tables_of(scene: Scene) -> Table:
    """Return the tables of a file that describes a scene."""
    tables = unsettled_tables(scene)
    waits = [b for b in scene.bearings if b.catalogue is not None]
    if waits:
        digest = digest_of(tables)
        for table, bearing in zip(tables["bearing"], scene.bearings):
            if bearing in waits:
                table["settled"] = _settled(bearing, digest)
    return tables


def digest_of(tables: Mapping[str, Any]) -> str:
    """Return a text that changes with every entry on which the stiffness of bearings may depend."""
    data = {key: value for key, value in tables.items() if key not in _BESIDE}
    return hashlib.sha256(json.dumps(data, sort_keys=True).encode()).hexdigest()[:16]


def digest_of_scene(scene: Scene) -> str:
    """Return the digest of the tables of a scene, whatever stiffness catalogue bearings have."""
    return digest_of(unsettled_tables(scene))


def _settled(bearing: Bearing, digest: str) -> Any:
    """Return the stiffness that catalogue data have under the load; False where it is not solved."""
    if bearing.matrix is None:
        return False
    return {"under": digest, "stiffness": stiffness_entries(bearing.matrix)}


def unsettled_tables(scene: Scene) -> Table:
    """Return the tables of a scene without the stiffness that catalogue data have under its load."""
    tables: Table = {
        "title": scene.title,
        "name": scene.name,
        "source": scene.source,
        "torque_at": scene.torque_at,
        "turns": scene.turns,
        "weight": scene.weight,
        "material": material_entry(scene.material),
        "body": None,
        "segment": [],
        "bearing": [_bearing(scene, bearing) for bearing in scene.bearings],
        "mass": [_mass(mass) for mass in scene.masses],
        "feature": [_feature(feature) for feature in scene.features],
        "housing": _housing(scene),
        "port": [_port(scene, port) for port in scene.ports],
        "load": [_load(load) for load in scene.loads] or entry_of(scene.load),
        "case": [table_of(case) for case in scene.cases],
        "lubrication": entry_of(scene.lubrication),
        "uncertain": {entry.path: written_range(scene, entry) for entry in scene.uncertain},
        "ask": table_of(scene.ask),
    }
    tables["feature"] += [_feature(blend, {"position": blend.y}) for blend in scene.blends]
    if scene.body is None:
        tables["segment"] = [_segment(segment, scene.material) for segment in scene.segments]
    else:
        tables["body"] = parts().written(scene.body)
    needed = {"name", "material"}
    return {key: value for key, value in tables.items() if key in needed or value}


def material_entry(material: Material) -> Table | str:
    """Return the name of a material that has the constants of that name, or its table."""
    table = table_of(material)
    return (
        material.name if material.name in MATERIALS and by_name(material.name) == table else table
    )


def _length(segment: Segment) -> float:
    """Return the length with the fewest digits that ends where the segment does."""
    for digits in range(1, 17):
        length = float(f"{segment.length:.{digits}g}")
        if round(segment.y0 + length, POSITION_DECIMALS) == segment.y1:
            return length
    return segment.length


def _segment(segment: Segment, usual: Material) -> Table:
    table: Table = {"kind": "cylinder", "name": segment.name, "length": _length(segment)}
    even_bore = segment.inner0 == segment.inner1
    if segment.outer0 == segment.outer1 and even_bore:
        table["diameter"] = segment.diameter
    else:
        table["kind"] = "cone"
        table["start_diameter"] = segment.start_diameter
        table["end_diameter"] = segment.end_diameter
    if not even_bore:
        table |= {"start_bore": 2 * segment.inner0, "end_bore": 2 * segment.inner1}
    elif segment.inner0:
        table["bore"] = segment.bore
    if segment.part != "shaft":
        table["part"] = segment.part
    if segment.material != usual:
        entry = material_entry(segment.material)
        whole: Table = {"name": segment.material.name, **table_of(segment.material)}
        table["material"] = entry if isinstance(entry, str) else whole
        if segment.material.strength is None and usual.strength is not None:
            table["material"] = {**whole, "strength": False}
    return table


def _bearing(scene: Scene, bearing: Bearing) -> Table:
    data: Any = bearing.catalogue
    table: Table = {"name": bearing.name}
    if bearing.patch is not None:
        table |= _on_patch(scene.body, bearing.patch)
    elif bearing.face is not None:
        table |= {"face": bearing.face, "seat_width": bearing.seat_width}
    else:
        table |= {"position": bearing.y, "seat_width": bearing.seat_width}
    if bearing.hold is not None:
        table["hold"] = bearing.hold
    elif data is not None:
        # a designation may stand for a class of clearance, ribs or two rows
        table["catalogue"] = table_of(data, write=data.written_too)
        table["status"] = bearing.status
    else:
        table["stiffness"] = stiffness_entries(bearing.matrix)
    if bearing.housing is not None:
        table["housing"] = _elastic(bearing.housing)
    words = ["name", "y", "seat_width", "matrix", "catalogue", "housing", "hold", "face", "patch"]
    # what is held is rigid where nothing is written, and the mean of a face no default
    write = ("attachment",) if bearing.hold is not None or bearing.face is not None else ()
    return table_of(bearing, leave_out=(*words, *table), write=write) | table


def _port(scene: Scene, port: Port) -> Table:
    place: Table = {"position": port.y, "span": [port.lo, port.hi]}
    if port.patch is not None:
        place = _on_patch(scene.body, port.patch)
    return {
        "name": port.name,
        **place,
        **table_of(port, leave_out=("name", "y", "lo", "hi", "patch")),
    }


def _on_patch(body: Any, patch: Patch) -> Table:
    """Return the words for a place on faces of a body without an axis."""
    usual = {p.name: p for p in body.patches}[patch.name]
    if patch == usual:
        return {"patch": patch.name}
    return {"patch": patch.name, "point": list(body.in_file(patch.point))}


def _mass(mass: PointMass) -> Table:
    table = table_of(mass, leave_out=("y",))
    return table if mass.on is not None else {**table, "position": mass.y}


def _load(load: ShaftLoad) -> Table:
    table = table_of(load, leave_out=("lo", "hi"))
    return table if load.seat is None else {**table, "span": [load.lo, load.hi]}


def _feature(feature: Any, place: Table | None = None) -> Table:
    table = table_of(feature, leave_out=("y",), write=("kind",))
    if place is None and hasattr(feature, "y"):
        place = {"position": feature.y, "from": "start"}
    return table | (place or {})


def _housing(scene: Scene) -> Table | None:
    if scene.housing is not None:
        return {"position": scene.housing.y, "stiffness": scene.housing.entries}
    return None if scene.housing_axial is None else {"axial": scene.housing_axial}


def _elastic(support: Elastic) -> Table:
    """Return the table of the housing of one bearing."""
    if entries := support.entries:
        return dict(entries)
    return {"matrix": np.zeros((6, 6)).tolist(), "rigid": list(support.rigid)}
