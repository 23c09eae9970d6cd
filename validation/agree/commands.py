"""Commands in this process, and the numbers that they print as JSON."""

from __future__ import annotations

import csv
import json
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from typer.testing import CliRunner

from solidgear import SolidgearError
from solidgear.app import app
from solidgear.core.frames import DOF_NAMES
from solidgear.core.quantity import Quantity
from validation.agree.relation import Number

#: exit code of a command whose numbers did not reach the tolerance, but are there
NOT_REACHED = 3
Numbers = dict[str, Number]
#: compliances that are compared
STATIC = ("C_xx", "C_yy", "C_zz", "C_thx", "C_thz", "C_z,thx")
#: of the largest stiffness: a motion softer than that is free
FREE = 1e-13


@dataclass(frozen=True)
class Printed:
    """What a command left."""

    code: int
    data: dict[str, Any]  #: JSON; empty where there is none
    stderr: str
    crash: str  #: exception that no sentence was made of

    @property
    def answered(self) -> bool:
        """Whether there are numbers."""
        return self.code in (0, NOT_REACHED) and bool(self.data)


def run(*words: Any) -> Printed:
    """Run a command with `--json`."""
    result = CliRunner().invoke(app, [*map(str, words), "--json"])
    lines = [line for line in result.stdout.splitlines() if line.startswith("{")]
    data = json.loads(lines[-1]) if lines else {}
    ended = result.exception
    if isinstance(ended, SolidgearError):
        return Printed(result.exit_code, data, f"{result.stderr}\n{ended}", "")
    crash = "" if ended is None or isinstance(ended, SystemExit) else repr(ended)
    return Printed(result.exit_code, data, result.stderr, crash)


def by_answer(scene: Path, *words: Any) -> Numbers:
    """Numbers of `answer`."""
    return answered(run("answer", scene, *words).data.get("values", []))


def answered(values: Sequence[dict[str, Any]]) -> Numbers:
    """Numbers of rows of an answer, each to the side that it names."""
    return {
        row["quantity"]: Number.within(
            row["value"], row["bar"] * row["size"], row["size"], row["side"]
        )
        for row in values
    }


def by_stiffness(scene: Path, *words: Any) -> Numbers:
    """Compliances of `stiffness`."""
    data = run("stiffness", scene, *words).data
    return _relative(_entries(data.get("compliance")), data.get("bars") or {}, exact(words))


def by_modes(scene: Path, *words: Any) -> Numbers:
    """Natural frequencies of `modes`."""
    modes = run("modes", scene, *words).data.get("modes", [])
    values = {mode["name"]: mode["frequency_hz"] for mode in modes}
    return _relative(values, {mode["name"]: mode["bar"] for mode in modes}, exact(words))


def by_deflect(scene: Path, *words: Any) -> Numbers:
    """Compliances as motions of the main point under unit loads, of the finest model."""
    numbers: Numbers = {}
    for load, unit in (("z", "kN"), ("thx", "kN*m")):
        data = run("deflect", scene, "--load", f"{load}=1 {unit}", *words).data
        if not data:
            continue
        *_, model = data["models"].values()
        motion = model["displacement"][data["port"]]
        for name in ("C_zz", "C_z,thx", "C_thx"):
            row, column = (DOF_NAMES[k] for k in Quantity(name).place)
            entry = motion[row]
            if column == load and (entry["bar"] is not None or exact(words)):
                numbers[name] = Number.within(entry["value"], entry["bar"]).times(1e-3)
    return _sized(numbers)


def by_sweep(scene: Path, *words: Any) -> Numbers:
    """Numbers of the row in which the springs of the first bearing are as they are."""
    row = first_row(scene, "--vary", "bearing.1.scale=1", *words)
    places = {f"f{k}_hz": row.get(f"mode{k}") for k in range(1, 11)}
    columns = {name: name for name in STATIC} | {c: mode for c, mode in places.items() if mode}
    numbers: Numbers = {}
    for column, name in columns.items():
        value, bar = row.get(column), row.get(f"{column} bar")
        if value and (bar or exact(words)):
            numbers.setdefault(name, Number.within(float(value), float(bar or 0.0)))
    return _sized(numbers)


def by_compare(scene: Path) -> Numbers:
    """Numbers of the model that `compare` trusts."""
    with tempfile.TemporaryDirectory() as folder:
        data = run("compare", scene, "--out", folder).data
    trusted = data.get("verdict", {}).get("trust")
    if not trusted:
        return {}
    model = data["models"][trusted]
    values = _entries(model["compliance"])
    for mode in model["modes"] or ():
        values.setdefault(mode["name"], mode["frequency_hz"])
    return _relative(values, (model["band"] or {}).get("each") or {}, False)


def by_export(scene: Path, *words: Any) -> Numbers:
    """Compliances of the matrices that `export` writes, which have no error bar."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "matrices.npz"
        run("export", scene, "--out", file, "--bearings", *words)
        if not file.exists():
            return {}
        with np.load(file) as arrays:
            stiffness = arrays["stiffness"]
    main = slice(0, 6)
    # a free motion has no compliance, and none of the others needs it
    moving = np.abs(np.linalg.eigvalsh(stiffness))
    if moving.min() <= FREE * moving.max():
        return {}
    return _relative(_entries(np.linalg.inv(stiffness)[main, main].tolist()), {}, True)


def first_row(file: Path, *words: Any) -> dict[str, str]:
    """First row of a sweep; empty where it was refused."""
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder) / "rows.csv"
        run("sweep", file, *words, "--out", table)
        if not table.exists():
            return {}
        with table.open(newline="", encoding="utf-8") as text:
            return next(csv.DictReader(text), {})


def exact(words: Sequence[Any]) -> bool:
    """Whether a command names a beam, whose numbers have no bar and are the same to rounding."""
    return "-f" in words


def _entries(matrix: list | None) -> dict[str, float]:
    """Entries of a compliance by their names, without those of free motions."""
    entries = {} if matrix is None else {name: Quantity(name).of(matrix) for name in STATIC}
    return {name: value for name, value in entries.items() if value is not None}


def _relative(values: dict[str, float], bars: dict[str, float | None], bare: bool) -> Numbers:
    """Numbers with relative bars; those without one only where they are the same to rounding."""
    numbers: Numbers = {}
    for name, value in values.items():
        bar = bars.get(name)
        if bar is not None or bare:
            size = _size(name, values)
            numbers[name] = Number.within(value, (bar or 0.0) * size, size)
    return numbers


def _size(name: str, values: dict[str, float]) -> float:
    """What the bar of a number is relative to: of a coupling the mean of its diagonals."""
    diagonals = Quantity(name).diagonals if name in STATIC else None
    if diagonals is None or not all(diagonal in values for diagonal in diagonals):
        return abs(values[name])
    row, column = (values[diagonal] for diagonal in diagonals)
    return abs(row * column) ** 0.5


def _sized(numbers: Numbers) -> Numbers:
    """The same numbers with their sizes, beside which rounding is small."""
    values = {name: number.value for name, number in numbers.items()}
    return {name: replace(number, size=_size(name, values)) for name, number in numbers.items()}


#: a command and the numbers that it prints of a scene, by the word of the command
OF_A_SCENE: dict[str, Callable[..., Numbers]] = {
    "answer": by_answer,
    "stiffness": by_stiffness,
    "modes": by_modes,
    "deflect": by_deflect,
    "sweep": by_sweep,
    "compare": by_compare,
}
#: commands that answer for a beam that is named
OF_A_BEAM: dict[str, Callable[..., Numbers]] = {
    "stiffness": by_stiffness,
    "modes": by_modes,
    "deflect": by_deflect,
    "sweep": by_sweep,
    "export": by_export,
}
