"""Stress of a whole shaft under loads on its ports: section forces, nominal stress, its fillets.

Sharp corners have no stress: that of an elastic solid grows there without end as its mesh is refined
(Williams 1952), so they are told and get no number.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.scene.blends import Corner
from solidgear.scene.outline import radii_of
from solidgear.studies.stress.din743 import Load as LoadKind
from solidgear.studies.stress.nominal import (
    NominalRow,
    NominalStress,
    nominal_rows,
    nominal_stress,
)
from solidgear.studies.stress.notch import ENOUGH, FilletFactors, fillet_factors
from solidgear.studies.stress.rating import (
    Conditions,
    FatigueFactor,
    Rating,
    fatigue_factors,
    rated,
)
from solidgear.studies.stress.section_forces import (
    SectionForces,
    on_ports,
    section_forces,
    weight,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from solidgear.scene import Scene

#: in diameters of the shaft: a load that enters nearer to a fillet disturbs its stress
NEAR = 1.0
#: relative bar below which no order leads
FINEST = 3e-3
#: rad; a surface that turns by less is straight, but for rounding
SMOOTH = 1e-9


@dataclass(frozen=True)
class Local:
    """Stress on the surface of a fillet where it is largest, Pa.

    Attributes
    ----------
    amplitude, amplitude_bar : float
        Normal stress along the meridian by bending of the turning shaft.
    mean, mean_bar : float
        The same by axial force.
    shear, shear_bar : float
        By torque, at the same place.
    angle : float
        Of that place on the arc, from the cylinder, rad.
    """

    amplitude: float
    amplitude_bar: float
    mean: float
    mean_bar: float
    shear: float
    shear_bar: float
    angle: float


@dataclass(frozen=True)
class Notch:
    """A fillet at the root of a step, with the stress of this shaft under its loads.

    Attributes
    ----------
    name : str
    y : float
        Where it meets its cylinder, m: forces and nominal stress are those of the section there.
    radius, small, large : float
        Of the fillet, and diameters on both sides of the step, m.
    found : FilletFactors
    forces : (6,) ndarray
        Q_x, N, Q_z, M_x, T, M_z, N and N m.
    nominal : NominalStress
    local : Local
    fatigue : dict of str to FatigueFactor
        By load; empty for a material without strength.
    rating : Rating or None
        None without strength, or where the norm has no formula: in bores.
    remark : str
        Of what disturbs its stress; empty for nothing.
    """

    name: str
    y: float
    radius: float
    small: float
    large: float
    found: FilletFactors
    forces: np.ndarray
    nominal: NominalStress
    local: Local
    fatigue: Mapping[LoadKind, FatigueFactor]
    rating: Rating | None
    remark: str


@dataclass(frozen=True)
class ShaftStress:
    """Stress of a shaft.

    Attributes
    ----------
    forces : SectionForces
    nominal : tuple of NominalRow
    notches : tuple of Notch
        Along the shaft.
    sharp : tuple of (float, str)
        Places (m) where a stress does not exist, and why.
    remarks : tuple of str
    """

    forces: SectionForces
    nominal: tuple[NominalRow, ...]
    notches: tuple[Notch, ...]
    sharp: tuple[tuple[float, str], ...]
    remarks: tuple[str, ...]

    @property
    def worst(self) -> tuple[Notch, ...]:
        """Fillets, that with the least safety first; without strength, that with the largest stress."""

        def rank(notch: Notch) -> tuple[float, float]:
            safety = notch.rating.fatigue if notch.rating else np.inf
            return safety, -(notch.local.amplitude + abs(notch.local.mean))

        return tuple(sorted(self.notches, key=rank))


def shaft_stress(
    scene: Scene,
    loads: Mapping[str, ArrayLike],
    *,
    gravity: ArrayLike | None = None,
    tolerance: float = ENOUGH,
    conditions: Conditions | None = None,
) -> ShaftStress:
    """Stress of a shaft under loads that balance.

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
        Relative bar of form factors at which to stop.
    conditions : Conditions, optional
        Of the rating by DIN 743.

    Returns
    -------
    ShaftStress

    Raises
    ------
    SolidgearError
        For loads that do not balance, or on nothing that the shaft has, or a tolerance beyond all
        meshes.

    Examples
    --------
    The overhung pinion under 10 kN across its head, held by its two bearings:

    >>> import solidgear as sg
    >>> scene = sg.load("geometry/pinion_filleted.toml")
    >>> arms = [bearing.y - scene.port.y for bearing in scene.bearings]
    >>> first = -10e3 * arms[1] / (arms[1] - arms[0])
    >>> across = {"pinion": 10e3, "1": first, "2": -10e3 - first}
    >>> found = sg.shaft_stress(scene, {name: [0, 0, z, 0, 0, 0] for name, z in across.items()})
    >>> (notch,) = found.notches
    >>> notch.name, f'{notch.forces[3]:.1f} N m', f'{notch.found.factors["bending"].value:.1f}'
    ('head fillet', '431.2 N m', '2.2')
    """
    if not FINEST <= tolerance < 1:
        raise SolidgearError(
            f"tolerance = {tolerance}: relative bars of form factors go from {FINEST:g} to 1"
        )
    acting = on_ports(scene, loads)
    if gravity is not None:
        acting += weight(scene, gravity)
    forces = section_forces(acting, scene.length)
    conditions = conditions or Conditions()
    seats = [(s.lo, s.hi) for s in scene.stations if np.any(loads.get(s.name, 0.0))]
    remarks = [
        f'{feature.what} "{feature.name}": its own stress concentration is not in these numbers'
        for feature in scene.features
    ]
    notches = []
    for corner in sorted(scene.outline.corners, key=lambda c: c.y):
        if corner.root and corner.kind == "fillet":
            try:
                notches.append(_notch(scene, corner, forces, seats, tolerance, conditions))
            except SolidgearError as error:  # the others have their stress all the same
                remarks.append(f"no stress there: {error}")
    return ShaftStress(
        forces,
        nominal_rows(scene.segments, forces),
        tuple(notches),
        tuple(sharp_corners(scene)),
        tuple(remarks),
    )


def sharp_corners(scene: Scene) -> Iterator[tuple[float, str]]:
    """Re-entrant corners of the outline that have no fillet: places, m, and a sentence for each."""
    for edge in scene.outline.edges:
        if edge.angle > np.pi + SMOOTH:
            low, high = scene.segments[edge.joint - 1 : edge.joint + 1]
            what = "two obtuse corners of a chamfer" if edge.root else "sharp corner"
            where = "outside" if edge.surface == "outer" else "in the bore"
            yield (
                edge.y,
                f'{what} {where} between "{low.name}" and "{high.name}": a stress does not '
                "exist there, it grows without end as a mesh is refined; give a fillet",
            )


def _notch(
    scene: Scene,
    corner: Corner,
    forces: SectionForces,
    seats: Sequence[tuple[float, float]],
    tolerance: float,
    conditions: Conditions,
) -> Notch:
    found = fillet_factors(scene, corner.name, tolerance)
    here = forces.at(found.reference)
    nominal = nominal_stress(found.section, here, found.radius)
    small, large = _diameters(scene, corner)
    strength = scene.segments[corner.owner].material.strength
    rating, fatigue = None, {}
    if strength is not None and corner.surface == "outer":
        yields = strength.yield_point * (conditions.yield_at_size or 1.0)
        fatigue = fatigue_factors(found, yields, large)
        rating = rated(found, nominal, strength, conditions, large)
    return Notch(
        corner.name,
        found.reference,
        corner.radial,
        small,
        large,
        found,
        here,
        nominal,
        _local(found, here),
        fatigue,
        rating,
        _remark(corner, seats, found, tolerance),
    )


def _diameters(scene: Scene, corner: Corner) -> tuple[float, float]:
    """Diameters of the surface on both sides of a step, that of the fillet's cylinder first, m."""
    beside = scene.segments[corner.owner - corner.side]
    start, end = radii_of(beside, corner.surface)
    return 2 * corner.r, 2 * (end if corner.side > 0 else start)


def _local(found: FilletFactors, forces: np.ndarray) -> Local:
    """Stress on the arc under section forces, where its normal stress is largest."""
    section, a = found.section, found.radius
    bend, push = a / section.second_moment, 1 / section.area
    profiles, factors = found.profiles, found.factors
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
    at = int((largest if largest.any() else np.abs(shear)).argmax())
    bars = {load: factor.bar for load, factor in factors.items()}
    return Local(
        float(amplitude[at]),
        bars["bending"] * bend * np.hypot(m_x, m_z) + bars["shear"] * push * np.hypot(q_x, q_z),
        float(mean[at]),
        bars["tension"] * push * abs(n),
        float(shear[at]),
        bars["torsion"] * abs(t) * a / (2 * section.second_moment),
        float(profiles["bending"].angle[at]),
    )


def _remark(
    corner: Corner, seats: Sequence[tuple[float, float]], found: FilletFactors, tolerance: float
) -> str:
    """What a user must know about the numbers of a fillet."""
    told = []
    first, last = corner.span
    gaps = [max(first - hi, lo - last, 0.0) for lo, hi in seats]
    nearest = min(gaps, default=np.inf) / (2 * found.section.outer)
    if nearest < NEAR:
        told.append(
            f"a load enters {nearest:.2g} diameters away; its own disturbance is not in the factors"
        )
    loads = ("tension", "bending", "torsion")
    widest = max(found.factors[k].bar / found.factors[k].value for k in loads)
    if widest > tolerance:
        told.append(f"bar {100 * widest:.2g} %, above the {100 * tolerance:.2g} % asked for")
    if corner.surface == "bore":
        told.append("DIN 743 has no formula for a step in a bore")
    return "; ".join(told)
