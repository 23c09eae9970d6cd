r"""Face load factor of every mesh by ISO 6336-1, from how far its shafts let the flanks lie askew.

    K_H beta = 1 + F c / (2 q)  up to 2,  sqrt(2 F c / q)  beyond,    F = |f_sh + f_flanks|

with the transverse force per face width q and c = 0.85 c_gamma_alpha (clause 7, method C).  f_sh is
computed, with bearings, bending and wind-up, so that it needs no factor for what an estimate leaves
out; f_flanks is what helix slopes and measured flanks of the file leave from end to end of the face.
Deviations that the file does not give, f_ma, and running-in, y_beta, are taken as zero.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos

import numpy as np

from solidgear.core import SceneError, System
from solidgear.core.gears.flank_shape import shape_opening
from solidgear.core.gears.norm import norm_face_load_factor, norm_stiffness
from solidgear.strength.deflection.misalignment import PARALLELS, meshes_of
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.stages import mesh_row
from solidgear.trains.file.mesh_teeth import MeshTeeth, moduli_of, wheels_of
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import PlanetMesh

#: name of the misalignment over the face
SKEW = PARALLELS[-1]


@dataclass(frozen=True)
class FaceLoad:
    """Face load factor of a mesh by the norm, with what it is made of."""

    mesh: str  #: name
    line_load: float  #: transverse force per face width, N/m
    skew: float  #: f_sh, m
    shape: float  #: what the shapes of the flanks open over the face, m
    stiffness: float  #: c_gamma_alpha, N/m per m
    factor: float  #: K_H beta
    bar: float | None  #: error bar by that of f_sh


def face_loads(
    assembly: Assembly,
    system: System,
    coordinates: np.ndarray,
    skews: Mapping[str, tuple[float, float | None]],
) -> tuple[FaceLoad, ...]:
    """Return the face load factors of all meshes of a train at rest whose teeth are known.

    Parameters
    ----------
    assembly : Assembly
        On the flanks that carry.
    system : System
    coordinates : (N,) ndarray
        Of the state at rest.
    skews : dict of str to (float, float or None)
        f_sh of every mesh with its error bar, m, by the names of
        :func:`solidgear.strength.deflection.misalignment.misalignment`.
    """
    loads = []
    for mesh in meshes_of(assembly.train):
        teeth, name = _teeth(assembly, mesh), f"{SKEW}{mesh.label}"
        if teeth is None or name not in skews:
            continue
        wheels = teeth.wheels
        row, spring = mesh_row(system, mesh.name)
        transverse = abs(spring * float(row @ coordinates)) * cos(wheels.base_helix)
        line_load = transverse / wheels.face_width
        if line_load == 0:
            continue
        stiffness = norm_stiffness(wheels, line_load, moduli_of(mesh)).mesh
        skew, bar = skews[name]
        shape = teeth.along[0] * shape_opening(wheels, teeth.shapes)
        factors = [
            norm_face_load_factor(skew + shape + off, line_load, stiffness)
            for off in (0.0, -(bar or 0.0), bar or 0.0)
        ]
        moved = None if bar is None else max(abs(f - factors[0]) for f in factors)
        loads.append(FaceLoad(mesh.name, line_load, skew, shape, stiffness, factors[0], moved))
    return tuple(loads)


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
