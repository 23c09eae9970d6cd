"""Load ratings of a row from the inner geometry: ISO 281:2007 (dynamic), ISO 76:2006 (static).

    balls     C = 1.3 f_c (i cos(a))^0.7 Z^(2/3) Dw^1.8,            C_0 = i Z Q_0 cos(a) / 5
    rollers   C = b_m f_c (i l cos(a))^(7/9) Z^(3/4) Dw^(29/27),    C_0 = 44 (1 - g) i Z l Dw cos(a)

    thrust    C = 1.3 f_c Z^(2/3) Dw^1.8,                           C_0 = Z Q_0

(N, mm; g = Dw cos(a) / Dpw; i rows).  Q_0 is the load under which a ball presses a ring with 4200
MPa: the f_0 of ISO 76 is ``Q_0 / (5 Dw^2)``, and is computed here by Hertz's contact and not read
from its table.  Thrust balls stand at 90 degrees, and their ratings are axial; ISO 281's Table 4 of
their f_c is ``36.7 (100 Dw / Dpw)^0.3`` to three digits.  Balls on a sphere have its radius in f_c,
and 4600 MPa in Q_0.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

from solidgear.bearings.ball import BallRow
from solidgear.bearings.catalogue import Catalogue
from solidgear.bearings.inside import Inside
from solidgear.bearings.kinds import SHARES

#: Pa, ISO 76: beyond it the dent is above 1e-4 of the element's diameter; of balls and of rollers
STATIC_PRESSURE = {True: 4200e6, False: 4000e6}
#: Pa, of self-aligning balls
SPHERE_PRESSURE = 4600e6
#: of ISO/TR 1281-1, by which ISO 281's factors of two rows in deep grooves differ from those of one
_TWO_GROOVES = 0.90 / 0.95
#: Pa, of ISO 76
_STATIC_E = 207e9
#: of several rows in one rating
ROW_POWER = {True: 0.7, False: 7 / 9}


def ball_rating(inside: Inside, factor: float = 1.3, rows: int = 1) -> float:
    """Return the basic dynamic radial load rating of a ball bearing by ISO 281, N."""
    size = inside.diameter * 1e3
    # above 25.4 mm the rating grows less
    size = size**1.8 if size <= 25.4 else 3.647 * size**1.4
    if inside.thrust:
        material = 36.7 * (100 * inside.diameter / inside.pitch) ** 0.3
        return factor * material * inside.elements ** (2 / 3) * size
    g = inside.gamma
    inner, outer = inside.conformity
    grooves = (inner * (2 * outer - 1) / (outer * (2 * inner - 1))) ** 0.41
    ratio = 1.04 * ((1 - g) / (1 + g)) ** 1.72 * grooves
    both_rings = (1 + ratio ** (10 / 3)) ** -0.3
    material = 39.9 * both_rings * g**0.3 * (1 - g) ** 1.39 / (1 + g) ** (1 / 3)
    material *= (2 * inner / (2 * inner - 1)) ** 0.41
    if rows > 1 and not inside.angle:
        material *= _TWO_GROOVES
    angle = math.cos(inside.angle)
    return factor * material * (rows * angle) ** 0.7 * inside.elements ** (2 / 3) * size


def roller_rating(inside: Inside, factor: float = 1.1, rows: int = 1) -> float:
    """Return the basic dynamic radial load rating of a roller bearing by ISO 281, N."""
    g = inside.gamma
    ratio = 1.04 * ((1 - g) / (1 + g)) ** (143 / 108)
    both_rings = (1 + ratio ** (9 / 2)) ** (-2 / 9)
    material = 207.0 * 0.83 * both_rings * g ** (2 / 9) * (1 - g) ** (29 / 27) / (1 + g) ** 0.25
    length = rows * inside.length * 1e3 * math.cos(inside.angle)
    size = (inside.diameter * 1e3) ** (29 / 27)
    return factor * material * length ** (7 / 9) * inside.elements**0.75 * size


def static_ball_rating(inside: Inside) -> float:
    """Return the basic static radial load rating of a row of balls by ISO 76, N."""
    inner, outer = _rated_conformity(inside)
    row = BallRow(
        count=inside.elements,
        diameter=inside.diameter,
        pitch=inside.pitch,
        angle=inside.angle,
        inner=inner,
        outer=outer,
        E=_STATIC_E,
    )
    pressure = SPHERE_PRESSURE if inside.sphere else STATIC_PRESSURE[True]
    ball = min(ring.load(pressure) for ring in row.rings)
    return inside.elements * ball * (1.0 if inside.thrust else 0.2 * math.cos(inside.angle))


def _rated_conformity(inside: Inside) -> tuple[float, float]:
    """Return the groove radii over ball diameter, inner and outer, for which ISO 281 and ISO 76
    rate balls.
    """
    if inside.sphere:
        return SHARES["self_aligning"].conformity[1][0], inside.conformity[1]
    return SHARES["thrust_ball" if inside.thrust else "deep_groove"].conformity[1]


def static_factor(inside: Inside) -> float:
    """Return f_0 of ISO 76, by which ISO 281 and ISO 76 express how deep balls sit in their
    grooves, N/mm^2.
    """
    flat = inside.elements * (inside.diameter * 1e3) ** 2 * math.cos(inside.angle)
    return static_ball_rating(inside) / flat


def static_roller_rating(inside: Inside) -> float:
    """Return the basic static radial load rating of a row of rollers by ISO 76, N."""
    mm = inside.length * inside.diameter * 1e6
    return 44.0 * (1 - inside.gamma) * inside.elements * mm * math.cos(inside.angle)


def rated(data: Catalogue, inside: Inside) -> float:
    """Return the basic dynamic radial load rating of a bearing with such rows by ISO 281, N; for a
    pair that of one bearing.
    """
    if not data.balls:
        return roller_rating(inside, _factor(data), data.rated_rows)
    # ISO 281 grants tighter grooves than its own nothing
    standard = replace(inside, conformity=_rated_conformity(inside))
    return ball_rating(standard, _factor(data), data.rated_rows)


def _factor(data: Catalogue) -> float:
    return data.rating_factor or SHARES[data.kind].rating_factor


class Ratings(NamedTuple):
    """Load ratings of a bearing, of all rows together."""

    #: dynamic, static, fatigue: C, C_0 and C_u, N
    dynamic: float
    static: float
    fatigue: float
    sources: dict[str, str]  #: where each came from, by C, C0 and Cu


def ratings(data: Catalogue, inside: Inside) -> Ratings:
    """Return load ratings of a bearing: those of the catalogue, or computed from the inside.

    Ratings in the catalogue are those of a single bearing of a pair, and of both rows of a
    double_row; the result is that of both bearings of a pair: ISO 281 takes ``2^0.7`` (balls) or
    ``2^(7/9)`` (rollers) times the C of one, ISO 76 twice the C_0.

    Examples
    --------
    >>> from solidgear.bearings.geometry import inner_geometry
    >>> from solidgear.bearings.catalogue import Catalogue
    >>> data = Catalogue(designation="7208 B", arrangement="tandem", holds="+y",
    ...                  load_rating="32.1 kN")
    >>> found = ratings(data, inner_geometry(data).middle)
    >>> round(found.dynamic / 32.1e3, 3), found.sources["C"], found.sources["Cu"]
    (1.625, 'catalogue, of two bearings by ISO 281', 'C0 / 22 (ISO 281, B.3.3)')
    """
    one = ratings_of_one(data, inside)
    if not data.paired:
        return one
    sources = one.sources | {"C": f"{one.sources['C']}, of two bearings by ISO 281"}
    return Ratings(
        2 ** ROW_POWER[data.balls] * one.dynamic, 2 * one.static, 2 * one.fatigue, sources
    )


def ratings_of_one(data: Catalogue, inside: Inside) -> Ratings:
    """Return load ratings of a single bearing, also where the data are those of a pair."""
    sources = {}
    if data.load_rating is not None:
        dynamic, sources["C"] = data.load_rating, "catalogue"
    else:
        dynamic = rated(data, inside)
        sources["C"] = f"ISO 281 from the inside, b_m {_factor(data):g}"
    if data.static_rating is not None:
        static, sources["C0"] = data.static_rating, "catalogue"
    else:
        row = static_ball_rating(inside) if data.balls else static_roller_rating(inside)
        static, sources["C0"] = data.rated_rows * row, "ISO 76 from the inside"
    if data.fatigue_limit is not None:
        fatigue, sources["Cu"] = data.fatigue_limit, "catalogue"
    else:
        fatigue, sources["Cu"] = fatigue_limit(static, inside.pitch, data.balls)
    return Ratings(dynamic, static, fatigue, sources)


def fatigue_limit(static: float, pitch: float, balls: bool) -> tuple[float, str]:
    """Return the fatigue load limit C_u by the simple estimate of ISO 281:2007, B.3.3, N, and the
    formula.
    """
    share, power = (22, 0.5) if balls else (8.2, 0.3)
    if pitch <= 0.1:
        return static / share, f"C0 / {share:g} (ISO 281, B.3.3)"
    limit = static / share * (0.1 / pitch) ** power
    return limit, f"C0 / {share:g} (100 mm / Dpw)^{power:g} (ISO 281, B.3.3)"
