"""Tables over a mesh cycle: stiffness, mesh point and line of action."""

from __future__ import annotations

from collections.abc import Sequence
from math import dist, hypot, isclose
from typing import Annotated

from pydantic import model_validator

from solidgear.core import Model, SceneError, SignedAngle
from solidgear.core.scene.units import MeshSpring, three

#: least number of places of a mesh cycle, and largest relative difference of its two ends
LEAST_OF_CYCLE, CYCLE_CLOSES = 3, 1e-3
#: difference from unit length of a normal typed with four digits
UNIT = 1e-4
Vector = Annotated[
    tuple[float, float, float], three("length", 'such as ["-55 mm", "0 mm", "0 mm"]')
]


class Cycle(Model):
    """Base of tables over one mesh cycle."""

    #: angles of the pinion, ascending over one tooth pitch with both ends, rad; linear between
    angle: tuple[SignedAngle, ...]

    @property
    def pitch(self) -> float:
        """Angle that the table covers, rad."""
        return self.angle[-1] - self.angle[0]

    def check_values(self, key: str, plural: str, values: Sequence) -> None:
        """Refuse angles that do not ascend, or a different number of values."""
        if len(self.angle) != len(values) or len(self.angle) < LEAST_OF_CYCLE:
            counts = f"{len(values)} {plural} for {len(self.angle)} angles"
            reason = f"there are {counts}; give as many, {LEAST_OF_CYCLE} at least"
            raise SceneError(reason, path=(key,))
        if any(b <= a for a, b in zip(self.angle, self.angle[1:])):
            raise SceneError("angles must ascend", path=("angle",))


class StiffnessCycle(Cycle):
    """Mesh stiffness over one mesh cycle; its mean is the stiffness of the mesh."""

    #: stiffness at each angle, N/m
    stiffness: tuple[MeshSpring, ...]

    @model_validator(mode="after")
    def _periodic(self):
        self.check_values("stiffness", "stiffnesses", self.stiffness)
        first, last = self.stiffness[0], self.stiffness[-1]
        if not isclose(first, last, rel_tol=CYCLE_CLOSES):
            raise SceneError(
                f"is not periodic: it begins at {first:.6g} N/m and ends at {last:.6g} N/m; both are "
                "the same instant of neighbouring teeth",
                path=("stiffness",),
            )
        return self


class LineCycle(Cycle):
    """Mesh point and line of action over a mesh cycle, in the pinion's frame from the lumped point."""

    #: mesh point at each angle, m
    point: tuple[Vector, ...]
    #: unit vectors, the direction of the force on the pinion
    normal: tuple[tuple[float, float, float], ...]

    @model_validator(mode="after")
    def _periodic(self):
        self.check_values("point", "points", self.point)
        self.check_values("normal", "normals", self.normal)
        for number, normal in enumerate(self.normal, start=1):
            if not isclose(hypot(*normal), 1.0, abs_tol=UNIT):
                raise SceneError(
                    f"normal {number} has length {hypot(*normal):.6g}; give unit vectors",
                    path=("normal",),
                )
        size = max(hypot(*point) for point in self.point)
        for key, unit, most in (("point", " m", size), ("normal", "", 1.0)):
            first, last = getattr(self, key)[0], getattr(self, key)[-1]
            if dist(first, last) > CYCLE_CLOSES * most:
                numbers = (", ".join(f"{v:.6g}" for v in end) for end in (first, last))
                ends = "{} and ends at {}".format(*(f"({text}){unit}" for text in numbers))
                raise SceneError(
                    f"is not periodic: it begins at {ends}; both are the same instant of "
                    "neighbouring teeth",
                    path=(key,),
                )
        return self
