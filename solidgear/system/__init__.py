"""Parts with ports and links between them, gear meshes and planetary stages."""

from solidgear.scene.planetary_teeth import PlanetaryTeeth
from solidgear.system.carrier_turn import CarrierTurn, FixedSupport, PlanetError, carrier_turn
from solidgear.system.gear_mesh import MeshVector
from solidgear.system.links import (
    BearingSpring,
    HousedSprings,
    Link,
    PortInertia,
    RowSpring,
    grounded,
    mesh_spring,
    torsion_spring,
)
from solidgear.system.modes import SystemModes
from solidgear.system.parts import Inertia, Part, Placed, PlanarBody, RigidBody
from solidgear.system.planetary import PlanetaryStage
from solidgear.system.planetary_members import CentralMember, Planet
from solidgear.system.planetary_modes import PlanetaryMode
from solidgear.system.system import System

__all__ = [
    "CarrierTurn",
    "FixedSupport",
    "PlanetError",
    "PlanetaryTeeth",
    "carrier_turn",
    "BearingSpring",
    "HousedSprings",
    "Inertia",
    "Link",
    "MeshVector",
    "Part",
    "CentralMember",
    "PlanarBody",
    "Planet",
    "PlanetaryMode",
    "PlanetaryStage",
    "Placed",
    "PortInertia",
    "RigidBody",
    "RowSpring",
    "System",
    "SystemModes",
    "grounded",
    "mesh_spring",
    "torsion_spring",
]
