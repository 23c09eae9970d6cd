"""What a designation says: kind and boundary dimensions by ISO, and what its suffixes add.

Only bore, outside diameter and width are standard (:mod:`solidgear.bearings.plan`).  Inner dimensions
are the maker's, and estimated in :mod:`solidgear.bearings.geometry`.
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterator
from functools import cache, lru_cache
from typing import NamedTuple

from solidgear.bearings.plan import (
    CUP_OUTER,
    NK_OUTER,
    NKI_RACEWAY,
    RACEWAYS,
    Size,
    Sizes,
    bore_of,
    code_of,
    iso_15,
    tapered,
    thrust,
)
from solidgear.bearings.suffixes import IGNORED, Suffixes, read_suffixes
from solidgear.core import SceneError, near, show
from solidgear.core.errors import did_you_mean


class Family(NamedTuple):
    """Designations of one kind that are written alike."""

    kind: str
    words: str  #: in a refusal
    series: dict[str, Sizes]  #: sizes by the digits of a series
    before: str = ""  #: letters before the digits, a pattern
    first: tuple[str, ...] = ("",)  #: letters that stand for the pattern in a proposal
    rows: str | None = None  #: arrangement of bearings with two rows


#: of what a maker ribs: how a cylindrical roller bearing holds the shaft along y
RIBS = {"NJ": "one way", "NF": "one way", "NCF": "one way", "NUP": "both ways", "NH": "both ways"}


def _families() -> Iterator[Family]:
    """Yield families, those with more digits first."""
    yield Family("thrust_ball", "thrust ball 511, 512, 513, 514", thrust())
    named = {name: sizes for name, sizes in tapered().items() if name.startswith("T")}
    plain = {name: sizes for name, sizes in tapered().items() if name not in named}
    words = "tapered 302, 303, 313, 320, 322, 323, 329, 330, 331, 332"
    yield Family("tapered", words, plain, "(?:4T-?|HR|E-?)?")
    yield Family("tapered", "T7FC, T2ED, T2EE, T4CB, T5ED of ISO 355", named)
    spherical = {"213": "03", "222": "22", "223": "23", "230": "30", "231": "31", "232": "32"}
    spherical |= {"239": "39", "240": "40", "241": "41"}
    words = "spherical 213, 222, 223, 230, 231, 232, 239, 240, 241"
    yield Family("spherical", words, _planned(spherical, 20))
    deep = {"618": "18", "619": "19", "160": "00", "60": "10", "62": "02", "63": "03", "64": "04"}
    deep |= {"622": "22", "623": "23", "630": "30", "68": "18", "69": "19"}
    deep_sizes = _planned(deep) | {"161": {10: Size(28, 8), 12: Size(30, 8)}}
    words = "deep groove 618, 619, 160, 60, 62, 63, 64, 622, 623, 630 and of two rows 42, 43"
    yield Family("deep_groove", words, deep_sizes, "(?:S|W|E2)?")
    yield Family("deep_groove", "", _planned({"42": "22", "43": "23"}), rows="double_row")
    angular = {"718": "18", "719": "19", "70": "10", "72": "02", "73": "03", "74": "04"}
    angular |= {"78": "18", "79": "19"}
    words = "angular contact 718, 719, 70, 72, 73, 74 (C, AC, A, B) and of two rows 32, 33"
    yield Family("angular_contact", words, _planned(angular, 10), "B?")
    two_rows = {"32": "32", "33": "33", "52": "32", "53": "33"}
    yield Family("double_row_angular", "", _planned(two_rows))
    self_aligning = {"12": "02", "13": "03", "22": "22", "23": "23"}
    words = "self-aligning ball 12, 13, 22, 23"
    yield Family("self_aligning", words, _planned(self_aligning, 5))
    four = {"10": "10", "2": "02", "3": "03"}
    yield Family("four_point", "four point QJ 10, 2, 3", _planned(four, 15), "QJF?", ("QJ",))
    rollers = {"10": "10", "2": "02", "22": "22", "3": "03", "23": "23", "4": "04"}
    words = "cylindrical N, NU, NJ, NUP, NF 10, 2, 22, 3, 23, 4, NCF 18, 22, 29, 30, NN 30, NNU 49"
    first = ("NU", "NJ", "NUP", "N", "NF", "NH")
    yield Family("cylindrical", words, _planned(rollers, 15), "(?:NU|NJ|NUP|N|NF|NH)", first)
    full = {"18": "18", "22": "22", "29": "29", "30": "30"}
    yield Family("cylindrical", "", _planned(full, 15), "(?:NCF|SL18)", ("NCF",))
    yield Family("cylindrical", "", _planned({"30": "30"}), "NN", ("NN",), "double_row")
    yield Family("cylindrical", "", _planned({"49": "49"}, 60), "NNU", ("NNU",), "double_row")
    needles = {"48": "48", "49": "49", "69": "69"}
    yield Family("needle", "needle NA, RNA 48, 49, 69", _planned(needles), "R?NA", ("NA", "RNA"))


def _planned(series: dict[str, str], least: int = 3) -> dict[str, Sizes]:
    """Return sizes of written series by their dimension series of ISO 15, from a bore on."""
    return {written: iso_15(dimension, least) for written, dimension in series.items()}


@cache
def families() -> tuple[Family, ...]:
    """Return all families; files without a designation need none."""
    return tuple(_families())


#: degrees, the middle of what makers give for a series: of ISO 355 the angle, else that of the
#: ``e = 1.5 tan a`` of ISO 281 in their lists
_ANGLES = {
    "tapered": {"302": 15.0, "303": 12.95, "320": 16.0, "322": 15.0, "323": 12.95, "330": 11.2}
}
_E = {
    "tapered": {
        "313": 0.83,
        "329": 0.36,
        "331": 0.40,
        "332": 0.37,
        "T7FC": 0.87,
        "T2E": 0.35,
        "T4": 0.47,
        "T5": 0.55,
    },
    "spherical": {
        "213": 0.24,
        "2220[4-7]": 0.32,
        "222": 0.24,
        "223": 0.36,
        "230": 0.23,
        "231": 0.30,
        "232": 0.33,
        "239": 0.18,
        "240": 0.31,
        "241": 0.38,
    },
    "self_aligning": {"12": 0.24, "13": 0.25, "22": 0.30, "23": 0.42},
}
for _kind, _factors in _E.items():
    _angles = {series: math.degrees(math.atan(e / 1.5)) for series, e in _factors.items()}
    _ANGLES[_kind] = {**_ANGLES.get(_kind, {}), **_angles}
#: what other designations mean, by the beginning of a designation
_OTHERS = {
    r"81[12]\d\d|89[34]\d\d|874\d\d": "a cylindrical roller thrust bearing",
    r"29[234]\d\d": "a spherical roller thrust bearing",
    r"52[234]\d\d|54[234]\d\d": "a thrust ball bearing of two directions",
    r"53[234]\d\d": "a thrust ball bearing with a spherical washer",
    r"(HM|LM|JL|JLM|JHM|M|L|H|HH)\s*\d{4,6}.*|\d{4,6}/\d{2,6}.*": "an inch tapered roller bearing",
    r"(UC|YAR|YET|GRAE|UK|SB)\s*\d+.*": "an insert bearing",
    r"(HCB|XCB|HCS|XCS|HC)\d+.*": "a bearing with ceramic balls, which are stiffer than steel,",
}


class Boundary(NamedTuple):
    """Kind and sizes of a designation."""

    kind: str
    #: bore, outer_diameter, width: m; the bore of needle rollers without an inner ring is the
    #: diameter under them
    bore: float
    outer_diameter: float
    width: float
    contact_angle: float | None = None  #: rad, where a suffix gives it
    clearance: str | None = None  #: class of ISO 5753-1, where a suffix gives it
    #: raceway, m: diameter under needle rollers on an inner ring
    raceway: float | None = None
    arrangement: str | None = None  #: of two rows, or of a matched pair
    cage: bool | None = None  #: False for a full complement of rollers
    ribs: str | None = None  #: how ribs hold a cylindrical roller bearing along y
    #: suffixes of seals, cages, tolerances and the like, which do not matter for stiffness
    ignored: str = ""
    tapered_bore: bool = False


@lru_cache(maxsize=1024)
def boundary(designation: str) -> Boundary:
    """Return kind and boundary dimensions of a designation, such as ``6208-2RS1/C3``, ``7210 BEP``,
    ``NU 206``, ``32018 X``, ``NKI 20/16`` or ``BK0810``.

    Examples
    --------
    >>> size = boundary("NUP 208 ECP/C3")
    >>> size.kind, round(size.outer_diameter, 3), size.clearance, size.ribs
    ('cylindrical', 0.08, 'C3', 'both ways')
    """
    text = re.sub(r"\s+", " ", designation.strip().upper())
    sized = _of_iso_355(text) or _of_family(text) or _of_needles(text)
    if sized is None:
        raise _unknown(designation, text)
    size, rest = sized
    # an E of a spindle bearing is an angle, of another its design
    spindle = size.kind == "angular_contact" and text.startswith("B")
    suffixes = read_suffixes(rest, "spindle" if spindle else size.kind)
    if suffixes.unread:
        raise SceneError(
            f"{show(suffixes.unread)} is no suffix that is known; known are those of SKF, "
            f"Schaeffler, NSK and NTN of {', '.join(IGNORED)}, classes C2 to C5, contact angles "
            "and pairs; leave it out if it says nothing of the inside, or write kind, bore, "
            "outer_diameter, width",
            value=show(designation),
        )
    return _with_suffixes(size, suffixes, designation)


def _with_suffixes(size: Boundary, suffixes: Suffixes, designation: str) -> Boundary:
    """Return sizes with what the suffixes say; refuse what contradicts itself or is not modelled."""
    if suffixes.reason:
        raise SceneError(suffixes.reason, value=show(designation))
    if len(suffixes.classes) > 1:
        raise SceneError(
            f"has two classes of clearance, {' and '.join(suffixes.classes)}: write one",
            value=show(designation),
        )
    angle = size.contact_angle if suffixes.angle is None else math.radians(suffixes.angle)
    return size._replace(
        contact_angle=angle,
        clearance=suffixes.classes[0] if suffixes.classes else None,
        arrangement=suffixes.arrangement or size.arrangement,
        ignored=" ".join(suffixes.ignored),
        tapered_bore=suffixes.tapered_bore,
    )


#: ISO 355's names of series that have an older one, without the digit of the bore; the letter of
#: the diameter depends on it
_ISO_355 = {
    r"T[23][DE]B": ("302", ""),
    r"T[23][DE]C": ("322", ""),
    r"T[23][DE]E": ("332", ""),
    r"T5[DE]C": ("322", "B"),
    r"T2[FG]B": ("303", ""),
    r"T7[FG]B": ("313", ""),
    r"T2[FG]D": ("323", ""),
    r"T5[FG]D": ("323", "B"),
    r"T[34]CC": ("320", ""),
}


def _of_iso_355(text: str) -> tuple[Boundary, str] | None:
    """Return sizes of a name of ISO 355, such as ``T2EE 040``, and the rest; None for another."""
    match = re.match(r"(?P<series>T\d[A-G][A-E])[ -]?(?P<bore>\d{3})(?!\d)", text)
    if match is None:
        return None
    bore, series, steep = int(match["bore"]), match["series"], ""
    size = tapered().get(series, {}).get(bore)
    if size is None:
        older = (names for pattern, names in _ISO_355.items() if re.fullmatch(pattern, series))
        series, steep = next(older, ("", ""))
        size = tapered().get(series, {}).get(bore)
    if size is None:
        return None
    return _sized("tapered", bore, size), f"{steep} {text[match.end() :]}"


def _of_family(text: str) -> tuple[Boundary, str] | None:
    """Return sizes of a designation of a series and a bore, and the rest; None for another."""
    readings = []
    for family in families():
        match = re.match(rf"(?P<before>{family.before})[ -]?(?P<digits>\d+)", text)
        if match is None:
            continue
        rest = text[match.end() :]
        for place, (series, bore, left) in enumerate(_read_digits(match["digits"], rest)):
            if (size := family.series.get(series, {}).get(bore)) is not None:
                sized = _of_letters(family, match["before"], series, bore, size)
                readings.append((place, sized, left))
    if not readings:
        return None
    _, sized, left = min(readings, key=lambda reading: reading[0])
    if sized.kind == "cylindrical" and (flange := re.search(r"\+ ?HJ.*", left)):
        ribs = {"one way": "both ways", "none": "one way"}.get(sized.ribs or "", sized.ribs)
        return sized._replace(ribs=ribs), left[: flange.start()]
    return sized, left


def _read_digits(digits: str, rest: str) -> Iterator[tuple[str, int, str]]:
    """Yield series, bore in mm and what is left of a number and the text behind it, the likeliest
    reading first.
    """
    if slashed := re.match(r"/(\d{1,2})(?!\d)", rest):
        yield digits, int(slashed[1]), rest[slashed.end() :]
    if spaced := re.match(r"[ -](\d\d)(?!\d)", rest):
        yield digits, bore_of(spaced[1]), rest[spaced.end() :]
    if len(digits) > 2:
        yield digits[:-2], bore_of(digits[-2:]), rest
    if len(digits) == 3:
        yield digits[:-1], bore_of(digits[-1]), rest
    # 62052RS is 6205 2RS, while 62202RS is 62202 RS
    if digits[-1] in "25" and rest[:1].isalpha() and len(digits) > 3:
        yield from _read_digits(digits[:-1], f" {digits[-1]}{rest}")


def _of_letters(family: Family, letters: str, series: str, bore: int, size: Size) -> Boundary:
    """Return what the digits of a designation and the letters before them say."""
    sized = _sized(family.kind, bore, size)._replace(arrangement=family.rows)
    if family.kind == "cylindrical":
        letters = letters.replace("SL18", "NCF")
        cage = False if letters == "NCF" else None
        return sized._replace(ribs=RIBS.get(letters, "none"), cage=cage)
    if family.kind != "needle":
        return sized
    under = RACEWAYS[series[1]].get(bore)
    if under is None:
        return sized
    if letters == "RNA":
        return sized._replace(bore=under / 1e3)
    return sized._replace(raceway=under / 1e3)


def _sized(kind: str, bore: float, size: Size) -> Boundary:
    return Boundary(kind, bore / 1e3, size.outer / 1e3, size.width / 1e3)


def _of_needles(text: str) -> tuple[Boundary, str] | None:
    """Return sizes of needle rollers that are named by them: ``NK 20/16``, ``NKI 20/16``,
    ``HK 2016``, and the rest; None for others.
    """
    match = re.match(
        r"(?:(?P<ring>NKI?S?) ?(?P<d>\d{1,3})/(?P<b>\d\d)|[BH]K[ -]?(?P<cup>\d\d)(?P<width>\d\d))(?!\d)",
        text,
    )
    if match is None or (match["ring"] or "").endswith("S"):
        return None
    rest = text[match.end() :]
    if match["cup"]:
        under, width = int(match["cup"]), int(match["width"])
        # the thin shell of 12 mm is the narrow one
        outer = 16 if under == 12 and width <= 10 else CUP_OUTER.get(under)
        return (_sized("needle", under, Size(outer, width)), rest) if outer and width else None
    bore, width = int(match["d"]), int(match["b"])
    under = bore if match["ring"] == "NK" else int(NKI_RACEWAY.get(bore, 0))
    if under not in NK_OUTER:
        return None
    sized = _sized("needle", bore, Size(NK_OUTER[under], width))
    return sized._replace(raceway=None if under == bore else under / 1e3), rest


def usual_angle(designation: str, kind: str = "tapered") -> float | None:
    """Return the usual contact angle of bearings of a kind and a series, rad; None where none is
    known.

    Examples
    --------
    >>> round(math.degrees(usual_angle("30310")), 2)
    12.95
    """
    plain = re.sub(r"[\s-]", "", designation.upper())
    plain = re.sub("^(?:4T|HR|E)", "", plain)
    series = _ANGLES.get(kind, {})
    degrees = next((angle for start, angle in series.items() if re.match(start, plain)), None)
    return None if degrees is None else math.radians(degrees)


def _designations() -> list[str]:
    """Return all known designations without suffixes, except those of needle rollers by size."""
    return [
        f"{before}{series}{code_of(bore)}"
        for family in families()
        for before in family.first
        for series, sizes in family.series.items()
        for bore in sizes
    ]


def _unknown(designation: str, text: str) -> SceneError:
    for pattern, words in _OTHERS.items():
        if re.match(pattern, text):
            return SceneError(
                f"is {words} of which there is no model here; write stiffness in place of catalogue",
                value=show(designation),
            )
    series = ", ".join(family.words for family in families() if family.words)
    plain = re.sub(r"[\s/-]", "", text).replace("O", "0")
    designations = _designations()
    swapped = [name for name in designations if sorted(name) == sorted(plain)]
    alike = max(swapped, key=lambda name: len(os.path.commonprefix([name, plain])), default="")
    hint = did_you_mean(alike or near(plain, designations))
    return SceneError(
        f"this designation is not understood{hint}; known are {series}, NK and NKI with sizes, and "
        "drawn cups HK, BK, in bores to 200 mm, with makers' suffixes; or write kind, bore, "
        "outer_diameter, width, or a list of bearings",
        value=show(designation),
    )
