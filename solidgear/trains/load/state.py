"""A train at rest at an operating point, and the train with the bearings of that state."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from solidgear.bearings.catalogued import Catalogued
from solidgear.core import System
from solidgear.core.system.system import port_forces
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.train import Train
from solidgear.trains.system.equilibrium import SystemEquilibrium


@dataclass(frozen=True, eq=False)
class OperatingState:
    """A train at rest at one operating point."""

    point: OperatingPoint
    models: dict[str, str]  #: by shaft
    #: along the line of action, N, by mesh; zero where no torque passes
    mesh_forces: dict[str, float]
    equilibrium: SystemEquilibrium  #: of all parts; the spring port of the engine does not turn
    assembly: Assembly = field(repr=False)  #: the train as it meshes at the point
    #: without the bearings; the equilibrium is in its coordinates
    system: System = field(repr=False)
    bearings: dict[str, Catalogued] = field(
        repr=False
    )  #: bearings of catalogue data, by ``side.name``
    #: loads from outside on ports of parts: torques of both rotors and other forces
    outside: dict[str, np.ndarray] = field(repr=False)
    notes: tuple[str, ...] = ()  #: sentences

    @property
    def mesh_force(self) -> float:
        """Force of the first mesh, N."""
        return next(iter(self.mesh_forces.values()))

    @property
    def coordinates(self) -> np.ndarray:
        """Coordinates (N,) of the system."""
        return self.equilibrium.coordinates

    def motion(self, end: str) -> np.ndarray:
        """Return the motion (6,) of a port such as ``pinion.A``, m and rad, in the axes of its
        scene.
        """
        return self.system.motion(end) @ self.coordinates

    def forces(self) -> dict[str, np.ndarray]:
        """Return the force (6,) of everything but weight on each port of a shaft: teeth, springs,
        bearings, and loads from outside, N and N m, in the axes of the scene.
        """
        out = port_forces(self.system, self.coordinates)
        for end, force in self.outside.items():
            out[end] = out.get(end, np.zeros(6)) + force
        for end, force in self.equilibrium.load.items():
            out[end] = out.get(end, np.zeros(6)) - force
        return out


def with_settled_bearings(train: Train, state: OperatingState) -> Train:
    """Return a train with one operating point, the bearings with the stiffness that they have
    there.
    """
    shafts = {}
    for side, shaft in train.shafts.items():
        bearings = [
            bearing
            if bearing.catalogue is None
            else bearing.with_changes(matrix=_symmetric(state, side, bearing.name))
            for bearing in shaft.scene.bearings
        ]
        scene = shaft.scene.with_changes(bearings=tuple(bearings))
        shafts[side] = shaft.with_changes(scene=scene)
    point = state.point.with_changes(share=None, hours=None)
    return train.with_changes(operation=(point,), shafts=shafts)


def _symmetric(state: OperatingState, side: str, name: str) -> np.ndarray:
    """Return the tangent (6, 6) of a bearing; friction at speed leaves a part that is no spring."""
    tangent = state.equilibrium.tangent[f"{side}.{name}"]
    return (tangent + tangent.T) / 2
