"""From a `Train` to the tables of a file, which read back equal: the inverse of
:mod:`solidgear.trains.file.reading`.

Scenes of shafts stand inside, and so do the numbers of files of columns; names of other files are
full paths.
"""

from __future__ import annotations

from typing import Any

from solidgear.core import Scene
from solidgear.core.scene.bearing_stiffness import stiffness_entries
from solidgear.core.scene.model_table import entry_of, table_of
from solidgear.trains.file.gears import Shaft
from solidgear.trains.file.housing import HOUSING, TrainHousing
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.shafting import Shafting
from solidgear.trains.file.tables import TrainAsk

Table = dict[str, Any]


def tables_of(train: Any) -> Table:
    """Return the tables of a file that describes a train."""
    tables: Table = {
        "title": train.title,
        "name": train.name,
        "source": train.source,
        "shaft": {
            name: _shaft(shaft, settles_with_train=bool(train.operation))
            for name, shaft in train.shafts.items()
        },
        "mesh": entry_of(train.meshes),
        "planetary": entry_of(train.planetary),
        **_rotors(train),
        "losses": entry_of(train.losses),
        HOUSING: _housing(train.housing),
        "operation": [point_table(point) for point in train.operation],
        "ask": _ask(train.ask),
    }
    return {key: value for key, value in tables.items() if key == "name" or value}


def point_table(point: OperatingPoint) -> Table:
    """Return the table of an operating point."""
    # a train without the name of the shaft would put the torque on that of its engine
    return table_of(point, write=("of",))


def _shaft(shaft: Shaft, settles_with_train: bool) -> Table:
    """Return the table of a shaft, a single gear at its main lumped point without one of its own."""
    table: Table = {"scene": _scene(shaft.scene, settles_with_train)}
    if [*shaft.gears] == [shaft.scene.port.name]:
        table |= entry_of(shaft.gears[shaft.scene.port.name])
    else:
        table["gears"] = entry_of(shaft.gears)
    if shaft.matrices is not None:
        table |= shaft.matrices.to_dict()
    return table | table_of(shaft, leave_out=("scene", "gears", "matrices"))


def _scene(scene: Scene, settles_with_train: bool) -> Table:
    tables = scene.to_dict()
    for bearing in tables.get("bearing", ()) if settles_with_train else ():
        bearing.pop("settled", None)
    return tables


def _rotors(train: Shafting) -> Table:
    """Return the tables of engines, loads and other rotors, by name."""
    tables: Table = {"engine": {}, "load": {}, "rotor": {}}
    for name, rotor in train.rotors.items():
        kind = "engine" if name in train.engines else "load" if name in train.loads else "rotor"
        tables[kind][name] = entry_of(rotor)
    # a single one needs no name
    return {kind: table[kind] if [*table] == [kind] else table for kind, table in tables.items()}


def _housing(housing: TrainHousing | None) -> Table | None:
    if housing is None:
        return None
    rigid = ("mass", "inertia", "centre", "points")
    table = table_of(housing, leave_out=("matrices", *(rigid if housing.matrices else ())))
    if housing.matrices is not None:
        table |= housing.matrices.to_dict()
    for mount_table, mount in zip(table.get("mount", ()), housing.mounts):
        mount_table["stiffness"] = stiffness_entries(mount.stiffness)
    return table


def _ask(ask: TrainAsk) -> Table:
    # studies take their own range where a file gives none
    return table_of(ask, write=ask.model_fields_set)
