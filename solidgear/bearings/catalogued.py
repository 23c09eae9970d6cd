"""From catalogue data to a bearing that carries load."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from solidgear.bearings.ball import AligningBallRow, BallRow, ThrustBallRow
from solidgear.bearings.catalogue import WAYS, Catalogue
from solidgear.bearings.clearance import clearance_at_work
from solidgear.bearings.equivalent import static_factors
from solidgear.bearings.geometry import inner_geometry
from solidgear.bearings.inside import Inside
from solidgear.bearings.preload import SprungRow, pushed
from solidgear.bearings.ribs import Ribs, estimated_stiffness
from solidgear.bearings.roller import RollerRow
from solidgear.bearings.rolling import RollingBearing, Row
from solidgear.bearings.spherical import SphericalRow
from solidgear.bearings.spinning import SpinningBalls
from solidgear.core import SceneError, SolidgearError

End = Literal["middle", "softer", "stiffer"]


@dataclass(frozen=True)
class Catalogued:
    """A bearing made from catalogue data."""

    bearing: RollingBearing
    inside: Inside  #: inner geometry of a row that it was made with
    estimated: tuple[str, ...]  #: names of the inner dimensions that were not given
    clearance: float  #: radial, at work, m


def catalogued(
    data: Catalogue,
    end: End = "middle",
    *,
    clearance_share: float = 0.5,
    preload_factor: float = 1.0,
    floats: bool = False,
) -> Catalogued:
    """Return the bearing that catalogue data describe, with an estimated inner geometry at one end
    of the range, and at a place in the range of a clearance class, 0 to 1.

    `preload_factor` multiplies the preload, force or displacement; a bearing that floats has a ring
    that slides along y. Data that describe no bearing, or a preload beyond the static rating, are
    refused.
    """
    geometry = inner_geometry(data)
    inside: Inside = getattr(geometry, end)
    clearance = clearance_at_work(data, inside, clearance_share)
    _within_rating(data, inside, preload_factor)
    rows = _placed(data, inside, clearance)
    try:
        preloaded = _preloaded(data, rows, preload_factor)
    except SolidgearError as error:
        raise SceneError(str(error), path=("preload",)) from None
    ribs = None
    if data.ribbed and not floats:
        stiffness = data.rib_stiffness or estimated_stiffness(inside, end)
        ribs = Ribs(stiffness, data.holds if data.ribs == "one way" else None)
    bearing = RollingBearing(preloaded, floats, ribs)
    return Catalogued(bearing, inside, geometry.estimated, clearance)


def _placed(data: Catalogue, inside: Inside, clearance: float) -> list[BallRow | RollerRow]:
    """Return rows at their places along y, each turned by half a pitch against the one before."""
    first = -1 if data.holds == "-y" else 1
    turn = math.pi / inside.elements
    if data.own_rows > 1:
        placed = data.nature.placed
        # the normals meet in the middle, or the rows stand back to back; four points are two
        # contacts of the same balls
        apart = (data.row_distance or data.width / 2) / 2 if placed == "apart" else 0.0
        lower, upper = (1, -1) if placed == "apart" else (-1, 1)
        start = 0.0 if placed == "crossing" else turn
        return [
            _row(data, inside, clearance, lower, -apart, 0.0),
            _row(data, inside, clearance, upper, apart, start),
        ]
    if data.arrangement == "single":
        return [_row(data, inside, clearance, first, 0.0, 0.0)]
    distance = data.row_distance or data.width * (0.5 if data.arrangement == "double_row" else 1.0)
    ways = WAYS.get(data.arrangement)
    sides = [1 if way == "+y" else -1 for way in ways] if ways else [first, first]
    return [
        _row(data, inside, clearance, side, height, start)
        for side, height, start in zip(sides, (-distance / 2, distance / 2), (0.0, turn))
    ]


def _row(
    data: Catalogue, inside: Inside, clearance: float, side: int, height: float, first: float
) -> BallRow | RollerRow:
    common: dict[str, Any] = {
        "count": inside.elements,
        "diameter": inside.diameter,
        "pitch": inside.pitch,
        "angle": inside.angle,
        "side": side,
        "clearance": clearance,
        "height": height,
        "first": first,
    }
    if data.balls:
        inner, outer = inside.conformity
        kinds = {"thrust_ball": ThrustBallRow, "self_aligning": AligningBallRow}
        kind = kinds.get(data.kind, BallRow)
        return kind(inner=inner, outer=outer, **common)
    if data.barrels:
        inner, outer = inside.conformity
        return SphericalRow(length=inside.length, inner=inner, outer=outer, **common)
    return RollerRow(length=inside.length, profile=data.profile, **common)


def _preloaded(data: Catalogue, rows: list[BallRow | RollerRow], factor: float) -> tuple[Row, ...]:
    preload = data.preload
    if preload is not None and preload.force is not None:
        # of tandems, every row takes its share
        share = len(rows) if data.arrangement == "tandem" else 1
        rows = [pushed(row, factor * preload.force / share) for row in rows]
    elif preload is not None and preload.displacement is not None:
        share = 1 if data.one_sided else len(rows)
        rows = [replace(row, preload=factor * preload.displacement / share) for row in rows]
    if data.speed:
        spinning = [SpinningBalls(row, data.speed) for row in rows if isinstance(row, BallRow)]
        return tuple(spinning)
    if data.preload_spring is not None:
        return (rows[0], SprungRow(rows[1], data.preload_spring))
    return tuple(rows)


def _within_rating(data: Catalogue, inside: Inside, factor: float) -> None:
    """Refuse a preload whose equivalent static load, ``P0 = Y0 F`` by ISO 76, is beyond C0."""
    if data.preload is None or data.preload.force is None or data.static_rating is None:
        return
    equivalent = static_factors(data, inside)[1] * factor * data.preload.force
    if data.arrangement == "tandem":
        equivalent /= 2
    if equivalent > data.static_rating:
        raise SceneError(
            f"a preload of {factor * data.preload.force:.6g} N is an equivalent static load of "
            f"{equivalent:.6g} N, beyond the static rating of {data.static_rating:.6g} N",
            path=("preload",),
        )


def state(
    data: Catalogue,
    catalogued_bearing: Catalogued,
    factor: float = 1.0,
    start: np.ndarray | None = None,
) -> np.ndarray:
    """Return the motion (6,), m and rad, at which the data require the stiffness: the given
    displacement, that under the given load times a factor, searched from `start`, or rest; refuse a
    load that the bearing cannot carry.

    Examples
    --------
    >>> from solidgear.bearings.catalogue import Catalogue
    >>> data = Catalogue(designation="6206", load_rating="19.5 kN", load={"z": "2 kN"})
    >>> round(float(state(data, catalogued(data))[2]) * 1e6, 1)  # micrometres
    21.8
    """
    if data.displacement is not None:
        return np.array(data.displacement.six)
    if data.load is None:
        return np.zeros(6)
    target = factor * np.array(data.load.six)
    if data.one_sided:  # what another bearing preloads it with stays
        target += catalogued_bearing.bearing.load(np.zeros(6))
    try:
        return catalogued_bearing.bearing.motion(target, fixed=data.load.held_tilts, start=start)
    except SolidgearError as error:
        way = f"; it holds the shaft towards {data.holds} only" if data.one_sided else ""
        raise SceneError(f"{error}{way}", path=("load",)) from None
