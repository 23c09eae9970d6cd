"""Undercuts at shoulders, by the forms E and F of DIN 509."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import ClassVar, Literal

from solidgear.core import TOUCH, PositiveLength, SceneError
from solidgear.core.scene.feature import OnSegment
from solidgear.core.scene.parts import Segment
from solidgear.cuts.features.detail import DETAIL


class Relief(OnSegment):
    """An undercut in a cylinder, beside the shoulder at one of its ends.

    Examples
    --------
    >>> relief = Relief(name="e", segment="seat", radius="0.8 mm", depth="0.3 mm", width="2.5 mm")
    >>> relief.side, relief.form, relief.smeared
    ('end', 'E', True)
    """

    sort: ClassVar[str] = DETAIL
    notched: ClassVar[bool] = False

    kind: Literal["relief"] = "relief"
    #: end of the cylinder at which the shoulder stands
    side: Literal["start", "end"] = "end"
    #: E: into the cylinder alone; F: into the face of the shoulder too
    form: Literal["E", "F"] = "E"
    #: radius of the undercut, m
    radius: PositiveLength
    #: depth below the cylinder, t1 of DIN 509, m
    depth: PositiveLength
    #: width along the cylinder, f of DIN 509, m
    width: PositiveLength

    @property
    def smeared(self) -> bool:
        return True

    @property
    def round(self) -> bool:
        return True

    def span(self, segments: Sequence[Segment]) -> tuple[float, float]:
        segment = next(s for s in segments if s.name == self.segment)
        if self.side == "start":
            return segment.y0, segment.y0 + self.width
        return segment.y1 - self.width, segment.y1

    def shoulder(self, segments: Sequence[Segment]) -> float | None:
        """Return the radius of the shoulder that the undercut stands beside, m; None where the
        cylinder is the larger one, or ends the shaft.
        """
        names = [s.name for s in segments]
        index = names.index(self.segment)
        beside = index + (1 if self.side == "end" else -1)
        if not 0 <= beside < len(segments):
            return None
        outer = segments[beside].outer0 if self.side == "end" else segments[beside].outer1
        return outer if outer > segments[index].outer0 + TOUCH else None

    def _fits(self, segment: Segment, segments: Sequence[Segment]) -> Iterator[SceneError]:
        if segment.outer0 != segment.outer1:
            yield SceneError(
                f'"{segment.name}" is a cone; an undercut is turned into a cylinder',
                path=("segment",),
            )
        elif self.shoulder(segments) is None:
            yield SceneError(
                f'no shoulder stands at the {self.side} of "{segment.name}"; an undercut lies in '
                "the smaller of two cylinders, beside the larger one",
                path=("side",),
            )
        elif self.width > segment.length + TOUCH:
            yield SceneError(
                f'longer than "{segment.name}", {segment.length:.6g} m', path=("width",)
            )
        elif self.depth >= segment.outer0 - max(segment.inner0, segment.inner1) - TOUCH:
            yield SceneError(
                f'as deep as this it cuts through the wall of "{segment.name}"', path=("depth",)
            )
