"""A list of bearings of one's own: a CSV file that designations are looked up in first.

A line is a bearing, a column a key of its catalogue data or the letter of a maker for it, with the
unit in brackets: ``designation;kind;d [mm];D [mm];B [mm];C [kN];C0 [kN];Z;Dw [mm]``.  Columns are parted
by semicolons, commas or tabs, and numbers may have a decimal comma.  Empty cells are not known:
they stay a range.
"""

from __future__ import annotations

import csv
import math
import os
import re
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from solidgear.bearings.designation import boundary
from solidgear.bearings.kinds import SHARES
from solidgear.core import SceneError, nearest, show
from solidgear.core.scene.units import quantity

#: makes a bearing of catalogue data, or refuses them
Make = Callable[..., Any]
#: variable with the path of a list for scenes that name none
VARIABLE = "SOLIDGEAR_BEARINGS"
#: columns by the letters of makers; capitals count
LETTERS = {
    "d": "bore",
    "D": "outer_diameter",
    "B": "width",
    "T": "width",
    "H": "width",
    "C": "load_rating",
    "Cr": "load_rating",
    "C0": "static_rating",
    "C0r": "static_rating",
    "Pu": "fatigue_limit",
    "Cu": "fatigue_limit",
    "Z": "elements",
    "Dw": "element_diameter",
    "Lwe": "element_length",
    "Dpw": "pitch_diameter",
    "F": "raceway",
    "Fw": "raceway",
    "alpha": "contact_angle",
    "ID": "bore",
    "OD": "outer_diameter",
    "type": "kind",
    "Type": "kind",
}
#: dimension of what columns hold
MEASURED = {
    **dict.fromkeys(
        (
            *("bore", "outer_diameter", "width", "raceway", "element_diameter"),
            *("element_length", "pitch_diameter", "row_distance"),
        ),
        "length",
    ),
    **dict.fromkeys(("load_rating", "static_rating", "fatigue_limit"), "load"),
    "contact_angle": "angle",
    "rib_stiffness": "force_per_length",
}
#: example of a unit by dimension
UNITS = {"length": "mm", "load": "kN", "angle": "deg", "force_per_length": "N/um"}
#: columns of plain numbers, of words, and what is kept out of a model
NUMBERS = (
    "elements",
    "conformity",
    "conformity_inner",
    "conformity_outer",
    "rating_factor",
    "e",
    "Y",
)
WORDS = ("designation", "kind", "arrangement", "profile", "ribs", "clearance")
BESIDE = ("maker", "note", "source", "price", "number")
COLUMNS = (*WORDS, *MEASURED, *NUMBERS, *BESIDE)
#: relative difference of Y and of 0.4 cot a by the e beside it, which makers round to a digit
ROUNDED = 0.1
#: largest list, in bytes
LARGEST = 5_000_000


class Column(NamedTuple):
    """Column of a list."""

    key: str
    unit: str
    head: str  #: as the file has it


def with_listed_by_variable(data: Mapping[str, Any], make: Make) -> dict[str, Any]:
    """Return catalogue data with those of the list of the variable ``SOLIDGEAR_BEARINGS``, if there is
    one.
    """
    path = os.environ.get(VARIABLE)
    if not path or data.get("listed"):  # the lines of the list themselves
        return dict(data)
    try:
        listed = read_list(path, make)
    except SceneError as error:
        raise SceneError(f"{VARIABLE}: {error}", path=("designation",)) from None
    return with_listed(data, listed)


def with_listed(data: Mapping[str, Any], listed: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """Return catalogue data with those of a list, where it has the designation; data that are there
    stay.
    """
    out = dict(data)
    designation = data.get("designation")
    if not isinstance(designation, str) or data.get("listed"):
        return out
    name = _plain(designation)
    # lists seldom have a line for every class of clearance
    split = re.fullmatch(r"(.*?)(C[2-5]|CN)", name)
    entry = listed.get(name)
    if entry is None and split is not None and split[1] in listed:
        entry = {**listed[split[1]], "clearance": split[2]}
    return out if entry is None else {**entry, **out}


def _plain(designation: str) -> str:
    return re.sub(r"[\s/\-.,]", "", designation.upper())


def read_list(path: str, make: Make) -> dict[str, dict[str, Any]]:
    """Read a list of bearings: catalogue data in SI by designation without separators; all wrong
    lines are refused, each with its column, and those of which `make` makes no bearing.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     path = os.path.join(folder, "list.csv")
    ...     _ = Path(path).write_text("designation;C [kN];Dw [mm]\\n6208;32,5;12\\n")
    ...     data = read_list(path, dict)["6208"]
    >>> data["load_rating"], data["element_diameter"], data["outer_diameter"]
    (32500.0, 0.012, 0.08)
    """
    try:
        status = os.stat(path)
    except OSError as error:
        reason = f"cannot be read: {error.strerror or error}"
        raise SceneError(reason, where=path) from None
    return _read(path, make, status.st_mtime_ns, status.st_size)


@lru_cache(maxsize=8)
def _read(path: str, make: Make, changed: int, size: int) -> dict[str, dict[str, Any]]:
    """Read a list that has this time of change and size."""
    if size > LARGEST:
        reason = f"has {size / 1e6:.0f} MB, more than a list of bearings has"
        raise SceneError(reason, where=path)
    rows = _rows(path)
    (_, heads), *lines = rows
    columns = _columns(heads, path)
    out: dict[str, dict[str, Any]] = {}
    numbers: dict[str, int] = {}
    problems: list[SceneError] = []
    for number, cells in lines:
        try:
            name, data = _bearing(columns, cells, number, path, make)
        except SceneError as error:
            problems += error.problems
            continue
        if name in numbers:
            reason = (
                f"line {number}: {show(data['designation'])} is in line {numbers[name]} as well"
            )
            problems.append(SceneError(reason, where=path))
            continue
        numbers[name], out[name] = number, data
    if problems:
        raise SceneError.of(problems)
    return out


def _rows(path: str) -> list[tuple[int, list[str]]]:
    """Return lines with their numbers and cells; the first is the head."""
    try:
        text = Path(path).read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        text = Path(path).read_text(encoding="cp1252", errors="replace")
    except OSError as error:
        raise SceneError(f"cannot be read: {error.strerror or error}", where=path) from None
    head = next((line for line in text.splitlines() if line.strip() and line[0] != "#"), "")
    separator = max(";\t,", key=head.count)
    reader = csv.reader(text.splitlines(), delimiter=separator, skipinitialspace=True)
    rows = [(reader.line_num, [cell.strip() for cell in cells]) for cells in reader]
    rows = [(k, cells) for k, cells in rows if any(cells) and not cells[0].startswith("#")]
    if len(rows) < 2:
        reason = (
            'holds no bearings: write a head such as "designation;kind;d [mm];D [mm];B [mm];C [kN]" '
            "and one bearing a line"
        )
        raise SceneError(reason, where=path)
    return rows


def _columns(heads: Sequence[str], path: str) -> list[Column]:
    """Return the columns of a head; refuse an unknown, a double or a missing one, and a length, a
    force or an angle without a unit.
    """
    columns: list[Column] = []
    problems: list[SceneError] = []
    for place, head in enumerate(heads, start=1):
        match = re.fullmatch(r"(?P<word>[^\[\]]*?)\s*(?:\[\s*(?P<unit>[^\]]+?)\s*\])?", head)
        word = match["word"].strip() if match else head
        key = LETTERS.get(word) or (word if word in COLUMNS else word.lower().replace(" ", "_"))
        unit = (match["unit"] if match else None) or ""
        reason = ""
        if key not in COLUMNS:
            near_ = nearest(word, [*COLUMNS, *LETTERS])
            reason = f"is no column of a list of bearings{near_}; there are {', '.join(COLUMNS)}"
        elif key in MEASURED and not unit:
            example = UNITS[MEASURED[key]]
            reason = f"has no unit: write it as {word} [{example}]"
        elif key in MEASURED:
            reason = _no_unit(unit, MEASURED[key])
        elif key in (column.key for column in columns):
            reason = f"is {key}, which another column is as well"
        if reason:
            problems.append(
                SceneError(f"line 1, column {place}: {show(head)} {reason}", where=path)
            )
        columns.append(Column(key, unit, head))
    if not problems and "designation" not in (column.key for column in columns):
        problems.append(SceneError("has no column designation", where=path))
    if problems:
        raise SceneError.of(problems)
    return columns


def _no_unit(unit: str, dimension: str) -> str:
    """Return why a unit is none of a dimension; empty where it is."""
    try:
        quantity(f"1 {unit}", dimension)
    except SceneError:
        return (
            f"has the unit {show(unit)}, which is none here: write one such as {UNITS[dimension]}"
        )
    return ""


def _bearing(
    columns: Sequence[Column], cells: Sequence[str], number: int, path: str, make: Make
) -> tuple[str, dict[str, Any]]:
    """Return the name without separators and the catalogue data of a line; all that is wrong in it is
    refused.
    """
    if len(cells) > len(columns) and any(cells[len(columns) :]):
        reason = (
            f"line {number}: has {len(cells)} cells under {len(columns)} columns; a decimal comma "
            "needs semicolons between cells, or quotes"
        )
        raise SceneError(reason, where=path)
    data: dict[str, Any] = {}
    problems = []
    for column, cell in zip(columns, cells):
        if not cell or cell in "-–—" or column.key in BESIDE:
            continue
        try:
            data[column.key] = _value(column, cell)
        except SceneError as error:
            reason = f"line {number}, column {column.head}: {show(cell)} {error.reason}"
            problems.append(SceneError(reason, where=path))
    if problems:
        raise SceneError.of(problems)
    try:
        return _checked(data, f"{Path(path).name}, line {number}", make)
    except SceneError as error:
        given = {c.key: (c.head, cell) for c, cell in zip(columns, cells)}
        raise SceneError.of(
            SceneError(_of_line(problem, number, given), where=path) for problem in error.problems
        ) from None


def _of_line(problem: SceneError, number: int, given: Mapping[str, tuple[str, str]]) -> str:
    """Return the reason of a problem with its line, its column and the cell."""
    key = str(problem.path[0]) if problem.path else ""
    head, cell = given.get(key, (key, ""))
    column = f", column {head}" if head else ""
    value = f"{show(cell)} " if cell else ""
    return f"line {number}{column}: {value}{problem.reason}"


def _value(column: Column, cell: str) -> Any:
    """Return the value of a cell in SI."""
    if column.key in MEASURED:
        number = _number(cell)
        return quantity(f"{number!r} {column.unit}", MEASURED[column.key])
    if column.key == "elements":
        number = _number(cell)
        if number != int(number):
            raise SceneError("is no whole number of elements")
        return int(number)
    if column.key in NUMBERS:
        return _number(cell)
    return cell.replace(" ", "_").lower() if column.key == "kind" else cell


def _number(cell: str) -> float:
    plain = cell.replace(" ", "").replace("\u00a0", "")
    if plain.count(",") == 1 and "." not in plain:
        plain = plain.replace(",", ".")
    try:
        number = float(plain)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise SceneError("is no number; write one such as 32.5 or 32,5")
    return number


def _checked(data: dict[str, Any], line: str, make: Make) -> tuple[str, dict[str, Any]]:
    """Return the name and catalogue data of a line, with the sizes of its designation where the line
    has none; refuse data that make no bearing.
    """
    name = data.get("designation")
    if not name:
        raise SceneError("has no designation")
    inner, outer = data.pop("conformity_inner", None), data.pop("conformity_outer", None)
    if inner is not None and outer is not None:
        data["conformity"] = (inner, outer)
    elif inner is not None or outer is not None:
        raise SceneError("give both conformity_inner and conformity_outer, or conformity")
    data = _with_standard(data)
    _take_factors(data)
    data["listed"] = line
    ways: dict[str, Any] = {}
    if (shares := SHARES.get(data["kind"])) and shares.holds == "one way":
        ways["holds"] = "+y"
    make(**data, **ways)
    return _plain(name), data


def _with_standard(data: dict[str, Any]) -> dict[str, Any]:
    """Return data with kind, sizes and ribs of a designation that is known."""
    needed = ("kind", "bore", "outer_diameter", "width")
    try:
        standard = boundary(data["designation"])
    except SceneError:
        missing = [key for key in needed if key not in data]
        if missing:
            raise SceneError(
                f"is no designation that is known here, and the line has no {', '.join(missing)}",
                path=("designation",),
                value=show(data["designation"]),
            ) from None
        return data
    if "kind" in data and data["kind"] != standard.kind:
        missing = [key for key in needed if key not in data]
        if missing:
            raise SceneError(
                f"does not fit the designation, which is {standard.kind}",
                path=("kind",),
                value=show(data["kind"]),
            )
        return data
    known = standard._asdict()
    for key in ("ignored", "tapered_bore", "clearance"):
        del known[key]
    return {**{key: value for key, value in known.items() if value is not None}, **data}


def _take_factors(data: dict[str, Any]) -> None:
    """Turn the e and Y of a maker into the contact angle of rollers: ``e = 1.5 tan a``, ``Y = 0.4 cot a``
    of ISO 281.
    """
    e, y = data.pop("e", None), data.pop("Y", None)
    if e is None and y is None:
        return
    if data["kind"] not in ("tapered", "spherical", "self_aligning"):
        # of balls in grooves they follow from the load, and of a given angle from that
        return
    angle = math.atan(e / 1.5) if e is not None else math.atan(0.4 / y)
    if not math.radians(2) < angle < math.radians(45):
        raise SceneError("is the factor of no contact angle", path=("e" if e is not None else "Y",))
    if e is not None and y is not None and data["kind"] == "tapered":
        if abs(0.4 / math.tan(angle) / y - 1) > ROUNDED:
            raise SceneError(
                f"does not fit e = {e:g}, with which it is {0.4 / math.tan(angle):.2f} (ISO 281)",
                path=("Y",),
                value=show(y),
            )
    data.setdefault("contact_angle", angle)
