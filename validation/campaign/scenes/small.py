"""Seeded random shafts small enough for a dense solution: slender or short, solid or thin-walled, of
one or several materials, on bearings that are soft, stiff, coupled, partial or none.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from solidgear.core.errors import SceneError
from solidgear.core.scene import STEEL, Bearing, Material, Port, Scene, Segment

MATERIALS = (
    STEEL,
    Material(E=3e9, nu=0.4, density=1400.0),
    Material(E=1.14e11, nu=0.34, density=4430.0),
    Material(E=7e10, nu=0.33, density=2700.0),
    Material(E=1.6e10, nu=0.44, density=11340.0),
)


@dataclass(frozen=True)
class Small:
    """A scene, the model that is built of it, and how its modes are asked for."""

    scene: Scene
    model: str
    options: dict[str, Any]
    ask: dict[str, Any]


def small(seed: int, number: int) -> Small:
    """The case of a seed and a number."""
    rng = np.random.default_rng([seed, number])
    while True:
        try:
            scene = _scene(rng)
            break
        except SceneError:
            continue
    model = str(rng.choice(["euler", "timoshenko", "harmonic", "harmonic"]))
    beam = model != "harmonic"
    options = {"elements": int(rng.integers(4, 40))} if beam else _light(scene, rng)
    method = rng.choice([None, None, "lanczos", "arpack", "dense"])
    ask = {
        "n": int(rng.integers(1, 17)),
        "method": method,
        "count": bool(rng.random() < 0.5),
        "coupling_tolerance": float(rng.choice([0.0, 1e-6])),
    }
    return Small(scene, model, options, ask)


def _log(rng, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def _scene(rng) -> Scene:
    radius = _log(rng, 0.005, 0.2)
    slenderness = _log(rng, 0.3, 80.0 if rng.random() < 0.8 else 300.0)
    length = 2 * radius * slenderness
    count = int(rng.integers(1, 6))
    cuts = np.sort(rng.uniform(0.1, 0.9, count - 1))
    ends = length * np.concatenate([[0.0], cuts, [1.0]])
    parts = _segments(rng, radius, ends)
    chosen = rng.permutation(count)[: rng.integers(0, 4)]
    bearings = [_bearing(rng, radius, int(k), ends[k], ends[k + 1]) for k in chosen]
    k = int(rng.integers(count))
    tie = str(rng.choice(["average", "section"]))
    port = Port(y=(ends[k] + ends[k + 1]) / 2, lo=ends[k], hi=ends[k + 1], attachment=tie)
    housing = _log(rng, 1e5, 1e10) if rng.random() < 0.15 else None
    return Scene.from_parts(parts, bearings=bearings, port=port, housing_axial=housing)


def _segments(rng, radius: float, ends: np.ndarray) -> list[Segment]:
    wall = rng.choice([1.0, 1.0, _log(rng, 0.01, 0.6)])
    several = rng.random() < 0.35
    base = MATERIALS[rng.integers(len(MATERIALS))]
    parts: list[Segment] = []
    before = radius * rng.uniform(0.6, 1.0)
    even = rng.random() < 0.4
    for k, (a, b) in enumerate(zip(ends, ends[1:])):
        outer0 = before if even or rng.random() < 0.3 else radius * rng.uniform(0.6, 1.4)
        outer1 = radius * rng.uniform(0.6, 1.4) if rng.random() < 0.2 else outer0
        bore = 0.0 if wall == 1.0 else (1 - wall) * min(outer0, outer1, before)
        material = MATERIALS[rng.integers(len(MATERIALS))] if several else base
        radii = {"outer0": outer0, "outer1": outer1, "inner0": bore, "inner1": bore}
        parts.append(Segment(name=f"s{k}", y0=a, y1=b, material=material, **radii))
        before = outer1
    return parts


def _bearing(rng, radius: float, k: int, a: float, b: float) -> Bearing:
    width = (b - a) * rng.uniform(0.1, 0.6)
    y = rng.uniform(a + width / 2, b - width / 2)
    attachment = str(rng.choice(["average", "average", "rigid", "section"]))
    series = (_log(rng, 1e5, 1e10),) if rng.random() < 0.2 else ()
    matrix = _springs(rng, radius)
    told = {"matrix": matrix, "axial_series": series, "attachment": attachment}
    return Bearing(name=f"b{k}", y=y, seat_width=width, **told)


def _springs(rng, radius: float) -> np.ndarray:
    """(6, 6), soft to stiff: alike in both planes or not, radial only, or coupled without mercy."""
    size = _log(rng, *((1e3, 1e12) if rng.random() < 0.8 else (1.0, 1e16)))
    lever = np.repeat([1.0, radius * rng.uniform(0.2, 2.0)], 3)
    kind = rng.choice(["alike", "alike", "uneven", "radial", "coupled", "one"])
    if kind == "coupled":
        root = rng.standard_normal((6, int(rng.integers(2, 8)))) * lever[:, None]
        return size * root @ root.T
    d = np.exp(rng.uniform(-3, 1, 6))
    if kind == "alike":
        d[0], d[3] = d[2], d[5]
    if kind == "radial":
        d[[1, 3, 4, 5]] = 0.0
    if kind == "one":
        d[np.arange(6) != rng.integers(6)] = 0.0
    d[4] *= rng.random() < 0.3
    return np.diag(size * d * lever**2)


def _light(scene: Scene, rng) -> dict[str, Any]:
    """Options of a harmonic solid of few cells."""
    order = int(rng.integers(1, 4))
    thick = max(max(s.outer0, s.outer1) for s in scene.segments)
    return {
        "order": order,
        "layers": int(rng.integers(0, 2)),
        "edge_layers": 0,
        "size": max(scene.length / (14 // order), thick / 2),
    }
