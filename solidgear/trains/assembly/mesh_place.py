"""Where two wheels of a train touch: pairs of gears, and planets with sun and ring."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos

import numpy as np

from solidgear.core import System
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.stages import mesh_row
from solidgear.trains.file.mesh_teeth import MeshTeeth
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import PlanetMesh


@dataclass(frozen=True, eq=False)
class MeshPlace:
    """Both wheels of a mesh as bodies of a system, in the axes of the train's first shaft."""

    link: str  #: of the teeth in the system
    force: str  #: name of the force in a state at rest
    #: ports of both wheels; the second is None for a ring that is part of the ground
    ends: tuple[str, str | None]
    pitch_point: np.ndarray  #: (3,) of cylindrical gears at the middle of the shared face, m
    normal: np.ndarray  #: (3,) direction of the force on the first wheel
    axis: np.ndarray  #: (3,) unit, y of the first wheel's shaft

    def load(self, system: System) -> list[tuple[str, np.ndarray]]:
        """Return the (6,) load on each end by a unit force of the teeth, in the axes of the end."""
        loads = []
        for end, sign in zip(self.ends, (1, -1)):
            if end is None:
                continue
            port = system.port(end)
            force = sign * self.normal
            moment = np.cross(self.pitch_point - port.point, force)
            loads.append((end, np.concatenate([port.axes.T @ force, port.axes.T @ moment])))
        return loads


def place_of(
    assembly: Assembly, system: System, mesh: Pair | PlanetMesh, teeth: MeshTeeth
) -> MeshPlace:
    """Return where a mesh lies in the system of a train, on the flanks of the assembly; of planets the
    first of those that it names.
    """
    if isinstance(mesh, PlanetMesh):
        return place_of_planet(assembly, system, mesh, teeth)
    place = place_of_pair(assembly, system, mesh)
    # a given mesh point may lie anywhere along the face
    aside = teeth.middles[0] - assembly.contacts[mesh.name].pinion.point[1]
    return replace(place, pitch_point=place.pitch_point + aside * place.axis)


def place_of_pair(assembly: Assembly, system: System, pair: Pair) -> MeshPlace:
    """Return where a pair of gears lies in the system of a train, on the flanks of the assembly."""
    first, second = (f"{side}.{port}" for side, port in zip(pair.shafts, pair.ports))
    port, vector = system.port(first), assembly.contacts[pair.name].pinion
    return MeshPlace(
        link=pair.name,
        force=pair.name,
        ends=(first, second),
        pitch_point=port.point + port.axes @ vector.point,
        normal=port.axes @ vector.normal,
        axis=port.axes[:, 1],
    )


def place_of_planet(
    assembly: Assembly, system: System, mesh: PlanetMesh, teeth: MeshTeeth
) -> MeshPlace:
    """Return where the first of the planets that a mesh names meshes with sun or ring."""
    stage, number = mesh.stage, mesh.planets[0]
    at_work = assembly.stages[stage.name]
    planet = f"{at_work.planets[f'planet {number}']}.centre"
    sun = ".".join((stage.shafts[0], stage.ports[0]))
    link = f"{stage.name} {mesh.mate} {number}"
    axis = system.port(sun).axes[:, 1]
    centre, pin = system.port(sun).point, system.port(planet).point
    outward = pin - centre
    outward = outward - (outward @ axis) * axis
    outward /= np.linalg.norm(outward)
    rolling = teeth.wheels.first.base / cos(teeth.wheels.working_angle)
    ring = None if at_work.holds is None else at_work.holds[0]
    ring = ring if at_work.ring is None else f"{at_work.ring}.centre"
    ends = (planet, ring) if mesh.mate == "ring" else (sun, planet)
    start = pin if mesh.mate == "ring" else centre
    # the row of the mesh in the system, with the sense in which teeth push the first wheel off
    port = system.port(ends[0])
    row, _ = mesh_row(system, link)
    along = port.axes @ np.linalg.lstsq(port.rows.T, row, rcond=None)[0][:3]
    return MeshPlace(
        link=link,
        force=stage.name,
        ends=ends,
        pitch_point=start + rolling * outward + teeth.middles[0] * axis,
        normal=-np.sign(along @ outward) * along,
        axis=axis,
    )
