"""From [[feature]] tables to features in their places."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from solidgear.errors import SceneError
from solidgear.scene.blends import Blend, Chamfer, Fillet
from solidgear.scene.cyclic_features import BoltCircle, Spline, Teeth
from solidgear.scene.features import CrossHole, Feature, Flat, Keyway
from solidgear.scene.tables import BlendTable, CutTable, FeatureTable

_FEATURES: dict[str, Any] = {
    "keyway": Keyway,
    "flat": Flat,
    "cross_hole": CrossHole,
    "teeth": Teeth,
    "spline": Spline,
    "bolt_circle": BoltCircle,
}


def feature_of(item: FeatureTable, index: int, datums: Mapping[str, float]) -> Feature:
    """A [[feature]] of a segment, in its place.

    Parameters
    ----------
    item : FeatureTable
    index : int
        Among those of the file, from 0.
    datums : mapping of str to float
        m.

    Raises
    ------
    SceneError
        A size out of its range; the path is that of the file.
    """
    given = item.model_dump(exclude={"name", "kind", "from_", "position"}, exclude_none=True)
    if isinstance(item, CutTable):
        # along the segment, unless another datum is given
        given["y"] = datums.get(item.from_ or f"{item.segment}.start", 0.0) + item.position
    name = item.name or f"{item.kind.replace('_', ' ')} {index + 1}"
    try:
        return _FEATURES[item.kind](name=name, **given)
    except SceneError as error:
        found = [one.located(None, path=("feature", index, *one.path)) for one in error.problems]
        raise SceneError.of(found) from None


_BLENDS = {"fillet": Fillet, "chamfer": Chamfer}


def blend_of(item: BlendTable, index: int, datums: Mapping[str, float]) -> Blend:
    """A fillet or chamfer at its edge; parameters as for :func:`feature_of`."""
    given = item.model_dump(exclude={"name", "kind", "at"}, exclude_none=True)
    name = item.name or f"{item.kind} {index + 1}"
    return _BLENDS[item.kind](name=name, y=datums[item.at], **given)
