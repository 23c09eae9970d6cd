"""Metric threads on a cylinder."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import AfterValidator

from solidgear.core import SceneError, show
from solidgear.core.scene.parts import Segment
from solidgear.cuts.features.detail import Stretch

#: pitches of coarse threads by their diameter, mm (ISO 261)
COARSE = {
    3: 0.5,
    4: 0.7,
    5: 0.8,
    6: 1.0,
    8: 1.25,
    10: 1.5,
    12: 1.75,
    14: 2.0,
    16: 2.0,
    18: 2.5,
    20: 2.5,
    22: 2.5,
    24: 3.0,
    27: 3.0,
    30: 3.5,
    33: 3.5,
    36: 4.0,
    39: 4.0,
    42: 4.5,
    45: 4.5,
    48: 5.0,
    52: 5.0,
    56: 5.5,
    60: 5.5,
    64: 6.0,
}
PATTERN = r"[Mm] ?(\d+(?:\.\d+)?)(?: ?[x×*] ?(\d+(?:\.\d+)?))?"
#: depth of an external thread, and radius of its root, over the pitch (ISO 724, ISO 68-1)
DEPTH, ROOT = 0.61343, 0.14434
#: largest pitch over the diameter: that of M1, the coarsest of ISO 261
COARSEST = 0.25
#: relative; the cylinder of a thread may be so much smaller than its nominal diameter
TURNED = 0.02


def _sized(text: str) -> str:
    """Return the designation of a metric thread; refuse what is none."""
    match = re.fullmatch(PATTERN, text.strip())
    if match is None:
        raise SceneError(f'{show(text, 30)} is no metric thread; write "M30x1.5", or "M30"')
    diameter = float(match[1])
    if match[2] is None and diameter not in COARSE:
        raise SceneError(f'M{diameter:g} has no coarse pitch in ISO 261; write "M{diameter:g}x1.5"')
    pitch = float(match[2] or COARSE[int(diameter)])
    if pitch <= 0 or pitch > COARSEST * diameter:
        raise SceneError(
            f"a pitch of {pitch:g} mm is too coarse for a diameter of {diameter:g} mm: at most a "
            f"quarter of it, {COARSEST * diameter:g} mm"
        )
    return f"M{diameter:g}x{pitch:g}"


class Thread(Stretch):
    """A metric thread on a cylinder of its nominal diameter.

    Examples
    --------
    >>> thread = Thread(name="nut", segment="end", y=0.0, size="M30x1.5")
    >>> round(1e3 * thread.core, 3)  # 30 - 1.22687 1.5
    28.16
    """

    kind: Literal["thread"] = "thread"
    #: designation, such as M30x1.5
    size: Annotated[str, AfterValidator(_sized)]

    @property
    def nominal(self) -> float:
        """Nominal diameter, m."""
        return 1e-3 * float(self.size[1:].partition("x")[0])

    @property
    def pitch(self) -> float:
        """Pitch, m."""
        return 1e-3 * float(self.size.partition("x")[2])

    @property
    def core(self) -> float:
        """Diameter of the core, d3, m."""
        return self.nominal - 2 * DEPTH * self.pitch

    @property
    def root(self) -> float:
        """Radius of the root, m."""
        return ROOT * self.pitch

    def _fitted(self, segment: Segment) -> Iterator[SceneError]:
        diameter = 2 * segment.outer0
        if not (1 - TURNED) * self.nominal <= diameter <= (1 + 1e-6) * self.nominal:
            yield SceneError(
                f'{self.size} is cut into a cylinder of {self.nominal:.6g} m, and "{segment.name}" '
                f"is {diameter:.6g} m thick",
                path=("size",),
            )
        elif self.core <= 2 * segment.inner0:
            yield SceneError(
                f'the core of {self.size}, {self.core:.6g} m, lies in the bore of "{segment.name}", '
                f"{2 * segment.inner0:.6g} m",
                path=("size",),
            )
