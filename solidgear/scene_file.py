"""From a TOML file to a `Scene`: datums and gear heads resolved, errors named by the keys of the
file.

The format is documented by the files in ``geometry``. Every problem of a file is told at once: of
all tables on their own, of all names that they use of each other, and of the places of all that is
sound so far.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, model_validator

from solidgear.bearing_stiffness import stiffness_matrix
from solidgear.errors import SceneError, listed, nearest
from solidgear.scene import (
    Ask,
    Attachment,
    AxialSeries,
    Bearing,
    Material,
    Model,
    Port,
    Scene,
    Segment,
    Status,
)
from solidgear.scene_rules import (
    MOST_BEARINGS,
    MOST_SEGMENTS,
    shaft_problems,
    station_problems,
    too_many,
)
from solidgear.toml_file import parse
from solidgear.units import (
    Angle,
    AxialSpring,
    Density,
    Length,
    Modulus,
    Poisson,
    PositiveLength,
    Thickness,
)

_WORDS = ("start", "end", "bearing")  # first words of datums, so no segment may be called that
_KINDS = ("cylinder", "cone", "bevel_head")


def _plain_name(name: str) -> str:
    if not name.strip() or "." in name or len(name) > 60 or not name.isprintable():
        raise SceneError("a name is a short text without a dot")
    return name


def _segment_name(name: str) -> str:
    if name in _WORDS:
        raise SceneError("this name is kept for datums; choose another")
    return _plain_name(name)


def _entries(entries: dict) -> dict:
    stiffness_matrix(entries)
    return entries


Name = Annotated[str, AfterValidator(_plain_name)]
SegmentName = Annotated[str, AfterValidator(_segment_name)]


class _MaterialChange(Model):
    E: Modulus | None = None
    nu: Poisson | None = None
    density: Density | None = None


class _Piece(Model):
    name: SegmentName
    bore: Thickness = 0.0
    material: _MaterialChange = _MaterialChange()

    def _check_bore(self, *keys: str) -> None:
        for key in keys:
            if self.bore >= getattr(self, key):
                raise SceneError(
                    f"must be smaller than {key} ({getattr(self, key):.6g} m)", path=("bore",)
                )


class _Cylinder(_Piece):
    kind: Literal["cylinder"]
    length: PositiveLength
    diameter: PositiveLength

    @model_validator(mode="after")
    def _wall(self):
        self._check_bore("diameter")
        return self

    def pieces(self):
        return [(self.name, "shaft", self.length, self.diameter / 2, self.diameter / 2)]


class _Cone(_Piece):
    kind: Literal["cone"]
    length: PositiveLength
    start_diameter: PositiveLength
    end_diameter: PositiveLength

    @model_validator(mode="after")
    def _wall(self):
        self._check_bore("start_diameter", "end_diameter")
        return self

    def pieces(self):
        return [(self.name, "shaft", self.length, self.start_diameter / 2, self.end_diameter / 2)]


class _BevelHead(_Piece):
    kind: Literal["bevel_head"]
    pitch_radius: PositiveLength
    pitch_angle: Angle
    face_width: PositiveLength
    backcone: Thickness = 0.0
    toe: Literal["start", "end"] = "start"

    @property
    def small_radius(self) -> float:
        return self.pitch_radius - self.face_width * math.sin(self.pitch_angle)

    @model_validator(mode="after")
    def _wall(self):
        if self.small_radius <= 0:
            longest = self.pitch_radius / math.sin(self.pitch_angle)
            raise SceneError(
                f"passes the apex of the pitch cone; it must be shorter than the cone distance {longest:.6g} m",
                path=("face_width",),
            )
        if self.bore >= 2 * self.small_radius:
            raise SceneError(
                f"must be smaller than the small end of the head (diameter {2 * self.small_radius:.6g} m)",
                path=("bore",),
            )
        return self

    def pieces(self):
        axial = self.face_width * math.cos(self.pitch_angle)
        rows = [(self.name, "frustum", axial, self.small_radius, self.pitch_radius)]
        if self.backcone > 0:
            rows.append(
                (
                    f"{self.name}.backcone",
                    "backcone",
                    self.backcone,
                    self.pitch_radius,
                    self.pitch_radius,
                )
            )
        return (
            rows
            if self.toe == "start"
            else [(n, p, a, r1, r0) for n, p, a, r0, r1 in reversed(rows)]
        )


class _BearingTable(Model):
    name: Name
    position: Length
    from_: str = Field("start", alias="from")
    seat_width: PositiveLength
    stiffness: Annotated[dict[str, Any], AfterValidator(_entries)] | None = None
    matrix: list[Any] | None = None
    axial_series: AxialSeries = ()
    attachment: Attachment | None = None
    status: Status = "assumed"
    note: str = ""

    @model_validator(mode="after")
    def _one_stiffness(self):
        if self.stiffness is None and self.matrix is None:
            raise SceneError(
                "this key is missing; write stiffness = {kxx = ...} or matrix = 6 rows of 6 numbers",
                path=("stiffness",),
            )
        if self.stiffness is not None and self.matrix is not None:
            raise SceneError("give either stiffness or matrix, not both", path=("matrix",))
        return self


class _Housing(Model):
    axial: AxialSpring


class _PortTable(Model):
    name: Name = "port"
    at: str | None = None
    position: Length | None = None
    from_: str | None = Field(None, alias="from")
    attach_to: str | None = None
    span: Annotated[list[Length], Field(min_length=2, max_length=2)] | None = None
    attachment: Attachment | None = None

    @model_validator(mode="after")
    def _one_place_one_surface(self):
        if self.at is None and self.position is None:
            raise SceneError(
                'this key is missing; write at = "<segment>.middle", or position with from',
                path=("at",),
            )
        if self.at is not None and (self.position is not None or self.from_ is not None):
            raise SceneError("give either at, or position with from, not both", path=("at",))
        if self.attach_to is None and self.span is None:
            raise SceneError(
                'this key is missing; name the segment whose surface carries the port, or write span = ["0 mm", "58 mm"]',
                path=("attach_to",),
            )
        if self.attach_to is not None and self.span is not None:
            raise SceneError("give either attach_to or span, not both", path=("span",))
        return self


class _SceneTable(Model):
    title: str = ""
    source: str = ""
    attachment: Attachment = "average"
    material: Material
    segment: list[Annotated[_Cylinder | _Cone | _BevelHead, Field(discriminator="kind")]]
    bearing: list[_BearingTable] = []
    housing: _Housing | None = None
    port: _PortTable
    ask: Ask = Ask()


class _SoundTables(_SceneTable):
    """What is left of a file without the tables that cannot be used."""

    port: _PortTable | None = None  # type: ignore[assignment]  # it may be what is missing


def _drop_tag(loc: tuple) -> tuple:
    """pydantic puts the kind of a segment into its location; the file has no such key."""
    return (
        (*loc[:2], *loc[3:]) if loc[:1] == ("segment",) and loc[2:3] and loc[2] in _KINDS else loc
    )


# ------------------------------------------------------------------------------------------------- reading
def load(path: str | os.PathLike) -> Scene:
    """Read and resolve a scene file.

    Raises
    ------
    SceneError
        The file, the key (``bearing[2] "2".seat_width``, counted from one), the value as written,
        what would be right: one line for each problem, in the order of the file.
    """
    where = os.fspath(path)
    raw = parse(where)
    try:
        return _read(raw, Path(where).stem)
    except SceneError as error:
        problems = {
            (one.path, one.reason): one for one in error.problems
        }  # both ends of a cylinder are one diameter
        order = _FileOrder(raw)
        ordered = sorted(problems.values(), key=lambda one: order.of(one.path))
        raise SceneError.of(ordered).located(raw, where=where) from None


def _read(raw: dict[str, Any], name: str) -> Scene:
    for what, most in (("segment", MOST_SEGMENTS), ("bearing", MOST_BEARINGS)):
        if isinstance(raw.get(what), list) and len(raw[what]) > most:
            raise SceneError(too_many(f"{what}s", len(raw[what]), most), path=(what,))
    problems: list[SceneError] = []
    table, numbers = _tables(raw, problems)
    problems += _unknown_names(raw)
    if table is None:
        raise SceneError.of(problems)
    return _resolve(table, numbers, name, problems)


def _tables(
    raw: dict[str, Any], problems: list[SceneError]
) -> tuple[_SceneTable | None, list[int]]:
    """The tables that are sound each by itself, and which bearings of the file are among them; None
    without a whole shaft.
    """
    count = len(raw["bearing"]) if isinstance(raw.get("bearing"), list) else 0
    try:
        return _SceneTable(**raw), list(range(count))
    except SceneError as error:
        found = [one.located(raw, path=_drop_tag(one.path)) for one in error.problems]
    problems += found
    spoilt = {one.path[: 2 if one.path[0] in ("segment", "bearing") else 1] for one in found}
    if ("bearing",) in spoilt or any(place[0] in ("segment", "material") for place in spoilt):
        return None, []
    numbers = [k for k in range(count) if ("bearing", k) not in spoilt]
    sound = {
        key: raw[key]
        for key in ("material", "segment", "attachment", "port")
        if key in raw and (key,) not in spoilt
    }
    return _SoundTables(**sound, bearing=[raw["bearing"][k] for k in numbers]), numbers


class _FileOrder:
    """Where entries stand in a file."""

    def __init__(self, raw: Mapping):
        self.raw = raw
        self.places: dict[int, dict] = {}

    def of(self, path: tuple) -> list[int]:
        """Places of the keys of a path in their tables, the last one for a key that is missing."""
        out: list[int] = []
        here = self.raw
        for key in path:
            if id(here) not in self.places:
                keys = (
                    here
                    if isinstance(here, Mapping)
                    else range(len(here))
                    if isinstance(here, list)
                    else ()
                )
                self.places[id(here)] = {key: place for place, key in enumerate(keys)}
            places = self.places[id(here)]
            if key not in places:
                return [*out, len(places)]
            out.append(places[key])
            here = here[key]
        return out


# ------------------------------------------------------------------------------------------------- names
_PIECES = {"bevel_head": ("start", "end", "middle", "mid_face")}
_EVERY_PIECE = ("start", "end", "middle")


def _unknown_names(raw: dict[str, Any]) -> Iterator[SceneError]:
    """Names of segments that are taken twice, and datums and segments that are asked for but are
    not there.

    Read from the file as it stands, since a segment of a wrong length still has its name.
    """
    pieces, bearings, port = (
        _list_of_tables(raw.get("segment")),
        _list_of_tables(raw.get("bearing", [])),
        raw.get("port"),
    )
    if pieces is None or not all(isinstance(piece.get("name"), str) for piece in pieces):
        return  # what is meant by a name cannot be told
    known, segments = ["start", "end"], []
    for i, piece in enumerate(pieces):
        if piece["name"] in segments:
            yield SceneError(
                "another segment has this name; each needs its own", path=("segment", i, "name")
            )
        segments.append(piece["name"])
        known += [
            f"{piece['name']}.{part}" for part in _PIECES.get(str(piece.get("kind")), _EVERY_PIECE)
        ]
    for i, bearing in enumerate(bearings or ()):
        yield from _unknown_datum(bearing.get("from"), known, ("bearing", i, "from"))
        known.append(f"bearing.{bearing.get('name')}")
    if isinstance(port, Mapping) and bearings is not None:
        for key in ("at", "from"):
            yield from _unknown_datum(port.get(key), known, ("port", key))
        carrier = port.get("attach_to")
        if isinstance(carrier, str) and carrier not in segments:
            yield SceneError(
                f"unknown segment{nearest(carrier, segments)}; known here: {listed(segments)}",
                path=("port", "attach_to"),
            )


def _list_of_tables(value: Any) -> list[Mapping] | None:
    return (
        value
        if isinstance(value, list) and all(isinstance(entry, Mapping) for entry in value)
        else None
    )


def _unknown_datum(text: Any, known: list[str], path: tuple) -> Iterable[SceneError]:
    if isinstance(text, str) and text not in known:
        yield SceneError(
            f"unknown datum{nearest(text, known)}; known here: {listed(known)}", path=path
        )


# ------------------------------------------------------------------------------------------------- places
def _resolve(
    table: _SceneTable, numbers: list[int], name: str, problems: list[SceneError]
) -> Scene:
    """The scene, if nothing is wrong with the places of its parts nor was before."""
    if not table.segment:
        raise SceneError.of(
            [*problems, SceneError("a scene needs at least one [[segment]]", path=("segment",))]
        )
    segments, owner, surface, datums = _lay_out(table, problems)
    if segments is not None:
        shaft = shaft_problems(segments)
        problems += [one.located(None, path=_file_path(one.path, table, owner)) for one in shaft]
        segments = None if shaft else segments
    if segments is None:
        raise SceneError.of(problems)
    bearings = {}
    for index, item in zip(numbers, table.bearing):
        if item.from_ in datums:  # else said before, or measured from a bearing that was refused
            try:
                bearings[index] = _bearing(item, index, table.attachment, datums)
            except SceneError as error:
                problems.append(error)
    port = None
    try:
        port = _port(table.port, table.attachment, datums, surface) if table.port else None
    except SceneError as error:
        problems.append(error)
    problems += [
        one.located(None, path=_file_path(one.path, table, owner))
        for one in station_problems(segments, port, bearings)
    ]
    if problems:
        raise SceneError.of(problems)
    return Scene.from_parts(
        segments,
        table.material,
        bearings.values(),
        port,
        title=table.title,
        name=name,
        source=table.source,
        housing_axial=table.housing.axial if table.housing else None,
        ask=table.ask,
    )


def _lay_out(table: _SceneTable, problems: list[SceneError]):
    """Segments end to end (None if one cannot be); which [[segment]] each came from; the surface of
    each by name; and all datums.
    """
    segments, owner, surface, datums, y = [], [], {}, {"start": 0.0}, 0.0
    for index, piece in enumerate(table.segment):
        material = table.material.with_changes(**piece.material.model_dump(exclude_none=True))
        start = y
        for name, part, length, outer0, outer1 in piece.pieces():
            if length <= 1e-9:
                key = {"frustum": "face_width", "backcone": "backcone", "shaft": "length"}[part]
                problems.append(
                    SceneError(
                        "is less than a nanometre along the shaft: probably wrong units",
                        path=("segment", index, key),
                    )
                )
                continue
            inner = piece.bore / 2
            try:
                segments.append(
                    Segment(
                        name=name,
                        y0=y,
                        y1=y + length,
                        outer0=outer0,
                        outer1=outer1,
                        inner0=inner,
                        inner1=inner,
                        material=material,
                        part=part,
                    )
                )
            except SceneError as error:
                problems.append(
                    error.located(
                        None,
                        path=_file_path(
                            ("segments", index, error.path[0]), table, range(index + 1)
                        ),
                    )
                )
                continue
            owner.append(index)
            y = segments[-1].y1
            if part != "backcone":
                surface[piece.name] = (segments[-1].y0, y)
                if piece.kind == "bevel_head":
                    datums[f"{piece.name}.mid_face"] = (segments[-1].y0 + y) / 2
        datums |= {
            f"{piece.name}.start": start,
            f"{piece.name}.end": y,
            f"{piece.name}.middle": (start + y) / 2,
        }
    whole = len(segments) == sum(len(piece.pieces()) for piece in table.segment)
    return segments if whole else None, owner, surface, datums | {"end": y}


def _bearing(item: _BearingTable, index: int, attachment: str, datums: dict[str, float]) -> Bearing:
    y = item.position + datums[item.from_]
    given = item.stiffness if item.matrix is None else item.matrix
    try:
        bearing = Bearing(
            name=item.name,
            y=y,
            seat_width=item.seat_width,
            stiffness=given,
            axial_series=item.axial_series,
            attachment=item.attachment or attachment,
            status=item.status,
            note=item.note,
        )
    except SceneError as error:
        key = "stiffness" if item.matrix is None else "matrix"
        raise SceneError(error.reason, path=("bearing", index, key), value=error.value) from None
    datums[f"bearing.{item.name}"] = bearing.y
    return bearing


def _port(
    item: _PortTable,
    attachment: Attachment,
    datums: dict[str, float],
    surface: dict[str, tuple[float, float]],
) -> Port | None:
    """The port, or None where it names what is not there."""
    datum = item.at or item.from_ or "start"
    span: Sequence[float] | None = item.span
    if span is None and item.attach_to is not None:
        span = surface.get(item.attach_to)
    if datum not in datums or span is None:
        return None
    lo, hi = span
    return Port(
        name=item.name,
        y=datums[datum] + (item.position or 0.0),
        lo=lo,
        hi=hi,
        attachment=item.attachment or attachment,
    )


def _file_path(path: tuple, table: _SceneTable, owner: Sequence[int]) -> tuple:
    """The key in the file that an entry of the resolved scene came from."""
    match path:
        case ("segments", index, key):
            kind = table.segment[owner[index]].kind
            start, end = {
                "cylinder": ("diameter",) * 2,
                "cone": ("start_diameter", "end_diameter"),
                "bevel_head": ("pitch_radius",) * 2,
            }[kind]
            length = "face_width" if kind == "bevel_head" else "length"
            key = {
                "outer0": start,
                "outer1": end,
                "inner0": "bore",
                "inner1": "bore",
                "y1": length,
            }.get(key, key)
            return ("segment", owner[index], key)
        case ("segments", index, "material", key):
            own = getattr(table.segment[owner[index]].material, key) is not None
            return ("segment", owner[index], "material", key) if own else ("material", key)
        case ("bearings", index, key):
            return ("bearing", index, {"y": "position"}.get(key, key))
        case ("port", "y"):
            return ("port", "at" if table.port.at is not None else "position")
        case ("port", "lo" | "hi"):
            return ("port", "span" if table.port.span is not None else "attach_to")
        case ("housing_axial",):
            return ("housing", "axial")
    return path
