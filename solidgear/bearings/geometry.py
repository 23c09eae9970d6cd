"""Inner geometry of a bearing: given, or estimated from boundary dimensions and load ratings.

A catalogue gives bore, outside diameter, width and load ratings; the number and size of the rolling
elements are the maker's. Three things tie them down: room (an element takes a usual share of ``D -
d``), filling (how many are usually put in), and the rating, of which ISO 281:2007 and ISO 76:2006
say how it is computed from them (:mod:`solidgear.bearings.rating`). The shares were read off
bearings whose inside is published (6203 to 6311, 7208, 218, NU205 to NU312, 30206 to 32310; of
spherical rollers one, Harris's 22317; of thrust balls 51110 and 51210):
:mod:`solidgear.bearings.kinds` holds their middle and their spread. Estimates are marked, and comes
with a softer and a stiffer inside at the ends of the spread.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

from solidgear.bearings.catalogue import Catalogue
from solidgear.bearings.designation import usual_angle
from solidgear.bearings.inside import Inside
from solidgear.bearings.kinds import FULL, SHARES, Share
from solidgear.bearings.rating import rated, static_ball_rating, static_roller_rating
from solidgear.core import SceneError

#: of a filling slot-free deep groove the balls span this much of the circle, rad
CONRAD = math.radians(186)
#: relative; of ratings that makers give on their own experience
RATING_SPREAD = 0.08


class Geometry(NamedTuple):
    """Inner geometry with its softest and stiffest estimate."""

    #: middle, softer, stiffer: all three the same where nothing is estimated
    middle: Inside
    softer: Inside
    stiffer: Inside
    estimated: tuple[str, ...]  #: names of the dimensions that were not given


@lru_cache(maxsize=1024)
def inner_geometry(data: Catalogue) -> Geometry:
    """Return the inner geometry of a bearing by catalogue data; refuse a load rating that no
    inside of these boundary dimensions has.
    """
    make = _balls if data.balls else _rollers
    middle = make(data, "middle")
    if not data.estimated:
        return Geometry(middle, middle, middle, ())
    return Geometry(middle, make(data, "softer"), make(data, "stiffer"), data.estimated)


_SIGN = {"middle": 0, "softer": -1, "stiffer": 1}


def _at(share: Share, end: str, sign: int = 1) -> float:
    return share.middle + sign * _SIGN[end] * share.spread


def _angle(data: Catalogue, end: str) -> float:
    shares = SHARES[data.kind]
    if not data.angled or data.contact_angle is not None:
        return data.contact_angle or shares.angle
    usual = usual_angle(data.designation, data.kind)
    return (usual or shares.angle) * (1 + _SIGN[end] * shares.angle_spread)


def _start(data: Catalogue, end: str) -> Inside:
    """Return the inner geometry by room and filling alone."""
    shares = SHARES[data.kind]
    room = data.outer_diameter - (data.raceway or data.bore)
    # larger elements are fewer, and softer together
    diameter = data.element_diameter or _at(shares.diameter, end, -1) * room
    pitch = data.pitch_diameter or (data.bore + data.outer_diameter) / 2
    if data.kind == "needle" and data.pitch_diameter is None:
        # needles run on the shaft, or on an inner ring
        pitch = (data.raceway or data.bore) + diameter
    length = 0.0
    if not data.balls:
        length = data.element_length or _at(shares.length, end) * data.width
    touching = math.pi / math.asin(diameter / pitch)
    elements = data.elements
    if elements is None and data.kind == "deep_groove":
        elements = round(1 + CONRAD / (2 * math.asin(diameter / pitch)) + 0.6 * _SIGN[end])
    elif elements is None:
        filling = shares.filling if data.cage else FULL
        elements = round(_at(filling, end) * touching)
    elements = max(3, min(elements, int(touching + 1e-9)))
    inner, outer = data.conformity or shares.conformity[1 + _SIGN[end]]
    return _on_sphere(
        data, Inside(elements, diameter, length, pitch, _angle(data, end), (inner, outer))
    )


def _on_sphere(data: Catalogue, inside: Inside) -> Inside:
    """Return an inside with the outer raceway that its kind has: a groove, or a sphere about the
    middle.
    """
    if not data.nature.sphere:
        return inside
    outer = (1 / inside.gamma + 1) / 2
    return replace(inside, conformity=(inside.conformity[0], outer))


#: of the ball diameter, in the rating of a bearing (ISO 281)
USUAL_POWER = 1.8


def _balls(data: Catalogue, end: str) -> Inside:
    guess = _start(data, end)
    if data.load_rating is None or (data.elements and data.element_diameter):
        return guess
    # the rating decides among the whole numbers of balls, nearest to the usual diameter
    rating = data.load_rating * (1 + _SIGN[end] * RATING_SPREAD)
    usual = SHARES[data.kind].diameter.middle * (data.outer_diameter - data.bore)
    counts = [data.elements] if data.elements else range(3, 60)
    candidates = []
    for count in counts:
        diameter = data.element_diameter or _ball_for(replace(guess, elements=count), rating, data)
        if count * math.asin(min(diameter / guess.pitch, 1.0)) < math.pi:
            inside = _on_sphere(data, replace(guess, elements=count, diameter=diameter))
            candidates.append((_misfit(inside, rating, usual, data), inside))
    if not candidates:
        raise _no_inside(data)
    misfit, best = min(candidates, key=lambda pair: pair[0])
    if misfit > 0.5:
        raise _no_inside(data)
    return best


def _misfit(inside: Inside, rating: float, usual: float, data: Catalogue) -> float:
    computed = rated(data, inside)
    filling = inside.elements * math.asin(inside.diameter / inside.pitch) / math.pi
    share = SHARES[data.kind].filling
    static = 0.0
    if inside.thrust and data.static_rating and data.load_rating:  # Z Dw^2 and nothing else
        target = data.static_rating * rating / data.load_rating
        static = abs(math.log(static_ball_rating(inside) / target))
    return (
        abs(math.log(computed / rating))
        + static
        + abs(math.log(inside.diameter / usual))
        + 0.5 * max(0.0, abs(filling - share.middle) - share.spread)
    )


def _ball_for(inside: Inside, rating: float, data: Catalogue) -> float:
    """Return the ball diameter that brings the rating, for a number of balls."""
    widest = 0.48 * (data.outer_diameter - data.bore)
    diameter, power, last = inside.diameter, USUAL_POWER, (0.0, 0.0)
    for _ in range(40):
        computed = rated(data, _on_sphere(data, replace(inside, diameter=diameter)))
        if all(last) and computed != last[1]:
            # steps of a secant, where the rating grows as it should
            grown = math.log(computed / last[1]) / math.log(diameter / last[0])
            power = grown if grown > USUAL_POWER / 2 else USUAL_POWER
        last = diameter, computed
        diameter = min(diameter * (rating / computed) ** (1 / power), widest)
        if abs(diameter - last[0]) <= 1e-14 * diameter:
            break
    return diameter


def _rollers(data: Catalogue, end: str) -> Inside:
    guess = _start(data, end)
    if data.element_length is not None or not (data.static_rating or data.load_rating):
        return guess
    # the ratings fix the length of all rollers together best
    computed: float
    if data.static_rating is not None:
        rating, computed, power = (
            data.static_rating,
            data.rated_rows * static_roller_rating(guess),
            1.0,
        )
    else:
        assert data.load_rating is not None
        rating, computed = data.load_rating, rated(data, guess)
        power = 9 / 7
    target = rating * (1 + _SIGN[end] * RATING_SPREAD)
    length = guess.length * (target / computed) ** power
    width = data.width / data.own_rows
    if not 0.3 * width < length < 1.3 * width:
        raise _no_inside(data)
    return replace(guess, length=min(length, 0.95 * width))


def _no_inside(data: Catalogue) -> SceneError:
    key = "static_rating" if data.static_rating and not data.balls else "load_rating"
    value = getattr(data, key)
    return SceneError(
        f"no {data.kind.replace('_', ' ')} bearing of these boundary dimensions has a rating of "
        f"{value:.4g} N; check it, or give the inner geometry",
        path=(key,),
    )
