"""What is cut out of a shaft and is not of revolution: keyways, flats, cross holes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Annotated, Literal, TypeAlias

from pydantic import BeforeValidator

from solidgear.errors import SceneError, nearest
from solidgear.scene.parts import Model, Segment
from solidgear.scene.rules import TOUCH
from solidgear.scene.units import Position, PositiveLength, quantity

#: a shaft carries no more of them
MOST_FEATURES = 20
#: least size of a feature over the radius of the shaft; smaller ones ask for meshes without end
SMALLEST = 1e-2

Turn = Annotated[float, BeforeValidator(lambda value: quantity(value, "angle") % (2 * math.pi))]


class _Feature(Model):
    """What every feature has: a name, a segment, and the angle it looks to."""

    name: str
    segment: str
    y: Position
    angle: Turn = 0.0

    def _on(self, segments: Sequence[Segment]) -> Segment | None:
        return next((s for s in segments if s.name == self.segment), None)

    def problems(self, segments: Sequence[Segment]) -> Iterator[SceneError]:
        """Why it does not fit the shaft; paths are those of its own fields."""
        here = self._on(segments)
        if here is None:
            known = [s.name for s in segments]
            yield SceneError(
                f"unknown segment{nearest(self.segment, known)}; there are {', '.join(known)}",
                path=("segment",),
            )
            return
        if here.outer0 != here.outer1:
            yield SceneError(
                f'"{here.name}" is a cone; a {self.what} is cut into a cylinder', path=("segment",)
            )
            return
        if here.inner0 != here.inner1:
            yield SceneError(
                f'the bore of "{here.name}" is a cone; a {self.what} is cut into an even wall',
                path=("segment",),
            )
            return
        lo, hi = self.reach
        if lo < here.y0 - TOUCH or hi > here.y1 + TOUCH:
            yield SceneError(
                f"the {self.what} reaches from {lo:.6g} to {hi:.6g} m, outside "
                f'"{here.name}" ({here.y0:.6g} to {here.y1:.6g} m)',
                path=("length" if hasattr(self, "length") else "y",),
            )
            return
        yield from self._sized(here)

    def _sized(self, here: Segment) -> Iterator[SceneError]:
        raise NotImplementedError

    @property
    def what(self) -> str:
        """Its kind in words."""
        return getattr(self, "kind").replace("_", " ")  # noqa: B009  # of every subclass

    @property
    def reach(self) -> tuple[float, float]:
        """Ends along the shaft, m."""
        raise NotImplementedError


def _deep(depth: float, here: Segment, what: str, least: float = 0.0) -> Iterator[SceneError]:
    """A cut leaves some wall over the bore, and over the axis of a solid shaft."""
    wall = here.outer0 - max(here.inner0, least)
    if depth >= wall - TOUCH:
        over = "the wall" if here.inner0 else "the radius"
        yield SceneError(
            f"a {what} as deep as this cuts through {over} of {wall:.6g} m", path=("depth",)
        )
    elif depth < SMALLEST * here.outer0:
        yield SceneError(
            f"a {what} under a hundredth of the radius, {here.outer0:.6g} m, is no feature: "
            "leave it out, or look at the units",
            path=("depth",),
        )


class Keyway(_Feature):
    """A slot with a flat floor along a cylinder.

    Attributes
    ----------
    name : str
    segment : str
        Of the shaft, a cylinder.
    y : float
        Its start along the shaft, m.
    length : float
        With its round ends, m.
    width, depth : float
        m; the depth is that below the crown of the cylinder (t1 of DIN 6885).
    ends : {'round', 'square'}
    angle : float
        Where it lies around the shaft, rad: 0 is +z, a quarter turn is +x.

    Raises
    ------
    SceneError
        A size that is not positive.

    Examples
    --------
    >>> from solidgear.scene import Keyway
    >>> key = Keyway(name="key", segment="shaft", y="120 mm", length="100 mm", width="25 mm",
    ...              depth="9 mm")
    >>> key.reach
    (0.12, 0.22)
    """

    kind: Literal["keyway"] = "keyway"
    length: PositiveLength
    width: PositiveLength
    depth: PositiveLength
    ends: Literal["round", "square"] = "round"

    @property
    def reach(self) -> tuple[float, float]:
        return self.y, self.y + self.length

    def _sized(self, here: Segment) -> Iterator[SceneError]:
        yield from _deep(self.depth, here, "keyway")
        if self.width >= here.outer0:
            yield SceneError(
                f"a keyway wider than the radius, {here.outer0:.6g} m, is no keyway",
                path=("width",),
            )
        elif self.width < SMALLEST * here.outer0:
            yield SceneError(
                f"is under a hundredth of the radius, {here.outer0:.6g} m", path=("width",)
            )
        # at the edges of the slot the surface lies lower than at its crown
        elif here.outer0 - math.sqrt(here.outer0**2 - self.width**2 / 4) >= self.depth:
            yield SceneError(
                "the surface at the sides of the keyway lies below its floor: it is too wide, or "
                "not deep enough",
                path=("depth",),
            )
        elif self.ends == "round" and self.length <= self.width + TOUCH:
            yield SceneError(
                f"with round ends a keyway is longer than it is wide ({self.width:.6g} m)",
                path=("length",),
            )


class Flat(_Feature):
    """A flat cut across a cylinder.

    Attributes
    ----------
    name, segment : str
    y, length : float
        Start and length along the shaft, m.
    depth : float
        Below the crown of the cylinder, m.
    angle : float
        As for :class:`Keyway`.

    Raises
    ------
    SceneError
        A size that is not positive.

    Examples
    --------
    >>> from solidgear.scene import Flat
    >>> Flat(name="flat", segment="shaft", y=0.1, length=0.05, depth=0.004).reach[0]
    0.1
    """

    kind: Literal["flat"] = "flat"
    length: PositiveLength
    depth: PositiveLength

    @property
    def reach(self) -> tuple[float, float]:
        return self.y, self.y + self.length

    def _sized(self, here: Segment) -> Iterator[SceneError]:
        yield from _deep(self.depth, here, "flat")


class CrossHole(_Feature):
    """A hole drilled through the axis.

    Attributes
    ----------
    name, segment : str
    y : float
        Of its middle along the shaft, m.
    diameter : float
        m.
    angle : float
        As for :class:`Keyway`; the hole goes all the way through.

    Raises
    ------
    SceneError
        A size that is not positive.

    Examples
    --------
    >>> from solidgear.scene import CrossHole
    >>> hole = CrossHole(name="oil", segment="shaft", y="50 mm", diameter="8 mm")
    >>> [round(y, 3) for y in hole.reach]
    [0.046, 0.054]
    """

    kind: Literal["cross_hole"] = "cross_hole"
    diameter: PositiveLength

    @property
    def reach(self) -> tuple[float, float]:
        return self.y - self.diameter / 2, self.y + self.diameter / 2

    def _sized(self, here: Segment) -> Iterator[SceneError]:
        if self.diameter >= here.outer0:
            yield SceneError(
                f"a cross hole wider than the radius, {here.outer0:.6g} m, leaves no shaft",
                path=("diameter",),
            )
        elif self.diameter < 2 * SMALLEST * here.outer0:
            yield SceneError(
                f"is under a hundredth of the diameter, {2 * here.outer0:.6g} m", path=("diameter",)
            )


#: any of them
Feature: TypeAlias = Keyway | Flat | CrossHole


def feature_problems(
    segments: Sequence[Segment], features: Sequence[Feature]
) -> Iterator[SceneError]:
    """Features that do not fit their shaft, or have a name twice.

    Parameters
    ----------
    segments : sequence of Segment
    features : sequence of Keyway, Flat or CrossHole

    Yields
    ------
    SceneError
        One for each problem, with the path of a scene.
    """
    if len(features) > MOST_FEATURES:
        reason = f"{len(features)} features are more than the {MOST_FEATURES} a shaft may have"
        yield SceneError(reason, path=("features",))
        return
    names = set()
    for i, feature in enumerate(features):
        if feature.name in names:
            yield SceneError(
                "another feature has this name; each needs its own", path=("features", i, "name")
            )
        names.add(feature.name)
        for problem in feature.problems(segments):
            yield problem.located(None, path=("features", i, *problem.path))
