"""From a TOML file of a train to a `Train`, errors named by the keys of the file.

The format is documented by ``geometry/axle_overhung.toml``, for more than two shafts by
``geometry/gearbox_two_stage.toml``, and with a housing by ``geometry/gearbox_housed.toml``.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated, Any, ClassVar

from pydantic import model_validator

from solidgear.core import (
    Document,
    Model,
    Scene,
    SceneError,
    Written,
    addition,
    document_of,
    listed,
    near,
)
from solidgear.core.loading import as_written as scene_as_written
from solidgear.core.reduction.matrix_units import MATRIX_UNITS
from solidgear.core.scene.toml_file import name_of, parse, with_table_paths
from solidgear.core.scene.typed import Problems
from solidgear.trains.file.columns import CELL_COLUMNS, read_cells, read_flank
from solidgear.trains.file.gears import Gear, Member, Shaft
from solidgear.trains.file.housing import HOUSING, TrainHousing
from solidgear.trains.file.layout import layout_problems
from solidgear.trains.file.operation import Operation
from solidgear.trains.file.planetary import Planetary
from solidgear.trains.file.tables import Losses, Mesh, Rotor, TrainAsk
from solidgear.trains.file.train import SHORT, SIDES, Train

#: key of the file of a measured flank
MEASURED = "measured_flank"
#: reads the scene of a side from a file or a document, given whether the shaft stands alone
ReadShaft = Callable[[str, Any, bool], Scene]


def _as_written(side: str, source: Any, alone: bool) -> Scene:
    return scene_as_written(source)


def load_train(path: str | os.PathLike, shaft: ReadShaft = _as_written) -> Train:
    """Read a train file, whose scenes lie relative to it. `shaft` reads the scene of a side from a
    file, given whether the shaft stands alone: with an [operation] bearings settle with the train.
    """
    file_path = os.fspath(path)
    return train_of(parse(file_path), file_path, shaft)


class _Tables(Model):
    """Tables that every train file has."""

    #: title of the train in tables and pages
    title: str = ""
    #: name of the train; by default that of the file
    name: str = "train"
    #: where the numbers come from
    source: str = ""
    #: file of a list of bearings (CSV) that designations of all shafts are looked up in first
    bearings: str | None = None
    #: inertia and torsional spring of what brings torque; several by name
    engine: Annotated[dict[str, Rotor], Written(Rotor | dict[str, Rotor])] = {}
    #: inertia and torsional spring of what takes torque; several by name
    load: Annotated[dict[str, Rotor], Written(Rotor | dict[str, Rotor])] = {}
    #: loss factors, twice a damping ratio
    losses: Losses = Losses()
    #: body that carries the bearings of shafts, on mounts to ground
    housing: TrainHousing | None = None
    #: operating points: torque, speed, weight, further forces
    operation: Operation = ()
    #: questions: frequency range and tolerances
    ask: TrainAsk = TrainAsk()

    @model_validator(mode="before")
    @classmethod
    def _by_name(cls, tables: dict[str, Any]) -> dict[str, Any]:
        """Name a single engine or load, which needs no name, by its role."""
        roles = [role for role in SHORT if tables.get(role)]
        return {**tables, **{r: {r: tables[r]} for r in roles if not _several(tables[r])}}

    def train(
        self, shafts: Mapping, meshes: tuple[Mesh, ...], rotors: Mapping, **more: Any
    ) -> Train:
        """Return the train of shafts, meshes and rotors with these tables."""
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
        train = Train(shafts=shafts, meshes=meshes, rotors=all_rotors, **more, **fields)
        if train.is_one_shaft:
            raise SceneError.of([*layout_problems(train)])
        return train


class ShortFile(_Tables):
    """File of a train of two shafts."""

    #: shaft and teeth of the driving gear
    pinion: Member
    #: shaft and teeth of the driven gear
    gear: Member
    #: teeth in contact
    mesh: Mesh

    def build_train(self) -> Train:
        """Return the train, rotors without a shaft on those of their role."""
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

    needs: ClassVar = (("mesh", "planetary"),)

    #: shafts by name, each with its file and its gears
    shaft: Annotated[dict[str, Shaft], Written(dict[str, Shaft | Member])]
    #: meshes, each between two gears
    mesh: tuple[Mesh, ...] = ()
    #: planetary stages by name
    planetary: dict[str, Planetary] = {}
    #: further inertias behind torsional springs, by name
    rotor: dict[str, Rotor] = {}

    def build_train(self) -> Train:
        """Return the train."""
        return self.train(self.shaft, self.mesh, self.rotor, planetary=self.planetary)


def train_of(raw: Mapping[str, Any], file_path: str, shaft: ReadShaft = _as_written) -> Train:
    """Resolve the tables of a train file; files that it names lie relative to `file_path`."""
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
        read_scene = partial(
            _with_scene, folder, "operation" not in raw, with_list_of(raw, folder, shaft)
        )
        problems, kind = Problems(), LongFile if "shaft" in raw else ShortFile
        if kind is LongFile:
            data["shaft"] = _shafts(problems, raw["shaft"], read_scene, "planetary" in raw)
        for side in SIDES:
            if isinstance(raw.get(side), Mapping):
                data[side] = _read(problems, partial(read_scene, raw[side], (side,))) or raw[side]
        if any(problem.path[1:2] == ("scene",) != problem.path[1:] for problem in problems):
            problems.raise_any()  # a train without one of its scenes cannot be judged
        _read_meshes(data, kind is LongFile, folder)
        if isinstance(stages := raw.get("planetary"), Mapping):
            data["planetary"] = {
                name: _with_flanks(stage, folder, ("planetary", name))
                if isinstance(stage, Mapping)
                else stage
                for name, stage in stages.items()
            }
        if isinstance(box := raw.get(HOUSING), Mapping) and "matrices" in box:
            data[HOUSING] = _with_matrices(box, folder)
        for role in (role for role in SHORT if role in raw):
            for name in [*raw[role]] if _several(raw.get(role)) else [""]:
                problems.read(partial(_check_rotor, raw, role, name))
        if kind is LongFile:
            problems.raise_any()
        known_paths = {problem.path for problem in problems}
        try:
            train = kind(**data).build_train()
        except SceneError as error:
            problems_of_file = as_written(error, raw).problems
            problems += [problem for problem in problems_of_file if problem.path not in known_paths]
        problems.raise_any()
        return train
    except SceneError as error:
        if error.where:
            raise
        raise as_written(error, raw).located(raw, where=file_path) from None


def with_list_of(raw: Mapping[str, Any], folder: Path, shaft: ReadShaft) -> ReadShaft:
    """Return a reader of shafts that have the list of bearings of their train, where they name none
    themselves.
    """
    name = raw.get("bearings")
    if name is None:
        return shaft
    # start-up: most trains name no list
    from solidgear.bearings.scene_list import path_of_list

    path = os.path.abspath(path_of_list(name, folder))

    def read(side: str, source: Any, alone: bool) -> Scene:
        document = document_of(source)
        return shaft(side, replace(document, tables={"bearings": path, **document.tables}), alone)

    return read


def as_written(error: SceneError, raw: Mapping[str, Any]) -> SceneError:
    """Return an error with paths of the file: as :func:`with_table_paths`, those of a single engine or
    load without a name, and those of a single gear in a table of its own.
    """
    alone = [(role, role) for role in SHORT if not _several(raw.get(role))]
    problems = []
    for problem in error.problems:
        if problem.path[:2] in alone:
            problem = problem.located(None, path=(problem.path[0], *problem.path[2:]))
        problems.append(problem.located(None, path=_gear_path(problem.path, raw)))
    return with_table_paths(SceneError.of(problems), raw)


def _gear_path(path: tuple, raw: Mapping[str, Any]) -> tuple:
    """Return the path of a key of the only gear of a shaft where the file has a table for it."""
    if path[:1] != ("shaft",) or len(path) < 3 or path[2] not in Gear.model_fields:
        return path
    table = raw["shaft"].get(path[1])
    gears = table.get("gears") if isinstance(table, Mapping) else None
    if not isinstance(gears, Mapping) or len(gears) != 1:
        return path
    return (*path[:2], "gears", *gears, *path[2:])


def _several(table: Any) -> bool:
    """Return True for a table of named engines or loads, and not of a single one."""
    tables = isinstance(table, Mapping) and all(
        isinstance(v, (Mapping, Rotor)) for v in table.values()
    )
    return tables and bool(table) and "spring" not in table


def _shafts(
    problems: Problems, tables: Any, read_scene: Callable, carriers: bool
) -> dict[str, Shaft]:
    """Return shafts by name: with a table for each of several gears, or a single gear in the table of
    the shaft; a carrier may have none.
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
    """Read the contact cells that meshes name into `data`."""
    meshes = data.get("mesh")
    tables = meshes if many and isinstance(meshes, list) else [meshes]
    read = []
    for k, table in enumerate(tables):
        if isinstance(table, Mapping) and not isinstance(
            table.get("contact_cells", ()), (list, tuple)
        ):
            table = _with_cells(table, folder, ("mesh", k) if many else ("mesh",))
        read.append(table)
    if "mesh" in data:
        data["mesh"] = read if many else read[0]


def _read(problems: Problems, reader: Callable[[], dict[str, Any]]) -> dict[str, Any] | None:
    """Return a result as `Problems.read`; problems of another file are raised at once."""
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
    if isinstance(name, Mapping):
        scene = _scene_inside(shaft, name, folder, alone, path)
    elif isinstance(name, str):
        scene = shaft(path[-1], folder / name, alone)
    else:
        reason = 'names the file of the shaft, such as "gear_shaft.toml", or holds its tables'
        raise SceneError(reason, path=(*path, "scene"))
    fields = {**table, "scene": scene}
    if "matrices" in table:
        fields = _matrices_read(fields, folder, path)
    return _with_flanks(fields, folder, path)


def _scene_inside(
    shaft: ReadShaft, tables: Mapping[str, Any], folder: Path, alone: bool, path: tuple
) -> Scene:
    """Read the scene of a shaft from tables within those of the train; it is called as the shaft."""
    try:
        return shaft(path[-1], Document(tables, str(folder / path[-1])), alone)
    except SceneError as error:
        raise SceneError.of(
            SceneError(problem.reason, path=(*path, "scene", *problem.path), value=problem.value)
            for problem in error.problems
        ) from None


def _with_flanks(table: Mapping[str, Any], folder: Path, path: tuple) -> dict[str, Any]:
    """Return the table of a gear, a shaft or a planetary stage with the measured flanks in it read."""
    fields = dict(table)
    if MEASURED in table and not isinstance(table[MEASURED], Mapping):
        name = table[MEASURED]
        if not isinstance(name, str):
            reason = "names a CSV file with the columns z, roll or diameter, and deviation, in m"
            raise SceneError(reason, path=(*path, MEASURED))
        fields[MEASURED] = read_flank(folder / name)
    for key in ("planet", "ring_flanks"):
        if isinstance(gear := table.get(key), Mapping):
            fields[key] = _with_flanks(gear, folder, (*path, key))
    if isinstance(gears := table.get("gears"), Mapping):
        fields["gears"] = {
            name: _with_flanks(gear, folder, (*path, "gears", name))
            if isinstance(gear, Mapping)
            else gear
            for name, gear in gears.items()
        }
    return fields


def _check_rotor(raw: Mapping[str, Any], rotor: str, name: str) -> None:
    """Refuse a rotor without a spring, which is most often left out, and explain the spring."""
    path = (rotor, name) if name else (rotor,)
    table = raw[rotor][name] if name else raw.get(rotor)
    if not isinstance(table, Mapping):
        reason = f"holds inertia and a spring: write [{rotor}] with inertia, and [{rotor}.spring]"
        raise SceneError(reason, path=(rotor,))
    side = table.get("shaft", SHORT[rotor])
    misspelt = any(near(key, ("spring",)) for key in table if key != "spring")  # refused as such
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
    for key in ("mass", "inertia", "centre"):
        if key in table:
            raise SceneError("follows from matrices; leave one of the two out", path=(HOUSING, key))
    return _matrices_read(table, folder, (HOUSING,))


def _matrices_read(table: Mapping[str, Any], folder: Path, path: tuple) -> dict[str, Any]:
    """Return a table with the file of matrices that it names read, points and units by its keys."""
    fields = {key: value for key, value in table.items() if key not in ("points", "units")}
    name, points, units = table["matrices"], table.get("points"), table.get("units", "")
    read = addition("matrices", "read")
    if read is None:
        reason = "is read by a part of solidgear that is not installed"
        raise SceneError(reason, path=(*path, "matrices"))
    if not isinstance(name, str):
        reason = 'names a file of mass and stiffness, such as "box.npz" or "box.bdf"'
        raise SceneError(reason, path=(*path, "matrices"))
    if points is not None and not isinstance(points, Mapping):
        reason = 'holds the node of every point, such as {"input.A" = 101}'
        raise SceneError(reason, path=(*path, "points"))
    if not isinstance(units, str) or (units and units not in MATRIX_UNITS):
        raise SceneError(f"use one of {listed(MATRIX_UNITS)}", path=(*path, "units"))
    fields["matrices"] = read(folder / name, points, units)
    return fields
