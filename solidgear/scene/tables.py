"""The tables of a scene file, each checked by itself: segments, bearings, housing, port."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal, NamedTuple

from pydantic import AfterValidator, Field, model_validator

from solidgear.errors import SceneError
from solidgear.scene.bearing_stiffness import stiffness_matrix
from solidgear.scene.blends import Edge, Surface, slope
from solidgear.scene.catalogue import BearingLoad, Catalogue
from solidgear.scene.model import Ask
from solidgear.scene.parts import Material, Model
from solidgear.scene.point_mass import check_inertia
from solidgear.scene.stations import Attachment, AxialSeries, Face, Hold, Status
from solidgear.scene.units import (
    Angle,
    AxialSpring,
    Density,
    Length,
    Mass,
    Modulus,
    Poisson,
    PositiveLength,
    Thickness,
    quantity,
)

_WORDS = ("start", "end", "bearing")  # first words of datums, so no segment may be called that
KINDS = ("cylinder", "cone", "bevel_head")


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


class Piece(NamedTuple):
    """One frustum of a [[segment]], by its radii at both ends, m."""

    name: str
    part: Literal["shaft", "frustum", "backcone"]
    length: float
    outer0: float
    outer1: float

    def turned(self) -> Piece:
        """End for end."""
        return self._replace(outer0=self.outer1, outer1=self.outer0)


class _Table(Model):
    """A table of the file."""

    def _one_of(self, first: str, other: str, how: str) -> None:
        """Refuse neither of two keys, or both."""
        given = [key for key in (first, other) if getattr(self, key) is not None]
        if not given:
            raise SceneError(f"this key is missing; {how}", path=(first,))
        if len(given) == 2:
            raise SceneError(f"give either {first} or {other}, not both", path=(other,))


class _Piece(_Table):
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

    def pieces(self) -> list[Piece]:
        radius = self.diameter / 2
        return [Piece(self.name, "shaft", self.length, radius, radius)]


class _Cone(_Piece):
    kind: Literal["cone"]
    length: PositiveLength
    start_diameter: PositiveLength
    end_diameter: PositiveLength

    @model_validator(mode="after")
    def _wall(self):
        self._check_bore("start_diameter", "end_diameter")
        return self

    def pieces(self) -> list[Piece]:
        start, end = self.start_diameter / 2, self.end_diameter / 2
        return [Piece(self.name, "shaft", self.length, start, end)]


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
                "passes the apex of the pitch cone; "
                f"it must be shorter than the cone distance {longest:.6g} m",
                path=("face_width",),
            )
        narrow = 2 * self.small_radius
        if self.bore >= narrow:
            raise SceneError(
                f"must be smaller than the small end of the head (diameter {narrow:.6g} m)",
                path=("bore",),
            )
        return self

    def pieces(self) -> list[Piece]:
        axial = self.face_width * math.cos(self.pitch_angle)
        large = self.pitch_radius
        pieces = [Piece(self.name, "frustum", axial, self.small_radius, large)]
        if self.backcone > 0:
            pieces.append(Piece(f"{self.name}.backcone", "backcone", self.backcone, large, large))
        if self.toe == "end":
            pieces = [piece.turned() for piece in reversed(pieces)]
        return pieces


class BearingTable(_Table):
    """A [[bearing]], its datum not yet resolved."""

    name: Name
    position: Length | None = None
    from_: str | None = Field(None, alias="from")
    face: Face | None = None
    seat_width: PositiveLength
    hold: Hold | None = None
    stiffness: Annotated[dict[str, Any], AfterValidator(_entries)] | None = None
    matrix: list[Any] | None = None
    catalogue: Catalogue | None = None
    axial_series: AxialSeries = ()
    attachment: Attachment | None = None
    status: Status | None = None
    note: str = ""

    @model_validator(mode="after")
    def _one_place_one_stiffness(self):
        _place(self)
        given = [k for k in ("stiffness", "matrix", "catalogue") if getattr(self, k) is not None]
        if self.hold is not None:
            given.append("hold")
        if not {"catalogue", "hold"} & set(given):
            how = "write stiffness = {kxx = ...}, matrix = 6 rows of 6 numbers, catalogue = {...}"
            self._one_of("stiffness", "matrix", f'{how}, or hold = "clamped"')
            return self
        if len(given) > 1:
            raise SceneError(f"give either {given[0]} or {given[-1]}, not both", path=(given[0],))
        if self.hold is not None and self.axial_series:
            raise SceneError(
                "a spring in series needs a stiffness beside it; leave one of hold and "
                "axial_series out",
                path=("axial_series",),
            )
        return self


def _place(table: BearingTable) -> None:
    """A seat is somewhere along the shaft, or beside an end face."""
    if table.face is None and table.position is None:
        raise SceneError(
            'this key is missing; write position = "28 mm" with from, or face = "start"',
            path=("position",),
        )
    given = next((k for k in ("position", "from_") if getattr(table, k) is not None), None)
    if table.face is not None and given:
        raise SceneError(
            "give either face, or position with from, not both", path=(given.rstrip("_"),)
        )


class MassTable(_Table):
    """A [[mass]], its datum not yet resolved."""

    name: Name
    mass: Mass
    inertia: list[Any] = Field(default_factory=list)
    offset: list[Any] = Field(default_factory=list)
    on: str | None = None
    position: Length | None = None
    from_: str | None = Field(None, alias="from")
    seat_width: PositiveLength | None = None
    attachment: Attachment | None = None

    @model_validator(mode="after")
    def _one_place_one_body(self):
        how = 'name the port or bearing that carries it, or write position = "28 mm"'
        self._one_of("on", "position", how)
        for key in ("from_", "seat_width", "attachment"):
            if self.on is not None and getattr(self, key) is not None:
                raise SceneError(
                    "belongs to a seat of its own; a mass on a station has that of the station",
                    path=(key.rstrip("_"),),
                )
        if self.on is None and self.seat_width is None:
            raise SceneError(
                "this key is missing: the width of the seat that carries the mass",
                path=("seat_width",),
            )
        self._three("inertia", "inertia", "about x, y and z")
        self._three("offset", "length", "along x, y and z")
        if self.inertia:
            x, y, z = (quantity(entry, "inertia") for entry in self.inertia)
            check_inertia((x, y, z))
        return self

    def _three(self, key: str, dimension: str, what: str) -> None:
        """Refuse a list that is not three quantities of one dimension."""
        given = getattr(self, key)
        if given and len(given) != 3:
            raise SceneError(f"must be three quantities, {what}", path=(key,))
        for k, entry in enumerate(given):
            try:
                quantity(entry, dimension)
            except SceneError as error:
                raise SceneError(error.reason, path=(key, k), value=error.value) from None


class _Housing(Model):
    axial: AxialSpring


class PortTable(_Table):
    """The [port], its datum and surface not yet resolved."""

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
        how = 'name the segment whose surface carries the port, or write span = ["0 mm", "58 mm"]'
        self._one_of("attach_to", "span", how)
        return self


class _FeatureTable(_Table):
    """A [[feature]], its datum not yet resolved."""

    name: Name | None = None
    segment: str
    from_: str | None = Field(None, alias="from")
    position: Length = 0.0
    angle: Any = 0.0

    @model_validator(mode="after")
    def _angle(self):
        try:
            quantity(self.angle, "angle")
        except SceneError as error:
            raise SceneError(error.reason, path=("angle",), value=error.value) from None
        return self


class _KeywayTable(_FeatureTable):
    kind: Literal["keyway"]
    length: PositiveLength
    width: PositiveLength
    depth: PositiveLength
    ends: Literal["round", "square"] = "round"


class _FlatTable(_FeatureTable):
    kind: Literal["flat"]
    length: PositiveLength
    depth: PositiveLength


class _CrossHoleTable(_FeatureTable):
    kind: Literal["cross_hole"]
    diameter: PositiveLength


class _BlendTable(_Table):
    """A [[feature]] at an edge, its datum not yet resolved."""

    name: Name | None = None
    at: str
    surface: Surface = "outer"
    edge: Edge | None = None


class FilletTable(_BlendTable):
    """A fillet."""

    kind: Literal["fillet"]
    radius: PositiveLength


class ChamferTable(_BlendTable):
    """A chamfer."""

    kind: Literal["chamfer"]
    length: PositiveLength
    angle: Any = None

    @model_validator(mode="after")
    def _angle(self):
        if self.angle is not None:
            try:
                slope(self.angle)
            except SceneError as error:
                raise SceneError(error.reason, path=("angle",), value=error.value) from None
        return self


FeatureTable = _KeywayTable | _FlatTable | _CrossHoleTable
BlendTable = FilletTable | ChamferTable
FEATURES = ("keyway", "flat", "cross_hole", "fillet", "chamfer")


class SceneTable(Model):
    """A whole file, each table sound by itself."""

    title: str = ""
    source: str = ""
    attachment: Attachment = "average"
    material: Material
    segment: list[Annotated[_Cylinder | _Cone | _BevelHead, Field(discriminator="kind")]]
    bearing: list[BearingTable] = []
    mass: list[MassTable] = []
    feature: list[Annotated[FeatureTable | BlendTable, Field(discriminator="kind")]] = []
    housing: _Housing | None = None
    port: PortTable
    load: BearingLoad | None = None
    ask: Ask = Ask()


class SoundTables(SceneTable):
    """What is left of a file without the tables that cannot be used."""

    port: PortTable | None = None  # type: ignore[assignment]  # it may be what is missing
