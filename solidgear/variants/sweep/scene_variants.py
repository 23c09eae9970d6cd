"""Scenes of a sweep: a file with entries replaced."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from solidgear.core.loading import scene_of
from solidgear.core.scene import Scene
from solidgear.core.scene.toml_file import parse
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.entries import Entry
from solidgear.variants.sweep.file_variants import OWN, FileVariants, in_own_file


@dataclass(frozen=True)
class SceneVariants(FileVariants[Scene]):
    """Points of a sweep over entries of a scene file, catalogue bearings with their stiffness."""

    def read(self, varied: Sequence[Entry], row: Sequence[float]) -> Scene:
        return scene_of(self.put(OWN, varied, row), self.path)


def scene_variants(path: Path, design: Design, example: str) -> SceneVariants:
    """Points of a sweep over entries of a scene file; the example of something to vary is told where
    nothing is.
    """
    files = {OWN: parse(str(path))}
    points = design.points(files, in_own_file, example=example)
    return SceneVariants(path, files, *points, design)
