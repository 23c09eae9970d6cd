"""The scene: shapes, supports, features and questions, as data only."""

from solidgear.core.quantity import Quantity
from solidgear.core.scene.ask import Ask
from solidgear.core.scene.blends import Blend, Chamfer, Fillet
from solidgear.core.scene.corner import Corner
from solidgear.core.scene.housing import Elastic, Housing
from solidgear.core.scene.load import BearingLoad
from solidgear.core.scene.load_case import LoadCase
from solidgear.core.scene.lubrication import Lubrication
from solidgear.core.scene.model import Scene
from solidgear.core.scene.parts import STEEL, Material, Segment, Strength
from solidgear.core.scene.point_mass import PointMass
from solidgear.core.scene.shaft_load import ShaftLoad
from solidgear.core.scene.stations import Bearing, Port

__all__ = [
    "Ask",
    "Bearing",
    "Blend",
    "BearingLoad",
    "Chamfer",
    "Corner",
    "Elastic",
    "Fillet",
    "Housing",
    "LoadCase",
    "Lubrication",
    "Material",
    "PointMass",
    "Port",
    "Quantity",
    "STEEL",
    "Scene",
    "Segment",
    "ShaftLoad",
    "Strength",
]
