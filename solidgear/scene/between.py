"""Rules between things on one shaft."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from solidgear.errors import SceneError
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
    yield from feature_problems(segments, features)
    own = [mass for mass in masses if mass.on is None]
    there = [f for f in features if any(f.segment == s.name for s in segments)]
    yield from blend_problems(segments, blends, [*ports, *bearings, *own], there)
