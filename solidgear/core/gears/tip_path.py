r"""Tips of one wheel in the spaces of its mate: how deep their corners cut, and which tips fit.

While both flanks touch, the wheel of the tip turns by ``q`` where its mate turns by 1, and ``theta =
psi + q delta`` is the angle of the corner from the line of centres, zero at delta with the flanks in
the pitch point: ``psi = half_angle(r_w) - half_angle(r_a)`` on its own wheel.  In the frame of the mate,
whose centre lies at the distance a from that of the tip, the corner of an external wheel stands at

    x = r_a sin theta,    y = a - r_a cos theta,

turned back by delta (of a ring, or inside one, the signs of y change).  There it is held against fillet,
root and flank as they are, of the fillet the trochoid itself: a tip that passes the end of a flank may
pass an undercut one freely, and cuts where the flank ends on its fillet (Litvin and Fuentes, Gear
Geometry and Applied Theory, 2004, 6.7).  Flanks count as involutes.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from math import cos

import numpy as np

from solidgear.core.gears.wheel import Wheel
from solidgear.core.gears.wheel_pair import WheelPair

#: points of the path of a corner, and of each part of the profile
PATH, PROFILE = 400, 300
#: modules that a tip may cut by and fit: what so many points leave open
FINE = 1e-4
#: halvings of the height between a tip that cuts and one that fits
HALVINGS = 24


@lru_cache(maxsize=256)
def cut_depth(pair: WheelPair, k: int) -> float:
    """Return how deep tips of the first (k = 0) or the second wheel cut into the other, normal to its
    surface, m; 0 where they pass.

    Examples
    --------
    A tip at the depth of the root cuts into the fillet; a usual one passes.

    >>> usual, long = Wheel(57, 3e-3), Wheel(57, 3e-3, tip_radius=89.25e-3)
    >>> [round(1e6 * cut_depth(WheelPair(Wheel(20, 3e-3), wheel), 1), 1) for wheel in (usual, long)]
    [0.0, 170.9]
    """
    tips, wheel = (pair.first, pair.second)[k], (pair.second, pair.first)[k]
    points = _corner_path(pair, k)
    radii, angles = np.hypot(*points.T), np.abs(np.arctan2(*points.T))
    boundary = _profile(wheel)
    # without the arc of the root, along which the radius does not grow
    sides = boundary[: 2 * PROFILE]
    order = np.argsort(np.hypot(*sides.T))
    half = np.interp(radii, np.hypot(*sides.T)[order], np.arctan2(*sides.T)[order])
    inside = (angles < half) | (wheel.sign * (wheel.root - radii) > 0)
    if not inside.any() or tips.tip <= 0:
        return 0.0
    return float(_distance(points[inside], boundary).max())


def largest_tip(pair: WheelPair, k: int) -> float | None:
    """Return the radius of tips of the first or the second wheel that reach furthest and do not cut,
    m; None where none do.
    """
    wheel, reference = (pair.first, pair.second)[k], _working_radius(pair, k)

    def cuts(tip: float) -> bool:
        wheels = [pair.first, pair.second]
        wheels[k] = replace(wheel, tip_radius=tip)
        shorter = replace(pair, first=wheels[0], second=wheels[1])
        return cut_depth(shorter, k) > FINE * wheel.module

    if cuts(reference):
        return None
    fits, deep = reference, wheel.tip
    for _ in range(HALVINGS):
        middle = (fits + deep) / 2
        fits, deep = (fits, middle) if cuts(middle) else (middle, deep)
    return fits


def _working_radius(pair: WheelPair, k: int) -> float:
    """Return the radius on which a wheel rolls, m."""
    return (pair.first, pair.second)[k].base / cos(pair.working_angle)


def _corner_path(pair: WheelPair, k: int) -> np.ndarray:
    """Return the (n, 2) points of the corner of a tip within the teeth of the other wheel, in the frame
    of that wheel's tooth 0.
    """
    tips, wheel = (pair.first, pair.second)[k], (pair.second, pair.first)[k]
    rolling, mate = _working_radius(pair, k), _working_radius(pair, 1 - k)
    inner = pair.second.sign < 0
    # centre of the tips from that of the mate, and which way a tip points along the line of centres
    centre = pair.distance * (-1 if inner and k == 1 else 1)
    out = 1 if inner else -1
    facing = (wheel.tip**2 - centre**2 - tips.tip**2) / (2 * centre * out * tips.tip)
    furthest = float(np.arccos(np.clip(facing, -1.0, 1.0)))
    theta = np.linspace(-furthest, furthest, PATH)
    corner = float(tips.half_angle(rolling) - tips.half_angle(tips.tip))
    delta = (theta - corner) * rolling / mate
    x, y = tips.tip * np.sin(theta), centre + out * tips.tip * np.cos(theta)
    angle = np.arctan2(x, y) + float(wheel.half_angle(mate)) - delta
    r = np.hypot(x, y)
    return np.column_stack([r * np.sin(angle), r * np.cos(angle)])


def _profile(wheel: Wheel) -> np.ndarray:
    """Return the (n, 2) points of the right side of tooth 0: flank from its tip, fillet, root."""
    flank, _ = wheel.flank_points(np.linspace(wheel.tip, wheel.form, PROFILE))
    fillet = wheel.fillet(PROFILE)[::-1]
    last = float(np.arctan2(*fillet[-1]))
    angles = np.linspace(last, wheel.pitch_angle - last, PROFILE)
    root = wheel.root * np.column_stack([np.sin(angles), np.cos(angles)])
    return np.vstack([flank, fillet, root])


def _distance(points: np.ndarray, line: np.ndarray) -> np.ndarray:
    """Return the distances of points from a line of straight pieces, m."""
    start, step = line[:-1], np.diff(line, axis=0)
    length = np.maximum((step**2).sum(axis=1), np.finfo(float).tiny)
    away = points[:, None] - start
    share = np.clip((away * step).sum(axis=2) / length, 0.0, 1.0)
    foot = away - share[..., None] * step
    return np.sqrt((foot**2).sum(axis=2).min(axis=1))
