"""Measured resonances from a file: frequencies, how sure they are, and what is known of each.

A TOML file holds a list ``mode``; a CSV file has a head such as ``frequency [kHz], multiplicity``;
a universal file has shapes as well, which a TOML file may join to its resonances, or frequency
responses; a CSV file of those has the head ``frequency [Hz], real, imaginary``. A TOML
file with ``file = "tap.uff"`` in place of a list says where the points of one lie and of what unit it
is.

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

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import AfterValidator, BeforeValidator, Field, PrivateAttr, model_validator

from solidgear.body.surface import Surface
from solidgear.errors import SceneError, show
from solidgear.scene.toml_file import parse
from solidgear.scene.typed import Model
from solidgear.scene.units import Frequency, quantity
from solidgear.studies.loading import explained
from solidgear.studies.measured.alignment import BANDWIDTH
from solidgear.studies.measured.axis_labels import response
from solidgear.studies.measured.csv_file import read_csv
from solidgear.studies.measured.placement import Places, PointsTable
from solidgear.studies.measured.responses import ResponseFit
from solidgear.studies.measured.universal import ENDINGS, Responses, Shapes, read_universal

#: resonances of a file
MOST = 2000
#: standard deviation of a component of a shape of which nothing is said, relative to the root mean
#: square of the shape: of careful modal tests
NOISE = (0.05, "relative")


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


def _response_unit(value: Any) -> tuple[float, int] | None:
    """A motion over a force such as ``m/s^2/N``: SI units in one, and derivatives of displacement."""
    if not value:
        return None
    known = response(value) if isinstance(value, str) else None
    if known is None:
        raise SceneError(
            'must be a motion over a force, such as "m/s^2/N" or "g/N"', value=show(value)
        )
    return known


ResponseUnit = Annotated[tuple[float, int] | None, BeforeValidator(_response_unit)]


class MeasuredMode(Model):
    """A measured resonance."""

    frequency: Frequency  #: Hz
    uncertainty: Uncertainty | None = None  #: one standard deviation
    #: 1 for a single resonance, 2 for a pair at one frequency; None where nobody looked
    multiplicity: Annotated[int, Field(strict=True, ge=1, le=2)] | None = None
    #: of the mode where it is known, such as ``bending 1``, or only its family: ``bending``
    name: str = ""
    #: number of its shape among those of the file of shapes, by ascending frequency, from one
    shape: Annotated[int, Field(strict=True, ge=1)] | None = None

    @property
    def width_hz(self) -> float | None:
        """Its standard deviation, Hz."""
        if self.uncertainty is None:
            return None
        value, kind = self.uncertainty
        return value * self.frequency if kind == "relative" else value


class Measured(Model):
    """Measured resonances of a body."""

    title: str = ""
    source: str = ""
    uncertainty: Uncertainty | None = None  #: of all that say nothing else
    shapes: str = ""  #: universal file of shapes, beside this one
    file: str = ""  #: universal file whose resonances are taken in place of a list
    #: of the responses of that file, ``m/s^2/N``: SI units in one, and derivatives of displacement
    response_unit: ResponseUnit = None
    points: PointsTable = PointsTable()  #: where the points of that file lie in the scene
    #: standard deviation of a component of a shape, relative to the root mean square of the shape
    noise: Annotated[Uncertainty, AfterValidator(_share)] = NOISE
    #: ratio; modes nearer to each other than twice that are heard as one peak
    damping: Annotated[Uncertainty, AfterValidator(_share)] = (BANDWIDTH / 2, "relative")
    mode: tuple[MeasuredMode, ...] = ()  #: by ascending frequency
    _on_points: Shapes | None = PrivateAttr(None)
    _responses: ResponseFit | None = PrivateAttr(None)
    _remarks: tuple[str, ...] = PrivateAttr(())

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
        """The same with its points in the frame of a scene, on the surface of its body."""
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
                f"Measuring points were placed on the surface, within {max(1e3 * away, 0.01):.2g} mm, by "
                f"{frame.table}.",
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
                'responses of what file? write file = "tap.uff"', path=("response_unit",)
            )
        if not 1 <= len(self.mode) <= MOST:
            raise SceneError(
                f"holds {len(self.mode)} resonances; give 1 to {MOST}, or the file of them, file =",
                path=("mode",),
            )
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
        return _of_shapes(*read, where)
    tables: Mapping[str, Any] | Responses
    if where.lower().endswith(".csv"):
        with explained(where, {}):
            tables = read_csv(Path(path), tuple(MeasuredMode.model_fields))
    else:
        tables = parse(where)
    if isinstance(tables, Responses):
        return of_responses(tables, where)
    try:
        out = Measured(**tables)
        if out.file:
            return _named(out, Path(where).parent)
        if out.shapes or any(one.shape for one in out.mode):
            out._on_points = _joined(out, Path(where).parent)
    except SceneError as error:
        # what is wrong in the file of shapes is told with that
        raise error if error.where else error.located(tables, where=where) from None
    return out


def _named(table: Measured, folder: Path) -> Measured:
    """Resonances of the universal file that a table names, with what the table says of them."""
    where = folder / table.file
    if not table.file.lower().endswith(ENDINGS):
        raise SceneError(
            "must be a universal file, .unv or .uff", path=("file",), value=show(table.file)
        )
    read = read_universal(where, table.response_unit)
    if isinstance(read, Responses):
        out = of_responses(read, str(where))
    elif table.response_unit:
        raise SceneError(f"{table.file} holds no responses", path=("response_unit",))
    else:
        out = _of_shapes(*read, str(where))
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
    if found is None:
        raise SceneError(
            f"{measured.shapes} gives no places of its points (dataset 15 or 2411)",
            path=("shapes",),
        )
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
    return replace(found, values=values)


def of_responses(responses: Responses, where: str = "responses") -> Measured:
    """Resonances that are found in responses of a file; refused where none stands out of the noise."""
    with explained(where, {}):
        found = ResponseFit.of(responses)
    both = zip(found.fit.frequencies.tolist(), found.widths_hz.tolist())
    modes = [{"frequency": f, "uncertainty": f"{d} Hz"} for f, d in both]
    out = _of_modes(modes, where, found.shapes, found)
    out._remarks = tuple(found.remarks)
    return out


def _of_shapes(frequencies: Sequence[float], shapes: Shapes | None, where: str) -> Measured:
    """Resonances of a file of shapes."""
    out = _of_modes([{"frequency": hertz} for hertz in frequencies], where, shapes)
    if shapes is None:
        out._remarks = (
            "The file gives no places of its points (dataset 15 or 2411), so its shapes take no part.",
        )
    return out


def _of_modes(
    modes: list[dict[str, Any]], where: str, shapes: Shapes | None, fit: ResponseFit | None = None
) -> Measured:
    """Resonances of a file that is no table of them."""
    with explained(where, {"mode": modes}):
        out = Measured(title=Path(where).stem, mode=modes)
    out._on_points, out._responses = shapes, fit
    return out
