"""Solution of one variant of a sweep of trains, as a row."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.machine.threads import pinned
from solidgear.scene import Scene
from solidgear.scene.operation import OperatingPoint
from solidgear.scene.train import Train
from solidgear.studies.sweep.bench import Bench
from solidgear.studies.sweep.train_variants import TrainVariants
from solidgear.studies.train.misalignment import measured_names, misalignment
from solidgear.studies.train.models import KEPT
from solidgear.studies.train.modes import refuse_unresolved
from solidgear.studies.train.operation import SHAFT, OperatingState, settled
from solidgear.studies.train.respond import Drive
from solidgear.studies.train.shaft import LUMPED, checked_rung
from solidgear.studies.train.turn import over_a_turn, told_over_a_turn

#: what a row may tell, by the commands that tell the same of one train
MODES, RESPONSE, DEFLECTION = "system-modes", "response", "deflect"
ASKED = (MODES, RESPONSE, DEFLECTION)
#: natural frequencies of a row, unless it is asked for so many
MOST_MODES = 20
#: peaks of the mesh force
PEAKS = 3
#: of a bearing, N, N and N m
CARRIED = ("radial", "axial", "moment")


@dataclass(frozen=True)
class TrainTask:
    """Everything that turns variants of a train into rows.

    Attributes
    ----------
    models : dict of str to str
        By shaft, in the sequence of the file.
    ask : tuple of str
        Some of `ASKED`.
    n : int or None
        Elastic modes; those up to the highest frequency, `MOST_MODES` at most, by default.
    max_frequency : float or None
        Hz; that of the file by default.
    settings : mapping
        Builder options by (side, model).
    mesh : str or None
        Whose transmission error drives the train; the first by default.
    """

    variants: TrainVariants
    models: Mapping[str, str]
    ask: tuple[str, ...] = ASKED
    n: int | None = None
    max_frequency: float | None = None
    reduction: str = "rubin"
    kept: int = KEPT
    settings: Mapping[Any, Mapping] = field(default_factory=dict)
    mesh: str | None = None

    @cached_property
    def bench(self) -> Bench:
        """Things kept from row to row; not sent to other processes."""
        return Bench(self.reduction, self.kept, self.settings)

    def __getstate__(self) -> dict[str, Any]:
        return {key: value for key, value in vars(self).items() if key != "bench"}

    def columns(self, train: Train) -> dict[str, type]:
        """Names and types of the columns of a row of such a train, in order."""
        out: dict[str, type] = {"variant": int}
        out |= self.variants.columns
        out["status"] = str
        if train.operation:
            out |= {"torque": float} | {force_of(one.name): float for one in train.joints}
        if train.operation and DEFLECTION in self.ask:
            out |= dict.fromkeys(map(misaligned, measured_names(train)), float)
            out |= {once(stage.called): float for stage in told_over_a_turn(train)}
            out |= dict.fromkeys(_loads(train), float)
        if train.operation:
            out["unloaded"] = str
        if MODES in self.ask:
            out |= {"rigid_modes": int, "modes": int, "error_bound": float}
            for k in range(1, (self.n or MOST_MODES) + 1):
                out |= {f"f{k}_hz": float, f"mode{k}": str}
        if RESPONSE in self.ask:
            for k in range(1, PEAKS + 1):
                out |= {f"peak{k}_hz": float, f"peak{k}_force": float, f"peak{k}_mode": str}
        return out

    @pinned
    def rows(self, indices: Iterable[int]) -> list[dict[str, Any]]:
        """Rows of some variants; none depends on those before it."""
        return [self._row(index) for index in indices]

    def _row(self, index: int) -> dict[str, Any]:
        row: dict[str, Any] = {"variant": index, **self.variants.told(index)}
        try:
            train = self.variants.train(index)
            point = self.variants.at(index, train)
            at, found = train, dict[str, Any]()
            if point is not None:
                at, found = self._at_rest(index, train, point)
            if {MODES, RESPONSE} & {*self.ask}:
                found |= self._moving(at)
        except SolidgearError as error:
            return row | {"status": self.variants.status(error, index)}
        return row | {"status": "ok"} | found

    # ------------------------------------------------------------------------------ at rest
    def _at_rest(
        self, index: int, train: Train, point: OperatingPoint
    ) -> tuple[Train, dict[str, Any]]:
        """A train whose bearings have settled at an operating point, and what is told of it there."""
        key, on_shafts = self.variants.beside_operation(index), (SHAFT,) * len(self.models)
        state = self.bench.operating(key, train, *on_shafts).at(point)
        at = settled(train, state)
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
    def _moving(self, train: Train) -> dict[str, Any]:
        """Natural frequencies and peaks of the mesh force."""
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
            out["error_bound"] = float(found.error_bound[elastic].max(initial=0.0))
            for k, (hz, name) in enumerate(
                zip(found.frequency_hz[elastic], names[elastic]), start=1
            ):
                out |= {f"f{k}_hz": float(hz), f"mode{k}": name}
        if RESPONSE in self.ask:
            hz = drive.grid(limit)
            tops = drive.peaks(hz, drive.mesh(hz)[1])
            largest = sorted(tops, key=lambda top: -top.force)[:PEAKS]
            for k, top in enumerate(largest, start=1):
                out |= {f"peak{k}_hz": top.frequency_hz, f"peak{k}_force": top.force}
                out[f"peak{k}_mode"] = top.mode
        return out


def statics_of(model: str) -> str:
    """Model that a shaft is put at rest by: a lumped one has no bearings of its own, and the body it
    comes from takes its place.
    """
    kind, base = checked_rung(model)
    return base if kind in LUMPED else model


def force_of(mesh: str) -> str:
    """Column of the force of a mesh at rest."""
    return f"mesh_force{mesh.removeprefix('mesh').replace(' ', '_')}"


def once(stage: str) -> str:
    """Column of what the largest mesh force of a planet varies by once a turn of its carrier."""
    return f"once_a_turn_{stage.replace(' ', '_')}"


def misaligned(name: str) -> str:
    """Column of a number of the misalignment."""
    return f"misalignment_{name.replace(' ', '_')}"


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
