"""Rows of a sweep of trains: natural frequencies, peaks of the mesh force, and numbers at rest."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core import (
    Document,
    Scene,
    SolidgearError,
    Source,
    document_of,
    listed,
    nearest,
    show,
)
from solidgear.core.judge.answer import read_tolerance
from solidgear.core.loading import scene_of
from solidgear.core.models.limits import number
from solidgear.core.scene.file import KEYS
from solidgear.core.scene.paths import Tables, with_entry
from solidgear.strength.deflection.misalignment import measured_names, misalignment
from solidgear.teeth.study import touching
from solidgear.teeth.train_teeth import with_teeth
from solidgear.trains.assembly.assembly import KEPT
from solidgear.trains.assembly.layout import contacts
from solidgear.trains.assembly.mesh_stiffness import asks_for_teeth, has_settled
from solidgear.trains.assembly.shaft import JUDGE, LUMPED, checked_model
from solidgear.trains.assembly.turn import over_a_turn, stages_over_a_turn
from solidgear.trains.file.flanks import Flanks
from solidgear.trains.file.housing import HOUSING
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.reading import train_of
from solidgear.trains.file.train import SHORT, SIDES, Train
from solidgear.trains.load.operation import (
    SHAFT,
    named_point,
    with_settled_bearings,
)
from solidgear.trains.load.state import OperatingState
from solidgear.trains.modes.modes import refuse_unresolved
from solidgear.trains.modes.parting import joint_name, parting_frequency, teeth_relief
from solidgear.trains.response.drive import Drive
from solidgear.variants.sweep.bench import Bench
from solidgear.variants.sweep.curves import force_of, misaligned
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.entries import Entry, Place
from solidgear.variants.sweep.error_curves import over_torque
from solidgear.variants.sweep.file_task import BARS, BOUND, FileTask
from solidgear.variants.sweep.file_variants import MAIN, POINT, FileVariants, tables_for_plan
from solidgear.variants.sweep.tooth_numbers import TOOTH_UNITS, TeethBench, of_mesh, tooth_numbers

#: kinds of numbers of a row, by the commands that show the same of one train
MODES, RESPONSE, DEFLECTION, CONTACT = "system-modes", "response", "deflect", "contact"
BY_DEFAULT = (MODES, RESPONSE, DEFLECTION)
ASKED = (*BY_DEFAULT, CONTACT)
#: natural frequencies of a row at most, by default and on request
MOST_MODES = 20
MOST_SHAPES = 200
#: peaks of the mesh force
PEAKS = 3
#: column of the lowest frequency at which the dynamic mesh force is larger than the mean one, Hz
PARTS = "parts_from_hz"
#: loads of a bearing, N, N and N m
LOADS = ("radial", "axial", "moment")
#: table of operating points
OPERATION = "operation"
#: scenes that are kept
SCENES = 500
#: keys of gears on which nothing but the contact of their teeth depends
FLANK_SHAPES = {"relief", "crowning", "helix_slope", "measured_flank"}


@dataclass(frozen=True)
class TrainTask(FileTask):
    """Turns variants of a train into rows."""

    variants: TrainVariants
    models: Mapping[str, str]  #: by shaft, in the sequence of the file
    ask: tuple[str, ...]  #: some of `ASKED`
    #: elastic modes; those up to the highest frequency, `MOST_MODES` at most, by default
    n: int | None
    max_frequency: float | None  #: hz; that of the file by default
    reduction: str
    kept: int
    tolerance: (
        float | None
    )  #: relative error that meshes may leave; by default a share of the file's
    settings: Mapping[Any, Mapping]  #: builder options by (side, model)
    mesh: str | None  #: the one whose transmission error drives the train; the first by default
    first: int  #: a variant that can be read

    @cached_property
    def bench(self) -> Bench:
        """Shafts and trains kept from row to row."""
        return Bench(self.reduction, self.kept, self.settings, self.tolerance, self.max_frequency)

    @cached_property
    def teeth(self) -> TeethBench:
        """The train that carries its teeth, kept from row to row."""
        return TeethBench()

    @cached_property
    def usual(self) -> Train:
        """Train of the first variant that can be read."""
        return self.variants.variant(self.first)

    @property
    def misalignments(self) -> tuple[str, ...]:
        return tuple(measured_names(self.usual))

    @property
    def meshes_in_contact(self) -> tuple[str, ...]:
        return tuple(mesh.name for mesh in touching(self.usual)) if CONTACT in self.ask else ()

    def refuse_chart(self) -> None:
        if not (self.meshes_in_contact and over_torque(self.variants)):
            super().refuse_chart()

    @property
    def cautions(self) -> tuple[str, ...]:
        """Sentences on data that contradict each other in trains that can be solved."""
        meshes = contacts(self.usual).values()
        of_meshes = tuple(text for mesh in meshes for text in mesh.cautions)
        return of_meshes + self.variants.cautions

    @property
    def columns(self) -> dict[str, type]:
        train, out = self.usual, dict[str, type]()
        if train.operation:
            out |= {"torque": float} | {force_of(joint.name): float for joint in train.joints}
        if train.operation and DEFLECTION in self.ask:
            out |= dict.fromkeys(map(misaligned, self.misalignments), float)
            out |= {once(stage.called): float for stage in stages_over_a_turn(train)}
            for side, shaft in train.shafts.items():
                for b in shaft.scene.bearings:
                    if b.catalogue is not None or np.any(b.stiffness):
                        out |= {f"{side}.{b.name}.{load}": float for load in LOADS}
        if train.operation:
            for mesh in self.meshes_in_contact:
                out |= {of_mesh(number, mesh): float for number in TOOTH_UNITS}
            out["unloaded"] = str
        if MODES in self.ask:
            out |= {"rigid_modes": int, "modes": int, BOUND: float}
            for k in range(1, (self.n or MOST_MODES) + 1):
                out |= {f"f{k}_hz": float, f"mode{k}": str}
        if RESPONSE in self.ask:
            for k in range(1, PEAKS + 1):
                out |= {f"peak{k}_hz": float, f"peak{k}_force": float, f"peak{k}_mode": str}
            out |= {PARTS: float} if train.operation else {}
        return out | {BARS: str}

    @property
    def without_bars(self) -> str:
        """Words on error bars of a row: the commands that have them."""
        *first, last = self.ask
        commands = f"{', '.join(first)} or {last}" if first else last
        return f"none: run {commands} on one variant"

    @property
    def plan(self) -> dict[str, Any]:
        variants, usual = self.variants, self.usual
        tables = variants.tables(self.first)
        # further files that these name
        cells = [cell.model_dump() for mesh in usual.meshes for cell in mesh.contact_cells]
        gears: list[Flanks | None] = []
        for shaft in usual.shafts.values():
            gears += shaft.gears.values()
        for table in usual.planetary.values():
            gears += [table.planet, table.ring_flanks]
        flanks = [gear.measured_flank for gear in gears if gear and gear.measured_flank]
        parts = [shaft.scene.body for shaft in usual.shafts.values()]
        return {
            "files": {name or "train": tables_for_plan(tables[name]) for name in tables},
            "cells": cells,
            "flanks": [flank.model_dump() for flank in flanks],
            "parts": [part and part.model_dump(mode="json") for part in parts],
            "scenes": {word: tables_for_plan(scene) for word, scene in variants.scenes_in_turn()},
            "point": variants.point,
            "models": [*self.models.values()],
            "mesh": self.mesh,
            "n": self.n,
            "max_frequency": self.max_frequency,
            "reduction": [self.reduction, self.kept],
            "tolerance": self.tolerance,
            "set": tables_for_plan(
                {" ".join(key): dict(options) for key, options in self.settings.items()}
            ),
        }

    def cut(self, columns: Mapping[str, list[Any]]) -> int:
        """Return the number of natural frequencies below the highest frequency without a column, of
        the row that has most.
        """
        widest = max((count for count in columns.get("modes", []) if count), default=0)
        return max(0, widest - MOST_MODES) if self.n is None else 0

    def numbers(self, index: int) -> dict[str, Any]:
        train = self.variants.variant(index)
        point = self.variants.operating_point(index, train)
        numbers: dict[str, Any] = {BARS: self.without_bars}
        if point is not None:
            train, at_rest = self._at_rest(index, train, point)
            numbers |= at_rest
        if {MODES, RESPONSE} & {*self.ask}:
            numbers |= self._moving(train, numbers)
        return numbers

    # ------------------------------------------------------------------------------ at rest
    def _at_rest(
        self, index: int, train: Train, point: OperatingPoint
    ) -> tuple[Train, dict[str, Any]]:
        """Return a train whose bearings have settled at an operating point, and its numbers there."""
        key = self.variants.beside_flanks(index)
        if not (CONTACT in self.ask or asks_for_teeth(train)):
            return self._settled(key, train, point)
        carried = self.teeth.carried(key, train, point)
        of_teeth = tooth_numbers(carried, train) if CONTACT in self.ask else {}
        if self.ask == (CONTACT,):
            at_rest = carried.assembly.train
            return at_rest, of_teeth | _loads(carried.state, at_rest)
        if asks_for_teeth(train):
            key = *key, index  # no other row has its mesh stiffness
        if has_settled(train):
            train = with_teeth(train, carried)
        at_rest, out = self._settled(key, train, point)
        return with_teeth(at_rest, carried), of_teeth | out

    def _settled(
        self, key: Hashable, train: Train, point: OperatingPoint
    ) -> tuple[Train, dict[str, Any]]:
        """Return a train whose bearings have settled at an operating point, and its numbers there but
        for those of teeth.
        """
        on_shafts = (SHAFT,) * len(self.models)
        state = self.bench.operating(key, train, *on_shafts).at(point)
        at_rest = with_settled_bearings(train, state)
        out = _loads(state, at_rest)
        if DEFLECTION in self.ask:
            models = tuple(map(statics_of, self.models.values()))
            operating = self.bench.operating(key, train, *models)
            deflected = state if models == on_shafts else operating.at(point)
            assembly = operating.assembly.on_flank(point.coast)
            for measure in misalignment(assembly, deflected.system):
                out[misaligned(measure.name)] = float(measure.row @ deflected.coordinates)
            for turn in over_a_turn(operating.assembly, deflected, deflected.models):
                out[once(turn.stage)] = max(planet.once for planet in turn.planets)
            for end, load in deflected.equilibrium.load.items():
                # across the shaft, along it and against tilting
                loads = np.hypot(load[0], load[2]), load[1], np.hypot(load[3], load[5])
                out |= {f"{end}.{name}": float(value) for name, value in zip(LOADS, loads)}
        return at_rest, out

    # ------------------------------------------------------------------------------ moving
    def _moving(self, train: Train, at_rest: Mapping[str, Any]) -> dict[str, Any]:
        """Return natural frequencies, peaks of the mesh force, and the frequency from which the teeth
        part under their load at rest.
        """
        assembly = self.bench.assembly(train, *self.models.values())
        drive = Drive(assembly, *self.models.values(), mesh=self.mesh)
        limit = self.max_frequency or train.ask.max_frequency
        refuse_unresolved(assembly, drive.system, limit)
        out: dict[str, Any] = {}
        if MODES in self.ask:
            below = int((drive.system.elastic[0] <= 2 * np.pi * limit).sum())
            wanted = self.n or min(below, MOST_MODES)
            modes, names = drive.named_modes(max(wanted, drive.reach(limit)), bounded=wanted)
            elastic = slice(modes.rigid, modes.rigid + wanted)
            out |= {"rigid_modes": modes.rigid, "modes": below}
            out[BOUND] = float(modes.error_bound[elastic].max(initial=0.0))
            for k, (hz, name) in enumerate(
                zip(modes.frequency_hz[elastic], names[elastic]), start=1
            ):
                out |= {f"f{k}_hz": float(hz), f"mode{k}": name}
        if RESPONSE in self.ask:
            hz = drive.grid(limit)
            largest = sorted(drive.curve(hz).peaks, key=lambda peak: -peak.force)[:PEAKS]
            for k, peak in enumerate(largest, start=1):
                out |= {f"peak{k}_hz": peak.frequency_hz, f"peak{k}_force": peak.force}
                out[f"peak{k}_mode"] = peak.mode
            mean = at_rest.get(force_of(joint_name(drive.pair)))
            if mean is not None:
                lowest = parting_frequency(
                    hz, teeth_relief(drive, drive.over_cycle(hz, limit)), mean
                )
                out |= {} if lowest is None else {PARTS: lowest}
        return out


def train_task(
    train: Source,
    design: Design,
    *,
    pinion: str | None = None,
    gear: str | None = None,
    models: Mapping[str, str] | None = None,
    mesh: str | None = None,
    ask: Iterable[str] = BY_DEFAULT,
    n: int | None = None,
    max_frequency: float | None = None,
    point: str | None = None,
    every_point: bool = False,
    reduction: str = "rubin",
    kept: int = KEPT,
    tolerance: float | None = None,
    local_harmonics: Sequence[int] = (),
    settings: Mapping[Any, Mapping] | None = None,
) -> TrainTask:
    """Return the task of natural frequencies, mesh force and misalignment of variants of a train;
    parameters as of :func:`solidgear.sweep`.

    Examples
    --------
    >>> design = Design(("mesh.stiffness=2e8 N/m:3e8 N/m:3",))
    >>> beams = {"pinion": "euler", "gear": "euler"}
    >>> task = train_task("geometry/axle_overhung.toml", design, **beams)
    >>> [row["status"] for row in task.rows(range(3))], task.bench.made
    (['ok', 'ok', 'ok'], 2)
    """
    asked = set(ask)
    for word in asked.difference(ASKED):
        raise SolidgearError(
            f"`ask` {show(word, 40)}: give one or more of {', '.join(ASKED)}{nearest(word, ASKED)}"
        )
    if not asked:
        raise SolidgearError(f"`ask`: name one or more of {', '.join(ASKED)}")
    by_side = {"pinion": pinion, "gear": gear}
    chosen = {side: model for side, model in by_side.items() if model is not None}
    chosen |= models or {}
    for model in chosen.values():
        checked_model(model)
    if n is not None:
        number("sweep", "n", n, least=1, below=MOST_SHAPES + 1, whole=True)
    if tolerance is not None:
        tolerance = read_tolerance(tolerance)
    variants = train_variants(
        train, design, point=point, every_point=every_point, local_harmonics=local_harmonics
    )
    first, usual = variants.first_sound()
    usual.named_mesh(mesh)
    for side in chosen:
        usual.named_shaft(side)
    if CONTACT in asked:
        if variants.operating_point(first, usual) is None:
            raise SolidgearError(
                f"`ask` {CONTACT}: teeth touch under a load; give [operation] a torque"
            )
        touching(usual)
    return TrainTask(
        variants,
        models={side: chosen.get(side, JUDGE) for side in usual.shafts},
        ask=tuple(word for word in ASKED if word in asked),
        n=n,
        max_frequency=max_frequency,
        reduction=reduction,
        kept=kept,
        tolerance=tolerance,
        settings=dict(settings or {}),
        mesh=mesh,
        first=first,
    )


def _loads(state: OperatingState, at_rest: Train) -> dict[str, Any]:
    """Return torque and mesh forces of a state, and the bearings without load in it."""
    return {
        "torque": state.point.torque,
        **{force_of(name): force for name, force in state.mesh_forces.items()},
        "unloaded": ", ".join(at_rest.unloaded),
    }


def statics_of(model: str) -> str:
    """Return the model of a shaft at rest: in place of a lumped one, which has no bearings, that of its
    body.
    """
    kind, base = checked_model(model)
    return base if kind in LUMPED else model


def once(stage: str) -> str:
    """Return the column of the amplitude of the mesh force of a planet once a turn of the carrier."""
    return f"once_a_turn_{stage.replace(' ', '_')}"


@dataclass(frozen=True)
class TrainVariants(FileVariants[Train]):
    """Points of a sweep of a train; bearings that settle with it have no stiffness yet. Files are named
    by side, that of the train by an empty name; the last entry may be the operating points. A scene
    within the train is one more file, called as its shaft.
    """

    #: operating point of all rows, by its name or number; the first by default
    point: str | None = None
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
                self._scenes[key] = scene_of(tables, path, alone)
            return self._scenes[key]

        return train_of(self.put(MAIN, varied, row), str(self.path), of_side)


def train_variants(
    train: Source,
    design: Design,
    *,
    point: str | None = None,
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

    design_points = design.points(
        files,
        partial(_owner, [*shafts], many, HOUSING in tables),
        points,
        example="mesh.stiffness=log:1e8 N/m:1e9 N/m:5",
    )
    varied = design_points.entries
    point = point or _varied_point(tables, varied)
    if local_harmonics:
        meshes = tables.get("mesh")
        places = [(k,) for k in range(len(meshes))] if isinstance(meshes, list) else [()]
        for place in places:
            keys = ("mesh", *place, "local_harmonics")
            files[MAIN] = with_entry(files[MAIN], keys, list(local_harmonics))
    return TrainVariants(
        path, files, varied, design_points.values, design_points.sums, design, point
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


def _every_point(tables: Tables, varied: Sequence[Entry], point: str | None) -> Entry:
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
