"""What builders and meshes see of a scene."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from solidgear.scene import Bearing, Corner, PointMass, Port, Segment


class Shaft(Protocol):
    """Segments end to end, and what is attached to them: a `Scene`, or something like it.

    Builders and meshers ask for no more than this.
    """

    @property
    def segments(self) -> tuple[Segment, ...]:
        """Segments from y = 0 on."""

    @property
    def stations(self) -> tuple[Port | Bearing | PointMass, ...]:
        """What is attached, the port first; each has name, y, lo, hi (m) and attachment."""

    @property
    def corners(self) -> tuple[Corner, ...]:
        """Edges with fillets and chamfers."""

    @property
    def length(self) -> float:
        """Overall length, m."""
