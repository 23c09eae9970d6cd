"""Whole commands of this checkout, and of another in turn: the numbers they print, wall and processor
seconds, and the peak of the memory of the process with all that it starts.

Numbers of both checkouts are compared first: with error bars they may be as far apart as both bars
reach; others are only shown.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core.scene.document import is_train
from solidgear.core.scene.toml_file import parse
from validation.race.heat import Check, Heat, Lane, Sample
from validation.race.process import ROOT, PeerError, last_words, run

GEOMETRY, SCENES = ROOT / "geometry", ROOT / "tests" / "scenes"
#: shafts that are compared, of which all but the last two are answered
COMPARED = (
    GEOMETRY / "pinion_overhung.toml",
    SCENES / "input_shaft.toml",
    SCENES / "hypoid_pinion.toml",
    SCENES / "inaccurate_thin_tube.toml",
    GEOMETRY / "rotor_disc.toml",
    SCENES / "motor_rotor.toml",
)
ANSWERED = COMPARED[:5]
TOLERANCES = ("1e-2", "1e-3", "1e-4")
TRAINS = (
    "axle_overhung",
    "axle_straddle",
    "axle_thesis",
    "gearbox_train",
    "gearbox_two_stage",
    "gearbox_housed",
    "reducer",
)
OF_TRAINS = ("system-modes", "response", "deflect")
#: torque of a train whose file has no operating point
TORQUE = "100 N*m"
#: commands whose error bars are in the unit of their numbers
IN_UNITS = ("deflect",)
#: numbers that older checkouts define otherwise: the wind-up of gears is in them
REDEFINED = "f_sh"
#: of the largest number that stands beside one: less is rounding
ROUNDING = 1e-9
#: keys of numbers that are compared, and keys that name what they belong to
VALUES, NAMES = ("value", "frequency_hz", "force"), ("name", "quantity", "mode")


@dataclass(frozen=True)
class Number:
    """A number that a command prints, and its error bar in the same unit, if it has one."""

    value: float
    bar: float | None = None


def comparing(heat: Heat) -> None:
    """Enter `compare` of shafts."""
    for scene in (*COMPARED[: 1 if heat.quick else None], *further(heat, trains=False)):
        enter(heat, f"compare {scene.stem}", ["compare", str(scene.resolve()), "--out", "out"])


def answering(heat: Heat) -> None:
    """Enter `answer` of shafts, by tolerance."""
    for scene in (*ANSWERED[: 1 if heat.quick else None], *further(heat, trains=False)):
        for tol in TOLERANCES[: 1 if heat.quick else None]:
            words = ["answer", str(scene.resolve()), "--tol", tol, "--json"]
            enter(heat, f"answer {scene.stem} to {tol}", words)


def training(heat: Heat) -> None:
    """Enter modes, response and deflection of trains."""
    files = [GEOMETRY / f"{name}.toml" for name in TRAINS[: 1 if heat.quick else None]]
    for command in OF_TRAINS[: 1 if heat.quick else None]:
        for file in (*files, *further(heat, trains=True)):
            words = [command, str(file.resolve()), "--json"]
            if command == "deflect" and "operation" not in parse(str(file)):
                words += ["--torque", TORQUE]
            enter(heat, f"{command} {file.stem}", words)


def further(heat: Heat, trains: bool) -> list[Path]:
    """Return the further files that were given, trains or shafts."""
    return [file for file in heat.scenes if is_train(file) is trains]


def enter(heat: Heat, name: str, words: list[str]) -> None:
    """Enter a command by this checkout, and by another where one is given, with their ratio."""
    if heat.against is None:
        heat.add(name, partial(once, ROOT, words, heat.limit))
        return
    other = heat.against.resolve()
    heat.versions["the other checkout"] = commit(other)
    before = heat.add(f"{name}, other checkout", partial(once, other, words, heat.limit))
    checks = [
        Check("numbers over both error bars", partial(over_bars, before), 1.0, "both are right"),
        Check("largest relative difference", partial(apart, before)),
    ]
    lane = heat.add(name, partial(once, ROOT, words, heat.limit), checks=checks)
    heat.ratio(f"{name}: other checkout / this one", before, lane)


def once(tree: Path, words: list[str], limit: float) -> Sample:
    """Run a command of a checkout from start to end in an empty folder."""
    with tempfile.TemporaryDirectory(prefix="race-") as name:
        folder = Path(name)
        command = [sys.executable, "-m", "solidgear", *words]
        done = run(command, folder, limit=limit, extra={"PYTHONPATH": str(tree)}, tree=True)
        kept = folder / "out" / "results.json"
        text = kept.read_text() if kept.exists() else done.out
    try:
        # notices of progress stand before
        numbers = dict(numbers_in(json.loads(text[text.index("{") :]), words[0] in IN_UNITS))
    except ValueError:
        raise PeerError(f"{words[0]} printed no JSON: {last_words(text)}") from None
    return Sample({"all": done.wall}, done.cpu, numbers, {"peak_MB": done.tree_mb})


def commit(tree: Path) -> str:
    """Return the commit of a checkout, with a plus where its source was changed."""
    words = ["git", "describe", "--always", "--dirty=+", "--exclude=*"]
    return subprocess.run(words, cwd=tree, capture_output=True, text=True).stdout.strip()


def numbers_in(data: Any, in_units: bool, path: str = "") -> Iterator[tuple[str, Number]]:
    """Yield the numbers of what a command prints, by where they stand; of a 6x6 the diagonal. Bars
    are printed in units of the number, or relative to it, those of couplings to another size.
    """
    if isinstance(data, list):
        for k, item in enumerate(data):
            label = next((str(item[n]) for n in NAMES if n in item), str(k)) if _is_row(item) else k
            yield from numbers_in(item, in_units, f"{path}/{label}")
        return
    if not isinstance(data, dict):
        return
    for key, item in data.items():
        if key in VALUES and isinstance(item, float):
            bar, size = data.get("bar"), 1.0 if in_units else data.get("size", abs(item))
            yield f"{path}/{key}", Number(item, None if bar is None else bar * size)
        elif key == "compliance" and np.shape(item) == (6, 6):
            for k in range(6):
                if item[k][k] is not None:
                    yield f"{path}/{key}/{k}", Number(float(item[k][k]))
        else:
            yield from numbers_in(item, in_units, f"{path}/{key}")


def _is_row(item: Any) -> bool:
    return isinstance(item, dict)


def differences(before: Lane, answer: dict[str, Number]) -> Iterator[tuple[float, float | None]]:
    """Yield relative differences of the numbers that both checkouts print, and the sum of both error
    bars.
    """
    largest: dict[str, float] = {}
    for name, old in before.answer.items():
        largest[_beside(name)] = max(largest.get(_beside(name), 0.0), abs(old.value))
    for name, old in before.answer.items():
        new = answer.get(name)
        if new is None or abs(old.value) <= ROUNDING * largest[_beside(name)]:
            continue
        if f"/{REDEFINED}" in name:
            continue
        bars = None if old.bar is None or new.bar is None else (old.bar + new.bar) / abs(old.value)
        yield abs(new.value / old.value - 1), bars if bars is None else bars + ROUNDING


def _beside(name: str) -> str:
    """Return where the numbers stand that stand beside one."""
    return name.rpartition("/")[0].rpartition("/")[0]


def over_bars(before: Lane, answer: dict[str, Number]) -> float:
    """Return the largest difference over the sum of both error bars."""
    gaps = [gap / bars for gap, bars in differences(before, answer) if bars]
    return max(gaps, default=0.0)


def apart(before: Lane, answer: dict[str, Number]) -> float:
    """Return the largest relative difference; infinite where no number is common."""
    return max((gap for gap, _ in differences(before, answer)), default=float("inf"))
