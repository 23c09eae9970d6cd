"""Kinds of rolling bearings: their nature, their usual inside, and the factor of their ratings.

A further kind of balls, rollers or barrels is its name in ``Kind`` of
:mod:`solidgear.bearings.catalogue` and an entry of ``SHARES``.  How makers write it is a line in
``_families`` of :mod:`solidgear.bearings.designation`, with a table of sizes in
:mod:`solidgear.bearings.plan` where none fits; keys that it refuses stand in ``_by_nature`` of the
catalogue, classes of clearance in ``TABLES`` of :mod:`solidgear.bearings.clearance`.  Other
elements need a row with ``load``, ``tangent`` and ``contacts`` of a motion
(:mod:`solidgear.bearings.row` says what holds of all) and its line in ``_row`` of
:mod:`solidgear.bearings.catalogued`.  A pair of bearings is the ``arrangement`` of the scene.
"""

from __future__ import annotations

import math
from typing import Literal, NamedTuple


class Share(NamedTuple):
    """Middle and half spread of a usual proportion."""

    middle: float
    spread: float


class Shares(NamedTuple):
    """Nature and usual inside of a kind, and the factor of the kind in its rating."""

    diameter: Share  #: element diameter over ``D - d``
    length: Share  #: effective roller length over width
    filling: Share  #: elements over those that would touch all around
    rating_factor: float  #: b_m of ISO 281:2007, Tables 1 and 6, for the steel and make of today
    angle: float = 0.0  #: contact angle where none is given, rad
    #: of it, relative.  Ball and tapered rows have none here: a steeper one is stiffer along y and
    #: softer across it.  Barrels stand so flat that only the former counts.
    angle_spread: float = 0.0
    #: groove radius over ball diameter, inner and outer: softer, middle (that of ISO 281's rating
    #: where it has one) and stiffer end; of spherical rollers over twice the radius of their
    #: contour
    conformity: tuple[tuple[float, float], ...] = ((0.53, 0.53), (0.52, 0.53), (0.515, 0.515))
    #: barrels, and balls on a sphere, let a ring tilt freely
    elements: Literal["balls", "rollers", "barrels"] = "rollers"
    #: along y, a single row of a kind with a contact angle, else the bearing
    holds: Literal["both ways", "one way", "nothing"] = "both ways"
    angled: bool = False  #: whether it has a contact angle that data may give
    rows: int = 1  #: of a single bearing
    #: of two rows: normals that meet in the middle of the bearing, both on the same elements, or
    #: rows side by side back to back
    placed: Literal["meeting", "crossing", "apart"] = "meeting"
    sphere: bool = False  #: whether the outer raceway is a sphere about the middle


NONE = Share(0.0, 0.0)
#: of rollers without a cage
FULL = Share(0.97, 0.02)
#: read off bearings whose inside is published, see :mod:`solidgear.bearings.geometry`; of two rows of
#: balls off the C and C0 of makers
SHARES = {
    "deep_groove": Shares(Share(0.30, 0.015), NONE, Share(0.66, 0.06), 1.3, elements="balls"),
    "angular_contact": Shares(
        Share(0.30, 0.02),
        NONE,
        Share(0.88, 0.05),
        1.3,
        angle=math.radians(40),
        elements="balls",
        holds="one way",
        angled=True,
    ),
    "double_row_angular": Shares(
        Share(0.30, 0.02),
        NONE,
        Share(0.66, 0.08),
        1.3,
        angle=math.radians(30),
        angle_spread=0.15,
        elements="balls",
        angled=True,
        rows=2,
        placed="apart",
    ),
    "four_point": Shares(
        Share(0.31, 0.015),
        NONE,
        Share(0.85, 0.05),
        1.3,
        angle=math.radians(35),
        elements="balls",
        angled=True,
        rows=2,
        placed="crossing",
    ),
    "self_aligning": Shares(
        Share(0.22, 0.02),
        NONE,
        Share(0.83, 0.05),
        1.3,
        angle=math.radians(10),
        angle_spread=0.15,
        conformity=((0.535, 0.535), (0.53, 0.53), (0.52, 0.52)),
        elements="balls",
        angled=True,
        rows=2,
        sphere=True,
    ),
    "cylindrical": Shares(
        Share(0.27, 0.015), Share(0.65, 0.08), Share(0.80, 0.06), 1.1, holds="nothing"
    ),
    "tapered": Shares(
        Share(0.245, 0.015),
        Share(0.70, 0.08),
        Share(0.92, 0.04),
        1.1,
        angle=math.radians(15),
        holds="one way",
        angled=True,
    ),
    "spherical": Shares(
        Share(0.255, 0.02),
        Share(0.36, 0.04),
        Share(0.85, 0.05),
        1.15,
        angle=math.radians(10),
        angle_spread=0.15,
        conformity=((0.515, 0.515), (0.51, 0.51), (0.5075, 0.5075)),
        elements="barrels",
        angled=True,
        rows=2,
    ),
    "thrust_ball": Shares(
        Share(0.36, 0.02),
        NONE,
        Share(0.89, 0.04),
        1.3,
        angle=math.radians(90),
        conformity=((0.545, 0.545), (0.54, 0.54), (0.525, 0.525)),
        elements="balls",
        holds="one way",
    ),
    "needle": Shares(Share(0.40, 0.05), Share(0.72, 0.08), Share(0.65, 0.10), 1.0, holds="nothing"),
}
