r"""Stress concentration of a fillet, by the harmonic solid of the shaft around it.

Four unit loads are solved on a piece of the shaft around the fillet: tension, torsion, bending, and
a transverse force whose moment is zero where the fillet meets the cylinder. By superposition they
make the stress under any section forces there. Orders are raised on one mesh until the error bar is
met; the error bar of an order p is the largest of

- ``| K_p - K_(p-1) |``,
- the traction left on the free surface where the stress is largest, over nominal stress,
- 2e-3 of K: where the arc meets straight lines the curvature jumps, and the effect on the
  stress falls slowly with the order.

The first two fall by about three an order. `python -m validation.campaign fillets` checks the error
bars against meshes four times as fine.

The disturbance of a plain shaft's stress by a shoulder dies out along it as exp(-2.7 y / a) and
faster, a the radius (Little and Childs, Q. Appl. Math. 25 (1967), 261, for a solid cylinder), so
that a piece that goes on for four radii on both sides is off by some 2e-5. Loads enter at both ends
as Saint-Venant's stress of a plain shaft, which makes no disturbance. Where the shaft ends earlier,
the end face is the end of the piece.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Protocol

import numpy as np

from solidgear.core import TOUCH, Outline, Port, SolidgearError, coned, flexibility
from solidgear.core.models.harmonic.body import harmonic
from solidgear.core.solve.backends.matrix import FactorError
from solidgear.strength.stress.arc_stress import Arc, ArcStress, RootArc
from solidgear.strength.stress.nominal import CrossSection

if TYPE_CHECKING:
    from solidgear.core import Body, Scene
    from solidgear.core.scene import Corner, Segment

#: how far a piece goes on beyond its fillet, in outer radii of the shaft on that side
REACH = 4.0
#: least rest of a segment, in extents of a fillet along it
ROOM = 3.0
#: solved pieces that are kept, some 10 kB each
KEPT = 64
#: decimals of lengths, m, that tell one piece from another: beyond is rounding of its place
DIGITS = 12
_ENDS = ("y0", "y1", "outer0", "outer1", "inner0", "inner1")


class Notched(Protocol):
    """Piece of a shaft around a notch of revolution, loaded at both ends."""

    @property
    def root(self) -> RootArc:
        """Arc looked at, in the places of the piece."""

    @property
    def reference(self) -> tuple[CrossSection, float, float]:
        """Section of nominal stress, the radius at which it is taken, and its place, m."""

    def body(self, order: int, refinement: float) -> Body:
        """Build the harmonic solid of the piece."""


@dataclass(frozen=True)
class Piece:
    """Piece of a shaft around a fillet; builders take it as a shaft."""

    segments: tuple[Segment, ...]  #: from y = 0 on
    outline: Outline[Segment]
    corner: Corner  #: the one looked at, in the places of the piece
    start: float  #: of the piece on the shaft, m

    @property
    def length(self) -> float:
        """Overall length, m."""
        return self.segments[-1].y1

    @property
    def stations(self) -> tuple[Port, Port]:
        """Both ends as mean motions of their cross-sections."""
        return ends(self.length)

    @property
    def root(self) -> RootArc:
        """Arc of the fillet."""
        return RootArc.of(self.corner)

    @property
    def reference(self) -> tuple[CrossSection, float, float]:
        """Outside, the cylinder that the fillet runs into; in a bore the weaker side of the step,
        outside.
        """
        corner, place = self.corner, self.corner.on_cylinder[1]
        owner, neighbour = (self.segments[k] for k in (corner.owner, corner.owner - corner.side))
        inner, outer = owner.radius_at(place)
        section = CrossSection(outer, inner)
        if corner.surface == "outer":
            return section, corner.r, place
        inner, outer = neighbour.radius_at(neighbour.y1 if corner.side > 0 else neighbour.y0)
        weaker = min(section, CrossSection(outer, inner), key=lambda side: side.second_moment)
        return weaker, weaker.outer, place

    def body(self, order: int, refinement: float) -> Body:
        """Build the harmonic solid with layers towards the fillet."""
        return harmonic(self, order=order, layers=LAYERS, edge_layers=0, refinement=refinement)


def piece_around(scene: Scene, name: str, reach: float = REACH) -> Piece:
    """Return the piece of a shaft, without features, around a fillet of a name; it goes on for
    `reach` outer radii of the shaft on either side.

    Examples
    --------
    >>> import solidgear as sg
    >>> piece = piece_around(sg.load("geometry/pinion_filleted.toml"), "head fillet")
    >>> [(s.name, round(s.length, 4)) for s in piece.segments]
    [('head', 0.0582), ('head.backcone', 0.01), ('shaft', 0.184)]
    """
    plain_shaft = coned(scene.plain)
    corner = next(c for c in plain_shaft.outline.corners if c.name == name)
    low, high = plain_shaft.segments[corner.joint - 1 : corner.joint + 1]
    first, last = corner.span
    start = _cut(plain_shaft, first - reach * low.outer1, -1)
    end = _cut(plain_shaft, last + reach * high.outer0, 1)
    segments_in = [s for s in plain_shaft.segments if s.y1 > start + TOUCH and s.y0 < end - TOUCH]
    offset = plain_shaft.segments.index(segments_in[0])
    segments = tuple(_part(s, start, end) for s in segments_in)
    corners = {
        c.name: replace(c, y=c.y - start, owner=c.owner - offset)
        for c in plain_shaft.outline.corners
        if start + TOUCH < c.y < end - TOUCH and _belongs(c, corner)
    }
    return Piece(segments, Outline(segments, corners.values()), corners[name], start)


def _belongs(candidate: Corner, corner: Corner) -> bool:
    """Return whether a corner belongs to the piece: not rims on other faces, round which no stress
    flows, nor chamfers that could not become cones.
    """
    if candidate.root:
        return candidate.kind == "fillet"
    return candidate.joint == corner.joint


def _cut(shaft: Scene, y: float, way: int) -> float:
    """Return the place of a cut near a place, clear of all fillets; the end of the shaft if that
    comes first.
    """
    if not 0.0 < y < shaft.length:
        return 0.0 if way < 0 else shaft.length
    index = next(
        k for k, s in enumerate(shaft.segments) if y < s.y1 or k + 1 == len(shaft.segments)
    )
    segment = shaft.segments[index]
    rooms = (
        ROOM * max((c.axial for c in shaft.outline.corners if c.joint == joint), default=TOUCH)
        for joint in (index, index + 1)
    )
    first, last = segment.y0 + next(rooms), segment.y1 - next(rooms)
    # not so near to the joint passed that its fillets have no room
    if way < 0:
        y = min(y, last)
        return y if y > first else segment.y0
    y = max(y, first)
    return y if y < last else segment.y1


def _part(segment: Segment, start: float, end: float) -> Segment:
    """Return the part of a segment between two places, counted from the first."""
    y0, y1 = max(segment.y0, start), min(segment.y1, end)
    (inner0, outer0), (inner1, outer1) = segment.radius_at(y0), segment.radius_at(y1)
    return segment.with_changes(
        y0=y0 - start,
        y1=y1 - start,
        outer0=outer0,
        outer1=outer1,
        inner0=inner0,
        inner1=inner1,
    )


def ends(length: float) -> tuple[Port, Port]:
    """Return both ends of a piece of a length, m, as mean motions of their cross-sections."""
    return _end("left", 0.0), _end("right", length)


def _end(name: str, y: float) -> Port:
    return Port(name=name, y=y, lo=y, hi=y, attachment="section")


#: orders that are tried, from the first whose error can be estimated
ORDERS = (4, 5, 6, 7, 8)
#: layers towards a fillet, at most: three of a ratio of 0.2 lead from a quarter of a radius to 1/500
LAYERS = 3
#: default relative error bar of a factor
ENOUGH = 0.01
#: of a factor: error bars are no less
FLOOR = 2e-3
#: error bar of a gradient: multiple of its change with the last order, and its least share
STEEPER, GRADIENT_FLOOR = 3.0, 0.03
UNIT_LOADS = ("tension", "bending", "torsion", "shear")


@dataclass(frozen=True)
class Factor:
    """A stress concentration factor."""

    #: value, bar: largest stress over nominal stress, and its error bar
    value: float
    bar: float
    angle: float  #: of that place on the arc, from the cylinder, rad
    #: gradient, gradient_bar: relative stress gradient there into the material, 1/m
    gradient: float
    gradient_bar: float


@dataclass(frozen=True)
class Step:
    """One order of the sequence that a notch was solved with."""

    order: int
    unknowns: int
    factors: Mapping[str, float]  #: by unit load


class NotchFactors(Protocol):
    """Stress concentration of a notch of revolution, over the nominal stress of a section."""

    @property
    def name(self) -> str:
        """Name of the notch."""

    @property
    def section(self) -> CrossSection:
        """Section of nominal stress."""

    @property
    def radius(self) -> float:
        """Radius at which nominal stress is taken, m."""

    @property
    def factors(self) -> Mapping[str, Factor]:
        """Factors by unit load."""

    @property
    def profiles(self) -> Mapping[str, ArcStress]:
        """Stress along the arc over nominal stress, by unit load."""

    @property
    def reference(self) -> float:
        """Place of the section forces, m."""

    @property
    def widest(self) -> float:
        """Largest error bar of the factors of tension, bending and torsion, relative."""


@dataclass(frozen=True)
class FilletFactors:
    """Stress concentration of a fillet."""

    name: str
    corner: Corner = field(repr=False)  #: on the shaft
    #: section of nominal stress: outside, the cylinder that the fillet runs into; in a bore the
    #: weaker side of the step
    section: CrossSection
    radius: float  #: at which nominal stress is taken, m
    #: by unit load: ``tension``, ``bending``, ``torsion``; ``shear`` counts in Q / A
    factors: Mapping[str, Factor]
    profiles: Mapping[str, ArcStress] = field(repr=False)  #: along the arc, over nominal stress
    steps: tuple[Step, ...]

    @property
    def reference(self) -> float:
        """Place where the fillet meets the cylinder, m: that of the section forces."""
        return self.corner.on_cylinder[1]

    @property
    def widest(self) -> float:
        """Largest error bar of the factors of tension, bending and torsion, relative."""
        return widest(self.factors)


def widest(factors: Mapping[str, Factor]) -> float:
    """Return the largest relative error bar of the factors of tension, bending and torsion."""
    return max(factors[load].bar / factors[load].value for load in UNIT_LOADS[:3])


def fillet_factors(
    scene: Scene,
    name: str,
    tolerance: float = ENOUGH,
    *,
    orders: Sequence[int] = ORDERS,
    refinement: float = 1.0,
    reach: float = REACH,
) -> FilletFactors:
    """Return stress concentration factors of a fillet of a name at the root of a step.

    Orders are tried until the relative error bars of tension, bending and torsion are within a
    tolerance, and error bars stay larger where none is; `refinement` multiplies the number of
    cells, and `reach` is as of :func:`piece_around`. Cells that fold around the fillet are refused.
    """
    piece = piece_around(scene, name, reach)
    corner = next(c for c in scene.outline.corners if c.name == name)
    solution = _kept(_Same(piece), tolerance, tuple(orders), refinement)
    section, radius, _ = piece.reference
    return FilletFactors(
        name, corner, section, radius, solution.factors, solution.profiles, solution.steps
    )


class _Same:
    """A piece that equals another one with the same shape and elasticity, wherever it is on its shaft and
    whatever it is called: rows of a sweep and cases share what was solved.
    """

    def __init__(self, piece: Piece):
        self.piece = piece
        self._shape = (
            tuple(
                (*(round(getattr(s, end), DIGITS) for end in _ENDS), s.material.E, s.material.nu)
                for s in piece.segments
            ),
            tuple(
                (c.kind, c.surface, c.root, c.owner, c.side, c.out, c.name == piece.corner.name)
                + tuple(round(v, DIGITS) for v in (c.y, c.r, c.axial, c.radial))
                for c in sorted(piece.outline.corners, key=lambda c: (c.y, c.r))
            ),
        )

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Same) and self._shape == other._shape

    def __hash__(self) -> int:
        return hash(self._shape)


@lru_cache(maxsize=KEPT)
def _kept(same: _Same, tolerance: float, orders: tuple[int, ...], refinement: float) -> Solution:
    """Solve a piece, or return what was solved of an equal one."""
    return solved(same.piece, tolerance, orders, refinement)


@dataclass(frozen=True)
class Solution:
    """Factors and profiles of a notch by the last order, and all orders."""

    factors: Mapping[str, Factor]
    profiles: Mapping[str, ArcStress] = field(repr=False)
    steps: tuple[Step, ...]


def solved(
    piece: Notched, tolerance: float, orders: Sequence[int] = ORDERS, refinement: float = 1.0
) -> Solution:
    """Solve a piece around a notch, order by order until error bars are within a tolerance."""
    result: Solution | None = None
    for order in orders:
        unknowns, profiles = _solved(piece, order, refinement)
        before = result.factors if result else {}
        factors = {k: _factor(profile, k, before.get(k)) for k, profile in profiles.items()}
        values = {load: factor.value for load, factor in factors.items()}
        steps = (*(result.steps if result else ()), Step(order, unknowns, values))
        result = Solution(factors, profiles, steps)
        if widest(factors) <= tolerance:
            break
    assert result is not None, "no order was asked for"
    return result


def _solved(piece: Notched, order: int, refinement: float) -> tuple[int, dict[str, ArcStress]]:
    """Return unknowns of a mesh and the profiles on it; the mesh itself, which may be large, ends
    here.
    """
    try:
        with np.errstate(invalid="ignore"):  # of cells that fold; their matrix is refused
            body = piece.body(order, refinement)
        profiles = _profiles(piece, body)
    except FactorError:
        raise SolidgearError(
            f"{piece.root.name}: cells of order {order} around it fold; make it or its "
            "neighbours smaller"
        ) from None
    return sum(block.size for block in body.blocks if block.mirror is None), profiles


def _profiles(piece: Notched, body: Body) -> dict[str, ArcStress]:
    """Return the stress along the arc over nominal stress, by unit load."""
    fields = flexibility(body).fields
    index = {block.name: k for k, block in enumerate(body.blocks)}
    arc = Arc(piece, body, piece.root)
    start, end = (port.y for port in body.ports)
    section, a, place = piece.reference
    pull = np.array([-1.0, 1.0])
    # force and moment at both ends, of a bending block; the moment of the force is zero at the notch
    bend = np.array([0.0, -1.0, 0.0, 1.0])
    shear = np.array([-1.0, start - place, 1.0, place - end])
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
        stress = arc.stress(body.blocks[index[name]], fields[index[name]] @ ends)
        out[load] = _relative_to(stress, nominal[load])
    return out


def _relative_to(stress: ArcStress, nominal: float) -> ArcStress:
    """Return the stress relative to a nominal one."""
    return ArcStress(
        stress.angle,
        stress.along / nominal,
        stress.around / nominal,
        stress.shear / nominal,
        stress.traction / abs(nominal),
        stress.slope / nominal,
    )


def _factor(profile: ArcStress, load: str, before: Factor | None) -> Factor:
    """Return the factor of a profile, with an error bar by the factor of an order before."""
    twist = load == "torsion"
    stress = profile.shear if twist else profile.along
    slope = profile.slope[int(twist)]
    place = int(np.abs(stress).argmax())
    value = abs(float(stress[place]))
    gradient = float(slope[place] / stress[place])
    if before is None:
        return Factor(value, np.inf, float(profile.angle[place]), gradient, np.inf)
    bar = max(abs(value - before.value), float(profile.traction[place]), FLOOR * value)
    steeper = max(STEEPER * abs(gradient - before.gradient), GRADIENT_FLOOR * abs(gradient))
    return Factor(value, bar, float(profile.angle[place]), gradient, steeper)
