"""From ranges of what is not known of bearings to the points where a range of answers is sought.

Corners of the box first: stiffness grows with load and preload and falls with clearance, so the
ends of a frequency mostly sit there. A low-discrepancy sample (Sobol) looks inside for what the
corners miss, such as a row that comes into contact half way.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from dataclasses import dataclass

from scipy.stats import qmc

from solidgear.bearings.solved import Choice
from solidgear.errors import SolidgearError, show
from solidgear.scene import Scene

#: points of the sample; a power of two, for which Sobol's points are balanced
SAMPLE = 16
_ENDS = ("softer", "middle", "stiffer")


@dataclass(frozen=True)
class Ranges:
    """Unknown data of the bearings of a scene, each with its range.

    Attributes
    ----------
    load, preload : (float, float)
        Times what the scene says.
    clearance : (float, float)
        Place in the range of a class of clearance, 0 to 1.
    inside : bool
        Whether an estimated inner geometry is taken from its softer to its stiffer end.
    """

    load: tuple[float, float] = (1.0, 1.0)
    preload: tuple[float, float] = (1.0, 1.0)
    clearance: tuple[float, float] = (0.0, 1.0)
    inside: bool = True

    def __post_init__(self) -> None:
        for name in ("load", "preload"):
            low, high = getattr(self, name)
            if not 0 < low <= high:
                raise SolidgearError(
                    f"range of {name} {show([low, high])}: two factors above zero, the lower "
                    "first, such as 0.5:1.2"
                )

    @property
    def text(self) -> str:
        """The varied data in words."""
        parts = [
            f"{key} {low:g} to {high:g} times"
            for key, (low, high) in (("load", self.load), ("preload", self.preload))
            if low != high
        ]
        if self.clearance[0] != self.clearance[1]:
            parts.append("clearance over its class")
        if self.inside:
            parts.append("estimated insides from softer to stiffer")
        return ", ".join(parts) or "nothing of the bearings varies"

    def for_scene(self, scene: Scene) -> Ranges:
        """Without what does not vary in a scene."""
        known = [b.catalogue for b in scene.bearings if b.catalogue is not None]
        loaded = scene.load is not None or any(data.load for data in known)
        return Ranges(
            load=self.load if loaded else (1.0, 1.0),
            preload=self.preload if any(data.preload for data in known) else (1.0, 1.0),
            clearance=self.clearance
            if any(isinstance(data.clearance, str) for data in known)
            else (0.5, 0.5),
            inside=self.inside and any(data.estimated for data in known),
        )


#: what the torque of a gearbox and the preload of a bearing usually do
USUAL = Ranges(load=(0.2, 1.2), preload=(0.7, 1.3))


def choices(ranges: Ranges, sample: int = SAMPLE) -> Iterable[Choice]:
    """The middle, the corners, and a sample of the box between them.

    Parameters
    ----------
    sample : int
        Points of the sample.

    Yields
    ------
    Choice

    Examples
    --------
    >>> points = list(choices(Ranges(load=(0.5, 1.2), inside=False), sample=4))
    >>> len(points), points[0].load, {point.load for point in points[1:5]} == {0.5, 1.2}
    (9, 1.0, True)
    """
    yield Choice()
    boxes = [ranges.load, ranges.preload, ranges.clearance, (0.0, 1.0) if ranges.inside else None]
    ends = [tuple(dict.fromkeys(box)) if box else (0.5,) for box in boxes]
    open_ = [k for k, end in enumerate(ends) if len(end) > 1]
    if not open_:
        return
    for corner in itertools.product(*ends):
        yield _choice(*corner)
    for point in qmc.Sobol(len(open_), scramble=False).random(sample):
        place = [end[0] for end in ends]
        for k, share in zip(open_, point):
            low, high = ends[k]
            place[k] = low + share * (high - low)
        yield _choice(*place)


def _choice(load: float, preload: float, clearance: float, inside: float) -> Choice:
    end = _ENDS[min(int(3 * inside), 2)]
    return Choice(end=end, clearance=clearance, preload=preload, load=load)  # type: ignore[arg-type]
