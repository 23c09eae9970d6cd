"""Models of the shafts of a train, and the system that they make.

The meshes of harmonic shafts follow the error bars of the train's modes, as those of one shaft do
(:mod:`solidgear.core.bounds.refining`), unless an option sets them.  A mesh is chosen once, and kept
for bearings, housings and operating points that vary.

A further model of one shaft is added by ``add_part`` or ``add_model``; of all shafts, its name here.
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field, replace
from time import perf_counter

import numpy as np
from numpy.typing import ArrayLike

from solidgear.bearings.solved import AS_STATED, Choice
from solidgear.core import (
    LADDER,
    Body,
    Scene,
    SolidgearError,
    System,
    build,
    listed,
    nearest,
    pinned,
    read_tolerance,
    rubin,
    show,
)
from solidgear.core.bounds.refining import Meshed, refined
from solidgear.core.ladder import solid_of
from solidgear.core.reduction.craig_bampton import craig_bampton
from solidgear.core.system.gear_mesh import MeshVector
from solidgear.core.system.links import Link, PortInertia, grounded, mesh_spring, torsion_spring
from solidgear.core.system.parts import Inertia, Part, Placed, RigidBody
from solidgear.trains.assembly.cautions import train_cautions
from solidgear.trains.assembly.housing import (
    housing_losses,
    housing_part,
    links_on_housing,
    mount_links,
)
from solidgear.trains.assembly.layout import contacts, places
from solidgear.trains.assembly.local import local_teeth, mesh_port
from solidgear.trains.assembly.matrices_body import (
    MATRICES,
    matrices_body,
)
from solidgear.trains.assembly.mesh_errors import (
    MeshErrors,
    Need,
    flexibility_errors,
    highest_resolved,
    mesh_errors,
    refine_meshes,
    resolving,
)
from solidgear.trains.assembly.mesh_stiffness import TeethAtRest
from solidgear.trains.assembly.shaft import (
    JUDGE,
    LUMPED,
    RIGID,
    Level,
    ShaftModel,
    checked_model,
    lumped,
    names_from,
)
from solidgear.trains.assembly.stages import StageAtWork, stages_at_work
from solidgear.trains.file.housing import HOUSING
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.train import Train
from solidgear.trains.load.contact import Contact

REDUCTIONS = {"rubin": rubin, "craig_bampton": craig_bampton}
#: free modes of a shaft that are kept: with residuals, enough for 1e-5 to 4 kHz, as the bound shows
KEPT = 24
#: modes kept of a shaft at rest, which needs none: they are half of what a 3D body costs
NO_MODES = 0


@dataclass(eq=False)
class Assembly:
    """Models of the shafts of a train, each built once, and all that studies read of the train
    with them: scenes, mesh contacts, places, planetary stages, on the flanks that carry.

    Examples
    --------
    >>> import solidgear as sg
    >>> assembly = Assembly(sg.load_train("geometry/axle_overhung.toml"))
    >>> system = assembly.system("timoshenko", "euler")
    >>> list(system.parts), system.modes(3).frequency_hz.round(1)
    (['engine', 'pinion', 'gear', 'load'], array([  0. ,  16.3,  55.4, 732.4]))
    """

    train: Train
    reduction: str = "rubin"
    kept: int = KEPT  #: modes of each shaft; with none it is exact at rest, and solves no modes
    #: builder options of models, by their names; of one shaft by (side, model), before those
    settings: Mapping[str | tuple[str, str], Mapping] = field(default_factory=dict)
    #: relative error that the meshes of harmonic shafts may leave; by default the tolerance of the
    #: file over the share of it that a judge may take
    tol: float | str | None = None
    highest_hz: float | None = None  #: up to which modes are wanted; by default that of the file
    #: true for bodies of the plain parts of shafts by models that do not hold their cuts; the shafts
    #: keep their mass
    plain_bodies: bool = False

    @classmethod
    def of(cls, scene: Scene, kept: int = KEPT, tol: float | str | None = None) -> Assembly:
        """Return the assembly of one shaft; with any number of modes that are `kept` it is exact
        at rest.

        Examples
        --------
        >>> import solidgear as sg
        >>> assembly = Assembly.of(sg.load("geometry/pinion_overhung.toml"))
        >>> list(assembly.system("timoshenko").parts), list(assembly.system("timoshenko").links)
        (['shaft'], ['shaft.1', 'shaft.2'])
        """
        return cls(Train.of(scene.settled), kept=kept, tol=tol)

    def __post_init__(self):
        if self.reduction not in REDUCTIONS:
            raise SolidgearError(
                f"reduction {show(self.reduction, 30)} is unknown; use {' or '.join(REDUCTIONS)}"
            )
        if self.tol is not None:
            self.tol = read_tolerance(self.tol)
        self._models: dict[tuple[str, str], ShaftModel] = {}
        self._local_seconds = 0.0
        #: errors of the first frequencies by the shafts' meshes, by the models of all shafts
        self.errors: dict[tuple[str, ...], MeshErrors] = {}
        #: frequencies up to which the meshes of harmonic shafts were chosen, Hz
        self._followed: dict[str, float] = {}
        #: harmonic shafts whose meshes were chosen at rest
        self.chosen_at_rest: set[str] = set()
        self._read_train(self.train)

    def _read_train(self, train: Train) -> None:
        self.asked_train = train  #: before the numbers of its teeth were put in
        self.teeth = TeethAtRest(train)  #: what they give at operating points
        #: the train at operating points and places in the ranges of its bearings, where its teeth differ
        self._at_points: dict[Hashable, Assembly] = {}
        self._point: Hashable = None  #: that of the numbers which stand here
        self.scenes: dict[str, Scene] = {side: train.shaft(side) for side in train.shafts}
        #: the train with plain bodies: built once for all ends of open data
        self._plain: Assembly | None = None
        self._mesh(self.teeth.first(), train.point is not None and train.point.coast)

    def _mesh(self, train: Train, coast: bool) -> None:
        """Read a train whose meshes have numbers, on the flanks that carry."""
        self.train = train
        self.contacts: dict[str, Contact] = contacts(train, coast)
        self.places = places(train, self.contacts, self.scenes)
        self.stages: dict[str, StageAtWork] = stages_at_work(
            train, self.contacts, self.scenes, self.places, coast
        )
        self._coast: bool | None = coast  #: flank that is in contact here
        self._flanks: dict[bool, Assembly] = {}  #: trains on the other one

    @property
    def tolerance(self) -> float:
        """Relative error that the meshes of harmonic shafts may leave."""
        return self.tolerance_of(JUDGE)

    def tolerance_of(self, model: str) -> float:
        """Return the relative error that the mesh of a shaft by a model may leave."""
        if self.tol is None:
            return self.train.ask.tolerance / LADDER[model].share
        return float(self.tol)

    @property
    def contact(self) -> Contact:
        """Contact of the only mesh; refused for a train with several."""
        return self.contacts[self.train.only().name]

    def models_by_shaft(self, models: Sequence[str]) -> dict[str, str]:
        """Return the model of every shaft, from a model for each in the sequence of the file, or
        one for all.
        """
        sides = [*self.train.shafts]
        if len(models) not in (1, len(sides)):
            raise SolidgearError(
                f"{len(models)} models ({listed(models)}) for the {len(sides)} shafts "
                f"{listed(sides)}; give one for each, or one for all"
            )
        shaft_models = models if len(models) == len(sides) else [*models] * len(sides)
        return dict(zip(sides, shaft_models))

    def meshed_scene(self, side: str, model: str) -> Scene:
        """Return the scene that the body of a shaft by a model is built from."""
        scene = self.scenes[side]
        return scene.plain if self.plain_bodies and LADDER[model].left_out(scene) else scene

    def shaft_model(self, side: str, model: str) -> ShaftModel:
        """Return a shaft by a model, built when it is first requested."""
        if (side, model) not in self._models:
            kind, base = checked_model(model)
            if kind == MATRICES:
                self._models[side, model] = self._of_matrices(side)
            elif base:
                self._models[side, model] = self._derived_model(side, model, kind, base)
            else:
                self.set_mesh(side, model, self._first_mesh(side, model))
        return self._models[side, model]

    def _of_matrices(self, side: str) -> ShaftModel:
        """Return a shaft by the matrices that its table names."""
        matrices = self.train.shafts[side].matrices
        if matrices is None:
            raise SolidgearError(
                f"the {side} has no matrices; write matrices = a file in its table, or use "
                f"another of {listed(LADDER.bodies)}"
            )
        start = perf_counter()
        body = matrices_body(matrices, self.scenes[side])
        seconds = perf_counter() - start
        return ShaftModel(
            side=side, model=MATRICES, part=matrices, body=body, unknowns=body.size, seconds=seconds
        )

    def _first_mesh(self, side: str, model: str) -> Meshed | None:
        """Return the mesh that refinement begins with; None where options set it, and for models
        whose meshes do not follow error bars.
        """
        if not LADDER[model].follows:
            return None
        plan = LADDER[model].meshes_of(self.meshed_scene(side, model), self.options_of(side, model))
        return None if plan.fixed else Meshed(fixed=plan.levels[0])

    def options_of(self, side: str, model: str) -> dict:
        """Return the builder options that were given for a shaft by a model."""
        return {**self.settings.get(model, {}), **self.settings.get((side, model), {})}

    def set_mesh(self, side: str, model: str, mesh: Meshed | Level | None) -> None:
        """Build and reduce a shaft on a mesh, in place of that before and all derived from it."""
        start, earlier = perf_counter(), 0.0
        before = self._models.get((side, model))
        if before is not None:
            earlier = before.seconds
            before.body.cache.clear()  # its factor need not be held beside the next one
        options = self.options_of(side, model) if mesh is None else mesh.options()
        options |= {} if self.kept else dict(LADDER[model].at_rest)
        shaft = self._reduce(
            side, model, build(self.meshed_scene(side, model), model, **options), start
        )
        for name in names_from(model, (*LUMPED, RIGID)):
            self._models.pop((side, name), None)
        self._models[side, model] = replace(shaft, mesh=mesh, seconds=shaft.seconds + earlier)
        self.errors.clear()

    def refine(self, meshes: Mapping[str, Meshed]) -> None:
        """Build and reduce harmonic shafts on other meshes."""
        for side, mesh in meshes.items():
            self.set_mesh(side, JUDGE, mesh)

    @pinned
    def follow(
        self, *models: str, highest_hz: float | None = None, most: int | None = None
    ) -> None:
        """Refine the meshes of harmonic shafts until the error bars of the train's modes up to a
        frequency, Hz, and so many at most, are within the tolerance, or finer ones do not help.
        """
        solved = self.solved_models(models)
        limit = highest_hz or self.highest_hz or self.train.ask.max_frequency
        sides = self.following(solved)
        if all(self._followed.get(side, -np.inf) >= limit for side in sides):
            return
        for side in sides:
            reached = self._followed.get(side, 0.0)
            self._followed[side] = reached if most is not None else max(reached, limit)
        if sides:
            refine_meshes(lambda: self._finer(solved, limit, most), self.refine)

    @pinned
    def follow_alone(self, side: str, model: str) -> ShaftModel:
        """Return a shaft by a model, a harmonic solid on a mesh that follows the error bars of its
        own flexibility at all ports, whatever holds it there.
        """
        limit = self.highest_hz or self.train.ask.max_frequency

        def finer() -> tuple[dict[str, Meshed], float]:
            solid = self.shaft_model(side, JUDGE)
            scene = self.meshed_scene(side, JUDGE)
            if isinstance(solid.mesh, Meshed) and highest_resolved(scene, solid.body) < limit:
                return {side: resolving(solid.mesh)}, np.inf
            errors = flexibility_errors(side, scene, solid.body)
            if errors is None:
                return {}, 0.0
            needs = errors.needs(len(errors.bars), self.tolerance)
            return self.finer_meshes(needs), float(errors.bars.max())

        if self.following({side: model}):
            refine_meshes(finer, self.refine)
        return self.shaft_model(side, model)

    def solved_models(self, models: Sequence[str]) -> dict[str, str]:
        """Return the models by which meshes are judged: in place of a lumped shaft the harmonic
        solid that it is condensed from.
        """
        lumped_solids = names_from(JUDGE, LUMPED)
        return {
            side: JUDGE if model in lumped_solids else model
            for side, model in self.models_by_shaft(models).items()
        }

    def following(self, models: Mapping[str, str]) -> dict[str, Meshed]:
        """Return the meshes of harmonic shafts that follow error bars."""
        solids = [self.shaft_model(s, JUDGE) for s, model in models.items() if model == JUDGE]
        return {s.side: s.mesh for s in solids if isinstance(s.mesh, Meshed)}

    def _finer(
        self, models: Mapping[str, str], limit: float, most: int | None
    ) -> tuple[dict[str, Meshed], float]:
        """Return the next meshes for the modes up to a frequency, none where all are within the
        tolerance, and the largest error bar.
        """
        system = self.coupled(models, teeth=False)
        omega = system.elastic[0]
        count = max(1, int((omega <= 2 * np.pi * limit).sum()))
        if most is not None:
            count = min(count, most)
        meshes, bodies = self.following(models), self._solids(models)
        highest = min(limit, float(omega[count - 1]) / (2 * np.pi))
        scenes = {side: self.meshed_scene(side, JUDGE) for side in meshes}
        coarse = [s for s in meshes if highest_resolved(scenes[s], bodies[s]) < highest]
        if coarse:
            return {side: resolving(meshes[side]) for side in coarse}, np.inf
        # one more is looked at where a list of modes ends
        errors = self._errors(system, models, count + 1)
        if errors is None:
            return {}, 0.0
        needs = errors.needs(count, self.tolerance)
        return self.finer_meshes(needs), float(errors.bars[:count].max())

    def finer_meshes(self, needs: Mapping[str, Need]) -> dict[str, Meshed]:
        """Return the next meshes of the shafts that need finer ones and follow."""
        finer = {}
        for side, need in needs.items():
            solid = self.shaft_model(side, JUDGE)
            if not isinstance(solid.mesh, Meshed):
                continue
            scene = self.meshed_scene(side, JUDGE)
            mesh = refined(scene, solid.body, solid.mesh, need.score, need.tolerance)
            if mesh is not None:
                finer[side] = mesh
        return finer

    def _solids(self, models: Mapping[str, str]) -> dict[str, Body]:
        solid = [side for side, model in models.items() if model == JUDGE]
        return {side: self.shaft_model(side, JUDGE).body for side in solid}

    def mesh_errors(self, system: System, models: Mapping[str, str], n: int) -> MeshErrors | None:
        """Return the errors of the first n elastic frequencies of the train by the meshes of
        harmonic shafts; None without any, and where teeth drive families of two waves and more.
        """
        if JUDGE in models.values() and any(mesh.local_harmonics for mesh in self.train.meshes):
            return None
        return self._errors(system, models, n)

    def _errors(self, system: System, models: Mapping[str, str], n: int) -> MeshErrors | None:
        key = tuple(models.values())
        if key not in self.errors or len(self.errors[key].bars) < n:
            scenes = {side: self.meshed_scene(side, JUDGE) for side in self.scenes}
            errors = mesh_errors(system, scenes, self._solids(models), n)
            if errors is None:
                return None
            self.errors[key] = errors
        return self.errors[key]

    def set_body(self, side: str, model: str, body: Body) -> None:
        """Set the body, on any mesh, that a model of a shaft is reduced from, in place of building
        it.
        """
        self.errors.clear()
        self._models[side, model] = self._reduce(side, model, body, perf_counter())

    def _reduce(self, side: str, model: str, body: Body, start: float) -> ShaftModel:
        """Reduce the body of a shaft, whose time counts from `start`."""
        part = REDUCTIONS[self.reduction](body, n=self.kept)
        return ShaftModel(side, model, part, body, body.size, perf_counter() - start)

    def is_built(self, side: str, model: str) -> bool:
        """Return whether a shaft by a model has been built."""
        return (side, model) in self._models

    def add_model(self, model: ShaftModel) -> None:
        """Add a shaft's model of another assembly, whose shafts differ in their bearings alone."""
        self._models[model.side, model.model] = model

    def add_part(self, side: str, name: str, part: Part, like: str) -> None:
        """Register a part, with the ports of the shaft, as model `name` of a shaft; body and
        unknowns are those of model `like`.
        """
        source = self.shaft_model(side, like)
        self._models[side, name] = ShaftModel(
            side=side,
            model=name,
            part=part,
            body=source.body,
            unknowns=source.unknowns,
            seconds=source.seconds,
        )

    def with_bearings(self, stiffness: Mapping[str, ArrayLike]) -> Assembly:
        """Return the same train on other bearings, from stiffness matrices (6, 6) by names such as
        ``pinion.1``, series springs included, SI; bodies and reductions are kept.

        Examples
        --------
        >>> import numpy as np
        >>> import solidgear as sg
        >>> assembly = Assembly(sg.load_train("geometry/axle_overhung.toml"))
        >>> usual = assembly.system("euler", "euler").modes(3).frequency_hz[3]
        >>> soft = assembly.with_bearings({"gear.3": np.diag([1e8, 1e8, 1e8, 0, 0, 0])})
        >>> bool(soft.system("euler", "euler").modes(3).frequency_hz[3] < usual)
        True
        """
        shafts = self.train.shafts.items()
        names = [f"{side}.{b.name}" for side, shaft in shafts for b in shaft.scene.bearings]
        for name in stiffness:
            if name not in names:
                raise SolidgearError(
                    f"no bearing {show(name, 40)}{nearest(name, names)}; there are {listed(names)}"
                )
        assembly = self._with_free_bodies()
        for side, scene in self.scenes.items():
            bearings = []
            for bearing in scene.bearings:
                matrix = stiffness.get(f"{side}.{bearing.name}")
                if matrix is not None:
                    bearing = bearing.with_changes(
                        matrix=np.asarray(matrix).tolist(),
                        axial_series=(),
                        scale=1.0,
                        catalogue=None,
                        support=None,
                    )
                bearings.append(bearing)
            assembly.scenes[side] = scene.with_changes(bearings=tuple(bearings))
        return assembly

    def with_train(self, train: Train) -> Assembly:
        """Return the same shafts in a train that differs in bearings, housing, mesh or operating
        point; bodies and reductions are kept.
        """
        assembly = self._with_free_bodies()
        assembly._read_train(train)
        return assembly

    def _with_free_bodies(self) -> Assembly:
        assembly = copy(self)
        # bodies hold no bearings; lumped models, condensed on them, do
        bodies = {k: m for k, m in self._models.items() if k[1].partition("/")[0] not in LUMPED}
        assembly._models, assembly.scenes, assembly.errors = bodies, {}, {}
        assembly._coast, assembly._flanks = None, {}
        assembly._followed = dict(self._followed)
        assembly.chosen_at_rest = set(self.chosen_at_rest)
        return assembly

    def cautions(self, *models: str) -> tuple[str, ...]:
        """Return sentences to be read before numbers of moving shafts by models are used: those at
        rest, and on bearings without load.
        """
        unloaded = [
            f"bearing {end} carries no load at {self.train.point.label}, so it has no stiffness "
            "there"
            for end in self.train.unloaded
            if self.train.point is not None
        ]
        return (*self.cautions_at_rest(*models), *unloaded)

    def cautions_at_rest(self, *models: str) -> tuple[str, ...]:
        """Return sentences to be read before numbers of shafts at rest by models, as of
        :meth:`models_by_shaft`, are used: on meshes, teeth whose contact was solved, gears, shafts
        that take the same space, the housing, and with models on the seats of their bodies.
        """
        by_shaft = self.models_by_shaft(models) if models else {}
        return train_cautions(self.train, self.contacts, self.scenes, self.places, by_shaft)

    @property
    def solids(self) -> tuple[str, ...]:
        """Cheapest solids that model all of every shaft, one for all where they are the same."""
        solids = tuple(map(solid_of, self.scenes.values()))
        return solids[:1] if len({*solids}) == 1 else solids

    def left_out(self, model: str) -> tuple[str, ...]:
        """Return the cuts and teeth that a model of revolution leaves out of all shafts, in words."""
        labels = (LADDER[model].left_out(scene) for scene in self.scenes.values())
        return tuple(label for label in labels if label)

    def settling(self, model: str) -> Assembly:
        """Return the same train with shafts as a model has them on which only bearings settle: bodies
        without cuts, unless it is made for them, and teeth that act at their ports.
        """
        if not self.left_out(model):
            return self.at_ports()
        if self._plain is None:
            train = self.asked_train.with_solved_meshes(self.teeth.solved)
            self._plain = replace(self, train=train, plain_bodies=True).at_ports()
        return self._plain

    def at_ports(self) -> Assembly:
        """Return the same train with teeth that act at their ports."""
        train = self.asked_train
        if not any(mesh.local_harmonics for mesh in train.meshes):
            return self
        meshes = tuple(mesh.with_changes(local_harmonics=()) for mesh in train.meshes)
        train = train.with_changes(meshes=meshes).with_solved_meshes(self.teeth.solved)
        return replace(self, train=train)

    def at(self, point: OperatingPoint, choice: Choice = AS_STATED) -> Assembly:
        """Return the same train as it meshes at an operating point: with the numbers of its teeth there,
        at a place in the ranges of its bearings, on the flanks that carry.
        """
        if not self.teeth.asked:
            return self.on_flank(point.coast)
        key = self.teeth.load_that_counts(point), repr(choice)
        if key == self._point:
            return self
        if key not in self._at_points:
            assembly = copy(self)
            assembly._point, assembly._at_points, assembly.errors = key, {}, {}
            assembly._mesh(self.teeth.at(point, choice), point.coast)
            self._at_points[key] = assembly
        return self._at_points[key]

    def on_flank(self, coast: bool) -> Assembly:
        """Return the same train with the teeth in contact on one flank: `coast` is True for that
        which the file does not name.
        """
        if coast == self._coast:
            return self
        if coast not in self._flanks:
            assembly = copy(self)
            assembly._coast, assembly._flanks = coast, {}
            assembly.contacts, assembly.errors = contacts(self.train, coast), {}
            assembly.stages = stages_at_work(
                self.train, assembly.contacts, self.scenes, self.places, coast
            )
            self._flanks[coast] = assembly
        return self._flanks[coast]

    def _derived_model(self, side: str, model: str, kind: str, base: str) -> ShaftModel:
        source = self.shaft_model(side, base)
        start = perf_counter()
        part: Part
        if kind == RIGID:
            part = RigidBody.of(source.body)
        else:
            if side in self.train.housed:
                raise SolidgearError(
                    f"a {kind} shaft has its bearings condensed to ground, but those of the "
                    f"{side} stand in a housing; use one of {', '.join(LADDER.bodies)}, {RIGID}"
                )
            # a shaft that is a carrier may have no gear: it is held at its main lumped point
            scene = self.scenes[side]
            points = [*self.train.shafts[side].gears] or [scene.port.name]
            part = lumped(source, kind, scene, points)
        seconds = source.seconds + perf_counter() - start
        unknowns = source.unknowns
        return ShaftModel(
            side=side, model=model, part=part, body=source.body, unknowns=unknowns, seconds=seconds
        )

    def system(self, *models: str, bearings: bool = True) -> System:
        """Couple the shafts by models, one for each or one for all; without bearings, all that
        rests on them is free. Parts are ``engine``, the shafts, ``load`` and other rotors, and
        ``housing``; links are ``engine spring``, ``load spring``, ``mesh`` (with several ``mesh
        input-middle``), the bearings, and mounts such as ``mount 1``.
        """
        by_shaft = self.models_by_shaft(models)
        if bearings and self.following(self.solved_models(models)).keys() - self._followed.keys():
            self.follow(*models)
        return self.coupled(by_shaft, bearings)

    def coupled(
        self, models: Mapping[str, str], bearings: bool = True, teeth: bool = True
    ) -> System:
        """Couple the shafts on the meshes that they have, by choice without the harmonics that
        teeth drive.
        """
        train = self.train
        if bearings:
            self.teeth.refuse_usual(train)
        rotors = {name: Inertia(rotor.inertia) for name, rotor in train.rotors.items()}
        parts: dict[str, Part] = {name: rotors[name] for name in train.engines}
        for side, model in models.items():
            part = self.shaft_part(side, model) if teeth else self.shaft_model(side, model).part
            parts[side] = self.place_part(side, part)
        parts |= rotors
        links: dict[str, Link] = {}
        if train.housing is not None:
            parts[HOUSING], links = housing_part(train.housing), mount_links(train.housing)
        for side in train.shafts:
            links |= self._support_links(side, bearings)
            for name, rotor in train.rotors_of(side).items():
                port_name = f"{side}.{train.spring_port(name)}"
                links[f"{name} spring"] = torsion_spring(port_name, rotor.spring.stiffness, name)
            for name, (port, head) in train.heads(side).items():
                diagonal = [head.mass] * 3 + [head.bending, head.torsional, head.bending]
                links[name.replace(".", " ")] = PortInertia(port, np.diag(diagonal))
        for pair in train.pairs:
            (port, vector), (to, to_vector) = self.mesh_ends(pair, parts)
            stiffness = self.contacts[pair.name].stiffness
            links[pair.name] = mesh_spring(port, vector, to, to_vector, stiffness)
        for stage in self.stages.values():
            parts |= stage.parts(*self.places[stage.stage.shafts[0]])
            links |= stage.links
        return System(parts, links)

    def _support_links(self, side: str, bearings: bool) -> dict[str, Link]:
        """Return the links of a shaft to ground or to the housing, and masses on the ports."""
        scene = self.scenes[side]
        if not bearings:
            free = [b.with_changes(matrix=np.zeros((6, 6)), hold=None) for b in scene.bearings]
            scene = scene.with_changes(bearings=tuple(free), housing=None, housing_axial=None)
        return links_on_housing(self.train, side, grounded(side, scene))

    def shaft_part(self, side: str, model: str) -> Part:
        """Return a shaft as a part, with the harmonics that the teeth drive where the train asks
        for them.
        """
        shaft = self.shaft_model(side, model)
        meshes = [
            (pair, self._mesh_vector(pair, side).point)
            for pair in self.train.pairs
            if model == JUDGE and side in pair.shafts and pair.mesh.local_harmonics
        ]
        if not meshes:
            return shaft.part
        key = tuple(
            (pair.name, pair.mesh.local_harmonics, pair.pinion.teeth, pair.ratio, *point.tolist())
            for pair, point in meshes
        )
        if key not in shaft.local:
            start = perf_counter()
            part = local_teeth(side, self.meshed_scene(side, model), shaft.part, shaft.body, meshes)
            shaft.local.clear()  # of mesh points elsewhere
            shaft.local[key] = part
            self._local_seconds += perf_counter() - start
        return shaft.local[key]

    def mesh_ends(self, pair: Pair, parts: Mapping[str, Part]) -> list[tuple[str, MeshVector]]:
        """Return the port of each shaft that the teeth of a mesh act on, and the line of action
        from there.
        """
        out = []
        for side, port in zip(pair.shafts, pair.ports):
            vector = self._mesh_vector(pair, side)
            if (name := mesh_port(pair)) in parts[side].ports:
                out.append((f"{side}.{name}", MeshVector(vector.normal, np.zeros(3))))
            else:
                out.append((f"{side}.{port}", vector))
        return out

    def _mesh_vector(self, pair: Pair, side: str) -> MeshVector:
        contact = self.contacts[pair.name]
        return contact.pinion if side == pair.shafts[0] else contact.gear

    def place_part(self, side: str, part: Part) -> Part:
        """Return a shaft in the axes of the first shaft's scene, at the place where the teeth meet."""
        first = side == next(iter(self.places))
        return part if first else Placed(part, *self.places[side])

    def loss_factors(self) -> dict[str, float]:
        """Return the loss factors of all parts and links, by name."""
        train, loss = self.train, self.train.losses
        factors = {side: loss.shafts for side in train.shafts}
        for side in train.shafts:
            factors |= dict.fromkeys(grounded(side, self.scenes[side]), loss.bearings)
            factors |= {f"{name} spring": loss.springs for name in train.rotors_of(side)}
        if train.housing is not None:
            factors |= housing_losses(train.housing)
        for stage in self.stages.values():
            factors |= dict.fromkeys(stage.links, loss.bearings)
        return factors | {mesh.name: loss.mesh for mesh in train.teeth}

    def build_seconds(self, *models: str) -> float:
        """Return the time to build and reduce all shafts, s."""
        models_by_side = self.models_by_shaft(models)
        local = self._local_seconds if JUDGE in models_by_side.values() else 0.0
        return sum(self.shaft_model(*shaft).seconds for shaft in models_by_side.items()) + local
