"""Local stress of the notches that features of a shaft make, by solids around them.

Grooves of revolution have the harmonic solid, keyways and cross holes a 3D one. Another kind is a
line in ``SOLIDS``.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from solidgear.core import SolidgearError, listed
from solidgear.strength.stress.groove import GrooveFactors, groove_factors
from solidgear.strength.stress.groove_mesh import GrooveShape
from solidgear.strength.stress.local_factors import LocalFactors, local_factors
from solidgear.strength.stress.nominal import NominalStress, nominal_stress
from solidgear.strength.stress.section_forces import sections_along
from solidgear.strength.stress.shaft import ShaftStress
from solidgear.strength.stress.shaft import local_stress as stress_on_arc

if TYPE_CHECKING:
    from solidgear.core import Scene
    from solidgear.core.scene import Segment

Factors: TypeAlias = GrooveFactors | LocalFactors
#: in diameters of the shaft: a shoulder, another feature or a seat under load nearer to a notch
#: disturbs its stress, which is that of a plain shaft on both sides
NEAR = 1.0
#: relative error bar of a 3D solid below which no mesh leads
FINEST_LOCAL = 0.03


@dataclass(frozen=True)
class LocalStress:
    """Stress on the surface of a notch where amplitude and mean are largest together, Pa."""

    #: amplitude, amplitude_bar: largest principal stress by bending of the turning shaft
    amplitude: float
    amplitude_bar: float
    #: mean, mean_bar: the same by axial force
    mean: float
    mean_bar: float
    #: shear, shear_bar: largest shear stress by torque, at the same place
    shear: float
    shear_bar: float

    @property
    def rank(self) -> tuple[float, float]:
        """Normal stress, then shear stress, Pa: the largest is the worst."""
        return self.amplitude + abs(self.mean), abs(self.shear)


@dataclass(frozen=True)
class SolidNotch:
    """A feature with its stress by a solid, under the loads of a shaft."""

    name: str
    kind: str
    y: float  #: m: forces and nominal stress are those of the section there
    factors: Factors
    forces: np.ndarray  #: (6,) Q_x, N, Q_z, M_x, T, M_z, N and N m
    nominal: NominalStress
    local: LocalStress
    remarks: tuple[str, ...]
    enough: float  #: relative error bar asked for

    @property
    def reached(self) -> bool:
        """Return whether the error bars of all factors are as asked for."""
        return self.factors.widest <= self.enough


def solid_notches(
    scene: Scene,
    stress: ShaftStress,
    tolerance: float,
    local: float | None = None,
    progress: Callable[[str], None] = lambda text: None,
) -> tuple[tuple[SolidNotch, ...], tuple[str, ...]]:
    """Return the notches of the features of a scene that a solid gives stress to, and sentences on
    those that have none; `tolerance` is the relative error bar of grooves, `local` that of keyways
    and cross holes, which are left out without it. Section forces are those where the norm rates a
    feature, in the middle of it where it does not.
    """
    notches, remarks = [], []
    rated = {drawn.name: (drawn.y, drawn.forces) for drawn in stress.drawn}
    for feature in sorted(scene.features, key=lambda f: f.span(scene.segments)):
        solid = SOLIDS.get(feature.kind)
        if solid is None:
            continue
        enough = tolerance if solid.revolved else local
        if enough is None:
            continue
        progress(feature.name)
        segment = next(s for s in scene.segments if s.name == feature.segment)
        try:
            concentration = solid.factors(segment, feature, enough)
        except SolidgearError as error:  # the others have their stress all the same
            remarks.append(f"no local stress: {error}")
            continue
        middle = concentration.reference
        y, section_load = rated.get(feature.name) or (
            middle,
            max(
                (
                    cut.of(stress.forces)
                    for cut in sections_along((middle, middle), [stress.forces])
                ),
                key=lambda six: local_stress(concentration, six).rank,
            ),
        )
        notches.append(
            SolidNotch(
                name=feature.name,
                kind=feature.what,
                y=y,
                factors=concentration,
                forces=section_load,
                nominal=_nominal(concentration, section_load),
                local=local_stress(concentration, section_load),
                remarks=(*_remarks(scene, feature, segment, concentration, enough),),
                enough=enough,
            )
        )
    return tuple(notches), tuple(remarks)


def local_stress(concentration: Factors, forces: np.ndarray) -> LocalStress:
    """Return the stress on the surface of a notch under section forces (6,)."""
    if isinstance(concentration, GrooveFactors):
        on_arc = vars(stress_on_arc(concentration, forces))
        return LocalStress(**{f.name: on_arc[f.name] for f in fields(LocalStress)})
    nominal, factors, on_surface = (
        concentration.nominal.stress(forces),
        concentration.factors,
        concentration.fields,
    )
    amplitude = on_surface["bending"] * nominal.bending
    mean = on_surface["tension"] * nominal.tension
    shear = on_surface["torsion"] * nominal.torsion
    largest = amplitude + np.abs(mean)
    place = int((largest if largest.any() else np.abs(shear)).argmax())
    return LocalStress(
        float(amplitude[place]),
        factors["bending"].bar * nominal.bending,
        float(mean[place]),
        factors["tension"].bar * abs(nominal.tension),
        float(shear[place]),
        factors["torsion"].bar * abs(nominal.torsion),
    )


def _nominal(concentration: Factors, forces: np.ndarray) -> NominalStress:
    if isinstance(concentration, GrooveFactors):
        return nominal_stress(concentration.section, forces, concentration.radius)
    return concentration.nominal.stress(forces)


def _remarks(
    scene: Scene, feature: Any, segment: Segment, concentration: Factors, tolerance: float
) -> Iterator[str]:
    """Yield what a user must know with the numbers of a notch."""
    low, high = feature.span(scene.segments)
    diameter = 2 * segment.outer0
    steps = {f"the step at {y:.6g} m": (y, y) for y in scene.outline.steps}
    others = {
        f'"{other.name}"': other.span(scene.segments)
        for other in scene.features
        if other is not feature
    }
    gaps = {
        what: max(low - end, start - high, 0.0) / diameter
        for what, (start, end) in (steps | others).items()
    }
    near = [f"{what} ({gap:.2g} diameters away)" for what, gap in gaps.items() if gap < NEAR]
    if near:
        yield f"not in its solid: {listed(near)}"
    if concentration.widest > tolerance:
        yield (
            f"error bar {100 * concentration.widest:.2g} %, above the {100 * tolerance:.2g} % asked for, "
            f"by the finest mesh here: allow {math.ceil(100 * concentration.widest)} %"
        )


@dataclass(frozen=True)
class Solid:
    """How a kind of feature gets its factors."""

    factors: Callable[[Segment, Any, float], Factors]
    revolved: bool


def _ring_groove(segment: Segment, groove: Any, tolerance: float) -> Factors:
    radius = groove.radius or 0.0
    shape = GrooveShape(groove.depth_in(segment.outer0), radius, groove.width - 2 * radius)
    return _groove(segment, groove, shape, tolerance)


def _round_groove(segment: Segment, groove: Any, tolerance: float) -> Factors:
    shape = GrooveShape(groove.depth_in(segment.outer0), groove.radius)
    return _groove(segment, groove, shape, tolerance)


def _v_groove(segment: Segment, groove: Any, tolerance: float) -> Factors:
    shape = GrooveShape(groove.depth_in(segment.outer0), groove.radius, lean=groove.flank_angle / 2)
    return _groove(segment, groove, shape, tolerance)


def _groove(segment: Segment, groove: Any, shape: GrooveShape, tolerance: float) -> Factors:
    low, high = groove.reach(segment.outer0)
    return groove_factors(
        f'{groove.what} "{groove.name}"', segment, shape, (low + high) / 2, tolerance
    )


#: by kind of feature
SOLIDS: Mapping[str, Solid] = {
    "ring_groove": Solid(_ring_groove, revolved=True),
    "round_groove": Solid(_round_groove, revolved=True),
    "v_groove": Solid(_v_groove, revolved=True),
    "keyway": Solid(local_factors, revolved=False),
    "cross_hole": Solid(local_factors, revolved=False),
}
