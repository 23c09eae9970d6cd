"""A scene or a train as a REXS document that reads back equal."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.bearings.catalogue import Catalogue
from solidgear.core import Document as SourceDocument
from solidgear.core import Scene, SolidgearError, addition, document_of
from solidgear.core.machine.whole_file import write_files
from solidgear.exchange.rexs.commented import plain
from solidgear.exchange.rexs.document import Document
from solidgear.exchange.rexs.export.parts import Parts
from solidgear.exchange.rexs.export.shafts import add_points, add_shaft, forces
from solidgear.exchange.rexs.export.tables import train_tables
from solidgear.exchange.rexs.export.trains import TrainParts
from solidgear.exchange.rexs.importing import imported
from solidgear.exchange.rexs.rest import lost, rest_of, rest_text
from solidgear.exchange.rexs.units import REST
from solidgear.exchange.rexs.writing import bytes_of
from solidgear.trains.file.reading import train_of
from solidgear.trains.file.train import Train

#: sources of the stiffness of catalogue bearings, which follow from what is known of their inside
FOLLOWS = ("estimated", "calculated")


@dataclass(frozen=True)
class Exported:
    """A document, and what REXS has no place for, by the name of the component."""

    document: Document
    without_place: tuple[tuple[str, tuple[str, ...]], ...]

    @property
    def lines(self) -> list[str]:
        """What REXS has no place for, a component a line."""
        return [f"{name}: {', '.join(keys)}" for name, keys in self.without_place]


def write_rexs(source: Any, path: str | os.PathLike) -> Exported:
    """Write the REXS file of a scene or a train, whole or not at all, by the ending of its name."""
    file = Path(path)
    result = exported(read_source(source))
    write_files({file: bytes_of(result.document, file)})
    return result


def read_source(source: Any) -> Scene | Train:
    """Return a scene or a train as it is written: REXS has bearings, and no stiffness that follows."""
    if isinstance(source, (Scene, Train)):
        return source
    if not isinstance(source, (str, os.PathLike, Mapping, SourceDocument)):
        raise SolidgearError(
            f"{type(source).__name__} is no gearbox; give a file, its tables, a scene or a train"
        )
    document = document_of(source)
    if not document.describes_train:
        read = addition("document", "read scene")
        return read(document.tables, document.path, alone=False).read_from(document)
    return train_of(document.tables, document.path).read_from(document)


def exported(source: Scene | Train) -> Exported:
    """Return the document of a scene or a train.

    What REXS has no place for stands in an attribute of the shaft, or of the gear unit, that other
    programs pass over.
    """
    if isinstance(source, Scene):
        return _of_scene(source)
    if source.is_one_shaft:
        return _of_scene(next(iter(source.shafts.values())).scene)
    return _of_train(source)


def _of_scene(scene: Scene) -> Exported:
    parts = Parts()
    shaft = add_shaft(parts, scene.name, scene, np.zeros(3), np.eye(3))
    points = add_points(parts, shaft, scene, ())
    due = scene.to_dict()
    _leave_settled_out(due)
    # loads at several places stand beside what REXS has
    load = {} if scene.loads else due.get("load", {})
    parts.write(points[scene.port.name], **forces(load))
    parts.write(parts.unit, **{REST: "{}"})
    tables = plain(next(iter(imported(parts.document(), scene.name).tables.values())))
    rest = rest_of(tables, due, _usual)
    parts.write(shaft, **{REST: rest_text(rest)})
    return Exported(parts.document(), _listed(lost(rest, scene.name)))


def _of_train(train: Train) -> Exported:
    made = TrainParts(train)
    parts, due = made.parts, train_tables(train)
    scenes = {name: due["shaft"][name].pop("scene") for name in train.shafts}
    for scene in scenes.values():
        _leave_settled_out(scene)
    parts.write(parts.unit, **{REST: "{}"})
    files = plain(imported(parts.document(), train.name).tables)
    tables = files.pop(next(iter(files)))
    rows: list[tuple[str, list[str]]] = []
    for name, table in due["shaft"].items():
        table["scene"] = f"{name}.toml"
        rest = rest_of(files[f"{name}.toml"], scenes[name], _usual)
        rows += lost(rest, name)
        parts.write(made.shafts[name], **{REST: rest_text(rest)})
    rest = rest_of(tables, due, _usual)
    rows += lost(rest, train.name)
    parts.write(parts.unit, **{REST: rest_text(rest)})
    return Exported(parts.document(), _listed(rows))


def _leave_settled_out(tables: Mapping[str, Any]) -> None:
    """Leave the stiffness of catalogue bearings out: what is read settles again."""
    for bearing in tables.get("bearing", ()):
        bearing.pop("settled", None)


def _listed(rows: Any) -> tuple[tuple[str, tuple[str, ...]], ...]:
    return tuple((name, tuple(keys)) for name, keys in rows)


def _usual(tables: Any, due: Mapping[str, Any]) -> dict[str, Any]:
    """Return the entries that a table has without a word: of catalogue bearings, what follows from
    their designation.
    """
    if "catalogue" in due and due.get("status") in FOLLOWS:
        return {"status": due["status"]}
    if "designation" not in tables:
        return {}
    try:
        return Catalogue(**tables).model_dump(exclude_none=True)
    except (SolidgearError, ValueError):
        return {}
