"""Grooves, threads and hubs of a drawing, which no model has."""

from __future__ import annotations

from typing import TYPE_CHECKING

from solidgear.core.scene.shaft import feature_labels
from solidgear.guards.notice import Notice, Notices

if TYPE_CHECKING:
    from solidgear.core import Scene


def details(scene: Scene) -> Notices:
    """Yield a notice on features that all models leave out, since only ratings read them."""
    left_out = [f for f in scene.features if f.smeared and not f.toothed]
    if left_out:
        them = "it" if len(left_out) == 1 else "them"
        yield Notice(
            "fact",
            (),
            f"{feature_labels(left_out)}: no model has {them}; solidgear stress rates {them} by "
            "DIN 743",
        )
