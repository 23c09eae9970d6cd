"""What is modelled and what is asked: data only."""

from solidgear.scene.model import (
    STEEL,
    Ask,
    Bearing,
    Material,
    Port,
    Quantity,
    Scene,
    SceneError,
    Segment,
)

__all__ = [
    "Ask",
    "Bearing",
    "Material",
    "Port",
    "Quantity",
    "STEEL",
    "Scene",
    "SceneError",
    "Segment",
]
