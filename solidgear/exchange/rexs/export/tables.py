"""Tables of trains in the form in which a REXS document gives them: every gear by its lumped point."""

from __future__ import annotations

from typing import Any

from solidgear.trains.file.train import Train


def train_tables(train: Train) -> dict[str, Any]:
    """Return the tables of a train, with gears by lumped points and both gears of a mesh."""
    tables = train.to_dict()
    for name, table in tables["shaft"].items():
        shaft = train.shafts[name]
        gears = table.pop("gears", None)
        if gears is None:
            port = shaft.scene.port.name
            rest = {"scene", "scene_load", "matrices", "apex"} & {*table}
            gears = {port: {k: table.pop(k) for k in [*table] if k not in rest}}
        tables["shaft"][name] = table | ({"gears": gears} if gears else {})
    for mesh, table in zip(train.meshes, tables.get("mesh", ())):
        table["between"] = [*mesh.between]
    return tables
