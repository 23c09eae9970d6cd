"""Numbers that inputs with an open value leave open: every answer has them beside its error bars."""

from __future__ import annotations

from typing import ClassVar

from solidgear.core.display import Displayed
from solidgear.core.judge.part import Number, Part
from solidgear.core.quantity import Quantity


class InputRecord(Part):
    """An open input: path in the file, source, range in words; of an estimated inside the bearing in
    words, whose maker knows it.
    """

    path: str = ""
    source: str = ""
    said: str = ""
    of: str = ""


class IntervalRecord(Part):
    """Lowest and highest of a number, relative to the value with all inputs as the scene says.

    ``deviation`` is the relative standard deviation where every input is equally likely anywhere in
    its range; None where it was not worked out.
    """

    low: Number = 0.0
    high: Number = 0.0
    deviation: Number = None


class SampledRecord(IntervalRecord):
    """Interval of seeded samples of all inputs together: ends of all, and of 95 % of them."""

    low95: Number = None
    high95: Number = None


class OpenRecord(Part):
    """A number with its interval by every input, by every source and in total.

    ``value`` is that of ``OpenNumbers.model``, SI; couplings are relative to the geometric mean of
    their diagonal entries, as bars are.
    """

    quantity: Quantity = Quantity("")
    value: Number = None
    total: IntervalRecord = IntervalRecord()
    by_source: dict[str, IntervalRecord] = {}
    by_input: dict[str, IntervalRecord] = {}
    sampled: SampledRecord | None = None

    @property
    def shares(self) -> dict[str, float]:
        """Share of every input in the sum of variances, the largest first; empty without any."""
        parts = {path: (interval.deviation or 0.0) ** 2 for path, interval in self.by_input.items()}
        total = sum(parts.values())
        ordered = sorted(parts, key=lambda path: -parts[path])
        return {path: parts[path] / total for path in ordered} if total else {}

    @property
    def width_shares(self) -> dict[str, float]:
        """Share of every input in the sum of squared widths of the ranges by each, the largest first,
        which need no deviations; empty without any.
        """
        parts = {
            path: ((interval.high or 0.0) - (interval.low or 0.0)) ** 2
            for path, interval in self.by_input.items()
        }
        total = sum(parts.values())
        ordered = sorted(parts, key=lambda path: -parts[path])
        return {path: parts[path] / total for path in ordered} if total else {}


class OpenNumbers(Displayed, Part):
    """Open inputs of a scene, and the numbers that they leave open.

    ``lost`` names bearings that carry nothing somewhere in the ranges, ``refused`` says why points
    could not be solved, ``left_out`` why nothing was worked out.
    """

    shown: ClassVar[str] = "show.open_words:budget"

    model: str = ""
    title: str = ""
    inputs: list[InputRecord] = []
    numbers: list[OpenRecord] = []
    points: int = 0
    samples: int = 0
    seed: int | None = None
    lost: list[str] = []
    refused: list[str] = []
    left_out: str = ""

    def of(self, quantity: str) -> OpenRecord | None:
        """Return the entry of a quantity."""
        return next((number for number in self.numbers if number.quantity == quantity), None)
