"""Lives of the bearings of a train over the operating points, and the command that prints them."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from solidgear.bearings.bearing_life import BearingLife, left_open, life_of
from solidgear.bearings.duty import DutyLife, DutyPoint, duty_life
from solidgear.bearings.life_command import plain_life
from solidgear.bearings.solved import AS_STATED
from solidgear.core import SolidgearError
from solidgear.core.plain import plain
from solidgear.show.command import say
from solidgear.show.table import Column, Table
from solidgear.show.words import engineering, percent
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.train import Train
from solidgear.trains.load.operation import Operating, OperatingState
from solidgear.trains.loading import load_train


def show_train(
    path: Path, name: str | None, options: Mapping[str, Any], as_json: bool = False
) -> None:
    """Print lives at all operating points of a train, and over its duty table.

    Parameters
    ----------
    name : str or None
        Of the one bearing that is asked for, such as ``pinion.A``.
    options : mapping of str to object
        Options that belong to a scene; none of them may be set.
    """
    for option, value in options.items():
        if value:
            raise SolidgearError(
                f"{option} belongs to a scene; for a train give torque and speed in [operation]"
            )
    lives = [bearing for bearing in train_lives(load_train(path)) if name in (None, bearing.end)]
    if not lives:
        raise SolidgearError(
            f"--bearing {name}: no bearing of catalogue data has this name; write shaft and name, "
            "such as pinion.A"
        )
    if as_json:
        print(json.dumps({"train": path.stem, "bearings": [_plain(bearing) for bearing in lives]}))
        return
    _print_points(lives)
    _print_duty(lives)


def _number(value: float | None) -> str:
    return "endless" if value == math.inf else engineering(value, 3)


def _print_points(lives: list[TrainBearingLife]) -> None:
    """Print the life of each bearing at each operating point."""
    rows = [(bearing, k) for bearing in lives for k in range(len(bearing.points))]
    columns = [
        Column("bearing", lambda row: row[0].end),
        Column("at", lambda row: row[0].points[row[1]].label, kind="text"),
        Column("L10", lambda row: row[0].lives[row[1]].life.basic, _number),
        Column("L10r", lambda row: row[0].lives[row[1]].life.reference, _number),
        Column("from", lambda row: row[0].lives[row[1]].range("reference")[0], _number),
        Column("to", lambda row: row[0].lives[row[1]].range("reference")[1], _number),
        Column("Lnmr", lambda row: _modified(row[0], row[1]), _number),
        Column("C0/P0", lambda row: row[0].lives[row[1]].life.static_safety, _number),
    ]
    say(Table("", columns, rows))
    say(
        "Lives in revolutions: basic L10 (ISO 281), reference L10r (ISO/TS 16281) with its range, "
        "modified Lnmr (ISO 281, 9.3); static safety C0/P0 (ISO 76)."
    )
    if ranges := lives[0].lives[0].told:
        say(f"From and to: range over {ranges}.")
    for bearing in lives:
        notes = [note for life in bearing.lives for note in life.life.notes]
        for note in dict.fromkeys(notes):
            say(f"caution: bearing {bearing.end!r}: {note}")


def _modified(bearing: TrainBearingLife, k: int) -> float | None:
    modified = bearing.lives[k].life.modified
    return None if modified is None else modified.life


def _print_duty(lives: list[TrainBearingLife]) -> None:
    """Print lives over the duty table, where there is one."""
    rows = [(bearing, bearing.duty) for bearing in lives if bearing.duty is not None]
    if not rows:
        say("No life over all points: give each point its speed, and its share or hours.")
        return
    columns = [
        Column("bearing", lambda row: row[0].end),
        Column("hours", lambda row: row[1].hours, _number),
        Column("revolutions", lambda row: row[1].revolutions, _number),
        Column("of", lambda row: row[0].kind, kind="word"),
        Column("most damage at", lambda row: row[0].points[row[1].worst].label, kind="text"),
        Column("of all", lambda row: percent(row[1].damage[row[1].worst], signed=False)),
    ]
    say(Table("", columns, rows))
    say("Damage of all points is added (Palmgren, Miner).")


def _plain(bearing: TrainBearingLife) -> dict[str, Any]:
    """Return lives of a bearing as plain data in SI; infinite ones are None."""
    duty = bearing.duty
    points = [
        {"at": point.label} | plain_life(life) for point, life in zip(bearing.points, bearing.lives)
    ]
    all_points = None
    if duty is not None:
        all_points = {
            "hours": duty.hours,
            "revolutions": duty.revolutions,
            "of": bearing.kind,
            "damage": duty.damage,
            "worst": duty.worst,
        }
    return plain({"bearing": bearing.end, "points": points, "duty": all_points})


@dataclass(frozen=True)
class TrainBearingLife:
    """Lives of a bearing of a train."""

    end: str  #: shaft and bearing, such as ``pinion.A``
    points: tuple[OperatingPoint, ...]
    lives: tuple[BearingLife, ...]  #: at each of them

    @cached_property
    def kind(self) -> str:
        """Kind of life that duty adds up: the modified one where every loaded point has it."""
        finite = [life.life for life in self.lives if math.isfinite(life.life.reference)]
        modified = finite and all(life.modified is not None for life in finite)
        return "modified" if modified else "reference"

    @property
    def duty(self) -> DutyLife | None:
        """Life over the duty table; None where the points give neither speed nor shares."""
        weights = [p.share if p.share is not None else p.hours for p in self.points]
        single = len(weights) == 1
        if (None in weights and not single) or not all(life.speed for life in self.lives):
            return None
        return duty_life(
            [
                DutyPoint(
                    self._life_at_point(life),
                    life.speed,
                    1.0 if single else p.share,
                    None if single else p.hours,
                )
                for p, life in zip(self.points, self.lives)
            ]
        )

    def _life_at_point(self, bearing_life: BearingLife) -> float:
        life = bearing_life.life
        return life.modified.life if self.kind == "modified" and life.modified else life.reference


def train_lives(train: Train) -> list[TrainBearingLife]:
    """Return the life of every catalogue bearing of a train at all operating points; refused
    without points or catalogue bearings.
    """
    if not train.operation:
        raise SolidgearError(
            f"{train.name} has no operating point; write [operation] with a torque in its file"
        )
    scenes = {side: shaft.scene for side, shaft in train.shafts.items()}
    open_data, choices = left_open(scenes.values())
    assembly = Assembly(train)
    settled = [
        _states(Operating(assembly, choice=choice), train) for choice in (AS_STATED, *choices)
    ]
    lives_by_bearing = []
    for side, scene in scenes.items():
        for bearing in scene.bearings:
            if bearing.catalogue is None:
                continue
            end = f"{side}.{bearing.name}"
            lives = []
            for k, point in enumerate(train.operation):
                places = [(s[k].bearings[end], s[k].equilibrium.relative[end]) for s in settled]
                speed = point.speed_of(side, train.turns)
                lives.append(life_of(bearing, scene.lubrication, open_data, speed, places))
            lives_by_bearing.append(TrainBearingLife(end, train.operation, tuple(lives)))
    if not lives_by_bearing:
        raise SolidgearError(f"{train.name}: no bearing is described by catalogue data")
    return lives_by_bearing


def _states(operating: Operating, train: Train) -> list[OperatingState]:
    """Return the train at all points, each begun at the one before."""
    states: list[OperatingState] = []
    for point in train.operation:
        states.append(operating.at(point, states[-1] if states else None))
    return states
