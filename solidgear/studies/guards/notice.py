"""What a guard says."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

BEAMS = ("euler", "timoshenko", "lumped")
SOLIDS = ("harmonic", "solid")
MODELS = (*BEAMS, *SOLIDS)
#: good to know; holds worse than one might think; cannot be told here; out of the tolerance asked
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


def beyond(error: float, tolerance: float) -> str:
    """``avoid`` for an error out of the tolerance, else ``caution``."""
    return "avoid" if abs(error) > tolerance else "caution"
