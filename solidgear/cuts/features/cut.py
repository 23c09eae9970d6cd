"""Base of every cut into a cylinder: a place along the shaft, and the wall that must remain."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

from solidgear.core import TOUCH, Model, PositiveLength, SceneError
from solidgear.core.scene.feature import SMALLEST, OnSegment
from solidgear.core.scene.parts import Segment
from solidgear.core.scene.places import Along, Places
from solidgear.core.scene.units import Position


class Frame(NamedTuple):
    """Frame of a cut at some angle, for formulas of element size."""

    #: side, up: formulas of the distance from the middle plane, with sign, and of the height, m
    side: str
    up: str
    num: Callable[[float], str]  #: a number in a formula

    @property
    def across(self) -> str:
        """Formula of the distance from the middle plane."""
        return f"Sqrt({self.side}^2)"

    def outside(self, lo: float, hi: float) -> str:
        """Return the formula of the distance along the shaft from a stretch of it."""
        return f"Max(0,Max({self.num(lo)}-y,y-{self.num(hi)}))"


class Cut(OnSegment):
    """A feature cut into a cylinder at a place along the shaft."""

    Words: ClassVar[type[Model]] = Along
    sources: ClassVar = {"y": ("position",)}
    _aliases: ClassVar = {}  # a position counts from the start of the segment
    sort: ClassVar[str] = "cut"

    y: Position

    @classmethod
    def place(cls, words: Any, table: Mapping[str, Any], places: Places) -> dict[str, Any]:
        # along the segment, unless another datum is given
        y = words.y(places, f"{table.get('segment')}.start")
        # refused as such
        unknown_segment = words.from_ is None and places.names is not None
        if y is None and unknown_segment:
            y = words.position or 0.0
        return {"y": y}

    def _fits(self, segment: Segment, segments: Sequence[Segment]) -> Iterator[SceneError]:
        if segment.outer0 != segment.outer1:
            yield SceneError(
                f'"{segment.name}" is a cone; a {self.what} is cut into a cylinder',
                path=("segment",),
            )
            return
        if segment.inner0 != segment.inner1:
            yield SceneError(
                f'the bore of "{segment.name}" is a cone; a {self.what} is cut into an even wall',
                path=("segment",),
            )
            return
        lo, hi = self.reach(segment.outer0)
        if lo < segment.y0 - TOUCH or hi > segment.y1 + TOUCH:
            yield SceneError(
                f"the {self.what} reaches from {lo:.6g} to {hi:.6g} m, outside "
                f'"{segment.name}" ({segment.y0:.6g} to {segment.y1:.6g} m)',
                path=("length" if hasattr(self, "length") else "y",),
            )
            return
        yield from self._sized(segment)

    def _sized(self, segment: Segment) -> Iterator[SceneError]:
        raise NotImplementedError

    def reach(self, radius: float) -> tuple[float, float]:
        """Return the ends along a shaft of some radius, m."""
        raise NotImplementedError

    def span(self, segments: Sequence[Segment]) -> tuple[float, float]:
        segment = next(s for s in segments if s.name == self.segment)
        return self.reach(segment.outer0)

    def mirrored(self, across: bool) -> bool:
        """Return True where the cut is symmetric about the plane through the axis at its angle or,
        `across`, about the plane at right angles to that.
        """
        return not across

    def tool(self, occ: Any, radius: float, top: float) -> int:
        """Draw the solid of OCC that is cut out of a segment of a radius, at the angle 0, and return
        its tag; it reaches out of the shaft by `top` (m).
        """
        raise NotImplementedError

    def volume(self, outer: float, inner: float) -> float | None:
        """Return the volume cut from a segment of these radii, m^3; None for a cut down to a bore,
        without a closed form.

        Examples
        --------
        A flat down to nearly the axis is nearly half of the cylinder:

        >>> from math import pi
        >>> from solidgear.cuts.features import Flat
        >>> deep = Flat(name="flat", segment="rod", y=0.0, length=1.0, depth=0.1 - 1e-9)
        >>> round(deep.volume(0.1, 0.0) / (pi * 0.1**2), 6)
        0.5
        """
        raise NotImplementedError

    def centre(self, outer: float, inner: float) -> tuple[float, float]:
        """Return the centre of the volume cut from a segment of these radii, m: its distance from the
        middle plane and its height over the axis; along the shaft it is in the middle.
        """
        raise NotImplementedError

    def edges(self, radius: float) -> tuple[float, float]:
        """Return the largest element edges that resolve straight and curved parts of the cut, m."""
        raise NotImplementedError

    def distance(self, radius: float, frame: Frame) -> str:
        """Return the formula of the distance from the cut, m."""
        raise NotImplementedError

    def from_edges(self, radius: float, frame: Frame) -> tuple[str, float] | None:
        """Return the formula of the distance from re-entrant edges, and the least size beside them, m;
        None without such edges.
        """
        return None

    def lines(self, radius: float) -> tuple[float, float]:
        """Return the length of lines that elements grow from, and the radius of their wall, m."""
        lo, hi = self.reach(radius)
        return 2 * (hi - lo), 0.0


class Long(Cut):
    """A cut that begins at a place and runs along the shaft, down to a plane floor."""

    if TYPE_CHECKING:
        depth: float  # a field of every subclass, in its own order

    #: length along the shaft, round ends included, m
    length: PositiveLength

    def reach(self, radius: float) -> tuple[float, float]:
        return self.y, self.y + self.length

    def floor(self, radius: float) -> float:
        """Return the height of the floor over the axis, m."""
        return radius - self.depth

    def half_width(self, radius: float) -> float:
        """Return half the width of the floor, m."""
        raise NotImplementedError

    def along(self, side: float, radius: float) -> float:
        """Return the length of the floor at a distance from the middle plane, m."""
        return self.length

    def _moment(self, outer: float, power: int) -> float:
        """Return the integral of a power of the height over the volume of the cut."""
        from scipy.integrate import quad  # slow to import, and seldom needed

        floor, half = self.floor(outer), self.half_width(outer)

        def section(x: float) -> float:
            crown = math.sqrt(outer**2 - x * x)
            height = (crown ** (power + 1) - floor ** (power + 1)) / (power + 1)
            return height * self.along(x, outer)

        return 2 * quad(section, 0, half, epsabs=0, epsrel=1e-12)[0]

    def volume(self, outer: float, inner: float) -> float | None:
        return None if self.floor(outer) < inner else self._moment(outer, 0)

    def centre(self, outer: float, inner: float) -> tuple[float, float]:
        return 0.0, self._moment(outer, 1) / self._moment(outer, 0)

    @property
    def rounded(self) -> bool:
        """True where the ends are half circles."""
        return False

    def distance(self, radius: float, frame: Frame) -> str:
        below = f"Max(0,{frame.num(self.floor(radius))}-{frame.up})"
        side = f"Max(0,{frame.across}-{frame.num(self.half_width(radius))})"
        return f"Sqrt({below}^2+{side}^2+{frame.outside(*self.reach(radius))}^2)"

    def from_edges(self, radius: float, frame: Frame) -> tuple[str, float]:
        away, floor = self.beside_edges(radius, frame), self.floor(radius)
        least = min(self.depth, self.half_width(radius))
        return f"Sqrt({away}^2+({frame.up}-{frame.num(floor)})^2)", least

    def beside_edges(self, radius: float, frame: Frame) -> str:
        """Return the formula of the distance from re-entrant edges as seen from above, m."""
        raise NotImplementedError

    def _deep(self, segment: Segment) -> Iterator[SceneError]:
        """Yield a problem of a depth that leaves no wall, or is too small to matter."""
        wall = segment.outer0 - segment.inner0
        if self.depth >= wall - TOUCH:
            extent = "the wall" if segment.inner0 else "the radius"
            yield SceneError(
                f"a {self.what} as deep as this cuts through {extent} of {wall:.6g} m",
                path=("depth",),
            )
        elif self.depth < SMALLEST * segment.outer0:
            yield SceneError(
                f"a {self.what} under a hundredth of the radius, {segment.outer0:.6g} m, is too "
                "small: leave it out, or check the units",
                path=("depth",),
            )
