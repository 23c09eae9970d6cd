"""What rules and layout read of a train: its tables, and what follows from them."""

from __future__ import annotations

from typing import Protocol

from solidgear.core import Scene
from solidgear.trains.file.gears import Shaft
from solidgear.trains.file.housing import TrainHousing
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import Planetary, Stage
from solidgear.trains.file.tables import Mesh, Rotor

#: teeth by which one shaft turns another
Joint = Pair | Stage


class Shafting(Protocol):
    """Shafts joined by teeth, such as a :class:`solidgear.trains.file.train.Train`."""

    @property
    def shafts(self) -> dict[str, Shaft]:
        """Shafts by name."""

    @property
    def meshes(self) -> tuple[Mesh, ...]:
        """Tables of meshes between two shafts."""

    @property
    def rotors(self) -> dict[str, Rotor]:
        """Engines, loads and others that turn with the shafts, by name."""

    @property
    def engines(self) -> tuple[str, ...]:
        """Rotors that bring torque."""

    @property
    def loads(self) -> tuple[str, ...]:
        """Rotors that take torque."""

    @property
    def planetary(self) -> dict[str, Planetary]:
        """Tables of planetary stages by name."""

    @property
    def housing(self) -> TrainHousing | None:
        """Housing under the bearings."""

    @property
    def operation(self) -> tuple[OperatingPoint, ...]:
        """Torques and speeds at which the train runs."""

    @property
    def point(self) -> OperatingPoint | None:
        """First operating point."""

    @property
    def reference(self) -> str:
        """Shaft that speeds refer to."""

    @property
    def output(self) -> str:
        """Shaft that the first load turns with."""

    @property
    def housed(self) -> tuple[str, ...]:
        """Shafts whose bearings stand in the housing."""

    @property
    def turns(self) -> dict[str, float]:
        """Turns of every shaft in one turn of the reference."""

    @property
    def torque_turns(self) -> dict[str, float]:
        """Turns over shares of the power, by shaft that it passes."""

    @property
    def ratio(self) -> float:
        """Turns of the reference in one turn of the output."""

    @property
    def pairs(self) -> tuple[Pair, ...]:
        """Gears that mesh, mesh by mesh."""

    @property
    def stages(self) -> tuple[Stage, ...]:
        """Planetary stages on their shafts."""

    @property
    def joints(self) -> tuple[Joint, ...]:
        """Pairs, then planetary stages."""

    @property
    def flows(self) -> dict[str, float | None]:
        """Share of the power that every joint passes; None in a loop of meshes."""

    def shaft(self, side: str) -> Scene:
        """Return the scene of a shaft with a station for every torsional spring on it."""

    def shaft_path(self, side: str) -> tuple:
        """Return the keys of a shaft in a file."""

    def rotor_path(self, name: str) -> tuple:
        """Return the keys of an engine, a load or another rotor in a file."""
