"""Pairs of gears that mesh: data only."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

from solidgear.core import SceneError
from solidgear.trains.file.cylindrical import rolling_fields
from solidgear.trains.file.gears import Member
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.tables import ErrorTable, Mesh


@dataclass(frozen=True)
class Pair:
    """Two gears that mesh."""

    name: str  #: of the mesh: ``mesh`` where it is the only one
    #: shafts, ports: of the first gear, called pinion here whatever its size, and of the other
    shafts: tuple[str, str]
    ports: tuple[str, str]
    paths: Mapping[str, tuple]  #: keys of a file at which ``pinion``, ``gear`` and ``mesh`` stand
    pinion: Member
    gear: Member
    mesh: Mesh
    point: OperatingPoint | None  #: at which the train is looked at
    #: true where the second gear is first in a further mesh: it drives there with the flank that the
    #: file names, and is driven here on the flank behind
    idle: bool = False

    @property
    def error(self) -> ErrorTable | None:
        """Transmission error of the mesh; None where the file gives none."""
        return self.mesh.transmission_error

    @property
    def members(self) -> dict[str, Member]:
        """Both gears, by ``pinion`` and ``gear``."""
        return {"pinion": self.pinion, "gear": self.gear}

    @property
    def label(self) -> str:
        """Name of the mesh in the middle of a phrase; empty where it is the only one."""
        return self.name.removeprefix("mesh")

    @property
    def ratio(self) -> float:
        """Teeth of the gear over teeth of the pinion."""
        return self.gear.teeth / self.pinion.teeth

    @cached_property
    def rolling(self) -> Pair:
        """The pair with pitch radii and angles of parallel shafts where the wheels roll on each other,
        as module, helix angle, profile shifts and centre distance give them.
        """
        return replace(self, **rolling_fields(self.pinion, self.gear, self.mesh))

    def with_file_paths(self, problems: Iterable[SceneError]) -> Iterator[SceneError]:
        """Yield problems of ``pinion``, ``gear`` or ``mesh`` with the paths of the file."""
        for problem in problems:
            first, *further = problem.path
            yield problem.located(None, path=(*self.paths[first], *further))
