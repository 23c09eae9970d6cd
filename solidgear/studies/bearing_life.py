"""Lives of the catalogue bearings of a scene, with what their unknown insides leave open."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from solidgear.bearings.catalogued import Catalogued, End
from solidgear.bearings.life import Life, life
from solidgear.bearings.solved import AS_TOLD, Choice, Solved, solved
from solidgear.body import Body
from solidgear.scene import Bearing, Lubrication, Scene

#: a bearing and the motion of its inner ring
Place = tuple[Catalogued, np.ndarray]


@dataclass(frozen=True)
class BearingLife:
    """Life of one bearing, and its range."""

    name: str
    life: Life  #: at the middle of what is not known
    speed: float  #: rad/s; 0 where none is known
    #: what is not known of this bearing or of those that share the load; empty where all is
    told: str
    ends: tuple[Life, ...]  #: at the ends of that, each with the other

    def range(self, kind: str) -> tuple[float, float]:
        """Least and largest life, revolutions, ``basic``, ``reference`` or ``modified`` (that also
        over the cleanliness that a word means); equal where everything is known.
        """
        found = [end for one in (self.life, *self.ends) for end in _lives(one, kind)]
        return min(found), max(found)


def _lives(one: Life, kind: str) -> tuple[float, ...]:
    if kind != "modified":
        return (getattr(one, kind),)
    return (one.modified.low, one.modified.high) if one.modified else ()


def bearing_lives(
    scene: Scene, body: Body | None = None, speed: float | None = None
) -> list[BearingLife]:
    """Life of every catalogue bearing of a scene at its load; `body` is the shaft, where they wait
    for its load, and `speed` its own, rad/s, in place of that of the bearings or of the
    lubrication.

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/gearbox_catalogue.toml")
    >>> found = bearing_lives(scene, sg.build(scene, "timoshenko"))
    >>> [(one.name, round(one.life.basic / 1e9, 1)) for one in found]
    [('A', 13.8), ('B', 23.1)]
    """
    told, choices = left_open([scene])
    found = [solved(scene, body, choice) for choice in (AS_TOLD, *choices)]
    return [
        life_of(bearing, scene.lubrication, told, speed, [_place(one, bearing) for one in found])
        for bearing in scene.bearings
        if bearing.catalogue is not None
    ]


def _place(found: Solved, bearing: Bearing) -> Place:
    return found.made[bearing.name], found.motion[bearing.name]


def left_open(scenes: Iterable[Scene]) -> tuple[str, list[Choice]]:
    """Words on what data leave open of the bearings of scenes that share their loads, empty where
    all is known, and the corners of that.

    Examples
    --------
    >>> import solidgear as sg
    >>> told, corners = left_open([sg.load("geometry/gearbox_catalogue.toml")])
    >>> told, len(corners)
    ('estimated insides and clearance classes', 4)
    """
    data = [b.catalogue for scene in scenes for b in scene.bearings if b.catalogue is not None]
    estimated = any(one.estimated for one in data)
    by_class = any(isinstance(one.clearance, str) for one in data)
    insides: tuple[End, ...] = ("softer", "stiffer") if estimated else ("middle",)
    places = (0.0, 1.0) if by_class else (0.5,)
    corners = [Choice(end, place) for end in insides for place in places]
    names = {"estimated insides": estimated, "clearance classes": by_class}
    told = " and ".join(name for name, there in names.items() if there)
    return told, [corner for corner in corners if corner != AS_TOLD]


def life_of(
    bearing: Bearing,
    oil: Lubrication | None,
    told: str,
    speed: float | None,
    places: Sequence[Place],
) -> BearingLife:
    """Life of a bearing with catalogue data from how it lies: the bearing and the motion of its
    inner ring, as told and at the corners of what is not known. A speed of the shaft, rad/s, is in
    place of that of the bearing or of its lubrication.
    """
    data = bearing.catalogue
    assert data is not None
    turns = speed or data.speed or (oil.speed if oil else None) or 0.0
    lives = [life(data, made, motion, oil, turns) for made, motion in places]
    return BearingLife(bearing.name, lives[0], turns, told, tuple(lives[1:]))
