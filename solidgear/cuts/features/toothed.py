"""Teeth on a cone, and splines on a cylinder.

Another kind of teeth is a class of ``Toothed`` with its ``kind``, usual proportions as defaults, and
``on_cones = False`` where it is for cylinders alone.  What repeats itself around the axis and is no
teeth needs a way to be drawn in :mod:`solidgear.cuts.sector.meshing` as well.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic import Field, model_validator

from solidgear.core import Range, SceneError, SignedAngle
from solidgear.core.scene.feature import SMALLEST, Count, OnSegment
from solidgear.core.scene.parts import Segment
from solidgear.core.scene.units import Ratio

#: least land between two teeth, and least top of a tooth, in pitches; smaller ones would need
#: endless meshes
LEAST_LAND = 0.02
#: rad; a chord of a tip, or of the land between two teeth, spans no more. A circle of such chords
#: lacks 0.4 % of its area; of 14 usual teeth every tip is one chord
LONGEST_CHORD = 0.15


Height = Annotated[Ratio, Range("must lie between 0 and 3 modules", least=0, most=3)]
HalfThickness = Annotated[
    Ratio, Range("must lie between 0.1 and 0.4 of the pitch", least=0.1, most=0.4)
]


def arc(half: float) -> np.ndarray:
    """Return the angles of the corners of an arc of 2 `half` in chords, from its middle.

    The number of chords is odd: a plane through the middle of the arc meets the middle of a chord.

    Examples
    --------
    >>> [len(arc(half)) - 1 for half in (0.07, 0.08, 0.225, 0.23)]
    [1, 3, 3, 5]
    """
    chords = 2 * math.ceil((2 * half / LONGEST_CHORD - 1 - 1e-9) / 2) + 1
    return np.linspace(-half, half, max(chords, 1) + 1)


class Toothed(OnSegment):
    """Trapezoid teeth, the same in every section but for the size.

    The angle is that of the middle of a tooth at the start of the segment, rad: 0 is +z.
    """

    sort: ClassVar[str] = "cyclic"
    toothed: ClassVar[bool] = True
    #: whether a cone may have them, and not only a cylinder
    on_cones: ClassVar[bool] = True

    #: number of teeth
    count: Count
    #: height above the pitch radius, modules
    addendum: Height = 1.0
    #: depth below the pitch radius, modules
    dedendum: Height = 1.2
    #: half of the thickness of a tooth at the pitch radius, in pitches
    half_thickness: HalfThickness = 0.25
    #: angle between a flank and the middle of the tooth, rad
    flank_angle: Annotated[SignedAngle, Field(ge=0.0, le=0.7)] = math.radians(15)
    #: angle between a tooth and a meridian, the same everywhere, rad
    spiral_angle: Annotated[SignedAngle, Field(ge=0.0, le=1.05)] = 0.0
    #: hand of the spiral: a tooth with a right hand turns about +y as it goes along +y
    hand: Literal["left", "right"] = "right"
    #: smeared, so that the segment of revolution replaces them, or resolved by a sector
    model: Literal["pitch_cone", "sector"] = "pitch_cone"

    @model_validator(mode="after")
    def _is_a_tooth(self):
        if self.addendum + self.dedendum == 0:
            raise SceneError(
                "teeth without height: leave the feature out",
                path=("dedendum",),
            )
        pitch = 2 * math.pi / self.count
        if self.root < 0.3:
            raise SceneError(
                f"leaves a root of {self.root:.3g} of the pitch radius; give less",
                path=("dedendum",),
            )
        if self.root_half > pitch / 2 - LEAST_LAND * pitch:
            raise SceneError(
                "the roots of neighbouring teeth almost touch: give a smaller dedendum, "
                "half_thickness or flank_angle",
                path=("dedendum",),
            )
        if self.tip_half < LEAST_LAND * pitch / 2:
            raise SceneError(
                "the teeth end in an edge below their height: give a smaller addendum or "
                "flank_angle, or a larger half_thickness",
                path=("addendum",),
            )
        return self

    @property
    def smeared(self) -> bool:
        """True where the pitch cone replaces the teeth."""
        return self.model == "pitch_cone"

    @property
    def tip(self) -> float:
        """Radius of the tips over the pitch radius of a section."""
        return 1 + 2 * self.addendum / self.count

    @property
    def root(self) -> float:
        """Radius of the roots over the pitch radius of a section."""
        return 1 - 2 * self.dedendum / self.count

    @property
    def tip_half(self) -> float:
        """Half angle of a tooth at its tip, rad."""
        return self._half(self.tip)

    @property
    def root_half(self) -> float:
        """Half angle of a tooth at its root, rad."""
        return self._half(self.root)

    @property
    def land_half(self) -> float:
        """Half angle of the land between two teeth, rad."""
        return math.pi / self.count - self.root_half

    @property
    def land(self) -> float:
        """Least radius of the land between teeth, in the middle of a chord, over the pitch radius."""
        return self.root * math.cos(arc(self.land_half)[-1] / (len(arc(self.land_half)) - 1))

    def _half(self, radius: float) -> float:
        """Return the half angle where the flank crosses a circle of `radius` over the pitch radius."""
        half, t = 2 * math.pi * self.half_thickness / self.count, math.tan(self.flank_angle)
        b = math.cos(half) - t * math.sin(half)
        inside = max(b * b - (1 + t * t) * (1 - radius**2), 0.0)
        s = (math.sqrt(inside) - b) / (1 + t * t)
        return math.atan2(math.sin(half) - t * s, math.cos(half) + s)

    @property
    def twist(self) -> float:
        """Tangent of the spiral angle, above zero for a right hand: the angle grows along +y."""
        return math.tan(self.spiral_angle) * (1 if self.hand == "right" else -1)

    def _fits(self, segment: Segment, segments: Sequence[Segment]) -> Iterator[SceneError]:
        if segment.outer0 != segment.outer1 and not self.on_cones:
            yield SceneError(
                f'"{segment.name}" is a cone, and a {self.what} is cut into a cylinder; '
                'use kind = "teeth"',
                path=("segment",),
            )
            return
        for end, outer, inner in (
            ("start", segment.outer0, segment.inner0),
            ("end", segment.outer1, segment.inner1),
        ):
            if inner >= self.root * outer * math.cos(math.pi / self.count) - SMALLEST * outer:
                yield SceneError(
                    f"the roots of the teeth lie {self.root * outer:.6g} m from the axis at the "
                    f'{end} of "{segment.name}", in its bore of radius {inner:.6g} m',
                    path=("dedendum",),
                )
                return


class Teeth(Toothed):
    """Straight or spiral teeth on a whole segment: a cone, or a cylinder.

    Every section is the same trapezoid with straight flanks, in proportion to the radius of the
    segment there, which is the pitch radius. Heights are measured in the section, along its radius,
    in modules of the section, ``2 r / count``. Tips and the lands between teeth are chords of at
    most `LONGEST_CHORD` with their ends on their circles: 14 usual teeth lack 0.1 % of the area and
    0.25 % of the polar moment that arcs would have, and no teeth more than 0.4 and 0.8 %.

    Examples
    --------
    >>> from solidgear.cuts.features import Teeth
    >>> teeth = Teeth(name="teeth", segment="head", count=14, addendum=0.9)
    >>> round(teeth.tip, 6), teeth.smeared
    (1.128571, True)
    """

    kind: Literal["teeth"] = "teeth"


class Spline(Toothed):
    """Teeth on a cylinder, with the fields of :class:`Teeth`."""

    on_cones: ClassVar[bool] = False

    kind: Literal["spline"] = "spline"
    #: profile, for ratings of strength: involute splines, serrations or straight-sided ones
    profile: Literal["involute", "serration", "straight"] = "involute"
