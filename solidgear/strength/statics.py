"""Statics of a shaft alone: what acts on it, what its bearings carry, and the torque along it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from solidgear.core import Scene
from solidgear.core.frames import shift
from solidgear.strength.load import LoadsAlone

#: of the largest torque: what is less is rounding
NOTHING = 1e-9


class Stretch(NamedTuple):
    """Piece of a shaft with one torque."""

    start: float  #: m
    end: float  #: m
    torque: float  #: of the part beyond a section on the part before it, about +y, N m


@dataclass(frozen=True)
class Statics:
    """Equilibrium of the loads of a shaft with the reactions of its bearings, about y = 0."""

    loads: np.ndarray  #: (6,) resultant of all loads, N and N m
    reactions: np.ndarray  #: (6,) resultant of all bearings on the shaft, N and N m
    #: largest component of their sum, over the sum of the sizes of all forces; moments count by the
    #: length of the shaft
    imbalance: float
    torque: tuple[Stretch, ...]  #: along the shaft


def statics(scene: Scene, loads: LoadsAlone, carried: Mapping[str, np.ndarray]) -> Statics:
    """Return the statics of a shaft alone, by the loads (6,) of the shaft on its bearings.

    Examples
    --------
    >>> import numpy as np
    >>> import solidgear as sg
    >>> from solidgear.strength.load import loads_alone
    >>> scene = sg.Scene.from_parts(
    ...     [sg.Segment.cylinder("rod", length=0.2, diameter=0.03)],
    ...     bearings=[sg.Bearing(name="A", y=0.1, seat_width=0.02, hold="clamped")],
    ...     loads=[sg.ShaftLoad(name="hub", position=0.19, seat_width=0.01, x=100.0, torque=5.0)],
    ... )
    >>> held = np.array([100.0, 0.0, 0.0, 0.0, 5.0, -9.0])
    >>> found = statics(scene, loads_alone(sg.Train.of(scene)), {"A": held})
    >>> found.imbalance, [(round(s.start, 3), round(s.end, 3), s.torque) for s in found.torque]
    (0.0, [(0.1, 0.19, 5.0)])
    """
    places = {station.name: station.y for station in scene.stations}
    rows = [(load.y, load.six) for load in loads.acting]
    reactions = [(places[name], -np.asarray(load)) for name, load in carried.items()]
    all_rows = [*rows, *reactions]
    acting, reacting = _about_start(rows), _about_start(reactions)
    moved = [np.abs(_about_start([row])) for row in all_rows]
    forces, moments = sum(moved, np.zeros(6)).reshape(2, 3).sum(axis=1)
    # moments count by the length of the shaft
    size = max(forces, moments / scene.length) * np.repeat([1.0, scene.length], 3)
    remainder = np.abs(acting + reacting)
    return Statics(
        acting,
        reacting,
        float((remainder / size).max()) if size.any() else 0.0,
        tuple(_torque_line([(y, float(six[4])) for y, six in all_rows])),
    )


def _about_start(rows: list[tuple[float, np.ndarray]]) -> np.ndarray:
    """Return the resultant (6,) of loads about y = 0."""
    return sum((shift([0.0, y, 0.0]).T @ six for y, six in rows), np.zeros(6))


def _torque_line(torques: list[tuple[float, float]]) -> Iterator[Stretch]:
    """Yield pieces of a shaft between torques, N m, at places, m, without those that carry none."""
    places = sorted({y for y, torque in torques if torque})
    least = NOTHING * max((abs(torque) for _, torque in torques), default=0.0)
    for start, end in zip(places, places[1:]):
        torque = -sum(value for y, value in torques if y <= start)
        if abs(torque) > least:
            yield Stretch(start, end, torque)
