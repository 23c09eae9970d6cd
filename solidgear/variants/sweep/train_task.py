"""Rows of a sweep of trains: natural frequencies, peaks of the mesh force, and numbers at rest."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core import Scene, SolidgearError, nearest, show
from solidgear.core.models.limits import number
from solidgear.strength.deflection.misalignment import measured_names, misalignment
from solidgear.trains.assembly.assembly import KEPT
from solidgear.trains.assembly.layout import contacts
from solidgear.trains.assembly.shaft import JUDGE, LUMPED, checked_model
from solidgear.trains.assembly.turn import over_a_turn, stages_over_a_turn
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.train import Train
from solidgear.trains.load.operation import SHAFT, OperatingState, with_settled_bearings
from solidgear.trains.modes.modes import refuse_unresolved
from solidgear.trains.modes.parting import joint_name, parting_frequency, teeth_relief
from solidgear.trains.response.drive import Drive
from solidgear.variants.sweep.bench import Bench
from solidgear.variants.sweep.curves import force_of, misaligned
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.file_task import BARS, BOUND, FileTask
from solidgear.variants.sweep.file_variants import tables_for_plan
from solidgear.variants.sweep.train_variants import TrainVariants, train_variants

#: kinds of numbers of a row, by the commands that show the same of one train
MODES, RESPONSE, DEFLECTION = "system-modes", "response", "deflect"
ASKED = (MODES, RESPONSE, DEFLECTION)
#: natural frequencies of a row at most, by default and on request
MOST_MODES = 20
MOST_SHAPES = 200
#: words on error bars of a row
UNBARRED = "none: run system-modes, response or deflect on one variant"
#: peaks of the mesh force
PEAKS = 3
#: column of the lowest frequency at which the dynamic mesh force is larger than the mean one, Hz
PARTS = "parts_from_hz"
#: loads of a bearing, N, N and N m
LOADS = ("radial", "axial", "moment")


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
    settings: Mapping[Any, Mapping]  #: builder options by (side, model)
    mesh: str | None  #: the one whose transmission error drives the train; the first by default
    first: int  #: a variant that can be read

    @cached_property
    def bench(self) -> Bench:
        """Shafts and trains kept from row to row."""
        return Bench(self.reduction, self.kept, self.settings)

    @cached_property
    def usual(self) -> Train:
        """Train of the first variant that can be read."""
        return self.variants.variant(self.first)

    @property
    def misalignments(self) -> tuple[str, ...]:
        return tuple(measured_names(self.usual))

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
            out |= dict.fromkeys(_loads(train), float)
        if train.operation:
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
    def plan(self) -> dict[str, Any]:
        variants, usual = self.variants, self.usual
        tables = variants.tables(self.first)
        # further files that these name
        cells = [cell.model_dump() for mesh in usual.meshes for cell in mesh.contact_cells]
        parts = [shaft.scene.body for shaft in usual.shafts.values()]
        return {
            "files": {name or "train": tables_for_plan(tables[name]) for name in tables},
            "cells": cells,
            "parts": [part and part.model_dump(mode="json") for part in parts],
            "scenes": {word: tables_for_plan(scene) for word, scene in variants.scenes_in_turn()},
            "point": variants.point,
            "models": [*self.models.values()],
            "mesh": self.mesh,
            "n": self.n,
            "max_frequency": self.max_frequency,
            "reduction": [self.reduction, self.kept],
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
        numbers: dict[str, Any] = {BARS: UNBARRED}
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
        key, on_shafts = self.variants.beside_operation(index), (SHAFT,) * len(self.models)
        state = self.bench.operating(key, train, *on_shafts).at(point)
        at_rest = with_settled_bearings(train, state)
        out: dict[str, Any] = {
            "torque": point.torque,
            **{force_of(name): force for name, force in state.mesh_forces.items()},
            "unloaded": ", ".join(at_rest.unloaded),
        }
        if DEFLECTION in self.ask:
            models = tuple(map(statics_of, self.models.values()))
            operating = self.bench.operating(key, train, *models)
            deflected = state if models == on_shafts else operating.at(point)
            assembly = operating.assembly.on_flank(point.coast)
            for measure in misalignment(assembly, deflected.system):
                out[misaligned(measure.name)] = float(measure.row @ deflected.coordinates)
            for turn in over_a_turn(operating.assembly, deflected, deflected.models):
                out[once(turn.stage)] = max(planet.once for planet in turn.planets)
            out |= _bearing_loads(deflected)
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
    train: Path,
    design: Design,
    *,
    pinion: str | None = None,
    gear: str | None = None,
    models: Mapping[str, str] | None = None,
    mesh: str | None = None,
    ask: Iterable[str] = ASKED,
    n: int | None = None,
    max_frequency: float | None = None,
    point: str | None = None,
    every_point: bool = False,
    reduction: str = "rubin",
    kept: int = KEPT,
    local_harmonics: Sequence[int] = (),
    settings: Mapping[Any, Mapping] | None = None,
) -> TrainTask:
    """Natural frequencies, mesh force and misalignment of many variants of a train.

    Parameters
    ----------
    train : Path
        Of the train file.
    design : Design
        Entries that vary: any number or word of the train file, or of the scene of a shaft, such as
        ``pinion.bearing.2.position=140 mm:160 mm:5``. The change is made to the tables of the file,
        and every rule of the file applies.
    pinion, gear : str, optional
        Models of the shafts of these names, as of ``system-modes``; ``harmonic`` by default.
    models : mapping of str to str, optional
        Models of shafts by any name.
    mesh : str, optional
        Whose transmission error drives the train; the first by default.
    ask : iterable of str
        Kinds of numbers of a row: some of ``system-modes``, ``response`` and ``deflect``; all by
        default.
    n : int, optional
        Elastic modes of a row; those up to the highest frequency by default.
    max_frequency : float, optional
        Hz; that of the file by default.
    point : str, optional
        Operating point of all rows, by its name or number; the first by default, or the one that
        varies.
    every_point : bool
        A row for each operating point of the file.
    reduction, kept, settings
        As for :class:`solidgear.trains.assembly.assembly.Assembly`.
    local_harmonics : sequence of int
        Of every mesh, in place of those of the file.

    Raises
    ------
    SolidgearError
        A path or a value that no variant can have, and too many variants.

    Examples
    --------
    >>> design = Design(("mesh.stiffness=2e8 N/m:3e8 N/m:3",))
    >>> beams = {"pinion": "euler", "gear": "euler"}
    >>> task = train_task(Path("geometry/axle_overhung.toml"), design, **beams)
    >>> [row["status"] for row in task.rows(range(3))], task.bench.made
    (['ok', 'ok', 'ok'], 2)
    """
    kinds = _kinds(ask)
    by_side = {"pinion": pinion, "gear": gear}
    chosen = {side: model for side, model in by_side.items() if model is not None}
    chosen |= models or {}
    for model in chosen.values():
        checked_model(model)
    if n is not None:
        number("sweep", "n", n, least=1, below=MOST_SHAPES + 1, whole=True)
    variants = train_variants(
        train, design, point=point, every_point=every_point, local_harmonics=local_harmonics
    )
    first, usual = variants.first_sound()
    usual.named_mesh(mesh)
    for side in chosen:
        usual.named_shaft(side)
    return TrainTask(
        variants,
        models={side: chosen.get(side, JUDGE) for side in usual.shafts},
        ask=kinds,
        n=n,
        max_frequency=max_frequency,
        reduction=reduction,
        kept=kept,
        settings=dict(settings or {}),
        mesh=mesh,
        first=first,
    )


def _kinds(ask: Iterable[str]) -> tuple[str, ...]:
    """Return the kinds of numbers of rows, in the usual order."""
    kinds = list(ask)
    for word in kinds:
        if word not in ASKED:
            raise SolidgearError(
                f"--ask {show(word, 40)}: give one or more of "
                f"{', '.join(ASKED)}{nearest(word, ASKED)}"
            )
    if not kinds:
        raise SolidgearError(f"--ask: name one or more of {', '.join(ASKED)}")
    return tuple(word for word in ASKED if word in kinds)


def statics_of(model: str) -> str:
    """Return the model of a shaft at rest: in place of a lumped one, which has no bearings, that of its
    body.
    """
    kind, base = checked_model(model)
    return base if kind in LUMPED else model


def once(stage: str) -> str:
    """Return the column of the amplitude of the mesh force of a planet once a turn of the carrier."""
    return f"once_a_turn_{stage.replace(' ', '_')}"


def _loads(train: Train) -> Iterator[str]:
    """Yield the columns of the loads of every bearing."""
    for side, shaft in train.shafts.items():
        for name in _loaded_bearings(shaft.scene):
            yield from (f"{side}.{name}.{load}" for load in LOADS)


def _loaded_bearings(scene: Scene) -> list[str]:
    """Return the names of the bearings of a shaft that can carry a load."""
    return [b.name for b in scene.bearings if b.catalogue is not None or np.any(b.stiffness)]


def _bearing_loads(state: OperatingState) -> dict[str, float]:
    """Return the load of every bearing: across the shaft, along it and against tilting."""
    out: dict[str, float] = {}
    for end, load in state.equilibrium.load.items():
        values = np.hypot(load[0], load[2]), load[1], np.hypot(load[3], load[5])
        out |= {f"{end}.{name}": float(value) for name, value in zip(LOADS, values)}
    return out
