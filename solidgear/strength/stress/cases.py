"""Stress of a shaft in every case of its loads: the largest moment, and the notch that is worst."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from solidgear.strength.stress.conditions import Conditions
from solidgear.strength.stress.drawn import drawn_stresses
from solidgear.strength.stress.rating import Rating
from solidgear.strength.stress.shaft import ShaftStress, local_stress, rating_under

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

    plain_names = ("label", "largest_moment", "fillet", "amplitude", "notch", "fatigue", "yielding")

    label: str  #: name and speed
    largest_moment: float  #: N m
    fillet: str  #: with the largest amplitude; empty without fillets
    amplitude: float | None  #: on its surface, Pa
    worst: Rated | None  #: notch with the least safety; None without ratings

    @property
    def notch(self) -> str:
        """Name of the notch with the least safety; empty without ratings."""
        return "" if self.worst is None else self.worst.name

    @property
    def fatigue(self) -> float | None:
        """Safety of that notch against fatigue."""
        return None if self.worst is None else self.worst.rating.fatigue

    @property
    def yielding(self) -> float | None:
        """Safety of that notch against yielding."""
        return None if self.worst is None else self.worst.rating.yielding


def case_stress(
    label: str, scene: Scene, stress: ShaftStress, forces: SectionForces, conditions: Conditions
) -> CaseStress:
    """Return the stress in a case, by the form factors of a shaft's stress."""
    amplitudes = {
        notch.name: local_stress(notch.found, forces.at(notch.y)).amplitude
        for notch in stress.notches
    }
    fillet = max(amplitudes, key=amplitudes.__getitem__, default="")
    worst = least_rated(scene, stress, forces, conditions)
    return CaseStress(label, forces.largest_moment, fillet, amplitudes.get(fillet), worst)


def least_rated(
    scene: Scene, stress: ShaftStress, forces: SectionForces, conditions: Conditions
) -> Rated | None:
    """Return the notch with the least safety under other section forces; None without ratings."""
    notches = _rated(scene, stress, forces, conditions)
    return min(notches, key=lambda notch: notch.rating.worst, default=None)


def _rated(
    scene: Scene, stress: ShaftStress, forces: SectionForces, conditions: Conditions
) -> Iterator[Rated]:
    """Yield all rated notches under other section forces."""
    for notch in stress.notches:
        if notch.rating is not None:
            yield Rated(notch.name, rating_under(scene, notch, forces, conditions))
    for drawn in drawn_stresses(scene, forces, conditions)[0]:
        if drawn.rating is not None:
            yield Rated(drawn.name, drawn.rating)
