"""Designs drawn from ranges of what the source leaves out, and in how many of them its claims hold."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import radians

import numpy as np

from solidgear.core.errors import SolidgearError
from validation.reducer.design import ACROSS, Design

#: pinion, wheel, sun, planet, ring: those that three planets assemble with at a ratio of ten
SETS = ((15, 25, 17, 34, 85), (15, 45, 36, 24, 84))
RATIO = 10.0
SEED, COUNT = 2025, 200
#: assumed, SI
RANGES: dict[str, tuple[float, float]] = {
    "torque": (2.0, 8.0),
    "module": (1.0e-3, 1.75e-3),
    "wheel": (50e-3, 85e-3),
    "spiral": (0.0, radians(35)),
    "rows": (15e-3, 30e-3),
    "preload": (50.0, 400.0),
    "beside_wheel": (3e-3, 15e-3),
    "beside_sun": (3e-3, 15e-3),
    "to_third": (12e-3, 25e-3),
    "clearance": (0.0, 15e-6),
    "sun_mesh": (1e8, 4e8),
    "ring_mesh": (1e8, 4e8),
    "pin": (2e7, 2e8),
}
CHOICES: dict[str, tuple] = {
    "teeth": SETS,
    "hand": ("left", "right"),
    "pair": ("7201 B", "7202 B", "7203 B", "7204 B"),
    "overhung": (False, True),
    "third": ("BK0810", "BK1010", "BK1210"),
}
#: of the mean force: a modulation that counts as one
SEEN = 0.05
#: of the modulation on two bearings: what most of it being gone leaves
MOST = 0.5
#: relative, of torques that balance
BALANCED = 1e-10


@dataclass(frozen=True)
class Outcome:
    """One design: mean mesh force, and its amplitude at the carrier's frequency on two bearings, on
    three, on three without clearance, and on three as foretold from two, N.

    Attributes
    ----------
    reached : float
        Clearance of the third bearing over what its place moves without it.
    """

    design: Design
    balanced: bool
    mean: float
    two: float
    three: float
    tight: float
    foretold: float
    reached: float


def outcome(design: Design) -> Outcome:
    """A design solved."""
    turn = design.settled_turn(False)
    torque = turn.torque["carrier"] * design.teeth[1] / design.teeth[0]
    ratio = turn.torque["carrier"] / design.torque
    shares = abs(turn.sun_mesh.mean(axis=0) / design.mean_force - 1)
    left = abs(sum(turn.torque.values())) / abs(torque)
    moved = float(np.linalg.norm(design.settled(False).motion["third"][ACROSS]))
    worst = max(left.max(), shares.max(), abs(ratio / RATIO - 1).max())
    return Outcome(
        design,
        bool(worst < BALANCED),
        design.mean_force,
        design.modulation(False),
        design.modulation(True),
        replace(design, clearance=0.0).modulation(True),
        design.foretold(),
        design.clearance / moved,
    )


def drawn(seed: int = SEED, count: int = COUNT) -> list[Design]:
    """Designs by a seed."""
    draw = np.random.default_rng(seed)
    out = []
    for _ in range(count):
        numbers = {name: float(draw.uniform(*ends)) for name, ends in RANGES.items()}
        words = {name: some[draw.integers(len(some))] for name, some in CHOICES.items()}
        out.append(Design(**numbers, **words))
    return out


def outcomes(
    designs: list[Design], progress: Callable[[int], None] = lambda done: None
) -> tuple[list[Outcome], list[str]]:
    """Outcomes of designs, and what was said of those that cannot be."""
    found, refused = [], []
    for done, design in enumerate(designs, 1):
        try:
            found.append(outcome(design))
        except SolidgearError as error:
            refused.append(str(error))
        progress(done)
    return found, refused


def speeds(teeth: tuple[int, ...], rpm: float) -> dict[str, float]:
    """Frequencies at a speed of the pinion, Hz."""
    design = Design(teeth=teeth)
    shaft = rpm / 60
    sun = shaft * teeth[0] / teeth[1]
    return {
        "shaft": shaft,
        "bevel mesh": shaft * teeth[0],
        "planetary mesh": design.planetary.mesh_frequency(sun),
        "carrier": sun / design.planetary.speed_ratio,
        "ratio": teeth[1] / teeth[0] * design.planetary.speed_ratio,
    }
