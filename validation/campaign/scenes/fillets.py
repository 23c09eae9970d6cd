"""Seeded shafts with one filleted shoulder, and steps, cones and bores around it."""

from __future__ import annotations

import numpy as np

from solidgear.core.errors import SceneError
from solidgear.core.scene import Fillet, Material, Port, Scene, Segment
from validation.campaign.scenes.shafts import TRIES, between

#: of the fillet of every scene
NAME = "fillet"
DIAMETER = 0.04


def filleted_shoulder(seed: int) -> Scene:
    """A shaft whose shoulder has D/d from 1.04 to 2.2 and r/d from 0.008 to 0.3; half of them with
    another step or a cone near by, a third hollow, and every other one turned around.
    """
    for attempt in range(TRIES):
        rng = np.random.default_rng([seed, 5, attempt])
        try:
            return _draw(rng)
        except SceneError:
            continue
    raise ValueError(f"no valid shoulder in {TRIES} draws from seed {seed}")


def _draw(rng: np.random.Generator) -> Scene:
    small = DIAMETER
    large = small * (1 + between(rng, 0.04, 1.2))
    radius = min(between(rng, 0.008, 0.3) * small, 0.45 * (large - small))
    bore = small * float(rng.choice([0.0, 0.0, rng.uniform(0.1, 0.8)]))
    material = Material(E=2.1e11, nu=float(rng.choice([0.3, 0.3, 0.25, 0.33])), density=7850.0)
    # from the end with the small diameter: length, and diameters at both ends
    pieces = [(max(between(rng, 1.0, 5.0) * small, 2.2 * radius), small, small)]
    end = large * rng.uniform(0.7, 1.5) if rng.random() < 0.3 else large
    pieces.append((between(rng, 0.2, 5.0) * large, large, end))
    if rng.random() < 0.6:
        further = large * rng.uniform(0.6, 1.3)
        pieces.append((2 * large, further, further))
    before = rng.random() < 0.3
    if before:
        first = small * rng.uniform(0.6, 1.4)
        pieces.insert(0, (0.05, first, first))
    places = np.concatenate([[0.0], np.cumsum([piece[0] for piece in pieces])])
    at = places[2 if before else 1]
    turned = rng.random() < 0.5
    if turned:
        pieces = [(length, b, a) for length, a, b in reversed(pieces)]
        at = places[-1] - at
        places = places[-1] - places[::-1]
    segments = [
        Segment.cone(
            f"part {k}",
            y0=round(float(y), 9),
            length=length,
            start_diameter=a,
            end_diameter=b,
            bore=bore,
            material=material,
        )
        for k, (y, (length, a, b)) in enumerate(zip(places, pieces))
    ]
    tip = segments[-1].y1
    port = Port(y=tip, lo=tip - 1e-4, hi=tip)
    fillet = Fillet(name=NAME, y=float(at), radius=radius)
    return Scene.from_parts(segments, port=port, blends=[fillet])
