"""A notch as a rating by DIN 743 sees it: its section, and its factors in a steel."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from solidgear.strength.stress.din743 import Load
from solidgear.strength.stress.rating_lines import Line

ByLoad = Mapping[Load, float]


class Steel(NamedTuple):
    """Strength of a steel at the size of the part, Pa."""

    ultimate: float
    yield_point: float
    hard: bool  #: whether its surface is hard


@dataclass(frozen=True)
class NotchFactors:
    """Fatigue notch factors of a notch, and the lines that lead to them."""

    notch: ByLoad  #: beta
    rise: ByLoad  #: form factor, or beta without one, by which yielding rises
    peak: ByLoad | None  #: form factor for a first crack; none where the norm has tests alone
    lines: tuple[Line, ...]


class RatedNotch(Protocol):
    """A notch as a rating sees it."""

    @property
    def diameter(self) -> float:
        """Diameter of nominal stress and of K_2, m."""

    @property
    def hollow(self) -> bool:
        """Whether the section has a bore."""

    @property
    def revolved(self) -> bool:
        """Whether the notch runs around the shaft, which raises the yield point."""

    @property
    def tested_roughness(self) -> float | None:
        """Rz of the tests behind the factors, m: zero where it is in them, None without tests."""

    def factors(self, steel: Steel) -> NotchFactors:
        """Return the notch factors in a steel."""
