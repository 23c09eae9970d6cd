"""The scene: shapes, supports, features and questions, as data only."""

from solidgear.quantity import Quantity
from solidgear.scene.ask import Ask
from solidgear.scene.blends import Blend, Chamfer, Corner, Fillet
from solidgear.scene.catalogue import BearingDisplacement, BearingLoad, Catalogue
from solidgear.scene.features import (
    BoltCircle,
    CrossHole,
    Feature,
    Flat,
    Keyway,
    Spline,
    Teeth,
)
from solidgear.scene.housing import Elastic, Housing
from solidgear.scene.lubrication import Lubrication
from solidgear.scene.model import Scene
from solidgear.scene.parts import STEEL, Material, Segment, Strength
from solidgear.scene.point_mass import PointMass
from solidgear.scene.stations import Bearing, Port

__all__ = [
    "Ask",
    "Bearing",
    "Blend",
    "BearingDisplacement",
    "BearingLoad",
    "BoltCircle",
    "Catalogue",
    "Chamfer",
    "Corner",
    "CrossHole",
    "Elastic",
    "Feature",
    "Fillet",
    "Flat",
    "Housing",
    "Keyway",
    "Lubrication",
    "Material",
    "PointMass",
    "Port",
    "Quantity",
    "STEEL",
    "Scene",
    "Segment",
    "Spline",
    "Strength",
    "Teeth",
]
