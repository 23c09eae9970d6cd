"""Builder options come from people: one place that refuses nonsense in a sentence."""

from __future__ import annotations

import math
from numbers import Integral, Real

from solidgear.errors import SolidgearError


def number(model: str, name: str, value, *, above: float | None = None, least: float | None = None, below: float | None = None, whole: bool = False):
    """A number within limits, or one sentence.

    Parameters
    ----------
    model, name : str
        Of the builder and its option, for the sentence.
    value : object
        None is passed through: the builder's default.
    above, least, below : float, optional
        Limits; ``least`` may be met, the others not.
    whole : bool
        Whether it must be an integer.

    Raises
    ------
    SolidgearError
    """
    if value is None:
        return None
    right = Integral if whole else Real
    good = isinstance(value, right) and not isinstance(value, bool) and math.isfinite(value)
    good = good and (above is None or value > above) and (least is None or value >= least) and (below is None or value < below)
    if not good:
        limits = [f"{word} {limit:g}" for word, limit in (("above", above), ("at least", least), ("below", below)) if limit is not None]
        raise SolidgearError(f"{model}: {name} = {value!r} is not usable; give a {'whole ' if whole else ''}number {' and '.join(limits)}")
    return value


def harmonics(model: str, value) -> tuple[int, ...]:
    """A list of circumferential harmonics, each a whole number of at least 2."""
    values = (value,) if isinstance(value, Integral) and not isinstance(value, bool) else tuple(value) if isinstance(value, (tuple, list)) else None
    if values is None:
        raise SolidgearError(f"{model}: ovalising = {value!r} is not a list of harmonics; give whole numbers of at least 2, such as 2,3")
    return tuple(number(model, "ovalising", v, least=2, whole=True) for v in values)
