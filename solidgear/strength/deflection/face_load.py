r"""Face load factor of every mesh by ISO 6336-1, from how far its shafts let the flanks lie askew.

    K_H beta = 1 + F c / (2 q)  up to 2,  sqrt(2 F c / q)  beyond,    F = |f_sh + f_flanks|

with the transverse force per face width q and c = 0.85 c_gamma_alpha (clause 7, method C).  f_sh is
computed, with bearings, bending and wind-up, so that it needs no factor for what an estimate leaves
out.  It is that of an even load, for the formula itself moves the load along the face: where the train
rests with the force elsewhere, as teeth in contact have it, the flanks are taken on to the middle of
the face by the stiffness at rest.  f_flanks is what helix slopes and measured flanks of the file leave from end to end of the face.
Deviations that the file does not give, f_ma, and running-in, y_beta, are taken as zero.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos

import numpy as np

from solidgear.core import SceneError
from solidgear.core.gears.flank_shape import shape_opening
from solidgear.core.gears.norm import norm_face_load_factor, norm_stiffness
from solidgear.strength.deflection.misalignment import PARALLELS, Measure, meshes_of
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.mesh_place import place_of, place_of_pair
from solidgear.trains.assembly.stages import mesh_row
from solidgear.trains.file.mesh_teeth import MeshTeeth, moduli_of, wheels_of
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import PlanetMesh
from solidgear.trains.load.state import OperatingState
from solidgear.trains.load.static_errors import StaticErrors

#: name of the misalignment over the face
SKEW = PARALLELS[-1]


@dataclass(frozen=True)
class FaceLoad:
    """Face load factor of a mesh by the norm, with what it is made of."""

    mesh: str  #: name
    line_load: float  #: transverse force per face width, N/m
    skew: float  #: f_sh under an even load, m
    shape: float  #: what the shapes of the flanks open over the face, m
    stiffness: float  #: c_gamma_alpha, N/m per m
    factor: float  #: K_H beta
    bar: float | None  #: error bar by that of f_sh


def face_loads(
    state: OperatingState, errors: StaticErrors, askew: Sequence[Measure]
) -> tuple[FaceLoad, ...]:
    """Return the face load factors of all meshes of a train at rest whose teeth are known, by f_sh of
    every mesh among its misalignments `askew` and its errors.
    """
    assembly, system, coordinates = state.assembly, state.system, state.coordinates
    skews, loads = {measure.name: measure.row for measure in askew}, []
    for mesh in meshes_of(assembly.train):
        teeth, name = _teeth(assembly, mesh), f"{SKEW}{mesh.label}"
        if teeth is None or name not in skews:
            continue
        wheels = teeth.wheels
        row, spring = mesh_row(system, mesh.name)
        force = abs(spring * float(row @ coordinates))
        transverse = force * cos(wheels.base_helix)
        line_load = transverse / wheels.face_width
        if line_load == 0:
            continue
        stiffness = norm_stiffness(wheels, line_load, moduli_of(mesh)).mesh
        bar = errors.error_bar(skews[name])
        skew = float(skews[name] @ (coordinates + _to_middle(errors, mesh, teeth, force)))
        shape = teeth.along[0] * shape_opening(wheels, teeth.shapes)
        factors = [
            norm_face_load_factor(skew + shape + off, line_load, stiffness)
            for off in (0.0, -(bar or 0.0), bar or 0.0)
        ]
        moved = None if bar is None else max(abs(f - factors[0]) for f in factors)
        loads.append(FaceLoad(mesh.name, line_load, skew, shape, stiffness, factors[0], moved))
    return tuple(loads)


def _to_middle(
    errors: StaticErrors, mesh: Pair | PlanetMesh, teeth: MeshTeeth, force: float
) -> np.ndarray | float:
    """Return the coordinates (N,) by which a train moves as the force of a mesh, N, goes to the middle
    of its face; those of planets are there.
    """
    if isinstance(mesh, PlanetMesh):
        return 0.0
    assembly, system = errors.state.assembly, errors.tangent
    places = place_of_pair(assembly, system, mesh), place_of(assembly, system, mesh, teeth)
    if np.array_equal(places[0].pitch_point, places[1].pitch_point):
        return 0.0
    at, middle = (system.load(dict(place.load(system))) for place in places)
    return system.static(force * (middle - at))


def _teeth(assembly: Assembly, mesh: Pair | PlanetMesh) -> MeshTeeth | None:
    """Return the wheels of a mesh that touch on a face; None where the file does not give them."""
    coast = None
    if isinstance(mesh, PlanetMesh):
        coast = assembly.stages[mesh.stage.name].way < 0
    try:
        teeth = wheels_of(mesh, coast)
        touching = (
            teeth is not None and min(teeth.wheels.face_width, teeth.wheels.contact_ratio) > 0
        )
    except SceneError:  # of numbers that a pitch radius leaves open
        return None
    return teeth if touching else None
