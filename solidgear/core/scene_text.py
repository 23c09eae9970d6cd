"""Text of the file of a scene: its own where it was read from one, with what has changed since."""

from __future__ import annotations

import os
import tomllib
from typing import Any

from solidgear.core.errors import SceneError
from solidgear.core.loading import part_of, scene_of
from solidgear.core.machine.whole_file import write_page
from solidgear.core.scene import file
from solidgear.core.scene.model import Scene
from solidgear.core.scene.rewriting import NOWHERE, Canonical, text_of
from solidgear.core.scene.writing import tables_of, unsettled_tables


def toml_of(scene: Scene, path: str | os.PathLike | None = None) -> str:
    """Return the text of the file of a scene, and write it to a path if one is given."""
    document = scene.document
    place = os.fspath(path or NOWHERE)
    text = text_of(document, path, _canonical(), unsettled_tables(scene))
    if any(bearing.catalogue is not None for bearing in scene.bearings):
        text = _settled(text, place, scene)
    if path is not None:
        write_page(path, text)
    return text


def _canonical() -> Canonical:
    """Return the reader of canonical tables, which reads the part of a scene once."""
    parts: dict[tuple[str, str], Any] = {}

    def part(table: Any, folder: Any) -> Any:
        key = (repr(table), str(folder))
        if key not in parts:
            parts[key] = part_of(table, folder)
        return parts[key]

    return lambda tables, path: unsettled_tables(file.scene_of(dict(tables), path, part))


def _settled(text: str, path: str, scene: Scene) -> str:
    """Return the text with the stiffness of catalogue bearings where reading it would give another."""
    import tomlkit  # start-up: not every scene is written

    try:
        bearings = scene_of(tomllib.loads(text), path).bearings
        if bearings in (scene.bearings, scene.settled.bearings):
            return text
    except SceneError:
        pass  # nothing to settle at
    settled = {table["name"]: table.get("settled") for table in tables_of(scene)["bearing"]}
    parsed = tomlkit.parse(text)
    for table in parsed["bearing"]:
        if settled[table["name"]] is not None:
            table["settled"] = settled[table["name"]]
    return tomlkit.dumps(parsed)
