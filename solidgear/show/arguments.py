"""Reading of a scene for commands that print no cautions of their own."""

from __future__ import annotations

import sys
from pathlib import Path

from solidgear.core import Scene
from solidgear.core import load as read


def load(path: Path) -> Scene:
    """Read a scene and print doubts about the file of its part."""
    scene = read(path)
    for sentence in scene.body.doubts(scene.material) if scene.body is not None else ():
        print(f"caution: {sentence}", file=sys.stderr)
    return scene
