"""Life and static safety of a bearing at one motion.

Three lives stand beside each other: the basic one of ISO 281 from the reaction alone, the basic
reference one of ISO/TS 16281 from the loads of all elements (clearance, preload, tilt and the share
of each row are in it), and the modified reference one, where the lubrication is known.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from solidgear.bearings.catalogued import Catalogued
from solidgear.bearings.equivalent import Equivalent, equivalent_load, static_load
from solidgear.bearings.modified_life import (
    LEAST_FILM,
    life_factor,
    reference_viscosity,
    reliability_factor,
)
from solidgear.bearings.rating import ROW_POWER, STATIC_PRESSURE, Ratings, ratings
from solidgear.bearings.reference_life import Damage, Ring, damage, raceways
from solidgear.bearings.row import Contacts
from solidgear.scene.catalogue import Catalogue
from solidgear.scene.lubrication import Lubrication

#: powers of the load in the basic life, of balls and of rollers
LIFE_POWER = {True: 3.0, False: 10 / 3}
#: of the sum of all contact forces: a load below it is none
ROUNDING = 1e-9
#: of C: beyond this equivalent load ISO 281 does not vouch for its life
MOST_LOAD = 0.5


class Modified(NamedTuple):
    """Modified reference rating life and its factors."""

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
    without: str  #: why there is no modified life; empty where there is one
    equivalent: Equivalent  #: dynamic load P of the basic life
    #: what its elements feel: the radial load, N, under which half of each row carrying it evenly
    #: would live as long as the reference life
    reference_load: float
    #: static_load, static_safety: P_0 in N, and C_0 / P_0
    static_load: float
    static_safety: float
    #: largest at the inner and the outer ring of each row, Pa
    pressure: tuple[tuple[float, float], ...]
    rated: Ratings
    notes: tuple[str, ...]  #: what is to be said of it, one sentence each


def life(
    data: Catalogue,
    made: Catalogued,
    motion: np.ndarray,
    lubrication: Lubrication | None = None,
    speed: float = 0.0,
    turning: Ring = "inner",
) -> Life:
    """Life of a bearing at one motion of its inner ring.

    Parameters
    ----------
    made : Catalogued
        From these data.
    motion : (6,) ndarray
        m and rad, as an equilibrium found it.
    lubrication : Lubrication, optional
        Without it there is no modified life.
    speed : float
        rad/s; without one there is no modified life.
    turning : {'inner', 'outer'}
        The ring that turns against the load.

    Examples
    --------
    >>> from solidgear.bearings.catalogued import catalogued, state
    >>> data = Catalogue(designation="6206", load_rating="19.5 kN", static_rating="11.3 kN",
    ...                  load={"z": "1.95 kN"})
    >>> made = catalogued(data)
    >>> found = life(data, made, state(data, made))
    >>> round(found.basic / 1e6), round(found.reference / 1e6), found.without
    (1000, 999, 'no [lubrication] is given')
    """
    rated = ratings(data, made.inside)
    rows, load = made.bearing.contacts(motion), made.bearing.load(motion)
    # contacts that balance each other leave the rounding of their sum
    at_work = sum(row.load.sum() for row in rows)
    load = np.where(np.abs(load) > ROUNDING * at_work, load, 0.0)
    own = rated.dynamic / len(rows) ** ROW_POWER[data.balls]
    done = damage(rows, raceways(made.inside, own), turning)
    equivalent = equivalent_load(data, made.inside, rated, load)
    static = static_load(data, made.inside, load)
    found = Life(
        basic=1e6 * _quotient(rated.dynamic, equivalent.load) ** LIFE_POWER[data.balls],
        reference=done.life,
        modified=None,
        without="",
        equivalent=equivalent,
        reference_load=done.load,
        static_load=static,
        static_safety=_quotient(rated.static, static),
        pressure=tuple((float(row.inner.max()), float(row.outer.max())) for row in rows),
        rated=rated,
        notes=tuple(_notes(data, rated, rows, equivalent.load, static)),
    )
    if math.isinf(found.reference):
        return replace(found, without="it carries nothing")
    if lubrication is None:
        return replace(found, without="no [lubrication] is given")
    return _modified(found, done, made.inside.pitch, data.balls, lubrication, speed)


def _quotient(rating: float, load: float) -> float:
    return rating / load if load > 0 else math.inf


def _modified(
    found: Life, done: Damage, pitch: float, balls: bool, lubrication: Lubrication, speed: float
) -> Life:
    """The same life with the modified one, or with why there is none."""
    if not speed > 0:
        return replace(found, without="no speed is given")
    wanted = reference_viscosity(speed, pitch)
    kappa = lubrication.viscosity / wanted
    if kappa < LEAST_FILM:
        without = (
            f"the viscosity is {kappa:.2g} of the {wanted * 1e6:.3g} mm^2/s that speed and size ask "
            f"for, and ISO 281 has no life below {LEAST_FILM:g}"
        )
        return replace(found, without=without)
    a1 = reliability_factor(lubrication.reliability)
    fatigue = found.rated.fatigue / len(done.each)
    # a slice that carries nothing is far below every limit
    limit = fatigue / np.maximum(done.slice_loads, 1e-9 * fatigue)

    def lived(dirt: float) -> float:
        return a1 * done.modified(life_factor(kappa, dirt * limit, balls))

    low, high = lubrication.contamination(pitch)
    dirt = (low + high) / 2
    whole = lived(dirt)
    modified = Modified(
        life=whole,
        reliability=lubrication.reliability,
        a1=a1,
        a_iso=whole / a1 / found.reference,
        kappa=kappa,
        contamination=dirt,
        reference_viscosity=wanted,
        low=lived(low),
        high=lived(high),
    )
    return replace(found, modified=modified)


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
            f"dynamic rating C; ISO 281 vouches for lives up to {MOST_LOAD:g} of it"
        )
    most = max(float(max(row.inner.max(), row.outer.max())) for row in rows)
    limit = STATIC_PRESSURE[data.balls]
    if most > limit:
        yield (
            f"a contact pressure of {most / 1e6:.0f} MPa is beyond the {limit / 1e6:.0f} MPa of its "
            "static rating (ISO 76)"
        )
