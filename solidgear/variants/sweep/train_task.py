"""Solution of one variant of a sweep of trains, as a row."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core.errors import SolidgearError, nearest, show
from solidgear.core.models.limits import number
from solidgear.core.scene import Scene
from solidgear.strength.deflection.misalignment import measured_names, misalignment
from solidgear.trains.assembly.layout import contacts
from solidgear.trains.assembly.models import KEPT
from solidgear.trains.assembly.shaft import JUDGE, LUMPED, checked_model
from solidgear.trains.assembly.turn import over_a_turn, stages_over_a_turn
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.train import Train
from solidgear.trains.load.operation import SHAFT, OperatingState, with_settled_bearings
from solidgear.trains.modes.modes import refuse_unresolved
from solidgear.trains.modes.parting import joint_name, parting_frequency, teeth_relief
from solidgear.trains.response.respond import Drive
from solidgear.variants.sweep.bearing_task import BARS, BOUND
from solidgear.variants.sweep.bench import Bench
from solidgear.variants.sweep.curves import force_of, misaligned
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.file_task import FileTask
from solidgear.variants.sweep.file_variants import plain
from solidgear.variants.sweep.train_variants import TrainVariants, train_variants

#: what a row may tell, by the commands that tell the same of one train
MODES, RESPONSE, DEFLECTION = "system-modes", "response", "deflect"
ASKED = (MODES, RESPONSE, DEFLECTION)
#: natural frequencies of a row, unless it is asked for so many
MOST_MODES = 20
#: most that can be asked for
MOST_SHAPES = 200
#: words on bars of a row
UNBARRED = "none: system-modes and response and deflect have those of one variant"
#: peaks of the mesh force
PEAKS = 3
#: column of the lowest frequency at which the dynamic mesh force is larger than the mean one, Hz
PARTS = "parts_from_hz"
#: of a bearing, N, N and N m
CARRIED = ("radial", "axial", "moment")


@dataclass(frozen=True)
class TrainTask(FileTask):
    """Everything that turns variants of a train into rows."""

    variants: TrainVariants
    models: Mapping[str, str]  #: by shaft, in the sequence of the file
    ask: tuple[str, ...]  #: some of `ASKED`
    #: elastic modes; those up to the highest frequency, `MOST_MODES` at most, by default
    n: int | None
    max_frequency: float | None  #: hz; that of the file by default
    reduction: str
    kept: int
    settings: Mapping[Any, Mapping]  #: builder options by (side, model)
    mesh: str | None  #: whose transmission error drives the train; the first by default
    first: int  #: a variant that can be read

    @cached_property
    def bench(self) -> Bench:
        """Things kept from row to row."""
        return Bench(self.reduction, self.kept, self.settings)

    @cached_property
    def usual(self) -> Train:
        """Train of the first variant that can be read."""
        return self.variants.of(self.first)

    @property
    def measured(self) -> tuple[str, ...]:
        return tuple(measured_names(self.usual))

    @property
    def cautions(self) -> tuple[str, ...]:
        """Things that do not fit together in the usual train but can be solved."""
        met = tuple(text for met in contacts(self.usual).values() for text in met.cautions)
        return met + self.variants.cautions

    @property
    def columns(self) -> dict[str, type]:
        train, out = self.usual, dict[str, type]()
        if train.operation:
            out |= {"torque": float} | {force_of(one.name): float for one in train.joints}
        if train.operation and DEFLECTION in self.ask:
            out |= dict.fromkeys(map(misaligned, self.measured), float)
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
        files = {name or "train": plain(t) for name, t in variants.tables(self.first).items()}
        # what these files name
        cells = [cell.model_dump() for mesh in usual.meshes for cell in mesh.contact_cells]
        parts = [own.scene.body for own in usual.shafts.values()]
        return {
            "files": files,
            "cells": cells,
            "parts": [part and part.model_dump(mode="json") for part in parts],
            "scenes": {word: plain(tables) for word, tables in variants.scenes_in_turn()},
            "point": variants.point,
            "models": [*self.models.values()],
            "mesh": self.mesh,
            "n": self.n,
            "max_frequency": self.max_frequency,
            "reduction": [self.reduction, self.kept],
            "set": plain({" ".join(key): dict(own) for key, own in self.settings.items()}),
        }

    def cut(self, columns: Mapping[str, list[Any]]) -> int:
        """Natural frequencies up to the highest frequency that the widest row has and no column
        holds.
        """
        widest = max((count for count in columns.get("modes", []) if count), default=0)
        return max(0, widest - MOST_MODES) if self.n is None else 0

    def numbers(self, index: int) -> dict[str, Any]:
        train = self.variants.of(index)
        point = self.variants.at(index, train)
        at, found = train, dict[str, Any]({BARS: UNBARRED})
        if point is not None:
            at, rest = self._at_rest(index, train, point)
            found |= rest
        if {MODES, RESPONSE} & {*self.ask}:
            found |= self._moving(at, found)
        return found

    # ------------------------------------------------------------------------------ at rest
    def _at_rest(
        self, index: int, train: Train, point: OperatingPoint
    ) -> tuple[Train, dict[str, Any]]:
        """A train whose bearings have settled at an operating point, and what is told of it there."""
        key, on_shafts = self.variants.beside_operation(index), (SHAFT,) * len(self.models)
        state = self.bench.operating(key, train, *on_shafts).at(point)
        at = with_settled_bearings(train, state)
        out: dict[str, Any] = {
            "torque": point.torque,
            **{force_of(name): force for name, force in state.mesh_forces.items()},
            "unloaded": ", ".join(at.unloaded),
        }
        if DEFLECTION in self.ask:
            models = tuple(map(statics_of, self.models.values()))
            operating = self.bench.operating(key, train, *models)
            told = state if models == on_shafts else operating.at(point)
            shop = operating.workshop.on_flank(point.coast)
            out |= {
                misaligned(one.name): float(one.row @ told.coordinates)
                for one in misalignment(shop, told.system)
            }
            turns = over_a_turn(operating.workshop, told, told.models)
            out |= {once(turn.stage): max(one.once for one in turn.planets) for turn in turns}
            out |= _carried(told)
        return at, out

    # ------------------------------------------------------------------------------ moving
    def _moving(self, train: Train, at_rest: Mapping[str, Any]) -> dict[str, Any]:
        """Natural frequencies and peaks of the mesh force, and where the teeth part by what they
        carry at rest.
        """
        shop = self.bench.workshop(train, *self.models.values())
        drive = Drive(shop, *self.models.values(), mesh=self.mesh)
        limit = self.max_frequency or train.ask.max_frequency
        refuse_unresolved(shop, drive.system, limit)
        out: dict[str, Any] = {}
        if MODES in self.ask:
            below = int((drive.system.elastic[0] <= 2 * np.pi * limit).sum())
            wanted = self.n or min(below, MOST_MODES)
            found, names = drive.named_modes(max(wanted, drive.reach(limit)), bounded=wanted)
            elastic = slice(found.rigid, found.rigid + wanted)
            out |= {"rigid_modes": found.rigid, "modes": below}
            out[BOUND] = float(found.error_bound[elastic].max(initial=0.0))
            for k, (hz, name) in enumerate(
                zip(found.frequency_hz[elastic], names[elastic]), start=1
            ):
                out |= {f"f{k}_hz": float(hz), f"mode{k}": name}
        if RESPONSE in self.ask:
            hz = drive.grid(limit)
            largest = sorted(drive.curve(hz).peaks, key=lambda top: -top.force)[:PEAKS]
            for k, top in enumerate(largest, start=1):
                out |= {f"peak{k}_hz": top.frequency_hz, f"peak{k}_force": top.force}
                out[f"peak{k}_mode"] = top.mode
            mean = at_rest.get(force_of(joint_name(drive.pair)))
            if mean is not None:
                low = parting_frequency(hz, teeth_relief(drive, drive.over_cycle(hz, limit)), mean)
                out |= {} if low is None else {PARTS: low}
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
        Some of ``system-modes``, ``response`` and ``deflect``: what a row tells, all by default.
    n : int, optional
        Elastic modes of a row; those up to the highest frequency by default.
    max_frequency : float, optional
        Hz; that of the file by default.
    point : str, optional
        Operating point that is looked at, by its name or number; the first by default, or the one
        that varies.
    every_point : bool
        A row for each operating point of the file.
    reduction, kept, settings
        As of :class:`solidgear.trains.assembly.models.Workshop`.
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
    asked = _asked(ask)
    given = {side: one for side, one in (("pinion", pinion), ("gear", gear)) if one is not None}
    given |= models or {}
    for model in given.values():
        checked_model(model)
    if n is not None:
        number("sweep", "n", n, least=1, below=MOST_SHAPES + 1, whole=True)
    variants = train_variants(
        train, design, point=point, every_point=every_point, local_harmonics=local_harmonics
    )
    first, usual = variants.first_sound()
    usual.named_mesh(mesh)
    for side in given:
        usual.named_shaft(side)
    mix = {side: given.get(side, JUDGE) for side in usual.shafts}
    how = reduction, kept, dict(settings or {}), mesh
    return TrainTask(variants, mix, asked, n, max_frequency, *how, first)


def _asked(ask: Iterable[str]) -> tuple[str, ...]:
    """Kinds of numbers that rows tell, in the usual order."""
    given = list(ask)
    for word in given:
        if word not in ASKED:
            raise SolidgearError(
                f"--ask {show(word, 40)}: a row tells what {', '.join(ASKED)} tell"
                f"{nearest(word, ASKED)}"
            )
    if not given:
        raise SolidgearError(f"--ask: name one or more of {', '.join(ASKED)}")
    return tuple(word for word in ASKED if word in given)


def statics_of(model: str) -> str:
    """Model that a shaft is put at rest by: a lumped one has no bearings of its own, and the body it
    comes from takes its place.
    """
    kind, base = checked_model(model)
    return base if kind in LUMPED else model


def once(stage: str) -> str:
    """Column of what the largest mesh force of a planet varies by once a turn of its carrier."""
    return f"once_a_turn_{stage.replace(' ', '_')}"


def _loads(train: Train) -> Iterator[str]:
    """Columns of what every bearing carries."""
    for side, own in train.shafts.items():
        for name in _bearings(own.scene):
            yield from (f"{side}.{name}.{what}" for what in CARRIED)


def _bearings(scene: Scene) -> list[str]:
    """Bearings of a shaft that can carry."""
    return [b.name for b in scene.bearings if b.catalogue is not None or np.any(b.stiffness)]


def _carried(state: OperatingState) -> dict[str, float]:
    """Load of every bearing: across the shaft, along it and against tilting."""
    out: dict[str, float] = {}
    for end, load in state.equilibrium.load.items():
        values = np.hypot(load[0], load[2]), load[1], np.hypot(load[3], load[5])
        out |= {f"{end}.{what}": float(value) for what, value in zip(CARRIED, values)}
    return out
