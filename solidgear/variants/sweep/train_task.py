"""Rows of a sweep of trains: natural frequencies, peaks of the mesh force, and numbers at rest."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from solidgear.core import (
    SolidgearError,
    Source,
    read_tolerance,
)
from solidgear.core.loading import MESH
from solidgear.core.models.limits import number
from solidgear.guards.one_shaft import mass_of
from solidgear.strength.deflection.misalignment import measured_names, misalignment
from solidgear.teeth.mesh_contact import SolvedMesh
from solidgear.teeth.study import touching
from solidgear.teeth.train_teeth import solved_mesh, with_teeth
from solidgear.trains.assembly.assembly import KEPT, NO_MODES, Assembly
from solidgear.trains.assembly.mesh_stiffness import asks_for_teeth, solved_meshes
from solidgear.trains.assembly.shaft import JUDGE, LUMPED, checked_model, usual_models
from solidgear.trains.assembly.turn import over_a_turn, stages_over_a_turn
from solidgear.trains.file.flanks import Flanks
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.train import Train
from solidgear.trains.load.lives import lives_in
from solidgear.trains.load.operation import Operating, with_settled_bearings
from solidgear.trains.load.state import OperatingState
from solidgear.trains.modes.modes import refuse_unresolved
from solidgear.trains.modes.parting import joint_name, parting_frequency, teeth_relief
from solidgear.trains.response.drive import Drive
from solidgear.variants.sweep.bench import Bench
from solidgear.variants.sweep.curves import force_of, misaligned
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.error_curves import over_torque
from solidgear.variants.sweep.file_task import BARS, BOUND, CAUTIONS, FileTask, named_kinds
from solidgear.variants.sweep.file_variants import tables_for_plan
from solidgear.variants.sweep.life_numbers import life_columns, life_numbers
from solidgear.variants.sweep.tooth_numbers import TOOTH_UNITS, TeethBench, of_mesh, tooth_numbers
from solidgear.variants.sweep.train_variants import TrainVariants, train_variants

#: kinds of numbers of a row, by the commands that show the same of one train
MODES, RESPONSE, DEFLECTION = "system-modes", "response", "deflect"
BEARING, CONTACT = "bearing", "contact"
BY_DEFAULT = (MODES, RESPONSE, DEFLECTION)
ASKED = (*BY_DEFAULT, BEARING, CONTACT)
#: natural frequencies of a row at most, by default and on request
MOST_MODES = 20
MOST_SHAPES = 200
#: peaks of the mesh force
PEAKS = 3
#: column of the lowest frequency at which the dynamic mesh force is larger than the mean one, Hz
PARTS = "parts_from_hz"
#: loads of a bearing, N, N and N m
LOADS = ("radial", "axial", "moment")
#: column of the mass of all shafts, without heads and rigid masses, kg
MASS = "mass"


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
    def settling(self) -> Bench:
        """Shafts on which bearings find the stiffness that motion sees, by whichever model."""
        return Bench(self.reduction, NO_MODES, {JUDGE: MESH})

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

    @cached_property
    def _in_contact(self) -> dict[int, list[SolvedMesh]]:
        """Meshes of the last row whose teeth were solved, by its variant."""
        return {}

    def cautions_of(self, index: int) -> tuple[str, ...]:
        train, of_contact = self.variant(index), list[str]()
        point = self.variants.operating_point(index, train)
        if point is not None and point.torque and (CONTACT in self.ask or asks_for_teeth(train)):
            carried = self.teeth.carried(self.variants.beside_flanks(index), train, point)
            meshes = self._in_contact.get(index, ())
            of_contact += (text for mesh in meshes for text in mesh.cautions)
            train = with_teeth(train, carried)
        cautions = Assembly(train).cautions_at_rest(*self.models.values())
        return tuple(dict.fromkeys((*cautions, *of_contact)))

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
        if train.operation and BEARING in self.ask:
            out |= life_columns(catalogued_ends(train))
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
        return out | {MASS: float, BARS: str, CAUTIONS: str}

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
        train = self.variant(index)
        point = self.variants.operating_point(index, train)
        masses = [mass_of(shaft.scene)[0] for shaft in train.shafts.values()]
        numbers: dict[str, Any] = {BARS: self.without_bars, MASS: sum(masses)}
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
        of_teeth = {}
        if CONTACT in self.ask:
            self._in_contact.clear()
            self._in_contact[index] = [solved_mesh(carried, mesh) for mesh in touching(train)]
            of_teeth = tooth_numbers(self._in_contact[index])
        if self.ask == (CONTACT,):
            at_rest = carried.assembly.train
            return at_rest, of_teeth | _loads(carried.state, at_rest)
        if asks_for_teeth(train):
            key = *key, index  # no other row has its mesh stiffness
            points = {point, *duty_points(train)} if BEARING in self.ask else {point}
            solved = {p: self.teeth.solved(key[:-1], train, p) for p in points if p.torque}
            train = train.with_solved_meshes(solved_meshes(solved))
        at_rest, out = self._settled(key, train, point)
        return at_rest, of_teeth | out

    def _settled(
        self, key: Hashable, train: Train, point: OperatingPoint
    ) -> tuple[Train, dict[str, Any]]:
        """Return a train whose bearings have settled at an operating point, and its numbers there but
        for those of teeth.
        """
        at_rest, out = train, {}
        if {MODES, RESPONSE} & {*self.ask}:
            moved_about = self.settling.operating(key, train, JUDGE).at(point)
            at_rest = with_settled_bearings(moved_about.assembly.train, moved_about)
            out = _loads(moved_about, at_rest)
        if {DEFLECTION, BEARING} & {*self.ask}:
            out |= self._loaded(key, train, point)
        return at_rest, out

    def _loaded(self, key: Hashable, train: Train, point: OperatingPoint) -> dict[str, Any]:
        """Return loads, lives and deflection of a train on the models of the rows."""
        models = tuple(map(statics_of, self.models.values()))
        operating = self.bench.operating(key, train, *models)
        state = operating.at(point)
        out = _loads(state, with_settled_bearings(state.assembly.train, state))
        if BEARING in self.ask:
            out |= life_numbers(lives_in(train, [duty_states(train, operating, state)]))
        if DEFLECTION in self.ask:
            for measure in misalignment(state.assembly, state.system):
                out[misaligned(measure.name)] = float(measure.row @ state.coordinates)
            for turn in over_a_turn(operating.assembly, state, state.models):
                out[once(turn.stage)] = max(planet.once for planet in turn.planets)
            for end, load in state.equilibrium.load.items():
                # across the shaft, along it and against tilting
                loads = np.hypot(load[0], load[2]), load[1], np.hypot(load[3], load[5])
                out |= {f"{end}.{name}": float(value) for name, value in zip(LOADS, loads)}
        return out

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
    point: str | int | None = None,
    every_point: bool = False,
    reduction: str = "rubin",
    kept: int = KEPT,
    tolerance: float | str | None = None,
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
    asked = named_kinds(ask, ASKED, "a train")
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
        models=usual_models(usual.shafts) | chosen,
        ask=asked,
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


def catalogued_ends(train: Train) -> list[str]:
    """Return the bearings of catalogue data, as ``side.name``."""
    return [
        f"{side}.{bearing.name}"
        for side, shaft in train.shafts.items()
        for bearing in shaft.scene.bearings
        if bearing.catalogue is not None
    ]


def duty_states(train: Train, operating: Operating, state: OperatingState) -> list[OperatingState]:
    """Return the states at all operating points where these are a duty table, each begun at the state;
    else the state alone.
    """
    return [operating.at(point, state) for point in duty_points(train)] or [state]


def duty_points(train: Train) -> tuple[OperatingPoint, ...]:
    """Return the operating points of a train where these are a duty table."""
    table = all(p.speed and (p.share is not None or p.hours is not None) for p in train.operation)
    return train.operation if table and len(train.operation) > 1 else ()


def statics_of(model: str) -> str:
    """Return the model of a shaft at rest: in place of a lumped one, which has no bearings, that of its
    body.
    """
    kind, base = checked_model(model)
    return base if kind in LUMPED else model


def once(stage: str) -> str:
    """Return the column of the amplitude of the mesh force of a planet once a turn of the carrier."""
    return f"once_a_turn_{stage.replace(' ', '_')}"
