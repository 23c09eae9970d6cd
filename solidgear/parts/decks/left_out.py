"""Masses, springs, rigid links, held nodes, beams and shells of a deck: none of them is solved, and
one remark says so.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import NamedTuple

MASS, SPRING, LINK, OTHER = "mass", "spring", "link", "other"


class Sorts(NamedTuple):
    """Patterns of names, by sort."""

    mass: str = ""
    spring: str = ""
    link: str = ""
    other: str = ""


#: by sort: its noun in a sentence, and how a scene writes the same
SORTS = {
    MASS: ("mass", "masses as [[mass]] in kg"),
    SPRING: ("spring", "springs as [[bearing]] with a stiffness"),
    LINK: (
        "constraint",
        'held nodes as [[bearing]] with hold = "clamped", rigid and averaging links as attachment = '
        '"rigid" or "average" of a [[bearing]] or [[port]]',
    ),
    OTHER: ("beam or shell", "beams and shells as solid elements of the file"),
}
#: kinds that a sentence names
NAMED = 8
#: names of cards of Nastran, by sort
CARDS = Sorts(
    mass=r"CONM[12]|CMASS[1-4]|NSM[L1]?1?|NSMADD",
    spring=r"CBUSH[12]?D?|CELAS[1-4]|CDAMP[1-5]|CVISC|CGAP|CFAST|CWELD|CSEAM|DMIG|K2GG|M2GG",
    link=r"RBE[123]|RBE2GS|RBAR1?|RROD|RTRPLT1?|RSPLINE|RSSCON|RJOINT|MPC|SPC1?|SPCD|SUPORT1?|BSURFS|BCTSET|BGSET",
    other=r"CBAR|CBEAM3?|CBEND|CROD|CONROD|CTUBE|CQUAD[48R]?|CTRIA[36R]|CSHEAR|CQUADR|CTRIAR|CSHELL",
)
#: keywords of Abaqus, by sort
KEYWORDS = Sorts(
    mass=r"NONSTRUCTURAL MASS",
    spring=r"CONNECTOR (?:SECTION|BEHAVIOR)|MATRIX INPUT|MATRIX ASSEMBLE",
    link=(
        r"MPC|EQUATION|RIGID BODY|COUPLING|KINEMATIC COUPLING|DISTRIBUTING COUPLING|TIE|BOUNDARY|"
        r"CONTACT PAIR|CONTACT|EMBEDDED ELEMENT|PRE-TENSION SECTION|SHELL TO SOLID COUPLING|FASTENER|"
        r"CYCLIC SYMMETRY MODEL|BASE MOTION"
    ),
)
#: types of elements of Abaqus, by sort; others carry something where a section names them
TYPES = Sorts(
    mass=r"MASS|ROTARYI",
    spring=r"SPRING.*|DASHPOT.*|CONN.*|GAP.*|JOINTC|ITT.*|ITS.*",
    link=r"RB[23]D2|R3D[34]|DCOUP.*",
    other=r"SC[68]R.*|CSS8.*|COH3D.*|CAX.*",
)
#: descriptors of elements of universal files, by sort
DESCRIPTORS = Sorts(
    mass=r"161",
    spring=r"136|137|138|139|14[0-2]|15[12]",
    link=r"121|122",
)
#: datasets of universal files with constraints
DATASETS = r"754|755|756|757|791"


@lru_cache(maxsize=4096)
def sort_of(name: str, patterns: Sorts) -> str | None:
    """Return the sort of a card, keyword or type of element; None for one that carries nothing."""
    pairs = zip(patterns._fields, patterns)
    return next((sort for sort, pattern in pairs if name and re.fullmatch(pattern, name)), None)


@dataclass
class LeftOut:
    """Tally of the parts of a deck beside solid elements."""

    counts: dict[tuple[str, str], int] = field(default_factory=dict)  #: by sort and name
    #: in the unit of the deck, where it gives a number
    masses: list[float] = field(default_factory=list)
    place: tuple[float, ...] | None = None  #: of the first of these, in the unit of the file

    def add(self, sort: str, name: str, count: int = 1) -> None:
        """Count some of one name."""
        if count:
            self.counts[sort, name] = self.counts.get((sort, name), 0) + count

    def weigh(self, masses: Iterable[float], place: Sequence[float] | None = None) -> None:
        """Note masses, and the place of the first of them."""
        self.masses += masses
        if self.place is None and place is not None:
            self.place = tuple(place)

    def remark(self) -> str:
        """Return one sentence on all of it; empty where the deck has nothing but solid elements."""
        if not self.counts:
            return ""
        names = [f"{count} {name}" for (_, name), count in self.counts.items()]
        if len(names) > NAMED:
            names = [*names[:NAMED], f"{len(names) - NAMED} kinds more"]
        sorts = [sort for sort in SORTS if any(kind == sort for kind, _ in self.counts)]
        ways = "; ".join(SORTS[sort][1] for sort in sorts)
        return f"left out, beside solid elements: {', '.join(names)}{self._weight()}; write {ways}"

    def _weight(self) -> str:
        if not self.masses:
            return ""
        location = ""
        if self.place is not None:
            coordinates = ", ".join(f"{value:.5g}" for value in self.place)
            location = (
                f", {'the first ' if len(self.masses) > 1 else ''}at ({coordinates}) of the file"
            )
        return f" (mass {sum(self.masses):.6g} in the unit of the deck{location})"
