"""Stress and rating of features of a drawing, each where it is worst along its length."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core import TOUCH, listed
from solidgear.strength.stress.conditions import Conditions
from solidgear.strength.stress.din743 import Load
from solidgear.strength.stress.duty import DutyForces, levels
from solidgear.strength.stress.meeting import (
    PlacedNotch,
    meeting_remark,
    others_at,
    placed_notches,
    together,
)
from solidgear.strength.stress.nominal import NominalStress
from solidgear.strength.stress.norm.steels import source_of, strength_of
from solidgear.strength.stress.norm.tested import TABLE
from solidgear.strength.stress.norm_notch import NormNotch, Section
from solidgear.strength.stress.rated_notch import Steel
from solidgear.strength.stress.rating import Rating, rated, severity
from solidgear.strength.stress.section_forces import Cut, SectionForces, sections_along

if TYPE_CHECKING:
    from solidgear.core import Scene
    from solidgear.core.scene import Segment
    from solidgear.core.scene.parts import Strength

#: of the six section forces, those that nominal stress is of
RATED = (1, 3, 4, 5)
#: relative difference of two safeties from which on both places are named
LITTLE = 1e-3


@dataclass(frozen=True)
class DrawnStress:
    """A feature as a notch of DIN 743, with the stress of this shaft under loads."""

    name: str
    kind: str  #: in words
    y: float  #: where it is worst, m
    section: Section  #: of nominal stress
    forces: np.ndarray  #: (6,) Q_x, N, Q_z, M_x, T, M_z there, N and N m
    nominal: NominalStress
    #: fatigue notch factors of the norm; empty for a material without strength
    factors: Mapping[Load, float]
    rating: Rating | None  #: none without strength
    remark: str
    segment: str = field(repr=False, default="")

    @property
    def severity(self) -> tuple[float, float, float]:
        """Rank of a notch, the worst least."""
        return severity(self.rating, self.nominal.bending + abs(self.nominal.tension))


@dataclass(frozen=True)
class Unrated:
    """A feature that DIN 743 does not rate."""

    name: str
    kind: str  #: in words
    reason: str


def drawn_stresses(
    scene: Scene,
    forces: SectionForces,
    conditions: Conditions,
    duty: Sequence[DutyForces] = (),
) -> tuple[tuple[DrawnStress, ...], tuple[Unrated, ...]]:
    """Return the stress of the features of a shaft that the norm rates, over a duty table where there
    is one, and the others.
    """
    stresses, unrated = list[DrawnStress](), list[Unrated]()
    notches = placed_notches(scene)
    for feature, placed in zip(scene.features, notches):
        notch = placed.notch
        if not isinstance(notch, NormNotch):
            unrated.append(Unrated(placed.name, placed.kind, *placed.remarks))
            continue
        segment = next(s for s in scene.segments if s.name == feature.segment)
        drawn = _Drawn(scene, segment, placed, notch.section, notches, forces, conditions, duty)
        stresses.append(drawn.worst())
    return tuple(stresses), tuple(unrated)


@dataclass(frozen=True)
class _Drawn:
    """A feature with all that its stress depends on."""

    scene: Scene
    segment: Segment
    placed: PlacedNotch
    section: Section  #: of nominal stress
    notches: Sequence[PlacedNotch]  #: of the shaft, itself among them
    forces: SectionForces
    conditions: Conditions
    duty: Sequence[DutyForces]

    def worst(self) -> DrawnStress:
        """Return its stress in the section of its length where it is worst, with the least safety of
        every kind in any.
        """
        candidates = [*self._candidates()]
        stress = min(candidates, key=lambda stress: stress.severity)
        remarks = [stress.remark] if stress.remark else []
        if without := self._without_factor():
            remarks.append(f"it meets the {listed(without)}, which has no factor and is left out")
        ratings = [each.rating for each in candidates if each.rating is not None]
        rating = stress.rating
        if rating is not None:
            least = rating.with_least_of(ratings)
            if least.yielding < (1 - LITTLE) * rating.yielding:
                weak = candidates[[each.yielding for each in ratings].index(least.yielding)]
                remarks.append(f"against yielding it is worst at y = {1e3 * weak.y:.4g} mm")
            rating = least
        return replace(stress, rating=rating, remark="; ".join(remarks))

    def _without_factor(self) -> list[str]:
        """Return the names of what it meets along its length that the norm has no factor for."""
        (lo, hi), met = self.placed.span, []
        for other in self.notches:
            overlaps = other.span[0] < hi - TOUCH and other.span[1] > lo + TOUCH
            if other.notch is None and overlaps and self.placed.touches(other):
                met.append(f'{other.kind} "{other.name}"')
        return met

    def _candidates(self) -> Iterator[DrawnStress]:
        """Yield its stress in sections along it, once where the same acts in several."""
        all_forces = [self.forces, *(point.forces for point in self.duty)]
        ends = [end for other in self.notches for end in other.span]
        seen = set()
        for cut in sections_along(self.placed.span, all_forces, ends):
            others = [*others_at(cut, self.placed, self.notches)]
            acting = tuple(float(cut.of(each)[k]) for each in all_forces for k in RATED)
            state = acting, tuple(other.name for other in others)
            if state not in seen:
                seen.add(state)
                yield self._at(cut, others)

    def _at(self, cut: Cut, others: Sequence[PlacedNotch]) -> DrawnStress:
        """Return its stress in a section across the shaft, with the notches that it meets there."""
        placed, section, conditions = self.placed, self.section, self.conditions
        notch, six = together(placed, others), cut.of(self.forces)
        nominal = section.nominal(six)
        strength = strength_of(self.segment)
        remarks = [*placed.remarks, *filter(None, [meeting_remark(others)])]
        rating, factors = None, {}
        if strength is not None:
            rating = rated(
                notch,
                levels(conditions, self.duty, nominal, lambda each: section.nominal(cut.of(each))),
                strength,
                conditions,
                2 * self.scene.outline.largest_radius,
                source_of(self.segment),
            )
            steel = steel_at_size(strength, rating, conditions)
            factors = dict(notch.factors(steel).notch)
            in_tests = TABLE[0] <= steel.ultimate <= TABLE[1]
            if notch.tested_roughness is not None and not in_tests:
                remarks.append(
                    f"a tensile strength of {steel.ultimate / 1e6:.4g} MPa is outside of the tests, "
                    "400 to 1200 MPa"
                )
            if conditions.hard_surface and rating.crack is None:
                remarks.append(no_crack_check(conditions))
        return DrawnStress(
            name=placed.name,
            kind=placed.kind,
            y=cut.y,
            section=section,
            forces=six,
            nominal=nominal,
            factors=factors,
            rating=rating,
            remark="; ".join(remarks),
            segment=self.segment.name,
        )


def no_crack_check(conditions: Conditions) -> str:
    """Return a sentence on a notch in a hard surface whose first crack is not judged."""
    if conditions.surface_strength is None:
        return "its first crack is not judged without surface_strength"
    return "its first crack is not judged: the norm has no form factor for it"


def steel_at_size(strength: Strength, rating: Rating, conditions: Conditions) -> Steel:
    """Return the strength at the size of the part that a rating took."""
    size = {entry.symbol: entry.values[0] or 1.0 for entry in rating.entries[:4]}
    return Steel(
        strength.ultimate * size["K_1 (sigma_B)"],
        strength.yield_point * size["K_1 (sigma_S)"],
        conditions.hard_surface,
    )
