"""What every feature of a shaft has: a name, a segment and a direction; and what every cut has."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Annotated, Any

from pydantic import BeforeValidator

from solidgear.errors import SceneError, nearest
from solidgear.scene.parts import Model, Segment
from solidgear.scene.rules import TOUCH
from solidgear.scene.units import Position, quantity

#: least size of a feature over the radius of the shaft; smaller ones ask for meshes without end
SMALLEST = 1e-2


def _turn(value: Any) -> float:
    """An angle within one turn, rad; a plain number beyond it was meant in degrees."""
    angle = quantity(value, "angle")
    if not isinstance(value, str) and abs(angle) > 2 * math.pi * (1 + 1e-9):
        raise SceneError(
            f"is more than a turn of 2 pi: a plain number is in rad; for degrees write "
            f'"{angle:.6g} deg"'
        )
    return angle % (2 * math.pi)


Turn = Annotated[float, BeforeValidator(_turn)]


class OnSegment(Model):
    """A feature of one segment, that looks to an angle: 0 is +z, a quarter turn is +x."""

    name: str
    segment: str
    angle: Turn = 0.0

    def problems(self, segments: Sequence[Segment]) -> Iterator[SceneError]:
        """Why it does not fit the shaft; paths are those of its own fields."""
        here = next((s for s in segments if s.name == self.segment), None)
        if here is None:
            known = [s.name for s in segments]
            yield SceneError(
                f"unknown segment{nearest(self.segment, known)}; there are {', '.join(known)}",
                path=("segment",),
            )
            return
        yield from self._fits(here, segments)

    def _fits(self, here: Segment, segments: Sequence[Segment]) -> Iterator[SceneError]:
        raise NotImplementedError

    @property
    def what(self) -> str:
        """Its kind in words."""
        return getattr(self, "kind").replace("_", " ")  # noqa: B009  # of every subclass

    def span(self, segments: Sequence[Segment]) -> tuple[float, float]:
        """Its ends along a shaft that it fits, m."""
        here = next(s for s in segments if s.name == self.segment)
        return here.y0, here.y1

    @property
    def smeared(self) -> bool:
        """Whether the segment of revolution stands for it."""
        return False

    @property
    def round(self) -> bool:
        """Whether it leaves the shaft one of revolution."""
        return False


class Cut(OnSegment):
    """A feature cut into a cylinder at a place along the shaft."""

    y: Position

    def _fits(self, here: Segment, segments: Sequence[Segment]) -> Iterator[SceneError]:
        if here.outer0 != here.outer1:
            yield SceneError(
                f'"{here.name}" is a cone; a {self.what} is cut into a cylinder', path=("segment",)
            )
            return
        if here.inner0 != here.inner1:
            yield SceneError(
                f'the bore of "{here.name}" is a cone; a {self.what} is cut into an even wall',
                path=("segment",),
            )
            return
        lo, hi = self.reach
        if lo < here.y0 - TOUCH or hi > here.y1 + TOUCH:
            yield SceneError(
                f"the {self.what} reaches from {lo:.6g} to {hi:.6g} m, outside "
                f'"{here.name}" ({here.y0:.6g} to {here.y1:.6g} m)',
                path=("length" if hasattr(self, "length") else "y",),
            )
            return
        yield from self._sized(here)

    def _sized(self, here: Segment) -> Iterator[SceneError]:
        raise NotImplementedError

    @property
    def reach(self) -> tuple[float, float]:
        """Ends along the shaft, m."""
        raise NotImplementedError

    def span(self, segments: Sequence[Segment]) -> tuple[float, float]:
        return self.reach


def deep(depth: float, here: Segment, what: str, least: float = 0.0) -> Iterator[SceneError]:
    """A cut leaves some wall over the bore, and over the axis of a solid shaft."""
    wall = here.outer0 - max(here.inner0, least)
    if depth >= wall - TOUCH:
        over = "the wall" if here.inner0 else "the radius"
        yield SceneError(
            f"a {what} as deep as this cuts through {over} of {wall:.6g} m", path=("depth",)
        )
    elif depth < SMALLEST * here.outer0:
        yield SceneError(
            f"a {what} under a hundredth of the radius, {here.outer0:.6g} m, is no feature: "
            "leave it out, or look at the units",
            path=("depth",),
        )
