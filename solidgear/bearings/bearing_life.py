"""Life of a catalogue bearing, with its range by unknown data of the bearings."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from solidgear.bearings.catalogue import catalogue_of
from solidgear.bearings.catalogued import Catalogued, End
from solidgear.bearings.life import Life, life
from solidgear.bearings.solved import AS_STATED, Choice, speed_of_bearing
from solidgear.core import Bearing, Scene
from solidgear.core.plain import plain
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
    unknown: str
    ends: tuple[Life, ...]  #: at all corners of the unknown data

    @property
    def lives(self) -> dict[str, float]:
        """Lives by kind, revolutions: ``basic``, ``reference`` and, where there is one, ``modified``."""
        lives = {"basic": self.life.basic, "reference": self.life.reference}
        if self.life.modified is not None:
            lives["modified"] = self.life.modified.life
        return lives

    def range(self, kind: str) -> tuple[float, float]:
        """Return the least and largest life of a kind, revolutions (a modified one also over the
        cleanliness that a word means); equal where everything is known.
        """
        lives = [value for life in (self.life, *self.ends) for value in _lives(life, kind)]
        return min(lives), max(lives)

    def as_dict(self) -> dict[str, Any]:
        """Return plain data in SI for JSON; infinite lives are None."""
        life, rated = self.life, self.life.rated
        data = {
            "speed": self.speed or None,
            "basic": life.basic,
            "reference": life.reference,
            "modified": life.modified,
            "no_modified_life": life.without,
            "range": {kind: self.range(kind) for kind in self.lives},
            "not_known": self.unknown,
            "equivalent_load": life.equivalent,
            "reference_load": life.reference_load,
            "static_load": life.static_load,
            "static_safety": life.static_safety,
            "ratings": {
                "C": rated.dynamic,
                "C0": rated.static,
                "Cu": rated.fatigue,
                "sources": rated.sources,
            },
            "notes": life.notes,
        }
        return plain(data)


def _lives(life: Life, kind: str) -> tuple[float, ...]:
    if kind == "modified":
        return (life.modified.low, life.modified.high) if life.modified else ()
    return (life.basic if kind == "basic" else life.reference,)


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
    turns = speed_of_bearing(data, oil, speed)
    lives = [life(data, rows, motion, oil, turns) for rows, motion in places]
    return BearingLife(bearing.name, lives[0], turns, label, tuple(lives[1:]))
