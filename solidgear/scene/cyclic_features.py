"""What repeats itself around a shaft: teeth on a cone, splines on a cylinder, circles of bolt holes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator

from solidgear.errors import SceneError
from solidgear.scene.feature import SMALLEST, OnSegment
from solidgear.scene.parts import Segment
from solidgear.scene.rules import TOUCH
from solidgear.scene.units import PositiveLength, SignedAngle, quantity

#: a sector of less than a third of a turn is what cyclic symmetry needs
FEWEST = 3
MOST_TEETH = 400
#: least land between two teeth, and least top of a tooth, in pitches; smaller ones ask for meshes
#: without end
LEAST_LAND = 0.02
#: rad; a chord of a tip, or of the land between two teeth, spans no more. A circle of such chords
#: lacks 0.4 % of its area; of 14 usual teeth every tip is one chord
LONGEST_CHORD = 0.15

Count = Annotated[int, Field(strict=True, ge=FEWEST, le=MOST_TEETH)]


def _ratio(low: float, high: float, what: str) -> Any:
    from pydantic import BeforeValidator

    def read(value):
        number = quantity(value, "dimensionless")
        if not low <= number <= high:
            raise SceneError(f"must lie between {low:g} and {high:g} {what}")
        return number

    return BeforeValidator(read)


Height = Annotated[float, _ratio(0.0, 3.0, "modules")]


def arc(half: float) -> np.ndarray:
    """Angles of the corners of an arc of 2 `half` in chords, from its middle.

    Their number is odd: a plane through the middle of the arc meets the middle of a chord.

    Examples
    --------
    >>> [len(arc(half)) - 1 for half in (0.07, 0.08, 0.225, 0.23)]
    [1, 3, 3, 5]
    """
    chords = 2 * math.ceil((2 * half / LONGEST_CHORD - 1 - 1e-9) / 2) + 1
    return np.linspace(-half, half, max(chords, 1) + 1)


class _Toothed(OnSegment):
    """Trapezoid teeth, the same in every section but for its size."""

    count: Count
    addendum: Height = 1.0
    dedendum: Height = 1.2
    half_thickness: Annotated[float, _ratio(0.1, 0.4, "of the pitch")] = 0.25
    flank_angle: Annotated[SignedAngle, Field(ge=0.0, le=0.7)] = math.radians(15)
    spiral_angle: Annotated[SignedAngle, Field(ge=0.0, le=1.05)] = 0.0
    hand: Literal["left", "right"] = "right"
    model: Literal["pitch_cone", "sector"] = "pitch_cone"

    @model_validator(mode="after")
    def _is_a_tooth(self):
        if self.addendum + self.dedendum == 0:
            raise SceneError(
                "teeth without height are the plain segment: leave the feature out",
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
                "the roots of neighbouring teeth all but touch: give a smaller dedendum, "
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
        """Whether the pitch cone stands for the teeth."""
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
        """Least radius of the land between two teeth, where a chord is nearest to the axis, over the
        pitch radius.
        """
        return self.root * math.cos(arc(self.land_half)[-1] / (len(arc(self.land_half)) - 1))

    def _half(self, radius: float) -> float:
        """Half angle where the straight flank crosses a circle; radius over that of the pitch."""
        half, t = 2 * math.pi * self.half_thickness / self.count, math.tan(self.flank_angle)
        b = math.cos(half) - t * math.sin(half)
        inside = max(b * b - (1 + t * t) * (1 - radius**2), 0.0)
        s = (math.sqrt(inside) - b) / (1 + t * t)
        return math.atan2(math.sin(half) - t * s, math.cos(half) + s)

    @property
    def twist(self) -> float:
        """Tangent of the spiral angle, above zero for a right hand: the angle grows along +y."""
        return math.tan(self.spiral_angle) * (1 if self.hand == "right" else -1)

    def _fits(self, here: Segment, segments: Sequence[Segment]) -> Iterator[SceneError]:
        for end, outer, inner in (
            ("start", here.outer0, here.inner0),
            ("end", here.outer1, here.inner1),
        ):
            if inner >= self.root * outer * math.cos(math.pi / self.count) - SMALLEST * outer:
                yield SceneError(
                    f"the roots of the teeth lie {self.root * outer:.6g} m from the axis at the "
                    f'{end} of "{here.name}", in its bore of radius {inner:.6g} m',
                    path=("dedendum",),
                )
                return


class Teeth(_Toothed):
    """Straight or spiral teeth on a whole segment: a cone, or a cylinder.

    Every section is the same trapezoid with straight flanks, in proportion to the radius of the
    segment there, which is the pitch radius. Heights are measured in the section, along its radius,
    in modules of the section, ``2 r / count``. Tips and the lands between teeth are chords of at
    most `LONGEST_CHORD` with their ends on their circles: 14 usual teeth lack 0.1 % of the area and
    0.25 % of the polar moment that arcs would have, and no teeth more than 0.4 and 0.8 %.

    Attributes
    ----------
    name, segment : str
    count : int
        3 to 400.
    addendum, dedendum : float
        Modules.
    half_thickness : float
        Of a tooth at its pitch radius, in pitches.
    flank_angle : float
        Between a flank and the middle of its tooth, rad.
    spiral_angle : float
        Between a tooth and a meridian, the same everywhere, rad.
    hand : {'right', 'left'}
        A tooth with a right hand turns about +y as it goes along +y.
    angle : float
        Where the middle of a tooth lies at the start of the segment, rad: 0 is +z.
    model : {'pitch_cone', 'sector'}
        Smeared, so that the segment of revolution stands for them, or resolved.

    Raises
    ------
    SceneError
        Teeth without height, that touch at the root, or that end in an edge.

    Examples
    --------
    >>> from solidgear.scene import Teeth
    >>> teeth = Teeth(name="teeth", segment="head", count=14, addendum=0.9)
    >>> round(teeth.tip, 6), teeth.smeared
    (1.128571, True)
    """

    kind: Literal["teeth"] = "teeth"


class Spline(_Toothed):
    """Teeth on a cylinder, fields as those of :class:`Teeth`.

    Raises
    ------
    SceneError
        As :class:`Teeth`.

    Examples
    --------
    >>> from solidgear.scene import Spline
    >>> Spline(name="spline", segment="end", count=24, addendum=0.5, dedendum=0.5).tip > 1.04
    True
    """

    kind: Literal["spline"] = "spline"

    def _fits(self, here: Segment, segments: Sequence[Segment]) -> Iterator[SceneError]:
        if here.outer0 != here.outer1:
            yield SceneError(
                f'"{here.name}" is a cone, and a spline is cut into a cylinder; use kind = "teeth"',
                path=("segment",),
            )
            return
        yield from super()._fits(here, segments)


class BoltCircle(OnSegment):
    """Holes along the axis, evenly spaced on a circle.

    Attributes
    ----------
    name, segment : str
    count : int
        3 to 400.
    diameter : float
        Of a hole, m.
    circle : float
        Diameter of the circle of their middles, m.
    depth : float or None
        m; None for holes through the whole segment.
    side : {'start', 'end'}
        The face of the segment that they are drilled from.
    angle : float
        Where the first hole lies, rad: 0 is +z.

    Raises
    ------
    SceneError
        A size that is not positive.

    Examples
    --------
    >>> from solidgear.scene import BoltCircle
    >>> BoltCircle(name="bolts", segment="flange", count=6, diameter="11 mm", circle="90 mm").depth
    """

    kind: Literal["bolt_circle"] = "bolt_circle"
    count: Count
    diameter: PositiveLength
    circle: PositiveLength
    depth: PositiveLength | None = None
    side: Literal["start", "end"] = "start"

    def _fits(self, here: Segment, segments: Sequence[Segment]) -> Iterator[SceneError]:
        middle, radius = self.circle / 2, self.diameter / 2
        least = SMALLEST * here.outer0
        outer, inner = min(here.outer0, here.outer1), max(here.inner0, here.inner1)
        if radius < least:
            yield SceneError(
                f"is under a hundredth of the diameter, {2 * here.outer0:.6g} m", path=("diameter",)
            )
        elif middle + radius > outer - least:
            yield SceneError(
                f'the holes reach {middle + radius:.6g} m from the axis, out of "{here.name}" of '
                f"radius {outer:.6g} m",
                path=("circle",),
            )
        elif middle - radius < inner + least:
            into = "its bore" if inner else "the axis"
            yield SceneError(f"the holes reach into {into}", path=("circle",))
        elif self.diameter > 2 * middle * math.sin(math.pi / self.count) - least:
            yield SceneError(
                f"{self.count} holes of this size run into each other", path=("diameter",)
            )
        elif self.depth is not None and self.depth > here.length + TOUCH:
            yield SceneError(
                f'deeper than "{here.name}" is long, {here.length:.6g} m', path=("depth",)
            )
        else:
            yield from self._open(here, segments)

    def _open(self, here: Segment, segments: Sequence[Segment]) -> Iterator[SceneError]:
        """The face that holes are drilled from is bare there."""
        at = segments.index(here) + (-1 if self.side == "start" else 1)
        if not 0 <= at < len(segments):
            return
        beside = segments[at]
        outer, inner = (
            (beside.outer1, beside.inner1)
            if self.side == "start"
            else (beside.outer0, beside.inner0)
        )
        middle, radius = self.circle / 2, self.diameter / 2
        if middle - radius < outer and middle + radius > inner:
            yield SceneError(
                f'"{beside.name}", of radius {outer:.6g} m, covers the holes at the {self.side} of '
                f'"{here.name}"; drill from the other side, or outside it',
                path=("side",),
            )

    def reach(self, here: Segment) -> tuple[float, float]:
        """Ends of the holes along the shaft.

        Parameters
        ----------
        here : Segment
            Its own.

        Returns
        -------
        (float, float)
            m.
        """
        if self.depth is None:
            return here.y0, here.y1
        if self.side == "start":
            return here.y0, here.y0 + self.depth
        return here.y1 - self.depth, here.y1
