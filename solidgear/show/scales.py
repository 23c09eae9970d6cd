"""Axes of a panel: where numbers stand along them, and what their ticks say."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

#: px; of paper that a tick of a linear axis has at least
SPACED = 75.0
PREFIXES = {-6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}


def number(value: float) -> str:
    """Return a number as a tick says it.

    Examples
    --------
    >>> number(-0.5), number(2e6), number(1e-5)
    ('−0.5', '2000000', '1e−5')
    """
    text = (
        f"{value:.6g}"
        if abs(value) < 1e6
        else f"{value:.0f}"
        if abs(value) < 1e9
        else f"{value:.3g}"
    )
    mantissa, _, exponent = text.partition("e")
    return (f"{mantissa}e{int(exponent)}" if exponent else mantissa).replace("-", "−")


def in_percent(value: float) -> str:
    """Return a share as a tick says it."""
    return f"{number(100 * value)} %"


def with_prefix(value: float) -> str:
    """Return a number with the prefix of its power of a thousand.

    Examples
    --------
    >>> with_prefix(200), with_prefix(20000)
    ('200', '20k')
    """
    power = 3 * math.floor(math.log10(abs(value)) / 3 + 1e-9) if value else 0
    power = min(max(power, min(PREFIXES)), max(PREFIXES))
    return number(value / 10.0**power) + PREFIXES[power]


class Axis(NamedTuple):
    """One axis of a panel."""

    title: str
    ends: tuple[float, float]  #: from left to right, or from the foot up
    log: bool = False
    label: Callable[[float], str] = number  #: what a tick says
    ticks: Mapping[float, str] | None = None  #: where they stand and what they say instead
    grid: bool = True
    shown: bool = True  #: of one that is not shown only the ends count

    def share(self, value: float) -> float:
        """Return the place of a value, from 0 at the first end to 1."""
        first, last = self.ends
        if self.log:
            return math.log(value / first) / math.log(last / first)
        return (value - first) / (last - first)

    def marks(self, room: float) -> list[tuple[float, str]]:
        """Return values of ticks on paper so long (px), and what each says."""
        low, high = sorted(self.ends)
        if self.ticks is not None:
            near = 1e-9 * (high - low)
            return [(v, text) for v, text in self.ticks.items() if low - near <= v <= high + near]
        if self.log:
            places = log_ticks(low, high)
        else:
            places = linear_ticks(low, high, max(3, int(room / SPACED)))
        return [(value, self.label(value)) for value in places]


def linear_ticks(low: float, high: float, about: int) -> list[float]:
    """Return about so many round numbers between two ends.

    Examples
    --------
    >>> linear_ticks(-0.3, 2.1, 5)
    [0.0, 0.5, 1.0, 1.5, 2.0]
    """
    step = (high - low) / about
    decade = 10.0 ** math.floor(math.log10(step))
    rest = step / decade
    # the round number nearest by ratio
    step = decade * next(n for n, most in ((1, 2), (2, 10), (5, 50), (10, 1e3)) if rest**2 < most)
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [round(k * step, 12 - math.floor(math.log10(step))) for k in range(first, last + 1)]


def log_ticks(low: float, high: float) -> list[float]:
    """Return powers of ten between two ends, with their doubles and fives where these are few.

    Examples
    --------
    >>> log_ticks(0.05, 300)
    [0.1, 1.0, 10.0, 100.0]
    >>> log_ticks(3, 60)
    [5.0, 10.0, 20.0, 50.0]
    >>> log_ticks(2, 5.5)
    [2.0, 3.0, 4.0, 5.0]
    """
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    span = math.log10(high / low)
    steps = (1, 1.5, 2, 3, 4, 5, 7) if span < 0.7 else (1, 2, 5) if span < 2.4 else (1,)
    places = (float(f"{step}e{k}") for k in decades for step in steps)
    return [place for place in places if low <= place <= high]


def rgb(colour: str) -> np.ndarray:
    """Return red, green and blue of a colour, each up to 255.

    Examples
    --------
    >>> rgb("#ff8000").tolist()
    [255, 128, 0]
    """
    return np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)])


class Shade(NamedTuple):
    """Colours of the numbers of a key of the rows, on a logarithmic scale."""

    key: str
    ends: tuple[float, float]
    colours: tuple[str, ...]  #: from the first end to the last, evenly
    title: str = ""
    #: what its legend says and how long it is, px; no legend without ticks
    ticks: Mapping[float, str] | None = None
    length: float = 250.0

    def colour(self, value: float) -> str:
        """Return the colour of a number; beyond an end that of the end."""
        low, high = self.ends
        share = math.log(min(max(value, low), high) / low) / math.log(high / low)
        place = share * (len(self.colours) - 1)
        k = min(int(place), len(self.colours) - 2)
        first, second = map(rgb, self.colours[k : k + 2])
        mixed = np.rint(first + (place - k) * (second - first)).astype(int)
        return "#" + "".join(f"{part:02x}" for part in mixed)


#: from light to dark: yellow, orange, red; and viridis
HEAT = (
    *("#fee087", "#fecc6a", "#feb351", "#fd9640", "#fc7335"),
    *("#f64a29", "#e62822", "#cf0f21", "#af0225"),
)
VIRIDIS = (
    *("#440154", "#482878", "#3e4a89", "#31688e", "#26828e"),
    *("#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725"),
)
#: displacements of shapes, as many as `uRamp` in viewer.js has: viridis, sampled, without its darkest
#: part, on which neither shading nor lines can be seen
MOTION = (
    *("#46307e", "#424186", "#3b518b", "#34608d", "#2e6d8e", "#297a8e"),
    *("#24878e", "#1f948c", "#1fa188", "#27ad81", "#3aba76", "#54c568"),
    *("#70cf57", "#93d741", "#b8de29", "#dde318", "#fde725"),
)
#: shares of the faces of a surface: YlOrRd of nine colours, by Cynthia Brewer, colorbrewer2.org
YLORRD = (
    *("#ffffcc", "#ffeda0", "#fed976", "#feb24c", "#fd8d3c", "#fc4e2a"),
    *("#e31a1c", "#bd0026", "#800026"),
)
