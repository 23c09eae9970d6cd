"""The one bearing whose estimated inside leaves most of what is open in a deflection."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np

from solidgear.bearings.catalogue import catalogue_of
from solidgear.bearings.solved import Choice
from solidgear.show.open_words import LEADS, WORTH, led_by
from solidgear.trains.file.train import Train


class Measured(Protocol):
    """A number of deflected shafts with its range."""

    @property
    def name(self) -> str: ...

    @property
    def unit(self) -> str: ...

    @property
    def value(self) -> float: ...

    @property
    def open(self) -> tuple[float, float] | None: ...


#: numbers that are compared at a place in the ranges of the bearings
ValuesAt = Callable[[Choice], np.ndarray]
ENDS = (Choice(end="softer"), Choice(end="stiffer"))


def leading_bearing(train: Train, measured: Sequence[Measured], values_at: ValuesAt) -> str:
    """Return the sentence on a bearing that leads in the number with the widest range; empty where no
    bearing does, or two shafts have bearings of one name.
    """
    scenes = [shaft.scene for shaft in train.shafts.values()]
    bearings = [(b.name, data) for s in scenes for b in s.bearings if (data := catalogue_of(b))]
    names = [name for name, data in bearings if data.estimated]
    widest = _widest(measured)
    if not names or len({*names}) < len(names) or widest is None:
        return ""
    by_class = any(isinstance(data.clearance, str) for _, data in bearings)
    choices = [[Choice(overrides={name: end}) for end in ENDS] for name in names]
    if by_class:
        choices.append([Choice(clearance=place) for place in (0.0, 1.0)])
    shares = np.ones(1)
    if len(choices) > 1:
        values = [[values_at(choice)[widest] for choice in pair] for pair in choices]
        middle = measured[widest].value
        squares = np.array([np.ptp([middle, *pair]) ** 2 for pair in values])
        shares = squares / squares.sum()
    leader = int(np.argmax(shares[: len(names)]))
    if shares[leader] < LEADS:
        return ""
    data = dict(bearings)[names[leader]]
    designation = f" ({data.designation})" if data.designation else ""
    label = f"bearing {names[leader]}{designation}"
    return led_by(label, float(shares[leader]), measured[widest].name)


def _widest(measured: Sequence[Measured]) -> int | None:
    """Return the place of the number with the widest range, lengths against the largest length and
    angles against the largest angle; None where all are narrow.
    """
    widths = np.zeros(len(measured))
    for unit in {m.unit for m in measured}:
        scale = np.linalg.norm([m.value for m in measured if m.unit == unit])
        for k, m in enumerate(measured):
            if m.unit == unit and m.open is not None and scale:
                widths[k] = (m.open[1] - m.open[0]) / scale
    widest = int(np.argmax(widths))
    return widest if widths[widest] >= WORTH else None
