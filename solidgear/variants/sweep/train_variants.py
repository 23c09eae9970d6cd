"""Variants of the file of a train and of the scenes of its shafts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core import Document, Scene, SolidgearError, Source, document_of, listed
from solidgear.core.loading import scene_of
from solidgear.core.scene.file import KEYS
from solidgear.core.scene.paths import Tables, with_entry
from solidgear.trains.assembly.layout import contacts
from solidgear.trains.file.housing import HOUSING
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.reading import train_of
from solidgear.trains.file.train import SHORT, SIDES, Train
from solidgear.trains.load.operation import named_point
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.entries import Entry, Place
from solidgear.variants.sweep.file_variants import MAIN, POINT, FileVariants
from solidgear.variants.sweep.following import followers_of, list_in

#: table of operating points
OPERATION = "operation"
#: scenes that are kept
SCENES = 500
#: keys of gears on which nothing but the contact of their teeth depends
FLANK_SHAPES = {"relief", "crowning", "helix_slope", "measured_flank"}


@dataclass(frozen=True)
class TrainVariants(FileVariants[Train]):
    """Points of a sweep of a train; bearings that settle with it have no stiffness yet. Files are named
    by side, that of the train by an empty name; the last entry may be the operating points. A scene
    within the train is one more file, called as its shaft.
    """

    #: operating point of all rows, by its name or number; the first by default
    point: str | int | None = None
    _scenes: dict[tuple, Scene] = field(default_factory=dict, repr=False, compare=False)

    def operating_point(self, index: int, train: Train) -> OperatingPoint | None:
        """Return the operating point of a variant; None for a train without any."""
        if not train.operation and self.point is None:
            return None
        if self.entries[-1].label == POINT:
            place = self.values[index, -1]
            return train.operation[0 if np.isnan(place) else int(place)]
        return train.operation[0] if self.point is None else named_point(train, self.point)

    def beside_flanks(self, index: int) -> tuple[float, ...]:
        """Return the values of all entries that are neither of an operating point nor of the shapes of
        flanks.
        """
        row = _ranked(self.values[index]).tolist()
        return tuple(
            value
            for entry, value in zip(self.entries, row)
            if not (_of_operation(entry) or _of_flanks(entry))
        )

    def in_turn(self, numbers: Iterable[int]) -> list[int]:
        """Return variants in an order in which those of the same shafts stand together, and operating
        points of the same train.
        """
        sides = [file for file in self.files if file != MAIN]
        cost = {file: k for k, file in enumerate((*sides, MAIN))}
        ranks = [len(cost) if _of_operation(entry) else cost[entry.file] for entry in self.entries]
        order = np.argsort(ranks, kind="stable")
        return sorted(numbers, key=lambda k: (*_ranked(self.values[k, order]).tolist(), k))

    def scenes_in_turn(self) -> Iterator[tuple[str, Tables]]:
        """Yield the tables of the scenes that a shaft has in turn, by the names of their files."""
        for entry in self.entries:
            if entry.file == MAIN and entry.keys[-1] == "scene":
                for word in entry.words:
                    yield str(word), document_of(self.path.parent / str(word)).tables

    def checked_variant(self, index: int) -> Train:
        train = self.variant(index)
        self.operating_point(index, train)
        contacts(train)
        return train

    def read(self, varied: Sequence[Entry], row: Sequence[float]) -> Train:
        def of_side(side: str, source: Path | Document, alone: bool) -> Scene:
            # with tables come the list of bearings of the train
            given = source.tables if isinstance(source, Document) else {}
            path = Path(source.path) if isinstance(source, Document) else source
            of_train = {key: given[key] for key in ("bearings",) if key in given}
            key = (
                side,
                str(path),
                alone,
                *(repr(value) for entry, value in zip(varied, row) if entry.is_in(side)),
            )
            if key not in self._scenes:
                if len(self._scenes) >= SCENES:
                    self._scenes.clear()
                usual = path == self.path.parent / str(shafts_in(self.files[MAIN])[side]["scene"])
                other = None if usual else document_of(path).tables
                tables = {**of_train, **self.put(side, varied, row, other)}
                scene = scene_of(tables, path, alone)
                self._scenes[key] = self.fitting(side, tables, scene)
            return self._scenes[key]

        return train_of(self.put(MAIN, varied, row), str(self.path), of_side)


def train_variants(
    train: Source,
    design: Design,
    *,
    point: str | int | None = None,
    every_point: bool = False,
    local_harmonics: Sequence[int] = (),
) -> TrainVariants:
    """Return the points of a sweep of a train; parameters as of :func:`solidgear.sweep`."""
    document = document_of(train)
    tables, path = document.tables, Path(document.path)
    if isinstance(meshes := tables.get("mesh"), list):
        tables = {**tables, "mesh": [*map(_with_name, meshes)]}
    shafts, many = shafts_in(tables), "shaft" in tables
    files = {side: _scene(path, table) for side, table in shafts.items()}
    for side, table in shafts.items():
        if isinstance(table, Mapping) and isinstance(table.get("scene"), Mapping):
            keys = ("shaft", side) if many else (side,)
            tables = with_entry(tables, (*keys, "scene"), side)
    files = {MAIN: tables} | files

    def points(varied: tuple[Entry, ...]) -> tuple[Entry, ...]:
        return (_every_point(tables, varied, point),) if every_point else ()

    owner = partial(_owner, [*shafts], many, HOUSING in tables)
    design_points = design.points(
        files, owner, points, example="mesh.stiffness=log:1e8 N/m:1e9 N/m:5"
    )
    varied = design_points.entries
    point = point or _varied_point(tables, varied)
    if local_harmonics:
        meshes = tables.get("mesh")
        places = [(k,) for k in range(len(meshes))] if isinstance(meshes, list) else [()]
        for place in places:
            keys = ("mesh", *place, "local_harmonics")
            files[MAIN] = with_entry(files[MAIN], keys, list(local_harmonics))

    def path_of_side(side: str) -> Path:
        scene = shafts[side]["scene"]
        return path.parent / scene if isinstance(scene, str) else path

    def list_of_side(side: str) -> Path | None:
        listed_in = list_in(files[side], path_of_side(side).parent)
        return listed_in or list_in(tables, path.parent)

    def scene_of_side(side: str) -> Scene:
        listed_in = list_of_side(side)
        of_train = {} if listed_in is None else {"bearings": str(listed_in.resolve())}
        return scene_of({**files[side], **of_train}, path_of_side(side), False)

    followers = followers_of(varied, files, owner, scene_of_side, list_of_side, design.follow)
    return TrainVariants(
        path, files, varied, design_points.values, design_points.sums, design, followers, point
    )


def shafts_in(tables: Tables) -> dict[str, Any]:
    """Return the tables of the shafts of a train file, by name; their reader refuses wrong ones."""
    shafts = tables.get("shaft", {side: tables.get(side) for side in SIDES})
    return dict(shafts) if isinstance(shafts, Mapping) else {}


def _with_name(mesh: Any) -> Any:
    """Return a mesh of several with the name that it has without one."""
    between = mesh.get("between") if isinstance(mesh, Mapping) else None
    if not isinstance(between, list) or mesh.get("name"):
        return mesh
    return {**mesh, "name": "-".join(str(end).partition(".")[0] for end in between)}


def _scene(path: Path, table: Any) -> Tables:
    """Return the tables of the scene of a shaft, of a file of its own or within those of the train;
    none where the train does not name it, which its reader refuses.
    """
    scene = table.get("scene") if isinstance(table, Mapping) else None
    if isinstance(scene, str):
        return document_of(path.parent / scene).tables
    return scene if isinstance(scene, Mapping) else {}


def _owner(shafts: Sequence[str], many: bool, housed: bool, path: str) -> tuple[str, str]:
    """Return the file of a path and the path within: keys of scenes are in that of the shaft."""
    if many:
        path = path.removeprefix("shaft.")
    first, _, within = path.partition(".")
    if first in shafts and within.partition(".")[0] in KEYS:
        return first, within
    if many and first in shafts:
        return MAIN, f"shaft.{path}"
    of_train = {*Train.model_fields, *shafts, *SHORT, "mesh"} - ({HOUSING} if not housed else set())
    if first in KEYS and first not in of_train:
        raise SolidgearError(
            f"`vary` {path}: belongs to the scene of a shaft; say which: "
            + " or ".join(f"{side}.{path}" for side in shafts)
        )
    return MAIN, path


def _points(tables: Tables) -> list[Any]:
    table = tables.get(OPERATION, [])
    return table if isinstance(table, list) else [table]


def _every_point(tables: Tables, varied: Sequence[Entry], point: str | int | None) -> Entry:
    """Return the operating points of a file as an entry that varies."""
    if point is not None or any(map(_of_operation, varied)):
        raise SolidgearError(
            "`every_point` takes every operating point: give no `point` and vary none"
        )
    points = _points(tables)
    if not points:
        raise SolidgearError("the file has no operating point; write [operation] with a torque")
    names = [str(table.get("name", k)) for k, table in enumerate(points, start=1)]
    if len(set(names)) < len(names):
        names = [str(k) for k in range(1, len(points) + 1)]
    values = tuple(map(float, range(len(points))))
    return Entry(
        label=POINT,
        places=(Place(MAIN, OPERATION, (OPERATION,)),),
        values=values,
        spacing="list",
        words=tuple(names),
    )


def _varied_point(tables: Tables, varied: Sequence[Entry]) -> str | None:
    """Return the operating point that varies, by its number; None where none does."""
    if len(_points(tables)) < 2:
        return None
    torques = [entry for entry in varied if _of_operation(entry) and entry.label != POINT]
    numbers = {entry.keys[1] for entry in torques}
    if len(numbers) > 1:
        labels = listed(entry.label for entry in torques)
        raise SolidgearError(f"{labels} are in several operating points; choose one by `point`")
    return str(int(numbers.pop()) + 1) if numbers else None


def _of_operation(entry: Entry) -> bool:
    return entry.file == MAIN and entry.keys[0] == OPERATION


def _of_flanks(entry: Entry) -> bool:
    """Return True for an entry of the shapes of flanks alone."""
    return all(FLANK_SHAPES & {*map(str, place.keys)} for place in entry.places)


def _ranked(values: np.ndarray) -> np.ndarray:
    """Return values that can be compared: that of the file before all others."""
    return np.where(np.isnan(values), -np.inf, values)
