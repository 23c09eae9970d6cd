"""Numbers with their bars, and the meshes that were tried on the way to them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from solidgear.quantity import Quantity

#: bars that the solution on one mesh tells by itself
METHOD = "local problems"
#: a coupling this small against its diagonal entries is zero
ROUNDING = 1e-9
#: sides on which the exact answer may lie
ABOVE, BELOW, BOTH = "above", "below", "both"


@dataclass(frozen=True)
class Value:
    """A number with its bar.

    Attributes
    ----------
    value : float
        SI.
    bar : float
        Relative; of couplings, to the geometric mean of their diagonal entries. Infinite where
        nothing is known.
    meshes : int
        Solutions that the value and its bar rest on.
    size : float
        What the bar is relative to, SI.
    side : str
        Where the exact answer of the model lies: ``above`` or ``below`` the value, or ``both`` where
        it may be either.
    method : str
        Where the bar comes from.
    """

    quantity: Quantity
    value: float
    unit: str
    bar: float
    meshes: int
    size: float
    side: str = BOTH
    method: str = ""

    @property
    def how(self) -> str:
        """Origin of the bar, in words."""
        if self.method == METHOD:
            return METHOD
        return f"{self.meshes} meshes" if self.meshes > 1 else "one mesh only, not judged"

    @property
    def zero(self) -> bool:
        """Tell whether it is nothing but rounding, as a coupling that symmetry forbids."""
        return abs(self.value) <= ROUNDING * self.size


@dataclass(frozen=True)
class Step:
    """Something that was tried, or passed over.

    Attributes
    ----------
    setting : str
        Of the mesh, in words.
    valid : bool
        Whether it could be an answer at all.
    why : str
        Why it was passed over, or what came after it.
    bar : float or None
        The largest over the quantities asked for; None where there is none yet.
    only : tuple of Quantity
        What was still open, where a mesh was not solved for everything asked for.
    options : dict
        Of the mesh, for its builder.
    """

    rung: str
    setting: str
    valid: bool
    why: str = ""
    bar: float | None = None
    unknowns: int | None = None
    seconds: float = 0.0
    chosen: bool = False
    only: tuple[Quantity, ...] = ()
    options: Mapping[str, Any] = field(default_factory=dict)
