"""Stress of a whole shaft under loads on ports: section forces, nominal stress, fillets, notches.

Sharp corners have no stress: that of an elastic solid grows there without end as the mesh is
refined (Williams 1952), so they are listed and get no number.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from solidgear.core import TOUCH, SolidgearError, show
from solidgear.core.scene.corner import Corner
from solidgear.core.scene.outline import radii_of
from solidgear.strength.stress.conditions import Conditions
from solidgear.strength.stress.din743 import LOADS
from solidgear.strength.stress.din743 import Load as LoadKind
from solidgear.strength.stress.drawn import DrawnStress, Unrated, drawn_stresses, steel_at_size
from solidgear.strength.stress.duty import DutyForces, levels
from solidgear.strength.stress.fillet_rating import FatigueFactor, FilletNotch
from solidgear.strength.stress.nominal import (
    NominalRow,
    NominalStress,
    nominal_rows,
    nominal_stress,
)
from solidgear.strength.stress.norm.steels import source_of, strength_of
from solidgear.strength.stress.notch import ENOUGH, FilletFactors, NotchFactors, fillet_factors
from solidgear.strength.stress.published import PUBLISHED
from solidgear.strength.stress.rating import Rating, rated, severity
from solidgear.strength.stress.section_forces import SectionForces, both_sides, forces_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from solidgear.core import Scene
    from solidgear.core.scene import Segment
    from solidgear.strength.stress.conditions import LoadLevel

#: in diameters of the shaft: a load that enters nearer to a fillet disturbs its stress, or is at it
NEAR, TOUCHING = 1.0, 0.01
#: share of an amplitude by shear that is reported
SHEARED = 0.05
#: relative error bar below which no order leads
FINEST = 3e-3
#: rad; a surface that turns by less is straight, but for rounding
SMOOTH = 1e-9


@dataclass(frozen=True)
class Local:
    """Stress on the surface of a fillet where it is largest, Pa."""

    #: amplitude, amplitude_bar: normal stress along the meridian by bending of the turning shaft
    amplitude: float
    amplitude_bar: float
    #: mean, mean_bar: the same by axial force
    mean: float
    mean_bar: float
    #: shear, shear_bar: by torque, at the same place
    shear: float
    shear_bar: float
    angle: float  #: of that place on the arc, from the cylinder, rad

    @property
    def rank(self) -> tuple[float, float]:
        """Normal stress, then shear stress, Pa: the largest is the worst."""
        return self.amplitude + abs(self.mean), abs(self.shear)


@dataclass(frozen=True)
class Notch:
    """A fillet at the root of a step, with the stress of this shaft under loads."""

    name: str
    #: where it meets its cylinder, m: forces and nominal stress are those of the section there
    y: float
    #: radius, small, large: of the fillet, and diameters on both sides of the step, m
    radius: float
    small: float
    large: float
    found: FilletFactors
    forces: np.ndarray  #: (6,) Q_x, N, Q_z, M_x, T, M_z, N and N m
    nominal: NominalStress
    local: Local
    #: form factors of solid shafts by their source and load, None where it gives none; empty of a
    #: fillet in a bore
    published: Mapping[str, Mapping[LoadKind, float | None]]
    fatigue: Mapping[LoadKind, FatigueFactor]  #: by load; empty for a material without strength
    rating: Rating | None  #: none without strength, or where the norm has no formula: in bores
    remark: str  #: on disturbances of its stress; empty for none

    @property
    def severity(self) -> tuple[float, float, float]:
        """Rank of a fillet, the worst least."""
        return severity(self.rating, self.local.rank[0])


class SharpCorner(NamedTuple):
    """Place, m, where a stress does not exist: it grows without end as a mesh is refined.

    A chamfer at the root of a step leaves two of them, which are obtuse.
    """

    y: float
    surface: str
    between: tuple[str, str]
    chamfered: bool


@dataclass(frozen=True)
class ShaftStress:
    """Stress of a shaft."""

    forces: SectionForces
    nominal: tuple[NominalRow, ...]
    notches: tuple[Notch, ...]  #: fillets along the shaft
    drawn: tuple[DrawnStress, ...]  #: features that DIN 743 rates, in the order of the file
    unrated: tuple[Unrated, ...]  #: and those that it does not
    sharp: tuple[SharpCorner, ...]
    remarks: tuple[str, ...]

    @property
    def worst(self) -> tuple[Notch | DrawnStress, ...]:
        """Fillets and features, that with the least safety against fatigue first; without strength, the
        fillet with the largest stress.
        """
        notches: list[Notch | DrawnStress] = [*self.notches, *self.drawn]
        return tuple(sorted(notches, key=lambda notch: notch.severity))

    @property
    def ratings(self) -> tuple[Rating, ...]:
        """Ratings of all notches that have one, in the same order."""
        return tuple(notch.rating for notch in self.worst if notch.rating is not None)


def shaft_stress(
    scene: Scene,
    loads: Mapping[str, ArrayLike],
    *,
    gravity: ArrayLike | None = None,
    tolerance: float = ENOUGH,
    conditions: Conditions | None = None,
    duty: Sequence[DutyForces] = (),
    progress: Callable[[str], None] = lambda text: None,
) -> ShaftStress:
    """Return the stress of a shaft under loads that balance.

    Parameters
    ----------
    scene : Scene
    loads : mapping of str to (6,) array_like
        All that acts on the shaft, by the names of its port, bearings and masses: bearing reactions,
        mesh forces, drive torques; N and N m about the place of each, in the order x, y, z, thx,
        thy, thz.
    gravity : (3,) array_like, optional
        m/s^2; where the loads balance the weight of the shaft too.
    tolerance : float
        Relative error bar of form factors at which to stop.
    conditions : Conditions, optional
        Of the rating by DIN 743.
    duty : sequence of DutyForces
        Points of a duty table over which ratings are; without one they are of the loads.
    progress : callable, optional
        Called with each fillet.

    Returns
    -------
    ShaftStress

    Raises
    ------
    SolidgearError
        For loads that do not balance, or at places that the shaft does not have, or a tolerance beyond all
        meshes.

    Examples
    --------
    The overhung pinion under 10 kN across its head, held by its two bearings:

    >>> import solidgear as sg
    >>> scene = sg.load("geometry/pinion_filleted.toml")
    >>> arms = [bearing.y - scene.port.y for bearing in scene.bearings]
    >>> first = -10e3 * arms[1] / (arms[1] - arms[0])
    >>> across = {"pinion": 10e3, "1": first, "2": -10e3 - first}
    >>> found = shaft_stress(scene, {name: [0, 0, z, 0, 0, 0] for name, z in across.items()})
    >>> (notch,) = found.notches
    >>> notch.name, f'{notch.forces[3]:.1f} N m', f'{notch.found.factors["bending"].value:.1f}'
    ('head fillet', '431.2 N m', '2.2')
    """
    check_tolerance(tolerance)
    forces = forces_of(scene, loads, gravity)
    conditions = conditions or Conditions()
    seats = [(s.lo, s.hi) for s in scene.stations if np.any(loads.get(s.name, 0.0))]
    drawn, unrated = drawn_stresses(scene, forces, conditions, duty)
    remarks = []
    notches = []
    for corner in sorted(scene.outline.corners, key=lambda c: c.y):
        if corner.root and corner.kind == "fillet":
            progress(corner.name)
            try:
                notches.append(_notch(scene, corner, forces, seats, tolerance, conditions, duty))
            except SolidgearError as error:  # the others have their stress all the same
                remarks.append(f"no stress there: {error}")
    return ShaftStress(
        forces,
        nominal_rows(scene.segments, forces, () if scene.body is None else scene.body.uneven),
        tuple(notches),
        drawn,
        unrated,
        tuple(sharp_corners(scene)),
        tuple(remarks),
    )


def check_tolerance(tolerance: float) -> None:
    """Refuse a relative error bar that no mesh reaches."""
    if not FINEST <= tolerance < 1:
        raise SolidgearError(
            f"tolerance = {show(tolerance)}: give a relative error bar of form factors from {FINEST:g} "
            "to 1"
        )


def sharp_corners(scene: Scene) -> Iterator[SharpCorner]:
    """Yield re-entrant corners of the outline that have neither fillet nor undercut."""
    undercut = [
        (segment.y0 if feature.side == "start" else segment.y1)
        for feature in scene.features
        for segment in scene.segments
        if feature.kind == "relief" and segment.name == feature.segment
    ]
    for edge in scene.outline.edges:
        if edge.surface == "outer" and any(abs(edge.y - y) < TOUCH for y in undercut):
            continue
        if edge.angle > np.pi + SMOOTH:
            low, high = scene.segments[edge.joint - 1 : edge.joint + 1]
            yield SharpCorner(edge.y, edge.surface, (low.name, high.name), bool(edge.root))


def _notch(
    scene: Scene,
    corner: Corner,
    forces: SectionForces,
    seats: Sequence[tuple[float, float]],
    tolerance: float,
    conditions: Conditions,
    duty: Sequence[DutyForces],
) -> Notch:
    fillet = fillet_factors(scene, corner.name, tolerance)
    section_load = worst_load(fillet, forces)
    nominal = nominal_stress(fillet.section, section_load, fillet.radius)
    local, (small, large) = local_stress(fillet, section_load), _diameters(scene, corner)
    segment = scene.segments[corner.owner]
    strength = strength_of(segment)
    published, rating, fatigue = {}, None, {}
    if corner.surface == "outer":
        published = {
            source: {load: factor(load, large, small, corner.radial) for load in LOADS}
            for source, factor in PUBLISHED.items()
        }
        if strength is not None:
            under = levels(conditions, duty, nominal, partial(_nominal_at, fillet))
            rating = _rating(scene, segment, FilletNotch(fillet, large), under, conditions)
            steel = steel_at_size(strength, rating, conditions)
            fatigue = FilletNotch(fillet, large).by_load(steel)
    return Notch(
        name=corner.name,
        y=fillet.reference,
        radius=corner.radial,
        small=small,
        large=large,
        found=fillet,
        forces=section_load,
        nominal=nominal,
        local=local,
        published=published,
        fatigue=fatigue,
        rating=rating,
        remark=_remark(corner, seats, fillet, tolerance, _excess_by_shear(fillet, nominal, local)),
    )


def _rating(
    scene: Scene,
    segment: Segment,
    notch: FilletNotch,
    under: Sequence[LoadLevel],
    conditions: Conditions,
) -> Rating:
    """Rate a fillet on a segment whose strength is known under levels of nominal stress."""
    strength = strength_of(segment)
    assert strength is not None, "without strength there is no rating"
    return rated(
        notch,
        under,
        strength,
        conditions,
        largest=2 * scene.outline.largest_radius,
        source=source_of(segment),
        raised=replace(notch, bars=1.0),
    )


def rating_under(
    scene: Scene, notch: Notch, forces: SectionForces, conditions: Conditions
) -> Rating:
    """Rate a fillet that is rated under other section forces."""
    under = conditions.levels(_nominal_at(notch.found, forces))
    segment = scene.segments[notch.found.corner.owner]
    return _rating(scene, segment, FilletNotch(notch.found, notch.large), under, conditions)


def _nominal_at(fillet: FilletFactors, forces: SectionForces) -> NominalStress:
    """Return the nominal stress of a fillet under section forces of a shaft."""
    return nominal_stress(fillet.section, forces.at(fillet.reference), fillet.radius)


def _diameters(scene: Scene, corner: Corner) -> tuple[float, float]:
    """Return diameters of the surface on both sides of a step, that of the fillet's cylinder first,
    m.
    """
    neighbour = scene.segments[corner.owner - corner.side]
    start, end = radii_of(neighbour, corner.surface)
    return 2 * corner.r, 2 * (end if corner.side > 0 else start)


def worst_load(fillet: FilletFactors, forces: SectionForces) -> np.ndarray:
    """Return the section forces (6,) at a fillet: where a seat crosses its step, as it may over a
    step of the bore, those on the side of the load that stress it most. A seat that ends at the step
    is on one side of it.
    """
    step, seats = fillet.corner.y, {load.name: load.seat for load in forces.loads if load.seat}
    crossing = [name for name, (lo, hi) in seats.items() if lo + TOUCH < step < hi - TOUCH]
    sections = [cut.of(forces) for cut in both_sides(fillet.reference, True, crossing)]
    return max(sections, key=lambda six: local_stress(fillet, six).rank)


def local_under(notch: Notch, forces: SectionForces) -> Local:
    """Return the stress on a fillet under other section forces."""
    return local_stress(notch.found, worst_load(notch.found, forces))


def local_stress(fillet: NotchFactors, forces: np.ndarray) -> Local:
    """Return the stress on the arc of a notch under section forces (6,), where the normal stress
    is largest.
    """
    section, a = fillet.section, fillet.radius
    bend, push = a / section.second_moment, 1 / section.area
    profiles, factors = fillet.profiles, fillet.factors
    q_x, n, q_z, m_x, t, m_z = forces
    # in both planes alike: a quarter turn about y makes (Q_x, -M_z) of (Q_z, M_x)
    planes = [
        profiles["bending"].along * bend * moment + profiles["shear"].along * push * across
        for moment, across in ((-m_x, q_z), (m_z, q_x))
    ]
    amplitude = np.hypot(*planes)
    mean = profiles["tension"].along * push * n
    shear = profiles["torsion"].shear * t * a / (2 * section.second_moment)
    largest = amplitude + np.abs(mean)
    place = int((largest if largest.any() else np.abs(shear)).argmax())
    bars = {load: factor.bar for load, factor in factors.items()}
    return Local(
        float(amplitude[place]),
        bars["bending"] * bend * np.hypot(m_x, m_z) + bars["shear"] * push * np.hypot(q_x, q_z),
        float(mean[place]),
        bars["tension"] * push * abs(n),
        float(shear[place]),
        bars["torsion"] * abs(t) * a / (2 * section.second_moment),
        float(profiles["bending"].angle[place]),
    )


def _excess_by_shear(fillet: FilletFactors, nominal: NominalStress, local: Local) -> float:
    """Return the relative excess of the amplitude on a fillet over form factor times nominal
    stress, which is due to shear.
    """
    bent = fillet.factors["bending"].value * nominal.bending
    return local.amplitude / bent - 1 if bent > 0 else np.inf * local.amplitude


def _remark(
    corner: Corner,
    seats: Sequence[tuple[float, float]],
    fillet: FilletFactors,
    tolerance: float,
    by_shear: float,
) -> str:
    """Return the remark that a user must know with the numbers of a fillet."""
    remarks = []
    first, last = corner.span
    gaps = [max(first - hi, lo - last, 0.0) for lo, hi in seats]
    nearest = min(gaps, default=np.inf) / (2 * fillet.section.outer)
    if nearest < NEAR:
        distance = f"{nearest:.2g} diameters away" if nearest > TOUCHING else "right beside it"
        remarks.append(f"a load enters {distance}: its local effect is not in the factors")
    if fillet.widest > tolerance:
        remarks.append(
            f"error bar {100 * fillet.widest:.2g} %, above the {100 * tolerance:.2g} % asked for"
        )
    if by_shear > SHEARED:
        share = f"{100 * by_shear:.0f} % above" if np.isfinite(by_shear) else "not"
        remarks.append(
            f"its amplitude is {share} Kt times nominal bending, by the shear force, which a rating "
            "by DIN 743 leaves out"
        )
    if corner.surface == "bore":
        remarks.append("DIN 743 has no formula for a step in a bore")
    return "; ".join(remarks)
