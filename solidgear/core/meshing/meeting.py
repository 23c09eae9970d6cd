"""What meets at a point of the surface of a shaft: wedges of materials, and which outer face is held."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import atan2, cos, pi
from typing import TYPE_CHECKING, NamedTuple

from solidgear.core.meshing.wedge import SAME_ANGLE, Wedge, wedge_exponent
from solidgear.core.safety import RESOLVED
from solidgear.core.scene.shaft import on_face

if TYPE_CHECKING:
    from solidgear.core.scene.parts import Material, Segment
    from solidgear.core.scene.shaft import Station

#: share of the length of a shaft within which points are one
SAME = 1e-9


def least_side(length: float) -> float:
    """Return the least side of a cell of a shaft, m, whose ends are still two points."""
    return RESOLVED * SAME * length


@dataclass(frozen=True)
class Meeting:
    """Wedges side by side around a point, the two outer faces of which are no material's."""

    wedges: tuple[Wedge, ...]
    held: tuple[bool, bool]  #: whether the outer face of the first and of the last is held

    @property
    def angle(self) -> float:
        """Angle of the material, rad."""
        return sum(angle for angle, _ in self.wedges)

    @property
    def joined(self) -> bool:
        """Whether several materials meet."""
        return len(self.wedges) > 1

    @property
    def exponent(self) -> float:
        """Exponent of displacement there, one at most: the less, the sharper."""
        faces = sum(self.held)
        turned = self.held == (False, True)
        return wedge_exponent(self.wedges[::-1] if turned else self.wedges, faces)


def meeting(
    segments: Sequence[Segment], y: float, r: float, rigid: Iterable[Station] = ()
) -> Meeting | None:
    """Return what meets at a point (m) of the surface of segments end to end, with the seats and end
    faces of some stations rigid; None where no surface is.
    """
    tol = SAME * (segments[-1].y1 - segments[0].y0)
    sectors = [s for s in (_sector(segment, y, r, tol) for segment in segments) if s]
    first = next((s for s in sectors if not any(_touch(other, s) for other in sectors)), None)
    if first is None:
        return None  # all around is material
    row = [first]
    while following := next((s for s in sectors if _touch(row[-1], s)), None):
        row.append(following)
    # of the surface that goes on before the first wedge and beyond the last one: along the outer
    # surface, across the axis, or along a bore
    before, after = -cos(row[0].start), cos(row[-1].end)
    seats = list(rigid)
    held = (
        any(_holds(seat, y, y - seat.lo, before, tol) for seat in seats),
        any(_holds(seat, y, seat.hi - y, after, tol) for seat in seats),
    )
    return Meeting(tuple(merged((end - start, material) for start, end, material in row)), held)


def _holds(seat: Station, y: float, reach: float, along: float, tol: float) -> bool:
    """Return whether a seat or an end face holds the surface that goes on from a point at y with a
    direction along the axis, by how far it reaches that way, m.
    """
    if abs(along) <= SAME_ANGLE:
        return on_face(seat) and abs(seat.y - y) <= tol
    return along > 0 and reach > tol and seat.lo - tol <= y <= seat.hi + tol


class _Sector(NamedTuple):
    """Directions into a segment from a point, as angles from the axis to larger radii, rad."""

    start: float
    end: float
    material: Material


def _sector(segment: Segment, y: float, r: float, tol: float) -> _Sector | None:
    """Return the directions into a segment from a point that it holds; None of any other."""
    if not segment.y0 - tol <= y <= segment.y1 + tol:
        return None
    inner, outer = segment.radius_at(min(max(y, segment.y0), segment.y1))
    if not inner - tol <= r <= outer + tol:
        return None
    rise_out = atan2(segment.outer1 - segment.outer0, segment.length)
    rise_in = atan2(segment.inner1 - segment.inner0, segment.length)
    on_outer, on_inner = r > outer - tol, inner > tol and r < inner + tol
    if y < segment.y0 + tol:
        start = rise_in if on_inner else -pi / 2
        end = rise_out if on_outer else pi / 2
    elif y > segment.y1 - tol:
        start = pi + rise_out if on_outer else pi / 2
        end = pi + rise_in if on_inner else 3 * pi / 2
    elif on_outer:
        start, end = pi + rise_out, 2 * pi + rise_out
    elif on_inner:
        start, end = rise_in, pi + rise_in
    else:
        return None
    return _Sector(start, end, segment.material)


def _touch(first: _Sector, second: _Sector) -> bool:
    """Return whether one sector begins where another ends."""
    return abs((second.start - first.end + pi) % (2 * pi) - pi) < SAME_ANGLE


def merged(row: Iterable[Wedge]) -> list[Wedge]:
    """Return wedges side by side, those of one elasticity as one."""
    wedges: list[Wedge] = []
    for angle, material in row:
        if wedges and _elasticity(wedges[-1][1]) == _elasticity(material):
            angle += wedges.pop()[0]
        wedges.append((angle, material))
    return wedges


def _elasticity(material: Material) -> tuple[float, float]:
    return material.E, material.nu
