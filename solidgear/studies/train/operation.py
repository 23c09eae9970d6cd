r"""A train at an operating point: mesh force, settled bearings, and how all parts lie.

A torque T on one shaft is carried by the teeth with ``F = |T| / |h|`` along their line of action, h
the lever of that shaft (the fifth component of its mesh vector), and leaves by the other shaft's
rotor.  Displacements are small against all lengths, so that the line of action stays where it is;
bearings of catalogue data settle together with the deflection of both shafts and of the mesh
(:mod:`solidgear.system.equilibrium`).

A positive torque loads the flank that the file names, a negative one the other: its normal is the
first one mirrored at the normal m of the pitch surface, ``n' = 2 (n . m) m - n``, which turns the
tangential and the spiral part of a tooth force round and leaves the part of the pressure angle.
"""

from __future__ import annotations

from collections.abc import Iterator
from copy import copy
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from solidgear.bearings.catalogued import Catalogued
from solidgear.bearings.solved import AS_STATED, Choice, catalogued_bearings
from solidgear.errors import SceneError, SolidgearError, listed
from solidgear.scene.operation import OperatingPoint
from solidgear.scene.train import Train
from solidgear.studies.deflection import seats_of
from solidgear.studies.train.housing import under
from solidgear.studies.train.layout import mesh_forces, rotor_torques
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.own_loads import refuse_own_loads, scene_load
from solidgear.studies.train.planet_loads import flung, held_against_weight
from solidgear.studies.train.stages import mesh_row
from solidgear.system.equilibrium import OnBearings, Seats, SystemEquilibrium, weight
from solidgear.system.port_forces import port_forces
from solidgear.system.system import System

#: model of all shafts on which bearings settle: loads hang little on how shoulders are modelled
SHAFT = "timoshenko"
LOOP = (
    "meshes of a loop divide the torque by their stiffness, as if all of their teeth touched without "
    "load: errors of teeth and places shift it"
)


@dataclass(frozen=True, eq=False)
class OperatingState:
    """A train at rest at one operating point."""

    point: OperatingPoint
    models: dict[str, str]  #: by shaft
    #: along the line of action, N, by mesh; zero of one that the torque does not pass
    mesh_forces: dict[str, float]
    equilibrium: SystemEquilibrium  #: of all parts; the spring port of the engine does not turn
    #: without the bearings, in whose coordinates the equilibrium is told
    system: System = field(repr=False)
    made: dict[str, Catalogued] = field(repr=False)  #: bearings of catalogue data, by ``side.name``
    #: loads from outside on ports of parts: torques of both rotors and other forces
    outside: dict[str, np.ndarray] = field(repr=False)
    notes: tuple[str, ...] = ()  #: what is to be said of it, one sentence each

    @property
    def mesh_force(self) -> float:
        """That of the first mesh, N."""
        return next(iter(self.mesh_forces.values()))

    @property
    def coordinates(self) -> np.ndarray:
        """(N,) coordinates of the system."""
        return self.equilibrium.coordinates

    def motion(self, end: str) -> np.ndarray:
        """Motion (6,) of a port such as ``pinion.A``, m and rad, in the axes of its scene."""
        return self.system.motion(end) @ self.coordinates

    def forces(self) -> dict[str, np.ndarray]:
        """Force (6,) of everything but weight on each port of a shaft: teeth, springs, bearings, and loads from
        outside, N and N m, in the axes of its scene.
        """
        out = port_forces(self.system, self.coordinates)
        for end, six in self.outside.items():
            out[end] = out.get(end, np.zeros(6)) + six
        for end, six in self.equilibrium.load.items():
            out[end] = out.get(end, np.zeros(6)) - six
        return out


class Operating:
    """A train with its shafts at two models, to be settled at any operating point.

    Parameters
    ----------
    workshop : Workshop
        Its bearings of catalogue data may have no stiffness yet.
    *models : str
        One for each shaft, or one for all: bodies or ``rigid``.
    choice : Choice
        Place in the ranges of catalogue data.

    Raises
    ------
    SceneError
        For bearings with a load of their own, or data that describe none.

    Examples
    --------
    >>> import solidgear as sg
    >>> from solidgear.scene.operation import OperatingPoint
    >>> shop = Workshop(sg.load_train("geometry/axle_straddle.toml"))
    >>> found = Operating(shop).at(OperatingPoint(torque=100.0))
    >>> lever = shop.contact.pinion.lever
    >>> round(found.mesh_force * abs(lever), 9)
    100.0
    """

    def __init__(self, workshop: Workshop, *models: str, choice: Choice = AS_STATED):
        self.workshop, self.models, self.choice = workshop, models or (SHAFT,), choice
        for side in workshop.train.shafts:
            refuse_own_loads(workshop.train, side)

    @cached_property
    def made(self) -> dict[str, Catalogued]:
        """Bearings of catalogue data, by ``side.name``."""
        out: dict[str, Catalogued] = {}
        train = self.workshop.train
        for side, shaft in train.shafts.items():
            try:
                own = catalogued_bearings(shaft.scene, self.choice)
            except SceneError as error:
                raise error.located(None, prefix=(*train.shaft_path(side), "scene")) from None
            out |= {f"{side}.{name}": one for name, one in own.items()}
        return out

    @cached_property
    def _seats(self) -> tuple[Seats, ...]:
        scenes = self.workshop.scenes.items()
        train, out = self.workshop.train, []
        for side, scene in scenes:
            own = seats_of(side, scene, self.made)
            below = (under(train, side, one.port) for one in own.bearings)
            out.append(replace(own, stands_in=tuple(port for port in below if port is not None)))
        return tuple(out)

    @cached_property
    def _flanks(self) -> dict[bool, OnBearings]:
        return {}

    def _on(self, coast: bool) -> tuple[Workshop, OnBearings]:
        """The train with the flank that carries, without its bearings, and what it rests on."""
        shop = self.workshop.on_flank(coast)
        if coast not in self._flanks:
            system = shop.system(*self.models, bearings=False)
            self._flanks[coast] = OnBearings(system, self._seats)
        return shop, self._flanks[coast]

    def with_points(self, train: Train) -> Operating:
        """The same bearings on the same shafts, in a train that differs in operating points alone."""
        _ = self._seats, self._flanks  # found once for all of them
        out = copy(self)
        out.workshop = self.workshop.with_train(train)
        return out

    def at(self, point: OperatingPoint, start: OperatingState | None = None) -> OperatingState:
        """The train at an operating point.

        Parameters
        ----------
        start : OperatingState, optional
            One of the same train to begin at.

        Raises
        ------
        SolidgearError
            If nothing holds a shaft under its loads.
        """
        point = self.workshop.train.told(point)
        shop, held = self._on(point.coast)
        forces = mesh_forces(shop.train, shop.contacts, point)
        loads, notes = self._loads(shop, point, forces)
        total = held.system.load(loads) + flung(shop, held.system, point)
        if point.weight is not None:
            total = total + weight(held.system, point.gravity)
        same = start is not None and start.point.coast == point.coast
        begin = start.equilibrium if same and start is not None else None
        try:
            found = held.equilibrium(total, begin)
        except SolidgearError as error:
            raise SolidgearError(f"at {point.label}: {error}") from None
        found = _engine_still(found, held.system, shop.train)
        if looped := divided(shop, held.system, found.coordinates, point.label):
            forces = {name: {**forces, **looped}[name] for name in shop.contacts}
            notes.append(LOOP)
        notes += list(_told(found, held.system, point))
        models = shop.mix(self.models)
        own = models, forces, found, held.system, self.made, loads
        return OperatingState(point, *own, tuple(notes))

    def _loads(
        self, shop: Workshop, point: OperatingPoint, forces: dict[str, float]
    ) -> tuple[dict[str, np.ndarray], list[str]]:
        """Loads at ports beside the mesh forces, which the torques of engine and load bring about."""
        loads, notes = torques(shop, point), []
        for outside in point.force:
            loads[outside.at] = loads.get(outside.at, np.zeros(6)) + outside.six
        for end, torque in held_against_weight(shop, point).items():
            loads[end] = loads.get(end, np.zeros(6)) + torque * np.eye(6)[4]
            notes.append(
                f"at {point.label} the weight of planets turns {end} by {abs(torque):.4g} N m: it is "
                "balanced there, and no shaft carries it"
            )
        for side, scene in shop.scenes.items():
            added, said = scene_load(shop, side, forces)
            notes += said
            if added is not None:
                end = f"{side}.{scene.port.name}"
                loads[end] = loads.get(end, np.zeros(6)) + added
        return loads, notes


def torques(workshop: Workshop, point: OperatingPoint) -> dict[str, np.ndarray]:
    """(6,) torques of engines and loads."""
    found = rotor_torques(workshop.train, workshop.contacts, point)
    return {name: torque * np.eye(6)[4] for name, torque in found.items()}


def mean_forces(workshop: Workshop, point: OperatingPoint) -> dict[str, float]:
    """Forces of all meshes at an operating point, N, of a planetary stage those of each planet; those
    of a loop as Timoshenko shafts divide them under all that loads the train there.
    """
    if None in workshop.train.flows.values():
        return Operating(workshop).at(point).mesh_forces
    return mesh_forces(workshop.train, workshop.contacts, point)


def divided(
    workshop: Workshop, system: System, coordinates: np.ndarray, where: str
) -> dict[str, float]:
    """Forces of meshes that a loop makes share the torque by their stiffness, N, by mesh; their teeth
    all touch where nothing is loaded.

    Raises
    ------
    SolidgearError
        For teeth that would have to pull.
    """
    out = {}
    for name in (name for name, flow in workshop.train.flows.items() if flow is None):
        row, stiffness = mesh_row(system, name)
        out[name] = -stiffness * float(row @ coordinates)
        if not out[name] > 0:
            raise SolidgearError(
                f"at {where}: the teeth of the {name} would have to pull with {-out[name]:.4g} N, so "
                "that the loop of meshes carries its torque: name the other flank of its gears, or "
                "another torque"
            )
    return out


def _engine_still(found: SystemEquilibrium, system: System, train: Train) -> SystemEquilibrium:
    """The same with the train turned until the port of the engine's spring has no rotation."""
    turning = _rotation(system, [*train.shafts])
    row = system.motion(f"{train.reference}.{train.spring_port(train.engines[0])}")[4]
    moved = float(row @ turning)
    if moved == 0.0:
        return found
    share = float(row @ found.coordinates) / moved
    return replace(found, coordinates=found.coordinates - share * turning)


def _rotation(system: System, shafts: list[str]) -> np.ndarray:
    """(N,) free motion of the train that moves no seat of a bearing but about its axis."""
    free = system.free
    ends = [f"{side}.{p}" for side in shafts for p in system.parts[side].ports]
    still = np.vstack([system.motion(end)[[0, 1, 2, 3, 5]] for end in ends]) @ free
    _, _, vectors = np.linalg.svd(still)
    return free @ vectors[-1]


def _told(found: SystemEquilibrium, system: System, point: OperatingPoint) -> Iterator[str]:
    for end in found.lost:
        yield (
            f"at {point.label} bearing {end} carries nothing: its clearance is not taken up, and it "
            "has no stiffness"
        )


def settled(train: Train, state: OperatingState) -> Train:
    """A train at one operating point, its bearings with the stiffness that they have there.

    Returns
    -------
    Train
        With that point alone.
    """
    shafts = {}
    for side, shaft in train.shafts.items():
        bearings = [
            b if b.catalogue is None else b.with_changes(matrix=_symmetric(state, side, b.name))
            for b in shaft.scene.bearings
        ]
        scene = shaft.scene.with_changes(bearings=tuple(bearings))
        shafts[side] = shaft.with_changes(scene=scene)
    point = state.point.with_changes(share=None, hours=None)
    return train.with_changes(operation=(point,), shafts=shafts)


def _symmetric(state: OperatingState, side: str, name: str) -> np.ndarray:
    """Tangent of a bearing; friction at speed leaves a part that is no spring."""
    tangent = state.equilibrium.tangent[f"{side}.{name}"]
    return (tangent + tangent.T) / 2


def at_point(train: Train, word: str | int | None = None) -> Train:
    """A train with its bearings settled at one of its operating points.

    Parameters
    ----------
    word : str or int, optional
        Name of the point, or its number counted from one; by default the first, and the train keeps
        the others.

    Raises
    ------
    SolidgearError
        If it has no such point, or nothing holds a shaft there.

    Examples
    --------
    >>> import solidgear as sg
    >>> train = sg.load_train("geometry/axle_straddle.toml")
    >>> points = ({"torque": 100.0, "name": "drive"}, {"torque": "-30 N*m", "name": "coast"})
    >>> at_point(train.with_changes(operation=points), "coast").point.torque
    -30.0
    """
    point = train.operation[0] if word is None and train.operation else named_point(train, word)
    found = settled(train, Operating(Workshop(train)).at(point))
    return found if word is not None else found.with_changes(operation=train.operation)


def named_point(train: Train, word: str | int | None) -> OperatingPoint:
    """Operating point of a train by its name or its number, counted from one.

    Raises
    ------
    SolidgearError
        If it has no such point.
    """
    if not train.operation:
        raise SolidgearError(
            f"{train.name} has no operating point; write [operation] with a torque in its file"
        )
    for k, point in enumerate(train.operation, start=1):
        if word in (point.name, k, str(k)) and word != "":
            return point
    known = [
        f"{k}" + (f" {p.name!r}" if p.name else "") for k, p in enumerate(train.operation, start=1)
    ]
    raise SolidgearError(f"no operating point {word!r}; there are {listed(known)}")
