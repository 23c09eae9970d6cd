"""From a TOML file to a `Scene`: datums and gear heads resolved, errors named by the keys of the file.

The format is documented by the files in ``geometry``.
"""

from __future__ import annotations

import math
import os
import tomllib
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, model_validator

from solidgear.bearing_stiffness import stiffness_matrix
from solidgear.errors import SceneError, nearest
from solidgear.scene import Ask, Attachment, Bearing, Material, Model, Port, Scene, Segment, Status
from solidgear.units import Angle, AxialSpring, Density, Length, Modulus, Poisson, PositiveLength, Thickness

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
                raise SceneError(f"must be smaller than {key} ({getattr(self, key):.6g} m)", path=("bore",))


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
            raise SceneError(f"passes the apex of the pitch cone; it must be shorter than the cone distance {longest:.6g} m", path=("face_width",))
        if self.bore >= 2 * self.small_radius:
            raise SceneError(f"must be smaller than the small end of the head (diameter {2 * self.small_radius:.6g} m)", path=("bore",))
        return self

    def pieces(self):
        axial = self.face_width * math.cos(self.pitch_angle)
        rows = [(self.name, "frustum", axial, self.small_radius, self.pitch_radius)]
        if self.backcone > 0:
            rows.append((f"{self.name}.backcone", "backcone", self.backcone, self.pitch_radius, self.pitch_radius))
        return rows if self.toe == "start" else [(n, p, a, r1, r0) for n, p, a, r0, r1 in reversed(rows)]


class _BearingTable(Model):
    name: Name
    position: Length
    from_: str = Field("start", alias="from")
    seat_width: PositiveLength
    stiffness: Annotated[dict[str, Any], AfterValidator(_entries)] | None = None
    matrix: list[Any] | None = None
    axial_series: tuple[AxialSpring, ...] = ()
    attachment: Attachment | None = None
    status: Status = "assumed"
    note: str = ""

    @model_validator(mode="after")
    def _one_stiffness(self):
        if self.stiffness is None and self.matrix is None:
            raise SceneError("this key is missing; write stiffness = {kxx = ...} or matrix = 6 rows of 6 numbers", path=("stiffness",))
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
            raise SceneError('this key is missing; write at = "<segment>.middle", or position with from', path=("at",))
        if self.at is not None and (self.position is not None or self.from_ is not None):
            raise SceneError("give either at, or position with from, not both", path=("at",))
        if self.attach_to is None and self.span is None:
            raise SceneError('this key is missing; name the segment whose surface carries the port, or write span = ["0 mm", "58 mm"]', path=("attach_to",))
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


def _drop_tag(loc: tuple) -> tuple:
    """pydantic puts the kind of a segment into its location; the file has no such key."""
    return (*loc[:2], *loc[3:]) if loc[:1] == ("segment",) and loc[2:3] and loc[2] in _KINDS else loc


class _Datums:
    """Positions along y that a file can measure from, by name."""

    def __init__(self, length: float):
        self.y = {"start": 0.0, "end": length}

    def segment(self, name: str, lo: float, hi: float) -> None:
        self.y |= {f"{name}.start": lo, f"{name}.end": hi, f"{name}.middle": (lo + hi) / 2}

    def find(self, text: str, path: tuple) -> float:
        if text not in self.y:
            raise SceneError(f"unknown datum{nearest(text, self.y)}; known here: {', '.join(self.y)}", path=path)
        return self.y[text]


def load(path: str | os.PathLike) -> Scene:
    """Read and resolve a scene file.

    Raises
    ------
    SceneError
        One line: the file, the key (``bearing[2] "2".seat_width``, counted from one), the value as written, what would be right.
    """
    where = os.fspath(path)
    raw = _parse(where)
    try:
        try:
            table = _SceneTable(**raw)
        except SceneError as error:
            error.path = _drop_tag(error.path)
            raise
        return _resolve(table, Path(where).stem)
    except SceneError as error:
        raise error.located(raw, where=where) from None


LARGEST = 4_000_000  # bytes; a scene takes some thousands


def _parse(where: str) -> dict[str, Any]:
    try:
        with Path(where).open("rb") as file:
            text = file.read(LARGEST + 1)
        if len(text) > LARGEST:
            raise SceneError(f"this is no scene: it is larger than {LARGEST // 10**6} MB", where=where)
        return tomllib.loads(text.decode("utf-8-sig"))
    except FileNotFoundError:
        reason = "there is no such file"
    except IsADirectoryError:
        reason = "this is a folder; give the TOML file in it"
    except UnicodeDecodeError as error:
        reason = f"not UTF-8 text (byte {error.start}); save the file as UTF-8"
    except tomllib.TOMLDecodeError as error:
        reason = f"not valid TOML: {error}"
    except RecursionError:
        reason = "not a scene: its tables are nested too deeply"
    except (OSError, ValueError) as error:
        reason = f"cannot be read: {getattr(error, 'strerror', None) or error}"
    raise SceneError(reason, where=where)


def _resolve(table: _SceneTable, name: str) -> Scene:
    if not table.segment:
        raise SceneError("a scene needs at least one [[segment]]", path=("segment",))
    segments, owner, frusta, ends = _lay_out(table)
    datums = _Datums(segments[-1].y1)
    for index, (piece, (lo, hi)) in enumerate(zip(table.segment, ends)):
        if f"{piece.name}.start" in datums.y:
            raise SceneError("another segment has this name; each needs its own", path=("segment", index, "name"))
        datums.segment(piece.name, lo, hi)
        if piece.kind == "bevel_head":
            frustum = frusta[piece.name]
            datums.y[f"{piece.name}.mid_face"] = (frustum[0] + frustum[1]) / 2
    bearings = [_bearing(item, index, table.attachment, datums) for index, item in enumerate(table.bearing)]
    port = _port(table.port, table.attachment, datums, frusta)
    housing = table.housing.axial if table.housing else None
    try:
        return Scene.from_parts(segments, table.material, bearings, port, title=table.title, name=name, source=table.source,
                                housing_axial=housing, ask=table.ask)  # fmt: skip
    except SceneError as error:
        error.path = _file_path(error.path, table, owner)
        raise


def _lay_out(table: _SceneTable):
    """Segments end to end; which [[segment]] each came from; surface a port may take, and both ends, of each [[segment]]."""
    segments, owner, surface, ends, y = [], [], {}, [], 0.0
    for index, piece in enumerate(table.segment):
        material = table.material.with_changes(**piece.material.model_dump(exclude_none=True))
        start = y
        for name, part, length, outer0, outer1 in piece.pieces():
            if length <= 1e-9:
                key = {"frustum": "face_width", "backcone": "backcone", "shaft": "length"}[part]
                raise SceneError("is less than a nanometre along the shaft: probably wrong units", path=("segment", index, key))
            inner = piece.bore / 2
            segments.append(Segment(name=name, y0=y, y1=y + length, outer0=outer0, outer1=outer1, inner0=inner, inner1=inner,
                                    material=material, part=part))  # fmt: skip
            owner.append(index)
            y = segments[-1].y1
            if part != "backcone":
                surface[piece.name] = (segments[-1].y0, y)
        ends.append((start, y))
    return segments, owner, surface, ends


def _bearing(item: _BearingTable, index: int, attachment: str, datums: _Datums) -> Bearing:
    y = item.position + datums.find(item.from_, ("bearing", index, "from"))
    given = item.stiffness if item.matrix is None else item.matrix
    try:
        bearing = Bearing(name=item.name, y=y, seat_width=item.seat_width, stiffness=given, axial_series=item.axial_series,
                          attachment=item.attachment or attachment, status=item.status, note=item.note)  # fmt: skip
    except SceneError as error:
        key = "stiffness" if item.matrix is None else "matrix"
        raise SceneError(error.reason, path=("bearing", index, key), value=error.value) from None
    datums.y[f"bearing.{item.name}"] = bearing.y
    return bearing


def _port(item: _PortTable, attachment: str, datums: _Datums, surface: dict[str, tuple[float, float]]) -> Port:
    if item.at is not None:
        y = datums.find(item.at, ("port", "at"))
    else:
        y = item.position + datums.find(item.from_ or "start", ("port", "from"))
    if item.span is not None:
        lo, hi = item.span
    elif item.attach_to in surface:
        lo, hi = surface[item.attach_to]
    else:
        raise SceneError(f"unknown segment{nearest(item.attach_to, surface)}; known here: {', '.join(surface)}", path=("port", "attach_to"))
    return Port(name=item.name, y=y, lo=lo, hi=hi, attachment=item.attachment or attachment)


def _file_path(path: tuple, table: _SceneTable, owner: list[int]) -> tuple:
    """The key in the file that an entry of the resolved scene came from."""
    match path:
        case ("segments", index, key):
            kind = table.segment[owner[index]].kind
            start, end = {"cylinder": ("diameter",) * 2, "cone": ("start_diameter", "end_diameter"), "bevel_head": ("pitch_radius",) * 2}[kind]
            length = "face_width" if kind == "bevel_head" else "length"
            key = {"outer0": start, "outer1": end, "inner0": "bore", "inner1": "bore", "y1": length}.get(key, key)
            return ("segment", owner[index], key)
        case ("bearings", index, key):
            return ("bearing", index, {"y": "position"}.get(key, key))
        case ("port", "y"):
            return ("port", "at" if table.port.at is not None else "position")
        case ("port", "lo" | "hi"):
            return ("port", "span" if table.port.span is not None else "attach_to")
        case ("housing_axial",):
            return ("housing", "axial")
    return path
