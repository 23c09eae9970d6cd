"""Boundary dimensions of a catalogue designation: ISO 15, 104, 355 and drawn cups, in mm.

Only bore, outside diameter and width are standard.  Inner dimensions are the maker's, and estimated
in :mod:`solidgear.bearings.geometry`.
"""

from __future__ import annotations

import math
import re
from typing import NamedTuple

from solidgear.core import SceneError, near, show
from solidgear.core.errors import did_you_mean

_BORES = (10, 12, 15, 17, *range(20, 105, 5), 110, 120)


def _series(text: str, first: int = 10) -> dict[int, tuple[float, float]]:
    """Return outside diameter and width by bore, from ``D x B`` in the order of bores, a dash for none."""
    pairs = zip(_BORES[_BORES.index(first) :], text.split())
    sizes = {bore: pair.split("x") for bore, pair in pairs if pair != "-"}
    return {bore: (float(D), float(B)) for bore, (D, B) in sizes.items()}


#: ISO 15:2017, diameter series 0, 2 and 3, usual width
_LIGHT = _series(
    "26x8 28x8 32x9 35x10 42x12 47x12 55x13 62x14 68x15 75x16 80x16 90x18 95x18 100x18 110x20 "
    "115x20 125x22 130x22 140x24 145x24 150x24 170x28 180x28"
)
_MEDIUM = _series(
    "30x9 32x10 35x11 40x12 47x14 52x15 62x16 72x17 80x18 85x19 90x20 100x21 110x22 120x23 125x24 "
    "130x25 140x26 150x28 160x30 170x32 180x34 200x38 215x40"
)
_HEAVY = _series(
    "35x11 37x12 42x13 47x14 52x15 62x17 72x19 80x21 90x23 100x25 110x27 120x29 130x31 140x33 "
    "150x35 160x37 170x39 180x41 190x43 200x45 215x47 240x50 260x55"
)
#: ISO 15:2017, series 22 of cylindrical and spherical rollers
_WIDE = _series(
    "47x18 52x18 62x20 72x23 80x23 85x23 90x23 100x25 110x28 120x31 125x31 130x31 140x33 150x36 "
    "160x40 170x43 180x46 200x53 215x58",
    20,
)
#: ISO 355:2019, outside diameter x assembled width of the series 302, 303, 320, 322, 323, 330
_TAPERED = {
    "302": _series(
        "62x17.25 72x18.25 80x19.75 85x20.75 90x21.75 100x22.75 110x23.75 120x24.75 125x26.25 "
        "130x27.25 140x28.25 150x30.5 160x32.5 170x34.5 180x37",
        30,
    ),
    "303": _series(
        "72x20.75 80x22.75 90x25.25 100x27.25 110x29.25 120x31.5 130x33.5 140x36 150x38 160x40 "
        "170x42.5 180x44.5 190x46.5 200x49.5 215x51.5",
        30,
    ),
    "320": _series(
        "42x15 47x15 55x17 62x18 68x19 75x20 80x20 90x23 95x23 100x23 110x25 115x25 125x29 130x29 "
        "140x32 145x32 150x32",
        20,
    ),
    "322": _series(
        "62x21.25 72x24.25 80x24.75 85x24.75 90x24.75 100x26.75 110x29.75 120x32.75 125x33.25 "
        "130x33.25 140x35.25 150x38.5 160x42.5 170x45.5 180x49",
        30,
    ),
    "323": _series(
        "72x28.75 80x32.75 90x35.25 100x38.25 110x42.25 120x45.5 130x48.5 140x51 150x54 160x58 "
        "170x61.5 180x63.5 190x67.5 200x71.5 215x77.5",
        30,
    ),
    "330": _series(
        "47x17 55x20 62x21 68x22 75x24 80x24 90x27 95x27 100x27 110x31 115x31 125x36 130x36 140x39 "
        "145x39 150x39 160x43 170x47 180x48",
        25,
    ),
}
#: ISO 15:2017, series 03, 22, 23, 30, 31, 32, 40 as spherical rollers are made in
_SPHERICAL = {
    "213": {bore: size for bore, size in _HEAVY.items() if bore >= 20},
    "222": _WIDE,
    "223": _series(
        "90x33 100x36 110x40 120x43 130x46 140x48 150x51 160x55 170x58 180x60 190x64 200x67 215x73 "
        "240x80 260x86",
        40,
    ),
    "230": _series("150x37 170x45 180x46", 100),
    "231": _series("165x52 180x56 200x62", 100),
    "232": _series("160x52.4 - 180x60.3 200x69.8 215x76", 90),
    "240": _series("150x50 170x60 180x60", 100),
}
#: ISO 104:2015, diameter series 1 and 2 of single-direction thrust balls, outside diameter x height
_THRUST = {
    "511": _series(
        "24x9 26x9 28x9 30x9 35x10 42x11 47x11 52x12 60x13 65x14 70x14 78x16 85x17 90x18 95x18 "
        "100x19 105x19 110x19 120x22 - 135x25 145x25 155x25"
    ),
    "512": _series(
        "26x11 28x11 32x12 35x12 40x14 47x15 52x16 62x18 68x19 73x20 78x22 90x25 95x26 100x27 "
        "105x27 110x27 115x28 125x31 135x35 - 150x38 160x38 170x39"
    ),
}
#: degrees, the middle of what makers give for a series: of ISO 355 the angle, of spherical rollers
#: ``e = 1.5 tan a`` of ISO 281
_ANGLES = {"302": 15.0, "303": 12.95, "320": 16.0, "322": 15.0, "323": 12.95, "330": 11.2}
_E = {
    "213": 0.24,
    "2220[4-7]": 0.32,
    "222": 0.24,
    "223": 0.36,
    "230": 0.23,
    "231": 0.30,
    "232": 0.33,
    "240": 0.31,
}
_ANGLES |= {series: math.degrees(math.atan(e / 1.5)) for series, e in _E.items()}
_BALLS = {"60": _LIGHT, "62": _MEDIUM, "63": _HEAVY}
_ANGULAR = {"70": _LIGHT, "72": _MEDIUM, "73": _HEAVY}
_ROLLERS = {"10": _LIGHT, "2": _MEDIUM, "3": _HEAVY, "22": _WIDE}
_SUFFIX = {"": None, "C": 15.0, "AC": 25.0, "A5": 25.0, "B": 40.0, "BE": 40.0}
#: outside diameter of drawn cups by the diameter under the rollers, ISO 3245
_CUPS = {4: 8, 5: 9, 6: 10, 7: 11, 8: 12, 9: 13, 10: 14, 12: 18, 13: 19, 14: 20, 15: 21, 16: 22}
_CUPS |= {18: 24, 20: 26, 22: 28, 25: 32, 28: 35, 30: 37, 35: 42, 40: 47, 45: 52, 50: 58}

#: seals, shields; cages; tapered bore, grooves; tolerance; universal matching: no part in a stiffness
_READ = (
    r"2?RS[12HLR]?|2?RZ|2Z|ZZ|Z|DDU|LLU|TN9?|TVP2?|TVH|MA|MB|M1?|J[12]?|K|W33|Q|D|P[02456]A?|P|"
    "C[ABC]|G[ABC]"
)
_CLASS = "CN|C[234]"

#: kind, pattern, sizes by series, and words in a refusal
_WRITTEN = (
    (
        "deep_groove",
        rf"(?P<series>60|62|63)(?P<code>\d\d)(?P<rest>(?:{_READ}|{_CLASS}){{0,8}})",
        _BALLS,
        "deep groove 60, 62, 63",
    ),
    (
        "angular_contact",
        rf"(?P<series>70|72|73)(?P<code>\d\d)(?P<angle>C|AC|A5|BE?)?(?P<rest>(?:{_READ}){{0,8}})",
        _ANGULAR,
        "angular contact 70, 72, 73 (C, AC, B)",
    ),
    (
        "cylindrical",
        r"(?:NU|NJ|NUP|N)(?P<series>10|22|2|3)(?P<code>\d\d)(?:EC?)?"
        rf"(?P<rest>(?:{_READ}|{_CLASS}){{0,8}})",
        _ROLLERS,
        "cylindrical N, NU, NJ, NUP 10, 2, 3, 22",
    ),
    (
        "tapered",
        rf"(?P<series>302|303|320|322|323|330)(?P<code>\d\d)X?(?P<rest>(?:{_READ}){{0,8}})",
        _TAPERED,
        "tapered 302, 303, 320, 322, 323, 330",
    ),
    (
        "spherical",
        # not K: the clearance of a tapered bore comes of how far it is driven up
        rf"(?P<series>{'|'.join(_SPHERICAL)})(?P<code>\d\d)(?:E1(?:XL)?|EA?)?"
        rf"(?P<rest>(?:(?!K)(?:{_READ})|{_CLASS}){{0,8}})",
        _SPHERICAL,
        "spherical 213, 222, 223, 230, 231, 232, 240",
    ),
    (
        "thrust_ball",
        rf"(?P<series>511|512)(?P<code>\d\d)(?P<rest>(?:{_READ}){{0,8}})",
        _THRUST,
        "thrust ball 511, 512",
    ),
)


class Boundary(NamedTuple):
    """Kind and sizes of a designation."""

    kind: str
    #: bore, outer_diameter, width: m; the bore of a drawn cup is the diameter under its rollers
    bore: float
    outer_diameter: float
    width: float
    contact_angle: float | None = None  #: rad, where a suffix gives it
    clearance: str | None = None  #: class of ISO 5753-1, where a suffix gives it
    #: suffixes of seals, cages, tolerances and the like, which do not matter for stiffness
    ignored: str = ""


def boundary(designation: str) -> Boundary:
    """Return kind and boundary dimensions of a designation, such as ``6208-2RS1/C3``, ``7210 BEP``,
    ``NU 206``, ``32018 X`` or ``BK0810``.
    """
    plain = re.sub(r"[\s/-]", "", designation.upper())
    for kind, pattern, table, _ in _WRITTEN:
        match = re.fullmatch(pattern, plain)
        if not match:
            continue
        code = int(match["code"])
        bore = _BORES[code] if code < 4 else 5 * code
        sizes = table[match["series"]]
        if bore not in sizes:
            raise _unknown(designation)
        outer, width = sizes[bore]
        degrees = _SUFFIX[match["angle"] or ""] if kind == "angular_contact" else None
        angle = None if degrees is None else math.radians(degrees)
        parts = re.findall(f"{_CLASS}|{_READ}", match["rest"])
        classes = [part for part in parts if re.fullmatch(_CLASS, part)]
        if len(classes) > 1:
            raise SceneError(
                f"has two classes of clearance, {' and '.join(classes)}: write one",
                value=show(designation),
            )
        ignored = " ".join(part for part in parts if part not in classes)
        clearance = classes[0] if classes else None
        return Boundary(kind, bore / 1e3, outer / 1e3, width / 1e3, angle, clearance, ignored)
    cup = re.fullmatch(r"[BH]K(\d\d)(\d\d)", plain)
    if cup and int(cup[1]) in _CUPS and int(cup[2]) > 0:
        inner, width = int(cup[1]), int(cup[2])
        outer = 16 if inner == 12 and width <= 10 else _CUPS[inner]
        return Boundary("needle", inner / 1e3, outer / 1e3, width / 1e3)
    raise _unknown(designation)


def usual_angle(designation: str) -> float | None:
    """Return the usual contact angle of tapered and spherical roller bearings of a series, rad; None
    where none is known.

    Examples
    --------
    >>> round(math.degrees(usual_angle("30310")), 2)
    12.95
    """
    plain = re.sub(r"[\s-]", "", designation)
    angles = (degrees for series, degrees in _ANGLES.items() if re.match(series, plain))
    degrees = next(angles, None)
    return None if degrees is None else math.radians(degrees)


def _designations() -> list[str]:
    """Return all known designations without suffixes, except those of drawn cups."""
    first = {"cylindrical": ("NU", "NJ", "NUP", "N")}
    return [
        f"{before}{series}{_BORES.index(bore) if bore < 20 else bore // 5:02d}"
        for kind, _, table, _ in _WRITTEN
        for before in first.get(kind, ("",))
        for series, sizes in table.items()
        for bore in sizes
    ]


def _unknown(designation: str) -> SceneError:
    series = ", ".join(words for *_, words in _WRITTEN)
    plain = re.sub(r"[\s/-]", "", designation.upper()).replace("O", "0")
    designations = _designations()
    swapped = [name for name in designations if sorted(name) == sorted(plain)]
    hint = did_you_mean(next(iter(swapped), near(plain, designations)))
    return SceneError(
        f"this designation is not understood{hint}; known are {series} and drawn cups HK, BK, bores "
        "10 to 120 mm, with suffixes such as 2RS1, ZZ, TN9, P6, and C2, CN, C3, C4 of deep groove, "
        "cylindrical and spherical ones; or write kind, bore, outer_diameter, width",
        value=show(designation),
    )
