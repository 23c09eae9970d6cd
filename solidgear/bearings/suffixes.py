"""Suffixes of designations as SKF, Schaeffler (FAG, INA), NSK, NTN, Timken and NKE write them.

A suffix stands with or without separators: ``2RS1/C3``, ``-2RSR-C3``, ``DDUC3``, ``BECBP``.  It is
split into as few pieces as possible, all of which have to be known.  Most of them say nothing of a
stiffness; a class of clearance, a contact angle, a pair and a tapered bore do.
"""

from __future__ import annotations

import re
from functools import cache
from typing import NamedTuple

#: patterns of pieces by what they say, in the order in which a refusal names them
IGNORED = {
    "seals": r"[24]?(?:[EH]?RS|BRS)[12HJLR]?\d?|2?RSH2|2?RZ2?|2?LS|2?ELS|2?CS[25]?|2?RD|2?RST|"
    r"LL[UBHCJ]|L[UBH]|DDU|DU|DDW?|2?NSE|2?NSL|PP|EE",
    "shields": r"2?Z|ZZ|2?ZR|ZZE|2?ZE|VV|V",
    "cages": r"J[12NAEP]?|JPA?|TN[9GH]?|TNHA?|T[2XB]?|T2X|T1X?|TVHB?|TVP[2B]?|P?TVPA|PVPA\d?|PV|TV|TPA|TB|TYN|TR|"
    r"T85|M[1-9ABPG]?|M[AP]\d?A?|M1[ABC]|MPA|MPB|MBS?|F[1APS]?|FSA|Y|W|PH?A?|PHS|ML|MLM?|L1?|G1|CY",
    "design": r"E[1-7]?|EA\d?|E1A|EC[AJMP]?|ECML|ECMP|ECNM?L?|ECPH?A?|ECJ|ET2X?|EG15?|EM\d?|EW|EJ|"
    r"XL|XLIFE|X|A\d?|B[1-9]?|BE[AP]?|C|CC[AJ]?|C[AD]|CAM|CCK?|D1?|DH|HPS|S|I|R|U|UU?A?|VJ?202|N2?R?|"
    r"N[1-6]|NX|W2[06]|W33X?|SW33|W64\w?|H[1-5]?|BD|BTN9?|CTN9?|Q|QR|QU|AS|ASR1|IS1|EK4",
    "precision": r"P(?:0|2|3|4|4A|4B|4S|5|5A|6|6A|6E|6X|7|A7|A9A?)|SP|UP|CL[0-7][A-D]?|CLN|QCL7[A-D]?|"
    r"CL7CVA\d*|Q[EO0]\d+|Q6[0-6]|R\d+(?:X|-)?\d*",
    "heat treatment": r"S[0-4]|SN|TS[2-4]|HT|HA[1-7]?|HB[1-4]|HE\d?|HV|L4B|L5B?|TM|TF|TL",
    "grease": r"GJ[NP]?|WT[A-F]?\d?|MT[34][37][A-F]?\d?|LT\d*[A-F]?|LHT\d*|HT\d{2}|GE2?|GWB?|VT\d+|"
    r"TT|L\d{2,3}|2AS|5[CK]|SRL?|NS7S?|AV2S?|GNP\d*|SDL\d*|G42|MB1",
    "variants": r"V[ABCEGKLMQXZ]\d+[A-Z]?\d*|T[45]\d[A-F]?[A-Z]?|DA|ZW|FB|J20[A-Z]+|L2\d\d|K13|2S|BKL|"
    r"HLC|HNA|ULTAGE",
    "universal matching": r"G[ABCDLM]?|C[BC]|[SD]U[LMH]?|U[AOLM]|DUL?|DGA?|DG[ABC]",
}
#: pieces that a stiffness knows
CLASSES = "C1|C2|CN|C0|C3|C4|C5|CM"
#: a tolerance and a class of clearance in one
BOTH = r"P[456]E?[2-5]"
TAPERED_BORE = "K|K30"
PAIR = r"Q?D(?P<way>[BFT])[ABCLMH]?(?:C\d+(?:-\d+)?)?"
#: a contact angle in degrees, where the bearing is an angular contact ball bearing of one row or two
ANGLES = {
    "angular_contact": {
        **dict.fromkeys(("C", "CD", "CE", "CTA", "UC", "UCG"), 15.0),
        "FB": 18.0,
        **dict.fromkeys(("AC", "ACD", "ACE", "A5", "UAD"), 25.0),
        **dict.fromkeys(("A", "AW"), 30.0),
        **dict.fromkeys(("B", "BE", "BEA", "BW", "BG", "BEP"), 40.0),
    },
    "spindle": {"C": 15.0, "AC": 25.0, "E": 25.0},
    "double_row_angular": {"B": 25.0, "BD": 30.0, "A": 30.0, "E": 30.0},
    # 1.5 tan a = 0.55 and 0.83, which ISO 355 calls angle series 5 and 7; NSK writes C and D
    "tapered": {
        **dict.fromkeys(("B", "BJ2", "BR", "C", "CJ"), 20.1),
        **dict.fromkeys(("D", "DJ", "DA", "DJ2"), 28.8),
    },
}
#: what a stiffness would have to know and does not
UNKNOWN = {
    r"HC\d?|HN\d|5S": "has ceramic elements, which are stiffer than steel and not modelled",
}
_WAYS = {"B": "back_to_back", "F": "face_to_face", "T": "tandem"}
_SEPARATORS = r"[\s/\-_,.]+"


class Suffixes(NamedTuple):
    """What the suffixes of a designation say."""

    ignored: tuple[str, ...] = ()  #: pieces that have no part in a stiffness
    classes: tuple[str, ...] = ()  #: classes of clearance
    angle: float | None = None  #: contact angle, degrees
    arrangement: str | None = None  #: of a matched pair
    tapered_bore: bool = False
    unread: str = ""  #: what is not known
    reason: str = ""  #: why a piece that is known cannot be taken


#: kinds of pieces, the first that fits
_PIECES = {
    "class": CLASSES,
    "both": BOTH,
    "bore": TAPERED_BORE,
    "pair": PAIR,
    "unknown": "|".join(UNKNOWN),
    "ignored": "|".join(IGNORED.values()),
}


@cache
def _patterns() -> dict[str, re.Pattern]:
    """Return compiled patterns; files without a designation need none."""
    return {what: re.compile(pattern) for what, pattern in _PIECES.items()}


def read_suffixes(text: str, kind: str) -> Suffixes:
    """Read what stands behind the number of a designation of some kind of bearing.

    Examples
    --------
    >>> result = read_suffixes("-2RS1/C3", "deep_groove")
    >>> result.ignored, result.classes
    (('2RS1',), ('C3',))
    >>> read_suffixes("BECBP", "angular_contact").angle
    40.0
    >>> read_suffixes("-XYZ", "deep_groove").unread
    'XYZ'
    """
    angles = ANGLES.get(kind, {})
    pieces: list[str] = []
    chunks = [chunk for chunk in re.split(_SEPARATORS, text.upper()) if chunk]
    result = Suffixes()
    for k, chunk in enumerate(chunks):
        first = tuple(angles) if k == 0 else ()
        split, left = _split(chunk, first)
        if left:
            return result._replace(unread=left)
        pieces += split
    if pieces and pieces[0] in angles:
        result = result._replace(angle=angles[pieces[0]])
        if kind in ("angular_contact", "spindle"):
            del pieces[0]
    for piece in pieces:
        result = _with(result, piece)
    return result


def _with(result: Suffixes, piece: str) -> Suffixes:
    """Return what suffixes say with one more piece."""
    what = _what(piece)
    if what == "class":
        return result._replace(classes=(*result.classes, "CN" if piece == "C0" else piece))
    if what == "both":
        ignored = (*result.ignored, piece[:-1])
        return result._replace(classes=(*result.classes, f"C{piece[-1]}"), ignored=ignored)
    if what == "bore":
        return result._replace(tapered_bore=True)
    if what == "pair":
        match = _patterns()["pair"].fullmatch(piece)
        assert match
        return result._replace(arrangement=_WAYS[match["way"]])
    if what == "unknown":
        reason = next(why for pattern, why in UNKNOWN.items() if re.fullmatch(pattern, piece))
        return result._replace(reason=f"{piece} {reason}")
    return result._replace(ignored=(*result.ignored, piece))


def _what(piece: str) -> str:
    """Return the kind of a piece; empty for one that is not known."""
    return next((what for what, pattern in _patterns().items() if pattern.fullmatch(piece)), "")


def _split(chunk: str, first: tuple[str, ...]) -> tuple[list[str], str]:
    """Return the fewest known pieces of a chunk, `first` among them at its beginning, and what is left
    where it has none.
    """
    # the fewest pieces to every place that known pieces reach
    ways: dict[int, list[str]] = {0: []}
    for start in range(len(chunk)):
        if start not in ways:
            continue
        for end in range(len(chunk), start, -1):
            piece = chunk[start:end]
            # single letters anywhere would read every word; 2RS1KTN9 is usual
            placed = end - start > 1 or start == 0 or end == len(chunk) or piece == "K"
            known = (placed and _what(piece)) or (start == 0 and piece in first)
            if known and (end not in ways or len(ways[start]) + 1 < len(ways[end])):
                ways[end] = [*ways[start], piece]
    if len(chunk) in ways:
        return ways[len(chunk)], ""
    return [], chunk[max(ways) :] if max(ways) > 1 else chunk
