"""Features of a shaft that are not of revolution: one file a kind, each with its data and its
rules.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TypeAlias, get_args

from solidgear.errors import SceneError
from solidgear.scene.features.around import meeting_problems
from solidgear.scene.features.base import OnSegment
from solidgear.scene.features.bolt_circle import BoltCircle
from solidgear.scene.features.cross_hole import CrossHole
from solidgear.scene.features.flat import Flat
from solidgear.scene.features.keyway import Keyway
from solidgear.scene.features.toothed import Spline, Teeth
from solidgear.scene.parts import Segment

#: a shaft carries no more of them
MOST_FEATURES = 20
#: any of them
Feature: TypeAlias = Keyway | Flat | CrossHole | Teeth | Spline | BoltCircle
#: by the kind that a file calls them
FEATURES: dict[str, type[OnSegment]] = {
    one.model_fields["kind"].default: one for one in get_args(Feature)
}


def feature_problems(
    segments: Sequence[Segment], features: Sequence[Feature]
) -> Iterator[SceneError]:
    """Features that do not fit their shaft, or have a name twice."""
    if len(features) > MOST_FEATURES:
        reason = f"{len(features)} features are more than the {MOST_FEATURES} a shaft may have"
        yield SceneError(reason, path=("features",))
        return
    names, each_fits = set(), True
    for i, feature in enumerate(features):
        if feature.name in names:
            yield SceneError(
                "another feature has this name; each needs its own", path=("features", i, "name")
            )
        names.add(feature.name)
        for problem in feature.problems(segments):
            each_fits = False
            yield problem.located(None, path=("features", i, *problem.path))
    if each_fits:
        for i, problem in meeting_problems(segments, features):
            yield problem.located(None, path=("features", i, *problem.path))
