"""Holes along the axis, on a circle."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import ClassVar, Literal

from solidgear.core import TOUCH, PositiveLength, SceneError
from solidgear.core.scene.feature import SMALLEST, Count, OnSegment
from solidgear.core.scene.parts import Segment


class BoltCircle(OnSegment):
    """Holes along the axis, evenly spaced on a circle; the angle is that of the first hole."""

    sort: ClassVar[str] = "cyclic"

    kind: Literal["bolt_circle"] = "bolt_circle"
    #: number of holes
    count: Count
    #: diameter of a hole, m
    diameter: PositiveLength
    #: diameter of the circle of their middles, m
    circle: PositiveLength
    #: depth of the holes, m; without one they go through the whole segment
    depth: PositiveLength | None = None
    #: face of the segment that they are drilled from
    side: Literal["start", "end"] = "start"

    def _fits(self, segment: Segment, segments: Sequence[Segment]) -> Iterator[SceneError]:
        middle, radius = self.circle / 2, self.diameter / 2
        least = SMALLEST * segment.outer0
        outer, inner = min(segment.outer0, segment.outer1), max(segment.inner0, segment.inner1)
        if radius < least:
            yield SceneError(
                f"is under a hundredth of the diameter, {2 * segment.outer0:.6g} m",
                path=("diameter",),
            )
        elif middle + radius > outer - least:
            yield SceneError(
                f'the holes reach {middle + radius:.6g} m from the axis, out of "{segment.name}" of '
                f"radius {outer:.6g} m",
                path=("circle",),
            )
        elif middle - radius < inner + least:
            obstacle = "its bore" if inner else "the axis"
            yield SceneError(f"the holes reach into {obstacle}", path=("circle",))
        elif self.diameter > 2 * middle * math.sin(math.pi / self.count) - least:
            yield SceneError(
                f"{self.count} holes of this size run into each other", path=("diameter",)
            )
        elif self.depth is not None and self.depth > segment.length + TOUCH:
            yield SceneError(
                f'deeper than "{segment.name}" is long, {segment.length:.6g} m', path=("depth",)
            )
        else:
            yield from self._open(segment, segments)

    def _open(self, segment: Segment, segments: Sequence[Segment]) -> Iterator[SceneError]:
        """Yield a problem where the face that holes are drilled from is covered."""
        index = segments.index(segment) + (-1 if self.side == "start" else 1)
        if not 0 <= index < len(segments):
            return
        neighbour = segments[index]
        outer, inner = (
            (neighbour.outer1, neighbour.inner1)
            if self.side == "start"
            else (neighbour.outer0, neighbour.inner0)
        )
        middle, radius = self.circle / 2, self.diameter / 2
        if middle - radius < outer and middle + radius > inner:
            yield SceneError(
                f'"{neighbour.name}", of radius {outer:.6g} m, covers the holes at the {self.side} of '
                f'"{segment.name}"; drill from the other side, or outside it',
                path=("side",),
            )

    def reach(self, segment: Segment) -> tuple[float, float]:
        """Return the ends of the holes along the shaft, m, in their segment."""
        if self.depth is None:
            return segment.y0, segment.y1
        if self.side == "start":
            return segment.y0, segment.y0 + self.depth
        return segment.y1 - self.depth, segment.y1
