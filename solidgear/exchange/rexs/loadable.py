"""Whether the files that are made of a REXS document can be loaded, before any is written."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from solidgear.core import SceneError
from solidgear.exchange.rexs.commented import Sourced
from solidgear.exchange.rexs.importing import Imported


def with_loadable(gearbox: Imported, source: str) -> Imported:
    """Return files that can be loaded, without the scenes of shafts outside the train of which none
    can be made, which are noted.

    Parameters
    ----------
    gearbox : Imported
    source : str
        The REXS file, as errors name it.

    Raises
    ------
    SceneError
        What keeps the train, or all shafts, from being loaded: each problem with the component and the
        attribute that its value came from.
    """
    from solidgear.core.scene.file import load  # start-up: for files that are made
    from solidgear.trains.file.reading import load_train  # start-up: as above

    files = dict(gearbox.files)
    first = next(iter(files))
    inside = _scenes_of(gearbox.tables[first]) if gearbox.has_train else set()
    refused: dict[str, SceneError] = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            (Path(folder) / name).write_text(text, encoding="utf-8")
        for name in files:
            if name in inside:
                continue
            read = load_train if gearbox.has_train and name == first else load
            try:
                read(Path(folder) / name)
            except SceneError as error:
                refused[name] = error
    if (gearbox.has_train and first in refused) or len(refused) == len(files):
        raise _in_document(refused[first], gearbox, source)
    for name, reason in refused.items():
        problem = _in_document(reason, gearbox, "").problems[0]
        gearbox.notes.drop(name, f"no scene can be made of it ({problem.sentence})")
    kept = {name: text for name, text in files.items() if name not in refused}
    return replace(gearbox, files=kept) if refused else gearbox


def _scenes_of(train: Mapping[str, Any]) -> set[str]:
    return {str(table["scene"]) for table in train["shaft"].values()}


def _in_document(error: SceneError, gearbox: Imported, source: str) -> SceneError:
    """Return an error whose problems name attributes of the document in place of keys of the files
    that are made of it, where an attribute gave the value.
    """
    problems = []
    for problem in error.problems:
        name = Path(problem.where or error.where).name
        tables = gearbox.tables.get(name, {})
        origin = _origin(tables, problem.path)
        place = f"{origin} ({problem.field})" if origin else f"{name}: {problem.field}"
        problems.append(SceneError(problem.reason, field=place, value=problem.value, where=source))
    return SceneError.of(problems)


def _origin(tables: Any, path: tuple) -> str:
    """Return where the value at a path came from; empty where nothing says."""
    origin = ""
    for key in path:
        if isinstance(tables, Sourced):
            origin, tables = tables.source, tables.value
        try:
            tables = tables[key]
        except (LookupError, TypeError):
            break
    return tables.source if isinstance(tables, Sourced) else origin
