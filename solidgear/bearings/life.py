"""Life and static safety of a bearing at one motion.

Three lives stand beside each other: the basic one of ISO 281 from the reaction alone, the basic
reference one of ISO/TS 16281 from the loads of all elements (clearance, preload, tilt and the share
of each row are in it), and the modified reference one, where the lubrication is known.

The modified life of ISO 281:2007 counts reliability, lubricating film, dirt and the fatigue limit,

    L_nm = a_1 a_ISO L_10.

The film is judged by ``kappa = nu / nu_1``, the viscosity at work over that which the size and the
speed ask for,

    nu_1 = 45000 n^-0.83 Dpw^-0.5 below 1000 r/min,     4500 n^-0.5 Dpw^-0.5 above   (mm^2/s, mm)

and with e_C for dirt and the fatigue load limit C_u, for 0.1 <= kappa <= 4,

    balls     a_ISO = 0.1 (1 - (2.5671 - A / kappa^B)^0.83 (e_C C_u / P)^(1/3))^-9.3
    rollers   a_ISO = 0.1 (1 - (1.5859 - A / kappa^B) (e_C C_u / P)^0.4)^-9.185

and at most 50 (ISO 281:2007, 9.3.3; A and B make the formulas join at kappa = 0.4, which a
misprinted 0.019087 for balls does not). Reliability is a Weibull distribution with a life of 5 %
that all reach, ``a_1 = 0.05 + 0.95 (ln S / ln 0.9)^(2/3)``: Table 12 of ISO 281 to its digits
(ISO/TR 1281-2:2008).

ISO/TS 16281 takes a_ISO for every slice by itself, at the load P of a row whose slices are all
loaded like this one.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from solidgear.bearings.catalogue import Catalogue
from solidgear.bearings.catalogued import Catalogued
from solidgear.bearings.equivalent import Equivalent, equivalent_load, static_load
from solidgear.bearings.rating import (
    ROW_POWER,
    SPHERE_PRESSURE,
    STATIC_PRESSURE,
    Ratings,
    ratings,
)
from solidgear.bearings.reference_life import Damage, Ring, damage, raceways
from solidgear.bearings.row import Contacts
from solidgear.core.scene.lubrication import Lubrication

#: powers of the load in the basic life, of balls and of rollers
LIFE_POWER = {True: 3.0, False: 10 / 3}
#: of the sum of all contact forces: a load below it is none
ROUNDING = 1e-9
#: of C: beyond this equivalent load ISO 281 does not vouch for its life
MOST_LOAD = 0.5
#: of the radial load: what ribs of cylindrical rollers may carry along y (SKF, Rolling bearings)
MOST_ON_RIBS = 0.5


class Modified(NamedTuple):
    """Modified reference rating life with factors."""

    life: float  #: L_nmr, revolutions
    reliability: float
    #: a1, a_iso, kappa, contamination: factors of ISO 281; `a_iso` is that of all slices together,
    #: `contamination` is e_C
    a1: float
    a_iso: float
    kappa: float
    contamination: float
    reference_viscosity: float  #: nu_1, m^2/s
    #: low, high: life at both ends of the cleanliness that a word means
    low: float
    high: float


@dataclass(frozen=True)
class Life:
    """Life and static safety of a bearing at one motion; lives in revolutions of 90 % reliability."""

    basic: float  #: L_10 of ISO 281
    reference: float  #: L_10r of ISO/TS 16281
    modified: Modified | None
    without: str  #: reason why there is no modified life; empty where there is one
    equivalent: Equivalent  #: dynamic load P of the basic life
    #: load, N, whose basic life is the reference life, so that this is ``(C/P)^p``
    reference_load: float
    #: static_load, static_safety: P_0 in N, and C_0 / P_0
    static_load: float
    static_safety: float
    #: largest at the inner and the outer ring of each row, Pa
    pressure: tuple[tuple[float, float], ...]
    rated: Ratings
    notes: tuple[str, ...]  #: warnings, one sentence each


def life(
    data: Catalogue,
    made: Catalogued,
    motion: np.ndarray,
    lubrication: Lubrication | None = None,
    speed: float = 0.0,
    turning: Ring = "inner",
) -> Life:
    """Return the life of a bearing at one motion of the inner ring, (6,), m and rad.

    Without lubrication or speed, rad/s, there is no modified life; `turning` is the ring that turns
    against the load.

    Examples
    --------
    >>> from solidgear.bearings.catalogued import catalogued, state
    >>> data = Catalogue(designation="6206", load_rating="19.5 kN", static_rating="11.3 kN",
    ...                  load={"z": "1.95 kN"})
    >>> made = catalogued(data)
    >>> found = life(data, made, state(data, made))
    >>> round(found.basic / 1e6), round(found.reference / 1e6), found.without
    (1000, 999, 'no lubrication is given')
    """
    rated = ratings(data, made.inside)
    rows, load = made.bearing.contacts(motion), made.bearing.load(motion)
    # contacts that balance each other leave the rounding of their sum
    at_work = sum(row.load.sum() for row in rows)
    load = np.where(np.abs(load) > ROUNDING * at_work, load, 0.0)
    row_rating = rated.dynamic / len(rows) ** ROW_POWER[data.balls]
    fatigue_damage = damage(rows, raceways(made.inside, row_rating), turning)
    equivalent = equivalent_load(data, made.inside, rated, load)
    static = static_load(data, made.inside, load)
    result = Life(
        basic=1e6 * _quotient(rated.dynamic, equivalent.load) ** LIFE_POWER[data.balls],
        reference=fatigue_damage.life,
        modified=None,
        without="",
        equivalent=equivalent,
        reference_load=rated.dynamic * (1e6 / fatigue_damage.life) ** (1 / LIFE_POWER[data.balls]),
        static_load=static,
        static_safety=_quotient(rated.static, static),
        pressure=tuple((float(row.inner.max()), float(row.outer.max())) for row in rows),
        rated=rated,
        notes=(
            *_on_ribs(data, equivalent),
            *_notes(data, rated, rows, equivalent.load, static),
        ),
    )
    if math.isinf(result.reference):
        return replace(result, without="it carries nothing")
    if lubrication is None:
        return replace(result, without="no lubrication is given")
    return _modified(result, fatigue_damage, made.inside.pitch, data.balls, lubrication, speed)


def _quotient(rating: float, load: float) -> float:
    return rating / load if load > 0 else math.inf


def _modified(
    result: Life,
    fatigue_damage: Damage,
    pitch: float,
    balls: bool,
    lubrication: Lubrication,
    speed: float,
) -> Life:
    """Return the same life with the modified life, or with the reason why there is none."""
    if not speed > 0:
        return replace(result, without="no speed is given")
    reference = reference_viscosity(speed, pitch)
    kappa = lubrication.viscosity / reference
    if kappa < LEAST_FILM:
        reason = (
            f"the viscosity is {kappa:.2g} of the {reference * 1e6:.3g} mm^2/s needed at this speed "
            f"and size, and ISO 281 has no life below {LEAST_FILM:g}"
        )
        return replace(result, without=reason)
    a1 = reliability_factor(lubrication.reliability)
    fatigue = result.rated.fatigue / len(fatigue_damage.by_slice)
    # a slice that carries nothing is far below every limit
    limit = fatigue / np.maximum(fatigue_damage.slice_loads, 1e-9 * fatigue)

    def life_with(dirt: float) -> float:
        return a1 * fatigue_damage.modified(life_factor(kappa, dirt * limit, balls))

    low, high = lubrication.contamination(pitch)
    dirt = (low + high) / 2
    life_at_middle = life_with(dirt)
    modified = Modified(
        life=life_at_middle,
        reliability=lubrication.reliability,
        a1=a1,
        a_iso=life_at_middle / a1 / result.reference,
        kappa=kappa,
        contamination=dirt,
        reference_viscosity=reference,
        low=life_with(low),
        high=life_with(high),
    )
    return replace(result, modified=modified)


def _on_ribs(data: Catalogue, equivalent: Equivalent) -> Iterator[str]:
    """Yield a sentence on ribs that carry more than they may."""
    if data.ribbed and equivalent.axial > MOST_ON_RIBS * equivalent.radial:
        yield (
            f"it takes {equivalent.axial:.5g} N along the shaft on its ribs, above half of its radial "
            f"load of {equivalent.radial:.5g} N, which makers allow at most (SKF); its life counts "
            "the radial load alone (ISO 281)"
        )


def _notes(
    data: Catalogue, rated: Ratings, rows: tuple[Contacts, ...], dynamic: float, static: float
) -> Iterator[str]:
    if static > rated.static:
        yield (
            f"its equivalent static load of {static:.5g} N is {static / rated.static:.3g} times its "
            f"static rating C0 of {rated.static:.5g} N (ISO 76)"
        )
    if dynamic > MOST_LOAD * rated.dynamic:
        yield (
            f"its equivalent load of {dynamic:.5g} N is {dynamic / rated.dynamic:.3g} times its "
            f"dynamic rating C; ISO 281 holds up to {MOST_LOAD:g} of it"
        )
    most = max(float(max(row.inner.max(), row.outer.max())) for row in rows)
    limit = SPHERE_PRESSURE if data.nature.sphere else STATIC_PRESSURE[data.balls]
    if most > limit:
        yield (
            f"a contact pressure of {most / 1e6:.0f} MPa is beyond the {limit / 1e6:.0f} MPa of its "
            "static rating (ISO 76)"
        )


#: largest a_ISO, and the range of kappa in which it is known
MOST_LIFE, LEAST_FILM, FULL_FILM = 50.0, 0.1, 4.0
#: for kappa from: A, B; of balls and of rollers
_FILM = {
    True: ((1.0, 1.9987, 0.071739), (0.4, 1.9987, 0.19087), (0.1, 2.2649, 0.054381)),
    False: ((1.0, 1.2348, 0.071739), (0.4, 1.2348, 0.19087), (0.1, 1.3993, 0.054381)),
}


class Law(NamedTuple):
    """Constants of a_ISO for a kind of element: see the head of this module."""

    start: float
    film: float
    load: float
    power: float


_LAW = {True: Law(2.5671, 0.83, 1 / 3, 9.3), False: Law(1.5859, 1.0, 0.4, 9.185)}


def reliability_factor(reliability: float) -> float:
    """Return a_1 of ISO 281, Table 12."""
    return 0.05 + 0.95 * (math.log(reliability) / math.log(0.9)) ** (2 / 3)


def reference_viscosity(speed: float, pitch: float) -> float:
    """Return the viscosity nu_1, m^2/s, that a bearing needs at a speed, rad/s, and a diameter of
    the circle of the elements' centres, m.
    """
    turns, size = speed * 30 / math.pi, pitch * 1e3
    factor = 45000 * turns**-0.83 if turns < 1000 else 4500 * turns**-0.5
    return factor * size**-0.5 * 1e-6


def life_factor(kappa: float, ratio: np.ndarray, balls: bool) -> np.ndarray:
    """Return a_ISO of ISO 281 for radial bearings, at most 50, from the viscosity ratio, at least
    0.1, and ``e_C C_u / P``; a viscosity ratio above 4 counts as 4.

    Examples
    --------
    >>> life_factor(1.0, np.array([0.1, 2.0]), balls=True).round(2)
    array([ 2.43, 50.  ])
    """
    kappa = min(kappa, FULL_FILM)
    law = _LAW[balls]
    _, a, b = next(entry for entry in _FILM[balls] if kappa >= entry[0])
    inner = 1 - (law.start - a / kappa**b) ** law.film * ratio**law.load
    # of a film this thick nothing below the fatigue limit fails
    least = (MOST_LIFE / 0.1) ** (-1 / law.power)
    return 0.1 * np.maximum(inner, least) ** -law.power
