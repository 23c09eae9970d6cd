"""Trains of a sweep: the file of a train, and those of its shafts, with entries replaced."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core.errors import SolidgearError, listed
from solidgear.core.loading import scene_of
from solidgear.core.scene import Scene
from solidgear.core.scene.file import KEYS
from solidgear.core.scene.paths import Tables, with_entry
from solidgear.core.scene.toml_file import parse
from solidgear.trains.assembly.layout import contacts
from solidgear.trains.file.housing import HOUSING
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.reading import train_of
from solidgear.trains.file.train import SHORT, SIDES, Train
from solidgear.trains.load.operation import named_point
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.entries import Entry, Place
from solidgear.variants.sweep.file_variants import OWN, POINT, FileVariants

#: table of operating points
OPERATION = "operation"
#: scenes that are kept
KEPT = 500


@dataclass(frozen=True)
class TrainVariants(FileVariants[Train]):
    """Points of a sweep of a train; bearings that settle with it have no stiffness yet.

    Attributes
    ----------
    files : mapping of str to mapping
        Tables by side, those of the train by an empty name.
    entries : tuple of Entry
        What varies; the last may be the operating points of the file.
    """

    #: operating point that is looked at, by its name or number; the first by default
    point: str | None = None
    _scenes: dict[tuple, Scene] = field(default_factory=dict, repr=False, compare=False)

    def at(self, index: int, train: Train) -> OperatingPoint | None:
        """Operating point at which a variant is looked at; None of a train without any."""
        if not train.operation and self.point is None:
            return None
        if self.entries[-1].label == POINT:
            return train.operation[int(self.values[index, -1])]
        return train.operation[0] if self.point is None else named_point(train, self.point)

    def beside_operation(self, index: int) -> tuple[float, ...]:
        """Values of all that is no operating point."""
        row = _ranked(self.values[index]).tolist()
        return tuple(v for one, v in zip(self.entries, row) if not _of_operation(one))

    def in_turn(self, numbers: Iterable[int]) -> list[int]:
        """Variants in an order in which those of the same shafts stand together, and operating points
        of the same train.
        """
        dear = {side: k for k, side in enumerate((*(f for f in self.files if f != OWN), OWN))}
        ranks = [len(dear) if _of_operation(one) else dear[one.file] for one in self.entries]
        order = np.argsort(ranks, kind="stable")
        return sorted(numbers, key=lambda k: (*_ranked(self.values[k, order]).tolist(), k))

    def scenes_in_turn(self) -> Iterator[tuple[str, Tables]]:
        """Tables of the scenes that a shaft has in turn, by the names of their files."""
        for one in self.entries:
            if one.file == OWN and one.keys[-1] == "scene":
                for word in one.words:
                    yield str(word), parse(str(self.path.parent / str(word)))

    def tried(self, index: int) -> Train:
        train = self.of(index)
        self.at(index, train)
        contacts(train)
        return train

    def read(self, varied: Sequence[Entry], row: Sequence[float]) -> Train:
        def of_side(side: str, path: Path, alone: bool) -> Scene:
            key = (
                side,
                str(path),
                alone,
                *(repr(v) for one, v in zip(varied, row) if one.is_in(side)),
            )
            if key not in self._scenes:
                if len(self._scenes) >= KEPT:
                    self._scenes.clear()
                usual = path == self.path.parent / str(shafts_in(self.files[OWN])[side]["scene"])
                tables = self.put(side, varied, row, None if usual else parse(str(path)))
                self._scenes[key] = scene_of(tables, path, alone)
            return self._scenes[key]

        own = self.put(OWN, varied, row)
        return train_of(own, str(self.path), of_side)


def train_variants(
    path: Path,
    design: Design,
    *,
    point: str | None = None,
    every_point: bool = False,
    local_harmonics: Sequence[int] = (),
) -> TrainVariants:
    """Points of a sweep of a train, as :func:`solidgear.variants.sweep.train_task.train_task` has
    them.
    """
    own = parse(str(path))
    if isinstance(own.get("mesh"), list):
        own["mesh"] = [*map(_named, own["mesh"])]
    shafts, many = shafts_in(own), "shaft" in own
    files = {OWN: own} | {side: _scene(path, table) for side, table in shafts.items()}

    def points(varied: tuple[Entry, ...]) -> tuple[Entry, ...]:
        return (_every_point(own, varied, point),) if every_point else ()

    varied, values, kept = design.points(
        files,
        partial(_owner, [*shafts], many, HOUSING in own),
        points,
        example="mesh.stiffness=log:1e8 N/m:1e9 N/m:5",
    )
    at = point or _varied_point(own, varied)
    if local_harmonics:
        meshes = own.get("mesh")
        places = [(k,) for k in range(len(meshes))] if isinstance(meshes, list) else [()]
        for place in places:
            keys = ("mesh", *place, "local_harmonics")
            files[OWN] = with_entry(files[OWN], keys, list(local_harmonics))
    return TrainVariants(path, files, varied, values, kept, design, at)


def shafts_in(own: Tables) -> dict[str, Any]:
    """Tables of the shafts of a train file, by name; whatever is wrong with them its reader tells."""
    found = own.get("shaft", {side: own.get(side) for side in SIDES})
    return dict(found) if isinstance(found, Mapping) else {}


def _named(mesh: Any) -> Any:
    """A mesh of several with the name that it has without one."""
    between = mesh.get("between") if isinstance(mesh, Mapping) else None
    if not isinstance(between, list) or mesh.get("name"):
        return mesh
    return {**mesh, "name": "-".join(str(end).partition(".")[0] for end in between)}


def _scene(path: Path, table: Any) -> Tables:
    """Tables of the scene of a shaft; none where the train file does not name it, which its own
    reader tells.
    """
    name = table.get("scene") if isinstance(table, Mapping) else None
    return parse(str(path.parent / name)) if isinstance(name, str) else {}


def _owner(shafts: Sequence[str], many: bool, housed: bool, path: str) -> tuple[str, str]:
    """The scene of a shaft owns the keys of scenes, the train file all others."""
    if many:
        path = path.removeprefix("shaft.")
    first, _, within = path.partition(".")
    if first in shafts and within.partition(".")[0] in KEYS:
        return first, within
    if many and first in shafts:
        return OWN, f"shaft.{path}"
    of_train = {*Train.model_fields, *shafts, *SHORT, "mesh"} - ({HOUSING} if not housed else set())
    if first in KEYS and first not in of_train:
        raise SolidgearError(
            f"--vary {path}: is of the scene of a shaft; say of which: "
            + " or ".join(f"{side}.{path}" for side in shafts)
        )
    return OWN, path


def _points(own: Tables) -> list[Any]:
    table = own.get(OPERATION, [])
    return table if isinstance(table, list) else [table]


def _every_point(own: Tables, varied: Sequence[Entry], point: str | None) -> Entry:
    """The operating points of a file as what varies."""
    if point is not None or any(map(_of_operation, varied)):
        raise SolidgearError("every operating point is looked at: give no --point and vary none")
    points = _points(own)
    if not points:
        raise SolidgearError("the file has no operating point; write [operation] with a torque")
    names = [str(one.get("name", k)) for k, one in enumerate(points, start=1)]
    if len(set(names)) < len(names):
        names = [str(k) for k in range(1, len(points) + 1)]
    values = tuple(map(float, range(len(points))))
    return Entry(
        label=POINT,
        places=(Place(OWN, OPERATION, (OPERATION,)),),
        values=values,
        spacing="list",
        words=tuple(names),
    )


def _varied_point(own: Tables, varied: Sequence[Entry]) -> str | None:
    """The operating point that varies, by its number; None where none does."""
    if len(_points(own)) < 2:
        return None
    torques = [one for one in varied if _of_operation(one) and one.label != POINT]
    numbers = {one.keys[1] for one in torques}
    if len(numbers) > 1:
        named = listed(one.label for one in torques)
        raise SolidgearError(
            f"{named} are of several operating points; say by --point which is told"
        )
    return str(int(numbers.pop()) + 1) if numbers else None


def _of_operation(one: Entry) -> bool:
    return one.file == OWN and one.keys[0] == OPERATION


def _ranked(values: np.ndarray) -> np.ndarray:
    """Values that can be compared: what stays as it is in the file before all others."""
    return np.where(np.isnan(values), -np.inf, values)
