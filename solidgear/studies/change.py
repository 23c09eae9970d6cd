"""A number in two files: what it changes by, and whether that is more than its error bars."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

from solidgear.judge.deviations import resolution


@dataclass(frozen=True)
class Change:
    """A number of one thing beside that of another, in SI.

    Examples
    --------
    >>> one = Change(100.0, 101.0, 0.2, 0.3)
    >>> one.difference, one.band, one.verdict
    (1.0, 0.5, 'resolved')
    >>> Change(100.0, 100.4, 0.2, 0.3).verdict, Change(100.0, 101.0).verdict
    ('not resolved', 'no band')
    """

    a: float
    b: float
    #: bar_a, bar_b: error bars of both, in the unit of the number; None of one that has none
    bar_a: float | None = None
    bar_b: float | None = None

    @property
    def difference(self) -> float:
        """`b` less `a`."""
        return self.b - self.a

    @property
    def relative(self) -> float | None:
        """Of the size of `a`; None where that is zero."""
        return self.difference / abs(self.a) if self.a else None

    @property
    def band(self) -> float | None:
        """Sum of both bars; None unless both are known."""
        return None if self.bar_a is None or self.bar_b is None else self.bar_a + self.bar_b

    @property
    def verdict(self) -> str:
        """``resolved``, ``not resolved`` or ``no band``."""
        return resolution(abs(self.difference), self.band)

    def as_dict(self) -> dict:
        """Plain data that JSON can hold."""
        told = {name: getattr(self, name) for name in ("a", "b", "bar_a", "bar_b")}
        return told | {
            name: getattr(self, name) for name in ("difference", "relative", "band", "verdict")
        }


@dataclass(frozen=True)
class BarredMode:
    """An elastic mode of one of two things."""

    name: str
    frequency_hz: float
    bar: float | None  #: largest relative error of its frequency; None where nothing tells it

    @property
    def width(self) -> float | None:
        """Its error bar, Hz."""
        return None if self.bar is None else self.bar * self.frequency_hz


M = TypeVar("M", bound=BarredMode)


@dataclass(frozen=True)
class ModePair(Generic[M]):
    """A mode of one thing and its partner in the other; either may be missing."""

    a: M | None
    b: M | None
    #: modal assurance criterion of their motions; None for a mode alone, and for modes that belong
    #: together by name
    mac: float | None = None

    @property
    def change(self) -> Change | None:
        """Of the frequency, Hz; None for a mode alone."""
        if self.a is None or self.b is None:
            return None
        return Change(self.a.frequency_hz, self.b.frequency_hz, self.a.width, self.b.width)

    @property
    def verdict(self) -> str | None:
        """That of the change, and what holds the pair together where that is its name alone; None
        for a mode alone.

        Examples
        --------
        >>> one = BarredMode("bending 3", 900.0, 1e-4), BarredMode("bending 3", 660.0, 1e-4)
        >>> ModePair(*one, mac=0.98).verdict, ModePair(*one).verdict
        ('resolved', 'resolved, by name')
        """
        if self.change is None:
            return None
        return self.change.verdict + (", by name" if self.mac is None else "")

    def within(self, highest: float) -> bool:
        """Tell whether either of them lies below a frequency, Hz."""
        return any(m is not None and m.frequency_hz <= highest for m in (self.a, self.b))
