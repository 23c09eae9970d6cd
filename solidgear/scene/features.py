"""What of a shaft is not of revolution: keyways, flats and cross holes; and all kinds together."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Literal, TypeAlias

from solidgear.errors import SceneError
from solidgear.scene.cyclic_features import BoltCircle, Spline, Teeth
from solidgear.scene.cyclic_rules import meeting_problems
from solidgear.scene.feature import SMALLEST, Cut, deep
from solidgear.scene.parts import Segment
from solidgear.scene.rules import TOUCH
from solidgear.scene.units import PositiveLength

#: a shaft carries no more of them
MOST_FEATURES = 20


class _Long(Cut):
    """A cut that begins at its place and runs along the shaft."""

    length: PositiveLength

    @property
    def reach(self) -> tuple[float, float]:
        return self.y, self.y + self.length


class Keyway(_Long):
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
    width: PositiveLength
    depth: PositiveLength
    ends: Literal["round", "square"] = "round"

    def _sized(self, here: Segment) -> Iterator[SceneError]:
        yield from deep(self.depth, here, "keyway")
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


class Flat(_Long):
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
    depth: PositiveLength

    def _sized(self, here: Segment) -> Iterator[SceneError]:
        yield from deep(self.depth, here, "flat")


class CrossHole(Cut):
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


CutFeature: TypeAlias = Keyway | Flat | CrossHole
CyclicFeature: TypeAlias = Teeth | Spline | BoltCircle
#: any of them
Feature: TypeAlias = CutFeature | CyclicFeature


def feature_problems(
    segments: Sequence[Segment], features: Sequence[Feature]
) -> Iterator[SceneError]:
    """Features that do not fit their shaft, or have a name twice.

    Parameters
    ----------
    segments : sequence of Segment
    features : sequence of Feature

    Yields
    ------
    SceneError
        One for each problem, with the path of a scene.
    """
    if len(features) > MOST_FEATURES:
        reason = f"{len(features)} features are more than the {MOST_FEATURES} a shaft may have"
        yield SceneError(reason, path=("features",))
        return
    names, alone = set(), True
    for i, feature in enumerate(features):
        if feature.name in names:
            yield SceneError(
                "another feature has this name; each needs its own", path=("features", i, "name")
            )
        names.add(feature.name)
        for problem in feature.problems(segments):
            alone = False
            yield problem.located(None, path=("features", i, *problem.path))
    if alone:
        for i, problem in meeting_problems(segments, features):
            yield problem.located(None, path=("features", i, *problem.path))
