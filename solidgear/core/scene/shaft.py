"""Interface of a scene for builders and meshers, and features of a scene."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

if TYPE_CHECKING:
    from solidgear.core.scene.outline import Outline
    from solidgear.core.scene.parts import Segment
    from solidgear.core.scene.point_mass import PointMass
    from solidgear.core.scene.stations import Bearing, Port

    Station: TypeAlias = Port | Bearing | PointMass


class Shaft(Protocol):
    """Segments end to end with their stations: a `Scene`, or a class with the same properties."""

    @property
    def segments(self) -> tuple[Segment, ...]:
        """Segments from y = 0 on."""

    @property
    def stations(self) -> tuple[Port | Bearing | PointMass, ...]:
        """Things attached, the port first; each has name, y, lo, hi (m) and attachment."""

    @property
    def outline(self) -> Outline[Segment]:
        """Lines and arcs of the meridian, fillets and chamfers among them."""

    @property
    def length(self) -> float:
        """Overall length, m."""

    @property
    def features(self) -> tuple[Any, ...]:
        """Features cut out of the segments or standing on them."""

    @property
    def body(self) -> Any:
        """Part from a file, whose round part the segments are; None of a shaft of segments."""


def resolved(scene: Shaft) -> tuple[Any, ...]:
    """Return the features of a scene that models of revolution cannot hold, and its part from a file;
    teeth that are smeared into a cone do not count.

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/pinion_keyed.toml")
    >>> [feature.name for feature in resolved(scene)]
    ['key']
    """
    parts = () if scene.body is None else (scene.body,)
    return (*(f for f in scene.features if not f.smeared), *parts)


def without_axis(scene: Shaft) -> bool:
    """Return True for a block or another body that is no shaft, whose segments only give places."""
    return scene.body is not None and scene.body.edges is not None


def turning_speed(scene: Any) -> float | None:
    """Return the largest speed of a shaft, rad/s, of those that its bearings, its lubrication and the
    cases of its loads state; None where none does.

    Examples
    --------
    >>> import solidgear as sg
    >>> turning_speed(sg.load("geometry/shaft_stepped.toml")) is None
    True
    """
    data = [b.catalogue for b in scene.bearings if b.catalogue is not None]
    stated = [catalogue.speed for catalogue in data] + [case.speed for case in scene.cases]
    stated.append(None if scene.lubrication is None else scene.lubrication.speed)
    return max((abs(speed) for speed in stated if speed), default=None)


def feature_labels(features: Iterable[Any]) -> str:
    """Return features in a sentence, such as ``keyway "key"``."""
    return ", ".join(f'{f.what} "{f.name}"' for f in features)


def attached_stations(
    stations: Iterable[Station], attachments: Sequence[str] | None = None
) -> Iterator[tuple[Station, str]]:
    """Yield stations with each of their attachments: those given, else the one of the station; the
    average of an end face is that of its section.

    Examples
    --------
    >>> from solidgear import Bearing, Port
    >>> tip = Port(name="tip", y=1.0, lo=0.9, hi=1.0)
    >>> wall = Bearing(name="wall", y=0.0, seat_width=0.02, hold="clamped", face="start")
    >>> [(s.name, way) for s, way in attached_stations([tip, wall], ["average", "rigid"])]
    [('tip', 'average'), ('tip', 'rigid'), ('wall', 'section'), ('wall', 'rigid')]
    """
    for station in stations:
        ways = attachments or (station.attachment,)
        mean = "section" if on_face(station) else "average"
        for attachment in dict.fromkeys(mean if way == "average" else way for way in ways):
            yield station, attachment


def on_face(station: Station) -> bool:
    """Return whether a station is on an end face, and not on a seat."""
    return getattr(station, "face", None) is not None
