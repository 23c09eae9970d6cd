"""The [[segment]] of a scene file, each checked by itself."""

from __future__ import annotations

import math
from typing import Annotated, Literal, NamedTuple

from pydantic import AfterValidator, BeforeValidator, model_validator

from solidgear.errors import SceneError
from solidgear.scene.materials import by_name
from solidgear.scene.parts import Model
from solidgear.scene.units import (
    Angle,
    Density,
    Modulus,
    Poisson,
    PositiveLength,
    Thickness,
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


class Table(Model):
    """A table of the file."""

    def _one_of(self, first: str, other: str, how: str) -> None:
        """Refuse neither of two keys, or both."""
        given = [key for key in (first, other) if getattr(self, key) is not None]
        if not given:
            raise SceneError(f"this key is missing; {how}", path=(first,))
        if len(given) == 2:
            raise SceneError(f"give either {first} or {other}, not both", path=(other,))


class _Piece(Table):
    name: SegmentName
    bore: Thickness = 0.0
    material: Annotated[_MaterialChange, BeforeValidator(by_name)] = _MaterialChange()

    def _check_bore(self, *keys: str) -> None:
        for key in keys:
            if self.bore >= getattr(self, key):
                raise SceneError(
                    f"must be smaller than {key} ({getattr(self, key):.6g} m)", path=("bore",)
                )


class Cylinder(_Piece):
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


class Cone(_Piece):
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


class BevelHead(_Piece):
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
