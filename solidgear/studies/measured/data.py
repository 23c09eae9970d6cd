"""Measured resonances from a file: frequencies, how sure they are, and what is known of each.

A TOML file holds a list ``mode``; a CSV file has a head such as ``frequency [kHz], multiplicity``;
a universal file has shapes as well, which a TOML file may join to its resonances, or frequency
responses; a CSV file of those has the head ``frequency [Hz], real, imaginary``.

    title = "Tap test, hung on two cords"
    uncertainty = "0.1 %"           # of all modes that say nothing else
    mode = [
        { frequency = "98.459 kHz", multiplicity = 2 },
        { frequency = "121.2 kHz", uncertainty = "0.2 kHz", name = "torsion 1", shape = 2 },
    ]
    shapes = "tap.unv"              # shape 2: its second mode by frequency
    noise = "5 %"                   # of a component of a shape
    damping = "0.1 %"               # ratio: how near two modes are heard as one
"""

from __future__ import annotations

import csv
import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import AfterValidator, BeforeValidator, Field, PrivateAttr, model_validator

from solidgear.errors import SceneError, show
from solidgear.scene.toml_file import parse
from solidgear.scene.typed import Model
from solidgear.scene.units import Frequency, quantity
from solidgear.studies.loading import explained
from solidgear.studies.measured.alignment import BANDWIDTH
from solidgear.studies.measured.responses import ResponseFit
from solidgear.studies.measured.universal import ENDINGS, Responses, Shapes, read_universal

#: resonances of a file
MOST = 2000
#: standard deviation of a component of a shape of which nothing is said, relative to the root mean
#: square of the shape: of careful modal tests
NOISE = (0.05, "relative")
#: head of a column: a word, and its unit in brackets
_HEAD = re.compile(r"\s*(?P<word>\w+)\s*(?:\[\s*(?P<unit>[^\]]+?)\s*\])?\s*")


def _uncertainty(value: Any) -> tuple[float, str]:
    """A share such as ``0.1 %`` or 0.001, or a frequency such as ``2 Hz``; and which of the two."""
    if isinstance(value, tuple):  # read already
        return value
    try:
        return quantity(value, "dimensionless"), "relative"
    except SceneError:
        return quantity(value, "frequency"), "Hz"


def _above_zero(value: tuple[float, str]) -> tuple[float, str]:
    if not value[0] > 0:
        raise SceneError(
            'must be greater than zero: no frequency is known exactly; write for example "0.1 %"'
        )
    if value[1] == "relative" and value[0] >= 1:
        raise SceneError('is more than all of the frequency; a number is a share, "0.1 %" is 0.001')
    return value


def _share(value: tuple[float, str]) -> tuple[float, str]:
    if value[1] != "relative":
        raise SceneError('must be a share and no frequency, such as "5 %"')
    return value


Uncertainty = Annotated[
    tuple[float, str], BeforeValidator(_uncertainty), AfterValidator(_above_zero)
]


class MeasuredMode(Model):
    """A measured resonance.

    Attributes
    ----------
    frequency : float
        Hz.
    uncertainty : (float, {'relative', 'Hz'}) or None
        One standard deviation.
    multiplicity : int or None
        1 for a single resonance, 2 for a pair at one frequency; None where nobody looked.
    name : str
        Of the mode where it is known, such as ``bending 1``, or only its family: ``bending``.
    shape : int or None
        Number of its shape among those of the file of shapes, by ascending frequency, from one.
    """

    frequency: Frequency
    uncertainty: Uncertainty | None = None
    multiplicity: Annotated[int, Field(strict=True, ge=1, le=2)] | None = None
    name: str = ""
    shape: Annotated[int, Field(strict=True, ge=1)] | None = None

    @property
    def width_hz(self) -> float | None:
        """Its standard deviation, Hz."""
        if self.uncertainty is None:
            return None
        value, kind = self.uncertainty
        return value * self.frequency if kind == "relative" else value


class Measured(Model):
    """Measured resonances of a body.

    Attributes
    ----------
    title, source : str
    uncertainty : (float, {'relative', 'Hz'}) or None
        Of all that say nothing else.
    shapes : str
        Universal file of shapes, beside this one.
    noise : (float, 'relative')
        Standard deviation of a component of a shape, relative to the root mean square of the shape.
    damping : (float, 'relative')
        Ratio; modes nearer to each other than twice that are heard as one peak.
    mode : tuple of MeasuredMode
        By ascending frequency.
    """

    title: str = ""
    source: str = ""
    uncertainty: Uncertainty | None = None
    shapes: str = ""
    noise: Annotated[Uncertainty, AfterValidator(_share)] = NOISE
    damping: Annotated[Uncertainty, AfterValidator(_share)] = (BANDWIDTH / 2, "relative")
    mode: tuple[MeasuredMode, ...]
    _on_points: Shapes | None = PrivateAttr(None)
    _responses: ResponseFit | None = PrivateAttr(None)

    @property
    def on_points(self) -> Shapes | None:
        """Shapes on measuring points, zero of a resonance without one; None where none has."""
        return self._on_points

    @property
    def responses(self) -> ResponseFit | None:
        """Responses that the resonances were found in; None for a list of them."""
        return self._responses

    @model_validator(mode="after")
    def _ascending(self) -> Measured:
        if not 1 <= len(self.mode) <= MOST:
            raise SceneError(f"holds {len(self.mode)} resonances; give 1 to {MOST}", path=("mode",))
        for k, (one, following) in enumerate(zip(self.mode, self.mode[1:]), start=1):
            if following.frequency < one.frequency:
                raise SceneError(
                    f"is below the one before it, {one.frequency:g} Hz: frequencies ascend",
                    path=("mode", k, "frequency"),
                    value=f"{following.frequency:g} Hz",
                )
        return self

    @property
    def modes(self) -> tuple[MeasuredMode, ...]:
        """Resonances, each with the uncertainty of all where it has none of its own."""
        return tuple(
            one
            if one.uncertainty is not None
            else one.model_copy(update={"uncertainty": self.uncertainty})
            for one in self.mode
        )


def load_measured(path: str | os.PathLike) -> Measured:
    """Measured resonances of a ``.toml`` or ``.csv`` file, or of a universal file ``.unv``,
    ``.uff`` of mode shapes, or of frequency responses, in which resonances are then found; an error
    tells the file, the entry, its value and what would be right.
    """
    where = os.fspath(path)
    if where.lower().endswith(ENDINGS):
        read = read_universal(where)
        if isinstance(read, Responses):
            return of_responses(read, where)
        frequencies, shapes = read
        return _of_modes([{"frequency": one} for one in frequencies], where, shapes)
    tables: Mapping[str, Any] | Responses
    if where.lower().endswith(".csv"):
        with explained(where, {}):
            tables = _of_csv(Path(path))
    else:
        tables = parse(where)
    if isinstance(tables, Responses):
        return of_responses(tables, where)
    try:
        out = Measured(**tables)
        if out.shapes or any(one.shape for one in out.mode):
            out._on_points = _joined(out, Path(where).parent)
    except SceneError as error:
        # what is wrong in the file of shapes is told with that
        raise error if error.where else error.located(tables, where=where) from None
    return out


def _joined(measured: Measured, folder: Path) -> Shapes:
    """Shapes of all resonances, from the file that is named; zero of those without."""
    if not measured.shapes:
        raise SceneError('shapes of what file? write shapes = "test.unv"', path=("shapes",))
    read = read_universal(folder / measured.shapes)
    if isinstance(read, Responses):
        raise SceneError(
            f"{measured.shapes} holds responses: give it in place of this file", path=("shapes",)
        )
    _, found = read
    values = np.zeros((len(measured.mode), *found.values.shape[1:]), found.values.dtype)
    for k, one in enumerate(measured.mode):
        if one.shape is not None and one.shape > len(found.values):
            raise SceneError(
                f"{measured.shapes} holds {len(found.values)} shapes",
                path=("mode", k, "shape"),
                value=str(one.shape),
            )
        if one.shape is not None:
            values[k] = found.values[one.shape - 1]
    if not values.any():
        raise SceneError(
            "no mode names one of its shapes; write for example shape = 1", path=("shapes",)
        )
    return Shapes(found.numbers, found.points, values)


def of_responses(responses: Responses, where: str = "responses") -> Measured:
    """Resonances that are found in responses of a file; refused where none stands out of the noise."""
    with explained(where, {}):
        found = ResponseFit.of(responses)
    told = zip(found.fit.frequencies.tolist(), found.fit.deviations[0].tolist())
    modes = [{"frequency": f, "uncertainty": f"{d} Hz"} for f, d in told]
    return _of_modes(modes, where, found.shapes, found)


def _of_modes(
    modes: list[dict[str, Any]], where: str, shapes: Shapes | None, fit: ResponseFit | None = None
) -> Measured:
    """Resonances of a file that is no table of them."""
    with explained(where, {"mode": modes}):
        out = Measured(title=Path(where).stem, mode=modes)
    out._on_points, out._responses = shapes, fit
    return out


def _of_csv(path: Path) -> dict[str, Any] | Responses:
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
    heads = [_head(head) for head in rows[0]]
    if "frequency" not in [word for word, _ in heads]:
        raise SceneError('has no column "frequency [Hz]"')
    return {"mode": [_entry(heads, row) for row in rows[1:]]}


def _columns(rows: Sequence[Sequence[str]]) -> Responses:
    """Responses of columns: the frequency, then real and imaginary parts in turn."""
    words = [head.split("[")[0].strip() for head in rows[0]]
    unit = _HEAD.fullmatch(rows[0][0])
    told = words == ["frequency"] + ["real", "imaginary"] * (len(words) // 2)
    if not told or unit is None or not unit["unit"]:
        raise SceneError(
            'has responses under other heads than "frequency [Hz], real, imaginary" and as many more '
            "pairs of real and imaginary as there are responses"
        )
    try:
        numbers = np.array(rows[1:], float)
    except ValueError:
        raise SceneError("holds a line that is not all numbers") from None
    hertz = numbers[:, 0] * quantity(f"1 {unit['unit']}", "frequency")
    return Responses(hertz, (numbers[:, 1::2] + 1j * numbers[:, 2::2]).T)


def _head(text: str) -> tuple[str, str]:
    """Word and unit of a head."""
    found = _HEAD.fullmatch(text)
    known = tuple(MeasuredMode.model_fields)
    if found is None or found["word"] not in known:
        raise SceneError(
            f"column {show(text)} is unknown; there are {', '.join(known)}, with a unit as in "
            '"frequency [kHz]"'
        )
    if found["word"] in ("frequency", "uncertainty") and not found["unit"]:
        raise SceneError(f'column {show(text)} has no unit; write it as in "{found["word"]} [Hz]"')
    return found["word"], found["unit"] or ""


def _entry(heads: Sequence[tuple[str, str]], row: Sequence[str]) -> dict[str, Any]:
    out: dict[str, Any] = {}
    for (word, unit), cell in zip(heads, map(str.strip, row)):
        if cell and unit:
            out[word] = f"{cell} {unit}"
        elif cell:
            out[word] = int(cell) if cell.isdecimal() else cell
    return out
