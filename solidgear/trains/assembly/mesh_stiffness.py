"""Meshes whose stiffness is that of their teeth in contact.

A file asks for it by ``stiffness = "teeth"``.  An assembly has the contact solved, by the addition "teeth"
of the kind "mesh stiffness" (:mod:`solidgear.rooms`), which returns the train with numbers in place of
that word: stiffness, its cycle, the line of action and the transmission error at the operating point.
It is called for each train that is assembled, and so for each row of a sweep and for each operating
point.  While bearings of catalogue data have no stiffness yet, and where nothing may be solved, a usual
stiffness stands in.
"""

from __future__ import annotations

from solidgear.core import SolidgearError, addition
from solidgear.core.gears.norm import material_factor
from solidgear.trains.file.mesh_teeth import moduli_of, wheels_of
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import PlanetMesh
from solidgear.trains.file.tables import TEETH
from solidgear.trains.file.train import Train

#: mesh stiffness of steel teeth per face width, N/m^2 (ISO 6336-1:1996, method C: 20 N/(mm um))
USUAL = 20e9


def asks_for_teeth(train: Train) -> bool:
    """Return True for a train with a mesh whose teeth are to give its stiffness."""
    stages = (table.mesh for table in train.planetary.values())
    return any(mesh.stiffness == TEETH for mesh in train.meshes) or any(
        TEETH in (mesh.sun_stiffness, mesh.ring_stiffness) for mesh in stages
    )


def with_solved_meshes(train: Train, varies: str = "") -> Train:
    """Return a train with the stiffness of its teeth, of one pair over its mesh cycle where it is named;
    the usual one while bearings have no stiffness.
    """
    if not asks_for_teeth(train):
        return train
    if not has_settled(train):
        return with_usual_meshes(train)
    mesh_of_teeth = addition("mesh stiffness", TEETH)
    if mesh_of_teeth is None:
        raise SolidgearError(
            f'{train.name}: stiffness = "teeth" needs the room of teeth, which is not installed; '
            'give a number, such as "3e8 N/m"'
        )
    solved_train: Train = mesh_of_teeth(train)
    if asks_for_teeth(solved_train):
        raise SolidgearError(
            f'{train.name}: not every mesh with stiffness = "teeth" has teeth whose contact can be '
            'solved; give a number there, such as "3e8 N/m"'
        )
    return solved_train


def with_usual_meshes(train: Train) -> Train:
    """Return a train with the usual stiffness of teeth where they are to give it."""
    if not asks_for_teeth(train):
        return train
    meshes = [
        pair.mesh.with_changes(
            stiffness=usual_stiffness(pair) * _face_width(pair), status="estimated"
        )
        if pair.mesh.stiffness == TEETH
        else pair.mesh
        for pair in train.pairs
    ]
    planetary = {}
    for stage in train.stages:
        mesh = stage.table.mesh
        width = stage.sun.face_width or 0.0
        changes = {
            f"{both.mate}_stiffness": usual_stiffness(both) * width
            for both in stage.together
            if getattr(mesh, f"{both.mate}_stiffness") == TEETH
        }
        if changes:
            mesh = mesh.with_changes(**changes, status="estimated")
        planetary[stage.called] = stage.table.with_changes(mesh=mesh)
    return train.with_changes(meshes=tuple(meshes), planetary=planetary)


def usual_stiffness(mesh: Pair | PlanetMesh) -> float:
    """Return the usual mesh stiffness of teeth per face width, by their materials, N/m^2."""
    return USUAL * material_factor(*moduli_of(mesh))


def has_settled(train: Train) -> bool:
    """Return True for a train all of whose bearings have a stiffness."""
    bearings = [b for shaft in train.shafts.values() for b in shaft.scene.bearings]
    return all(b.catalogue is None or b.matrix is not None for b in bearings)


def _face_width(pair: Pair) -> float:
    """Return the face width that both gears share, m."""
    teeth = wheels_of(pair)
    if teeth is not None:
        return teeth.wheels.face_width
    widths = [wheel.face_width for wheel in (pair.pinion, pair.gear) if wheel.face_width]
    return min(widths)
