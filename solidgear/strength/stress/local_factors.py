r"""Stress concentration of keyways and cross holes, by 3D solids refined until error bars are met.

Each mesh has smaller elements wherever the largest stress of a load may lie by the one before: along
a hole under tension, or its mouth, stress is so even that the largest place of a coarse mesh is any.
Elements that were small stay so. The error bar of a factor is the sum of its change from the mesh before and of the traction left on the free surface
in these places (root mean square), over nominal stress; and at least 2e-2 of it.

`python -m validation.campaign notches` holds error bars against finer meshes. Nominal stress is that
of DIN 743-2: for a keyway that of the plain shaft; for a hole of diameter b that of the section left,

    A = A_0 - 2 b (R - R_i),   I = I_0 - b (8 R^3 - 8 R_i^3) / 12,   J = J_0 - b (8 R^3 - 8 R_i^3) / 12

which for a solid shaft are the moduli of the norm.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core import SolidgearError
from solidgear.cuts.features.cross_hole import CrossHole
from solidgear.cuts.features.keyway import Keyway
from solidgear.cuts.local.mesh import LocalShape, Places
from solidgear.cuts.local.solid import LocalSolution, PeakStress, solution_on
from solidgear.strength.stress.nominal import CrossSection, NominalStress

if TYPE_CHECKING:
    from solidgear.core.scene import Segment
    from solidgear.cuts.features.cut import Cut

#: default relative error bar of a factor
ENOUGH = 0.05
#: edges of elements where stress is largest, in radii of the notch, mesh by mesh
SIZES = (None, *(0.3 * 0.6**k for k in range(7)))
#: of a factor: error bars are no less
FLOOR = 2e-2
#: error bar of a gradient: multiple of its change with the last mesh, and its least share
STEEPER, GRADIENT_FLOOR = 3.0, 0.1
#: how far a piece goes on beyond its cut, in outer radii of the shaft: its disturbance dies out as
#: exp(-2.7 y / a) (see :mod:`solidgear.strength.stress.notch`)
REACH = 2.5
LOADS = ("tension", "bending", "torsion")


@dataclass(frozen=True)
class LocalFactor:
    """A stress concentration factor of a cut."""

    #: value, bar: largest stress over nominal stress, and its error bar
    value: float
    bar: float
    place: np.ndarray  #: (3,) of that stress on the shaft, m
    #: gradient, gradient_bar: relative stress gradient there into the material, 1/m
    gradient: float
    gradient_bar: float


@dataclass(frozen=True)
class NominalModuli:
    """Section that the nominal stress of a cut is taken of."""

    area: float  #: m^2
    bending: float  #: section modulus, m^3
    torsion: float  #: section modulus, m^3
    what: str  #: in words

    @classmethod
    def of(cls, cut: Cut, outer: float, inner: float) -> NominalModuli:
        """Return the section that DIN 743-2 takes for a cut in a shaft of some radii, m."""
        plain = CrossSection(outer, inner)
        area, second, polar = plain.area, plain.second_moment, 2 * plain.second_moment
        if not isinstance(cut, CrossHole):
            return cls(area, second / outer, polar / outer, "the plain shaft")
        slab = cut.diameter * 8 * (outer**3 - inner**3) / 12
        net = area - 2 * cut.diameter * (outer - inner)
        return cls(net, (second - slab) / outer, (polar - slab) / outer, "the section left")

    def stress(self, forces: np.ndarray) -> NominalStress:
        """Return nominal stress under section forces (6,); a shear force has none here."""
        _, n, _, m_x, t, m_z = forces
        bending = float(np.hypot(m_x, m_z)) / self.bending
        return NominalStress(n / self.area, bending, t / self.torsion, 0.0)

    def of_plain(self, outer: float, inner: float) -> dict[str, float]:
        """Return nominal stress of the plain shaft over that of this section, by load."""
        plain = CrossSection(outer, inner)
        return {
            "tension": self.area / plain.area,
            "bending": self.bending * outer / plain.second_moment,
            "torsion": self.torsion * outer / (2 * plain.second_moment),
        }


@dataclass(frozen=True)
class LocalStep:
    """One mesh of the sequence that a cut was solved with."""

    unknowns: int
    factors: Mapping[str, float]  #: by load


@dataclass(frozen=True)
class LocalFactors:
    """Stress concentration of a cut that is not of revolution."""

    name: str
    radius: float  #: of the edges at the floor of a keyway, of a hole, m
    reference: float  #: middle of the cut, place of the section forces, m
    nominal: NominalModuli
    #: by load: largest principal stress under ``tension``, its amplitude under ``bending`` of the
    #: turning shaft, largest shear stress under ``torsion``
    factors: Mapping[str, LocalFactor]
    places: np.ndarray = field(repr=False)  #: (3, m) on the surface around the cut, m
    fields: Mapping[str, np.ndarray] = field(repr=False)  #: (m,) by load there, over nominal stress
    steps: tuple[LocalStep, ...]

    @property
    def widest(self) -> float:
        """Largest error bar of the factors, relative."""
        return max(factor.bar / factor.value for factor in self.factors.values())


def local_factors(
    segment: Segment,
    cut: Cut,
    tolerance: float = ENOUGH,
    sizes: tuple[float | None, ...] = SIZES,
) -> LocalFactors:
    """Return stress concentration factors of a keyway or a cross hole in a segment of a shaft, a
    cylinder that goes on on both sides.

    Meshes are tried until relative error bars are within a tolerance, and error bars stay larger
    where none is; `sizes` are as ``SIZES``. A sharp edge, whose stress has no limit, is refused.

    Examples
    --------
    A hole of 8 mm across a shaft of 40 mm:

    >>> from solidgear import Segment
    >>> from solidgear.cuts.features import CrossHole
    >>> shaft = Segment.cylinder("shaft", length=0.2, diameter=0.04)
    >>> hole = CrossHole(name="oil", segment="shaft", y=0.1, diameter=0.008)
    >>> factors = local_factors(shaft, hole, 0.2)
    >>> f'{factors.factors["bending"].value:.1f} of {factors.nominal.what}'
    '2.1 of the section left'
    """
    shape = local_shape(segment, cut)
    solutions = _solved(shape, segment.material.nu, tolerance, sizes)
    last = solutions[-1]
    moduli = NominalModuli.of(cut, shape.outer, shape.inner)
    share = moduli.of_plain(shape.outer, shape.inner)
    turn = _turned(cut.angle)
    low, high = cut.reach(shape.outer)
    middle = np.array([0.0, (low + high) / 2, 0.0])
    factors = {}
    for load in LOADS:
        peak, bar = last.peaks[load], _bar(solutions, load)
        gradients = [solution.peaks[load].gradient for solution in solutions[-2:]]
        change = STEEPER * abs(gradients[-1] - gradients[0])
        steeper = max(change, GRADIENT_FLOOR * abs(peak.gradient))
        place = turn @ peak.place + middle
        factors[load] = LocalFactor(
            share[load] * peak.value, share[load] * bar, place, peak.gradient, steeper
        )
    return LocalFactors(
        name=cut.name,
        radius=shape.size,
        reference=float(middle[1]),
        nominal=moduli,
        factors=factors,
        places=turn @ last.x + middle[:, None],
        fields={load: share[load] * values for load, values in last.fields.items()},
        steps=tuple(
            LocalStep(s.unknowns, {load: share[load] * s.peaks[load].value for load in LOADS})
            for s in solutions
        ),
    )


def local_shape(segment: Segment, cut: Cut) -> LocalShape:
    """Return the shape of a cut in a segment; refuse what has no stress, or no solid here."""
    if isinstance(cut, Keyway):
        _refuse_keyway(cut)
    elif not isinstance(cut, CrossHole):
        raise SolidgearError(f'{cut.what} "{cut.name}": no solid gives its stress here')
    outer, inner = float(segment.outer0), float(segment.inner0)
    # the same for a cut at several places, for which it is solved once
    standard = cut.with_changes(name="cut", segment="shaft", y=0.0, angle=0.0)
    return LocalShape(standard, outer, inner, REACH * outer)


def _refuse_keyway(cut: Keyway) -> None:
    """Refuse a keyway with edges whose stress has no limit."""
    without_limit = "stress grows there without limit as a mesh is refined"
    if cut.ends == "square" and not cut.mill:
        raise SolidgearError(
            f'keyway "{cut.name}": the edges of its square ends are sharp, and {without_limit}; give '
            "the mill that runs out beyond them"
        )
    if not cut.radius:
        raise SolidgearError(
            f'keyway "{cut.name}": the edges of its floor are sharp, and {without_limit}; give its '
            "radius"
        )
    if cut.radius >= min(cut.width / 2, cut.depth):
        raise SolidgearError(
            f'keyway "{cut.name}": a radius of {cut.radius:.6g} m leaves no flat floor or no wall: its '
            "solid needs both"
        )


@lru_cache(maxsize=32)
def _solved(
    shape: LocalShape, nu: float, tolerance: float, sizes: tuple[float | None, ...]
) -> tuple[LocalSolution, ...]:
    """Solve a cut mesh by mesh until the error bars of all loads are within a tolerance."""
    solutions: list[LocalSolution] = []
    places: list[Places] = []
    for size in sizes:
        if size is not None:
            places.append((solutions[-1].leading, size * shape.size))
        try:
            solutions.append(solution_on(shape, nu, places))
        except SolidgearError:  # of a mesh that cannot be made
            if len(solutions) < 2:
                raise
            break  # with the error bars that meshes before have
        bars = (_bar(solutions, load) / solutions[-1].peaks[load].value for load in LOADS)
        if max(bars) <= tolerance:
            break
    return tuple(solutions)


def _bar(solutions: list[LocalSolution] | tuple[LocalSolution, ...], load: str) -> float:
    """Return the error bar of the largest stress of the last mesh, infinite of the first one."""
    last: PeakStress = solutions[-1].peaks[load]
    if len(solutions) < 2:
        return float("inf")
    change = abs(last.value - solutions[-2].peaks[load].value)
    return max(change + last.traction, FLOOR * last.value)


def _turned(angle: float) -> np.ndarray:
    """Return the rotation about y that takes +z to where a cut of an angle looks."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
