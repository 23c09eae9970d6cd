"""The scene: shapes, supports, features and questions, as data only."""

from solidgear.bearings.catalogue import BearingDisplacement, BearingLoad, Catalogue
from solidgear.core.quantity import Quantity
from solidgear.core.scene.ask import Ask
from solidgear.core.scene.blends import Blend, Chamfer, Corner, Fillet
from solidgear.core.scene.housing import Elastic, Housing
from solidgear.core.scene.lubrication import Lubrication
from solidgear.core.scene.model import Scene
from solidgear.core.scene.parts import STEEL, Material, Segment, Strength
from solidgear.core.scene.point_mass import PointMass
from solidgear.core.scene.stations import Bearing, Port
from solidgear.cuts.features import BoltCircle, CrossHole, Feature, Flat, Keyway, Spline, Teeth

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
