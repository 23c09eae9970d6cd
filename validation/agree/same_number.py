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
from solidgear.trains.assembly.mesh_stiffness import with_usual_meshes
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
#: between two commands that wind up one gear by one formula: rounding
WOUND = 1e-6
#: of the area of a round section, what carries shear in a Timoshenko beam, at least
SHEARED = 0.5


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
    """How far flanks open along the face as gears wind up, which is one number, and as shafts bend, by
    `contact` and by `deflect` on the beams that contact bends.

    `deflect` has the slope of the section in the middle of a rigid face, `contact` the line from end to
    end of a face that bends and shears within itself under a load spread along it.  About the middle
    only odd parts count: those of the shear force there, which is at most half of the force F of the
    teeth, ``F / 2 (b / (kappa G A) + b^3 / (24 E I))`` for each shaft.
    """
    contact = run("contact", train, "--no-curve")
    if not contact.answered:
        return
    # the force of solved teeth lies elsewhere on the face than where contact begins
    loaded = with_usual_meshes(sg.load_train(train))
    (model,) = sg.deflect(loaded, "timoshenko").as_dict()["models"].values()
    for pair in loaded.pairs:
        mesh = contact.data["meshes"].get(pair.name)
        askew = model["misalignment"].get(f"f_sh{pair.label}")
        if mesh is None or askew is None:
            continue
        wound = model["misalignment"][f"wind-up{pair.label}"]["value"]
        turning = mesh["skew"]["turning"]
        seen = f"{wound:.6g} and {turning:.6g} m"
        close = math.isclose(wound, turning, rel_tol=WOUND)
        yield Relation(train.name, KIND, f"wind-up of {pair.name}: deflect, contact", close, seen)
        bent, bending = askew["value"] - wound, mesh["skew"]["bending"]
        force = abs(model["mesh_forces"][pair.name])
        most = sum(
            _within_face(loaded, side, port, force) for side, port in zip(pair.shafts, pair.ports)
        )
        seen = f"{bent:.5g} and {bending:.5g} m, {most:.2g} m within the face"
        close = abs(bent - bending) <= most
        yield Relation(train.name, KIND, f"bending of {pair.name}: deflect, contact", close, seen)


def _within_face(train: sg.Train, side: str, port: str, force: float) -> float:
    """Return the most that a face bends and shears within itself, from end to end, m."""
    scene = train.shafts[side].scene
    middle = next(p for p in scene.ports if p.name == port).y
    segment = next(s for s in scene.segments if s.y0 <= middle <= s.y1)
    inner, outer = segment.radius_at(middle)
    width = train.shafts[side].gears[port].face_width or 0.0
    area, inertia = math.pi * (outer**2 - inner**2), math.pi * (outer**4 - inner**4) / 4
    material = segment.material
    shear_modulus = material.E / (2 * (1 + material.nu))
    shear = width / (SHEARED * shear_modulus * area)
    return force / 2 * (shear + width**3 / (24 * material.E * inertia))


def lives(file: Path, sheet: bool = True) -> Iterator[Relation]:
    """Lives and loads of bearings by `deflect`, `bearing`, a row of `sweep` and by choice `sheet`, which
    takes most of the time.
    """
    rated = run("bearing", file)
    if not rated.answered:
        return
    claims = {
        "bearing": _by_bearing(rated),
        "deflect": _by_deflect(run("deflect", file)),
        "sweep": _by_row(file),
    }
    if sheet:
        claims["sheet"] = _by_sheet(file)
    for (first, numbers), (second, others) in combinations(claims.items(), 2):
        for name in sorted(numbers.keys() & others.keys()):
            a, b = numbers[name], others[name]
            seen = f"{a:.6g} by {first}, {b:.6g} by {second}"
            close = math.isclose(a, b, rel_tol=SETTLED, abs_tol=1e-6)
            yield Relation(file.name, KIND, f"{name}: {first}, {second}", close, seen)


def _by_bearing(printed: Printed) -> dict[str, float]:
    """Lives in revolutions, at the first point of operation and over a table, and static safeties."""
    numbers = {}
    for row in printed.data["bearings"]:
        life = row["points"][0] if "points" in row else row.get("life")
        if life:
            numbers |= {
                f"reference life of {row['name']}": life["reference"],
                f"static safety of {row['name']}": life["static_safety"],
            }
        if row.get("duty"):
            numbers[f"{row['duty']['of']} life of {row['name']} over the table"] = row["duty"][
                "revolutions"
            ]
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
        if row.get("kind"):
            over = " over the table" * row["over_table"]
            numbers[f"{row['kind']} life of {row['name']}{over}"] = row["life"]
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
