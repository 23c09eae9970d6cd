"""Claims in time: all drawn designs as bodies in contact, on ideal joints, two bearings and three."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from solidgear.core.frames import shift
from validation.reducer.design import HUB, Design
from validation.reducer.multibody import ORDERS, Reducer
from validation.reducer.stepping import Motion, run, together

#: steps in a turn of the carrier, and of these one in so many is kept
STEPS, EVERY = 8192, 8
#: m; assumed runout of the pinion, of quality 6 or so
RUNOUT = 5e-6


@dataclass(frozen=True, eq=False)
class Seen:
    """Outcomes of designs (b,), forces in N, lengths in m.

    Attributes
    ----------
    mean, statics : ndarray
        Mesh force of a planet, over a turn and by statics.
    external, internal : ndarray
        Largest force of a planet on sun and ring.
    closed, carrier, mesh : ndarray
        Amplitude of the mesh with the sun at the carrier's frequency, by the closed form and in time;
        and of all lines at mesh frequencies and their multiples, the root of the sum of squares.
    swing : ndarray
        Half of what the mesh with the sun varies over a turn.
    foreign : ndarray
        Share of the variance of the mesh with the sun at no multiple of a mesh frequency.
    apart : ndarray
        Whether teeth of a planet part.
    near, far : (2, b) ndarray
        Ends of the input shaft, that of the mesh first: mean shift and root mean square of the rest.
    shaft, bevel : ndarray
        Amplitudes at the frequency of the input shaft, of its mesh end and of the bevel force.
    unbalanced : ndarray
        Energy lost sight of, relative.
    """

    mean: np.ndarray
    statics: np.ndarray
    external: np.ndarray
    internal: np.ndarray
    closed: np.ndarray
    carrier: np.ndarray
    mesh: np.ndarray
    swing: np.ndarray
    foreign: np.ndarray
    apart: np.ndarray
    near: np.ndarray
    far: np.ndarray
    shaft: np.ndarray
    bevel: np.ndarray
    unbalanced: np.ndarray


def amplitudes(values: np.ndarray) -> np.ndarray:
    """(t / 2 + 1, ...) amplitudes of a turn by multiples of the carrier's frequency."""
    out = np.abs(np.fft.rfft(values, axis=0)) / len(values)
    out[1:] *= 2
    return out


def moved(
    designs: list[Design],
    bearings: int,
    runout: float = 0.0,
    progress: Callable[[float], None] = lambda share: None,
) -> tuple[list[Reducer], Motion]:
    """Designs over one turn of the carrier, after two others."""
    some = [Reducer(design, bearings, runout=runout) for design in designs]
    bodies = together([one.bodies for one in some])
    return some, run(bodies, STEPS, every=EVERY, progress=progress)


def seen(some: list[Reducer], motion: Motion) -> Seen:
    """What designs did."""
    force, b = motion.force, np.arange(len(some))
    sun, ring = force[:, :, 1:4], force[:, :, 4:7]
    lines = np.sqrt((amplitudes(sun) ** 2).mean(axis=2))
    mesh = [
        n * np.array([one.orders[name] for one in some])
        for name in ("planetary", "bevel")
        for n in range(1, ORDERS + 1)
    ]
    own = np.array([lines[order, b] for order in mesh])
    # multiples beyond those that excite count as mesh lines too
    every = [
        np.isin(
            np.arange(len(lines)),
            [n * one.orders[name] for name in ("planetary", "bevel") for n in range(1, 7)],
        )
        for one in some
    ]
    power = lines[1:] ** 2
    foreign = 1 - (power * np.array(every).T[1:]).sum(axis=0) / power.sum(axis=0)
    ends = np.zeros((2, 2, len(some)))
    at_shaft = np.zeros(len(some))
    if some[0].bearings:
        for k, one in enumerate(some):
            middle = one.moved("input.pinion", motion.place[:, k])
            length = one.input_shaft.length
            for side, y in enumerate((-HUB / 2, length - HUB / 2)):
                path = (middle @ shift(np.array([0.0, y, 0.0])).T)[:, [0, 2]]
                ends[side, :, k] = (
                    np.linalg.norm(path.mean(axis=0)),
                    np.sqrt(path.var(axis=0).sum()),
                )
                if side == 0:
                    at_shaft[k] = np.linalg.norm(amplitudes(path)[one.orders["shaft"]])
    return Seen(
        sun.mean(axis=(0, 2)),
        np.array([one.given.mean_force for one in some]),
        sun.max(axis=(0, 2)),
        ring.max(axis=(0, 2)),
        np.array([one.bearings and one.design.modulation(one.bearings == 3) for one in some]),
        lines[1],
        np.sqrt((own**2).sum(axis=0)),
        np.ptp(sun, axis=0).max(axis=1) / 2,
        foreign,
        force[:, :, 1:].min(axis=(0, 2)) <= 0,
        ends[0],
        ends[1],
        at_shaft,
        np.array([amplitudes(force[:, k, 0])[one.orders["shaft"]] for k, one in enumerate(some)]),
        motion.unbalanced,
    )


#: name: bearings, and runout of the pinion
VARIANTS = {
    "ideal": (0, 0.0),
    "two": (2, 0.0),
    "three": (3, 0.0),
    "two, runout": (2, RUNOUT),
    "ideal, runout": (0, RUNOUT),
}


def campaign(
    designs: list[Design], progress: Callable[[str, float], None] = lambda name, share: None
) -> dict[str, Seen]:
    """All variants of all designs."""
    return {
        name: seen(*moved(designs, *given, progress=lambda share, name=name: progress(name, share)))
        for name, given in VARIANTS.items()
    }
