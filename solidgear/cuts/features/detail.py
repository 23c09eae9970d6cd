"""Base of what a drawing has on a cylinder and models leave out: ratings of strength read it.

Grooves, undercuts, threads and the hubs of press fits change stiffness and mass by next to nothing,
and stress by a lot. Another one is a class of ``Detail`` with its ``kind``, rules (``_sized``) and
``reach``; its rating is a line in :mod:`solidgear.strength.stress.notches`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import ClassVar

from solidgear.core import TOUCH, PositiveLength, SceneError
from solidgear.core.scene.parts import Segment
from solidgear.cuts.features.cut import Cut

#: sort of features that no model holds
DETAIL = "detail"


class Detail(Cut):
    """A detail of a cylinder that ratings of strength read, and no model."""

    sort: ClassVar[str] = DETAIL
    notched: ClassVar[bool] = False

    @property
    def smeared(self) -> bool:
        return True

    @property
    def round(self) -> bool:
        return True


class Stretch(Detail):
    """A detail that begins at a place and runs along its segment, to its end without a length."""

    #: length along the shaft, m; to the end of the segment where none is given
    length: PositiveLength | None = None

    def reach(self, radius: float) -> tuple[float, float]:
        return self.y, self.y + (self.length or 0.0)

    def span(self, segments: Sequence[Segment]) -> tuple[float, float]:
        segment = next(s for s in segments if s.name == self.segment)
        return self.y, segment.y1 if self.length is None else self.y + self.length

    def _sized(self, segment: Segment) -> Iterator[SceneError]:
        if self.length is None and self.y > segment.y1 - TOUCH:
            yield SceneError(
                f'begins where "{segment.name}" ends, at {segment.y1:.6g} m', path=("y",)
            )
            return
        yield from self._fitted(segment)

    def _fitted(self, segment: Segment) -> Iterator[SceneError]:
        """Yield problems of its sizes on a segment that it lies on."""
        raise NotImplementedError


def floor_problems(
    what: str, segment: Segment, depth: float | None, diameter: float | None
) -> Iterator[SceneError]:
    """Yield problems of the floor of a groove, m, of which a depth or a diameter gives one."""
    outer, inner = segment.outer0, segment.inner0
    if (depth is None) == (diameter is None):
        yield SceneError(
            f"give either the depth of the {what} or the diameter of its floor",
            path=("depth",),
        )
    elif diameter is not None and not 2 * inner < diameter < 2 * outer:
        above = f"above the bore, {2 * inner:.6g} m, and " if inner else ""
        yield SceneError(
            f'the floor of a {what} lies {above}below the surface of "{segment.name}", of diameter '
            f"{2 * outer:.6g} m",
            path=("diameter",),
        )
    elif depth is not None and depth >= outer - inner - TOUCH:
        extent = "the wall" if inner else "the radius"
        yield SceneError(
            f'a {what} as deep as this cuts through {extent} of "{segment.name}", '
            f"{outer - inner:.6g} m",
            path=("depth",),
        )
