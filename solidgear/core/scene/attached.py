"""Attachments of stations to a body."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any


def attached_stations(
    stations: Iterable[Any], attachments: Sequence[str] | None = None
) -> Iterator[tuple[Any, str]]:
    """Yield stations with each of their attachments: those given, else the one of the station; the
    middle of an end face is always a section.

    Examples
    --------
    >>> from solidgear import Bearing, Port
    >>> tip = Port(name="tip", y=1.0, lo=0.9, hi=1.0)
    >>> wall = Bearing(name="wall", y=0.0, seat_width=0.02, hold="clamped", face="start")
    >>> [(s.name, way) for s, way in attached_stations([tip, wall], ["average", "rigid"])]
    [('tip', 'average'), ('tip', 'rigid'), ('wall', 'section')]
    """
    for station in stations:
        usual = (station.attachment,)
        on_face = getattr(station, "face", None) is not None
        for attachment in usual if on_face or not attachments else attachments:
            yield station, attachment
