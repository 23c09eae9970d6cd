"""Ways of tying the stations of a scene that models are compared in."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from solidgear.core.scene import Scene

#: as bearings and port say; and mean motions of cross-sections everywhere, as in a beam
SCENE, SECTION = "as scene", "section"


def attached(scene: Scene, attachment: str) -> Scene:
    """Return the scene with one attachment everywhere. A rigid one is set at bearing seats alone: a
    lumped point that was rigid becomes averaged, any other keeps its attachment.

    Only seats are compared in the literature on RBE2 against RBE3; a rigid head would be another
    model.
    """
    if attachment != "rigid":
        return scene.with_attachment(attachment)
    bearings = tuple(b.attached("rigid") for b in scene.bearings)
    port, *further = (
        port.with_changes(attachment="average") if port.attachment == "rigid" else port
        for port in scene.ports
    )
    return scene.with_changes(bearings=bearings, port=port, further_ports=tuple(further))
