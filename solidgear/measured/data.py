"""Measured resonances from a file: frequencies, their uncertainty, and known properties.

A TOML file holds a list ``mode``; a CSV file has a head such as ``frequency [kHz], multiplicity``;
a universal file has shapes as well, which a TOML file may join to its resonances, or frequency
responses; a CSV file of those has the head ``frequency [Hz], real, imaginary``. A TOML file with
``file = "tap.uff"`` in place of a list states where the points of that file lie, and in which unit.

    title = "Tap test, hung on two cords"
    uncertainty = "0.1 %"           # of all modes that say nothing else
    mode = [
        { frequency = "98.459 kHz", multiplicity = 2 },
        { frequency = "121.2 kHz", uncertainty = "0.2 kHz", name = "torsion 1", shape = 2 },
    ]
    shapes = "tap.unv"              # shape 2: its second mode by frequency
    points = { unit = "mm", axis = "x", origin = "-80 mm" }     # of its points
    noise = "5 %"                   # of a component of a shape
    damping = "0.1 %"               # ratio: how near two modes are heard as one
"""

from __future__ import annotations

import csv
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, ClassVar, TypeAlias

import numpy as np
from pydantic import AfterValidator, BeforeValidator, Field, PrivateAttr, model_validator

from solidgear.core import (
    Document,
    Model,
    SceneError,
    SolidgearError,
    Source,
    Surface,
    Written,
    document_of,
    explained,
    show,
)
from solidgear.core.scene.document import Origin, read_tables
from solidgear.core.scene.model_table import entry_of
from solidgear.core.scene.rewriting import toml_of
from solidgear.core.scene.units import Frequency, Tolerance, quantity
from solidgear.measured.alignment import BANDWIDTH
from solidgear.measured.modal_fit import ResponseFit
from solidgear.measured.placement import Places, PointsTable
from solidgear.measured.universal import ENDINGS, Responses, Shapes, read_universal, response_unit

#: resonances of a file
MOST = 2000
#: standard deviation of a component of a shape of which nothing is said, relative to the root mean
#: square of the shape: of careful modal tests
NOISE = (0.05, "relative")


def _uncertainty(value: Any) -> tuple[float, str]:
    """Return a share such as ``0.1 %`` or 0.001, or a frequency such as ``2 Hz``; and which of the
    two.
    """
    if isinstance(value, tuple):  # read already
        return value
    try:
        return quantity(value, "dimensionless"), "relative"
    except SceneError:
        return quantity(value, "frequency"), "Hz"


def _above_zero(value: tuple[float, str]) -> tuple[float, str]:
    if not value[0] > 0:
        raise SceneError(
            "must be greater than zero, since no frequency is known exactly; write for example "
            '"0.1 %"'
        )
    if value[1] == "relative" and value[0] >= 1:
        raise SceneError('is more than all of the frequency; a number is a share, "0.1 %" is 0.001')
    return value


def _share(value: tuple[float, str]) -> tuple[float, str]:
    if value[1] != "relative":
        raise SceneError('must be a share, such as "5 %", not a frequency')
    return value


Uncertainty = Annotated[
    tuple[float, str],
    BeforeValidator(_uncertainty),
    AfterValidator(_above_zero),
    Written(Tolerance | Frequency),
]


def _response_unit(value: Any) -> tuple[float, int] | None:
    """Return a motion over a force such as ``m/s^2/N``: SI units in one, and derivatives of
    displacement.
    """
    if not value:
        return None
    unit = response_unit(value) if isinstance(value, str) else None
    if unit is None:
        raise SceneError(
            'must be a motion over a force, such as "m/s^2/N" or "g/N"', value=show(value)
        )
    return unit


ResponseUnit = Annotated[tuple[float, int] | None, BeforeValidator(_response_unit), Written(str)]


class MeasuredMode(Model):
    """A measured resonance."""

    #: frequency, Hz
    frequency: Frequency
    #: one standard deviation, a share or a frequency
    uncertainty: Uncertainty | None = None
    #: 1 for a single resonance, 2 for a pair at one frequency; without it nobody looked
    multiplicity: Annotated[int, Field(strict=True, ge=1, le=2)] | None = None
    #: name of the mode where it is known, such as `bending 1`, or only its family: `bending`
    name: str = ""
    #: number of its shape among those of the file of shapes, by ascending frequency, from one
    shape: Annotated[int, Field(strict=True, ge=1)] | None = None

    @property
    def width_hz(self) -> float | None:
        """Standard deviation, Hz."""
        if self.uncertainty is None:
            return None
        value, kind = self.uncertainty
        return value * self.frequency if kind == "relative" else value


class Measured(Model):
    """Measured resonances of a body; read them with `solidgear.load_measured`.

    Attributes
    ----------
    title, source : str
    uncertainty : tuple of float and str, optional
        Of all resonances that say nothing else: a share, ``"relative"``, or ``"Hz"``.
    shapes, file : str
        Universal files of shapes and of resonances.
    mode : tuple of MeasuredMode
        By ascending frequency, Hz.
    noise, damping : tuple of float and str
        Standard deviation of a component of a shape; damping ratio at which modes are heard as one.

    Examples
    --------
    >>> import solidgear as sg
    >>> tap = sg.Measured(uncertainty="0.1 %", mode=[{"frequency": "1.2 kHz", "multiplicity": 2}])
    >>> [mode.frequency for mode in tap.modes]
    [1200.0]
    """

    needs: ClassVar = (("mode", "file"),)

    #: title of the measurement
    title: str = ""
    #: where the measurement comes from
    source: str = ""
    #: one standard deviation of all resonances that say nothing else, a share or a frequency
    uncertainty: Uncertainty | None = None
    #: universal file of shapes, beside this one
    shapes: str = ""
    #: universal file whose resonances are taken in place of a list
    file: str = ""
    #: unit of the responses of that file, such as `m/s^2/N`
    response_unit: ResponseUnit = None
    #: where the points of that file lie in the scene
    points: PointsTable = PointsTable()
    #: standard deviation of a component of a shape, relative to the root mean square of the shape
    noise: Annotated[Uncertainty, AfterValidator(_share), Written(Tolerance)] = NOISE
    #: damping ratio; modes nearer to each other than twice that are heard as one peak
    damping: Annotated[Uncertainty, AfterValidator(_share), Written(Tolerance)] = (
        BANDWIDTH / 2,
        "relative",
    )
    #: resonances by ascending frequency
    mode: tuple[MeasuredMode, ...] = ()
    _on_points: Shapes | None = PrivateAttr(None)
    _responses: ResponseFit | None = PrivateAttr(None)
    _remarks: tuple[str, ...] = PrivateAttr(())
    #: of data of another file: the tables that name it
    _tables: dict[str, Any] | None = PrivateAttr(None)
    _origin: Origin = PrivateAttr(Origin())

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Measured):
            return False
        mine, others = (data.model_dump(exclude={"shapes", "file"}) for data in (self, other))
        return mine == others and self._tables == other._tables

    __hash__ = Model.__hash__

    @classmethod
    def from_dict(
        cls, tables: Mapping[str, Any], folder: str | os.PathLike = ".", name: str = "measured"
    ) -> Measured:
        """Measured resonances from the tables of a file, as `tomllib` gives them.

        Parameters
        ----------
        tables : mapping
            By the keys of a file.
        folder : str or path
            Names of files in the tables are relative to it.
        name : str
            Of the data in messages.

        Returns
        -------
        Measured

        Raises
        ------
        SceneError
            The entry, its value and the right form.

        Examples
        --------
        >>> peaks = Measured.from_dict({"mode": [{"frequency": "1.2 kHz", "uncertainty": "2 Hz"}]})
        >>> peaks.to_dict()
        {'mode': [{'frequency': 1200.0, 'uncertainty': '2.0 Hz'}]}
        """
        return read_tables(tables, folder, name, "measurement", load_measured)

    def to_dict(self) -> dict[str, Any]:
        """Tables of a file with these data, as plain data in SI; `from_dict` reads them back equal.

        Returns
        -------
        dict
            By the keys of a file. Data of universal files are named by their full paths.

        Raises
        ------
        SolidgearError
            Responses of a CSV file, which no table names.
        """
        if self._tables is not None:
            return dict(self._tables)
        if self._responses is not None or self._on_points is not None:
            raise SolidgearError(f"{self.title}: its data are in no table; name the file itself")
        table = entry_of(self)
        for key in ("uncertainty", "noise", "damping"):
            if key in table:
                table[key] = _share_or_hertz(getattr(self, key))
        for row, mode in zip(table.get("mode", ()), self.mode):
            if mode.uncertainty is not None:
                row["uncertainty"] = _share_or_hertz(mode.uncertainty)
        return table

    def to_toml(self, path: str | os.PathLike | None = None) -> str:
        """The file of the data: that which they were read from with its words and comments, where
        entries that have changed since are written anew.

        Parameters
        ----------
        path : str or path, optional
            File to write, whole or not at all.

        Returns
        -------
        str

        Raises
        ------
        SolidgearError
            A file that cannot be written, and as of `to_dict`.
        """

        def canonical(tables: Mapping[str, Any], path: str) -> dict[str, Any]:
            return load_measured(Document(tables, path)).to_dict()

        return toml_of(self._origin.document, path, canonical, self.to_dict())

    def with_changes(self, **changes: Any) -> Measured:
        """Return a validated copy with some fields replaced, a list by itself."""
        out = super().with_changes(**changes)
        out._origin = self._origin
        return out

    @property
    def on_points(self) -> Shapes | None:
        """Shapes on measuring points, zero of a resonance without one; None where none has."""
        return self._on_points

    @property
    def responses(self) -> ResponseFit | None:
        """Responses that the resonances were found in; None for a list of them."""
        return self._responses

    @property
    def remarks(self) -> tuple[str, ...]:
        """Sentences on how the file was read."""
        return self._remarks

    def placed(self, still: Surface, revolved: bool) -> Measured:
        """Return the same data with points in the frame of a scene, on the surface of its body."""
        shapes = self._on_points
        if shapes is None:
            return self
        frame, away = Places(shapes.points, shapes.length, still, revolved).frame(self.points)
        placing = frame.placing
        out = self.unjudged(points=PointsTable())
        out._on_points = shapes.placed(placing)
        out._responses = self._responses and self._responses.placed(placing)
        if not self.points.states(frame, shapes.length):
            out._remarks = (
                *self._remarks,
                f"Measuring points were placed on the surface, within {max(1e3 * away, 0.01):.2g} "
                f"mm, by {frame.table}.",
            )
        return out

    @model_validator(mode="after")
    def _ascending(self) -> Measured:
        if self.file and (self.mode or self.shapes):
            raise SceneError(
                "give either the file of all resonances, or a list mode with shapes", path=("file",)
            )
        if self.file:
            return self
        if self.response_unit:
            raise SceneError(
                'the file of the responses is missing; write file = "tap.uff"',
                path=("response_unit",),
            )
        if not 1 <= len(self.mode) <= MOST:
            raise SceneError(
                f"holds {len(self.mode)} resonances; give 1 to {MOST}, or the file of them, file =",
                path=("mode",),
            )
        for k, (mode, following) in enumerate(zip(self.mode, self.mode[1:]), start=1):
            if following.frequency < mode.frequency:
                raise SceneError(
                    f"is below the one before it, {mode.frequency:g} Hz: frequencies ascend",
                    path=("mode", k, "frequency"),
                    value=f"{following.frequency:g} Hz",
                )
        return self

    @property
    def modes(self) -> tuple[MeasuredMode, ...]:
        """Resonances, each with the uncertainty of all where it has none."""
        return tuple(
            mode
            if mode.uncertainty is not None
            else mode.model_copy(update={"uncertainty": self.uncertainty})
            for mode in self.mode
        )


#: measured data, or what they are read from
MeasuredSource: TypeAlias = Source | Measured | Responses | Sequence[float]


def load_measured(source: MeasuredSource) -> Measured:
    """Read measured resonances, or find them in frequency responses.

    Parameters
    ----------
    source : path, dict, Responses or sequence of float
        A ``.toml`` or ``.csv`` file of resonances; a universal file ``.unv``, ``.uff`` of mode shapes
        or of frequency responses; the tables of a TOML file; responses; or frequencies alone, Hz.

    Returns
    -------
    Measured

    Raises
    ------
    SceneError
        The file, the entry, its value and the right form.

    Examples
    --------
    >>> import solidgear as sg
    >>> tables = {"uncertainty": "0.1 %", "mode": [{"frequency": "251.6 Hz"}]}
    >>> sg.load_measured(tables).modes[0].uncertainty
    (0.001, 'relative')
    """
    if isinstance(source, Measured):
        return source
    if isinstance(source, Responses):
        return measured_from_responses(source)
    if isinstance(source, Sequence | np.ndarray) and not isinstance(source, str):
        source = {"mode": [{"frequency": frequency} for frequency in source]}
    name = os.fspath(source) if isinstance(source, str | os.PathLike) else "measured data"
    if isinstance(source, Document):
        name = source.path
    elif name.lower().endswith(ENDINGS):
        content = read_universal(name)
        if isinstance(content, Responses):
            out = measured_from_responses(content, name)
        else:
            out = _from_shapes(*content, name)
        out._tables = {"file": os.path.abspath(name)}
        return out
    tables: Mapping[str, Any] | Responses
    document = None
    if name.lower().endswith(".csv"):
        with explained(name, {}):
            tables = read_csv(Path(name), tuple(MeasuredMode.model_fields))
    else:
        document = document_of(source)
        tables = document.tables
    if isinstance(tables, Responses):
        return measured_from_responses(tables, name)
    try:
        out = Measured(**tables)
        key = "file" if out.file else "shapes"
        named = {**tables, key: os.path.abspath(Path(name).parent / str(tables.get(key, "")))}
        if out.file:
            out = _from_universal(out, Path(name).parent)
            out._tables = named
        elif out.shapes or any(mode.shape for mode in out.mode):
            out._on_points = _joined_shapes(out, Path(name).parent)
            out._tables = named
    except SceneError as error:
        # an error in the file of shapes names that file
        raise error if error.where else error.located(tables, where=name) from None
    out._origin = Origin(document)
    return out


def _share_or_hertz(value: tuple[float, str]) -> float | str:
    """Return an uncertainty as a file has it."""
    number, kind = value
    return number if kind == "relative" else f"{number!r} Hz"


def _from_universal(table: Measured, folder: Path) -> Measured:
    """Return resonances of the universal file that a table names, with the entries of the table."""
    path = folder / table.file
    if not table.file.lower().endswith(ENDINGS):
        raise SceneError(
            "must be a universal file, .unv or .uff", path=("file",), value=show(table.file)
        )
    content = read_universal(path, table.response_unit)
    if isinstance(content, Responses):
        out = measured_from_responses(content, str(path))
    elif table.response_unit:
        raise SceneError(f"{table.file} holds no responses", path=("response_unit",))
    else:
        out = _from_shapes(*content, str(path))
    listed = out.mode
    if table.uncertainty is not None:
        listed = tuple(m.model_copy(update={"uncertainty": table.uncertainty}) for m in listed)
    return out.unjudged(
        title=table.title or out.title,
        source=table.source,
        noise=table.noise,
        damping=table.damping,
        points=table.points,
        mode=listed,
    )


def _joined_shapes(measured: Measured, folder: Path) -> Shapes:
    """Return shapes of all resonances, from the file that is named; zero of those without."""
    if not measured.shapes:
        raise SceneError(
            'the file of the shapes is missing; write shapes = "test.unv"', path=("shapes",)
        )
    content = read_universal(folder / measured.shapes)
    if isinstance(content, Responses):
        raise SceneError(
            f"{measured.shapes} holds responses: give it in place of this file", path=("shapes",)
        )
    _, shapes = content
    if shapes is None:
        raise SceneError(
            f"{measured.shapes} gives no places of its points (dataset 15 or 2411)",
            path=("shapes",),
        )
    values = np.zeros((len(measured.mode), *shapes.values.shape[1:]), shapes.values.dtype)
    for k, mode in enumerate(measured.mode):
        if mode.shape is not None and mode.shape > len(shapes.values):
            raise SceneError(
                f"{measured.shapes} holds {len(shapes.values)} shapes",
                path=("mode", k, "shape"),
                value=str(mode.shape),
            )
        if mode.shape is not None:
            values[k] = shapes.values[mode.shape - 1]
    if not values.any():
        raise SceneError(
            "no mode names one of its shapes; write for example shape = 1", path=("shapes",)
        )
    return replace(shapes, values=values)


def measured_from_responses(responses: Responses, name: str = "responses") -> Measured:
    """Return resonances that are found in responses of a file; refused where none stands out of the
    noise.
    """
    with explained(name, {}):
        fit = ResponseFit.of(responses)
    pairs = zip(fit.fit.frequencies.tolist(), fit.widths_hz.tolist())
    modes = [{"frequency": f, "uncertainty": f"{d} Hz"} for f, d in pairs]
    out = _from_modes(modes, name, fit.shapes, fit)
    out._remarks = tuple(fit.remarks)
    return out


def _from_shapes(frequencies: Sequence[float], shapes: Shapes | None, name: str) -> Measured:
    """Return resonances of a file of shapes."""
    out = _from_modes([{"frequency": hertz} for hertz in frequencies], name, shapes)
    if shapes is None:
        out._remarks = (
            "The file gives no positions of its points (dataset 15 or 2411), so its shapes are "
            "not used.",
        )
    return out


def _from_modes(
    modes: list[dict[str, Any]], name: str, shapes: Shapes | None, fit: ResponseFit | None = None
) -> Measured:
    """Return resonances of a file that is no table of them."""
    with explained(name, {"mode": modes}):
        out = Measured(title=Path(name).stem, mode=modes)
    out._on_points, out._responses = shapes, fit
    return out


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
