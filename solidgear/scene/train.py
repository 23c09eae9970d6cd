"""Two shafts that mesh, with what drives them and what they drive: data only.

The two shafts are scenes of their own.  Vectors of the mesh are told in the *pinion's frame*: y
along its shaft from the pitch apex towards its back, the mesh on its -x side, z up
(:mod:`solidgear.system.gear_mesh` draws it), from the pinion's lumped point.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import isclose, pi

import numpy as np
from pydantic import model_validator

from solidgear.errors import SceneError, listed, nearest
from solidgear.scene.cylindrical import cylindrical_problems, rolling
from solidgear.scene.model import Scene
from solidgear.scene.operation import OperatingPoint, Operation, operation_problems
from solidgear.scene.stations import Bearing
from solidgear.scene.train_tables import FLANKS, Losses, Member, Mesh, Rotor, TrainAsk
from solidgear.scene.typed import Model

SIDES = ("pinion", "gear")
#: a ratio that is typed with four digits may differ from that of the teeth by this
RATIO_TYPED = 1e-3


class Train(Model):
    """Engine, pinion shaft, mesh, gear shaft, load; read one with `solidgear.load_train`.

    Attributes
    ----------
    title, name, source : str
    pinion, gear : Member
    mesh : Mesh
    engine, load : Rotor
    losses : Losses
    operation : tuple of OperatingPoint
        Torques and speeds at which it runs; bearings of catalogue data settle at the first.
    ask : TrainAsk

    Raises
    ------
    SceneError
        Every problem of its parts, hands that cannot mesh, a ratio
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
    pinion: Member
    gear: Member
    mesh: Mesh
    engine: Rotor
    load: Rotor
    losses: Losses = Losses()
    operation: Operation = ()
    ask: TrainAsk = TrainAsk()

    @model_validator(mode="after")
    def _hangs_together(self) -> Train:
        problems = [*self._teeth(), *self._springs(), *self._operation()]
        if problems:
            raise SceneError.of(problems)
        return self

    def _teeth(self) -> Iterator[SceneError]:
        hands = (self.pinion.hand, self.gear.hand)
        curved = any(m.spiral_angle or m.helix_angle for m in (self.pinion, self.gear))
        if curved and None not in hands and hands[0] == hands[1]:
            pair = (
                "spiral bevel pair" if self.mesh.shaft_angle else "helical pair on parallel shafts"
            )
            yield SceneError(
                f"both wheels are {hands[0]}-handed and cannot mesh; a {pair} has one of each",
                path=("gear", "hand"),
            )
        yield from self._flanks()
        yield from cylindrical_problems(self.pinion, self.gear, self.mesh)
        ratio = self.gear.teeth / self.pinion.teeth
        given = self.mesh.ratio
        if given is not None and not isclose(given, ratio, rel_tol=RATIO_TYPED):
            yield SceneError(
                f"{self.gear.teeth} over {self.pinion.teeth} teeth are a ratio of {ratio:.4f}; "
                "correct it or leave it out",
                path=("mesh", "ratio"),
            )

        yield from self._cycles()

    def _cycles(self) -> Iterator[SceneError]:
        """Tables over a mesh cycle cover one tooth pitch of the pinion and begin at one angle."""
        pitch = 2 * pi / self.pinion.teeth
        tables = {key: getattr(self.mesh, key) for key in ("stiffness_cycle", "line_cycle")}
        given = {key: table for key, table in tables.items() if table is not None}
        for key, table in given.items():
            if not isclose(table.pitch, pitch, rel_tol=RATIO_TYPED):
                yield SceneError(
                    f"covers {table.pitch:.5g} rad of the pinion, and one of its "
                    f"{self.pinion.teeth} teeth takes {pitch:.5g} rad; correct the angles, or the "
                    "number of teeth",
                    path=("mesh", key, "angle"),
                )
        first = [table.angle[0] for table in given.values()]
        if len(first) > 1 and not isclose(*first, abs_tol=RATIO_TYPED * pitch):
            yield SceneError(
                f"begins at {first[1]:.5g} rad, and stiffness_cycle at {first[0]:.5g} rad; both tell "
                "one cycle and begin at one angle",
                path=("mesh", "line_cycle", "angle"),
            )

    def _flanks(self) -> Iterator[SceneError]:
        """Left and right flanks are those of cylindrical gears, and touch their own kind."""
        named = [side for side in SIDES if self.member(side).loaded_side in FLANKS]
        if named and self.mesh.shaft_angle:
            yield SceneError(
                "left and right flanks are words of parallel shafts (ISO 21771); of a bevel gear "
                "write concave or convex",
                path=(named[0], "loaded_side"),
            )
        elif named and None not in (self.pinion.flank, self.gear.flank):
            if self.pinion.flank != self.gear.flank:
                yield SceneError(
                    f"is the {self.gear.flank} flank, and the {self.pinion.flank} one is loaded on "
                    "the pinion: seen from one side, left flanks touch left ones; correct one of "
                    "the two, or leave that of the gear out",
                    path=("gear", "loaded_side"),
                )

    def _springs(self) -> Iterator[SceneError]:
        for rotor, side in (("engine", "pinion"), ("load", "gear")):
            spring, scene = getattr(self, rotor).spring, getattr(self, side).scene
            ports = [s.name for s in scene.stations]
            key, word = ("at", spring.at) if spring.at is not None else ("from", spring.from_)
            known = ports if key == "at" else ["start", "end", *ports]
            if word not in known:
                yield SceneError(
                    f"unknown port of the {side}'s shaft{nearest(word, known)}; "
                    f"known here: {listed(known)}",
                    path=(rotor, "spring", key),
                )
            elif key == "from" and word in ports and word in ("start", "end"):
                yield SceneError(
                    f"is the {word} of the {side}'s shaft, and a station is called so as well; "
                    "give the station another name",
                    path=(rotor, "spring", key),
                )
            elif key == "from":
                yield from self._on_the_shaft(rotor, side)

    def _on_the_shaft(self, rotor: str, side: str) -> Iterator[SceneError]:
        try:
            self.shaft(side)
        except SceneError as error:
            reason = f"is no place on the {side}'s shaft: {error.problems[0].reason}"
            yield SceneError(reason, path=(rotor, "spring", "position"))

    def _operation(self) -> Iterator[SceneError]:
        if not self.operation:
            return
        ports = {side: [s.name for s in self.member(side).scene.stations] for side in SIDES}
        yield from operation_problems(self.operation, self.ratio, ports)
        for side in SIDES:
            scene = self.member(side).scene
            held = [b.name for b in scene.bearings if b.matrix is not None and b.matrix[4][4] > 0]
            if held:
                yield SceneError(
                    f"a torque has to turn the {side}'s shaft, and {listed(held)} of its scene "
                    "holds its rotation: leave kthy out, or hold it in another way than clamped",
                    path=("operation",),
                )
            yield from self._speeds(side, scene)

    def _speeds(self, side: str, scene: Scene) -> Iterator[SceneError]:
        """Speeds that bearings of a shaft name and that it does not have."""
        for bearing in scene.bearings:
            own = bearing.catalogue.speed if bearing.catalogue is not None else 0.0
            for k, point in enumerate(self.operation):
                speed = point.speed_of(side, self.ratio)
                if own and speed is not None and not isclose(own, speed, rel_tol=RATIO_TYPED):
                    yield SceneError(
                        f"turns the {side}'s shaft at {speed * 30 / pi:.6g} rpm, and the "
                        f"catalogue data of its bearing {bearing.name} name {own * 30 / pi:.6g} "
                        "rpm; correct one, or leave the bearing's speed out",
                        path=("operation", k, "speed"),
                    )
                    break

    @property
    def called(self) -> str:
        """Title, or name, and the operating point at which it is looked at."""
        where = f" at {self.point.label}" if self.point is not None else ""
        return (self.title or self.name) + where

    @property
    def unloaded(self) -> tuple[str, ...]:
        """Bearings of catalogue data that carry nothing at the operating point, as ``side.name``."""
        if self.point is None:
            return ()
        return tuple(
            f"{side}.{b.name}"
            for side in SIDES
            for b in self.member(side).scene.bearings
            if b.catalogue is not None and b.matrix is not None and not np.any(b.matrix)
        )

    @property
    def point(self) -> OperatingPoint | None:
        """Operating point at which its bearings have settled: the first; None without any."""
        return self.operation[0] if self.operation else None

    @property
    def ratio(self) -> float:
        """Teeth of the gear over teeth of the pinion."""
        return self.gear.teeth / self.pinion.teeth

    @property
    def rolling(self) -> Train:
        """The same with pitch radii and angles of parallel shafts where their wheels roll on each
        other: what module, helix angle, profile shifts and centre distance come to.

        Raises
        ------
        SceneError
            For a centre distance or profile shifts that no pressure angle meets.
        """
        return self.with_changes(**rolling(self.pinion, self.gear, self.mesh))

    def member(self, side: str) -> Member:
        """``pinion`` or ``gear``."""
        return {"pinion": self.pinion, "gear": self.gear}[side]

    def rotor(self, side: str) -> tuple[str, Rotor]:
        """Rotor that turns with a shaft, and its name: the engine with the pinion, the load with
        the gear.
        """
        return ("engine", self.engine) if side == "pinion" else ("load", self.load)

    def spring_port(self, side: str) -> str:
        """Port of a shaft that its torsional spring acts on."""
        name, rotor = self.rotor(side)
        return rotor.spring.at or f"{name} spring"

    def shaft(self, side: str) -> Scene:
        """Scene of a shaft, with the place of its torsional spring as a free station if that is
        none of its ports; tied as the others are, where all of them are tied alike.
        """
        scene, spring = self.member(side).scene, self.rotor(side)[1].spring
        if spring.position is None:
            return scene
        datum = {"start": 0.0, "end": scene.length} | {s.name: s.y for s in scene.stations}
        ties = {s.attachment for s in scene.stations}
        station = Bearing(
            name=self.spring_port(side),
            y=datum[spring.from_] + spring.position,
            seat_width=spring.seat_width or 0.0,
            attachment=ties.pop() if len(ties) == 1 else "average",
            stiffness=[[0.0] * 6] * 6,
            status=spring.status,
        )
        return scene.with_changes(bearings=(*scene.bearings, station))

    def unpublished(self) -> dict[str, str]:
        """Every value of the file that no source gives, by its key: ``identified`` or
        ``assumed``.
        """
        return {k: s for k, s in self.statuses().items() if s in ("identified", "assumed")}

    def statuses(self) -> dict[str, str]:
        """Status of every value of the file that has one, by its key."""
        mesh, out = self.mesh, {}
        line = "line_of_action" if mesh.line_of_action else "contact_cells"
        line = "pressure_angle" if not (mesh.line_of_action or mesh.contact_cells) else line
        for key, status in (
            ("mesh.stiffness", mesh.status),
            (f"mesh.{line}", mesh.line_of_action_status),
            ("mesh.transmission_error", mesh.transmission_error_status),
            ("engine.inertia", self.engine.status),
            ("engine.spring.stiffness", self.engine.spring.status),
            ("load.inertia", self.load.status),
            ("load.spring.stiffness", self.load.spring.status),
            ("losses", self.losses.status),
        ):
            out[key] = str(status)
        for side in SIDES:
            member = self.member(side)
            if member.head is not None:
                out[f"{side}.head"] = str(member.head.status)
            for bearing in member.scene.bearings:
                out[f"{side} bearing {bearing.name}"] = str(bearing.status)
        return out
