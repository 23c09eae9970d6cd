"""Features of a shaft that are not of revolution: one file for each kind, with data and rules."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TypeAlias, get_args

from solidgear.core.errors import SceneError
from solidgear.core.scene.feature import OnSegment
from solidgear.core.scene.parts import Segment
from solidgear.cuts.features.around import meeting_problems
from solidgear.cuts.features.bolt_circle import BoltCircle
from solidgear.cuts.features.cross_hole import CrossHole
from solidgear.cuts.features.flat import Flat
from solidgear.cuts.features.keyway import Keyway
from solidgear.cuts.features.toothed import Spline, Teeth

#: features of one shaft
MOST_FEATURES = 20
Feature: TypeAlias = Keyway | Flat | CrossHole | Teeth | Spline | BoltCircle
#: by the kind in a file
FEATURES: dict[str, type[OnSegment]] = {
    feature.model_fields["kind"].default: feature for feature in get_args(Feature)
}


def feature_problems(
    segments: Sequence[Segment], features: Sequence[Feature]
) -> Iterator[SceneError]:
    """Yield problems of features that do not fit their shaft or each other, or share a name."""
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
