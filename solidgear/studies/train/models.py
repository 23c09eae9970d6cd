"""Each shaft of a train by any model, and the system that they make."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field
from time import perf_counter

import numpy as np
from numpy.typing import ArrayLike

from solidgear.body import Body
from solidgear.errors import SolidgearError, listed, nearest, show
from solidgear.ladder import build
from solidgear.ladder.registry import LADDER
from solidgear.reduction.craig_bampton import craig_bampton
from solidgear.reduction.rubin import rubin
from solidgear.scene import Scene
from solidgear.scene.gears import Pair
from solidgear.scene.train import Train
from solidgear.scene.train_housing import HOUSING
from solidgear.studies.train.contact import Contact
from solidgear.studies.train.gear_bodies import gear_cautions
from solidgear.studies.train.housing import cautions_of, losses_of, mounts_of, part_of, standing_in
from solidgear.studies.train.layout import contacts, places
from solidgear.studies.train.local import local_teeth, mesh_port
from solidgear.studies.train.shaft import JUDGE, LUMPED, RIGID, ShaftModel, checked_rung, lumped
from solidgear.studies.train.space import overlaps
from solidgear.studies.train.stages import StageAtWork, stages_at_work
from solidgear.system.gear_mesh import MeshVector
from solidgear.system.links import Link, PortInertia, grounded, mesh_spring, torsion_spring
from solidgear.system.parts import Inertia, Part, Placed, RigidBody
from solidgear.system.system import System

REDUCTIONS = {"rubin": rubin, "craig_bampton": craig_bampton}
#: free modes of a shaft that are kept: with residuals, enough for 1e-5 to 4 kHz; the bound tells
KEPT = 24
#: a mesh for systems: frequencies move by some 1e-5 against order 5
MESH: dict[str, dict] = {JUDGE: {"order": 4}}


@dataclass(eq=False)
class Workshop:
    """Models of the shafts of a train, each made once.

    Examples
    --------
    >>> import solidgear as sg
    >>> shop = Workshop(sg.load_train("geometry/axle_overhung.toml"))
    >>> system = shop.system("timoshenko", "euler")
    >>> list(system.parts), system.modes(3).frequency_hz.round(1)
    (['engine', 'pinion', 'gear', 'load'], array([  0. ,  16.3,  55.4, 732.4]))
    """

    train: Train
    reduction: str = "rubin"
    kept: int = KEPT  #: modes of each shaft
    #: builder options of models, by their names; of one shaft by (side, model), before those
    settings: Mapping[str | tuple[str, str], Mapping] = field(default_factory=dict)

    def __post_init__(self):
        if self.reduction not in REDUCTIONS:
            raise SolidgearError(
                f"reduction {show(self.reduction, 30)} is unknown; use {' or '.join(REDUCTIONS)}"
            )
        self._made: dict[tuple[str, str], ShaftModel] = {}
        self._local_seconds = 0.0
        #: what meshes leave in the first frequencies, by the models of all shafts
        self.bars: dict[tuple[str, ...], np.ndarray] = {}
        self._take_in(self.train)

    def _take_in(self, train: Train) -> None:
        self.train = train
        self.scenes: dict[str, Scene] = {side: train.shaft(side) for side in train.shafts}
        self.contacts: dict[str, Contact] = contacts(train)
        self.places = places(train, self.contacts, self.scenes)
        self.stages: dict[str, StageAtWork] = stages_at_work(
            train, self.contacts, self.scenes, self.places
        )
        point = train.point
        self._flanks: dict[bool, Workshop] = {point is not None and point.coast: self}

    @property
    def contact(self) -> Contact:
        """Contact of the only mesh.

        Raises
        ------
        SolidgearError
            For a train of several.
        """
        return self.contacts[self.train.only().name]

    def mix(self, models: Sequence[str]) -> dict[str, str]:
        """Models by shaft, from one each in the sequence of the file, or one for all.

        Raises
        ------
        SolidgearError
            For another number of them.
        """
        sides = [*self.train.shafts]
        if len(models) not in (1, len(sides)):
            raise SolidgearError(
                f"{len(models)} models ({listed(models)}) for the {len(sides)} shafts "
                f"{listed(sides)}; give one for each, or one for all"
            )
        each = models if len(models) == len(sides) else [*models] * len(sides)
        return dict(zip(sides, each))

    def shaft(self, side: str, rung: str) -> ShaftModel:
        """Model of a shaft, made when it is first asked for."""
        if (side, rung) not in self._made:
            kind, base = checked_rung(rung)
            if base:
                self._made[side, rung] = self._from_body(side, rung, kind, base)
            else:
                start = perf_counter()
                options = self.settings.get(rung, MESH.get(rung, {}))
                own = self.settings.get((side, rung), {})
                body = build(self.scenes[side], rung, **{**options, **own})
                part = REDUCTIONS[self.reduction](body, n=self.kept)
                seconds = perf_counter() - start
                self._made[side, rung] = ShaftModel(side, rung, part, body, body.size, seconds)
        return self._made[side, rung]

    def take(self, side: str, rung: str, body: Body) -> None:
        """Take in a body that is there already as the model of a shaft.

        Parameters
        ----------
        body : Body
            Of that model, on any mesh.
        """
        self.bars.clear()
        start = perf_counter()
        part = REDUCTIONS[self.reduction](body, n=self.kept)
        seconds = perf_counter() - start
        self._made[side, rung] = ShaftModel(side, rung, part, body, body.size, seconds)

    def keep(self, model: ShaftModel) -> None:
        """Take in the model of a shaft of another workshop that differs in its bearings alone."""
        self._made[model.side, model.rung] = model

    def put(self, side: str, name: str, part: Part, like: str) -> None:
        """Take in a part of one's own as a further model of a shaft.

        Parameters
        ----------
        name : str
            What it is asked for by.
        part : Part
            With the ports of the shaft.
        like : str
            Model of the body it stands for.
        """
        under = self.shaft(side, like)
        self._made[side, name] = ShaftModel(
            side, name, part, under.body, under.unknowns, under.seconds
        )

    def with_bearings(self, stiffness: Mapping[str, ArrayLike]) -> Workshop:
        """The same train on other bearings; bodies and their reductions are kept.

        Parameters
        ----------
        stiffness : mapping of str to (6, 6) array_like
            By bearing, such as ``pinion.1``, series springs included, SI.

        Raises
        ------
        SolidgearError
            For a bearing that there is not, or a matrix that is no stiffness.

        Examples
        --------
        >>> import numpy as np
        >>> import solidgear as sg
        >>> shop = Workshop(sg.load_train("geometry/axle_overhung.toml"))
        >>> usual = shop.system("euler", "euler").modes(3).frequency_hz[3]
        >>> soft = shop.with_bearings({"gear.3": np.diag([1e8, 1e8, 1e8, 0, 0, 0])})
        >>> bool(soft.system("euler", "euler").modes(3).frequency_hz[3] < usual)
        True
        """
        shafts = self.train.shafts.items()
        known = [f"{side}.{b.name}" for side, own in shafts for b in own.scene.bearings]
        for name in stiffness:
            if name not in known:
                raise SolidgearError(
                    f"no bearing {show(name, 40)}{nearest(name, known)}; there are {listed(known)}"
                )
        out = self._on_other_bearings()
        for side, scene in self.scenes.items():
            bearings = [
                bearing.with_changes(
                    matrix=np.asarray(stiffness[f"{side}.{bearing.name}"]).tolist(),
                    axial_series=(),
                    scale=1.0,
                    catalogue=None,
                    support=None,
                )
                if f"{side}.{bearing.name}" in stiffness
                else bearing
                for bearing in scene.bearings
            ]
            out.scenes[side] = scene.with_changes(bearings=tuple(bearings))
        return out

    def with_train(self, train: Train) -> Workshop:
        """The same shafts in a train that differs in bearings, housing, mesh or operating point; bodies
        and their reductions are kept.
        """
        out = self._on_other_bearings()
        out._take_in(train)
        return out

    def _on_other_bearings(self) -> Workshop:
        out = copy(self)
        # bodies are free of their bearings; what is condensed on them is not
        kept = {k: m for k, m in self._made.items() if k[1].partition("/")[0] not in LUMPED}
        out._made, out.scenes, out.bars, out._flanks = kept, {}, {}, {}
        return out

    @property
    def cautions(self) -> tuple[str, ...]:
        """Warnings of data that do not fit together but can be solved, and of bearings without load."""
        lost = [
            f"bearing {end} carries nothing at {self.train.point.label}: it has no stiffness there"
            for end in self.train.unloaded
            if self.train.point is not None
        ]
        return (*self.odd, *lost)

    @property
    def odd(self) -> tuple[str, ...]:
        """Cautions on meshes, gears, shafts that take the same space, and the housing, in words."""
        several = len(self.contacts) > 1
        met = [(f"{name}: " * several, own.cautions) for name, own in self.contacts.items()]
        told = [head + text for head, cautions in met for text in cautions]
        told += gear_cautions(self.train, self.contacts)
        told += map(str, overlaps(self.train, self.scenes, self.places))
        return (*told, *cautions_of(self.train, self.places))

    def on_flank(self, coast: bool) -> Workshop:
        """The same train with one of the two flanks of its teeth in contact.

        Parameters
        ----------
        coast : bool
            True for the flank that the file does not name.
        """
        if coast not in self._flanks:
            other = copy(self)
            other.contacts, other.bars = contacts(self.train, coast), {}
            other.stages = stages_at_work(
                self.train, other.contacts, self.scenes, self.places, coast
            )
            self._flanks[coast] = other
        return self._flanks[coast]

    def _from_body(self, side: str, rung: str, kind: str, base: str) -> ShaftModel:
        under = self.shaft(side, base)
        start = perf_counter()
        part: Part
        if kind == RIGID:
            part = RigidBody.of(under.body)
        else:
            if side in self.train.housed:
                raise SolidgearError(
                    f"a {kind} shaft has its bearings condensed to ground, and those of the {side} "
                    f"stand in a housing; use one of {', '.join(LADDER.bodies)}, {RIGID}"
                )
            # a shaft that is a carrier may have no gear: it is held at its main lumped point
            scene = self.scenes[side]
            points = [*self.train.shafts[side].gears] or [scene.port.name]
            part = lumped(under, kind, scene, points)
        seconds = under.seconds + perf_counter() - start
        return ShaftModel(side, rung, part, under.body, under.unknowns, seconds)

    def system(self, *models: str, bearings: bool = True) -> System:
        """The train with its shafts by models.

        Parameters
        ----------
        *models : str
            One for each shaft, or one for all.
        bearings : bool
            False leaves them out: what rests on them is then free.

        Returns
        -------
        System
            Parts ``engine``, the shafts, ``load`` and other rotors; links ``engine spring``, ``load
            spring``, ``mesh`` (of several meshes such as ``mesh input-middle``), and the bearings; with a
            housing the part ``housing`` and links such as ``mount 1``.
        """
        train = self.train
        rotors = {name: Inertia(rotor.inertia) for name, rotor in train.rotors.items()}
        parts: dict[str, Part] = {name: rotors[name] for name in train.engines}
        for side, rung in self.mix(models).items():
            parts[side] = self.placed(side, self.part(side, rung))
        parts |= rotors
        links: dict[str, Link] = {}
        if train.housing is not None:
            parts[HOUSING], links = part_of(train.housing), mounts_of(train.housing)
        for side in train.shafts:
            links |= self._ground(side, bearings)
            for name, rotor in train.rotors_of(side).items():
                at = f"{side}.{train.spring_port(name)}"
                links[f"{name} spring"] = torsion_spring(at, rotor.spring.stiffness, name)
            for name, (port, head) in train.heads(side).items():
                diagonal = [head.mass] * 3 + [head.bending, head.torsional, head.bending]
                links[name.replace(".", " ")] = PortInertia(port, np.diag(diagonal))
        for pair in train.pairs:
            ends = self.teeth(pair, parts)
            links[pair.name] = mesh_spring(*ends[0], *ends[1], self.contacts[pair.name].stiffness)
        for stage in self.stages.values():
            parts |= stage.parts(*self.places[stage.stage.shafts[0]])
            links |= stage.links
        return System(parts, links)

    def _ground(self, side: str, bearings: bool) -> dict[str, Link]:
        """Links of a shaft to ground or to the housing, and masses on its ports."""
        scene = self.scenes[side]
        if not bearings:
            free = [b.with_changes(matrix=np.zeros((6, 6)), hold=None) for b in scene.bearings]
            scene = scene.with_changes(bearings=tuple(free), housing=None, housing_axial=None)
        return standing_in(self.train, side, grounded(side, scene))

    def part(self, side: str, rung: str) -> Part:
        """Model of a shaft with the harmonics that its teeth drive, if the train asks for any."""
        own = self.shaft(side, rung)
        meshes = [
            (pair, self._vector(pair, side).point)
            for pair in self.train.pairs
            if rung == JUDGE and side in pair.shafts and pair.mesh.local_harmonics
        ]
        if not meshes:
            return own.part
        key = tuple(
            (pair.name, pair.mesh.local_harmonics, pair.pinion.teeth, pair.ratio, *point.tolist())
            for pair, point in meshes
        )
        if key not in own.local:
            start = perf_counter()
            made = local_teeth(side, self.scenes[side], own.part, own.body, meshes)
            own.local.clear()  # of mesh points elsewhere
            own.local[key] = made
            self._local_seconds += perf_counter() - start
        return own.local[key]

    def teeth(self, pair: Pair, parts: Mapping[str, Part]) -> list[tuple[str, MeshVector]]:
        """Ports of both parts that the teeth of a mesh act on, and along which line from there."""
        out = []
        for side, port in zip(pair.shafts, pair.ports):
            vector = self._vector(pair, side)
            if (name := mesh_port(pair)) in parts[side].ports:
                out.append((f"{side}.{name}", MeshVector(vector.normal, np.zeros(3))))
            else:
                out.append((f"{side}.{port}", vector))
        return out

    def _vector(self, pair: Pair, side: str) -> MeshVector:
        met = self.contacts[pair.name]
        return met.pinion if side == pair.shafts[0] else met.gear

    def placed(self, side: str, part: Part) -> Part:
        """A shaft where its teeth meet others, in the axes of the first shaft's scene."""
        first = side == next(iter(self.places))
        return part if first else Placed(part, *self.places[side])

    def losses(self) -> dict[str, float]:
        """Loss factors of all parts and links."""
        train, loss = self.train, self.train.losses
        out = {side: loss.shafts for side in train.shafts}
        for side in train.shafts:
            out |= dict.fromkeys(grounded(side, self.scenes[side]), loss.bearings)
            out |= {f"{name} spring": loss.springs for name in train.rotors_of(side)}
        if train.housing is not None:
            out |= losses_of(train.housing)
        for stage in self.stages.values():
            out |= dict.fromkeys(stage.links, loss.bearings)
        return out | {mesh.name: loss.mesh for mesh in train.teeth}

    def seconds(self, *models: str) -> float:
        """To build and reduce all shafts."""
        mix = self.mix(models)
        local = self._local_seconds if JUDGE in mix.values() else 0.0
        return sum(self.shaft(*one).seconds for one in mix.items()) + local
