"""What to ask the maker of a bearing: which of its inner data would narrow the range of a number most.

For each of these data the range by the estimated inside is worked out anew with it known, at the
middle of its estimate.  Ratings are in every catalogue and come first; the rest a maker tells on
request.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol

from solidgear.bearings.catalogue import Catalogue, catalogue_of
from solidgear.bearings.catalogued import End
from solidgear.bearings.geometry import inner_geometry
from solidgear.bearings.inside import Inside
from solidgear.bearings.rating import ratings_of_one
from solidgear.bearings.ribs import estimated_stiffness
from solidgear.core import OpenNumbers, Quantity, Scene, SolidgearError
from solidgear.core.judge.open_numbers import OpenRecord
from solidgear.core.judge.part import Part
from solidgear.show.open_words import SHOWN


class Open(Protocol):
    """Open input of a scene."""

    @property
    def path(self) -> str: ...

    @property
    def usual(self) -> float: ...


class Points(Protocol):
    """Numbers of a scene at points of the ranges of its open inputs."""

    scene: Scene

    @property
    def inputs(self) -> Sequence[Open]: ...

    def numbers(self, place: Sequence[float]) -> dict[Quantity, float]: ...

    def with_data(self, bearing: str, **known: Any) -> Points: ...


#: of the variance of a number: an inside with less is no question
ASKED = 0.1
#: of the width of a range: an answer that leaves more is no question
NARROWER = 0.98
#: words for data in a letter to a maker, with the unit
WORDS = {
    "load_rating": ("basic dynamic load rating C", "kN"),
    "static_rating": ("basic static load rating C0", "kN"),
    "elements": ("number of rolling elements in a row", ""),
    "element_diameter": ("diameter of the rolling elements", "mm"),
    "element_length": ("effective length of the rollers", "mm"),
    "pitch_diameter": ("pitch diameter of the rolling elements", "mm"),
    "contact_angle": ("nominal contact angle", "deg"),
    "conformity": ("groove radius over ball diameter, inner and outer ring", ""),
    "rib_stiffness": ("axial stiffness of the ribs", "N/um"),
}
IN_CATALOGUE = ("load_rating", "static_rating")
_SCALE = {"kN": 1e-3, "mm": 1e3, "deg": 180 / math.pi, "N/um": 1e-6, "": 1.0}


class Question(Part):
    """A number that the maker of a bearing knows, and what it narrows."""

    bearing: str = ""  #: name in the scene
    designation: str = ""
    key: str = ""  #: of catalogue data
    asked: str = ""  #: the number in words, with its unit
    low: float | None = None  #: least of the estimate, SI; None where it has two parts
    high: float | None = None
    middle: str = ""  #: the estimate in words
    number: Quantity = Quantity("")  #: whose range it narrows
    width: float = 0.0  #: of the range by the inside, relative
    left: float = 0.0  #: width of that range once this is known, over the width now
    in_catalogue: bool = False


class Candidate(NamedTuple):
    """A number that a maker knows and a scene does not."""

    key: str  #: of catalogue data
    value: Any  #: middle of the estimate, SI
    #: ends of the estimate, SI; None where they say nothing
    ends: tuple[float, float] | None = None

    @property
    def words(self) -> str:
        """The estimate in the unit of a maker."""
        if self.key == "conformity":
            return " and ".join(f"{ratio:.4g}" for ratio in self.value)
        scale = _SCALE[WORDS[self.key][1]]
        middle = f"{scale * self.value:.4g}"
        if self.ends is None or self.ends[0] == self.ends[1]:
            return middle
        return f"{middle} ({scale * self.ends[0]:.4g} to {scale * self.ends[1]:.4g})"


def questions(points: Points, ranges: OpenNumbers, insides: Sequence[int]) -> list[Question]:
    """Return questions to makers: of every bearing whose inside leaves a share of the variance of a
    number that is shown; `insides` are the places of estimated insides among the open inputs.
    """
    out = []
    for index in insides:
        path = points.inputs[index].path
        number = _widest(ranges, path)
        if number is None:
            continue
        name = path.removeprefix("bearing.").removesuffix(".inside")
        data = catalogue_of(next(b for b in points.scene.bearings if b.name == name))
        assert data is not None
        now, of_bearing = _width(number, path), []
        for candidate in _candidates(data):
            width = _width_with(points, index, name, candidate, number.quantity)
            if width is None or width > NARROWER * now:
                continue
            asked, unit = WORDS[candidate.key]
            low, high = candidate.ends or (None, None)
            of_bearing.append(
                Question(
                    bearing=name,
                    designation=data.designation,
                    key=candidate.key,
                    asked=f"{asked}, {unit}" if unit else asked,
                    low=low,
                    high=high,
                    middle=candidate.words,
                    number=number.quantity,
                    width=now,
                    left=width / now,
                    in_catalogue=candidate.key in IN_CATALOGUE,
                )
            )
        out += sorted(of_bearing, key=lambda question: (not question.in_catalogue, question.left))
    return out


def _widest(ranges: OpenNumbers, path: str) -> OpenRecord | None:
    """Return the number that is shown and of which an input leaves most open; None where it leaves
    little of every one.
    """
    shown = [n for name in SHOWN if (n := ranges.of(name)) is not None]
    shown = [n for n in shown if n.width_shares.get(path, 0.0) >= ASKED and _width(n, path)]
    return max(shown, key=lambda n: _width(n, path), default=None)


def _width(number: OpenRecord, path: str) -> float:
    interval = number.by_input[path]
    return (interval.high or 0.0) - (interval.low or 0.0)


def _candidates(data: Catalogue) -> list[Candidate]:
    """Return data that a maker knows and the scene does not."""
    geometry = inner_geometry(data)
    out = []
    # balls are estimated from C, rollers from C0
    rating = ratings_of_one(data, geometry.middle)
    if data.balls and data.load_rating is None:
        out.append(Candidate("load_rating", rating.dynamic))
    if not data.balls and data.static_rating is None and data.load_rating is None:
        out.append(Candidate("static_rating", rating.static))
    for key in data.estimated:
        if key == "conformity":
            out.append(Candidate(key, geometry.middle.conformity))
            continue
        value = _of(geometry.middle, key, "middle")
        # fewer balls are larger, but not between the ends where their number is rounded
        ends = [value, _of(geometry.softer, key, "softer"), _of(geometry.stiffer, key, "stiffer")]
        out.append(Candidate(key, value, (min(ends), max(ends))))
    return out


def _of(inside: Inside, key: str, end: End) -> float:
    """Return a number of an inside by the key of catalogue data."""
    if key == "rib_stiffness":
        return estimated_stiffness(inside, end)
    numbers = {
        "elements": inside.elements,
        "element_diameter": inside.diameter,
        "element_length": inside.length,
        "pitch_diameter": inside.pitch,
        "contact_angle": inside.angle,
    }
    return numbers[key]


def _width_with(
    points: Points, index: int, bearing: str, candidate: Candidate, quantity: Quantity
) -> float | None:
    """Return the width of the range of a number by an inside of which one number more is known; None
    where no bearing has that one.
    """
    usual = [i.usual for i in points.inputs]
    values = []
    try:
        known = points.with_data(bearing, **{candidate.key: candidate.value})
        for place in (0.0, 0.5, 1.0):
            values.append(known.numbers([*usual[:index], place, *usual[index + 1 :]])[quantity])
    except (SolidgearError, KeyError):
        return None
    return (max(values) - min(values)) / abs(values[1])
