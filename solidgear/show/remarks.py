"""Remarks beside the numbers of one shaft, as far as rooms of features add them."""

from __future__ import annotations

from collections.abc import Iterator

from solidgear.core import Body, OpenNumbers, Scene
from solidgear.core.registry import addition


def cautions(scene: Scene, body: Body) -> list[str]:
    """Return the cautions of all guards on a scene and the model that was solved."""
    remark = addition("remark", "cautions")
    return remark(scene, body) if remark else []


def open_ranges(scene: Scene, body: Body | None = None) -> OpenNumbers:
    """Return the ranges of numbers that inputs with an open value cause."""
    if not scene.uncertain and all(bearing.catalogue is None for bearing in scene.bearings):
        return OpenNumbers()
    remark = addition("remark", "open ranges")
    return remark(scene, body) if remark else OpenNumbers()


def bearing_cautions(scene: Scene) -> Iterator[str]:
    """Yield cautions on bearings that do not fit their seat, or hold the shaft one way only."""
    for name in ("directions", "seats"):
        remark = addition("remark", name)
        if remark:
            yield from remark(scene)
