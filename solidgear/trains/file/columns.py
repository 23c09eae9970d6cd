"""Columns of numbers in CSV files that a train file names: contact cells, measured flanks."""

from __future__ import annotations

import csv
import os
from collections.abc import Iterator, Mapping, Sequence
from math import isfinite, sqrt
from typing import Any

from solidgear.core import SceneError, show
from solidgear.core.scene.units import TYPED

CELL_COLUMNS = ("x", "y", "z", "nx", "ny", "nz", "force")
MOST_ROWS = 100_000


def read_columns(
    path: str | os.PathLike, columns: Sequence[str], noun: str
) -> Iterator[tuple[int, dict[str, float]]]:
    """Yield the rows of a CSV file with their lines; `noun` says what they are, in the plural."""
    rows = _rows(path, noun)
    file_path = os.fspath(path)
    missing = [c for c in columns if c not in rows[0]]
    if missing:
        reason = f"no column {missing[0]}; the first line must name {', '.join(columns)}"
        raise SceneError(reason, where=file_path)
    for line, row in enumerate(rows, start=2):
        yield line, {column: _number(row, column, line, file_path) for column in columns}


def _rows(path: str | os.PathLike, noun: str) -> list[dict[str, str]]:
    file_path = os.fspath(path)
    try:
        with open(path, newline="", encoding="utf-8-sig") as file:
            rows = list(csv.DictReader(file, skipinitialspace=True))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        cause = getattr(error, "strerror", None) or "not a CSV file in UTF-8"
        raise SceneError(f"the {noun} cannot be read: {cause}", where=file_path) from None
    if not rows or len(rows) > MOST_ROWS:
        raise SceneError(f"{len(rows)} {noun}; there must be 1 to {MOST_ROWS}", where=file_path)
    return rows


def _number(row: Mapping[str, Any], column: str, line: int, file_path: str) -> float:
    try:
        number = float(row[column])
    except (TypeError, ValueError):
        number = float("nan")
    if not isfinite(number):
        reason = f"line {line}, {column} = {show(row[column], 30)}: must be a number in SI"
        raise SceneError(reason, where=file_path)
    return number


def read_cells(path: str | os.PathLike) -> tuple[dict[str, Any], ...]:
    """Read contact cells from a CSV file with the columns x, y, z (m), nx, ny, nz and force (N), as a
    `Mesh` takes them: ``point``, unit ``normal`` and ``force``.
    """
    file_path = os.fspath(path)
    rows = read_columns(path, CELL_COLUMNS, "contact cells")
    cells = tuple(_cell([*row.values()], line, file_path) for line, row in rows)
    if not sum(cell["force"] for cell in cells) > 0:
        raise SceneError("no cell carries a force; the sum must be above zero", where=file_path)
    return cells


def _cell(value: Sequence[float], line: int, file_path: str) -> dict[str, Any]:
    normal, force = value[3:6], value[6]
    length = sqrt(sum(v * v for v in normal))
    if abs(length - 1) > TYPED:
        reason = f"line {line}: the normal has length {length:.6g}; it must be a unit vector"
        raise SceneError(reason, where=file_path)
    if force < 0:
        reason = (
            f"line {line}, force = {force:g}: must not be negative, since teeth push and do not "
            "pull"
        )
        raise SceneError(reason, where=file_path)
    unit = tuple(v / length for v in normal)
    return {"point": tuple(value[:3]), "normal": unit, "force": force}


def read_flank(path: str | os.PathLike) -> dict[str, Any]:
    """Read a measured flank from a CSV file with the columns z, roll or diameter, and deviation, all in
    m and a row for each place of a grid, as a `MeasuredFlank` takes it.
    """
    file_path = os.fspath(path)
    height = "diameter" if "diameter" in _rows(path, "places of a flank")[0] else "roll"
    columns = ("z", height, "deviation")
    places: dict[tuple[float, float], float] = {}
    for line, row in read_columns(path, columns, "places of a flank"):
        place = row["z"], row[height]
        if place in places:
            raise SceneError(
                f"line {line}: z = {place[0]:g}, {height} = {place[1]:g} is there twice",
                where=file_path,
            )
        places[place] = row["deviation"]
    z, heights = (sorted(set(values)) for values in zip(*places))
    missing = [(a, b) for a in z for b in heights if (a, b) not in places]
    if missing:
        raise SceneError(
            f"has no row for z = {missing[0][0]:g}, {height} = {missing[0][1]:g}; a measured flank "
            f"has one for each of {len(z)} face places and {len(heights)} heights",
            where=file_path,
        )
    deviation = tuple(tuple(places[a, b] for b in heights) for a in z)
    return {"z": tuple(z), height: tuple(heights), "deviation": deviation}
