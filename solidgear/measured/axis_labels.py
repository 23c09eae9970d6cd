"""Units of responses by the labels of their axes: ``m/s^2``, ``g``, ``lbf``, ``kHz``.

A label is free text that test equipment writes; an unknown one is ignored.
"""

from __future__ import annotations

import math
import re

#: m of a unit of length, N of one of force, Hz of one of frequency, as labels write them
LENGTHS = {
    "m": 1.0,
    "mm": 1e-3,
    "cm": 1e-2,
    "um": 1e-6,
    "µm": 1e-6,
    "μm": 1e-6,
    "in": 0.0254,
    "inch": 0.0254,
    "mil": 2.54e-5,
    "ft": 0.3048,
}
FORCES = {"n": 1.0, "mn": 1e-3, "kn": 1e3, "lbf": 4.4482216152605, "lb": 4.4482216152605}
FREQUENCIES = {"hz": 1.0, "khz": 1e3, "rad/s": 1 / (2 * math.pi), "rpm": 1 / 60, "cpm": 1 / 60}
#: m/s^2 of an acceleration in units of free fall
GRAVITY = dict.fromkeys(("g", "gn", "g0"), 9.80665)
#: a length, and how often it is over a second
_MOTION = re.compile(
    r"(?P<length>[^\W\d]+)(?:/s(?:ec)?(?P<square>\^2|\*\*2|²|2|/s(?:ec)?)?)?", re.I
)


def motion(label: str) -> tuple[float, int] | None:
    """Return SI units in the unit of a motion, and how often the displacement is differentiated in
    it.
    """
    word = _bare(label)
    if word in GRAVITY:
        return GRAVITY[word], 2
    parts = _MOTION.fullmatch(word)
    if parts is None or parts["length"] not in LENGTHS:
        return None
    order = 0 if "/" not in word else 2 if parts["square"] else 1
    return LENGTHS[parts["length"]], order


def force(label: str) -> float | None:
    """Return newtons in the unit of a force."""
    return FORCES.get(_bare(label))


def frequency(label: str) -> float | None:
    """Return hertz in the unit of a frequency."""
    return FREQUENCIES.get(_bare(label))


def response(label: str) -> tuple[float, int] | None:
    """Return SI units in the unit of a motion over a force, and derivatives, such as of
    ``mm/s^2/N``.
    """
    above, _, below = label.rpartition("/")
    numerator, denominator = motion(above.strip().strip("()")), force(below)
    return (
        None
        if numerator is None or denominator is None
        else (numerator[0] / denominator, numerator[1])
    )


def _bare(label: str) -> str:
    return re.sub(r"\s+", "", label).strip("[]()").lower()
