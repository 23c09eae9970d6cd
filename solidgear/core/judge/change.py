"""A number in two files: the change, and whether that is more than its error bars."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from solidgear.core.judge.deviations import resolution


@dataclass(frozen=True)
class Change:
    """A number of one design beside that of another, in SI.

    Examples
    --------
    >>> change = Change(100.0, 101.0, 0.2, 0.3)
    >>> change.difference, change.band, change.verdict
    (1.0, 0.5, 'resolved')
    >>> Change(100.0, 100.4, 0.2, 0.3).verdict, Change(100.0, 101.0).verdict
    ('not resolved', 'no band')
    """

    plain_names = ("a", "b", "bar_a", "bar_b", "difference", "relative", "band", "verdict")

    a: float
    b: float
    #: error bars of both, in the unit of the number; None without one
    bar_a: float | None = None
    bar_b: float | None = None

    @property
    def difference(self) -> float:
        """`b` less `a`."""
        return self.b - self.a

    @property
    def relative(self) -> float | None:
        """Difference over the size of `a`; None where that is zero."""
        return self.difference / abs(self.a) if self.a else None

    @property
    def band(self) -> float | None:
        """Sum of both error bars; None unless both are known."""
        return None if self.bar_a is None or self.bar_b is None else self.bar_a + self.bar_b

    @property
    def verdict(self) -> str:
        """``resolved``, ``not resolved`` or ``no band``."""
        return resolution(abs(self.difference), self.band)


@dataclass(frozen=True)
class BarredMode:
    """An elastic mode with the error bar of the frequency."""

    name: str
    frequency_hz: float
    bar: float | None  #: largest relative error of the frequency; None where it is unknown

    @property
    def width(self) -> float | None:
        """Error bar of the frequency, Hz."""
        return None if self.bar is None else self.bar * self.frequency_hz


M = TypeVar("M", bound=BarredMode)


@dataclass(frozen=True)
class ModePair(Generic[M]):
    """A mode of one design and the partner in another; either may be missing."""

    plain_names = ("a", "b", "mac", ("frequency", "change"))

    a: M | None
    b: M | None
    #: modal assurance criterion of their motions; None for a mode alone, and for modes paired by
    #: name
    mac: float | None = None

    @property
    def change(self) -> Change | None:
        """Change of the frequency, Hz; None for a mode alone."""
        if self.a is None or self.b is None:
            return None
        return Change(self.a.frequency_hz, self.b.frequency_hz, self.a.width, self.b.width)

    @property
    def verdict(self) -> str | None:
        """Verdict on the change, with ``by name`` where names alone pair the modes; None for a mode
        alone.

        Examples
        --------
        >>> a, b = BarredMode("bending 3", 900.0, 1e-4), BarredMode("bending 3", 660.0, 1e-4)
        >>> ModePair(a, b, mac=0.98).verdict, ModePair(a, b).verdict
        ('resolved', 'resolved, by name')
        """
        if self.change is None:
            return None
        return self.change.verdict + (", by name" if self.mac is None else "")

    def within(self, highest: float) -> bool:
        """Return True where either mode lies below a frequency, Hz."""
        return any(m is not None and m.frequency_hz <= highest for m in (self.a, self.b))


@dataclass(frozen=True, eq=False)
class Side:
    """A train or shaft of a comparison of two."""

    letter: str  #: ``A`` or ``B``
    name: str
    cautions: tuple[str, ...]

    @property
    def label(self) -> str:
        """Letter and name, as in legends."""
        return f"{self.letter}: {self.name}"

    @property
    def title(self) -> str:
        """Title of the file; by default the name."""
        return self.name


def all_pairs(
    same_shape: Sequence[ModePair[M]],
    first: Sequence[M],
    second: Sequence[M],
    label: Callable[[M], str],
    highest: float = math.inf,
) -> list[ModePair[M]]:
    """Return all modes of two lists, both by ascending frequency, paired by shape, else by `label`
    up to a frequency `highest`, Hz, or alone.
    """
    waiting: dict[str, list[M]] = {}
    for mode in second:
        if mode.frequency_hz <= highest and mode not in [p.b for p in same_shape]:
            waiting.setdefault(label(mode), []).append(mode)
    out = [*same_shape]
    for mode in first:
        if mode not in [p.a for p in same_shape]:
            named = waiting.get(label(mode)) if mode.frequency_hz <= highest else None
            out.append(ModePair(mode, named.pop(0) if named else None))
    out += [ModePair(None, mode) for mode in second if mode not in [p.b for p in out]]
    return sorted(out, key=lambda p: (p.a or p.b).frequency_hz)  # type: ignore[union-attr]  # never both
