"""Notices of guards."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from solidgear.core import BEAM, LADDER
from solidgear.core.ladder.model import LUMPED, SOLID

#: good to know; holds worse than one might think; cannot be decided here; out of the tolerance asked
#: for; wrong
LEVELS = ("fact", "caution", "open", "avoid", "fault")
#: the beam that lumped models of a check rest on
LUMPED_ON = "timoshenko"


@dataclass(frozen=True)
class Notice:
    """One sentence of a guard."""

    level: str  #: one of ``LEVELS``
    #: models concerned; empty for a notice on the data, which concerns every model
    models: tuple[str, ...]
    sentence: str  #: fault, place, value, limit, and remedy


Notices = Iterator[Notice]


def beams() -> tuple[str, ...]:
    """Return beams, and the lumped models that rest on them."""
    return (*LADDER.of(BEAM), *LADDER.of(LUMPED))


def of_theory(shear: bool) -> tuple[str, ...]:
    """Return beams whose sections shear, or do not, and the lumped models that rest on them."""
    beams_of_theory = [m for m in LADDER.of(BEAM) if LADDER[m].defaults()["shear"] is shear]
    return tuple(name for beam in beams_of_theory for name in with_lumped(beam))


def with_lumped(beam: str) -> tuple[str, ...]:
    """Return a beam, with the lumped models where they rest on it."""
    return (beam, *LADDER.of(LUMPED)) if beam == LUMPED_ON else (beam,)


def solids() -> tuple[str, ...]:
    """Return the solids that model a plain shaft, the only ones that guards look at."""
    return tuple(name for name in LADDER.of(SOLID) if not LADDER[name].for_features)


def everything() -> tuple[str, ...]:
    """Return all models."""
    return (*beams(), *solids())


def beyond(error: float, tolerance: float) -> str:
    """Return ``avoid`` for an error out of the tolerance, else ``caution``."""
    return "avoid" if abs(error) > tolerance else "caution"


def sure(bar: float | None) -> str:
    """Return an error bar as the end of a clause; empty without one."""
    if not bar:
        return ""
    # one digit, and no power of ten
    return (
        f", give or take {float(f'{100 * bar:.1g}'):g} %" if bar >= 1e-4 else ", to within 0.01 %"
    )


def slip_in_units(
    numbers: Iterable[tuple[str, float, str]], sound: Mapping[str, tuple[float, float]], legend: str
) -> str:
    """Return a sentence on numbers whose order of magnitude no part has, the worst of each kind; empty
    if there are none.

    `numbers` are tuples of a key of `sound`, the value, and the owner of it, which may be empty;
    `sound` gives the least and largest value of a part that can be made; `legend` explains symbols of
    the keys.
    """
    odd: dict[str, list[tuple[float, str]]] = {}
    for name, value, owner in numbers:
        least, most = sound[name]
        if not least <= value <= most:
            odd.setdefault(name, []).append((value, owner))
    slips = []
    for name, values in odd.items():
        least, most = sound[name]
        value, owner = min(values) if min(values)[0] < least else max(values)
        number = f"{name} of {owner}" if owner else name
        others = f", and {len(values) - 1} more" if len(values) > 1 else ""
        slips.append(f"{number} is {value:.3g}, outside {least:g} to {most:g}{others}")
    if not slips:
        return ""
    symbols = f" ({legend})" if legend else ""
    return f"probably a wrong unit: {'; '.join(slips)}{symbols}; check the number and its unit"


def against(gap: float, more: str, less: str) -> str:
    """Return the ratio of a number to a reference in words, from the gap as a share of the reference:
    in per cent, and as a factor where it is more than twice as large.

    Examples
    --------
    >>> against(-0.12, "higher", "lower"), against(12.8, "higher", "lower")
    ('12 % lower than', '13.8 times')
    """
    if gap > 1:
        return f"{1 + gap:.3g} times"
    return f"{100 * abs(gap):.3g} % {more if gap > 0 else less} than"
