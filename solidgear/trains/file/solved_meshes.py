"""Meshes of a train with the numbers of their teeth at operating points, which the train keeps so that
they are solved once: every study of the same train reads them. One that has changed since has none.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.planetary import Planetary
from solidgear.trains.file.tables import Mesh

#: load of an operating point, and the place in the ranges of the bearings as a text, empty as stated
Condition = tuple[OperatingPoint, str]


class Meshes(NamedTuple):
    """All meshes of a train under one load."""

    meshes: tuple[Mesh, ...]
    planetary: dict[str, Planetary]  #: stages by name
    cautions: tuple[str, ...]  #: sentences on what the numbers of the teeth leave out


@dataclass(frozen=True, eq=False)
class SolvedMeshes:
    """What the teeth of a train give, which follows from the train: all are equal."""

    by_condition: Mapping[Condition, Meshes] = field(default_factory=dict)
    #: sentences on the teeth whose numbers the train has in place of a word
    cautions: tuple[str, ...] = ()
    #: whether bearings of catalogue data have their stiffness at the operating point of the train
    with_bearings: bool = False

    def __eq__(self, other: object) -> bool:
        return isinstance(other, SolvedMeshes)

    def __hash__(self) -> int:
        return 0


def load_of(point: OperatingPoint) -> OperatingPoint:
    """Return an operating point without its name and its part of a duty table."""
    return point.with_changes(name="", share=None, hours=None)
