"""Trains of a sweep: the file of a train, and those of its shafts, with entries replaced."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.bearings.solved import solved
from solidgear.errors import SceneError, SolidgearError, listed
from solidgear.scene import Scene
from solidgear.scene.file import KEYS, scene_of
from solidgear.scene.operation import OperatingPoint
from solidgear.scene.paths import Keys, Tables, changed
from solidgear.scene.toml_file import parse
from solidgear.scene.train import SIDES, Train
from solidgear.scene.train_file import train_of
from solidgear.studies.loading import explained, part_of, shaft
from solidgear.studies.sweep.entries import Entry, entries_of, hinted, put_in
from solidgear.studies.sweep.vary import product, sample
from solidgear.studies.train.contact import contact
from solidgear.studies.train.operation import named_point

#: name of the train's own file among those of its shafts
OWN = ""
#: table of operating points, and the label of those of a file where each has a row
OPERATION, POINT = "operation", "point"
#: variants that are looked at for one that the rules of the files let pass
LOOKED = 2000
#: scenes that are kept
KEPT = 500


@dataclass(frozen=True)
class TrainVariants:
    """Points of a sweep of a train.

    Attributes
    ----------
    path : Path
        Of the train file.
    files : mapping of str to mapping
        Tables by side, those of the train by an empty name.
    entries : tuple of Entry
        What varies; the last may be the operating points of the file.
    values : (n, len(entries)) ndarray
    point : str or None
        Operating point that is looked at, by its name or number; the first by default.
    """

    path: Path
    files: Mapping[str, Tables]
    entries: tuple[Entry, ...]
    values: np.ndarray
    point: str | None = None
    _scenes: dict[tuple, Scene] = field(default_factory=dict, repr=False, compare=False)

    def __len__(self) -> int:
        return len(self.values)

    def told(self, index: int) -> dict[str, str | float]:
        """Values that vary, by their labels."""
        return {one.label: one.told(v) for one, v in zip(self.entries, self.values[index].tolist())}

    def train(self, index: int) -> Train:
        """Train of one variant as it would be read from its files: bearings that settle with it have
        no stiffness yet.

        Raises
        ------
        SceneError
            If files with these values would be refused.
        """
        return self._read(self.entries, self.values[index].tolist())

    def at(self, index: int, train: Train) -> OperatingPoint | None:
        """Operating point at which a variant is looked at; None of a train without any."""
        if not train.operation and self.point is None:
            return None
        if self.entries[-1].label == POINT:
            return train.operation[int(self.values[index, -1])]
        return train.operation[0] if self.point is None else named_point(train, self.point)

    def beside_operation(self, index: int) -> tuple[float, ...]:
        """Values of all that is no operating point."""
        row = self.values[index].tolist()
        return tuple(v for one, v in zip(self.entries, row) if not _of_operation(one))

    def in_turn(self, numbers: Iterable[int]) -> list[int]:
        """Variants in an order in which those of the same shafts stand together, and operating points
        of the same train.
        """
        dear = {side: k for k, side in enumerate((*SIDES, OWN))}
        ranks = [len(dear) if _of_operation(one) else dear[one.file] for one in self.entries]
        order = np.argsort(ranks, kind="stable")
        return sorted(numbers, key=lambda k: (*self.values[k, order].tolist(), k))

    def first_sound(self) -> int:
        """Number of the first variant that the rules of the files let pass.

        Raises
        ------
        SolidgearError
            If there is none, with the entry that is refused whatever its value, if there is one.
        """
        refusal: Exception | None = None
        for index in dict.fromkeys(np.linspace(0, len(self) - 1, LOOKED).astype(int).tolist()):
            try:
                train = self.train(index)
                self.at(index, train)
                contact(train)
                return index
            except SolidgearError as error:
                refusal = refusal or self.located(error, index)
        for one in self.entries:
            self._refuse_whatever_its_value(one)
        raise SolidgearError(f"no variant can be solved; the first one is refused: {refusal}")

    def _refuse_whatever_its_value(self, one: Entry) -> None:
        first: SceneError | None = None
        for value in one.values if one.label != POINT else ():
            try:
                self._read((one,), (value,))
                return
            except SceneError as error:
                own = [found for found in error.problems if _meets(found.path, one.keys)]
                if not own:
                    return
                first = first or own[0]
        if first is not None:
            raise SolidgearError(f"--vary {one.label}: {hinted(first, one.label, self.files)}")

    def with_entry(self, file: str, keys: Keys, value: Any) -> TrainVariants:
        """The same with an entry of a file replaced in all of them."""
        files = {**self.files, file: changed(self.files[file], keys, value)}
        return replace(self, files=files, _scenes={})

    def located(self, error: SolidgearError, index: int) -> SolidgearError:
        """An error of one variant told with the key and the value of the train's file."""
        if not isinstance(error, SceneError) or error.where:
            return error
        return error.located(self.tables(index)[OWN], where=str(self.path))

    def tables(self, index: int) -> dict[str, Tables]:
        """Tables of all files of one variant, by their names."""
        row = self.values[index].tolist()
        return {name: self._put(name, self.files[name], self.entries, row) for name in self.files}

    @staticmethod
    def _put(name: str, tables: Tables, varied: Sequence[Entry], row: Sequence[float]) -> Tables:
        own = [p for p in zip(varied, row) if p[0].file == name and p[0].label != POINT]
        return put_in(tables, *zip(*own)) if own else tables

    def _read(self, varied: Sequence[Entry], row: Sequence[float]) -> Train:
        def of_side(side: str, path: Path, alone: bool) -> Scene:
            key = (side, str(path), alone, *(v for one, v in zip(varied, row) if one.file == side))
            if key not in self._scenes:
                if len(self._scenes) >= KEPT:
                    self._scenes.clear()
                usual = path == self.path.parent / str(self.files[OWN][side]["scene"])
                tables = self.files[side] if usual else parse(str(path))
                self._scenes[key] = _scene(self._put(side, tables, varied, row), str(path), alone)
            return self._scenes[key]

        own = self._put(OWN, self.files[OWN], varied, row)
        return train_of(own, str(self.path), of_side)


def train_variants(
    path: Path,
    texts: Iterable[str],
    *,
    count: int | None = None,
    seed: int = 0,
    point: str | None = None,
    every_point: bool = False,
) -> TrainVariants:
    """Points of a sweep: all combinations of ``PATH=VALUES`` texts, or a sample of them.

    Parameters
    ----------
    path : Path
        Of the train file.
    texts : iterable of str
    count, seed : int, optional
        Of the sample.
    point : str, optional
        Operating point that is looked at; the first by default, or the one that varies.
    every_point : bool
        Look at each of the file.

    Raises
    ------
    SolidgearError
        For files and texts that cannot be read, and for too many variants.
    """
    own = parse(str(path))
    files = {OWN: own} | {side: _side(path, own, side) for side in SIDES}
    varied = entries_of(texts, files, _owner)
    if every_point:
        varied += (_every_point(own, varied, point),)
    if not varied:
        raise SolidgearError(
            'nothing is varied; give for example --vary "mesh.stiffness=log:1e8 N/m:1e9 N/m:5"'
        )
    values = product(varied) if count is None else sample(varied, count, seed)
    return TrainVariants(path, files, varied, values, point or _varied_point(own, varied))


def _side(path: Path, own: Tables, side: str) -> Tables:
    """Tables of the scene of a side; none where the train file does not name it, which its own
    reader tells.
    """
    table = own.get(side)
    name = table.get("scene") if isinstance(table, Mapping) else None
    return parse(str(path.parent / name)) if isinstance(name, str) else {}


def _owner(path: str) -> tuple[str, str]:
    """The scene of a side owns the keys of scenes, the train file all others."""
    first, _, within = path.partition(".")
    if first in SIDES and within.partition(".")[0] in KEYS:
        return first, within
    if first in KEYS and first not in Train.model_fields:
        raise SolidgearError(
            f"--vary {path}: is of the scene of a shaft; say of which: "
            + " or ".join(f"{side}.{path}" for side in SIDES)
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
        file=OWN,
        path=OPERATION,
        keys=(OPERATION,),
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


def _meets(path: tuple, keys: tuple) -> bool:
    """True where a problem is of an entry, of what lies in it or of a table that it was put in."""
    shared = min(len(path), len(keys))
    return shared > 0 and path[:shared] == keys[:shared]


def _scene(tables: Tables, where: str, alone: bool) -> Scene:
    """Scene of a shaft: settled by itself, or to be settled with its train."""
    scene = scene_of(dict(tables), where, part_of)
    if not alone or all(bearing.catalogue is None for bearing in scene.bearings):
        return scene
    with explained(where, tables):
        return solved(scene, shaft(scene)).scene
