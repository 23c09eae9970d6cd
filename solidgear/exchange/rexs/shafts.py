"""Shafts of a REXS document: sections end to end along y, and what a place on them is."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Collection
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solidgear.exchange.rexs.document import Component, Document, RexsError
from solidgear.exchange.rexs.frames import Frame
from solidgear.exchange.rexs.notes import Notes

#: gap between sections, m, that digits leave, and that lengths and places in tenths of a millimetre do
TOUCH, ROUNDED_GAP = 1e-6, 1e-4
#: letters of a name, and of one that a file had before
LONGEST, MOST_LETTERS = 32, 100


@dataclass(frozen=True)
class Section:
    """A piece of a shaft between two places along y, with diameters at both, m."""

    component: Component
    y0: float
    y1: float
    outer: tuple[float, float]
    inner: tuple[float, float]

    @property
    def length(self) -> float:
        """Length along the shaft, m."""
        return self.y1 - self.y0

    @property
    def volume(self) -> float:
        """Volume, m^3."""
        rings = [_frustum(*self.outer), _frustum(*self.inner)]
        return np.pi / 4 * self.length * (rings[0] - rings[1])

    def outer_at(self, y: float) -> float:
        """Return the outer diameter at a place, m."""
        share = (y - self.y0) / self.length
        return self.outer[0] + share * (self.outer[1] - self.outer[0])


def _frustum(start: float, end: float) -> float:
    return (start * start + start * end + end * end) / 3


@dataclass(frozen=True)
class Shaft:
    """A shaft: sections in the order of y."""

    name: str
    component: Component
    sections: tuple[Section, ...]
    frame: Frame | None
    #: 1, or -1 where it runs against the first shaft of the train and is turned end for end
    sign: int
    turn: np.ndarray  #: (3, 3), from u, v, w of the shaft to x, y, z of its scene
    first: float  #: u of the beginning of the first section, m

    @property
    def length(self) -> float:
        """Length, m."""
        return self.sections[-1].y1

    def place(self, u: float) -> float:
        """Return the place y of a coordinate u on the shaft, m."""
        y = u - self.first
        return y if self.sign > 0 else self.length - y

    @cached_property
    def runs(self) -> list[tuple[float, float]]:
        """Ends of the surfaces between steps of the outer diameter, m."""
        cuts = [0.0]
        for before, after in zip(self.sections, self.sections[1:]):
            if abs(before.outer[1] - after.outer[0]) > TOUCH:
                cuts.append(before.y1)
        cuts.append(self.length)
        return list(zip(cuts, cuts[1:]))

    def seat(self, y: float, width: float) -> tuple[float, float] | None:
        """Return the ends of a seat around a place: as wide as asked for where no step is nearer, with
        its middle there if it can be; None off the shaft.
        """
        if not -TOUCH <= y <= self.length + TOUCH:
            return None
        y = min(max(y, 0.0), self.length)
        run = max((r for r in self.runs if r[0] <= y <= r[1]), key=lambda r: r[1] - r[0])
        half = min(width / 2, y - run[0], run[1] - y)
        if half < width / 8:
            # at a step or an end face: all that lies on this side
            return max(run[0], y - width / 2), min(run[1], y + width / 2)
        return y - half, y + half

    def span(self, y: float, width: float) -> tuple[float, float] | None:
        """Return the ends of the longest smooth surface under a face; None off the shaft."""
        pieces = [
            (max(lo, y - width / 2), min(hi, y + width / 2))
            for lo, hi in self.runs
            if min(hi, y + width / 2) - max(lo, y - width / 2) > TOUCH
        ]
        return max(pieces, key=lambda piece: piece[1] - piece[0], default=None)

    def mean_outer(self, lo: float, hi: float) -> float:
        """Return the diameter of the cylinder of as much volume as the shaft has between places, m."""
        squares = weight = 0.0
        for section in self.sections:
            a, b = max(lo, section.y0), min(hi, section.y1)
            if b > a:
                squares += (b - a) * _frustum(section.outer_at(a), section.outer_at(b))
                weight += b - a
        return float(np.sqrt(squares / weight)) if weight else 0.0


def sections_of(
    document: Document, shaft: Component, sign: int, notes: Notes
) -> tuple[list[Section], float]:
    """Return the sections of a shaft in the order of y, and u where they begin, m; note gaps that are
    closed, and sections without a bore.

    Raises
    ------
    RexsError
        No section, a length or diameters that no section has, a gap, or two in one place.
    """
    parts = document.parts_of(shaft, "shaft_section")
    if not parts:
        raise RexsError(f"{shaft.label}: has no shaft_section, and nothing says how thick it is")
    pieces, end = [], 0.0
    for part in parts:
        length = _size(part, "length")
        start = part.number("u_coordinate_on_shaft")
        start = end if start is None else start
        end = start + length
        inner = _ends(part, "inner")
        if any(part.number(f"inner_diameter_{end}") is None for end in ("begin", "end")):
            notes.assume(part, "has no bore where no inner_diameter is given")
        pieces.append((start, end, part, _ends(part, "outer"), inner))
    pieces.sort(key=lambda piece: piece[0])
    for k, (before, after) in enumerate(zip(pieces, pieces[1:])):
        gap = after[0] - before[1]
        if TOUCH < abs(gap) <= ROUNDED_GAP < after[0] - before[0]:
            way = "before" if gap > 0 else "behind"
            notes.doubt(
                before[2],
                f"ends {1e3 * abs(gap):.6g} mm {way} the place where {after[2].title} begins: it is "
                "made to end there",
            )
            pieces[k] = (before[0], after[0], *before[2:])
        elif abs(gap) > TOUCH:
            kind = "leaves a gap of" if gap > 0 else "overlaps by"
            raise RexsError(
                f"{after[2].label} of {shaft.label}: begins at {1e3 * after[0]:.6g} mm and "
                f"{kind} {1e3 * abs(gap):.6g} mm with {before[2].label}; sections lie end to end"
            )
    first, last = pieces[0][0], pieces[-1][1]
    sections = []
    for start, end, part, outer, inner in pieces:
        y0, y1 = start - first, end - first
        if sign < 0:
            y0, y1, outer, inner = last - end, last - start, outer[::-1], inner[::-1]
        sections.append(Section(part, y0, y1, outer, inner))
    return sections[::sign], first


def _ends(part: Component, side: str) -> tuple[float, float]:
    """Return the outer or inner diameters of a section at both ends, m."""
    names = [f"{side}_diameter_{end}" for end in ("begin", "end")]
    sizes = [part.number(name) for name in names]
    if side == "outer":
        if None in sizes:
            raise part.wrong(names[sizes.index(None)], "is missing; a section needs its diameter")
        inner = _ends(part, "inner")
        for name, size, bore in zip(names, sizes, inner):
            if not (size or 0.0) > bore >= 0:
                raise part.wrong(name, f"must be larger than the bore there, {1e3 * bore:.6g} mm")
    return sizes[0] or 0.0, sizes[1] or 0.0


def _size(part: Component, name: str) -> float:
    size = part.number(name)
    if size is None or size <= 0:
        raise part.wrong(name, "is missing" if size is None else "must be greater than zero")
    return size


def is_file_name(name: str) -> bool:
    """Return True for a name after which a file of a folder can be called, wherever it is.

    Examples
    --------
    >>> is_file_name("input shaft 2"), is_file_name("../input")
    (True, False)
    """
    return len(name) <= MOST_LETTERS and re.fullmatch(r"\w[\w ()+-]*", name) is not None


def plain_name(text: str, taken: Collection[str], usual: str, longest: int = LONGEST) -> str:
    """Return a name for a file of TOML and for command lines: letters, digits and underscores.

    Examples
    --------
    >>> plain_name("Planetenträger [3]", (), "shaft")
    'planetentrager_3'
    """
    letters = unicodedata.normalize("NFKD", text.lower()).encode("ascii", "ignore").decode()
    name = re.sub(r"[^a-z0-9]+", "_", letters).strip("_") or usual
    if len(name) > longest:
        name = name[:longest].rpartition("_")[0] or name[:longest]
    number, unique = 2, name
    while unique in taken:
        unique, number = f"{name}_{number}", number + 1
    return unique
