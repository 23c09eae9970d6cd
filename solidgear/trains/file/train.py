"""Trains of shafts that mesh, with engines and loads: data only.

Each shaft has a scene.  Vectors of a mesh are given in the frame of the *pinion*, the first of both
gears: y along the shaft from the pitch apex towards the back, the mesh on the -x side, z up
(:mod:`solidgear.core.system.gear_mesh` draws it), from the pinion's lumped point.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import cached_property
from math import pi
from typing import Any

import numpy as np
from pydantic import PrivateAttr, model_validator

from solidgear.core import (
    Bearing,
    Document,
    Model,
    Scene,
    SceneError,
    SolidgearError,
    addition,
    listed,
)
from solidgear.core.scene.document import Origin, read_tables
from solidgear.trains.file.gears import HeadInertia, Member, Shaft
from solidgear.trains.file.housing import TrainHousing
from solidgear.trains.file.layout import (
    PerTurn,
    ends_of,
    is_idler,
    layout_problems,
    turns_of,
    with_flanks,
)
from solidgear.trains.file.operation import OperatingPoint, Operation, ShaftCase
from solidgear.trains.file.pair_rules import pair_problems
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import Planetary, PlanetMesh, Stage, stage_of
from solidgear.trains.file.power import carried_of, flows_of, share_problems
from solidgear.trains.file.rules import housing_problems
from solidgear.trains.file.running_rules import running_problems, spring_problems
from solidgear.trains.file.shafting import Joint
from solidgear.trains.file.solved_meshes import SolvedMeshes
from solidgear.trains.file.tables import Losses, Mesh, Rotor, TrainAsk

#: names of the shafts, and of what turns with them, in a file of the short form
SHORT = {"engine": "pinion", "load": "gear"}
SIDES = tuple(SHORT.values())
#: name of the shaft in a train of one
ALONE = "shaft"


class Train(Model):
    """Shafts, the meshes between them, engine and load; read one with `solidgear.load_train`.

    Attributes
    ----------
    title, name, source : str
    shafts : dict of str to Shaft
        By name; scenes are laid out, and weight acts, in the axes of the first.
    meshes : tuple of Mesh
    rotors : dict of str to Rotor
        ``engine`` and ``load``, between which torque passes, and others; none for modes alone.
    engines, loads : tuple of str
        Rotors that bring torque, and that take it, where they have other names.
    planetary : dict of str to Planetary
        Stages by name.
    losses : Losses
    housing : TrainHousing or None
        Housing under the bearings of its shafts; without one they stand on ground.
    operation : tuple of OperatingPoint
        Torques and speeds at which it runs; catalogue bearings have their stiffness at the first.
    ask : TrainAsk

    Raises
    ------
    SceneError
        Every problem of its parts, meshes that leave a shaft out or a loop of them whose teeth
        contradict each other, hands that cannot mesh, a ratio
        that is not that of the teeth, springs on ports that are not there, operating points that
        the teeth contradict, and shafts that a torque cannot turn.

    Examples
    --------
    >>> import solidgear as sg
    >>> train = sg.load_train("geometry/axle_overhung.toml")
    >>> train.pinion.teeth, train.gear.teeth, [b.name for b in train.gear.scene.bearings]
    (14, 45, ['3', '4'])
    >>> train.unpublished()["engine.spring.stiffness"]
    'identified'
    """

    title: str = ""
    name: str = "train"
    source: str = ""
    shafts: dict[str, Shaft]
    meshes: tuple[Mesh, ...]
    rotors: dict[str, Rotor]
    engines: tuple[str, ...] = ("engine",)
    loads: tuple[str, ...] = ("load",)
    planetary: dict[str, Planetary] = {}
    losses: Losses = Losses()
    housing: TrainHousing | None = None
    operation: Operation = ()
    ask: TrainAsk = TrainAsk()
    _origin: Origin = PrivateAttr(Origin())
    _solved: SolvedMeshes = PrivateAttr(SolvedMeshes())

    @classmethod
    def of(cls, scene: Scene) -> Train:
        """A shaft as a train of one: no teeth, no engine, the loads of the scene, and their cases as
        operating points.

        Parameters
        ----------
        scene : Scene

        Returns
        -------
        Train
            With one shaft, called ``shaft``.

        Examples
        --------
        >>> import solidgear as sg
        >>> train = sg.Train.of(sg.load("geometry/pinion_overhung.toml"))
        >>> list(train.shafts), train.pairs, train.is_one_shaft
        (['shaft'], (), True)
        """
        return cls(
            title=scene.title,
            name=scene.name,
            source=scene.source,
            shafts={ALONE: Shaft(scene=scene, scene_load="added")},
            meshes=(),
            rotors={},
            engines=(),
            loads=(),
            operation=tuple(map(ShaftCase.of_case, scene.cases)),
            ask=TrainAsk(tolerance=scene.ask.tolerance),
        )

    @property
    def is_one_shaft(self) -> bool:
        """True for a shaft alone, without teeth or rotors."""
        return len(self.shafts) == 1 and not (self.meshes or self.planetary or self.rotors)

    @model_validator(mode="after")
    def _hangs_together(self) -> Train:
        if self.is_one_shaft:
            return self
        if problems := list(layout_problems(self)):
            raise SceneError.of(problems)
        object.__setattr__(self, "operation", tuple(map(self.told, self.operation)))
        problems = [
            problem for pair in self.pairs for problem in pair.with_file_paths(pair_problems(pair))
        ]
        problems += [*spring_problems(self), *share_problems(self), *housing_problems(self)]
        problems += [] if problems else running_problems(self)
        if problems:
            raise SceneError.of(problems)
        return self

    def with_changes(self, **changes: Any) -> Train:
        """A validated copy with some fields replaced, or shafts and rotors by their names, a shaft of
        one gear also by a `Member`, and the only mesh as ``mesh``.

        Parameters
        ----------
        **changes
            Fields by name.

        Returns
        -------
        Train

        Raises
        ------
        SceneError
            As by the constructor.
        """
        shafts, rotors = dict(self.shafts), dict(self.rotors)
        for name in [n for n in changes if n in shafts]:
            new = changes.pop(name)
            shafts[name] = new.shaft if isinstance(new, Member) else new
        for name in [n for n in changes if n in rotors]:
            rotors[name] = changes.pop(name)
        if "mesh" in changes:
            self.only()
            changes["meshes"] = (changes.pop("mesh"),)
        out = super().with_changes(**{"shafts": shafts, "rotors": rotors, **changes})
        out._origin = self._origin
        return out

    @classmethod
    def from_dict(
        cls, tables: Mapping[str, Any], folder: str | os.PathLike = ".", name: str = "train"
    ) -> Train:
        """A train from the tables of a file, as `tomllib` gives them.

        Parameters
        ----------
        tables : mapping
            By the keys of a file; ``scene`` of a shaft is the name of a file, or the tables of one.
        folder : str or path
            Names of files in the tables are relative to it.
        name : str
            Of the train where the tables have none, and in messages.

        Returns
        -------
        Train
            As `solidgear.load_train` gives it.

        Raises
        ------
        SceneError
            Every problem of the tables, by their keys.

        Examples
        --------
        >>> import solidgear as sg
        >>> train = sg.load_train("geometry/axle_overhung.toml")
        >>> sg.Train.from_dict(train.to_dict()) == train
        True
        """
        return read_tables(tables, folder, name, "train", addition("document", "read train"))

    def to_dict(self) -> dict[str, Any]:
        """Tables of a file that describes the train with its shafts, as plain data in SI; `from_dict`
        reads them back equal.

        Returns
        -------
        dict
            By the keys of a file. Names of files are full paths.
        """
        return addition("document", "write train")(self)

    def to_toml(self, path: str | os.PathLike | None = None) -> str:
        """The file of the train: that which it was read from with its words and comments, where entries
        that have changed since are written anew; a scene that has changed stands inside.

        Parameters
        ----------
        path : str or path, optional
            File to write, whole or not at all; files are named from its folder.

        Returns
        -------
        str
            Text that `solidgear.load_train` reads back equal: without a path wherever it lies, for it
            holds the name of the train and full paths of files.

        Raises
        ------
        SolidgearError
            A file that cannot be written.
        """
        return addition("document", "text of train")(self, path)

    @property
    def document(self) -> Document | None:
        """Document that the train was read from, whatever has been changed since; None of one made in
        Python.
        """
        return self._origin.document

    @property
    def as_read(self) -> Document | None:
        """Document that the train was read from; None of one that has changed since."""
        return self.document if self._origin.thing == self else None

    def read_from(self, document: Document) -> Train:
        """Return the same train with the document that it was read from."""
        out = self.unjudged()
        out._origin = Origin(document, out.unjudged())  # a copy: no circle through its origin
        return out

    @property
    def solved_meshes(self) -> SolvedMeshes:
        """What its teeth give where they were solved; nothing of a train that has changed since."""
        return self._solved

    def with_solved_meshes(self, solved: SolvedMeshes) -> Train:
        """Return the same train with what its teeth give at operating points."""
        out = self.unjudged()
        out._solved = solved
        return out

    @property
    def called(self) -> str:
        """Title, or name, and the operating point at which it is looked at."""
        place = f" at {self.point.label}" if self.point is not None else ""
        return (self.title or self.name) + place

    @property
    def every(self) -> str:
        """All shafts, in a word before the noun."""
        return "both" if len(self.shafts) == 2 else f"all {len(self.shafts)}"

    @property
    def unloaded(self) -> tuple[str, ...]:
        """Bearings of catalogue data that carry nothing at the operating point, as ``side.name``."""
        if self.point is None:
            return ()
        return tuple(
            f"{side}.{b.name}"
            for side, shaft in self.shafts.items()
            for b in shaft.scene.bearings
            if b.catalogue is not None and b.matrix is not None and not np.any(b.matrix)
        )

    @property
    def point(self) -> OperatingPoint | None:
        """Operating point at which bearings have settled: the first; None without any."""
        return self.operation[0] if self.operation else None

    def told(self, point: OperatingPoint) -> OperatingPoint:
        """Return an operating point, with the torque on the engine's shaft unless it names another."""
        if "of" in point.model_fields_set or point.of == self.reference:
            return point
        return point.with_changes(of=self.reference)

    @property
    def reference(self) -> str:
        """Shaft that the first engine turns with, which speeds refer to; else the first."""
        return self.engine.shaft if self.engines else next(iter(self.shafts))

    @property
    def output(self) -> str:
        """Shaft that the first load turns with; else the last."""
        return self.load.shaft if self.loads else [*self.shafts][-1]

    @property
    def housed(self) -> tuple[str, ...]:
        """Shafts whose bearings stand in the housing."""
        if self.housing is None:
            return ()
        return tuple(s for s in self.housing.carries or self.shafts if s in self.shafts)

    @cached_property
    def turns(self) -> dict[str, float]:
        """Turns of every shaft in one turn of the engine's shaft, by the teeth."""
        return turns_of(self)

    @cached_property
    def pairs(self) -> tuple[Pair, ...]:
        """Gears that mesh, mesh by mesh."""
        short = self.short
        out = []
        for k, mesh in enumerate(self.meshes):
            ends = ends_of(self, k)
            paths = {
                role: self.gear_path(side, port)
                for role, (side, port) in zip(("pinion", "gear"), ends)
            }
            paths["mesh"] = ("mesh",) if short else ("mesh", k)
            sides, ports = (ends[0][0], ends[1][0]), (ends[0][1], ends[1][1])
            alone = len(self.meshes) == 1 and not self.planetary
            name = "mesh" if alone else f"mesh {mesh.name or '-'.join(sides)}"
            pinion, gear = (self.shafts[side].member(port) for side, port in ends)
            pinion, gear = with_flanks(self, k, pinion, gear)
            idle = is_idler(self, ends[1])
            out.append(Pair(name, sides, ports, paths, pinion, gear, mesh, self.point, idle))
        return tuple(out)

    @cached_property
    def stages(self) -> tuple[Stage, ...]:
        """Planetary stages on their shafts."""
        return tuple(stage_of(name, table, self.shafts) for name, table in self.planetary.items())

    @cached_property
    def joints(self) -> tuple[Joint, ...]:
        """Joints by which one shaft turns another: pairs, then planetary stages."""
        return (*self.pairs, *self.stages)

    @cached_property
    def teeth(self) -> tuple[Pair | PlanetMesh, ...]:
        """Meshes one by one: those of pairs, then those of planets."""
        return (*self.pairs, *(mesh for stage in self.stages for mesh in stage.meshes))

    @cached_property
    def drivers(self) -> tuple[Pair | PlanetMesh, ...]:
        """Meshes whose errors drive the train: those of pairs, then those of all planets together."""
        return (*self.pairs, *(mesh for stage in self.stages for mesh in stage.together))

    @property
    def short(self) -> bool:
        """True where a file may describe the train by [pinion], [gear] and [mesh] alone."""
        turned = {name: rotor.shaft for name, rotor in self.rotors.items()}
        usual = turned.items() <= SHORT.items() and tuple(self.shafts) == SIDES
        return usual and len(self.meshes) == 1

    def gear_path(self, side: str, port: str) -> tuple:
        """Return the keys of a gear in a file, which may have the only one of a shaft in the shaft's
        table.
        """
        if self.short:
            return (side,)
        tables = {} if self.document is None else self.document.tables.get("shaft", {})
        apart = len(self.shafts[side].gears) > 1 or "gears" in tables.get(side, {})
        return ("shaft", side, "gears", port) if apart else ("shaft", side)

    def shaft_path(self, side: str) -> tuple:
        """Return the keys of a shaft in a file."""
        return (side,) if self.short else ("shaft", side)

    def rotor_path(self, name: str) -> tuple:
        """Return the keys of an engine, a load or another rotor in a file."""
        kind = "engine" if name in self.engines else "load" if name in self.loads else "rotor"
        return (kind,) if name == kind else (kind, name)

    def per_turn(self, pair: Pair | PlanetMesh) -> PerTurn:
        """Return the teeth of a mesh that pass in one turn of the engine's shaft; of planets, those of
        the ring.
        """
        if isinstance(pair, PlanetMesh):
            teeth, side = pair.stage.teeth.ring, pair.stage.shafts[1]
        else:
            teeth, side = pair.pinion.teeth, pair.shafts[0]
        return PerTurn(teeth * self.turns[side], self.reference)

    def named_mesh(self, word: str | None) -> Pair | PlanetMesh:
        """Return a mesh by name, with or without the word mesh before it; the first by default."""
        for pair in (*self.drivers, *self.teeth):
            if word in (None, pair.name, pair.label.strip()):
                return pair
        names = listed(pair.label.strip() or pair.name for pair in self.drivers)
        raise SolidgearError(f"{self.name} has no mesh {word!r}; it has {names}")

    @cached_property
    def flows(self) -> dict[str, float | None]:
        """Share of the power that every mesh or stage passes from the first shaft to the second, by
        name; None where a loop of meshes divides it by stiffness.
        """
        return flows_of(self)

    @cached_property
    def carried(self) -> dict[str, float]:
        """Share of the power by shaft that it passes; in a loop of meshes that of the shaft's engines
        and loads.
        """
        return carried_of(self)

    @property
    def torque_turns(self) -> dict[str, float]:
        """Turns over shares of the power, to which torques are inverse, by shaft that it passes."""
        return {side: self.turns[side] / share for side, share in self.carried.items()}

    def only(self) -> Pair:
        """Return the only pair of gears; refuse a train of several meshes."""
        if len(self.teeth) > 1:
            raise SolidgearError(
                f"{self.name} has {len(self.teeth)} meshes, but this is for a train of one mesh "
                "only"
            )
        return self.pairs[0]

    @property
    def mesh(self) -> Mesh:
        """The only mesh."""
        return self.only().mesh

    @property
    def pinion(self) -> Member:
        """The shaft named pinion, with the first gear on it."""
        return self.member("pinion")

    @property
    def gear(self) -> Member:
        """The shaft named gear, with the first gear on it."""
        return self.member("gear")

    @property
    def engine(self) -> Rotor:
        """The first rotor through which torque comes in."""
        return self.rotors[self.engines[0]]

    @property
    def load(self) -> Rotor:
        """The first rotor through which torque goes out."""
        return self.rotors[self.loads[0]]

    @property
    def ratio(self) -> float:
        """Turns of the engine's shaft in one turn of the load's shaft."""
        return self.turns[self.reference] / self.turns[self.output]

    def named_shaft(self, side: str) -> Shaft:
        """Return a shaft by name."""
        if side not in self.shafts:
            names = listed(self.shafts)
            raise SolidgearError(f"{self.name} has no shaft {side!r}; it has {names}")
        return self.shafts[side]

    def member(self, side: str) -> Member:
        """Return a shaft by name, with the first gear on it."""
        return self.named_shaft(side).member()

    def rotors_of(self, side: str) -> dict[str, Rotor]:
        """Return the rotors that turn with a shaft, by name."""
        return {name: rotor for name, rotor in self.rotors.items() if rotor.shaft == side}

    def spring_port(self, name: str) -> str:
        """Return the port of a shaft that the torsional spring of a rotor acts on."""
        return self.rotors[name].spring.at or f"{name} spring"

    def torque_entry(self, side: str, gear: str) -> str | None:
        """Return the port at which the torque of a gear enters or leaves its shaft: that of a rotor, else
        of a further gear or a carrier; None where there is none.
        """
        rotors = [self.spring_port(name) for name in self.rotors_of(side)]
        gears = [name for name in self.shafts[side].gears if name != gear]
        carriers = [stage.ports[1] for stage in self.stages if stage.shafts[1] == side]
        return next(iter([*rotors, *gears, *carriers]), None)

    def shaft(self, side: str) -> Scene:
        """Return the scene of a shaft, with a free station at the place of every torsional spring that
        is on no port; attached as all others where these share one attachment.
        """
        side_shaft = self.shafts[side]
        scene = side_shaft.member().scene if len(side_shaft.gears) == 1 else side_shaft.scene
        ties = {s.attachment for s in scene.stations}
        datum = {"start": 0.0, "end": scene.length} | {s.name: s.y for s in scene.stations}
        stations = [
            Bearing(
                name=self.spring_port(name),
                y=datum[rotor.spring.from_] + rotor.spring.position,
                seat_width=rotor.spring.seat_width or 0.0,
                attachment=next(iter(ties)) if len(ties) == 1 else "average",
                stiffness=[[0.0] * 6] * 6,
                status=rotor.spring.status,
            )
            for name, rotor in self.rotors_of(side).items()
            if rotor.spring.position is not None
        ]
        if not stations:
            return scene
        return scene.with_changes(bearings=(*scene.bearings, *stations))

    def unpublished(self) -> dict[str, str]:
        """Return the status, ``identified`` or ``assumed``, of every value without a source, by key."""
        return {k: s for k, s in self.statuses().items() if s in ("identified", "assumed")}

    def statuses(self) -> dict[str, str]:
        """Return the status of every value of the file that has one, by key."""
        out: dict[str, Any] = {}
        for pair in self.pairs:
            mesh, name = pair.mesh, pair.name
            line = "line_of_action" if mesh.line_of_action else "contact_cells"
            line = "pressure_angle" if not (mesh.line_of_action or mesh.contact_cells) else line
            out[f"{name}.stiffness"] = mesh.status
            out[f"{name}.{line}"] = mesh.line_of_action_status
            if mesh.transmission_error is not None:
                out[f"{name}.transmission_error"] = mesh.transmission_error_status
        for name, rotor in self.rotors.items():
            out[f"{name}.inertia"] = rotor.status
            out[f"{name}.spring.stiffness"] = rotor.spring.status
        for name, table in self.planetary.items():
            out |= {f"{name}.mesh": table.mesh.status, f"{name}.planet": table.planet.status}
            if table.ring is not None:
                out[f"{name}.ring"] = table.ring.status
        out["losses"] = self.losses.status
        if self.housing is not None:
            out["housing"] = self.housing.status
            out |= {f"mount {name}": mount.status for name, mount in self.housing.mounted.items()}
        for side, shaft in self.shafts.items():
            for end, (_, head) in self.heads(side).items():
                out[end] = head.status
            for bearing in shaft.scene.bearings:
                out[f"{side} bearing {bearing.name}"] = bearing.status
        return {key: str(status) for key, status in out.items()}

    def heads(self, side: str) -> dict[str, tuple[str, HeadInertia]]:
        """Return rigid heads of a shaft with their ports, by ``side.head``, or with several gears
        ``side.port.head``.
        """
        gears = self.shafts[side].gears
        alone = len(gears) == 1
        return {
            f"{side}.head" if alone else f"{side}.{port}.head": (f"{side}.{port}", gear.head)
            for port, gear in gears.items()
            if gear.head is not None
        }


def with_carrier_turned(train: Train, name: str, angle: float) -> Train:
    """Return a train with the carrier of a stage turned by an angle, rad."""
    table = train.planetary[name]
    turned_table = table.with_changes(position=(table.position + angle) % (2 * pi))
    return train.with_changes(planetary={**train.planetary, name: turned_table})


def named_pair(train: Train, word: str | None) -> Pair:
    """Return a mesh of two shafts by name, as :meth:`Train.named_mesh`; refuse
    a mesh of planets, whose teeth have no backlash.
    """
    mesh = train.named_mesh(word)
    if isinstance(mesh, PlanetMesh):
        names = listed(pair.label.strip() for pair in train.pairs) or "none"
        raise SolidgearError(
            f"teeth of planets have no backlash; in {train.name} use one of {names}"
        )
    return mesh
