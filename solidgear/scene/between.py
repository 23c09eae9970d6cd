"""Rules between things on one shaft."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from solidgear.errors import SceneError, listed
from solidgear.scene.blend_rules import blend_problems
from solidgear.scene.blends import Blend
from solidgear.scene.features import Feature, feature_problems
from solidgear.scene.parts import Segment
from solidgear.scene.point_mass import PointMass
from solidgear.scene.rules import mass_problems, station_problems
from solidgear.scene.stations import Bearing, Port


def problems_between(
    segments: Sequence[Segment],
    *,
    ports: Sequence[Port],
    bearings: Sequence[Bearing],
    masses: Sequence[PointMass],
    features: Sequence[Feature],
    blends: Sequence[Blend],
    whole: bool = True,
) -> Iterator[SceneError]:
    """Problems between things on a sound shaft, the main port first; names are judged where the
    ports and bearings are the whole of them.
    """
    yield from station_problems(segments, ports, bearings, masses)
    if whole:
        yield from mass_problems(ports, bearings, masses)
        yield from preload_problems(bearings)
    yield from feature_problems(segments, features)
    own = [mass for mass in masses if mass.on is None]
    there = [f for f in features if any(f.segment == s.name for s in segments)]
    yield from blend_problems(segments, blends, [*ports, *bearings, *own], there)


def preload_problems(bearings: Sequence[Bearing]) -> Iterator[SceneError]:
    """Preloaded rows that all hold the shaft the same way: nothing presses them together."""
    rows = [(k, b, b.catalogue) for k, b in enumerate(bearings) if b.catalogue is not None]
    rows = [row for row in rows if row[2].one_sided]
    pressed = [b for _, b, data in rows if data.preload is not None]
    ways = {data.holds for *_, data in rows}
    if len(pressed) < 2 or len(ways) > 1:
        return
    way = ways.pop()
    other = "-y" if way == "+y" else "+y"
    lower, *_, upper = sorted(rows, key=lambda row: row[1].y)
    # back to back, the lower one holds towards +y
    o, x = (upper, lower) if way == "+y" else (lower, upper)
    yield SceneError(
        f"{listed([repr(b.name) for b in pressed])} are preloaded and all hold the shaft towards "
        f"{way}, but a preload needs a row that holds it towards {other}: turn one, for an O "
        f"arrangement {o[1].name!r}, for X {x[1].name!r}, or leave the preload out",
        path=("bearings", o[0], "catalogue", "holds"),
    )
