"""Numbers with error bars, and the meshes that were tried on the way to them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from solidgear.core.quantity import Quantity

#: a coupling this small against its diagonal entries is zero
ROUNDING = 1e-9
#: sides on which the exact answer may lie
ABOVE, BELOW, BOTH = "above", "below", "both"


@dataclass(frozen=True)
class Value:
    """A number with an error bar."""

    quantity: Quantity
    value: float  #: SI
    unit: str
    #: relative; of couplings, to the geometric mean of their diagonal entries. Infinite where
    #: nothing is known.
    bar: float
    size: float  #: scale that the bar is relative to, SI
    #: where the exact answer of the model lies: ``above`` or ``below`` the value, or ``both`` where
    #: it may be either
    side: str = BOTH
    method: str = ""  #: where the bar comes from

    @property
    def how(self) -> str:
        """Origin of the error bar, in words."""
        return self.method or "not judged"

    @property
    def zero(self) -> bool:
        """Whether the number is only rounding, as a coupling that symmetry forbids."""
        return abs(self.value) <= ROUNDING * self.size


@dataclass(frozen=True)
class Step:
    """A model or mesh that was tried, or passed over."""

    plain_names = (
        ("model", "rung"),
        *("setting", "valid", "why", "bar", "unknowns", "seconds", "chosen", "only", "options"),
    )

    rung: str
    setting: str  #: of the mesh, in words
    valid: bool  #: whether it could be an answer at all
    why: str = ""  #: reason for passing it over, or for stopping after it
    #: the largest over the quantities asked for; None where there is none yet
    bar: float | None = None
    unknowns: int | None = None
    seconds: float = 0.0
    chosen: bool = False
    #: quantities still open, where a mesh was not solved for everything asked for
    only: tuple[Quantity, ...] = ()
    options: Mapping[str, Any] = field(default_factory=dict)  #: of the mesh, for its builder
