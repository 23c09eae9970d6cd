"""Numbers of a deflected train, each with what it leaves open."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Measured:
    """A number of a deflected train.

    Attributes
    ----------
    value : float
        SI.
    bar : float or None
        That meshes leave in it, at most, SI; None where it has none to tell.
    open : (float, float) or None
        Least and largest value by what the data of its bearings leave open; None where nothing is.
    mesh : str
        Of a misalignment where there are several meshes: its name at the end of `name`.
    face : float or None
        Width that a meaning over the face is of, m.
    """

    name: str
    unit: str
    meaning: str
    value: float
    bar: float | None
    open: tuple[float, float] | None = None
    mesh: str = ""
    face: float | None = None

    def as_dict(self) -> dict[str, Any]:
        """Plain data in SI that JSON can hold."""
        unit = self.unit.split()[0]
        return {"value": self.value, "bar": self.bar, "open": self.open, "unit": unit}
