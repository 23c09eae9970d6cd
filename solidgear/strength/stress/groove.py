"""Stress concentration of a groove of revolution in a cylinder, by the harmonic solid around it.

What :mod:`solidgear.strength.stress.notch` does for a fillet: unit loads on a piece of the shaft,
orders raised until error bars are met. The piece is the cylinder alone, which goes on on both
sides; nominal stress is that of the section at the floor of the groove, as in DIN 743-2.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core import Outline, SolidgearError
from solidgear.core.models.harmonic.body import on_mesh
from solidgear.core.models.harmonic.mesh import harmonic_mesh
from solidgear.strength.stress.arc_stress import ArcStress, RootArc
from solidgear.strength.stress.groove_mesh import GrooveShape, groove_meridian
from solidgear.strength.stress.nominal import CrossSection
from solidgear.strength.stress.notch import (
    ENOUGH,
    ORDERS,
    REACH,
    Factor,
    Step,
    ends,
    solved,
    widest,
)

if TYPE_CHECKING:
    from solidgear.core import Body, Port
    from solidgear.core.scene import Segment


@dataclass(frozen=True)
class GroovePiece:
    """Cylinder around a groove, loaded at both ends; builders take it as a shaft."""

    segments: tuple[Segment, ...]  #: from y = 0 on
    shape: GrooveShape
    name: str

    @property
    def outline(self) -> Outline[Segment]:
        """Outline without the groove, which is in the mesh alone."""
        return Outline(self.segments)

    @property
    def length(self) -> float:
        """Overall length, m."""
        return self.segments[0].y1

    @property
    def stations(self) -> tuple[Port, Port]:
        """Both ends as mean motions of their cross-sections."""
        return ends(self.length)

    @property
    def root(self) -> RootArc:
        """Arc at larger y; the other is its image."""
        shape, least = self.shape, self.segments[0].outer0 - self.shape.depth
        y = self.length / 2 + shape.floor / 2
        return RootArc(self.name, (least + shape.radius, y), (least, y), shape.radius, 1)

    @property
    def reference(self) -> tuple[CrossSection, float, float]:
        """Section at the floor, its radius and the middle of the groove."""
        least = self.segments[0].outer0 - self.shape.depth
        return CrossSection(least, self.segments[0].inner0), least, self.length / 2

    def body(self, order: int, refinement: float) -> Body:
        """Build the harmonic solid with layers towards the root."""
        segment = self.segments[0]
        flat = groove_meridian(
            self.shape, segment.outer0, segment.inner0, self.length / 2, refinement
        )
        return on_mesh(self, harmonic_mesh(flat, order))


@dataclass(frozen=True)
class GrooveFactors:
    """Stress concentration of a groove."""

    name: str
    shape: GrooveShape
    reference: float  #: middle of the groove, place of the section forces, m
    section: CrossSection  #: at the floor, of nominal stress
    radius: float  #: of the floor, at which nominal stress is taken, m
    #: by unit load: ``tension``, ``bending``, ``torsion``; ``shear`` counts in Q / A
    factors: Mapping[str, Factor]
    profiles: Mapping[str, ArcStress] = field(repr=False)  #: along both arcs, over nominal stress
    steps: tuple[Step, ...]

    @property
    def widest(self) -> float:
        """Largest error bar of the factors of tension, bending and torsion, relative."""
        return widest(self.factors)


def groove_factors(
    name: str,
    segment: Segment,
    shape: GrooveShape,
    place: float,
    tolerance: float = ENOUGH,
    *,
    orders: Sequence[int] = ORDERS,
    refinement: float = 1.0,
    reach: float = REACH,
) -> GrooveFactors:
    """Return stress concentration factors of a groove of a name in a segment of a shaft, a
    cylinder, with the middle of the groove at a place along the shaft, m.

    Orders are tried until the relative error bars of tension, bending and torsion are within a
    tolerance; `refinement` multiplies the number of cells, and the piece goes on for `reach` outer
    radii on either side. A sharp root, whose stress has no limit, and a groove through the wall are
    refused.

    Examples
    --------
    A round groove of 1 mm in a shaft of 40 mm, bent:

    >>> from solidgear import Segment
    >>> shaft = Segment.cylinder("shaft", length=0.2, diameter=0.04)
    >>> groove = groove_factors("groove", shaft, GrooveShape(1e-3, 1e-3), 0.1)
    >>> f'{groove.factors["bending"].value:.2f}'
    '2.63'
    """
    _refuse(name, segment, shape)
    half = shape.mouth + reach * segment.outer0
    cylinder = segment.with_changes(y0=0.0, y1=2 * half)
    piece = GroovePiece((cylinder,), shape, name)
    solution = solved(piece, tolerance, orders, refinement)
    section, radius, _ = piece.reference
    profiles = {load: _both_arcs(p, load) for load, p in solution.profiles.items()}
    return GrooveFactors(
        name, shape, place, section, radius, solution.factors, profiles, solution.steps
    )


def _refuse(name: str, segment: Segment, shape: GrooveShape) -> None:
    """Refuse a groove without a stress, or without a wall below it."""
    if not shape.radius > 0:
        raise SolidgearError(
            f"{name}: its root is sharp, and stress grows there without limit as a mesh is "
            "refined; give its radius"
        )
    if segment.outer0 != segment.outer1 or segment.inner0 != segment.inner1:
        raise SolidgearError(f'{name}: "{segment.name}" is a cone; its solid needs a cylinder')
    if shape.depth >= segment.outer0 - segment.inner0:
        raise SolidgearError(
            f'{name}: it is as deep as the wall of "{segment.name}", '
            f"{segment.outer0 - segment.inner0:.6g} m"
        )
    if shape.floor < 0:
        raise SolidgearError(
            f"{name}: two radii of {shape.radius:.6g} m have no room in its width; make the radius "
            "half of the width at most"
        )


def _both_arcs(profile: ArcStress, load: str) -> ArcStress:
    """Return the stress along an arc and its image, in which a transverse force bends the other
    way.
    """
    sign = -1.0 if load == "shear" else 1.0
    return replace(
        profile,
        angle=np.tile(profile.angle, 2),
        along=np.concatenate([profile.along, sign * profile.along]),
        around=np.concatenate([profile.around, sign * profile.around]),
        shear=np.tile(profile.shear, 2),
        traction=np.tile(profile.traction, 2),
        slope=np.concatenate([profile.slope, sign * profile.slope], axis=1),
    )
