"""Lives of the catalogue bearings of a scene, with their ranges by unknown inner dimensions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from solidgear.bearings.catalogue import catalogue_of
from solidgear.bearings.catalogued import Catalogued, End
from solidgear.bearings.life import Life, life
from solidgear.bearings.solved import AS_STATED, Choice, solved
from solidgear.core import Bearing, Body, Scene
from solidgear.core.scene import Lubrication

#: a bearing and the motion (6,) of its inner ring
Place = tuple[Catalogued, np.ndarray]


@dataclass(frozen=True)
class BearingLife:
    """Life of one bearing, and its range."""

    name: str
    life: Life  #: at the middle of the unknown data
    speed: float  #: rad/s; 0 where none is known
    #: names of unknown data of this bearing and of those that share the load; empty if all are known
    told: str
    ends: tuple[Life, ...]  #: at all corners of the unknown data

    def range(self, kind: str) -> tuple[float, float]:
        """Return the least and largest life, revolutions, ``basic``, ``reference`` or ``modified``
        (that also over the cleanliness that a word means); equal where everything is known.
        """
        lives = [value for life in (self.life, *self.ends) for value in _lives(life, kind)]
        return min(lives), max(lives)


def _lives(bearing_life: Life, kind: str) -> tuple[float, ...]:
    if kind != "modified":
        return (getattr(bearing_life, kind),)
    return (bearing_life.modified.low, bearing_life.modified.high) if bearing_life.modified else ()


def bearing_lives(
    scene: Scene, body: Body | None = None, speed: float | None = None
) -> list[BearingLife]:
    """Compute the life of every catalogue bearing of a scene at its load; `body` is the shaft, needed
    where bearings settle under the load, and `speed` that of the shaft, rad/s, in place of the speeds
    of bearings and lubrication.

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/gearbox_catalogue.toml")
    >>> lives = bearing_lives(scene, sg.build(scene, "timoshenko"))
    >>> [(bearing.name, round(bearing.life.basic / 1e9, 1)) for bearing in lives]
    [('A', 13.8), ('B', 23.1)]
    """
    label, choices = left_open([scene])
    states = [solved(scene, body, choice) for choice in (AS_STATED, *choices)]
    return [
        life_of(
            bearing,
            scene.lubrication,
            label,
            speed,
            [(state.made[bearing.name], state.motion[bearing.name]) for state in states],
        )
        for bearing in scene.bearings
        if bearing.catalogue is not None
    ]


def left_open(scenes: Iterable[Scene]) -> tuple[str, list[Choice]]:
    """Return the names of unknown data of the bearings of scenes that share their loads, empty where
    all are known, and the corners of their ranges.

    Examples
    --------
    >>> import solidgear as sg
    >>> label, corners = left_open([sg.load("geometry/gearbox_catalogue.toml")])
    >>> label, len(corners)
    ('estimated insides and clearance classes', 4)
    """
    data = [d for scene in scenes for b in scene.bearings if (d := catalogue_of(b)) is not None]
    estimated = any(catalogue.estimated for catalogue in data)
    by_class = any(isinstance(catalogue.clearance, str) for catalogue in data)
    insides: tuple[End, ...] = ("softer", "stiffer") if estimated else ("middle",)
    places = (0.0, 1.0) if by_class else (0.5,)
    corners = [Choice(end, place) for end in insides for place in places]
    names = {"estimated insides": estimated, "clearance classes": by_class}
    label = " and ".join(name for name, unknown in names.items() if unknown)
    return label, [corner for corner in corners if corner != AS_STATED]


def life_of(
    bearing: Bearing,
    oil: Lubrication | None,
    label: str,
    speed: float | None,
    places: Sequence[Place],
) -> BearingLife:
    """Compute the life of a catalogue bearing from its places: the bearing and the motion of its
    inner ring, at the middle and at the corners of the unknown data; a speed of the shaft, rad/s,
    replaces that of the bearing or lubrication.
    """
    data = catalogue_of(bearing)
    assert data is not None
    turns = speed or data.speed or (oil.speed if oil else None) or 0.0
    lives = [life(data, rows, motion, oil, turns) for rows, motion in places]
    return BearingLife(bearing.name, lives[0], turns, label, tuple(lives[1:]))
