"""The tables of a scene file, each checked by itself: bearings, masses, port, the whole."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from solidgear.errors import SceneError
from solidgear.scene.bearing_stiffness import stiffness_matrix
from solidgear.scene.blends import Edge, Surface, slope
from solidgear.scene.body_file import BodyTable, SeatTable
from solidgear.scene.catalogue import BearingLoad, Catalogue
from solidgear.scene.materials import by_name
from solidgear.scene.parts import Material, Model
from solidgear.scene.point_mass import check_inertia
from solidgear.scene.port_tables import AskTable, HousingTable, PortTable, SeatHousing
from solidgear.scene.segment_tables import BevelHead, Cone, Cylinder, Name, Table
from solidgear.scene.stations import Attachment, AxialSeries, Face, Hold, Status
from solidgear.scene.units import (
    Length,
    Mass,
    PositiveLength,
    quantity,
)


def _entries(entries: dict) -> dict:
    stiffness_matrix(entries)
    return entries


class BearingTable(Table):
    """A [[bearing]], its datum not yet resolved."""

    name: Name
    position: Length | None = None
    from_: str | None = Field(None, alias="from")
    face: Face | None = None
    seat: SeatTable | None = None
    seat_width: PositiveLength | None = None
    hold: Hold | None = None
    stiffness: Annotated[dict[str, Any], AfterValidator(_entries)] | None = None
    matrix: list[Any] | None = None
    catalogue: Catalogue | None = None
    axial_series: AxialSeries = ()
    housing: SeatHousing | None = None
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
    """A seat is somewhere along the shaft, beside an end face, or a cylinder of a part."""
    if table.seat is not None:
        for key in ("position", "from_", "face", "seat_width"):
            if getattr(table, key) is not None:
                raise SceneError(
                    "a seat has its place and width in seat; leave one of both out",
                    path=(key.rstrip("_"),),
                )
        return
    if table.seat_width is None:
        raise SceneError("this key is missing", path=("seat_width",))
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


class MassTable(Table):
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


class _FeatureTable(Table):
    """A [[feature]] of a segment."""

    name: Name | None = None
    segment: str
    angle: Any = 0.0

    @model_validator(mode="after")
    def _angle(self):
        try:
            quantity(self.angle, "angle")
        except SceneError as error:
            raise SceneError(error.reason, path=("angle",), value=error.value) from None
        return self


class CutTable(_FeatureTable):
    """One cut at a place, its datum not yet resolved."""

    from_: str | None = Field(None, alias="from")
    position: Length = 0.0


class _KeywayTable(CutTable):
    kind: Literal["keyway"]
    length: PositiveLength
    width: PositiveLength
    depth: PositiveLength
    ends: Literal["round", "square"] = "round"


class _FlatTable(CutTable):
    kind: Literal["flat"]
    length: PositiveLength
    depth: PositiveLength


class _CrossHoleTable(CutTable):
    kind: Literal["cross_hole"]
    diameter: PositiveLength


class _ToothedTable(_FeatureTable):
    """Teeth are those of the whole segment; their own class knows the limits."""

    count: Any
    addendum: Any = None
    dedendum: Any = None
    half_thickness: Any = None
    flank_angle: Any = None
    spiral_angle: Any = None
    hand: Any = None
    model: Any = None


class _TeethTable(_ToothedTable):
    kind: Literal["teeth"]


class _SplineTable(_ToothedTable):
    kind: Literal["spline"]


class _BoltCircleTable(_FeatureTable):
    kind: Literal["bolt_circle"]
    count: Any
    diameter: PositiveLength
    circle: PositiveLength
    depth: PositiveLength | None = None
    side: Literal["start", "end"] = "start"


class _BlendTable(Table):
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


FeatureTable = (
    _KeywayTable | _FlatTable | _CrossHoleTable | _TeethTable | _SplineTable | _BoltCircleTable
)
BlendTable = FilletTable | ChamferTable
FEATURES = (
    "keyway",
    "flat",
    "cross_hole",
    "teeth",
    "spline",
    "bolt_circle",
    "fillet",
    "chamfer",
)


def _several(ports: Any) -> Any:
    """One [port] is a list of one."""
    return [ports] if isinstance(ports, Mapping) else ports


class SceneTable(Model):
    """A whole file, each table sound by itself."""

    title: str = ""
    source: str = ""
    attachment: Attachment = "average"
    material: Annotated[Material, BeforeValidator(by_name)]
    body: BodyTable | None = None
    segment: list[Annotated[Cylinder | Cone | BevelHead, Field(discriminator="kind")]]
    bearing: list[BearingTable] = []
    mass: list[MassTable] = []
    feature: list[Annotated[FeatureTable | BlendTable, Field(discriminator="kind")]] = []
    housing: HousingTable | None = None
    port: Annotated[list[PortTable], BeforeValidator(_several), Field(min_length=1)]
    load: BearingLoad | None = None
    ask: AskTable = AskTable()

    @model_validator(mode="after")
    def _one_shaft(self):
        if self.body is None:
            seats: list[tuple[str | int, ...]]
            seats = [("bearing", k) for k, one in enumerate(self.bearing) if one.seat is not None]
            seats += [("port", k) for k, one in enumerate(self.port) if one.seat is not None]
            if seats:
                way = "span, or attach_to with the name of a segment"
                if seats[0][0] == "bearing":
                    way = "position and seat_width"
                raise SceneError(
                    "a seat by diameter is looked for on a part from a file ([body]); on segments "
                    f"write {way}",
                    path=(*seats[0], "seat"),
                )
        if self.material is None and not (self.body and self.body.materials):
            raise SceneError("this key is missing", path=("material",))
        for key, what in (("segment", "describes the shaft"), ("feature", "is cut into segments")):
            if self.body is not None and getattr(self, key):
                raise SceneError(
                    f"a [[{key}]] {what}, which a [body] does itself; leave one of both out",
                    path=(key,),
                )
        return self


class PartTable(SceneTable):
    """A whole file with a part from another file in place of segments."""

    # not needed where the groups of the part have all their own
    material: Annotated[Material | None, BeforeValidator(by_name)] = None  # type: ignore[assignment]
    body: BodyTable
    segment: list[Annotated[Cylinder | Cone | BevelHead, Field(discriminator="kind")]] = []


class SoundTables(SceneTable):
    """What is left of a file without the tables that cannot be used."""

    material: Annotated[Material | None, BeforeValidator(by_name)] = None  # type: ignore[assignment]
    segment: list[Annotated[Cylinder | Cone | BevelHead, Field(discriminator="kind")]] = []
    # they may be what is missing
    port: Annotated[list[PortTable], BeforeValidator(_several)] = []
