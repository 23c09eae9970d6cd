"""Shapes by which a file describes a shaft, and the segments that they make end to end."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Literal, NamedTuple, TypeAlias

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from solidgear.core.errors import SceneError
from solidgear.core.scene.materials import MaterialName, by_name
from solidgear.core.scene.parts import Material, Segment, Strength
from solidgear.core.scene.places import Places, Seat, plain_name
from solidgear.core.scene.typed import Model, Problems
from solidgear.core.scene.units import (
    Angle,
    Density,
    Modulus,
    Poisson,
    PositiveLength,
    Thickness,
    quantity,
)
from solidgear.core.scene.written import Written

NANOMETRE = 1e-9
_WORDS = ("start", "end", "bearing")  # first words of datums, so no segment may be called that
#: ends the name of the cylinder behind a bevel head
BEHIND = ".backcone"


def _segment_name(name: str) -> str:
    if name in _WORDS:
        raise SceneError("this name is kept for datums; choose another")
    plain_name(name.removesuffix(BEHIND))
    return name


Part = Literal["shaft", "frustum", "backcone"]


class Frustum(NamedTuple):
    """A part of a shape, by the radii at both ends, m."""

    part: Part
    length: float
    outer0: float
    outer1: float

    def turned(self) -> Frustum:
        """Return the frustum turned end for end."""
        return self._replace(outer0=self.outer1, outer1=self.outer0)


class OtherMaterial(Model):
    """Constants of a segment that are not those of the scene."""

    #: Young's modulus, Pa
    E: Modulus | None = None
    #: Poisson's ratio
    nu: Poisson | None = None
    #: density, kg/m^3
    density: Density | None = None
    #: strength for ratings of fatigue; false for none, whatever the scene has
    strength: Strength | Literal[False] | None = None
    #: name in reports, without effect
    name: str | None = None

    def in_scene_of(self, usual: Material) -> Material:
        """Return the material of a segment in a scene with a usual material."""
        changes = {
            key: value
            for key in type(self).model_fields
            if (value := getattr(self, key)) is not None
        }
        if self.strength is False:
            changes["strength"] = None
        return usual.with_changes(**changes)


class _Shape(Model):
    """A [[segment]] of a file, which makes one segment or several."""

    keys: ClassVar[Mapping[str, str]]  #: keys of the file, by the fields of segments they give
    #: places on it that others can be counted from
    datums: ClassVar[tuple[str, ...]] = ("start", "end", "middle")

    #: name that places and reports refer to
    name: Annotated[str, AfterValidator(_segment_name)]
    #: diameter of the bore, m; 0 is solid
    bore: Thickness = 0.0
    #: constants that differ from the material of the shaft, or a name
    material: Annotated[
        OtherMaterial, BeforeValidator(by_name), Written(OtherMaterial | MaterialName)
    ] = OtherMaterial()

    @model_validator(mode="after")
    def _behind_a_head(self):
        if self.name.endswith(BEHIND) and getattr(self, "part", "") != "backcone":
            raise SceneError("a name is a short text without a dot", path=("name",))
        return self

    @property
    def bores(self) -> tuple[float, float]:
        """Diameters of the bore at both ends, m."""
        return self.bore, self.bore

    def _check_bore(self, *keys: str) -> None:
        for key in keys:
            if self.bore >= getattr(self, key):
                raise SceneError(
                    f"must be smaller than {key} ({getattr(self, key):.6g} m)", path=("bore",)
                )

    def frusta(self) -> list[Frustum]:
        """Return the frusta that make up the shape, in the order of the shaft."""
        raise NotImplementedError

    def key_of(self, field: str) -> str:
        """Return the key of the file that a field of a segment came from."""
        return {"inner0": "bore", "inner1": "bore", **self.keys}.get(field, field)


class Cylinder(_Shape):
    """A cylinder."""

    keys: ClassVar = {"outer0": "diameter", "outer1": "diameter", "y1": "length"}

    kind: Literal["cylinder"]
    #: length along the shaft, m
    length: PositiveLength
    #: outer diameter, m
    diameter: PositiveLength
    #: part of a bevel head that is written as its two pieces
    part: Part = "shaft"

    @model_validator(mode="after")
    def _wall(self) -> Cylinder:
        self._check_bore("diameter")
        return self

    def frusta(self) -> list[Frustum]:
        return [Frustum(self.part, self.length, self.diameter / 2, self.diameter / 2)]


class Cone(_Shape):
    """A cone."""

    keys: ClassVar = {"outer0": "start_diameter", "outer1": "end_diameter", "y1": "length"}

    kind: Literal["cone"]
    #: length along the shaft, m
    length: PositiveLength
    #: outer diameter at the start, m
    start_diameter: PositiveLength
    #: outer diameter at the end, m
    end_diameter: PositiveLength
    #: diameter of the bore at the start, m, of a bore that is a cone as well, in place of `bore`
    start_bore: Thickness | None = None
    #: diameter of the bore at the end, m, of a bore that is a cone as well, in place of `bore`
    end_bore: Thickness | None = None
    #: part of a bevel head that is written as its two pieces
    part: Part = "shaft"

    @model_validator(mode="after")
    def _wall(self) -> Cone:
        self._check_bore("start_diameter", "end_diameter")
        ends = {"start_bore": self.start_bore, "end_bore": self.end_bore}
        keys = [key for key, bore in ends.items() if bore is not None]
        if len(keys) == 1:
            missing = next(key for key in ends if key not in keys)
            raise SceneError("start_bore and end_bore go together; give both", path=(missing,))
        if keys and self.bore:
            raise SceneError("give either bore, or start_bore and end_bore", path=("bore",))
        outer = {"start_bore": "start_diameter", "end_bore": "end_diameter"}
        for key in keys:
            if ends[key] >= (widest := getattr(self, outer[key])):
                reason = f"must be smaller than {outer[key]} ({widest:.6g} m)"
                raise SceneError(reason, path=(key,))
        return self

    @property
    def bores(self) -> tuple[float, float]:
        if self.start_bore is None or self.end_bore is None:
            return super().bores
        return self.start_bore, self.end_bore

    def frusta(self) -> list[Frustum]:
        return [Frustum(self.part, self.length, self.start_diameter / 2, self.end_diameter / 2)]


class BevelHead(_Shape):
    """The pitch cone of a bevel gear with the cylinder behind it."""

    keys: ClassVar = {"outer0": "pitch_radius", "outer1": "pitch_radius", "y1": "face_width"}
    datums: ClassVar = ("start", "end", "middle", "mid_face")

    kind: Literal["bevel_head"]
    #: pitch radius at the heel, m
    pitch_radius: PositiveLength
    #: angle of the pitch cone to the axis, rad
    pitch_angle: Angle
    #: face width along the pitch cone, m
    face_width: PositiveLength
    #: length of the cylinder behind the cone, m
    backcone: Thickness = 0.0
    #: end of the shaft that the small end looks to
    toe: Literal["start", "end"] = "start"

    @property
    def small_radius(self) -> float:
        """Radius at the toe, m."""
        return self.pitch_radius - self.face_width * math.sin(self.pitch_angle)

    @model_validator(mode="after")
    def _wall(self) -> BevelHead:
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

    def frusta(self) -> list[Frustum]:
        axial = self.face_width * math.cos(self.pitch_angle)
        large = self.pitch_radius
        frusta = [Frustum("frustum", axial, self.small_radius, large)]
        if self.backcone > 0:
            frusta.append(Frustum("backcone", self.backcone, large, large))
        return [frustum.turned() for frustum in reversed(frusta)] if self.toe == "end" else frusta


Shape: TypeAlias = Annotated[Cylinder | Cone | BevelHead, Field(discriminator="kind")]
SHAPES: dict[str, type[_Shape]] = {"cylinder": Cylinder, "cone": Cone, "bevel_head": BevelHead}


class Laid(NamedTuple):
    """Shapes laid end to end."""

    segments: list[Segment]
    shapes: list[tuple[int, Shape]]  #: of each segment, with its place in the file

    def path(self, path: tuple) -> tuple:
        """Return the path in the file that an entry of the segments came from."""
        if not path[1:]:
            return ("segment",)
        _, place, key, *further = path
        index, shape = self.shapes[place]
        if key == "material" and getattr(shape.material, further[0]) is None:
            return ("material", *further)
        return ("segment", index, shape.key_of(key), *further)


def lay_out(shapes: Sequence[Shape], usual: Material, places: Places) -> Laid:
    """Lay shapes end to end from y = 0 and enter their datums; problems have paths of the file."""
    laid, problems, y = Laid([], []), [], 0.0
    places.datums["start"] = 0.0
    for index, shape in enumerate(shapes):
        start = y
        material = shape.material.in_scene_of(usual)
        for frustum in shape.frusta():
            try:
                segment = _segment(shape, frustum, y, {"y0": y, "material": material})
            except SceneError as error:
                problems += [
                    problem.located(None, path=("segment", index, shape.key_of(problem.path[0])))
                    for problem in error.problems
                ]
                continue
            laid.segments.append(segment)
            laid.shapes.append((index, shape))
            y = segment.y1
            if frustum.part != "backcone" or shape.name.endswith(BEHIND):
                places.surface[shape.name] = (segment.y0, y)
        places.enter(shape.name, (start, y), shape.datums)
    places.datums["end"] = y
    if problems:
        raise SceneError.of(problems)
    return laid


def segment_of(
    kind: str, words: Mapping[str, Any], y0: Any = None, material: Any = None
) -> Segment:
    """Return the segment of a cylinder or cone by the words of a file, which begins at `y0` (m), or
    where a scene puts it, and is of a material of its own or of that of the scene.
    """
    shape = SHAPES[kind](**{"kind": kind, **words})
    (frustum,) = shape.frusta()
    fields = {"y0": y0, "material": material}
    problems = Problems()
    start = 0.0 if y0 is None else problems.read(lambda: quantity(y0, "length"), ("y0",))
    problems.raise_any()
    try:
        return _segment(
            shape, frustum, start or 0.0, {key: v for key, v in fields.items() if v is not None}
        )
    except SceneError as error:
        raise SceneError.of(
            problem.located(
                {**words, **fields}, path=(shape.key_of(problem.path[0]), *problem.path[1:])
            )
            for problem in error.problems
        ) from None


def _segment(shape: Any, frustum: Frustum, y: float, fields: Mapping[str, Any]) -> Segment:
    behind = frustum.part == "backcone" and not shape.name.endswith(BEHIND)
    start_bore, end_bore = shape.bores
    if frustum.length <= NANOMETRE:
        key = "backcone" if frustum.part == "backcone" else "y1"
        reason = "is less than a nanometre along the shaft: probably wrong units"
        raise SceneError(reason, path=(key,))
    return Segment(
        name=shape.name + BEHIND * behind,
        y1=y + frustum.length,
        outer0=frustum.outer0,
        outer1=frustum.outer1,
        inner0=start_bore / 2,
        inner1=end_bore / 2,
        part=frustum.part,
        **fields,
    )


@dataclass
class Patches:
    """A part of a scene, which gives places on its faces."""

    body: Any

    def span(self, seat: Seat) -> tuple[float, float]:
        """Refuse a seat by diameter."""
        reason = "a seat by diameter is looked for where a file is read: give its place and width"
        raise SceneError(reason, path=("diameter",))


def places_on(segments: Sequence[Segment], body: Any = None) -> Places:
    """Return the places on segments end to end, as those of the shapes of a file."""
    part = None if body is None else Patches(body)
    places = Places(of_body=body is not None, part=part)
    places.datums |= {"start": segments[0].y0, "end": segments[-1].y1}
    names = {segment.name.removesuffix(BEHIND): segment for segment in segments}
    for name in names:
        pieces = [s for s in segments if s.name in (name, name + BEHIND)]
        head = next((s for s in pieces if s.name == name), pieces[0])
        places.surface[name] = (head.y0, head.y1)
        kind = BevelHead if head.part == "frustum" else Cylinder
        places.enter(name, (pieces[0].y0, pieces[-1].y1), kind.datums)
        places.segments.append(name)
    places.names = [*places.datums]
    return places
