"""Measured resonances, or responses, of a CSV file."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core import SceneError, show
from solidgear.core.scene.units import quantity
from solidgear.measured.universal import Responses

#: head of a column: a word, and its unit in brackets
_HEAD = re.compile(r"\s*(?P<word>\w+)\s*(?:\[\s*(?P<unit>[^\]]+?)\s*\])?\s*")


def read_csv(path: Path, words: Sequence[str]) -> dict[str, Any] | Responses:
    """Return the list of resonances of a file whose columns have `known` words, or its responses."""
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            rows = [row for row in csv.reader(file) if any(cell.strip() for cell in row)]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise SceneError(f"cannot be read ({error})") from None
    if len(rows) < 2:
        raise SceneError(
            'holds no resonances; write a head such as "frequency [Hz]" and one a line'
        )
    if any(head.split("[")[0].strip() == "real" for head in rows[0]):
        return _columns(rows)
    heads = [_head(head, words) for head in rows[0]]
    if "frequency" not in [word for word, _ in heads]:
        raise SceneError('has no column "frequency [Hz]"')
    return {"mode": [_entry(heads, row) for row in rows[1:]]}


def _columns(rows: Sequence[Sequence[str]]) -> Responses:
    """Return responses of columns: the frequency, then real and imaginary parts in turn."""
    words = [head.split("[")[0].strip() for head in rows[0]]
    unit = _HEAD.fullmatch(rows[0][0])
    as_stated = words == ["frequency"] + ["real", "imaginary"] * (len(words) // 2)
    if not as_stated or unit is None or not unit["unit"]:
        raise SceneError(
            'has other heads than "frequency [Hz], real, imaginary", with one more pair "real, '
            'imaginary" for each further response'
        )
    try:
        numbers = np.array(rows[1:], float)
    except ValueError:
        raise SceneError("holds a line that is not all numbers") from None
    hertz = numbers[:, 0] * quantity(f"1 {unit['unit']}", "frequency")
    return Responses(hertz, (numbers[:, 1::2] + 1j * numbers[:, 2::2]).T)


def _head(text: str, words: Sequence[str]) -> tuple[str, str]:
    """Return the word and unit of a head."""
    match = _HEAD.fullmatch(text)
    if match is None or match["word"] not in words:
        raise SceneError(
            f"column {show(text)} is unknown; there are {', '.join(words)}, with a unit as in "
            '"frequency [kHz]"'
        )
    if match["word"] in ("frequency", "uncertainty") and not match["unit"]:
        raise SceneError(f'column {show(text)} has no unit; write it as in "{match["word"]} [Hz]"')
    return match["word"], match["unit"] or ""


def _entry(heads: Sequence[tuple[str, str]], row: Sequence[str]) -> dict[str, Any]:
    out: dict[str, Any] = {}
    for (word, unit), cell in zip(heads, map(str.strip, row)):
        if cell and unit:
            out[word] = f"{cell} {unit}"
        elif cell:
            out[word] = int(cell) if cell.isdecimal() else cell
    return out
