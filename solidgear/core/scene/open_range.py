"""Range of one entry of a scene, as factors on its value."""

from __future__ import annotations

import math
import re

from solidgear.core.errors import SceneError
from solidgear.core.scene.typed import Model
from solidgear.core.scene.units import quantity

#: dimension of entries that are multiplied as a whole, and are no numbers with a unit
FACTOR = "dimensionless"
PLUS_MINUS = re.compile(r"(.*?)(?:±|\+/-|\+-)(.*)", re.S)


class Uncertain(Model):
    """An entry and its range."""

    path: str
    said: str  #: the range as the file states it
    #: low, high: factors on the value of the scene; 1 lies between
    low: float
    high: float

    @property
    def deviation(self) -> float:
        """Standard deviation of the logarithm: ± is taken as one, between two ends all values are
        equally likely.
        """
        spread = math.log(self.high / self.low)
        return spread / (2.0 if PLUS_MINUS.fullmatch(self.said) else math.sqrt(12.0))


def range_ends(text: str, value: float, dimension: str) -> tuple[float, float]:
    """Return the ends of a range about a value, SI."""

    def number(word: str) -> float:
        word = word.strip()
        try:
            return float(word)
        except ValueError:
            return quantity(word, dimension)

    if match := PLUS_MINUS.fullmatch(text):
        middle = number(match[1]) if match[1].strip() else value
        part = match[2].strip()
        share = part.endswith("%")
        deviation = abs(middle) * number(part[:-1]) / 100 if share else number(part)
        return middle - deviation, middle + deviation
    low, colon, high = text.partition(":")
    if not colon:
        raise SceneError('must be two ends such as "3e8 N/m : 6e8 N/m", or "206 GPa ± 3 %"')
    return number(low), number(high)
