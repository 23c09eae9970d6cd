"""The list of bearings that a scene file names."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from solidgear.bearings.bearing_list import read_list, with_listed
from solidgear.bearings.catalogue import Catalogue
from solidgear.core import SceneError, show


def complete(tables: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Return the tables of a scene with catalogue data from the list that the key ``bearings`` names,
    where a designation is in it; what the scene gives itself holds.
    """
    out = dict(tables)
    name = out.get("bearings")
    bearings = out.get("bearing")
    if name is None or not isinstance(bearings, list):
        return out
    listed = read_list(os.fspath(path_of_list(name, folder)), Catalogue)
    out["bearing"] = [_completed(table, listed) for table in bearings]
    return out


def path_of_list(name: Any, folder: Path) -> Path:
    """Return the path of a list that a file in a folder names; refuse what is no file."""
    if not isinstance(name, str):
        reason = 'names the file of a list of bearings, such as "my_bearings.csv"'
        raise SceneError(reason, path=("bearings",), value=show(name))
    path = folder / name
    if not path.is_file():
        reason = "there is no such file; name a list of bearings (CSV), beside this file"
        raise SceneError(reason, path=("bearings",), value=show(name))
    return path


def _completed(table: Any, listed: Mapping[str, Mapping[str, Any]]) -> Any:
    """Return the table of a bearing with the data of a list."""
    data = table.get("catalogue") if isinstance(table, Mapping) else None
    if not isinstance(data, Mapping):
        return table
    return {**table, "catalogue": with_listed(data, listed)}
