"""Mass that features take from a shaft, by counting points: nothing here is known of any mesh."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.stats import qmc

#: points a segment, as a power of two
POINTS = 18


def removed_mass(scene: Any) -> np.ndarray:
    """(6, 6) rigid mass matrix about the start of the shaft of all that is cut out of it, SI; teeth
    are not counted.
    """
    total = np.zeros((6, 6))
    cuts = [f for f in scene.features if f.kind in ("keyway", "flat", "cross_hole", "bolt_circle")]
    for s in scene.segments:
        own = [f for f in cuts if f.segment == s.name]
        if not own:
            continue
        ends = [f.span(scene.segments) for f in own]
        lo, hi = min(a for a, _ in ends), max(b for _, b in ends)
        u = qmc.Sobol(3, seed=1).random(2**POINTS)
        y = lo + (hi - lo) * u[:, 0]
        t = (y - s.y0) / s.length
        outer, inner = (a + (b - a) * t for a, b in ((s.outer0, s.outer1), (s.inner0, s.inner1)))
        r = np.sqrt(inner**2 + (outer**2 - inner**2) * u[:, 1])
        turn = 2 * math.pi * u[:, 2]
        # every point stands for as much as its section is large
        weight = s.material.density * math.pi * (outer**2 - inner**2) * (hi - lo) / len(y)
        x, z = r * np.sin(turn), r * np.cos(turn)
        gone = np.any([_inside(f, x, y, z, scene) for f in own], axis=0)
        total += _rigid_mass(x[gone], y[gone], z[gone], weight[gone])
    return total


def _inside(f: Any, x, y, z, scene: Any) -> np.ndarray:
    here = next(s for s in scene.segments if s.name == f.segment)
    up = x * math.sin(f.angle) + z * math.cos(f.angle)
    across = x * math.cos(f.angle) - z * math.sin(f.angle)
    lo, hi = f.span(scene.segments)
    along = (y >= lo) & (y <= hi)
    if f.kind == "cross_hole":
        beside = (y - f.y) * math.cos(f.inclination) - up * math.sin(f.inclination)
        return (across - f.offset) ** 2 + beside**2 < f.diameter**2 / 4
    if f.kind == "bolt_circle":
        lo, hi = f.reach(here)
        angle = f.angle + 2 * math.pi * np.arange(f.count) / f.count
        cx, cz = f.circle / 2 * np.sin(angle), f.circle / 2 * np.cos(angle)
        near = (x[:, None] - cx) ** 2 + (z[:, None] - cz) ** 2 < f.diameter**2 / 4
        return near.any(axis=1) & (y >= lo) & (y <= hi)
    deep = along & (up > here.outer0 - f.depth)
    if f.kind == "flat":
        return deep
    half = f.width / 2
    if f.ends == "square":
        return deep & (np.abs(across) < half)
    nearest = np.clip(y, lo + half, hi - half)
    return deep & (across**2 + (y - nearest) ** 2 < half**2)


def _rigid_mass(x, y, z, weight) -> np.ndarray:
    """Of points: motions along x y z, turns about x y z."""
    zero, one = np.zeros_like(x), np.ones_like(x)
    # a turn about one axis moves a point by the cross product
    rows = np.array(
        [
            [one, zero, zero, zero, z, -y],
            [zero, one, zero, -z, zero, x],
            [zero, zero, one, y, -x, zero],
        ]
    )
    return np.einsum("kin,kjn,n->ij", rows, rows, weight)


def _chords(p, q) -> list[tuple[float, float]]:
    """Corners of the fewest chords of an odd number, none above 0.15 rad, from p to q on a circle."""
    radius, (start, end) = math.hypot(*p), (math.atan2(*p), math.atan2(*q))
    count = next(n for n in range(1, 99, 2) if (end - start) / n <= 0.15)
    angles = [start + (end - start) * k / count for k in range(count + 1)]
    return [(radius * math.sin(t), radius * math.cos(t)) for t in angles]


def toothed_area(teeth: Any) -> tuple[float, float]:
    """Area and polar moment of a toothed section of unit pitch radius, from the definition of its
    trapezoids.
    """
    pitch = 2 * math.pi / teeth.count
    half = pitch * teeth.half_thickness
    start = np.array([math.sin(half), math.cos(half)])
    along = np.array([-math.tan(teeth.flank_angle), 1.0])
    corners = []
    for radius in (1 - 2 * teeth.dedendum / teeth.count, 1 + 2 * teeth.addendum / teeth.count):
        a, b, c = along @ along, start @ along, start @ start - radius**2
        corners.append(start + (-b + math.sqrt(b * b - a * c)) / a * along)
    (x0, z0), (x1, z1) = corners
    c, s = math.cos(pitch), math.sin(pitch)
    after = (c * -x0 + s * z0, c * z0 - s * -x0)  # the root of the next tooth
    points = np.array([(-x0, z0), *_chords((-x1, z1), (x1, z1)), *_chords((x0, z0), after)])
    p, q = points[:-1], points[1:]
    twice = p[:, 1] * q[:, 0] - p[:, 0] * q[:, 1]
    square = (p * p).sum(axis=1) + (q * q).sum(axis=1) + (p * q).sum(axis=1)
    return teeth.count * twice.sum() / 2, teeth.count * (twice * square).sum() / 12
