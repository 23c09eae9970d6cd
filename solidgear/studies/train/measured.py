"""Numbers of a deflected train, each with what it leaves open."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Measured:
    """A number of a deflected train."""

    name: str
    unit: str
    meaning: str
    value: float  #: SI
    bar: float | None  #: that meshes leave in it, at most, SI; None where it has none to tell
    #: least and largest value by what the data of its bearings leave open; None where nothing is
    open: tuple[float, float] | None = None
    #: of a misalignment where there are several meshes: its name at the end of `name`
    mesh: str = ""
    face: float | None = None  #: width that a meaning over the face is of, m

    def as_dict(self) -> dict[str, Any]:
        """Plain data in SI that JSON can hold."""
        unit = self.unit.split()[0]
        return {"value": self.value, "bar": self.bar, "open": self.open, "unit": unit}
