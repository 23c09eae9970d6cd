"""Life over a table of duty: damages of the points add up (Palmgren 1924, Miner 1945).

A point with the share q of the time, at n turns an hour and with a life of L turns, uses up
``q n / L`` of the bearing an hour; the life in hours is one over the sum.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from solidgear.bearings.bearing_life import BearingLife
from solidgear.core import SceneError
from solidgear.core.plain import plain
from solidgear.core.scene.units import TYPED


@dataclass(frozen=True)
class DutyPoint:
    """Point of a duty table of one bearing."""

    life: float  #: of the bearing there, revolutions; infinite where it carries nothing
    speed: float  #: rad/s
    share: float | None = None  #: of the time
    hours: float | None = None  #: in place of a share

    @property
    def turns(self) -> float:
        """Revolutions an hour."""
        return abs(self.speed) / (2 * math.pi) * 3600


@dataclass(frozen=True)
class DutyLife:
    """Life over a duty table."""

    hours: float
    revolutions: float
    #: share of the damage that each point does; they sum to one, or are zero where none does any
    damage: tuple[float, ...]
    worst: int  #: place of the point that does most


def duty_life(points: Sequence[DutyPoint]) -> DutyLife:
    """Return the life of a bearing over the points of a duty table, all with shares of the time
    that sum to one, or all with hours; other tables are refused.
    """
    shares = _shares(points)
    rates = [share * point.turns / point.life for share, point in zip(shares, points)]
    total, turns = sum(rates), sum(share * point.turns for share, point in zip(shares, points))
    worst = max(range(len(points)), key=lambda k: rates[k])
    if total == 0:
        return DutyLife(math.inf, math.inf, (0.0,) * len(points), worst)
    damage = tuple(rate / total for rate in rates)
    return DutyLife(1 / total, turns / total, damage, worst)


def _shares(points: Sequence[DutyPoint]) -> list[float]:
    """Return shares of the time, with the exact sum one."""
    if not points:
        raise SceneError("a duty table needs at least one point")
    for k, point in enumerate(points):
        if not point.life > 0:
            raise SceneError("a life must be greater than zero", path=(k, "life"))
    stated = [point.share for point in points if point.share is not None]
    hours = [point.hours for point in points if point.hours is not None]
    if stated and hours or len(stated) + len(hours) != len(points):
        raise SceneError(
            "give every point of a duty table its share of the time, or every point its hours"
        )
    parts = stated or hours
    for k, part in enumerate(parts):
        if not 0 <= part < math.inf:
            key = "share" if stated else "hours"
            raise SceneError("must not be negative, and finite", path=(k, key), value=f"{part:g}")
    total = sum(parts)
    if stated and abs(total - 1) > TYPED:
        raise SceneError(
            f"the shares of a duty table sum to {total:.6g}; they must sum to one (write hours for "
            "times that do not)"
        )
    if total == 0:
        raise SceneError("the hours of a duty table sum to zero; at least one point must last")
    return [part / total for part in parts]


@dataclass(frozen=True)
class PointLife:
    """Life of a bearing at an operating point."""

    label: str  #: of the point
    life: BearingLife
    share: float | None = None  #: of the time
    hours: float | None = None  #: in place of a share


@dataclass(frozen=True)
class LivesOverPoints:
    """Lives of a bearing at all operating points of a train."""

    name: str  #: shaft and bearing, such as ``pinion.A``
    points: tuple[PointLife, ...]

    @property
    def kind(self) -> str:
        """Kind of life that duty adds up: the modified one where every loaded point has it."""
        loaded = [p.life for p in self.points if math.isfinite(p.life.life.reference)]
        modified = loaded and all("modified" in life.lives for life in loaded)
        return "modified" if modified else "reference"

    @property
    def duty(self) -> DutyLife | None:
        """Life over the duty table; None where the points give neither speed nor shares."""
        single = len(self.points) == 1
        weighted = single or all(p.share is not None or p.hours is not None for p in self.points)
        if not weighted or not all(p.life.speed for p in self.points):
            return None
        return duty_life(
            [
                DutyPoint(
                    p.life.lives.get(self.kind, p.life.life.reference),
                    p.life.speed,
                    1.0 if single else p.share,
                    None if single else p.hours,
                )
                for p in self.points
            ]
        )

    def as_dict(self) -> dict[str, Any]:
        """Return plain data in SI for JSON; infinite lives are None."""
        points = [{"at": point.label} | point.life.as_dict() for point in self.points]
        duty = self.duty
        over_points = None
        if duty is not None:
            over_points = {
                "hours": duty.hours,
                "revolutions": duty.revolutions,
                "of": self.kind,
                "damage": duty.damage,
                "worst": duty.worst,
            }
        return plain({"name": self.name, "points": points, "duty": over_points})
