"""Reading of a scene for commands that print no cautions of their own."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from solidgear.scene import Scene


def load(path: Path) -> Scene:
    """A scene, and to the terminal what is doubtful about the file of its part.

    Parameters
    ----------
    path : path

    Raises
    ------
    SceneError
        As :func:`solidgear.load`.
    """
    from solidgear.studies.loading import load as read

    scene = read(path)
    for sentence in scene.body.doubts if scene.body is not None else ():
        print(f"caution: {sentence}", file=sys.stderr)
    return scene
