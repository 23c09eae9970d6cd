"""The scenes in `geometry/`: shafts, and trains of two of them."""

from __future__ import annotations

import tomllib
from pathlib import Path

GEOMETRY = Path(__file__).resolve().parent.parent / "geometry"


def shipped_shafts() -> list[Path]:
    """Scenes of one shaft, by name."""
    paths = sorted(GEOMETRY.glob("*.toml"))
    return [path for path in paths if "segment" in tomllib.loads(path.read_text("utf-8"))]
