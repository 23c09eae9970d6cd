"""A claim of the thesis and the words of verdicts."""

from __future__ import annotations

from dataclasses import dataclass, field

CONFIRMED, CAVEAT = "confirmed", "confirmed with a caveat"
NOT, OPEN = "not confirmed", "not decidable"


@dataclass(frozen=True)
class Claim:
    """A claim, what was found, and the verdict.

    Attributes
    ----------
    place, says, verdict, found : str
    numbers : dict of str to float
    """

    place: str
    says: str
    verdict: str
    found: str
    numbers: dict[str, float] = field(default_factory=dict)
