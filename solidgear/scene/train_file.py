"""From a TOML file of a train to a `Train`, errors named by the keys of the file.

The format is documented by ``geometry/axle_overhung.toml``, and that of more than two shafts by
``geometry/gearbox_two_stage.toml``, and of a housing by ``geometry/gearbox_housed.toml``.
"""

from __future__ import annotations

import csv
import os
from collections.abc import Callable, Mapping
from functools import partial
from math import isfinite, sqrt
from pathlib import Path
from typing import Any

from pydantic import model_validator

from solidgear.errors import SceneError, near, show
from solidgear.scene.file import load
from solidgear.scene.gears import Member, Shaft
from solidgear.scene.housing_matrices import ARRAYS, read_matrices
from solidgear.scene.model import Scene
from solidgear.scene.operation import Operation
from solidgear.scene.planetary import Planetary
from solidgear.scene.toml_file import name_of, of_tables, parse
from solidgear.scene.train import SHORT, SIDES, Train
from solidgear.scene.train_housing import HOUSING, TrainHousing
from solidgear.scene.train_tables import Losses, Mesh, Rotor, TrainAsk
from solidgear.scene.typed import Gathered, Model
from solidgear.scene.units import TYPED

#: reads the scene of a side from a file, told whether the shaft stands alone.
ReadShaft = Callable[[str, Path, bool], Scene]

CELL_COLUMNS = ("x", "y", "z", "nx", "ny", "nz", "force")
MOST_CELLS = 100_000


def _as_written(side: str, path: Path, alone: bool) -> Scene:
    return load(path)


def load_train(path: str | os.PathLike, shaft: ReadShaft = _as_written) -> Train:
    """Read a train file; the shafts it names lie relative to it. `shaft` reads the scene of a side
    from its file, and is told whether the shaft stands alone: bearings of a shaft whose train has
    an [operation] settle with the train.
    """
    file_path = os.fspath(path)
    return train_of(parse(file_path), file_path, shaft)


class _Tables(Model):
    """Tables that every train file has."""

    title: str = ""
    name: str = "train"
    source: str = ""
    engine: dict[str, Rotor] = {}
    load: dict[str, Rotor] = {}
    losses: Losses = Losses()
    housing: TrainHousing | None = None
    operation: Operation = ()
    ask: TrainAsk = TrainAsk()

    @model_validator(mode="before")
    @classmethod
    def _by_name(cls, tables: dict[str, Any]) -> dict[str, Any]:
        """One engine or load, which needs no name, by what it is."""
        roles = [role for role in SHORT if tables.get(role)]
        return {**tables, **{r: {r: tables[r]} for r in roles if not _several(tables[r])}}

    def train(
        self, shafts: Mapping, meshes: tuple[Mesh, ...], rotors: Mapping, **more: Any
    ) -> Train:
        """The train that they describe."""
        fields = {
            key: getattr(self, key) for key in _Tables.model_fields if key in Train.model_fields
        }
        all_rotors: dict[str, Rotor] = {}
        for kind, kind_rotors in (("engine", self.engine), ("load", self.load), ("rotor", rotors)):
            for name, rotor in kind_rotors.items():
                if name in all_rotors:
                    reason = f"an engine or a load is called {name!r} as well; give it another name"
                    raise SceneError(reason, path=(kind, name))
                all_rotors[name] = rotor
        more |= {"engines": tuple(self.engine), "loads": tuple(self.load)}
        return Train(shafts=shafts, meshes=meshes, rotors=all_rotors, **more, **fields)


class ShortFile(_Tables):
    """File of a train of two shafts."""

    pinion: Member
    gear: Member
    mesh: Mesh

    def whole(self) -> Train:
        """The train."""
        rotors = {
            kind: {
                name: rotor if rotor.shaft else rotor.with_changes(shaft=side)
                for name, rotor in getattr(self, kind).items()
            }
            for kind, side in SHORT.items()
        }
        shafts = {"pinion": self.pinion.shaft, "gear": self.gear.shaft}
        mesh = self.mesh.with_changes(between=tuple(shafts))
        return self.with_changes(**rotors).train(shafts, (mesh,), {})


class LongFile(_Tables):
    """File of a train of any number of shafts."""

    shaft: dict[str, Shaft]
    mesh: tuple[Mesh, ...] = ()
    planetary: dict[str, Planetary] = {}
    rotor: dict[str, Rotor] = {}

    def whole(self) -> Train:
        """The train."""
        return self.train(self.shaft, self.mesh, self.rotor, planetary=self.planetary)


def train_of(raw: Mapping[str, Any], file_path: str, shaft: ReadShaft = _as_written) -> Train:
    """Resolve the tables of a train file; what it names lies relative to `where`, its path."""
    folder = Path(file_path).parent
    try:
        if "segment" in raw:
            raise SceneError(
                "this is the scene of one shaft, not of a train; run solidgear compare, answer "
                "or modes on it, or name a file with [pinion] and [gear], such as "
                "geometry/axle_overhung.toml",
                path=("segment",),
            )
        data: dict[str, Any] = {"name": name_of(file_path), **raw}
        read_scene = partial(_with_scene, folder, "operation" not in raw, shaft)
        problems, kind = Gathered(), LongFile if "shaft" in raw else ShortFile
        if kind is LongFile:
            data["shaft"] = _shafts(problems, raw["shaft"], read_scene, "planetary" in raw)
        for side in SIDES:
            if isinstance(raw.get(side), Mapping):
                data[side] = _read(problems, partial(read_scene, raw[side], (side,))) or raw[side]
        _read_meshes(data, kind is LongFile, folder)
        if isinstance(box := raw.get(HOUSING), Mapping) and "matrices" in box:
            data[HOUSING] = _with_matrices(box, folder)
        for role in (role for role in SHORT if role in raw):
            for name in [*raw[role]] if _several(raw.get(role)) else [""]:
                problems.read(partial(_whole_rotor, raw, role, name))
        if kind is LongFile:
            problems.tell()
        known_paths = {problem.path for problem in problems}
        try:
            train = kind(**data).whole()
        except SceneError as error:
            problems_of_file = as_written(error, raw).problems
            problems += [problem for problem in problems_of_file if problem.path not in known_paths]
        problems.tell()
        return train
    except SceneError as error:
        if error.where:
            raise
        raise as_written(error, raw).located(raw, where=file_path) from None


def as_written(error: SceneError, raw: Mapping[str, Any]) -> SceneError:
    """Problems told by the keys of a file: as of :func:`of_tables`, and those of the only engine or
    load as its own.
    """
    alone = [(role, role) for role in SHORT if not _several(raw.get(role))]
    problems = (
        problem.located(None, path=(problem.path[0], *problem.path[2:]))
        if problem.path[:2] in alone
        else problem
        for problem in error.problems
    )
    return of_tables(SceneError.of(problems), raw)


def _several(table: Any) -> bool:
    """True if a table holds others by their names, and is none of an engine or a load itself."""
    tables = isinstance(table, Mapping) and all(
        isinstance(v, (Mapping, Rotor)) for v in table.values()
    )
    return tables and bool(table) and "spring" not in table


def _shafts(
    problems: Gathered, tables: Any, read_scene: Callable, carriers: bool
) -> dict[str, Shaft]:
    """Shafts by their names: with a table for each of several gears, or the one gear in their own;
    a carrier may have none.
    """
    if not isinstance(tables, Mapping) or not all(isinstance(t, Mapping) for t in tables.values()):
        reason = "holds a table for each shaft, such as [shaft.input]"
        raise SceneError(reason, path=("shaft",))
    out = {}
    for name, table in tables.items():
        path = ("shaft", name)
        fields = _read(problems, partial(read_scene, table, path))
        if fields is None:
            continue
        single = "gears" not in table and (not carriers or "teeth" in table)
        shaft = problems.read(
            lambda: Member(**fields).shaft if single else Shaft(**fields),  # noqa: B023  read at once
            path,
        )
        if shaft is not None:
            out[name] = shaft
    return out


def _read_meshes(data: dict[str, Any], many: bool, folder: Path) -> None:
    """Put the contact cells that meshes name into them; one mesh is a list of one."""
    meshes = data.get("mesh")
    tables = meshes if many and isinstance(meshes, list) else [meshes]
    read = [
        _with_cells(table, folder, ("mesh", k) if many else ("mesh",))
        if isinstance(table, Mapping) and "contact_cells" in table
        else table
        for k, table in enumerate(tables)
    ]
    if "mesh" in data:
        data["mesh"] = read if many else read[0]


def _read(problems: Gathered, reader: Callable[[], dict[str, Any]]) -> dict[str, Any] | None:
    """As `Gathered.read`; problems of another file are told by themselves."""
    try:
        return reader()
    except SceneError as error:
        if error.where:
            raise
        problems += error.problems
        return None


def _with_scene(
    folder: Path, alone: bool, shaft: ReadShaft, table: Mapping[str, Any], path: tuple
) -> dict[str, Any]:
    name = table.get("scene")
    if not isinstance(name, str):
        reason = 'names the file of the shaft, such as "gear_shaft.toml"'
        raise SceneError(reason, path=(*path, "scene"))
    return {**table, "scene": shaft(path[-1], folder / name, alone)}


def _whole_rotor(raw: Mapping[str, Any], rotor: str, name: str) -> None:
    """The spring is what is most often left out: say what it is for."""
    path = (rotor, name) if name else (rotor,)
    table = raw[rotor][name] if name else raw.get(rotor)
    if not isinstance(table, Mapping):
        reason = f"holds inertia and a spring: write [{rotor}] with inertia, and [{rotor}.spring]"
        raise SceneError(reason, path=(rotor,))
    side = table.get("shaft", SHORT[rotor])
    misspelt = any(near(key, ("spring",)) for key in table if key != "spring")  # told as such
    if not isinstance(table.get("spring"), Mapping) and not misspelt:
        raise SceneError(
            f"the torsional spring between the {name or rotor} and the {side}'s shaft is missing; "
            f"write [{'.'.join(path)}.spring] with stiffness and where it sits (at)",
            path=(*path, "spring"),
        )


def _with_cells(table: Mapping[str, Any], folder: Path, path: tuple) -> dict[str, Any]:
    fields = {key: value for key, value in table.items() if key != "contact_cells"}
    name = table["contact_cells"]
    if not isinstance(name, str):
        reason = "names a CSV file with the columns " + ", ".join(CELL_COLUMNS)
        raise SceneError(reason, path=(*path, "contact_cells"))
    return {**fields, "contact_cells": read_cells(folder / name)}


def _with_matrices(table: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    for key in ("mass", "inertia", "centre", "points"):
        if key in table:
            raise SceneError("follows from matrices; leave one of the two out", path=(HOUSING, key))
    if not isinstance(name := table["matrices"], str):
        reason = "names an .npz file with " + ", ".join(ARRAYS)
        raise SceneError(reason, path=(HOUSING, "matrices"))
    return {**table, "matrices": read_matrices(folder / name)}


def read_cells(path: str | os.PathLike) -> tuple[dict[str, Any], ...]:
    """Contact cells of a CSV file with the columns x, y, z (m), nx, ny, nz and force (N), as a
    `Mesh` takes them: ``point``, ``normal`` (of unit length) and ``force``.
    """
    file_path = os.fspath(path)
    try:
        with open(path, newline="", encoding="utf-8-sig") as file:
            rows = list(csv.DictReader(file, skipinitialspace=True))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        said = getattr(error, "strerror", None) or "not a CSV file in UTF-8"
        raise SceneError(f"the contact cells cannot be read: {said}", where=file_path) from None
    if not rows or len(rows) > MOST_CELLS:
        raise SceneError(
            f"{len(rows)} contact cells; there must be 1 to {MOST_CELLS}", where=file_path
        )
    missing = [c for c in CELL_COLUMNS if c not in rows[0]]
    if missing:
        reason = f"no column {missing[0]}; the first line must name {', '.join(CELL_COLUMNS)}"
        raise SceneError(reason, where=file_path)
    cells = tuple(_cell(row, k, file_path) for k, row in enumerate(rows, start=2))
    if not sum(cell["force"] for cell in cells) > 0:
        raise SceneError("no cell carries a force; the sum must be above zero", where=file_path)
    return cells


def _cell(row: Mapping[str, Any], line: int, file_path: str) -> dict[str, Any]:
    value = []
    for column in CELL_COLUMNS:
        try:
            number = float(row[column])
        except (TypeError, ValueError):
            number = float("nan")
        if not isfinite(number):
            reason = f"line {line}, {column} = {show(row[column], 30)}: must be a number in SI"
            raise SceneError(reason, where=file_path)
        value.append(number)
    normal, force = value[3:6], value[6]
    length = sqrt(sum(v * v for v in normal))
    if abs(length - 1) > TYPED:
        reason = f"line {line}: the normal has length {length:.6g}; it must be a unit vector"
        raise SceneError(reason, where=file_path)
    if force < 0:
        reason = f"line {line}, force = {force:g}: teeth push and do not pull; must not be negative"
        raise SceneError(reason, where=file_path)
    unit = tuple(v / length for v in normal)
    return {"point": tuple(value[:3]), "normal": unit, "force": force}
