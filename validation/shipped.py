"""The scenes in `geometry/`: shafts, and trains of two of them."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from solidgear.core.loading import load
from solidgear.core.scene.document import is_train
from solidgear.core.scene.shaft import resolved
from solidgear.core.scene.toml_file import parse

GEOMETRY = Path(__file__).resolve().parent.parent / "geometry"


def shipped_shafts() -> list[Path]:
    """Scenes of one shaft, by name."""
    paths = sorted(GEOMETRY.glob("*.toml"))
    return [path for path in paths if not is_train(path)]


def drawn_shafts() -> list[Path]:
    """Those of segments: a part from a file is read in a process of its own, which takes seconds."""
    return [path for path in shipped_shafts() if "body" not in parse(str(path))]


@cache
def shafts_of_revolution() -> tuple[Path, ...]:
    """Those that a model of revolution holds."""
    return tuple(path for path in drawn_shafts() if not resolved(load(path)))
