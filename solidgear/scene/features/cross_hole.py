"""A hole across the shaft."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, ClassVar, Literal

from solidgear.errors import SceneError
from solidgear.scene.features.base import SMALLEST
from solidgear.scene.features.cut import Cut, Frame
from solidgear.scene.parts import Segment
from solidgear.scene.units import PositiveLength


class CrossHole(Cut):
    """A hole drilled through the axis.

    Attributes
    ----------
    name, segment : str
    y : float
        Of its middle along the shaft, m.
    diameter : float
        m.
    angle : float
        As for :class:`Keyway`; the hole goes all the way through.

    Raises
    ------
    SceneError
        A size that is not positive.

    Examples
    --------
    >>> from solidgear.scene import CrossHole
    >>> hole = CrossHole(name="oil", segment="shaft", y="50 mm", diameter="8 mm")
    >>> [round(y, 3) for y in hole.reach]
    [0.046, 0.054]
    """

    notched: ClassVar[bool] = False
    through: ClassVar[bool] = True

    kind: Literal["cross_hole"] = "cross_hole"
    diameter: PositiveLength

    @property
    def reach(self) -> tuple[float, float]:
        return self.y - self.diameter / 2, self.y + self.diameter / 2

    def _sized(self, here: Segment) -> Iterator[SceneError]:
        if self.diameter >= here.outer0:
            yield SceneError(
                f"a cross hole wider than the radius, {here.outer0:.6g} m, leaves no shaft",
                path=("diameter",),
            )
        elif self.diameter < 2 * SMALLEST * here.outer0:
            yield SceneError(
                f"is under a hundredth of the diameter, {2 * here.outer0:.6g} m", path=("diameter",)
            )

    def tool(self, occ: Any, radius: float, top: float) -> int:
        far = radius + top
        return occ.addCylinder(0, self.y, -far, 0, 0, 2 * far, self.diameter / 2)

    def volume(self, outer: float, inner: float) -> None:
        return None

    def edges(self, radius: float) -> tuple[float, float]:
        # a circle of fewer than eight edges is no hole: it loses a fifteenth of its volume
        return math.inf, math.pi * self.diameter / 8

    def distance(self, radius: float, frame: Frame) -> str:
        off = f"Sqrt({frame.across}^2+(y-{frame.num(self.y)})^2)"
        return f"Max(0,{off}-{frame.num(self.diameter / 2)})"
