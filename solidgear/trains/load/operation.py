r"""A train at an operating point: mesh force, settled bearings, and how all parts lie.

A torque T on one shaft is carried by the teeth with ``F = |T| / |h|`` along their line of action, h
the lever of that shaft (the fifth component of its mesh vector), and leaves by the other shaft's
rotor.  Displacements are small against all lengths, so that the line of action stays where it is;
bearings of catalogue data settle together with the deflection of both shafts and of the mesh
(:mod:`solidgear.trains.system.equilibrium`).

A positive torque loads the flank that the file names, a negative one the other: its normal is the
first one mirrored at the normal m of the pitch surface, ``n' = 2 (n . m) m - n``, which turns the
tangential and the spiral part of a tooth force round and leaves the part of the pressure angle.
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from copy import copy
from dataclasses import replace
from functools import cached_property

import numpy as np

from solidgear.bearings.catalogued import Catalogued
from solidgear.bearings.solved import AS_STATED, Choice, catalogued_bearings, wants_equilibrium
from solidgear.core import Body, SceneError, SolidgearError, System, listed
from solidgear.core.bounds.refining import Meshed
from solidgear.core.loading import MESH
from solidgear.core.scene.acting import station_loads
from solidgear.core.scene.load_rules import named_case
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.housing import housing_port
from solidgear.trains.assembly.layout import force_on, mesh_forces, rotor_torques
from solidgear.trains.assembly.mesh_errors import refine_meshes
from solidgear.trains.assembly.shaft import JUDGE, Level
from solidgear.trains.assembly.stages import mesh_row
from solidgear.trains.file.operation import OperatingPoint, ShaftCase
from solidgear.trains.file.train import ALONE, Train
from solidgear.trains.load.meshes_at_rest import MeshesAtRest
from solidgear.trains.load.own_weight import weight_at_rest
from solidgear.trains.load.planet_loads import carrier_torques, centrifugal_load
from solidgear.trains.load.state import OperatingState, with_settled_bearings
from solidgear.trains.load.static_errors import StaticErrors
from solidgear.trains.load.twist import held_torques, rotation, turned_back
from solidgear.trains.system.equilibrium import (
    OnBearings,
    Seats,
    SystemEquilibrium,
    seats_of,
)

#: a [load] of a scene that is off the mesh force by less, of it, is that force written down
SAME_LOAD = 0.05
#: trains at rest that are kept: one on each flank, or the last two whose teeth or speeds differ
FLANKS = 2
#: stiffness of a bearing across its load, over that along it, that is rounding
BARE = 1e-12
LOOP = (
    "meshes of a loop divide the torque by their stiffness; errors of teeth and positions, which "
    "shift it, are left out"
)


class Operating:
    """A train with the shafts at models (bodies or ``rigid``, one for each shaft or one for all; by
    default those that deflection trusts, on which loads and lives of bearings rest), to be settled at
    any operating point; `choice` is the place in the ranges of catalogue data, and bearings with a
    load of their own are refused.

    Examples
    --------
    >>> import solidgear as sg
    >>> from solidgear.trains.file.operation import OperatingPoint
    >>> assembly = Assembly(sg.load_train("geometry/axle_straddle.toml"))
    >>> found = Operating(assembly).at(OperatingPoint(torque=100.0))
    >>> lever = assembly.contact.pinion.lever
    >>> round(found.mesh_force * abs(lever), 9)
    100.0
    """

    def __init__(self, assembly: Assembly, *models: str, choice: Choice = AS_STATED):
        if not models:
            assembly, models = assembly.at_ports(), assembly.solids
        self.assembly, self.models, self.choice = assembly, models, choice
        if assembly.train.is_one_shaft:
            return
        for side in assembly.train.shafts:
            refuse_own_loads(assembly.train, side)

    def _bearings(self, point: OperatingPoint) -> dict[str, Catalogued]:
        """Return the bearings of catalogue data at the speeds of a point, by ``side.name``."""
        out: dict[str, Catalogued] = {}
        train = self.assembly.train
        for side, shaft in train.shafts.items():
            speed = point.speed_of(side, train.turns)
            try:
                shaft_bearings = catalogued_bearings(shaft.scene, self.choice, speed)
            except SceneError as error:
                raise error.located(None, prefix=(*train.shaft_path(side), "scene")) from None
            out |= {f"{side}.{name}": catalogued for name, catalogued in shaft_bearings.items()}
        return out

    def _seats(self, bearings: Mapping[str, Catalogued]) -> tuple[Seats, ...]:
        scenes = self.assembly.scenes.items()
        train, out = self.assembly.train, []
        for side, scene in scenes:
            seats = seats_of(side, scene, bearings)
            ports = (housing_port(train, side, seat.port) for seat in seats.bearings)
            out.append(replace(seats, stands_in=tuple(port for port in ports if port is not None)))
        return tuple(out)

    @cached_property
    def _turning(self) -> dict[float | None, tuple[dict[str, Catalogued], tuple[Seats, ...]]]:
        """Bearings of catalogue data and the seats with them, at the last speeds of the first shaft."""
        return {}

    @cached_property
    def _meshing(self) -> dict[Hashable, OnBearings]:
        """The last trains that were put at rest, by the load or the flank on which they mesh alike."""
        return {}

    def _at(self, point: OperatingPoint) -> tuple[Assembly, dict[str, Catalogued], OnBearings]:
        """Return the train as it meshes at an operating point, without the bearings, those of catalogue
        data, and the seats that it rests on.
        """
        assembly = self.assembly.at(point, self.choice)
        alike = assembly.teeth.load_that_counts(point) or point.coast
        turning = point.speed_of(next(iter(assembly.scenes)), assembly.train.turns)
        if turning not in self._turning:
            _make_room(self._turning)
            bearings = self._bearings(point)
            self._turning[turning] = bearings, self._seats(bearings)
        bearings, seats = self._turning[turning]
        if alike not in self._meshing:
            _make_room(self._meshing)
            MeshesAtRest(assembly, self.models).begin()
            system = assembly.system(*self.models, bearings=False)
            self._meshing[alike] = OnBearings(system, seats)
        elif self._meshing[alike].seats is not seats:
            self._meshing[alike] = replace(self._meshing[alike], seats=seats)
        return assembly, bearings, self._meshing[alike]

    def with_points(self, train: Train) -> Operating:
        """Return the same bearings on the same shafts, in a train that differs in operating points
        alone.
        """
        _ = self._turning, self._meshing  # the same for all of them
        out = copy(self)
        out.assembly = self.assembly.with_train(train)
        return out

    def at(self, point: OperatingPoint, start: OperatingState | None = None) -> OperatingState:
        """Settle the train at an operating point, from the state `start` of the same train if it is
        on the same flank; refused where nothing holds a shaft under the loads. The first one that
        is settled decides the meshes of harmonic shafts.
        """
        state = self._settled(point, start)
        meshes_at_rest = MeshesAtRest(self.assembly, self.models)
        if not meshes_at_rest.to_be_chosen():
            return state
        if any(mesh.local_harmonics for mesh in self.assembly.train.meshes):
            # forces where teeth touch are not those of ports: the shaft by itself decides
            for side in self.assembly.following(state.models):
                self.assembly.follow_alone(side, JUDGE)
            self._meshing.clear()
            return self._settled(point, None)

        tolerance = meshes_at_rest.tolerance

        def finer() -> tuple[Mapping[str, Meshed | Level], float]:
            errors = StaticErrors(self.assembly, state).of_gears()
            needs = errors.needs(len(errors.bars), tolerance)
            meshes = meshes_at_rest.finer(needs)
            return meshes, float(errors.bars.max(initial=0.0))

        def refine(meshes: Mapping[str, Meshed | Level]) -> None:
            nonlocal state
            before = meshes_at_rest.shafts(meshes)
            try:
                meshes_at_rest.refine(meshes)
                self._meshing.clear()
                state = self._settled(point, None)
            except (SolidgearError, MemoryError):
                # the state before stands, on the meshes that it was solved on
                for shaft in before:
                    self.assembly.add_model(shaft)
                self._meshing.clear()
                raise

        refine_meshes(finer, refine)
        return state

    def _settled(self, point: OperatingPoint, start: OperatingState | None) -> OperatingState:
        """Settle the train on the meshes that its shafts have."""
        point = self.assembly.train.told(point)
        if self.assembly.train.is_one_shaft and point.weight is None:
            (scene,) = self.assembly.scenes.values()
            point = point.with_changes(weight=scene.weight)
        assembly, bearings, seated = self._at(point)
        forces = mesh_forces(assembly.train, assembly.contacts, point)
        loads, notes = self._loads(assembly, point, forces)
        total = seated.system.load(loads) + centrifugal_load(assembly, seated.system, point)
        if point.weight is not None:
            models = assembly.models_by_shaft(self.models)
            total = total + weight_at_rest(assembly, seated.system, models, point)
        begin = None
        if start is not None and start.point.coast == point.coast:
            begin = start.equilibrium
        alone = assembly.train.is_one_shaft
        held = held_torques(assembly, seated.system, loads) if alone else {}
        total = total - seated.system.load({end: t * np.eye(6)[4] for end, t in held.items()})
        try:
            solved = seated.equilibrium(total, begin)
        except SolidgearError as error:
            raise SolidgearError(str(error) if alone else f"at {point.label}: {error}") from None
        solved = _engine_still(solved, seated.system, assembly.train)
        if alone and any(load[4] for load in loads.values()):
            solved = turned_back(assembly, seated.system, solved, held)
        if loop_shares := loop_forces(assembly, seated.system, solved.coordinates, point.label):
            forces = {name: {**forces, **loop_shares}[name] for name in assembly.contacts}
            notes.append(LOOP)
        place = "" if alone else f"at {point.label} "
        notes += [
            f"{place}bearing {end} carries no load within its clearance, so it has no stiffness"
            for end in solved.lost
        ]
        notes += [
            f"{place}bearing {end} carries on one element, and nothing holds it across its load: "
            "motions there have no error bar"
            for end in bearings
            if end in solved.tangent and on_one_element(solved.tangent[end])
        ]
        return OperatingState(
            point=point,
            models=assembly.models_by_shaft(self.models),
            mesh_forces=forces,
            equilibrium=solved,
            assembly=assembly,
            system=seated.system,
            bearings=bearings,
            outside=loads,
            notes=tuple(notes),
        )

    def _loads(
        self, assembly: Assembly, point: OperatingPoint, forces: dict[str, float]
    ) -> tuple[dict[str, np.ndarray], list[str]]:
        """Return loads at ports in addition to the mesh forces, which the torques of engine and load bring
        about, and notes on them.
        """
        loads, notes = rotor_loads(assembly, point), []
        for force in point.force:
            loads[force.at] = loads.get(force.at, np.zeros(6)) + force.six
        for end, torque in carrier_torques(assembly, point).items():
            loads[end] = loads.get(end, np.zeros(6)) + torque * np.eye(6)[4]
            notes.append(
                f"at {point.label} the weight of planets turns {end} by {abs(torque):.4g} N m, "
                "which is balanced there and carried by no shaft"
            )
        for side in assembly.scenes:
            added, sentences = scene_loads(assembly, side, forces, point)
            notes += sentences
            for station, six in added.items():
                end = f"{side}.{station}"
                loads[end] = loads.get(end, np.zeros(6)) + six
        return loads, notes


def _make_room(kept: dict) -> None:
    """Drop the oldest of what is kept where one more would be too many."""
    if len(kept) == FLANKS:
        del kept[next(iter(kept))]


def on_one_element(tangent: np.ndarray) -> bool:
    """Return whether a bearing (6, 6) has stiffness along one direction across the shaft alone."""
    least, largest = np.linalg.eigvalsh(tangent[np.ix_((0, 2), (0, 2))])
    return bool(abs(least) <= BARE * largest and largest > 0)


def refuse_own_loads(train: Train, side: str) -> None:
    """Refuse bearings with a load of their own where a torque brings it."""
    for bearing in train.shafts[side].scene.bearings:
        data = bearing.catalogue
        if data is None:
            continue
        for key in ("load", "displacement"):
            if getattr(data, key) is not None:
                reason = (
                    f"bearing {bearing.name} has a {key}, but in a train with an [operation] its "
                    "load comes from the torque; leave it out"
                )
                raise SceneError(reason, path=(*train.shaft_path(side), "scene"))


def scene_loads(
    assembly: Assembly, side: str, forces: Mapping[str, float], point: OperatingPoint
) -> tuple[dict[str, np.ndarray], list[str]]:
    """Return the loads (6,) by station that the scene of a shaft adds to the mesh force, in a train
    those of its first case, and notes; refused if they are neither the mesh force nor declared as
    added or replaced.
    """
    train, scene = assembly.train, assembly.scenes[side]
    if not scene.is_loaded:
        return {}, []
    if train.is_one_shaft:
        return station_loads(scene, named_case(scene.cases, point.name or None)), []
    loads, word = station_loads(scene), train.shafts[side].scene_load
    if not loads:  # weight alone, which a train has from the operating point
        return {}, []
    load = sum(loads.values(), np.zeros(6))
    if word == "added":
        return loads, [f"the [load] of the {side}'s scene is added to the mesh force"]
    if word == "replaced":
        return {}, []
    if any(train.flows[pair.name] is None for pair in train.pairs if side in pair.shafts):
        raise SceneError(
            f"the [load] of the {side}'s scene may be the mesh force in a loop of meshes; write "
            '"replaced", or "added" where it acts besides the teeth',
            path=(*train.shaft_path(side), "scene_load"),
        )
    flanks = [(assembly.at(p), p) for p in train.operation]
    mesh_loads = [_force_on(s, side, mesh_forces(train, s.contacts, p)) for s, p in flanks]
    mesh_loads.append(_force_on(assembly, side, forces))
    if any(np.linalg.norm(load[:3] - f) <= SAME_LOAD * np.linalg.norm(f) for f in mesh_loads):
        return {}, [f"the [load] of the {side}'s scene equals its mesh force, and is not added"]
    raise SceneError(
        f"the [load] of the {side}'s scene is ({_newtons(load[:3])}) N at its lumped point, and the "
        f"mesh force is ({_newtons(mesh_loads[0])}) N: leave [load] out of the scene, or write "
        f'scene_load = "replaced" under [{".".join(train.shaft_path(side))}], or "added" where it '
        "acts beside the teeth",
        path=(*train.shaft_path(side), "scene_load"),
    )


def _force_on(assembly: Assembly, side: str, forces: Mapping[str, float]) -> np.ndarray:
    """Return the (3,) force of all teeth on a shaft, in the axes of the scene, N; equal planets
    have none.
    """
    forces_on = [
        forces[pair.name] * force_on(pair, side, assembly.contacts[pair.name])[:3]
        for pair in assembly.train.pairs
        if side in pair.shafts
    ]
    return np.sum([np.zeros(3), *forces_on], axis=0)


def _newtons(force: np.ndarray) -> str:
    return ", ".join(f"{v:.0f}" for v in force)


def rotor_loads(assembly: Assembly, point: OperatingPoint) -> dict[str, np.ndarray]:
    """Return (6,) torques of engines and loads, by rotor."""
    by_rotor = rotor_torques(assembly.train, assembly.contacts, point)
    return {name: torque * np.eye(6)[4] for name, torque in by_rotor.items()}


def mean_forces(assembly: Assembly, point: OperatingPoint) -> dict[str, float]:
    """Return the forces of all meshes at an operating point, N, of a planetary stage those of each
    planet; those of a loop as harmonic shafts divide them under all that loads the train there.
    """
    if None in assembly.train.flows.values():
        train = assembly.asked_train.with_solved_meshes(assembly.teeth.solved)
        return before_motion(train, point).mesh_forces
    meshing = assembly.at(point)
    return mesh_forces(meshing.train, meshing.contacts, point)


def loop_forces(
    assembly: Assembly, system: System, coordinates: np.ndarray, place: str
) -> dict[str, float]:
    """Return the forces of meshes that a loop makes share the torque by their stiffness, N, by
    mesh; their teeth all touch where nothing is loaded, and teeth that would have to pull are
    refused.
    """
    out = {}
    for name in (name for name, flow in assembly.train.flows.items() if flow is None):
        row, stiffness = mesh_row(system, name)
        out[name] = -stiffness * float(row @ coordinates)
        if not out[name] > 0:
            raise SolidgearError(
                f"at {place} the teeth of the {name} would have to pull with {-out[name]:.4g} N "
                "to carry the torque of their loop; name the other flank of its gears, or another "
                "torque"
            )
    return out


def _engine_still(solved: SystemEquilibrium, system: System, train: Train) -> SystemEquilibrium:
    """Return the same with the train turned until the port of the engine's spring has no rotation."""
    if not train.engines:
        return solved
    turning = rotation(system, [*train.shafts])
    row = system.motion(f"{train.reference}.{train.spring_port(train.engines[0])}")[4]
    turned = float(row @ turning)
    if turned == 0.0:
        return solved
    factor = float(row @ solved.coordinates) / turned
    return replace(solved, coordinates=solved.coordinates - factor * turning)


def at_point(train: Train, word: str | int | None = None) -> Train:
    """Return a train with bearings settled at an operating point, by name or number
    from one; by default the first, and the train keeps the others.

    Examples
    --------
    >>> import solidgear as sg
    >>> train = sg.load_train("geometry/axle_straddle.toml")
    >>> points = ({"torque": 100.0, "name": "drive"}, {"torque": "-30 N*m", "name": "coast"})
    >>> at_point(train.with_changes(operation=points), "coast").point.torque
    -30.0
    """
    point = train.operation[0] if word is None and train.operation else named_point(train, word)
    settled_train = settled_at(train, point)
    if word is not None:
        return settled_train
    settled = settled_train.with_changes(operation=train.operation)
    return settled.with_solved_meshes(settled_train.solved_meshes)


def settled_at(train: Train, point: OperatingPoint) -> Train:
    """Return a train with bearings settled at an operating point, which is its only one."""
    state = before_motion(train, point)
    solved = replace(state.assembly.teeth.solved, with_bearings=True)
    return with_settled_bearings(train, state).with_solved_meshes(solved)


def before_motion(train: Train, point: OperatingPoint) -> OperatingState:
    """Return the state at rest that motion is about, in which bearings have their stiffness: on
    harmonic shafts of one mesh, as those of a shaft alone (:data:`solidgear.core.loading.MESH`).
    """
    assembly = Assembly(train, kept=1, settings={JUDGE: MESH}).settling(JUDGE)
    return Operating(assembly, JUDGE).at(point)


def body_at_rest(assembly: Assembly) -> Body | None:
    """Return the body of a shaft alone on which loads and lives of its bearings rest, on the mesh that
    its state at rest in the first case decides; None where no bearing waits for the load of the shaft.
    """
    if not wants_equilibrium(assembly.scenes[ALONE]):
        return None
    operating = Operating(assembly)
    operating.at(assembly.train.point or ShaftCase())
    (model,) = operating.models
    return operating.assembly.shaft_model(ALONE, model).body


def named_point(train: Train, word: str | int | None) -> OperatingPoint:
    """Return the operating point of a train by name or number, counted from one."""
    if not train.operation:
        raise SolidgearError(
            f"{train.name} has no operating point; write [operation] with a torque in its file"
        )
    for k, point in enumerate(train.operation, start=1):
        if word in (point.name, k, str(k)) and word != "":
            return point
    names = [
        f"{k}" + (f" {p.name!r}" if p.name else "") for k, p in enumerate(train.operation, start=1)
    ]
    raise SolidgearError(f"no operating point {word!r}; there are {listed(names)}")
