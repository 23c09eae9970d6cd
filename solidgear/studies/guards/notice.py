"""What a guard says."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from solidgear.fidelity.ladder import LADDER
from solidgear.fidelity.rung import BEAM, LUMPED, SOLID

#: good to know; holds worse than one might think; cannot be decided here; out of the tolerance asked
#: for; wrong
LEVELS = ("fact", "caution", "open", "avoid", "fault")


@dataclass(frozen=True)
class Notice:
    """One sentence of a guard.

    Attributes
    ----------
    level : str
        One of ``LEVELS``.
    models : tuple of str
        The models it is about; empty where it is about the data, whatever the model.
    sentence : str
        What, where, the value, the limit, and what to do.
    """

    level: str
    models: tuple[str, ...]
    sentence: str


Notices = Iterator[Notice]


def beams() -> tuple[str, ...]:
    """Beams, and the lumped models that rest on them."""
    return (*LADDER.of(BEAM), *LADDER.of(LUMPED))


def solids() -> tuple[str, ...]:
    """Solids that model a plain shaft: guards look at nothing else."""
    return tuple(name for name in LADDER.of(SOLID) if not LADDER[name].for_features)


def everything() -> tuple[str, ...]:
    """All models."""
    return (*beams(), *solids())


def beyond(error: float, tolerance: float) -> str:
    """``avoid`` for an error out of the tolerance, else ``caution``."""
    return "avoid" if abs(error) > tolerance else "caution"
