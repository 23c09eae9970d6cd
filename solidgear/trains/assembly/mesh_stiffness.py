"""Meshes whose stiffness is that of their teeth in contact.

A file asks for it by ``stiffness = "teeth"``.  The contact is solved where the train is put at rest, by
the addition "teeth" of the kind "mesh stiffness" (:mod:`solidgear.rooms`), which gives numbers in place
of that word: stiffness, its cycle, mesh point, line of action and transmission error.  Each operating
point has its own, and so has each place in the ranges of the bearings.

The contact is solved about the train with its forces at the middle of the faces and a usual stiffness;
the train then settles with the force where the contact has it.  That is one step of Newton's: what is
left is second order in how bearings stiffen as the force moves along the face.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from solidgear.bearings.solved import AS_STATED, Choice
from solidgear.core import SceneError, SolidgearError, addition
from solidgear.core.gears.norm import material_factor
from solidgear.trains.file.mesh_teeth import moduli_of, wheels_of
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import PlanetMesh
from solidgear.trains.file.solved_meshes import Meshes, SolvedMeshes, load_of
from solidgear.trains.file.tables import TEETH
from solidgear.trains.file.train import Train

#: mesh stiffness of steel teeth per face width, N/m^2 (ISO 6336-1:1996, method C: 20 N/(mm um))
USUAL = 20e9
UNLOADED = "a torque of 0 N m presses no teeth together; give another one"


def asks_for_teeth(train: Train) -> bool:
    """Return True for a train with a mesh whose teeth are to give its stiffness."""
    stages = (table.mesh for table in train.planetary.values())
    return any(mesh.stiffness == TEETH for mesh in train.meshes) or any(
        TEETH in (mesh.sun_stiffness, mesh.ring_stiffness) for mesh in stages
    )


class SolvesTeeth(Protocol):
    """Teeth of a train that asks for them, as the room of teeth solves them."""

    def at(self, point: OperatingPoint, choice: Choice = AS_STATED, varies: str = "") -> Train:
        """Return the train with numbers under a load, of a mesh `varies` over its cycle."""


class TeethAtRest:
    """Teeth of a train that may ask for them: its meshes at operating points, each solved once."""

    def __init__(self, train: Train):
        self.train = train
        self.asked = asks_for_teeth(train)
        self._usual = with_usual_meshes(train)
        self._meshes = dict(train.solved_meshes.by_condition)
        self._solver: SolvesTeeth | None = None

    @property
    def solved(self) -> SolvedMeshes:
        """The meshes as far as they were solved, for other studies of the same train."""
        return SolvedMeshes(dict(self._meshes))

    def first(self) -> Train:
        """Return the train with numbers for its teeth where it stands: usual ones while bearings have no
        stiffness, and where no torque presses teeth together, with which no motion is computed.
        """
        if not self.asked or not has_settled(self.train):
            return self._usual
        point = self.train.point
        if point is None:
            raise SceneError(
                'is missing; stiffness = "teeth" is that under a load: give [operation] a torque',
                path=("operation",),
            )
        return self.at(point) if point.torque else self._usual

    def refuse_usual(self, train: Train) -> None:
        """Refuse a train whose teeth have a usual stiffness in place of their own."""
        if self.asked and train is self._usual:
            raise SolidgearError(UNLOADED)

    def load_that_counts(self, point: OperatingPoint) -> OperatingPoint | None:
        """Return what an operating point has in common with others where the teeth give the same; None
        where only the flank counts.
        """
        return load_of(self.train.told(point)) if self.asked and point.torque else None

    def at(self, point: OperatingPoint, choice: Choice = AS_STATED) -> Train:
        """Return the train with the numbers of its teeth at an operating point, at a place in the ranges
        of its bearings.
        """
        load = self.load_that_counts(point)
        if load is None:
            return self._usual
        key = load, "" if choice == AS_STATED else repr(choice)
        if key not in self._meshes:
            self._meshes[key] = meshes_of(self._solve(load, choice))
        solved = self._meshes[key]
        # the teeth are those of the train whatever harmonics they drive
        meshes = tuple(
            mesh.with_changes(local_harmonics=given.local_harmonics)
            for mesh, given in zip(solved.meshes, self.train.meshes)
        )
        train = self.train.with_changes(meshes=meshes, planetary=solved.planetary)
        return train.with_solved_meshes(SolvedMeshes(cautions=solved.cautions))

    def over_cycle(self, point: OperatingPoint, mesh: str) -> Train:
        """Return the train with the numbers of its teeth, of one pair over its mesh cycle."""
        if not point.torque:
            raise SolidgearError(UNLOADED)
        return self._solve(load_of(self.train.told(point)), AS_STATED, mesh)

    def _solve(self, load: OperatingPoint, choice: Choice, varies: str = "") -> Train:
        if self._solver is None:
            solver = addition("mesh stiffness", TEETH)
            if solver is None:
                raise SolidgearError(
                    f'{self.train.name}: stiffness = "teeth" needs the room of teeth, which is not '
                    'installed; give a number, such as "3e8 N/m"'
                )
            self._solver = solver(self.train)
        assert self._solver is not None
        solved = self._solver.at(load, choice, varies)
        if asks_for_teeth(solved):
            raise SolidgearError(
                f'{self.train.name}: not every mesh with stiffness = "teeth" has teeth whose contact '
                'can be solved; give a number there, such as "3e8 N/m"'
            )
        return solved


def solved_meshes(trains: Mapping[OperatingPoint, Train]) -> SolvedMeshes:
    """Return what the teeth give in trains that have numbers of them, by operating point."""
    return SolvedMeshes({(load_of(p), ""): meshes_of(train) for p, train in trains.items()})


def meshes_of(train: Train) -> Meshes:
    """Return the meshes of a train that has numbers of its teeth."""
    return Meshes(train.meshes, train.planetary, train.solved_meshes.cautions)


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
