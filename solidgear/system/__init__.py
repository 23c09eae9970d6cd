"""Parts with ports and links between them; the geared pair, its mesh, and identification of what a
source leaves out.
"""

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
from solidgear.system.parts import Inertia, Part, Placed, RigidBody
from solidgear.system.system import System, SystemModes

__all__ = [
    "BearingSpring",
    "HousedSprings",
    "Inertia",
    "Link",
    "Part",
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
