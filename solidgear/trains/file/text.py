"""Text of the file of a train: its own where it was read from one, with what has changed since."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from solidgear.core.scene import rewriting
from solidgear.trains.file.reading import train_of
from solidgear.trains.file.train import SIDES, Train
from solidgear.trains.file.writing import tables_of

Table = dict[str, Any]


def toml_of(train: Train, path: str | os.PathLike | None = None) -> str:
    """Return the text of the file of a train, and write it to a path if one is given."""
    document = train.document
    short = train.short and document is not None and "shaft" not in document.tables

    def canonical(tables: Mapping[str, Any], path: str) -> Table:
        return _in_form(tables_of(train_of(tables, path)), short)

    return rewriting.toml_of(document, path, canonical, _in_form(tables_of(train), short))


def _in_form(tables: Table, short: bool) -> Table:
    """Return the tables of a train without stiffness at load, with [pinion] and [gear] if short."""
    tables = _unsettled(tables)
    if not short:
        return tables
    shafts, (mesh,) = tables.pop("shaft"), tables.pop("mesh")
    mesh = {key: value for key, value in mesh.items() if key != "between"}
    return {**tables, **{side: shafts[side] for side in SIDES}, "mesh": mesh}


def _unsettled(tables: Table) -> Table:
    """Return the tables of a train whose bearings settle when it is read."""
    for shaft in tables["shaft"].values():
        for bearing in shaft["scene"].get("bearing", ()):
            bearing.pop("settled", None)
    return tables
