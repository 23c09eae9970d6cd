"""Fillets and chamfers at the edges of a shaft: it stays a body of revolution.

An edge is a corner of the meridian (r, y).  At the root of a step material is added in the corner,
at a rim it is taken away; either way the outline runs from a point on the plane face to a point on
the cylinder beside it, along an arc or straight.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal, TypeAlias

from pydantic import BeforeValidator

from solidgear.errors import SceneError
from solidgear.scene.parts import Model, Segment
from solidgear.scene.rules import TOUCH
from solidgear.scene.units import Position, PositiveLength, quantity

#: a shaft carries no more of them
MOST_BLENDS = 40
#: least size over the radius of the edge: smaller ones ask for meshes without end
SMALLEST = 2e-3
#: of a plane face, and of the cylinder between two edges, that may go to fillets and chamfers
MOST_OF_FACE, MOST_OF_LENGTH = 0.95, 0.95

Surface = Literal["outer", "bore"]
Edge = Literal["root", "rim"]


@dataclass(frozen=True)
class Corner:
    """An edge of a shaft with its fillet or chamfer, in plain floats.

    Attributes
    ----------
    name, kind : str
        Kind is fillet or chamfer.
    y, r : float
        Of the sharp edge, m.
    surface : {'outer', 'bore'}
    root : bool
        Material is added; at a rim it is taken away.
    owner : int
        Segment whose cylinder the outline runs into.
    side : int
        +1 if that segment lies at larger y than the edge, -1 otherwise.
    out : int
        +1 if the plane face beside the edge lies at larger radius, -1 otherwise.
    axial, radial : float
        Extent along the shaft and across it, m.

    Examples
    --------
    >>> corner = Corner("f", "fillet", 0.1, 0.02, "outer", True, 1, 1, 1, 0.004, 0.004)
    >>> corner.on_face, corner.on_cylinder
    ((0.024, 0.1), (0.02, 0.10400000000000001))
    """

    name: str
    kind: str
    y: float
    r: float
    surface: Surface
    root: bool
    owner: int
    side: int
    out: int
    axial: float
    radial: float

    @property
    def on_face(self) -> tuple[float, float]:
        """(r, y) where the outline leaves the plane face, m."""
        return self.r + self.out * self.radial, self.y

    @property
    def on_cylinder(self) -> tuple[float, float]:
        """(r, y) where it meets the cylinder, m."""
        return self.r, self.y + self.side * self.axial

    @property
    def centre(self) -> tuple[float, float] | None:
        """(r, y) of the middle of the arc, m; None for a chamfer."""
        return (self.on_face[0], self.on_cylinder[1]) if self.kind == "fillet" else None

    @property
    def middle(self) -> tuple[float, float]:
        """(r, y) halfway along the outline, m."""
        if self.centre is None:
            (a, b), (c, d) = self.on_face, self.on_cylinder
            return (a + c) / 2, (b + d) / 2
        reach = self.radial / math.sqrt(2)
        return self.centre[0] - self.out * reach, self.centre[1] - self.side * reach

    @property
    def span(self) -> tuple[float, float]:
        """First and last y, m."""
        ends = (self.y, self.on_cylinder[1])
        return min(ends), max(ends)

    def points(self, count: int = 9) -> list[tuple[float, float]]:
        """(r, y) along the outline from the face to the cylinder, m."""
        if self.centre is None:
            return [self.on_face, self.on_cylinder]
        # from the face (straight along the axis from the centre) to the cylinder (straight across)
        turns = [math.pi / 2 * k / (count - 1) for k in range(count)]
        (r, y), f = self.centre, self.radial
        found = [(r - self.out * f * math.sin(t), y - self.side * f * math.cos(t)) for t in turns]
        return [self.on_face, *found[1:-1], self.on_cylinder]


class _Blend(Model):
    """What fillets and chamfers have in common."""

    name: str
    y: Position
    surface: Surface = "outer"
    edge: Edge | None = None

    @property
    def what(self) -> str:
        """Its kind in words."""
        return getattr(self, "kind")  # noqa: B009  # of every subclass

    @property
    def extents(self) -> tuple[float, float]:
        """Along the shaft and across, m."""
        raise NotImplementedError

    @property
    def size_key(self) -> str:
        """The field that gives its size."""
        raise NotImplementedError

    def corner(self, segments: Sequence[Segment]) -> Corner:
        """Its edge on a shaft.

        Parameters
        ----------
        segments : sequence of Segment

        Raises
        ------
        SceneError
            Where there is no such edge, or it cannot be rounded; the path is that of a field.
        """
        outer = self.surface == "outer"
        i, low, high = self._place(segments)
        before, after = (
            _radius(s, self.surface, end) if s else None for s, end in ((low, "1"), (high, "0"))
        )
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
                what = "outer radius" if outer else "bore"
                raise SceneError(
                    f"the {what} does not jump at y = {self.y:.6g} m; a {self.what} sits at a step "
                    "or at the edge of an end face",
                    path=("y",),
                )
            edge = edge or "root"
            # the root is on the surface that lies deeper in the material, the rim on the other
            deeper_first = (before < after) == outer
            owner = i - 1 if deeper_first == (edge == "root") else i
        here = segments[owner]
        radius = _radius(here, self.surface, "0" if owner == i else "1")
        if not radius:
            raise SceneError(f'"{here.name}" has no bore there', path=("surface",))
        if _radius(here, self.surface, "0") != _radius(here, self.surface, "1"):
            raise SceneError(
                f'"{here.name}" is a cone there; a {self.what} runs into a cylinder',
                path=("y",),
            )
        if edge == "root" and low and high and low.material != high.material:
            raise SceneError(
                f'"{low.name}" and "{high.name}" are of two materials; a {self.what} at their '
                "root would be of neither",
                path=("y",),
            )
        axial, radial = self.extents
        return Corner(
            self.name,
            self.what,
            here.y0 if owner == i else here.y1,
            radius,
            self.surface,
            edge == "root",
            owner,
            1 if owner == i else -1,
            1 if (edge == "root") == outer else -1,
            axial,
            radial,
        )

    def _place(self, segments):
        """Number of the segment that begins at the edge, and the segments on its two sides."""
        ends = [0.0, *(s.y1 for s in segments)]
        near = [k for k, y in enumerate(ends) if abs(y - self.y) <= TOUCH]
        if not near:
            raise SceneError(
                f"no segment begins or ends at y = {self.y:.6g} m; a {self.what} sits at a step "
                'or at the edge of an end face, such as "<segment>.end"',
                path=("y",),
            )
        k = near[0]
        low = segments[k - 1] if k else None
        return k, low, segments[k] if k < len(segments) else None


class Fillet(_Blend):
    """A quarter of a circle at an edge.

    Attributes
    ----------
    name : str
    y : float
        Place of the edge, m: a step, or an end face.
    surface : {'outer', 'bore'}
    edge : {'root', 'rim'} or None
        Root adds material in the corner of a step, rim rounds off its edge; by default the root,
        and the rim at an end face.
    radius : float
        m.

    Raises
    ------
    SceneError
        A radius that is not positive.

    Examples
    --------
    >>> from solidgear.scene import Fillet
    >>> Fillet(name="head fillet", y="68 mm", radius="4 mm").extents
    (0.004, 0.004)
    """

    kind: Literal["fillet"] = "fillet"
    radius: PositiveLength

    @property
    def extents(self) -> tuple[float, float]:
        return self.radius, self.radius

    @property
    def size_key(self) -> str:
        return "radius"


def slope(value: Any) -> float:
    """Angle of a chamfer to the axis, rad."""
    angle = quantity(value, "angle")
    if not math.radians(5) <= angle <= math.radians(85):
        raise SceneError("the angle of a chamfer to the axis lies between 5 and 85 deg")
    return angle


class Chamfer(_Blend):
    """A straight cut across an edge.

    Attributes
    ----------
    name, y, surface, edge
        As for :class:`Fillet`; a chamfer at a root fills the corner.
    length : float
        Along the shaft, m.
    angle : float
        To the axis, rad; 45 degrees by default.

    Raises
    ------
    SceneError
        A length that is not positive, or an angle outside 5 to 85 degrees.

    Examples
    --------
    >>> from solidgear.scene import Chamfer
    >>> [round(x, 6) for x in Chamfer(name="end", y=0.2, length="2 mm", angle="30 deg").extents]
    [0.002, 0.001155]
    """

    kind: Literal["chamfer"] = "chamfer"
    length: PositiveLength
    angle: Annotated[float, BeforeValidator(slope)] = math.pi / 4

    @property
    def extents(self) -> tuple[float, float]:
        tangent = 1.0 if self.angle == math.pi / 4 else math.tan(self.angle)
        return self.length, self.length * tangent

    @property
    def size_key(self) -> str:
        return "length"


#: either of them
Blend: TypeAlias = Fillet | Chamfer


def corners_of_blends(segments: Sequence[Segment], blends: Sequence[Blend]) -> tuple[Corner, ...]:
    """Edges with their fillets and chamfers; see :meth:`Fillet.corner`."""
    return tuple(blend.corner(segments) for blend in blends)


def _radius(segment: Segment, surface: Surface, end: str) -> float:
    return getattr(segment, ("outer" if surface == "outer" else "inner") + end)


def blend_problems(
    segments: Sequence[Segment],
    blends: Sequence[Blend],
    stations: Sequence[Any] = (),
    features: Sequence[Any] = (),
) -> Iterator[SceneError]:
    """Fillets and chamfers that do not fit their shaft.

    Parameters
    ----------
    segments : sequence of Segment
    blends : sequence of Fillet or Chamfer
    stations : sequence
        What sits on the shaft: name, y, lo and hi each.
    features : sequence of Keyway, Flat or CrossHole

    Yields
    ------
    SceneError
        One for each problem, with the path of a scene.
    """
    if len(blends) > MOST_BLENDS:
        reason = (
            f"{len(blends)} fillets and chamfers are more than the {MOST_BLENDS} a shaft may have"
        )
        yield SceneError(reason, path=("blends",))
        return
    names = {f.name for f in features}
    before: list[tuple[Blend, Corner]] = []
    for i, blend in enumerate(blends):
        if blend.name in names:
            yield SceneError(
                "another feature has this name; each needs its own", path=("blends", i, "name")
            )
        names.add(blend.name)
        try:
            corner = blend.corner(segments)
        except SceneError as error:
            yield error.located(None, path=("blends", i, *error.path))
            continue
        key, reason = _misfit(blend, corner, segments, before, stations, features)
        if reason:
            yield SceneError(reason, path=("blends", i, key))
        before.append((blend, corner))


def _misfit(blend, corner, segments, before, stations, features) -> tuple[str, str]:
    """Field and reason of the first thing that is wrong with a fillet or chamfer, or two empty
    texts.
    """
    here, what, key = segments[corner.owner], blend.what, blend.size_key
    for other, at in before:
        if (at.y, at.r, at.surface) == (corner.y, corner.r, corner.surface):
            return "y", f'this edge has "{other.name}" already'
    if min(corner.axial, corner.radial) < SMALLEST * corner.r:
        return key, (
            f"a {what} under {SMALLEST:g} of the radius, {corner.r:.6g} m, is no {what}: "
            "leave it out, or look at the units"
        )
    face = _face_height(corner, segments)
    if corner.radial > face + TOUCH:
        return key, f"a {what} of {corner.radial:.6g} m does not fit the face of {face:.6g} m"
    same_face = [at for _, at in before if at.y == corner.y and _same_face(at, corner, segments)]
    if corner.radial + sum(at.radial for at in same_face) > MOST_OF_FACE * face:
        beside = f' beside "{same_face[0].name}"' if same_face else ""
        return key, (
            f"a {what} of {corner.radial:.6g} m{beside} leaves less than a twentieth of the face "
            f"of {face:.6g} m"
        )
    if corner.axial > here.length / 2 + TOUCH:
        return key, (
            f'a {what} reaches {corner.axial:.6g} m along "{here.name}", beyond half its length of '
            f"{here.length:.6g} m"
        )
    for other, at in before:
        if (at.owner, at.surface) == (corner.owner, corner.surface) and (
            at.axial + corner.axial > MOST_OF_LENGTH * here.length
        ):
            return key, (
                f'with "{other.name}" at its other end nothing is left of the cylinder '
                f'"{here.name}", {here.length:.6g} m long'
            )
    lo, hi = corner.span
    reach = f"the {what} reaches from {lo:.6g} to {hi:.6g} m"
    for s in stations:
        if corner.surface == "outer" and min(s.hi, hi) - max(s.lo, lo) > TOUCH:
            return key, (
                f'{reach}, into the seat of "{s.name}" ({s.lo:.6g} to {s.hi:.6g} m), which must '
                "stay a cylinder"
            )
        # the face itself is plane at the end of a shaft
        at_end = abs(s.y - corner.y) <= TOUCH and corner.y in (0.0, segments[-1].y1)
        if lo - TOUCH <= s.y <= hi + TOUCH and not at_end:
            return key, (
                f'{reach}, and "{s.name}" is at {s.y:.6g} m; put the one or the other elsewhere, '
                "since no section there is plane"
            )
    for f in features:
        if f.reach[0] < hi - TOUCH and lo + TOUCH < f.reach[1]:
            return key, f'{reach}, into the {f.what} "{f.name}"'
    return "", ""


def _face_height(corner: Corner, segments: Sequence[Segment]) -> float:
    """Of the plane face beside an edge, m."""
    here = segments[corner.owner]
    k = corner.owner + (0 if corner.side > 0 else 1)  # the joint
    if k in (0, len(segments)):
        return here.outer0 - here.inner0 if k == 0 else here.outer1 - here.inner1
    low, high = segments[k - 1], segments[k]
    return abs(_radius(low, corner.surface, "1") - _radius(high, corner.surface, "0"))


def _same_face(a: Corner, b: Corner, segments: Sequence[Segment]) -> bool:
    at_end = a.y <= TOUCH or a.y >= segments[-1].y1 - TOUCH
    return at_end or a.surface == b.surface
