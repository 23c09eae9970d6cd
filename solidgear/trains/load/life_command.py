"""Lives of the bearings of a train, as the command on bearings prints them."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from solidgear.bearings.life_command import plain_life
from solidgear.core.errors import SolidgearError
from solidgear.show.command import say
from solidgear.show.table import Column, Table
from solidgear.show.words import engineering, percent
from solidgear.trains.load.life import TrainBearingLife, train_lives
from solidgear.trains.loading import load_train


def show_train(
    path: Path, name: str | None, other: Mapping[str, Any], as_json: bool = False
) -> None:
    """Print lives at all operating points of a train, and over its duty table.

    Parameters
    ----------
    name : str or None
        Of the one bearing that is asked for, such as ``pinion.A``.
    other : mapping of str to object
        Options that belong to a scene; none of them may be set.
    """
    for option, value in other.items():
        if value:
            raise SolidgearError(
                f"{option} belongs to a scene; of a train the [operation] says torque and speed"
            )
    found = [one for one in train_lives(load_train(path)) if name in (None, one.end)]
    if not found:
        raise SolidgearError(
            f"--bearing {name}: no bearing of catalogue data has this name; write shaft and name, "
            "such as pinion.A"
        )
    if as_json:
        print(json.dumps({"train": path.stem, "bearings": [_plain(one) for one in found]}))
        return
    _print_points(found)
    _print_duty(found)


def _number(value: float | None) -> str:
    return "endless" if value == math.inf else engineering(value, 3)


def _print_points(found: list[TrainBearingLife]) -> None:
    """Print what each bearing lives at each operating point."""
    rows = [(one, k) for one in found for k in range(len(one.points))]
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
    if told := found[0].lives[0].told:
        say(f"From and to: {told} at their ends.")
    for one in found:
        notes = [note for life in one.lives for note in life.life.notes]
        for note in dict.fromkeys(notes):
            say(f"caution: bearing {one.end!r}: {note}")


def _modified(one: TrainBearingLife, k: int) -> float | None:
    own = one.lives[k].life.modified
    return None if own is None else own.life


def _print_duty(found: list[TrainBearingLife]) -> None:
    """Print lives over the duty table, where there is one."""
    rows = [(one, one.duty) for one in found if one.duty is not None]
    if not rows:
        say("No life over all points: give each its speed, and its share or hours.")
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
    say("Over all points damage adds up (Palmgren, Miner).")


def _plain(one: TrainBearingLife) -> dict[str, Any]:
    """Lives of a bearing as plain data, SI; what has no end is None."""

    def known(value: float) -> float | None:
        return value if math.isfinite(value) else None

    duty = one.duty
    points = [{"at": point.label} | plain_life(life) for point, life in zip(one.points, one.lives)]
    over = None
    if duty is not None:
        over = {
            "hours": known(duty.hours),
            "revolutions": known(duty.revolutions),
            "of": one.kind,
            "damage": list(duty.damage),
            "worst": duty.worst,
        }
    return {"bearing": one.end, "points": points, "duty": over}
