r"""Stress concentration of a fillet, by the harmonic solid of the shaft around it.

Four unit loads are solved on the piece: tension, torsion, bending, and a transverse force whose
moment is zero where the fillet meets the cylinder. By superposition they make the stress under any
section forces there. Orders are raised on one mesh until the bar is met; the bar of an order p is
the largest of

- ``| K_p - K_(p-1) |``,
- the traction left on the free surface where the stress is largest, over nominal stress,
- 2e-3 of K: where the arc meets straight lines its curvature jumps, and what that leaves in the
  stress falls slowly with the order.

The first two fall by about three an order. `python -m validation.campaign fillets` holds the bars
against meshes four times as fine.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.models.harmonic.arc_stress import Arc, ArcStress
from solidgear.models.harmonic.body import harmonic
from solidgear.solve.backends.matrix import FactorError
from solidgear.solve.statics import flexibility
from solidgear.studies.stress.nominal import CrossSection
from solidgear.studies.stress.piece import REACH, Piece, piece_around

if TYPE_CHECKING:
    from solidgear.body import Body
    from solidgear.scene import Corner, Scene

#: orders that are tried, from the first that says something of its error
ORDERS = (4, 5, 6, 7, 8)
#: layers towards a fillet, at most: three of a ratio of 0.2 lead from a quarter of a radius to 1/500
LAYERS = 3
#: relative bar of a factor, unless asked otherwise
ENOUGH = 0.01
#: of a factor: bars are no less
FLOOR = 2e-3
#: of its change with the last order, the bar of a gradient, and the share that it is no less than
STEEPER, GRADIENT_FLOOR = 3.0, 0.03
UNIT_LOADS = ("tension", "bending", "torsion", "shear")


@dataclass(frozen=True)
class Factor:
    """A stress concentration factor."""

    #: value, bar: largest stress over nominal stress, and what it may be off
    value: float
    bar: float
    angle: float  #: where on the arc that is, from the cylinder, rad
    #: gradient, gradient_bar: relative stress gradient there into the material, 1/m
    gradient: float
    gradient_bar: float


@dataclass(frozen=True)
class Step:
    """One order of the sequence that a fillet was solved with."""

    order: int
    unknowns: int
    factors: Mapping[str, float]  #: by unit load


@dataclass(frozen=True)
class FilletFactors:
    """Stress concentration of a fillet."""

    name: str
    corner: Corner = field(repr=False)  #: on the shaft
    #: that nominal stress is that of: outside, the cylinder that the fillet runs into; in a bore
    #: the weaker side of the step
    section: CrossSection
    radius: float  #: at which nominal stress is taken, m
    #: by unit load: ``tension``, ``bending``, ``torsion``; ``shear`` counts in Q / A
    factors: Mapping[str, Factor]
    profiles: Mapping[str, ArcStress] = field(repr=False)  #: along the arc, over nominal stress
    steps: tuple[Step, ...]

    @property
    def reference(self) -> float:
        """Place where the fillet meets the cylinder, m: that of its section forces."""
        return self.corner.on_cylinder[1]

    @property
    def widest(self) -> float:
        """Largest bar of the factors of tension, bending and torsion, relative."""
        return max(self.factors[load].bar / self.factors[load].value for load in UNIT_LOADS[:3])


def fillet_factors(
    scene: Scene,
    name: str,
    tolerance: float = ENOUGH,
    *,
    orders: Sequence[int] = ORDERS,
    refinement: float = 1.0,
    reach: float = REACH,
) -> FilletFactors:
    """Stress concentration factors of a fillet of a name at the root of a step.

    Orders are tried until the relative bars of tension, bending and torsion are within a tolerance,
    and bars stay larger where none is; `refinement` multiplies the number of cells, and `reach` is
    as of :func:`piece_around`. Cells that fold around the fillet are refused.
    """
    piece = piece_around(scene, name, reach)
    section, radius = _reference(piece)
    corner = next(c for c in scene.outline.corners if c.name == name)
    found: FilletFactors | None = None
    for order in orders:
        unknowns, profiles = _solved(piece, section, radius, order, refinement)
        before = found.factors if found else {}
        factors = {k: _factor(one, k, before.get(k)) for k, one in profiles.items()}
        values = {load: factor.value for load, factor in factors.items()}
        steps = (*(found.steps if found else ()), Step(order, unknowns, values))
        found = FilletFactors(name, corner, section, radius, factors, profiles, steps)
        if found.widest <= tolerance:
            break
    assert found is not None, "no order was asked for"
    return found


def _solved(
    piece: Piece, section: CrossSection, radius: float, order: int, refinement: float
) -> tuple[int, dict[str, ArcStress]]:
    """Unknowns of a mesh and what it finds; the mesh itself, which may be large, ends here."""
    try:
        with np.errstate(invalid="ignore"):  # of cells that fold; their matrix is refused
            body = harmonic(piece, order=order, layers=LAYERS, edge_layers=0, refinement=refinement)
        profiles = _profiles(piece, body, section, radius)
    except FactorError:
        raise SolidgearError(
            f'fillet "{piece.corner.name}": cells of the mesh around it fold, of order {order}; make '
            "it, or what lies beside it, smaller"
        ) from None
    return sum(block.size for block in body.blocks if block.mirror is None), profiles


def _reference(piece: Piece) -> tuple[CrossSection, float]:
    """Section that nominal stress is that of, and the radius looked at, m: outside, of the cylinder
    that the fillet runs into; in a bore the outer one of the weaker side of the step.
    """
    corner = piece.corner
    owner, beside = (piece.segments[k] for k in (corner.owner, corner.owner - corner.side))
    inner, outer = owner.radius_at(corner.on_cylinder[1])
    section = CrossSection(outer, inner)
    if corner.surface == "outer":
        return section, corner.r
    inner, outer = beside.radius_at(beside.y1 if corner.side > 0 else beside.y0)
    weaker = min(section, CrossSection(outer, inner), key=lambda one: one.second_moment)
    return weaker, weaker.outer


def _profiles(piece: Piece, body: Body, section: CrossSection, a: float) -> dict[str, ArcStress]:
    """Stress along the arc over nominal stress, by unit load."""
    fields = flexibility(body).fields
    index = {block.name: k for k, block in enumerate(body.blocks)}
    arc = Arc(piece, body, piece.corner)
    left, right = (port.y for port in body.ports)
    place = piece.corner.on_cylinder[1]
    pull = np.array([-1.0, 1.0])
    # force and moment at both ends, of a bending block; the moment of the force is zero at the fillet
    bend = np.array([0.0, -1.0, 0.0, 1.0])
    shear = np.array([-1.0, left - place, 1.0, place - right])
    loads = {
        "tension": ("axial", pull),
        "bending": ("bending_z", bend),
        "torsion": ("torsion", pull),
        "shear": ("bending_z", shear),
    }
    area, second = section.area, section.second_moment
    # positive moments about x press the side of positive z
    nominal = {"tension": 1 / area, "bending": -a / second, "torsion": a / (2 * second)}
    nominal["shear"] = 1 / area
    out = {}
    for load, (name, ends) in loads.items():
        found = arc.stress(body.blocks[index[name]], fields[index[name]] @ ends)
        out[load] = _over(found, nominal[load])
    return out


def _over(found: ArcStress, nominal: float) -> ArcStress:
    """Stress over a nominal one."""
    return ArcStress(
        found.angle,
        found.along / nominal,
        found.around / nominal,
        found.shear / nominal,
        found.traction / abs(nominal),
        found.slope / nominal,
    )


def _factor(profile: ArcStress, load: str, before: Factor | None) -> Factor:
    """The factor of a profile, its bar by that of an order before."""
    twist = load == "torsion"
    stress = profile.shear if twist else profile.along
    slope = profile.slope[int(twist)]
    at = int(np.abs(stress).argmax())
    value = abs(float(stress[at]))
    gradient = float(slope[at] / stress[at])
    if before is None:
        return Factor(value, np.inf, float(profile.angle[at]), gradient, np.inf)
    bar = max(abs(value - before.value), float(profile.traction[at]), FLOOR * value)
    steeper = max(STEEPER * abs(gradient - before.gradient), GRADIENT_FLOOR * abs(gradient))
    return Factor(value, bar, float(profile.angle[at]), gradient, steeper)
