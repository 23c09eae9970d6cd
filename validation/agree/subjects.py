"""Files that relations are asked of: shipped scenes and trains, and files of strangers."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import solidgear as sg
from solidgear import SolidgearError
from solidgear.core.scene.shaft import without_axis

ROOT = Path(__file__).parent.parent.parent
SHIPPED = (ROOT / "geometry", ROOT / "tests" / "scenes", ROOT / "tests" / "found")


def files_in(places: Iterable[Path]) -> list[Path]:
    """Return scenes and trains that can be read, of files and folders; by default the shipped ones."""
    files = [
        file
        for place in list(places) or [folder for folder in SHIPPED if folder.is_dir()]
        for file in (sorted(place.rglob("*.toml")) if place.is_dir() else [place])
    ]
    return [file for file in files if _can_be_read(file)]


def _can_be_read(file: Path) -> bool:
    """Whether a file describes something or crashes; one that is refused has no numbers."""
    for read in (sg.load, sg.load_train):
        try:
            read(file)
        except SolidgearError:
            continue
        except Exception:
            return True
        return True
    return False


def is_shaft_with_axis(scene: Path) -> bool:
    """Whether a scene is a shaft, and no body without an axis."""
    return not without_axis(sg.load(scene))
