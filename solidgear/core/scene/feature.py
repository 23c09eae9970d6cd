"""Base of every feature of a shaft: a name, a segment and a direction."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from pydantic import BeforeValidator, Field

from solidgear.core.errors import SceneError, nearest
from solidgear.core.scene.parts import Segment
from solidgear.core.scene.places import NoWords, Placed
from solidgear.core.scene.typed import Model
from solidgear.core.scene.units import SignedAngle, quantity
from solidgear.core.scene.written import Range, Written

#: least size of a feature over the radius of the shaft; smaller ones would need endless meshes
SMALLEST = 1e-2

#: a sector of less than a third of a turn is what cyclic symmetry needs
FEWEST = 3
MOST_TEETH = 400
Count = Annotated[int, Field(strict=True, ge=FEWEST, le=MOST_TEETH)]


#: of a plain number
TURN = Range("", least=-2 * math.pi * (1 + 1e-9), most=2 * math.pi * (1 + 1e-9))


def _turn(value: Any) -> float:
    """Return an angle within one turn, rad; refuse a plain number beyond it, meant in degrees."""
    angle = quantity(value, "angle")
    if not isinstance(value, str) and abs(angle) > TURN.most:
        raise SceneError(
            f"is more than a turn of 2 pi: a plain number is in rad; for degrees write "
            f'"{angle:.6g} deg"'
        )
    return angle % (2 * math.pi)


Turn = Annotated[float, BeforeValidator(_turn), Written(Annotated[SignedAngle, TURN])]


class OnSegment(Placed):
    """A feature of one segment at an angle around the axis: 0 is +z, a quarter turn is +x."""

    Words: ClassVar[type[Model]] = NoWords
    sources: ClassVar = {}
    #: cut, at one place of a segment, or cyclic, repeating itself around the axis
    sort: ClassVar[str]
    #: whether it has right-angled re-entrant corners where the meridian has none: teeth end at the
    #: next segment or in its face, holes and keyways have a bottom
    notched: ClassVar[bool] = True
    #: whether it is teeth all around its segment
    toothed: ClassVar[bool] = False

    if TYPE_CHECKING:
        kind: str  # a field of every subclass, in its own order

    #: name in reports; by default its kind and number
    name: str
    #: name of the segment
    segment: str
    #: angle around the shaft, rad: 0 is +z, a quarter turn is +x
    angle: Turn = 0.0

    def problems(self, segments: Sequence[Segment]) -> Iterator[SceneError]:
        """Yield reasons why the feature does not fit the shaft, with paths of its fields."""
        segment = next((s for s in segments if s.name == self.segment), None)
        if segment is None:
            names = [s.name for s in segments]
            yield SceneError(
                f"unknown segment{nearest(self.segment, names)}; there are {', '.join(names)}",
                path=("segment",),
            )
            return
        yield from self._fits(segment, segments)

    def _fits(self, segment: Segment, segments: Sequence[Segment]) -> Iterator[SceneError]:
        raise NotImplementedError

    @property
    def what(self) -> str:
        """Kind in words."""
        return self.kind.replace("_", " ")

    def span(self, segments: Sequence[Segment]) -> tuple[float, float]:
        """Return the ends along a shaft that the feature fits, m."""
        segment = next(s for s in segments if s.name == self.segment)
        return segment.y0, segment.y1

    @property
    def smeared(self) -> bool:
        """True where the segment of revolution replaces the feature."""
        return False

    @property
    def round(self) -> bool:
        """True where the shaft stays a body of revolution."""
        return False
