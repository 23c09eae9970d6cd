"""Kinds of features of a shaft that there are, and rules that all of them keep."""

from __future__ import annotations

import functools
import operator
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from solidgear.core.errors import SceneError
from solidgear.core.registry import added
from solidgear.core.scene.feature import OnSegment
from solidgear.core.scene.parts import Segment

#: a shaft carries no more of them
MOST_FEATURES = 20
#: by the kind that a file calls them
FEATURES: dict[str, type[OnSegment]] = added("feature")
if TYPE_CHECKING:
    Feature = OnSegment
else:
    Feature = functools.reduce(operator.or_, FEATURES.values(), OnSegment)


def feature_problems(
    segments: Sequence[Segment], features: Sequence[OnSegment]
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
        for meeting_problems in added("rule of features").values():
            for i, problem in meeting_problems(segments, features):
                yield problem.located(None, path=("features", i, *problem.path))
