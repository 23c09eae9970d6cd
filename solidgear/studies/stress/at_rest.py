"""Stress of the shafts of a scene or of a train at rest, under the loads of their equilibrium.

A shaft of a train is free but for what acts on its ports: teeth, springs, bearings, the weight of a
wheel on it. A shaft of a scene has its load at the port and the reactions of its bearings. Both are
settled as plain bodies of revolution: what is cut into them moves reactions by next to nothing. Models
that are made for what is cut settle with it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from solidgear.bearings.solved import AS_TOLD, Choice
from solidgear.display import plain
from solidgear.errors import SolidgearError
from solidgear.ladder.registry import LADDER
from solidgear.scene import Scene
from solidgear.scene.body_file import BodyFile
from solidgear.scene.filleted import filleted
from solidgear.scene.operation import OperatingPoint
from solidgear.scene.train import Train
from solidgear.studies.bearing_life import left_open
from solidgear.studies.deflection import ShaftAtRest, load_of
from solidgear.studies.stress.notch import ENOUGH
from solidgear.studies.stress.rating import Conditions
from solidgear.studies.stress.section_forces import COMPONENTS, SectionForces, forces_of
from solidgear.studies.stress.shaft import ShaftStress, check_tolerance, local_stress, shaft_stress
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.operation import Operating, OperatingState

#: model on which shafts and bearings settle, unless told otherwise
MODEL = LADDER.judges[0]
#: what has no error bar, and why
WITHOUT_BAR = "reactions and section forces are those of one mesh; form factors have error bars"

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Acting:
    """Everything that acts on a shaft."""

    loads: dict[str, np.ndarray]  #: by port, N and N m
    gravity: np.ndarray | None = None  #: (3,) m/s^2, in the axes of its scene

    def add(self, port: str, load: np.ndarray) -> None:
        """One more load (6,) on a port."""
        self.loads[port] = self.loads.get(port, np.zeros(6)) + load


@dataclass(frozen=True)
class StressedShaft:
    """Stress of one shaft of a scene or a train."""

    name: str
    scene: Scene = field(repr=False)
    acting: Acting
    found: ShaftStress
    #: least and largest of the largest bending moment, N m, by what the data of bearings leave
    #: open; None where that is nothing
    open_moment: tuple[float, float] | None
    open: Mapping[str, tuple[float, float]]  #: the same of the amplitude on each fillet, Pa

    @property
    def weak(self) -> tuple[str, ...]:
        """Segments with a fillet whose material has no strength."""
        segments = [self.scene.segments[notch.found.corner.owner] for notch in self.found.notches]
        return tuple(dict.fromkeys(s.name for s in segments if s.material.strength is None))


@dataclass(frozen=True)
class Asked:
    """Question asked of fillets.

    Raises
    ------
    SolidgearError
        For a tolerance beyond all meshes.
    """

    tolerance: float = ENOUGH  #: relative bar of form factors at which their meshes stop
    conditions: Conditions = Conditions()  #: of the rating by DIN 743

    def __post_init__(self) -> None:
        check_tolerance(self.tolerance)


@dataclass(frozen=True)
class StressAtRest:
    """Stress of a shaft under its load, or of both shafts of a train at an operating point."""

    title: str
    model: str  #: on which shafts and bearings settled
    #: load of a scene, or operating point and mesh force of a train, as plain data in SI
    under: Mapping[str, Any]
    asked: Asked
    shafts: tuple[StressedShaft, ...]
    open_by: str  #: what the data of bearings leave open, in words; empty for nothing
    cautions: tuple[str, ...] = ()  #: beside the remarks of each shaft

    @property
    def reached(self) -> bool:
        """True where the bars of all form factors are within the tolerance."""
        notches = [notch for shaft in self.shafts for notch in shaft.found.notches]
        return all(notch.found.widest <= self.asked.tolerance for notch in notches)

    def as_dict(self) -> dict[str, Any]:
        """Plain data in SI that JSON can hold."""
        data = plain(self) | {"components": list(COMPONENTS), "shafts": {}}
        data["why_without_bar"] = WITHOUT_BAR
        data["asked"]["conditions"] = self.asked.conditions.model_dump(mode="json")
        for shaft in self.shafts:
            worst = [notch.name for notch in shaft.found.worst]
            data["shafts"][shaft.name] = plain(shaft) | {"worst": worst[0] if worst else None}
        return data


def stress_of_scene(
    scene: Scene,
    model: str = MODEL,
    drive: Mapping[str, float] | None = None,
    asked: Asked = Asked(),
    progress: Progress = lambda text: None,
) -> StressAtRest:
    """Stress of a shaft under the [load] of its scene.

    Torques about the axis, N m, enter at bearings, masses or further points (`drive`); the gear at
    the port takes them out. Shaft and bearings settle on a model; those of catalogue data need no
    stiffness yet.
    """
    file, scene = scene.body, filleted(scene)
    load, port, drive = load_of(scene), scene.port.name, drive or {}
    if port in drive:
        raise SolidgearError(
            f'the torque at "{port}" enters where the gear takes it out: name the bearing, mass or '
            "point where a coupling or spline brings it"
        )
    progress(model)
    at_rest = ShaftAtRest(_settling(scene, model), model)

    def acting(choice: Choice) -> dict[str, Acting]:
        own = Acting({port: load})
        for bearing in at_rest.settled(choice).bearings:
            own.add(bearing.name, -bearing.load)
        for name, torque in drive.items():
            own.add(name, np.array([0, 0, 0, 0, torque, 0.0]))
            own.add(port, np.array([0, 0, 0, 0, -torque, 0.0]))
        return {scene.name: own}

    under = {"port": port, "load": load, "drive": drive}
    shafts, told = _shafts({scene.name: scene}, acting, asked, progress)
    cautions = (*_of_a_file(file, scene), *_not_acting(scene, drive))
    return StressAtRest(scene.title or scene.name, model, under, asked, shafts, told, cautions)


def _of_a_file(file: BodyFile | None, scene: Scene) -> Iterator[str]:
    """Sentences on what the round part of a file leaves out, whose fillets are those of a scene."""
    if file is None:
        return
    if not file.round:
        yield (
            f"{file.name} is not of revolution: stress is that of its round part, without what is cut "
            "into it or stands out"
        )
    if cones := len(file.tori) - len(scene.blends):
        yield (
            f"{cones} of {len(file.tori)} arcs of {file.name} are short cones here, and corners between "
            "them are none of the part: fillets are quarters of a turn at the root of a shoulder, "
            "outside of seats"
        )


def _not_acting(scene: Scene, drive: Mapping[str, float]) -> Iterator[str]:
    """Sentences on what does not act on a shaft, and perhaps should."""
    if not drive:
        yield (
            "no torque runs along the shaft: a [load] has forces and tilting moments; --drive says "
            "where a torque enters"
        )
    for point in scene.further_ports:
        if point.name not in drive:
            yield f'nothing acts at the point "{point.name}": [load] is that of "{scene.port.name}"'


def stress_of_train(
    train: Train,
    point: OperatingPoint,
    model: str = MODEL,
    asked: Asked = Asked(),
    progress: Progress = lambda text: None,
) -> StressAtRest:
    """Stress of all shafts of a train at an operating point; shafts and bearings settle on a model,
    no lumped one, which has no places of its own.
    """
    progress(model)
    files = {side: own.scene.body for side, own in train.shafts.items()}
    round_parts = {
        side: own.with_changes(scene=filleted(own.scene)) for side, own in train.shafts.items()
    }
    train = train.with_changes(shafts=round_parts)
    shop = Workshop(_settling_train(train, model))
    usual = Operating(shop, model).at(point)

    def acting(choice: Choice) -> dict[str, Acting]:
        own = choice == AS_TOLD
        return _on_shafts(shop, usual if own else Operating(shop, model, choice=choice).at(point))

    under = {"point": point.model_dump(mode="json"), "mesh_force": usual.mesh_force}
    shafts, told = _shafts(
        {side: train.shaft(side) for side in train.shafts}, acting, asked, progress
    )
    left_out = [text for k in files for text in _of_a_file(files[k], train.shafts[k].scene)]
    cautions = (*left_out, *usual.notes, *shop.odd, *_without_torque(train))
    return StressAtRest(train.title or train.name, model, under, asked, shafts, told, cautions)


def _on_shafts(shop: Workshop, state: OperatingState) -> dict[str, Acting]:
    """Everything that acts on the shafts of a train at rest."""
    out = {}
    for side, scene in shop.scenes.items():
        turned = state.system.port(f"{side}.{scene.port.name}").axes.T
        gravity = turned @ np.array(state.point.gravity)
        out[side] = Acting({}, gravity if state.point.weight else None)
        for end, head in shop.train.heads(side).values():
            out[side].add(end.partition(".")[2], head.mass * np.r_[gravity, np.zeros(3)])
    for end, six in state.forces().items():
        side, _, port = end.partition(".")
        if side in out:  # an engine and a load only turn
            out[side].add(port, six)
    return out


def _without_torque(train: Train) -> Iterator[str]:
    """Sentences on shafts whose torque enters where the teeth take it out."""
    for name, rotor in train.rotors.items():
        side, port = rotor.shaft, train.spring_port(name)
        if [*train.shafts[side].gears] == [port]:
            yield (
                f"no torque runs along the {side}: {name}.spring is at the teeth "
                f'(at = "{port}"); put it where the torque enters'
            )


def _settling(scene: Scene, model: str) -> Scene:
    """The plain part of a shaft, or all of it on a model that is made for features."""
    return scene if LADDER[model].for_features else scene.plain


def _settling_train(train: Train, model: str) -> Train:
    """A train of such shafts, whose teeth act at their ports."""
    shafts = {
        side: own.with_changes(scene=_settling(own.scene, model))
        for side, own in train.shafts.items()
    }
    meshes = tuple(mesh.with_changes(local_harmonics=()) for mesh in train.meshes)
    return train.with_changes(meshes=meshes, shafts=shafts)


def _shafts(
    scenes: Mapping[str, Scene],
    acting: Callable[[Choice], dict[str, Acting]],
    asked: Asked,
    progress: Progress,
) -> tuple[tuple[StressedShaft, ...], str]:
    """Stress of every shaft, and what the data of bearings leave open, in words."""
    usual = acting(AS_TOLD)
    told, choices = left_open(scenes.values())
    if choices:
        progress("what the data of bearings leave open")
    others = [acting(choice) for choice in choices]
    shafts = []
    for name, scene in scenes.items():
        own = usual[name]
        found = shaft_stress(
            scene,
            own.loads,
            gravity=own.gravity,
            tolerance=asked.tolerance,
            conditions=asked.conditions,
            progress=progress,
        )
        along = [forces_of(scene, one[name].loads, one[name].gravity) for one in others]
        shafts.append(StressedShaft(name, scene, own, found, *_ranges(found, along)))
    return tuple(shafts), told


def _ranges(
    found: ShaftStress, others: Sequence[SectionForces]
) -> tuple[tuple[float, float] | None, dict[str, tuple[float, float]]]:
    """Ranges of the largest bending moment, N m, and of the amplitude on each fillet, Pa, over the
    section forces that were solved and others.
    """
    if not others:
        return None, {}
    moments = [forces.largest_moment for forces in (found.forces, *others)]
    amplitudes = {
        notch.name: [
            notch.local.amplitude,
            *(local_stress(notch.found, forces.at(notch.y)).amplitude for forces in others),
        ]
        for notch in found.notches
    }
    return (min(moments), max(moments)), {k: (min(v), max(v)) for k, v in amplitudes.items()}
