"""Entries that are to be found: where they begin, their bounds, and their prior values."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from solidgear.core import DIMENSIONS, SceneError, SolidgearError, show
from solidgear.core.scene.open_range import FACTOR, PLUS_MINUS, Uncertain, range_ends
from solidgear.core.scene.paths import Keys, Tables, entry, keys_of, label_of
from solidgear.core.scene.units import quantity
from solidgear.variants.sweep.entries import in_si


@dataclass(frozen=True)
class Varied:
    """An entry of a scene file; logarithms are of the value over that in the file."""

    keys: Keys
    label: str  #: its path
    before: float  #: in the file, SI
    #: low, high: bounds of the logarithm
    low: float = -math.inf
    high: float = math.inf
    #: middle, deviation: of the logarithm, as it is known beforehand; an infinite deviation where
    #: it is not
    middle: float = 0.0
    deviation: float = math.inf

    @property
    def begin(self) -> float:
        """Logarithm at which a search begins."""
        return min(max(self.middle, self.low), self.high)

    @property
    def prior(self) -> tuple[float, float] | None:
        """Prior value, and the deviation of the logarithm."""
        if math.isinf(self.deviation):
            return None
        return self.before * math.exp(self.middle), self.deviation


def varied_of(
    texts: Iterable[str], tables: Tables, ranges: Sequence[Uncertain] | None = None
) -> tuple[Varied, ...]:
    """Return entries of ``PATH``, ``PATH=180 GPa : 220 GPa`` (bounds) and ``PATH=206 GPa ± 3 %`` (a
    value that is known to one standard deviation); ranges of the scene hold where a text gives
    none.
    """
    entries = [_varied(text, tables, ranges or ()) for text in texts]
    if not entries:
        raise SolidgearError('nothing is varied; give for example --vary "material.E"')
    if len({entry.keys for entry in entries}) < len(entries):
        raise SolidgearError("--vary: the same entry is given twice")
    bounded = any(math.isfinite(entry.high) or math.isfinite(entry.deviation) for entry in entries)
    if ranges is not None and not bounded:
        raise SolidgearError("--priors: [uncertain] of the file has no range for a varied entry")
    return tuple(entries)


def _varied(text: str, tables: Tables, ranges: Sequence[Uncertain]) -> Varied:
    path, equals, range_text = (part.strip() for part in text.partition("="))
    try:
        keys = keys_of(path, tables)
        value = entry(keys, tables)
        before = in_si(value)
        if value is None:
            raise SceneError("is not in the file, where the search takes its first value from")
        if before is None or not before > 0:
            raise SceneError(
                f"is {show(value, 40)} in the file; identify needs a number above zero to begin "
                "with"
            )
        label = label_of(keys, tables)
        if equals:
            low, high = sorted(range_ends(range_text, before, _dimension(value, range_text)))
            return _with_range(Varied(keys, label, before), range_text, low / before, high / before)
    except SceneError as error:
        raise SolidgearError(f"--vary {text}: {error}") from None
    out = Varied(keys, label, before)
    for stated in ranges:
        # a range of all of a bearing's stiffness is one of each entry
        if f"{label}.".startswith(f"{stated.path}."):
            return _with_range(out, stated.said, stated.low, stated.high)
    return out


def _with_range(entry: Varied, range_text: str, low: float, high: float) -> Varied:
    """Return the entry with a range, times the value in the file."""
    if not 0 < low < high:
        raise SceneError(
            'must be two ends above zero such as "180 GPa : 220 GPa", or a value and its standard '
            'deviation, which is less than the value, such as "206 GPa ± 3 %"',
            value=show(range_text),
        )
    a, b, middle = (math.log(factor) for factor in (low, high, (low + high) / 2))
    if PLUS_MINUS.fullmatch(range_text):
        return Varied(entry.keys, entry.label, entry.before, middle=middle, deviation=(b - a) / 2)
    if not a <= 0 <= b:
        raise SceneError(
            f"bounds must contain the file's value, {entry.before:.6g} in SI, where the search "
            "begins",
            value=show(range_text),
        )
    return Varied(entry.keys, entry.label, entry.before, low=a, high=b)


def _dimension(value: object, range_text: str) -> str:
    """Return the dimension of an entry, by the unit or, where the file has a plain number, by that
    of a range.
    """
    for word in (value, *PLUS_MINUS.sub(r"\1:\2", range_text).split(":")):
        for name in DIMENSIONS if isinstance(word, str) else ():
            try:
                quantity(word, name)
            except SceneError:
                continue
            if name != FACTOR:
                return name
    return FACTOR
