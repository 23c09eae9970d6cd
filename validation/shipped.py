"""The scenes in `geometry/`: shafts, and trains of two of them."""

from __future__ import annotations

from pathlib import Path

from solidgear.scene.toml_file import is_train

GEOMETRY = Path(__file__).resolve().parent.parent / "geometry"


def shipped_shafts() -> list[Path]:
    """Scenes of one shaft, by name."""
    paths = sorted(GEOMETRY.glob("*.toml"))
    return [path for path in paths if not is_train(path)]
