"""What commands say beside numbers of one shaft: doubts about its part, and remarks that rooms of
features add."""

from __future__ import annotations

import sys
from collections.abc import Iterator

from solidgear.core import Body, OpenNumbers, Scene, Source, addition, explained
from solidgear.core import load as read


def load(source: Source, case: str | None = None) -> Scene:
    """Read a scene, whose bearings settle under a case of its loads, by default the first, and print
    doubts about the file of its part.
    """
    scene = read(source)
    if case is not None:
        with explained(source):
            scene = scene.with_case(case).settled
    for sentence in scene.body.doubts(scene.material) if scene.body is not None else ():
        print(f"caution: {sentence}", file=sys.stderr)
    return scene


def cautions(scene: Scene, body: Body) -> list[str]:
    """Return the cautions of all guards on a scene and the model that was solved."""
    remark = addition("remark", "cautions")
    return remark(scene, body) if remark else []


def open_ranges(scene: Scene, body: Body | None = None) -> OpenNumbers:
    """Return the ranges of numbers that inputs with an open value cause."""
    if not may_be_open(scene):
        return OpenNumbers()
    remark = addition("remark", "open ranges")
    return remark(scene, body) if remark else OpenNumbers()


def may_be_open(scene: Scene) -> bool:
    """Return True where inputs of a scene may have an open value."""
    return bool(scene.uncertain) or any(b.catalogue is not None for b in scene.bearings)


def bearing_cautions(scene: Scene) -> Iterator[str]:
    """Yield cautions on bearings that do not fit their seat, or hold the shaft one way only."""
    for name in ("directions", "seats"):
        remark = addition("remark", name)
        if remark:
            yield from remark(scene)
