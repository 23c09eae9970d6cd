"""Notices of guards."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from solidgear.ladder.model import BEAM, LUMPED, SOLID
from solidgear.ladder.registry import LADDER

#: good to know; holds worse than one might think; cannot be decided here; out of the tolerance asked
#: for; wrong
LEVELS = ("fact", "caution", "open", "avoid", "fault")
#: the beam that lumped models of a check rest on
LUMPED_ON = "timoshenko"


@dataclass(frozen=True)
class Notice:
    """One sentence of a guard."""

    level: str  #: one of ``LEVELS``
    #: the models it is about; empty where it is about the data, whatever the model
    models: tuple[str, ...]
    sentence: str  #: what, where, the value, the limit, and what to do


Notices = Iterator[Notice]


def beams() -> tuple[str, ...]:
    """Beams, and the lumped models that rest on them."""
    return (*LADDER.of(BEAM), *LADDER.of(LUMPED))


def of_theory(shear: bool) -> tuple[str, ...]:
    """Beams whose sections shear, or do not, and the lumped models that rest on them."""
    own = [m for m in LADDER.of(BEAM) if LADDER[m].defaults()["shear"] is shear]
    return tuple(name for beam in own for name in with_lumped(beam))


def with_lumped(beam: str) -> tuple[str, ...]:
    """A beam, with the lumped models where it is the one that they rest on."""
    return (beam, *LADDER.of(LUMPED)) if beam == LUMPED_ON else (beam,)


def solids() -> tuple[str, ...]:
    """Solids that model a plain shaft: guards look at nothing else."""
    return tuple(name for name in LADDER.of(SOLID) if not LADDER[name].for_features)


def everything() -> tuple[str, ...]:
    """All models."""
    return (*beams(), *solids())


def beyond(error: float, tolerance: float) -> str:
    """``avoid`` for an error out of the tolerance, else ``caution``."""
    return "avoid" if abs(error) > tolerance else "caution"


def sure(bar: float | None) -> str:
    """An error bar as the end of a clause; nothing where there is none."""
    if not bar:
        return ""
    return f", give or take {100 * bar:.1g} %" if bar >= 1e-4 else ", to within 0.01 %"


def slip_in_units(
    found: Iterable[tuple[str, float, str]], sound: Mapping[str, tuple[float, float]], legend: str
) -> str:
    """Sentence on numbers whose order of magnitude no part has, the worst of each kind; nothing if there
    are none.

    Parameters
    ----------
    found : iterable of (str, float, str)
        What it is, a key of `sound`; its value; and of what it is, which may be empty.
    sound : mapping of str to (float, float)
        Least and largest value of a part that can be made.
    legend : str
        Symbols in the names, in brackets behind them.
    """
    odd: dict[str, list[tuple[float, str]]] = {}
    for name, value, where in found:
        least, most = sound[name]
        if not least <= value <= most:
            odd.setdefault(name, []).append((value, where))
    out = []
    for name, ones in odd.items():
        least, most = sound[name]
        value, where = min(ones) if min(ones)[0] < least else max(ones)
        what = f"{name} of {where}" if where else name
        others = f", and so are {len(ones) - 1} others" if len(ones) > 1 else ""
        out.append(f"{what} is {value:.3g}, outside {least:g} to {most:g}{others}")
    if not out:
        return ""
    told = f" ({legend})" if legend else ""
    return f"probably a slip in units: {'; '.join(out)}{told}; check the number and its unit"


def against(gap: float, more: str, less: str) -> str:
    """Ratio of a number to another in words, by the gap as a share of the other: in per cent,
    and as a factor where it is more than twice as large.

    Examples
    --------
    >>> against(-0.12, "higher", "lower"), against(12.8, "higher", "lower")
    ('12 % lower than', '13.8 times')
    """
    if gap > 1:
        return f"{1 + gap:.3g} times"
    return f"{100 * abs(gap):.3g} % {more if gap > 0 else less} than"
