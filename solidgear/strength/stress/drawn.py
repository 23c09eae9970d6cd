"""Stress and rating of features of a drawing, each where it is worst along its length."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from solidgear.core import TOUCH
from solidgear.strength.stress.conditions import Conditions
from solidgear.strength.stress.din743 import Load
from solidgear.strength.stress.duty import DutyForces, levels
from solidgear.strength.stress.nominal import NominalStress
from solidgear.strength.stress.norm.steels import source_of, strength_of
from solidgear.strength.stress.norm.tested import TABLE
from solidgear.strength.stress.norm_notch import Section
from solidgear.strength.stress.notches import DrawnNotch, drawn_notch
from solidgear.strength.stress.rated_notch import Steel
from solidgear.strength.stress.rating import Rating, rated

if TYPE_CHECKING:
    from solidgear.core import Scene
    from solidgear.core.scene.parts import Strength
    from solidgear.strength.stress.section_forces import SectionForces


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
    def severity(self) -> tuple[float, float]:
        """Rank of a notch, the worst least: the safety, or minus the stress where there is none."""
        safety = self.rating.worst if self.rating else np.inf
        return safety, -(self.nominal.bending + abs(self.nominal.tension))


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
    stresses, unrated = [], []
    for feature in scene.features:
        drawn = drawn_notch(scene, feature)
        if isinstance(drawn, str):
            unrated.append(Unrated(feature.name, feature.what, drawn))
        else:
            stresses.append(_worst(scene, feature, drawn, forces, conditions, duty))
    return tuple(stresses), tuple(unrated)


def _worst(
    scene: Scene,
    feature: Any,
    drawn: DrawnNotch,
    forces: SectionForces,
    conditions: Conditions,
    duty: Sequence[DutyForces],
) -> DrawnStress:
    """Return the stress of a notch in the section of its length where it is worst."""
    all_forces = [forces, *(point.forces for point in duty)]
    candidates = [
        _at(scene, feature, drawn, cut, forces, conditions, duty)
        for cut in _cuts(feature.span(scene.segments), all_forces)
    ]
    return min(candidates, key=lambda stress: stress.severity)


class Cut(NamedTuple):
    """A section across the shaft, just before a place, m, or just beyond it."""

    y: float
    beyond: bool

    def of(self, forces: SectionForces) -> np.ndarray:
        """Return the section forces (6,) there."""
        return forces.at(self.y) if self.beyond else forces.before(self.y)


def _cuts(span: tuple[float, float], forces: Sequence[SectionForces]) -> Iterator[Cut]:
    """Yield sections along a span, m: both ends, and both sides of loads between."""
    lo, hi = span
    yield Cut(lo, beyond=True)
    loaded = np.unique(np.concatenate([each.y for each in forces]))
    for y in loaded[(loaded > lo + TOUCH) & (loaded < hi - TOUCH)]:
        yield Cut(float(y), beyond=False)
        yield Cut(float(y), beyond=True)
    yield Cut(hi, beyond=False)


def _at(
    scene: Scene,
    feature: Any,
    drawn: DrawnNotch,
    cut: Cut,
    forces: SectionForces,
    conditions: Conditions,
    duty: Sequence[DutyForces],
) -> DrawnStress:
    """Return the stress of a notch in a section across the shaft."""
    section, six = drawn.notch.section, cut.of(forces)
    notch, nominal = drawn.notch, section.nominal(six)
    segment = next(s for s in scene.segments if s.name == feature.segment)
    strength = strength_of(segment)
    rating, factors, remarks = None, {}, list(drawn.remarks)
    if strength is not None:
        largest = 2 * scene.outline.largest_radius
        rating = rated(
            notch,
            levels(conditions, duty, nominal, lambda each: section.nominal(cut.of(each))),
            strength,
            conditions,
            largest,
            source_of(segment),
        )
        steel = steel_at_size(strength, rating, conditions)
        factors = dict(notch.factors(steel).notch)
        if notch.tested_roughness is not None and not TABLE[0] <= steel.ultimate <= TABLE[1]:
            remarks.append(
                f"a tensile strength of {steel.ultimate / 1e6:.4g} MPa is outside of the tests, 400 "
                "to 1200 MPa"
            )
        if conditions.hard_surface and rating.crack is None:
            remarks.append(_no_crack_check(conditions))
    return DrawnStress(
        name=feature.name,
        kind=feature.what,
        y=cut.y,
        section=section,
        forces=six,
        nominal=nominal,
        factors=factors,
        rating=rating,
        remark="; ".join(remarks),
        segment=segment.name,
    )


def _no_crack_check(conditions: Conditions) -> str:
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
