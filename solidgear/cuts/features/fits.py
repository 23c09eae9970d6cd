"""Interference of fits on the hole basis, by the tables of ISO 286.

Deviations and grades agree between two public programs (WaldekS710/isoFits and
rf-ghofmockel/rf-tolerance).
"""

from __future__ import annotations

import bisect
import re
from collections.abc import Mapping

from solidgear.core import SceneError, show

#: mm; upper ends of the ranges of sizes
SIZES = (3, 6, 10, 14, 18, 24, 30, 40, 50, 65, 80, 100, 120, 140, 160, 180, 200, 225, 250) + (
    *(280, 315, 355, 400, 450, 500),
)
#: um; lower deviation of a shaft by its letter, range by range; None where the standard has none
DEVIATIONS: Mapping[str, tuple[int | None, ...]] = {
    "n": (4, 8, 10, 12, 12, 15, 15, 17, 17, 20, 20, 23, 23, 27, 27, 27, 31, 31, 31)
    + (34, 34, 37, 37, 40, 40),
    "p": (6, 12, 15, 18, 18, 22, 22, 26, 26, 32, 32, 37, 37, 43, 43, 43, 50, 50, 50)
    + (56, 56, 62, 62, 68, 68),
    "r": (10, 15, 19, 23, 23, 28, 28, 34, 34, 41, 43, 51, 54, 63, 65, 68, 77, 80, 84)
    + (94, 98, 108, 114, 126, 132),
    "s": (14, 19, 23, 28, 28, 35, 35, 43, 43, 53, 59, 71, 79, 92, 100, 108, 122, 130, 140)
    + (158, 170, 190, 208, 232, 252),
    "t": (None, None, None, None, None, None, 41, 48, 54, 66, 75, 91, 104, 122, 134, 146)
    + (166, 180, 196, 218, 240, 268, 294, 330, 360),
    "u": (18, 23, 28, 33, 33, 41, 48, 60, 70, 87, 102, 124, 144, 170, 190, 210, 236, 258)
    + (284, 315, 350, 390, 435, 490, 540),
    "x": (20, 28, 34, 40, 45, 54, 64, 80, 97, 122, 146, 178, 210, 248, 280, 310, 350, 385)
    + (425, 475, 525, 590, 660, 740, 820),
}
#: mm; upper ends of the ranges of grades, and grades in um, range by range
GRADED = (3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500)
GRADES: Mapping[int, tuple[int, ...]] = {
    5: (4, 5, 6, 8, 9, 11, 13, 15, 18, 20, 23, 25, 27),
    6: (6, 8, 9, 11, 13, 16, 19, 22, 25, 29, 32, 36, 40),
    7: (10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63),
    8: (14, 18, 22, 27, 33, 39, 46, 54, 63, 72, 81, 89, 97),
}
PATTERN = r"H([5-8])/([nprstux])([5-8])"


def checked_fit(text: str) -> str:
    """Return a fit such as H7/s6; refuse any other."""
    if re.fullmatch(PATTERN, text) is None:
        raise SceneError(
            f"{show(text, 20)} is no fit that is known here: H5 to H8 with n, p, r, s, t, u or x of "
            'grade 5 to 8, such as "H7/s6"'
        )
    return text


def interference_of(fit: str, diameter: float) -> tuple[float, float]:
    """Return the least and the largest interference of a fit on a diameter, m; refuse sizes that the
    standard leaves out.

    Examples
    --------
    H7 of 40 mm is 0 to 25 um, s6 is 43 to 59 um:

    >>> [round(1e6 * value) for value in interference_of("H7/s6", 0.04)]
    [18, 59]
    """
    match = re.fullmatch(PATTERN, fit)
    assert match is not None, "a fit is checked as it is read"
    hole, letter, grade = int(match[1]), match[2], int(match[3])
    size = round(1e3 * diameter, 6)
    if size > SIZES[-1]:
        raise SceneError(f"fits are known to {SIZES[-1]} mm, and this is {size:g} mm")
    lower = DEVIATIONS[letter][bisect.bisect_left(SIZES, size)]
    if lower is None:
        raise SceneError(f"ISO 286 has no {letter} for {size:g} mm; give the interference")
    row = bisect.bisect_left(GRADED, size)
    least = lower - GRADES[hole][row]
    return 1e-6 * least, 1e-6 * (lower + GRADES[grade][row])
