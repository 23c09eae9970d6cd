"""Kinds of features of a shaft that there are, and rules that all of them keep."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Annotated, Any

from pydantic import BeforeValidator, SerializeAsAny

from solidgear.core.errors import SceneError
from solidgear.core.registry import absent, added
from solidgear.core.scene.feature import OnSegment
from solidgear.core.scene.parts import Segment

#: a shaft carries no more of them
MOST_FEATURES = 20


def _made(value: Any) -> Any:
    """Return a feature made from its table, as its kind says; anything else as it is."""
    if not isinstance(value, Mapping) or "kind" not in value:
        return value
    kind = kinds_of_features().get(value["kind"])
    if kind is None:
        raise SceneError(unknown_kind(value["kind"], kinds_of_features()), path=("kind",))
    return kind(**value)


def kinds_of_features() -> dict[str, type[OnSegment]]:
    """Return features by the kind that a file calls them; a shaft without any imports none."""
    return added("feature")


def unknown_kind(kind: Any, kinds: Iterable[str]) -> str:
    """Return the reason why a feature of another kind is refused."""
    missing = absent("feature", kind) if isinstance(kind, str) else ""
    return missing or f"unknown kind; write one of {', '.join(map(repr, kinds))}"


#: one of several models, which its kind tells apart
Feature = Annotated[SerializeAsAny[OnSegment], BeforeValidator(_made)]


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
    if features and each_fits:
        for meeting_problems in added("rule of features").values():
            for i, problem in meeting_problems(segments, features):
                yield problem.located(None, path=("features", i, *problem.path))
