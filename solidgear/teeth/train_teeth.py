"""Teeth of a train as finite elements and contact see them: one pair of a file, and the train filled in.

What a train needs of a mesh is its tangent stiffness about the mean load, teeth alone, for its shafts
give way by themselves; and the loaded transmission error, which drives it.  The supports count for how
the load lies along the face, and for nothing else there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from solidgear.bearings.solved import AS_STATED, Choice
from solidgear.core import SceneError
from solidgear.core.gears.wheel import Wheel
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.teeth.bevel.train import BevelContact, bevel_contact
from solidgear.teeth.compliance.flank import FlankCompliance
from solidgear.teeth.compliance.plane import DEPTH, HUB, PORT, RIM
from solidgear.teeth.compliance.slices import SPREAD, HelicalSlices
from solidgear.teeth.compliance.solid import SolidTeeth
from solidgear.teeth.contact.cycle import POSITIONS, harmonics, mesh_cycle
from solidgear.teeth.contact.cylindrical import CylindricalPair
from solidgear.teeth.contact.frame import Frame
from solidgear.teeth.contact.local import Elasticity, LineContact
from solidgear.teeth.mesh_contact import ORDERS, MeshContact
from solidgear.teeth.supports import Carried, on_beams, with_sections
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.mesh_stiffness import with_usual_meshes
from solidgear.trains.file.gears import Member
from solidgear.trains.file.lengths import in_mm
from solidgear.trains.file.mesh_cycle import StiffnessCycle
from solidgear.trains.file.mesh_teeth import MeshTeeth, elasticity_of, gears_of, wheels_of
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import PlanetMesh, PlanetMeshes, Stage
from solidgear.trains.file.solved_meshes import SolvedMeshes
from solidgear.trains.file.tables import TEETH, ErrorTable, Mesh
from solidgear.trains.file.tip_rules import tip_problems
from solidgear.trains.file.tooth_fit import parting_teeth
from solidgear.trains.file.train import Train
from solidgear.trains.load.contact import axes_of, other_flank

#: share of the largest mesh force of a train that is rounding
IDLE = 1e-9
#: bore below which a wheel is solid, of its root radius; least rim below the roots, modules
SMALL_BORE, LEAST_RIM = HUB, 2 * PORT


@dataclass(frozen=True)
class TeethModel:
    """How teeth are modelled.

    Attributes
    ----------
    name : {"slices", "solid"}
        Plane strain in slices of the face, or finite elements in 3D.
    slices, positions : int
        Of the face, and of a mesh cycle.
    coarse : bool
        Whether finite elements are twice as large.
    depth : float
        Depth of readings below the flank, modules.
    spread : float
        How far a slice moves others along the face, modules; of slices alone.
    beside : bool
        Whether wheels are as stiff as a thick shaft beside the face makes them: solid whatever their
        bore, and not bent out of their plane.

    Examples
    --------
    >>> quick = TeethModel(slices=12, positions=8)
    >>> quick.name, quick.slices
    ('slices', 12)
    """

    name: Literal["slices", "solid"] = "slices"
    slices: int = 24
    positions: int = POSITIONS
    coarse: bool = False
    depth: float = DEPTH
    spread: float = SPREAD
    beside: bool = False

    def compliance(self, wheel: Wheel, body: WheelBody) -> FlankCompliance:
        """Return the compliance of a wheel's teeth."""
        depth = self.depth * wheel.module
        bore = None if self.beside else body.bore
        if self.name == "slices":
            return HelicalSlices.of(
                wheel,
                body.face_width,
                self.slices,
                bore,
                body.elasticity,
                self.coarse,
                depth,
                self.spread,
                disc=not self.beside,
            )
        solid = SolidTeeth(
            wheel,
            hold=bore,
            reading_depth=depth,
            elasticity=body.elasticity,
            free=bore is not None,
            hand=body.hand,
            width=body.face_width,
            offset=body.offset,
            slices=self.slices,
        )
        return solid.coarser if self.coarse else solid


@dataclass(frozen=True)
class WheelBody:
    """What carries the teeth of a wheel, and the face that it shares."""

    elasticity: Elasticity
    #: radius of the bore of its shaft, m; None where it is solid
    bore: float | None
    hand: int  #: as of :class:`solidgear.teeth.compliance.solid.SolidTeeth`
    face_width: float  #: shared, m
    offset: float  #: of its middle from that of the wheel's face, m


def teeth_of(mesh: Pair | PlanetMesh, coast: bool) -> MeshTeeth:
    """Return the wheels of a mesh; refused where the file does not give them."""
    teeth = wheels_of(mesh, coast)
    path = mesh.paths["pinion"] if isinstance(mesh, Pair) else ("planetary", mesh.stage.called)
    if teeth is None:
        raise SceneError(
            "is missing; contact of teeth needs it, or a pitch radius", path=(*path, "module")
        )
    if not teeth.wheels.face_width > 0:
        if isinstance(mesh, PlanetMesh):
            raise SceneError("has no face_width; contact of teeth needs it", path=(*path, "sun"))
        raise SceneError(
            "is missing; contact of teeth needs it of one of both wheels",
            path=(*path, "face_width"),
        )
    if parting := parting_teeth(teeth.wheels):
        raise SceneError(parting, path=(*path, "teeth" if isinstance(mesh, Pair) else "mesh"))
    cutting = tip_problems(mesh, teeth.wheels, solved=True)
    if isinstance(mesh, Pair):
        cutting = mesh.with_file_paths(cutting)
    for problem in cutting:
        raise problem if isinstance(mesh, Pair) else problem.located(None, prefix=path)
    return teeth


def toothed(mesh: Pair | PlanetMesh, teeth: MeshTeeth, model: TeethModel) -> CylindricalPair:
    """Return both wheels with their compliance."""
    wheels = teeth.wheels
    first, second = wheel_bodies(mesh, teeth)
    compliances = model.compliance(wheels.first, first), model.compliance(wheels.second, second)
    law = LineContact(
        (first.elasticity, second.elasticity), (compliances[0].depth, compliances[1].depth)
    )
    return CylindricalPair(wheels, compliances, law, teeth.shapes, model.slices)


def wheel_bodies(mesh: Pair | PlanetMesh, teeth: MeshTeeth) -> tuple[WheelBody, WheelBody]:
    """Return what carries the teeth of both wheels."""
    wheels = teeth.wheels
    bodies = []
    for wheel, gear, hand, middle in zip(
        (wheels.first, wheels.second), gears_of(mesh), (1, -1), wheels.face_middles
    ):
        material = Elasticity() if gear is None else _elasticity(gear)
        bore = None if gear is None else _bore(gear, wheel)
        bodies.append(WheelBody(material, bore, hand, wheels.face_width, -middle))
    return bodies[0], bodies[1]


def rims_of(wheels: WheelPair, bodies: Sequence[WheelBody]) -> tuple[float | None, float | None]:
    """Return how thick both wheels are from their bores to the roots of their teeth, modules; None of
    solid ones and rings.
    """
    first, second = (
        None if body.bore is None else (wheel.root - body.bore) / wheel.module
        for wheel, body in zip((wheels.first, wheels.second), bodies)
    )
    return first, second


def assumed_bodies(mesh: Pair | PlanetMesh) -> tuple[str, ...]:
    """Return sentences on the bodies of wheels that the file does not describe."""
    if isinstance(mesh, Pair):
        heads = [side for side, gear in zip(mesh.shafts, gears_of(mesh)) if gear and gear.head]
        return tuple(
            f"wheel of the {side} of its shaft's material, solid to the shaft" for side in heads
        )
    ring = f"ring of steel, with a rim of {RIM:g} modules that is held around its outside"
    return ("planets of steel, solid", *([ring] if mesh.mate == "ring" else []))


def _elasticity(gear: Member) -> Elasticity:
    return Elasticity(*elasticity_of(gear))


def _bore(gear: Member, wheel: Wheel) -> float | None:
    """Return the radius of the bore of a gear's shaft, m, or none where it is solid: a wheel that is no
    part of its shaft sits on it, and both carry the teeth together.
    """
    y = gear.scene.port.y
    bore = max((segment.radius_at(y)[0] for segment in gear.scene.segments_at(y)), default=0.0)
    if bore > wheel.root - LEAST_RIM * wheel.module:
        raise SceneError(
            f"leaves no rim: a bore of {in_mm(2 * bore)} at the gear, whose teeth have their roots at "
            f"{in_mm(2 * wheel.root)} across; correct the bore, the teeth or their module",
            path=("scene",),
        )
    return bore if bore > SMALL_BORE * wheel.root else None


def mesh_contact(
    carried: Carried, mesh: Pair | PlanetMesh, model: TeethModel | None = None
) -> MeshContact:
    """Solve the contact of a mesh over its cycle where its train is carried; the mesh may be that of a
    train which differs from it in the shapes of flanks alone.
    """
    model = model or TeethModel()
    teeth = teeth_of(mesh, carried.coast(mesh))
    bodies = wheel_bodies(mesh, teeth)
    wheels = teeth.wheels, model, bodies
    if wheels not in carried.pairs:
        carried.pairs[wheels] = toothed(mesh, teeth, model)
    contact = carried.pairs[wheels].with_shapes(teeth.shapes)
    place = carried.place(mesh, teeth)
    supports = carried.supports(mesh, place, Frame.of(place, teeth))
    torque = carried.force(place) * teeth.wheels.first.base * np.cos(teeth.wheels.base_helix)
    base = teeth.wheels.first.base
    return MeshContact(
        name=mesh.name,
        pair=contact,
        along=teeth.along[0],
        rims=rims_of(teeth.wheels, bodies),
        supports=supports,
        cycle=mesh_cycle(contact, torque, base, model.slices, supports, model.positions),
        assumed=(*teeth.assumed, *assumed_bodies(mesh)),
    ).within_reach()


def solved_mesh(
    carried: Carried, mesh: Pair | PlanetMesh, model: TeethModel | None = None
) -> MeshContact | BevelContact:
    """Solve the contact of any mesh over its cycle; bevel teeth are of slices."""
    if isinstance(mesh, Pair) and mesh.mesh.shaft_angle:
        model = model or TeethModel()
        materials = [_elasticity(member) for member in mesh.members.values()]
        both = materials[0], materials[1]
        return bevel_contact(carried, mesh, both, model.slices, model.positions)
    return mesh_contact(carried, mesh, model)


class TeethOfTrain:
    """Teeth of a train whose meshes with ``stiffness = "teeth"`` are to have numbers.

    Shafts are reduced once and wheels solved once for all operating points and bearings.

    Examples
    --------
    >>> import solidgear as sg
    >>> train = sg.load_train("geometry/gearbox_train.toml")
    >>> mesh = train.meshes[0].with_changes(stiffness="teeth")
    >>> teeth = TeethOfTrain(train.with_changes(meshes=(mesh,)))
    >>> full, coast = (teeth.at(point).meshes[0].stiffness for point in train.operation)
    >>> 2e9 > full > coast > 5e8
    True
    """

    def __init__(self, train: Train):
        self.train = train
        #: wheels whose contact was solved, as of :class:`solidgear.teeth.supports.Carried`
        self._pairs: dict[Any, CylindricalPair] = {}
        self._assembly: Assembly | None = None

    def at(self, point: OperatingPoint, choice: Choice = AS_STATED, varies: str = "") -> Train:
        """Return the train with the numbers of its teeth at an operating point, at a place in the ranges
        of its bearings: tangent stiffness, and of pairs mesh point, line of action and the orders of
        the loaded transmission error.

        Parameters
        ----------
        point : OperatingPoint
        choice : Choice
        varies : str
            Name of a pair whose stiffness is to vary over its mesh cycle, for nonlinear motion; its
            transmission error is then what is left of the loaded one.

        Raises
        ------
        SolidgearError
            For teeth that the file does not describe, and a point without a torque.
        """
        if self._assembly is None:
            self._assembly = Assembly(with_sections(with_usual_meshes(self.train)))
        operating = on_beams(self._assembly, choice)
        carried = Carried(operating, operating.at(point), self._pairs)
        return with_teeth(self.train, carried, varies)


def with_teeth(train: Train, carried: Carried, varies: str = "") -> Train:
    """Return a train whose meshes with ``stiffness = "teeth"`` have the numbers of their teeth where it
    is carried: the train itself, or one that differs in the shapes of flanks alone.
    """
    meshes, planetary, cautions = [*train.meshes], dict(train.planetary), list[str]()
    largest = max(map(abs, carried.state.mesh_forces.values()), default=0.0)
    for k, (pair, mesh) in enumerate(zip(train.pairs, train.meshes)):
        if mesh.stiffness != TEETH:
            continue
        if abs(carried.state.mesh_forces[pair.name]) <= IDLE * largest:
            meshes[k] = with_usual_meshes(train).meshes[k]
            cautions.append(
                f"{pair.name}: no torque presses these teeth together, so that a usual stiffness "
                "stands in for that of contact"
            )
        else:
            solved = solved_mesh(carried, pair)
            meshes[k] = _filled(carried, pair, mesh, solved, pair.name == varies)
            cautions += solved.cautions
    for stage in train.stages:
        table = planetary[stage.called]
        of_stage = _solved_of_stage(carried, stage, table.mesh)
        planetary[stage.called] = table.with_changes(mesh=_of_stage(of_stage, table.mesh))
        cautions += (text for _, contact in of_stage for text in contact.cautions)
    filled = train.with_changes(meshes=tuple(meshes), planetary=planetary)
    return filled.with_solved_meshes(SolvedMeshes(cautions=tuple(dict.fromkeys(cautions))))


def _solved_of_stage(
    carried: Carried, stage: Stage, table: PlanetMeshes
) -> list[tuple[PlanetMesh, MeshContact]]:
    """Return the contact of those teeth of a stage's first planet that are to give a stiffness."""
    return [
        (mesh, mesh_contact(carried, mesh))
        for mesh in stage.meshes
        if mesh.planets == (1,) and getattr(table, f"{mesh.mate}_stiffness") == TEETH
    ]


def _of_stage(
    solved: Sequence[tuple[PlanetMesh, MeshContact]], table: PlanetMeshes
) -> PlanetMeshes:
    """Return the table of a stage's meshes with the stiffness and the transmission error of the teeth of
    its first planet.
    """
    changes: dict[str, Any] = {}
    for mesh, contact in solved:
        cycle = contact.cycle
        changes[f"{mesh.mate}_stiffness"] = float(cycle.tangent.mean())
        if mesh.error is None or table.status == "assumed":
            changes[f"{mesh.mate}_error"] = _orders(cycle.line_error)
    return table.with_changes(**changes, status="calculated") if changes else table


def _orders(error: np.ndarray) -> ErrorTable:
    """Return the orders of a transmission error over a mesh cycle."""
    orders = harmonics(error, ORDERS)
    return ErrorTable(
        orders=tuple(np.abs(orders).tolist()), phases=tuple(np.angle(orders).tolist())
    )


def _filled(
    carried: Carried, pair: Pair, mesh: Mesh, solved: MeshContact | BevelContact, varies: bool
) -> Mesh:
    """Return the table of a mesh with the numbers of its teeth."""
    cycle = solved.cycle
    changes: dict[str, Any] = {"stiffness": float(cycle.tangent.mean()), "status": solved.status}
    if isinstance(solved, BevelContact) and mesh.gear_position is None:
        changes["gear_position"] = solved.gear_position
    error = cycle.line_error
    if varies:
        error = cycle.parametric_error
        angle = np.append(cycle.phases, 1.0) * 2 * np.pi / pair.pinion.teeth
        stiffness = np.append(cycle.tangent, cycle.tangent[0])
        changes["stiffness_cycle"] = StiffnessCycle(
            angle=tuple(angle.tolist()), stiffness=tuple(stiffness.tolist())
        )
    if mesh.transmission_error is None or mesh.transmission_error_status == "assumed":
        changes["transmission_error"] = _orders(error)
        changes["transmission_error_status"] = solved.status
    point, normal = in_pinion_frame(carried, pair, solved)
    place, mean = point.mean(axis=0), normal.mean(axis=0)
    mean = mean / np.linalg.norm(mean)
    if carried.point.coast:  # a file has the line of the flank that it names
        mean = other_flank(pair.rolling, mean, place)
    changes |= {
        "line_of_action": tuple(mean.tolist()),
        "point": tuple(place.tolist()),
        "line_of_action_status": solved.status,
    }
    return mesh.with_changes(**changes)


def in_pinion_frame(
    carried: Carried, pair: Pair, solved: MeshContact | BevelContact
) -> tuple[np.ndarray, np.ndarray]:
    """Return mesh points from the pinion's lumped point and lines of action, (p, 3) each, in the frame
    of the pinion.
    """
    port = carried.system.port(f"{pair.shafts[0]}.{pair.ports[0]}")
    frame = solved.supports.frame
    turn = axes_of(pair, "pinion").T @ port.axes.T
    points = frame.origin - port.point + solved.cycle.points @ frame.axes.T
    return points @ turn.T, solved.cycle.lines_of_action @ frame.axes.T @ turn.T
