"""Edges of a shaft that a fillet or chamfer rounds, as corners of the meridian (r, y)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

Surface = Literal["outer", "bore"]
SURFACES: tuple[Surface, Surface] = ("outer", "bore")


@dataclass(frozen=True)
class Corner:
    """An edge of a shaft with a fillet or chamfer, in plain floats."""

    #: name, kind: kind is fillet or chamfer
    name: str
    kind: str
    #: y, r: of the sharp edge, m
    y: float
    r: float
    surface: Surface
    root: bool  #: material is added; at a rim it is taken away
    owner: int  #: segment whose cylinder the outline runs into
    side: int  #: +1 if that segment lies at larger y than the edge, -1 otherwise
    out: int  #: +1 if the plane face beside the edge lies at larger radius, -1 otherwise
    #: axial, radial: extent along the shaft and across it, m
    axial: float
    radial: float

    @property
    def joint(self) -> int:
        """Segment that begins at the edge, or would behind the last one."""
        return self.owner if self.side > 0 else self.owner + 1

    @property
    def face_side(self) -> int:
        """Side of the joint on which the segment lies whose plane face the outline leaves."""
        return -self.side if self.root else self.side

    @property
    def face_owner(self) -> int:
        """Segment whose plane face the outline leaves."""
        return self.joint if self.face_side > 0 else self.joint - 1

    @property
    def on_face(self) -> tuple[float, float]:
        """(r, y) where the outline leaves the plane face, m."""
        return self.r + self.out * self.radial, self.y

    @property
    def on_cylinder(self) -> tuple[float, float]:
        """(r, y) where the outline meets the cylinder, m."""
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

    def point_at(self, share: float) -> tuple[float, float]:
        """Return (r, y) at a share of the outline from the face to the cylinder, m."""
        if self.centre is None:
            (a, b), (c, d) = self.on_face, self.on_cylinder
            return a + share * (c - a), b + share * (d - b)
        # from the face (straight along the axis from the centre) to the cylinder (straight across)
        turn = math.pi / 2 * share
        (r, y), f = self.centre, self.radial
        return r - self.out * f * math.sin(turn), y - self.side * f * math.cos(turn)

    def points(self, count: int = 9) -> list[tuple[float, float]]:
        """Return (r, y) along the outline from the face to the cylinder, m."""
        if self.centre is None:
            return [self.on_face, self.on_cylinder]
        between = [self.point_at(k / (count - 1)) for k in range(1, count - 1)]
        return [self.on_face, *between, self.on_cylinder]
