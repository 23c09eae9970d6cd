"""Options on loads of a train or a shaft at rest, and the assembly and point that they give."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias, TypedDict

import typer

from solidgear.bearings.study import loaded_by
from solidgear.core import (
    SceneError,
    SolidgearError,
    Source,
    explained,
    is_train,
    name_of_source,
    show,
)
from solidgear.core.loading import as_written
from solidgear.core.scene.units import quantity
from solidgear.show.command import Group
from solidgear.show.options import CaseName, Named, refuse
from solidgear.strength.load import AT_REST, driven
from solidgear.trains.assembly.assembly import NO_MODES, Assembly
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.train import Train
from solidgear.trains.load.operation import named_point
from solidgear.trains.loading import load_train

#: torque as a text with a unit or a number in N m; None where it is not given
Given: TypeAlias = str | float | None
if TYPE_CHECKING:
    Torque: TypeAlias = Given
    #: at the port: a text, or its components
    Forces: TypeAlias = str | Mapping[str, Any] | None
    #: by the place where each enters: texts such as `B=115 N*m`, or a mapping
    Torques: TypeAlias = list[str] | Mapping[str, Any] | None
else:
    Torque = Forces = str | None
    Torques = list[str] | None


class Under(TypedDict, total=False):
    """Words of every study at rest: what acts on a train or on a shaft."""

    torque: Given
    of: str | None
    point: str | int | None
    weight: str | None
    load: str | Mapping[str, Any] | None
    case: str | int | None
    drive: Mapping[str, str | float] | list[str] | None


AtRestFile = Annotated[
    Path, typer.Argument(help="Train or scene file (TOML), such as geometry/axle_overhung.toml.")
]


@dataclass(frozen=True)
class Acting(Group):
    """An operating point of a train, or a load of a shaft."""

    torque: Annotated[
        Torque,
        typer.Option(
            help='Torque on a train, such as "115 N*m"; by default its first operating point.'
        ),
    ] = None
    of: Annotated[
        str | None,
        typer.Option("--of", help="Shaft of --torque: pinion or gear; the engine's shaft."),
    ] = None
    point: Annotated[
        Named, typer.Option("--point", help="Operating point of a train, by name or number.")
    ] = None
    weight: Annotated[
        str | None,
        typer.Option(
            help="With --torque: direction of weight in the first shaft's scene, such as -z."
        ),
    ] = None
    load: Annotated[
        Forces,
        typer.Option(
            "--load",
            help='Load on a shaft in place of those in its file: "x=2 kN, z=-500 N" at the port.',
        ),
    ] = None
    case: CaseName = None
    drive: Annotated[
        Torques,
        typer.Option(
            help='Torque that enters a shaft at a bearing, mass or point, such as "B=115 N*m", and '
            "leaves at the port, or where the file says; repeatable."
        ),
    ] = None

    def read(
        self, source: Source | Train, tol: float | str | None = None
    ) -> tuple[Assembly, OperatingPoint]:
        """Return a train and its operating point, or a shaft under its load, with the error that
        meshes may leave; refuse options of the other.
        """
        if isinstance(source, Train) or is_train(source):
            train, point = self.read_train(source)
            return Assembly(train, kept=NO_MODES, tol=tol), point
        of_train = {"`torque`": self.torque, "`point`": self.point, "`weight`": self.weight}
        options = {option: value is not None for option, value in of_train.items()}
        name = name_of_source(source)
        refuse(options, f"a train, and {name} is a shaft: give `load`, or [load] in the file")
        scene = as_written(source)
        if self.load is not None:
            scene = loaded_by(scene, self.load)
        if self.case is not None:
            scene = scene.with_case(self.case)
        if self.drive:
            scene = driven(scene, torques(self.drive))
        with explained(source):
            assembly = Assembly.of(scene, kept=NO_MODES, tol=tol)
        return assembly, assembly.train.point or AT_REST

    def read_train(self, source: Source | Train) -> tuple[Train, OperatingPoint]:
        """Return a train as its file has it and its operating point; refuse a load on a shaft."""
        self.refuse_load(source)
        return self._at_point(source)

    def refuse_load(self, train: Source | Train) -> None:
        """Refuse loads of a shaft."""
        kind = f"a shaft, and {name_of_source(train)} is a train: give `torque`"
        refuse({"`load`": self.load is not None, "`drive`": bool(self.drive)}, kind)
        kind = f"a shaft, and {name_of_source(train)} is a train: give `point`"
        refuse({"`case`": self.case is not None}, kind)

    def _at_point(self, source: Source | Train) -> tuple[Train, OperatingPoint]:
        if self.torque is None:
            name = name_of_source(source)
            kind = f"a `torque`, and there is none: write weight into [operation] of {name}"
            refuse({"`weight`": self.weight is not None}, kind)
            train = load_train(source)
            if not train.operation:
                raise SolidgearError(
                    f'{name}: no torque is given; write [operation] with torque = "115 N*m", or '
                    "give `torque`"
                )
            by_name = self.point is not None
            return train, named_point(train, self.point) if by_name else train.operation[0]
        if self.point is not None:
            raise SolidgearError("give either `torque` or `point`, not both")
        values: dict[str, Any] = {"torque": self.torque, "of": self.of, "weight": self.weight}
        try:
            point = OperatingPoint(**{key: value for key, value in values.items() if value})
        except SceneError as error:
            raise SolidgearError(f"`torque` {show(self.torque, 40)}: {error}") from None
        try:
            train = load_train(source, point)
        except SceneError as error:
            if error.path[:1] != ("operation",) or error.path[-1] != "of":
                raise
            raise SolidgearError(f"`of` {show(self.of, 40)}: {error.reason}") from None
        return train, train.told(point)


def torques(drive: list[str] | Mapping[str, Any]) -> dict[str, float]:
    """Return torques by the place where each enters, N m, from ``B=115 N*m`` or a mapping."""
    pairs = drive.items() if isinstance(drive, Mapping) else map(_torque, drive)
    out = {}
    for name, value in pairs:
        try:
            out[name] = quantity(value, "torque")
        except SceneError as error:
            raise SolidgearError(f"`drive` {name}: {error}") from None
    return out


def _torque(text: str) -> tuple[str, str]:
    """Return name and torque of ``B=115 N*m``."""
    name, sep, value = (part.strip() for part in text.partition("="))
    if not sep or not name:
        raise SolidgearError(f'`drive` {show(text)}: write NAME=TORQUE, such as "B=115 N*m"')
    return name, value
