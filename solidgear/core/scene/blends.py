"""Fillets and chamfers at the edges of a shaft: it stays a body of revolution.

An edge is a corner of the meridian (r, y).  At the root of a step material is added in the corner,
at a rim it is taken away; either way the outline runs from a point on the plane face to a point on
the cylinder beside it, along an arc or straight.

Another edge of revolution is a :class:`Corner` here, a piece of :mod:`solidgear.core.scene.outline`,
its volume in :mod:`solidgear.core.scene.closed_form` and its cells in
:mod:`solidgear.core.meshing.blended`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, TypeAlias

from solidgear.core.errors import SceneError
from solidgear.core.scene.corner import Corner, Surface
from solidgear.core.scene.limits import TOUCH
from solidgear.core.scene.outline import radii_of
from solidgear.core.scene.parts import Segment
from solidgear.core.scene.places import Along, Placed, Places
from solidgear.core.scene.units import Position, PositiveLength, SignedAngle
from solidgear.core.scene.written import Range

Edge = Literal["root", "rim"]


class _At(Along):
    """Words for the place of an edge: a datum, or a position."""

    #: place of the edge, such as `NAME.end` of a segment
    at: str | None = None


class _Blend(Placed):
    """Base of fillets and chamfers."""

    Words: ClassVar = _At
    sources: ClassVar = {"y": ("at", "position")}
    needs: ClassVar = (("at", "position"),)

    if TYPE_CHECKING:
        kind: str  # a field of every subclass, in its own order

    #: name in reports; by default its kind and number
    name: str
    y: Position
    #: surface that the edge lies on
    surface: Surface = "outer"
    #: root adds material in the corner of a step, rim rounds off the edge; by default the root,
    #: and the rim at an end face
    edge: Edge | None = None

    @classmethod
    def place(cls, words: Any, table: Mapping[str, Any], places: Places) -> dict[str, Any]:
        if words.at is not None:
            words.refuse("give either at, or position with from, not both", "position", "from_")
            return {"y": places.datum(words.at, "at")}
        words.require("position", 'name the edge, as at = "<segment>.end"', "at")
        return {"y": words.y(places)}

    @property
    def what(self) -> str:
        """Kind in words."""
        return self.kind

    @property
    def extents(self) -> tuple[float, float]:
        """Extents along the shaft and across, m."""
        raise NotImplementedError

    @property
    def size_key(self) -> str:
        """Field that gives the size."""
        raise NotImplementedError

    def corner(self, segments: Sequence[Segment]) -> Corner:
        """Return the edge on a shaft; refuse a missing edge, and one that cannot be rounded."""
        outer = self.surface == "outer"
        i, low, high = self._place(segments)
        before = radii_of(low, self.surface)[1] if low else None
        after = radii_of(high, self.surface)[0] if high else None
        edge = self.edge
        if before is None or after is None:
            if edge == "root":
                raise SceneError(
                    "an end face has no root, only a rim; the root is that of a step",
                    path=("edge",),
                )
            edge = "rim"
            owner = i if low is None else i - 1
        else:
            if abs(before - after) <= 1e-9 * max(before, after):
                surface_name = "outer radius" if outer else "bore"
                raise SceneError(
                    f"the {surface_name} has no step at y = {self.y:.6g} m; a {self.what} needs a step or "
                    "the edge of an end face",
                    path=("y",),
                )
            edge = edge or "root"
            # the root is on the surface that lies deeper in the material, the rim on the other
            deeper_first = (before < after) == outer
            owner = i - 1 if deeper_first == (edge == "root") else i
        owner_segment = segments[owner]
        start, end = radii_of(owner_segment, self.surface)
        radius = start if owner == i else end
        if not radius:
            raise SceneError(f'"{owner_segment.name}" has no bore there', path=("surface",))
        if start != end:
            raise SceneError(
                f'"{owner_segment.name}" is a cone there; a {self.what} runs into a cylinder',
                path=("y",),
            )
        if edge == "root" and low and high and low.material != high.material:
            raise SceneError(
                f'"{low.name}" and "{high.name}" are of two materials; a {self.what} at their '
                "root is not possible",
                path=("y",),
            )
        axial, radial = self.extents
        return Corner(
            name=self.name,
            kind=self.what,
            y=owner_segment.y0 if owner == i else owner_segment.y1,
            r=radius,
            surface=self.surface,
            root=edge == "root",
            owner=owner,
            side=1 if owner == i else -1,
            out=1 if (edge == "root") == outer else -1,
            axial=axial,
            radial=radial,
        )

    def _place(self, segments):
        """Return the number of the segment that begins at the edge, and the segments on both sides."""
        ends = [0.0, *(s.y1 for s in segments)]
        near = [k for k, y in enumerate(ends) if abs(y - self.y) <= TOUCH]
        if not near:
            raise SceneError(
                f"no segment begins or ends at y = {self.y:.6g} m; a {self.what} needs a step or "
                'the edge of an end face, such as "<segment>.end"',
                path=("y",),
            )
        k = near[0]
        low = segments[k - 1] if k else None
        return k, low, segments[k] if k < len(segments) else None


class Fillet(_Blend):
    """A quarter of a circle at an edge.

    `y` is the place of the edge, m: a step, or an end face. The edge 'root' adds material in the
    corner of a step, 'rim' rounds off the edge; by default the root, and the rim at an end face.

    Examples
    --------
    >>> from solidgear.core.scene import Fillet
    >>> Fillet(name="head fillet", y="68 mm", radius="4 mm").extents
    (0.004, 0.004)
    """

    kind: Literal["fillet"] = "fillet"
    #: radius of the fillet, m
    radius: PositiveLength

    @property
    def extents(self) -> tuple[float, float]:
        return self.radius, self.radius

    @property
    def size_key(self) -> str:
        return "radius"


#: angle of a chamfer to the axis, rad
Slope = Annotated[
    SignedAngle,
    Range(
        "the angle of a chamfer to the axis lies between 5 and 85 deg",
        least=math.radians(5),
        most=math.radians(85),
    ),
]


class Chamfer(_Blend):
    """A straight cut across an edge, with the fields of :class:`Fillet`; at a root it fills the corner.

    Examples
    --------
    >>> from solidgear.core.scene import Chamfer
    >>> [round(x, 6) for x in Chamfer(name="end", y=0.2, length="2 mm", angle="30 deg").extents]
    [0.002, 0.001155]
    """

    kind: Literal["chamfer"] = "chamfer"
    #: length along the shaft, m
    length: PositiveLength
    #: angle to the axis, rad; 45 degrees by default
    angle: Slope = math.pi / 4

    @property
    def extents(self) -> tuple[float, float]:
        tangent = 1.0 if self.angle == math.pi / 4 else math.tan(self.angle)
        return self.length, self.length * tangent

    @property
    def size_key(self) -> str:
        return "length"


Blend: TypeAlias = Fillet | Chamfer
BLENDS: dict[str, type[_Blend]] = {"fillet": Fillet, "chamfer": Chamfer}
