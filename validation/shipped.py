"""The scenes in `geometry/`: shafts, and trains of two of them."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from solidgear.scene.shaft import resolved
from solidgear.scene.toml_file import is_train
from solidgear.studies.loading import load

GEOMETRY = Path(__file__).resolve().parent.parent / "geometry"


def shipped_shafts() -> list[Path]:
    """Scenes of one shaft, by name."""
    paths = sorted(GEOMETRY.glob("*.toml"))
    return [path for path in paths if not is_train(path)]


def shafts_of_revolution() -> list[Path]:
    """Those that a model of revolution holds."""
    return [path for path in shipped_shafts() if _of_revolution(path)]


@cache
def _of_revolution(path: Path) -> bool:
    # a part from a file is read in a process of its own
    return not resolved(load(path))
