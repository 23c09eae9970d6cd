"""Numbers with the intervals that commands claim for them, and relations between two of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations

#: of a number: what double precision leaves of a compliance or a frequency that was solved twice
ROUNDING = 1e-7


@dataclass(frozen=True)
class Number:
    """A number and the interval in which its command says the exact one lies."""

    value: float
    low: float
    high: float
    #: what rounding is small beside: the number, or what a coupling is measured by
    size: float

    @classmethod
    def within(cls, value: float, bar: float | None, size: float | None = None, side: str = "both"):
        """A number with an absolute bar, to one side or both; without one it claims its own value."""
        bar = bar or 0.0
        low = value if side == "above" else value - bar
        high = value if side == "below" else value + bar
        return cls(value, low, high, abs(value) if size is None else abs(size))

    def times(self, factor: float) -> Number:
        """The number in other units, or by a load of another size."""
        low, high = sorted((self.low * factor, self.high * factor))
        return Number(self.value * factor, low, high, self.size * abs(factor))

    def meets(self, other: Number) -> bool:
        """Whether one number may lie in both intervals."""
        rounding = ROUNDING * max(self.size, other.size)
        return max(self.low, other.low) <= min(self.high, other.high) + rounding

    def __str__(self) -> str:
        return f"{self.value:.6g} in [{self.low:.6g}, {self.high:.6g}]"


@dataclass(frozen=True)
class Relation:
    """One thing that must hold, and what was seen where it does not."""

    subject: str  #: file
    kind: str
    name: str
    holds: bool
    seen: str = ""

    def __str__(self) -> str:
        return f"{self.subject}, {self.name}: {self.seen}"


def meeting(
    subject: str, kind: str, claims: Mapping[str, Mapping[str, Number]]
) -> Iterator[Relation]:
    """Yield a relation for every number that two sources claim, each pair once."""
    for (first, numbers), (second, others) in combinations(claims.items(), 2):
        for name in numbers.keys() & others.keys():
            a, b = numbers[name], others[name]
            seen = f"{a} by {first}, {b} by {second}"
            yield Relation(subject, kind, f"{name}: {first}, {second}", a.meets(b), seen)


def failed(relations: Iterable[Relation]) -> list[Relation]:
    """Return the relations that do not hold."""
    return [relation for relation in relations if not relation.holds]
