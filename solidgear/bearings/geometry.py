"""Inner geometry of a bearing: given, or estimated from boundary dimensions and load ratings.

A catalogue gives bore, outside diameter, width and load ratings; the number and size of the rolling
elements are the maker's.  Three things tie them down: room (an element takes a usual share of
``D - d``), filling (how many are usually put in), and the rating, of which ISO 281:2007 and
ISO 76:2006 say how it is computed from them,

    balls     C = 1.3 f_c cos(a)^0.7 Z^(2/3) Dw^1.8
    rollers   C = b_m f_c (l cos(a))^(7/9) Z^(3/4) Dw^(29/27),    C_0 = 44 (1 - g) Z l Dw cos(a)

(N, mm; g = Dw cos(a) / Dpw).  The shares were read off bearings whose inside is published (6203 to
6311, 7208, 218, NU205 to NU312, 30206 to 32310): :data:`SHARES` holds their middle and their
spread. What is estimated is marked, and comes with a softer and a stiffer inside at the ends of the
spread.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

from solidgear.errors import SceneError
from solidgear.scene.catalogue import Catalogue
from solidgear.scene.designation import usual_angle


class Share(NamedTuple):
    """Middle and half spread of a usual proportion."""

    middle: float
    spread: float


class Shares(NamedTuple):
    """Usual proportions of a kind.

    Attributes
    ----------
    diameter : Share
        Element diameter over ``D - d``.
    length : Share
        Effective roller length over width.
    filling : Share
        Elements over those that would touch all around.
    factor : float
        b_m of ISO 281.
    """

    diameter: Share
    length: Share
    filling: Share
    factor: float


NONE = Share(0.0, 0.0)
SHARES = {
    "deep_groove": Shares(Share(0.30, 0.015), NONE, Share(0.66, 0.06), 1.3),
    "angular_contact": Shares(Share(0.30, 0.02), NONE, Share(0.88, 0.05), 1.3),
    "cylindrical": Shares(Share(0.27, 0.015), Share(0.65, 0.08), Share(0.80, 0.06), 1.1),
    "tapered": Shares(Share(0.245, 0.015), Share(0.70, 0.08), Share(0.92, 0.04), 1.1),
    "needle": Shares(Share(0.40, 0.05), Share(0.72, 0.08), Share(0.65, 0.10), 1.0),
}
#: rad; of a contact angle that nothing tells.  It has no spread here: a steeper one is stiffer
#: along y and softer across it
ANGLE = {"angular_contact": math.radians(40), "tapered": math.radians(15)}
#: groove radius over ball diameter: ISO 281's own, and the range in use
CONFORMITY = {"middle": (0.52, 0.53), "softer": (0.53, 0.53), "stiffer": (0.515, 0.515)}
#: of a filling slot-free deep groove the balls span this much of the circle, rad
CONRAD = math.radians(186)
#: relative; of ratings that makers give on their own experience
RATING_SPREAD = 0.08


@dataclass(frozen=True)
class Inside:
    """Inner geometry of a row, m and rad.

    Attributes
    ----------
    elements : int
    diameter, length, pitch : float
        `length` is 0 for balls.
    angle : float
    conformity : (float, float)
    """

    elements: int
    diameter: float
    length: float
    pitch: float
    angle: float
    conformity: tuple[float, float]

    @property
    def gamma(self) -> float:
        """``Dw cos(a) / Dpw``."""
        return self.diameter * math.cos(self.angle) / self.pitch


class Geometry(NamedTuple):
    """Inner geometry with its spread.

    Attributes
    ----------
    middle, softer, stiffer : Inside
        All three the same where nothing is estimated.
    estimated : tuple of str
        What was not given.
    """

    middle: Inside
    softer: Inside
    stiffer: Inside
    estimated: tuple[str, ...]


def ball_rating(inside: Inside, rows: int = 1) -> float:
    """Basic dynamic radial load rating of a ball bearing by ISO 281, N.

    Examples
    --------
    A 6206 has nine balls of 9.525 mm on 46 mm; makers give 19.5 to 20.3 kN:

    >>> round(ball_rating(Inside(9, 9.525e-3, 0.0, 46e-3, 0.0, (0.52, 0.53))) / 1e3, 1)
    19.9
    """
    g = inside.gamma
    inner, outer = inside.conformity
    grooves = (inner * (2 * outer - 1) / (outer * (2 * inner - 1))) ** 0.41
    ratio = 1.04 * ((1 - g) / (1 + g)) ** 1.72 * grooves
    both = (1 + ratio ** (10 / 3)) ** -0.3
    factor = 39.9 * both * g**0.3 * (1 - g) ** 1.39 / (1 + g) ** (1 / 3)
    factor *= (2 * inner / (2 * inner - 1)) ** 0.41
    size = inside.diameter * 1e3
    # above 25.4 mm the rating grows less
    size = size**1.8 if size <= 25.4 else 3.647 * size**1.4
    angle = math.cos(inside.angle)
    return 1.3 * factor * (rows * angle) ** 0.7 * inside.elements ** (2 / 3) * size


def roller_rating(inside: Inside, factor: float = 1.1, rows: int = 1) -> float:
    """Basic dynamic radial load rating of a roller bearing by ISO 281, N.

    Examples
    --------
    Thirteen rollers of 9 x 10 mm on 46.5 mm, an NU 206:

    >>> round(roller_rating(Inside(13, 9e-3, 10e-3, 46.5e-3, 0.0, (0.5, 0.5))) / 1e3)
    42
    """
    g = inside.gamma
    ratio = 1.04 * ((1 - g) / (1 + g)) ** (143 / 108)
    both = (1 + ratio ** (9 / 2)) ** (-2 / 9)
    material = 207.0 * 0.83 * both * g ** (2 / 9) * (1 - g) ** (29 / 27) / (1 + g) ** 0.25
    length = rows * inside.length * 1e3 * math.cos(inside.angle)
    size = (inside.diameter * 1e3) ** (29 / 27)
    return factor * material * length ** (7 / 9) * inside.elements**0.75 * size


def static_roller_rating(inside: Inside) -> float:
    """Basic static radial load rating of a row of rollers by ISO 76, N."""
    mm = inside.length * inside.diameter * 1e6
    return 44.0 * (1 - inside.gamma) * inside.elements * mm * math.cos(inside.angle)


def inner_geometry(data: Catalogue) -> Geometry:
    """Inner geometry of a bearing by its catalogue data.

    Parameters
    ----------
    data : Catalogue

    Returns
    -------
    Geometry

    Raises
    ------
    SceneError
        A load rating that no inside of these boundary dimensions has.

    Examples
    --------
    The 6206 of catalogues, with nothing of its inside told:

    >>> from solidgear.scene.catalogue import Catalogue
    >>> found = inner_geometry(Catalogue(designation="6206", load_rating="19.5 kN"))
    >>> found.middle.elements, round(found.middle.diameter * 1e3, 2)  # in truth 9 of 9.525 mm
    (9, 9.41)
    """
    make = _balls if data.balls else _rollers
    middle = make(data, "middle")
    if not data.estimated:
        return Geometry(middle, middle, middle, ())
    return Geometry(middle, make(data, "softer"), make(data, "stiffer"), data.estimated)


_SIGN = {"middle": 0, "softer": -1, "stiffer": 1}


def _at(share: Share, end: str, sign: int = 1) -> float:
    return share.middle + sign * _SIGN[end] * share.spread


def _angle(data: Catalogue) -> float:
    if data.kind not in ANGLE:
        return 0.0
    if data.contact_angle is not None:
        return data.contact_angle
    known = usual_angle(data.designation)
    return ANGLE[data.kind] if known is None else known


def _start(data: Catalogue, end: str) -> Inside:
    """Geometry by room and filling alone."""
    shares = SHARES[data.kind]
    room = data.outer_diameter - data.bore
    # larger elements are fewer, and softer together
    diameter = data.element_diameter or _at(shares.diameter, end, -1) * room
    pitch = data.pitch_diameter or (data.bore + data.outer_diameter) / 2
    if data.kind == "needle" and data.pitch_diameter is None:
        pitch = data.bore + diameter  # needles run on the shaft
    length = 0.0
    if not data.balls:
        length = data.element_length or _at(shares.length, end) * data.width
    touching = math.pi / math.asin(diameter / pitch)
    elements = data.elements
    if elements is None and data.kind == "deep_groove":
        elements = round(1 + CONRAD / (2 * math.asin(diameter / pitch)) + 0.6 * _SIGN[end])
    elif elements is None:
        elements = round(_at(shares.filling, end) * touching)
    elements = max(3, min(elements, int(touching + 1e-9)))
    conformity = data.conformity or CONFORMITY[end]
    return Inside(elements, diameter, length, pitch, _angle(data), conformity)


def _rows(data: Catalogue) -> int:
    """Rows that a load rating is told for: of a pair it is that of a single bearing."""
    return 2 if data.arrangement == "double_row" else 1


def _balls(data: Catalogue, end: str) -> Inside:
    guess = _start(data, end)
    if data.load_rating is None or (data.elements and data.element_diameter):
        return guess
    # the rating decides among the whole numbers of balls, nearest to the usual diameter
    rating = data.load_rating * (1 + _SIGN[end] * RATING_SPREAD)
    usual = SHARES[data.kind].diameter.middle * (data.outer_diameter - data.bore)
    counts = [data.elements] if data.elements else range(3, 60)
    found = []
    for count in counts:
        diameter = data.element_diameter or _ball_for(replace(guess, elements=count), rating, data)
        if count * math.asin(min(diameter / guess.pitch, 1.0)) < math.pi:
            inside = replace(guess, elements=count, diameter=diameter)
            found.append((_misfit(inside, rating, usual, data), inside))
    if not found:
        raise _no_inside(data)
    misfit, best = min(found, key=lambda pair: pair[0])
    if misfit > 0.5:
        raise _no_inside(data)
    return best


def _rated(inside: Inside, data: Catalogue) -> float:
    """Rating as makers tell it: ISO 281 grants tighter grooves than its own nothing."""
    own = replace(inside, conformity=CONFORMITY["middle"])
    return ball_rating(own, _rows(data))


def _misfit(inside: Inside, rating: float, usual: float, data: Catalogue) -> float:
    own = _rated(inside, data)
    filling = inside.elements * math.asin(inside.diameter / inside.pitch) / math.pi
    share = SHARES[data.kind].filling
    return (
        abs(math.log(own / rating))
        + abs(math.log(inside.diameter / usual))
        + 0.5 * max(0.0, abs(filling - share.middle) - share.spread)
    )


def _ball_for(inside: Inside, rating: float, data: Catalogue) -> float:
    """Ball diameter that brings the rating, for a number of balls."""
    diameter = inside.diameter
    widest = 0.48 * (data.outer_diameter - data.bore)
    for _ in range(40):
        own = _rated(replace(inside, diameter=diameter), data)
        diameter = min(diameter * (rating / own) ** (1 / 1.8), widest)
    return diameter


def _rollers(data: Catalogue, end: str) -> Inside:
    guess = _start(data, end)
    if data.element_length is not None or not (data.static_rating or data.load_rating):
        return guess
    # what the ratings tie down best is the length of all rollers together
    own: float
    if data.static_rating is not None:
        rating, own, power = data.static_rating, _rows(data) * static_roller_rating(guess), 1.0
    else:
        assert data.load_rating is not None
        factor = SHARES[data.kind].factor
        rating, own = data.load_rating, roller_rating(guess, factor, _rows(data))
        power = 9 / 7
    wanted = rating * (1 + _SIGN[end] * RATING_SPREAD)
    length = guess.length * (wanted / own) ** power
    if not 0.3 * data.width < length < 1.3 * data.width:
        raise _no_inside(data)
    return replace(guess, length=min(length, 0.95 * data.width))


def _no_inside(data: Catalogue) -> SceneError:
    key = "static_rating" if data.static_rating and not data.balls else "load_rating"
    value = getattr(data, key)
    return SceneError(
        f"no {data.kind.replace('_', ' ')} bearing of these boundary dimensions has a rating of "
        f"{value:.4g} N; check it, or give the inner geometry",
        path=(key,),
    )
