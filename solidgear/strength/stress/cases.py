"""Stress of a shaft in every case of its loads: the largest moment, and the notches that are worst."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from solidgear.strength.stress.conditions import Conditions
from solidgear.strength.stress.drawn import drawn_stresses
from solidgear.strength.stress.rating import Rating, severity
from solidgear.strength.stress.shaft import ShaftStress, local_under, rating_under

if TYPE_CHECKING:
    from solidgear.core import Scene
    from solidgear.strength.stress.section_forces import SectionForces


@dataclass(frozen=True)
class Rated:
    """A notch with its rating under other section forces."""

    name: str
    rating: Rating


@dataclass(frozen=True)
class CaseStress:
    """Stress of a shaft in one case of its loads."""

    plain_names = (
        "label",
        "largest_moment",
        "fillet",
        "amplitude",
        "notch",
        "fatigue",
        "yielding_notch",
        "yielding",
    )

    label: str  #: name and speed
    largest_moment: float  #: N m
    fillet: str  #: with the largest amplitude; empty without fillets
    amplitude: float | None  #: on its surface, Pa
    #: worst, yields: notches with the least safety against fatigue and against yielding; None without
    #: ratings
    worst: Rated | None
    yields: Rated | None

    @property
    def notch(self) -> str:
        """Name of the notch with the least safety against fatigue; empty without ratings."""
        return "" if self.worst is None else self.worst.name

    @property
    def fatigue(self) -> float | None:
        """Least safety against fatigue."""
        return None if self.worst is None else self.worst.rating.fatigue

    @property
    def yielding_notch(self) -> str:
        """Name of the notch with the least safety against yielding; empty without ratings."""
        return "" if self.yields is None else self.yields.name

    @property
    def yielding(self) -> float | None:
        """Least safety against yielding."""
        return None if self.yields is None else self.yields.rating.yielding


def case_stress(
    label: str, scene: Scene, stress: ShaftStress, forces: SectionForces, conditions: Conditions
) -> CaseStress:
    """Return the stress in a case, by the form factors of a shaft's stress."""
    amplitudes = {notch.name: local_under(notch, forces).amplitude for notch in stress.notches}
    fillet = max(amplitudes, key=amplitudes.__getitem__, default="")
    notches = [*rated_under(scene, stress, forces, conditions)]
    worst = min(notches, key=lambda notch: severity(notch.rating, 0.0), default=None)
    yields = min(notches, key=lambda notch: notch.rating.yielding, default=None)
    return CaseStress(label, forces.largest_moment, fillet, amplitudes.get(fillet), worst, yields)


def rated_under(
    scene: Scene, stress: ShaftStress, forces: SectionForces, conditions: Conditions
) -> Iterator[Rated]:
    """Yield all rated notches under other section forces."""
    for notch in stress.notches:
        if notch.rating is not None:
            yield Rated(notch.name, rating_under(scene, notch, forces, conditions))
    for drawn in drawn_stresses(scene, forces, conditions)[0]:
        if drawn.rating is not None:
            yield Rated(drawn.name, drawn.rating)
