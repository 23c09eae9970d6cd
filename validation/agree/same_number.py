"""The same number by every command, for shafts and for trains."""

from __future__ import annotations

import math
import tempfile
import tomllib
from collections.abc import Iterator
from itertools import combinations
from pathlib import Path
from typing import Any

import solidgear as sg
from validation.agree.commands import (
    OF_A_BEAM,
    OF_A_SCENE,
    STATIC,
    Numbers,
    Printed,
    exact,
    first_row,
    run,
)
from validation.agree.relation import Number, Relation, meeting

KIND = "same number"
#: between two commands that settle one state: what Newton's steps leave of a life, which goes with
#: the third power of a load and more
SETTLED = 1e-4
#: between the line along which shafts are reckoned with cells of teeth and with one point of mesh
BENDING = 0.1
#: m: a bend that no flank is ground to
NO_BENDING = 1e-8


def of_scene(scene: Path) -> Iterator[Relation]:
    """Numbers of a shaft by all commands, and of a beam that each of them is asked for."""
    unloaded = _is_plain(scene)
    commands = {
        name: function
        for name, function in OF_A_SCENE.items()
        # another load would be another state of catalogue bearings
        if unloaded or name not in ("deflect", "sweep")
    }
    yield from meeting(scene.name, KIND, _claims(commands, scene))
    if unloaded:
        beam = ("-f", "timoshenko")
        yield from meeting(f"{scene.name}, beam", KIND, _claims(OF_A_BEAM, scene, *beam))
    yield from in_python(scene)
    yield from lives(scene)


def _claims(commands: dict[str, Any], scene: Path, *words: str) -> dict[str, Numbers]:
    """Numbers by command, without what no command is asked for alike."""
    claims = {name: function(scene, *words) for name, function in commands.items()}
    if exact(words):
        # of several modes of one name a list and a row may name another first
        return {name: _static(numbers) for name, numbers in claims.items()}
    return claims


def _static(numbers: Numbers) -> Numbers:
    return {name: number for name, number in numbers.items() if name in STATIC}


def _is_plain(scene: Path) -> bool:
    """Whether bearings have the same stiffness under any load."""
    loaded = sg.load(scene)
    return not loaded.is_loaded and all(bearing.catalogue is None for bearing in loaded.bearings)


def in_python(scene: Path) -> Iterator[Relation]:
    """`sg.answer` is `answer`, to the last digit."""
    rows = run("answer", scene).data.get("values", [])
    if rows:
        answered = sg.answer(scene)
        for row in rows:
            value = answered[row["quantity"]]
            name = f"{row['quantity']}: answer, sg.answer"
            seen = f"{row['value']} and {value}"
            yield Relation(scene.name, KIND, name, value == row["value"], seen)


def of_train(train: Path) -> Iterator[Relation]:
    """Loads and lives of bearings of a train, its natural frequencies and how its shafts bend under
    the teeth, by all commands.
    """
    yield from lives(train)
    yield from meeting(
        train.name, KIND, {"system-modes": _by_modes(train), "sweep": _by_row_of_modes(train)}
    )
    yield from _bending(train)


def _by_modes(train: Path) -> Numbers:
    """Natural frequencies above zero by their place."""
    modes = run("system-modes", train).data.get("modes", [])
    frequencies = [(m["frequency_hz"], m.get("bar")) for m in modes if m["frequency_hz"] > 0.0]
    return {
        f"f{k}": Number.within(hz, (bar or 0.0) * hz)
        for k, (hz, bar) in enumerate(frequencies[:6], start=1)
    }


def _by_row_of_modes(train: Path) -> Numbers:
    """Natural frequencies of a row in which nothing varies, within the tolerance of rows."""
    row = first_row(train, "--vary", unchanged(train), "--ask", "modes")
    columns = {f"f{k}": row.get(f"f{k}_hz") for k in range(1, 7)}
    within = sg.load_train(train).ask.tolerance
    return {
        name: Number.within(float(hz), within * float(hz)) for name, hz in columns.items() if hz
    }


def _bending(train: Path) -> Iterator[Relation]:
    """How far shafts bend out of line under the teeth, by `contact` and by `deflect`."""
    deflected, contact = run("deflect", train), run("contact", train, "--no-curve")
    if not deflected.answered or not contact.answered:
        return
    *_, model = deflected.data["models"].values()
    for name, mesh in contact.data["meshes"].items():
        norm = (model.get("face_load_norm") or {}).get(name)
        if norm is not None:
            a, b = norm["skew"], mesh["skew"]["bending"] + mesh["skew"]["turning"]
            close = math.isclose(a, b, rel_tol=BENDING, abs_tol=NO_BENDING)
            seen = f"{a:.5g} and {b:.5g} m"
            yield Relation(train.name, KIND, f"f_sh of {name}: deflect, contact", close, seen)


def lives(file: Path) -> Iterator[Relation]:
    """Lives and loads of bearings by `deflect`, `bearing`, `sheet` and a row of `sweep`."""
    rated = run("bearing", file)
    if not rated.answered:
        return
    claims = {
        "bearing": _by_bearing(rated),
        "deflect": _by_deflect(run("deflect", file)),
        "sheet": _by_sheet(file),
        "sweep": _by_row(file),
    }
    for (first, numbers), (second, others) in combinations(claims.items(), 2):
        for name in sorted(numbers.keys() & others.keys()):
            a, b = numbers[name], others[name]
            seen = f"{a:.6g} by {first}, {b:.6g} by {second}"
            close = math.isclose(a, b, rel_tol=SETTLED, abs_tol=1e-6)
            yield Relation(file.name, KIND, f"{name}: {first}, {second}", close, seen)


def _by_bearing(printed: Printed) -> dict[str, float]:
    """Lives at the first point of operation, in revolutions, and static safeties."""
    numbers = {}
    for row in printed.data["bearings"]:
        life = row["points"][0] if "points" in row else row.get("life")
        if life:
            numbers |= {
                f"reference life of {row['name']}": life["reference"],
                f"static safety of {row['name']}": life["static_safety"],
            }
        if "load" in row:
            numbers[f"radial load of {row['name']}"] = math.hypot(row["load"][0], row["load"][2])
    return numbers


def _by_deflect(printed: Printed) -> dict[str, float]:
    """The same by the finest model."""
    if not printed.answered:
        return {}
    *_, model = printed.data["models"].values()
    shafts = model.get("shafts") or {"": model}
    numbers = {}
    for shaft, state in shafts.items():
        for bearing in state["bearings"]:
            name = f"{shaft}.{bearing['name']}".strip(".")
            numbers[f"radial load of {name}"] = bearing["radial_load"]
            if bearing["reference_life"] is not None:
                numbers[f"reference life of {name}"] = bearing["reference_life"]
                numbers[f"static safety of {name}"] = bearing["static_safety"]
    return numbers


def _by_sheet(file: Path) -> dict[str, float]:
    with tempfile.TemporaryDirectory() as folder:
        data = run("sheet", file, "--out", Path(folder) / "sheet.html").data
    numbers = {}
    for row in data.get("bearings", []):
        numbers[f"radial load of {row['name']}"] = row["radial"]
        if row.get("static_safety") is not None:
            numbers[f"static safety of {row['name']}"] = row["static_safety"]
        if row.get("kind") == "reference":
            numbers[f"reference life of {row['name']}"] = row["life"]
    return numbers


def _by_row(file: Path) -> dict[str, float]:
    """Loads and safeties of a row in which nothing varies."""
    row = first_row(file, "--vary", unchanged(file), "--ask", "bearing")
    words = {"radial": "radial load", "static_safety": "static safety"}
    numbers = {}
    for column, text in row.items():
        name, _, what = column.rpartition(".")
        if name and text and what in words:
            numbers[f"{words[what]} of {name}"] = float(text)
    return numbers


def unchanged(file: Path) -> str:
    """An entry of a file with the value that it has there."""
    if is_train(file):
        name, shaft = next(iter(sg.load_train(file).shafts.items()))
        bearing = shaft.scene.bearings[0]
        return f"{name}.bearing.{bearing.name}.seat_width={bearing.hi - bearing.lo} m"
    segment = sg.load(file).segments[-1]
    return f"segment.{segment.name}.length={segment.length} m"


def is_train(file: Path) -> bool:
    """Whether a file describes shafts in mesh."""
    tables = tomllib.loads(file.read_text(encoding="utf-8"))
    return "segment" not in tables and "body" not in tables
