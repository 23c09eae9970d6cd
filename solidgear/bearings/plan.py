"""Boundary dimensions of ISO: outer diameter and width of a bearing by its series and its bore, in mm.

ISO 15 has one plan for all radial bearings with a straight bore: the outer diameter follows from
the diameter series (8, 9, 0, 1, 2, 3, 4: the last digit of a series) and the bore, the width from the
width series beside it.  So 6208, 7208, QJ 208, 1208, NU 208 are one row of it.  ISO 355 has tapered
rollers, ISO 104 thrust bearings, ISO 1206, 3245 and makers' lists needle rollers.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple


class Size(NamedTuple):
    """Outer diameter and width, mm."""

    outer: float
    width: float


Sizes = dict[int, Size]

#: mm; from 20 on five times the number in a designation
BORES = (
    *(3, 4, 5, 6, 7, 8, 9, 10, 12, 15, 17),
    *range(20, 115, 5),
    *range(120, 210, 10),
)
#: bores of a designation's last digits below 04
CODES = {"00": 10, "01": 12, "02": 15, "03": 17}


def bore_of(code: str) -> int:
    """Return the bore of the last digits of a designation, mm: one digit is the bore itself."""
    return CODES.get(code) or (int(code) if len(code) == 1 else 5 * int(code))


def code_of(bore: int) -> str:
    """Return the last digits of a designation of a bore; of a bore that has none, with a slash."""
    if bore < 10:
        return str(bore)
    codes = {size: code for code, size in CODES.items()}
    return codes.get(bore) or (f"/{bore}" if bore % 5 else f"{bore // 5:02d}")


class Row(NamedTuple):
    """Numbers in the order of bores, from a bore on; a dash for none."""

    first: int
    text: str

    def read(self) -> dict[int, float]:
        """Return the numbers by bore."""
        bores = BORES[BORES.index(self.first) :]
        pairs = zip(bores, self.text.split())
        return {bore: float(number) for bore, number in pairs if number != "-"}


class Listed(NamedTuple):
    """Sizes ``D x B`` in the order of bores, from a bore on, a dash for none; and bores between."""

    first: int
    text: str
    between: dict[int, Size] = {}

    def read(self) -> Sizes:
        """Return the sizes by bore."""
        pairs = zip(BORES[BORES.index(self.first) :], self.text.split()) if self.text else ()
        sizes = {bore: pair.split("x") for bore, pair in pairs if pair != "-"}
        return {bore: Size(float(D), float(B)) for bore, (D, B) in sizes.items()} | self.between


#: ISO 15:2017, outer diameter by diameter series
_OUTER = {
    "8": Row(
        3,
        "7 9 11 13 14 16 17 19 21 24 26 32 37 42 47 52 58 65 72 78 85 90 95 100 110 115 120 125 130 "
        "140 150 165 175 190 200 215 225 240 250",
    ),
    "9": Row(
        3,
        "8 11 13 15 17 19 20 22 24 28 30 37 42 47 55 62 68 72 80 85 90 100 105 110 120 125 130 140 "
        "145 150 165 180 190 210 220 230 250 260 280",
    ),
    "0": Row(
        3,
        "9 12 14 17 19 22 24 26 28 32 35 42 47 55 62 68 75 80 90 95 100 110 115 125 130 140 145 150 "
        "160 170 180 200 210 225 240 260 280 290 310",
    ),
    "1": Row(100, "165 - 180 200 210 225 250 270 280 300 320 340"),
    "2": Row(
        3,
        "10 13 16 19 22 24 26 30 32 35 40 47 52 62 72 80 85 90 100 110 120 125 130 140 150 160 170 "
        "180 190 200 215 230 250 270 290 310 320 340 360",
    ),
    "3": Row(
        4,
        "16 19 22 26 28 30 35 37 42 47 52 62 72 80 90 100 110 120 130 140 150 160 170 180 190 200 "
        "215 225 240 260 280 300 320 340 360 380 400 420",
    ),
    "4": Row(15, "52 62 72 80 90 100 110 120 130 140 150 160 180 190 200 210 225 240 250"),
}
#: ISO 15:2017, width by width series and diameter series
_WIDTH = {
    "18": Row(
        3,
        "2 2.5 3 3.5 3.5 4 4 5 5 5 5 7 7 7 7 7 7 7 9 10 10 10 10 10 13 13 13 13 13 16 16 18 18 20 20 "
        "22 22 24 24",
    ),
    "48": Row(110, "30 30 35 35 40 40 45 45 50 50"),
    "19": Row(
        3,
        "3 4 4 5 5 6 6 6 6 7 7 9 9 9 10 12 12 12 13 13 13 16 16 16 18 18 18 20 20 20 22 24 24 28 28 "
        "28 33 33 38",
    ),
    "29": Row(100, "24 - 24 27 30 30 36 36 36 42 42 48"),
    "39": Row(180, "52 52 60"),
    "49": Row(
        10,
        "13 13 13 13 17 17 17 20 22 22 22 25 25 25 30 30 30 35 35 35 40 40 40 45 50 50 60 60 60 69 "
        "69 80",
    ),
    "69": Row(12, "22 23 23 30 30 30 36 40 40 40 45 45 45 54 54 54 63 63"),
    "00": Row(
        12,
        "7 8 8 8 8 9 9 9 10 10 11 11 11 13 13 14 14 16 16 16 18 19 19 22 22 24 25 28 31 31 34",
    ),
    "10": Row(
        3,
        "3 4 5 6 6 7 7 8 8 9 10 12 12 13 14 15 16 16 18 18 18 20 20 22 22 24 24 24 26 28 28 33 33 35 "
        "38 42 46 46 51",
    ),
    "30": Row(
        20,
        "16 16 19 20 21 23 23 26 26 26 30 30 34 34 37 37 37 41 45 46 52 53 56 60 67 74 75 82",
    ),
    "40": Row(100, "50 - 60 60 69 69 75 80 90 100 100 109"),
    "31": Row(100, "52 - 56 62 64 68 80 86 88 96 104 112"),
    "41": Row(100, "65 - 69 80 80 85 100 109 109 118 128 140"),
    "02": Row(
        3,
        "4 5 5 6 7 8 8 9 10 11 12 14 15 16 17 18 19 20 21 22 23 24 25 26 28 30 32 34 36 38 40 40 42 "
        "45 48 52 52 55 58",
    ),
    "22": Row(
        10,
        "14 14 14 16 18 18 20 23 23 23 23 25 28 31 31 31 33 36 40 43 46 50 53 58 64 68 73 80 86 86 "
        "92 98",
    ),
    "32": Row(
        10,
        "14 15.9 15.9 17.5 20.6 20.6 23.8 27 30.2 30.2 30.2 33.3 36.5 38.1 39.7 41.3 44.4 49.2 52.4 "
        "55.6 60.3 65.1 69.8 76 80 88 96 104 110 112 120 128",
    ),
    "03": Row(
        4,
        "5 6 7 9 9 10 11 12 13 14 15 17 19 21 23 25 27 29 31 33 35 37 39 41 43 45 47 49 50 55 58 62 "
        "65 68 72 75 78 80",
    ),
    "23": Row(
        10,
        "17 17 17 19 21 24 27 31 33 36 40 43 46 48 51 55 58 60 64 67 73 77 80 86 93 102 108 114 120 "
        "126 132 138",
    ),
    "33": Row(
        15,
        "19 22.2 22.2 25.4 30.2 34.9 36.5 39.7 44.4 49.2 54 58.7 63.5 68.3 68.3 73 73 77.8 82.6 - "
        "92.1",
    ),
    "04": Row(15, "15 17 19 21 23 25 27 29 31 33 35 37 42 45 48 52 54 55 58"),
}
#: the bores 22, 28 and 32 mm, which are written with a slash
_BETWEEN = {
    "10": {22: Size(44, 12), 28: Size(52, 12), 32: Size(58, 13)},
    "02": {22: Size(50, 14), 28: Size(58, 16), 32: Size(65, 17)},
    "03": {22: Size(56, 16), 28: Size(68, 18), 32: Size(75, 20)},
}


def iso_15(series: str, least: int = 3) -> Sizes:
    """Return sizes by bore of a dimension series of ISO 15, its width and diameter series such as
    ``02`` of 6208, from a bore on.

    Examples
    --------
    >>> iso_15("02")[40]
    Size(outer=80.0, width=18.0)
    """
    outer = _OUTER[series[1]].read()
    sizes = {bore: Size(outer[bore], width) for bore, width in _WIDTH[series].read().items()}
    sizes |= _BETWEEN.get(series, {})
    return {bore: size for bore, size in sorted(sizes.items()) if bore >= least}


#: ISO 355:2019, outer diameter x assembled width T
_TAPERED = {
    "302": Listed(
        15,
        "35x11.75 40x13.25 47x15.25 52x16.25 62x17.25 72x18.25 80x19.75 85x20.75 90x21.75 100x22.75 "
        "110x23.75 120x24.75 125x26.25 130x27.25 140x28.25 150x30.5 160x32.5 170x34.5 180x37 190x39 "
        "200x41 215x43.5 230x43.75 250x45.75 270x49 290x52 310x57 320x57 340x60 360x64",
        {28: Size(58, 17.25)},
    ),
    "303": Listed(
        15,
        "42x14.25 47x15.25 52x16.25 62x18.25 72x20.75 80x22.75 90x25.25 100x27.25 110x29.25 120x31.5 "
        "130x33.5 140x36 150x38 160x40 170x42.5 180x44.5 190x46.5 200x49.5 215x51.5 225x53.5 "
        "240x54.5 260x59.5 280x63.75 300x67.75 320x72",
    ),
    "313": Listed(
        25,
        "62x18.25 72x20.75 80x22.75 90x25.25 100x27.25 110x29.25 120x31.5 130x33.5 140x36 150x38 "
        "160x40 170x42.5 180x44.5 190x46.5 200x49.5 215x56.5 225x58 240x63 260x68 280x72 300x77 "
        "320x82",
    ),
    "320": Listed(
        20,
        "42x15 47x15 55x17 62x18 68x19 75x20 80x20 90x23 95x23 100x23 110x25 115x25 125x29 130x29 "
        "140x32 145x32 150x32 160x35 170x38 180x38 200x45 210x45 225x48 240x51 260x57 280x64 290x64 "
        "310x70",
        {22: Size(44, 15), 28: Size(52, 16), 32: Size(58, 17)},
    ),
    "322": Listed(
        17,
        "40x17.25 47x19.25 52x19.25 62x21.25 72x24.25 80x24.75 85x24.75 90x24.75 100x26.75 110x29.75 "
        "120x32.75 125x33.25 130x33.25 140x35.25 150x38.5 160x42.5 170x45.5 180x49 190x53 200x56 "
        "215x61.5 230x67.75 250x71.75 270x77 290x84 310x91 320x91 340x97 360x104",
        {28: Size(58, 20.25)},
    ),
    "323": Listed(
        17,
        "47x20.25 52x22.25 62x25.25 72x28.75 80x32.75 90x35.25 100x38.25 110x42.25 120x45.5 130x48.5 "
        "140x51 150x54 160x58 170x61.5 180x63.5 190x67.5 200x71.5 215x77.5 225x81.5 240x84.5 "
        "260x90.5",
    ),
    "329": Listed(
        20,
        "37x12 42x12 47x12 55x14 62x15 68x15 72x15 80x17 85x17 90x17 100x20 105x20 110x20 120x23 "
        "125x23 130x23 140x25 145x25 150x25 165x29 180x32 190x32 210x38 220x38 230x38 250x45 260x45 "
        "280x51",
    ),
    "330": Listed(
        25,
        "47x17 55x20 62x21 68x22 75x24 80x24 90x27 95x27 100x27 110x31 115x31 125x36 130x36 140x39 "
        "145x39 150x39 160x43 170x47 180x48",
    ),
    "331": Listed(
        40,
        "75x26 80x26 85x26 95x30 100x30 110x34 120x37 125x37 130x37 140x41 150x45 160x49 165x52 "
        "175x56 180x56 200x62",
    ),
    "332": Listed(
        25,
        "52x22 62x25 72x28 80x32 85x32 90x32 100x35 110x38 120x41 125x41 130x41 140x46 150x49 160x55 "
        "170x58 180x63",
    ),
    # ISO 355's names of series that have no older one
    "T7FC": Listed(45, "95x29 105x32 115x34 125x37 130x37 140x39 150x42 160x45 170x48 - 180x49"),
    "T2ED": Listed(45, "95x36 100x36 110x39 - - 130x43 - 145x46"),
    "T2EE": Listed(10, "", {40: Size(85, 33), 60: Size(115, 40), 100: Size(165, 47)}),
    "T4CB": Listed(10, "", {100: Size(145, 24), 120: Size(170, 27), 140: Size(195, 29)}),
    "T5ED": Listed(10, "", {60: Size(115, 39)}),
}
#: ISO 104:2015, single-direction thrust balls, outer diameter x height
_THRUST = {
    "511": Listed(
        10,
        "24x9 26x9 28x9 30x9 35x10 42x11 47x11 52x12 60x13 65x14 70x14 78x16 85x17 90x18 95x18 "
        "100x19 105x19 110x19 120x22 - 135x25 - 145x25 155x25 170x30 180x31 190x31 200x31 215x34 "
        "225x34 240x37 250x37",
    ),
    "512": Listed(
        10,
        "26x11 28x11 32x12 35x12 40x14 47x15 52x16 62x18 68x19 73x20 78x22 90x25 95x26 100x27 "
        "105x27 110x27 115x28 125x31 135x35 - 150x38 - 160x38 170x39 190x45 200x46 215x50 225x51 "
        "240x55 250x56 270x62 280x62",
    ),
    "513": Listed(
        25,
        "52x18 60x21 68x24 78x26 85x28 95x31 105x35 110x35 115x36 125x40 135x44 140x44 150x49 155x50 "
        "- 170x55 - 190x63 210x70 225x75 240x80 250x80 270x87 280x87 300x95 320x105 340x110",
    ),
    "514": Listed(
        25,
        "60x24 70x28 80x32 90x36 100x39 110x43 120x48 130x51 140x56 150x60 160x65 170x68 180x72 "
        "190x77 - 210x85 - 230x95 250x102",
    ),
}


@cache
def tapered() -> dict[str, Sizes]:
    """Return sizes of tapered rollers by series."""
    return {series: listed.read() for series, listed in _TAPERED.items()}


@cache
def thrust() -> dict[str, Sizes]:
    """Return sizes of thrust balls by series."""
    return {series: listed.read() for series, listed in _THRUST.items()}


def _pairs(text: str) -> dict[int, float]:
    """Return numbers from ``bore:number``."""
    pairs = (entry.split(":") for entry in text.split())
    return {int(bore): float(number) for bore, number in pairs}


#: diameter under the needles by the bore of the inner ring: ISO 1206, series 49 and 69, and 48
RACEWAYS = {
    "9": _pairs(
        "10:14 12:16 15:20 17:22 20:25 25:30 30:35 35:42 40:48 45:52 50:58 55:63 60:68 65:72 70:80 "
        "75:85 80:90 85:100 90:105 95:110 100:115 110:125 120:135 130:150 140:160"
    ),
    "8": _pairs("110:120 120:130 130:145 140:155 150:165 160:175 170:185 180:195 190:210 200:220"),
}
#: outer diameter of needle rollers by the diameter under them: of NK and NKI, and of drawn cups
#: (ISO 3245)
NK_OUTER = _pairs(
    "5:10 6:12 7:14 8:15 9:16 10:17 12:19 14:22 15:23 16:24 17:25 18:26 19:27 20:28 21:29 22:30 "
    "24:32 25:33 26:34 28:37 29:38 30:40 32:42 35:45 37:47 38:48 40:50 42:52 43:53 45:55 47:57 "
    "50:62 55:68 60:72 65:78 68:82 70:85 73:90 75:92 80:95 85:105 90:110 95:115 100:120 105:125 "
    "110:130"
)
CUP_OUTER = _pairs(
    "4:8 5:9 6:10 7:11 8:12 9:13 10:14 12:18 13:19 14:20 15:21 16:22 17:23 18:24 20:26 22:28 25:32 "
    "28:35 30:37 35:42 40:47 45:52 50:58 55:63 60:68"
)
#: diameter under the needles by the bore of NKI
NKI_RACEWAY = _pairs(
    "5:8 6:9 7:10 9:12 10:14 12:16 15:19 17:21 20:24 22:26 25:29 28:32 30:35 32:37 35:40 38:43 40:45 "
    "42:47 45:50 50:55 55:60 60:68 65:73 70:80 75:85 80:90 85:95 90:100 95:105 100:110"
)
