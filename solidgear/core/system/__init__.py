"""Parts with ports and links between them, gear meshes and planetary stages."""

from solidgear.core.scene.planetary_teeth import PlanetaryTeeth
from solidgear.core.system.gear_mesh import MeshVector
from solidgear.core.system.links import (
    BearingSpring,
    HousedSprings,
    Link,
    PortInertia,
    RowSpring,
    grounded,
    mesh_spring,
    torsion_spring,
)
from solidgear.core.system.modes import SystemModes
from solidgear.core.system.parts import Inertia, Part, Placed, PlanarBody, RigidBody
from solidgear.core.system.system import System

__all__ = [
    "PlanetaryTeeth",
    "BearingSpring",
    "HousedSprings",
    "Inertia",
    "Link",
    "MeshVector",
    "Part",
    "PlanarBody",
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
