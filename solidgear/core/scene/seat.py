"""Seat on a part from a file, by a cylinder of its surface."""

from __future__ import annotations

from pydantic import Field, model_validator

from solidgear.core.errors import SceneError
from solidgear.core.scene.typed import Model
from solidgear.core.scene.units import Length, PositiveLength


class Seat(Model):
    """A stretch of a cylinder of the part, counted from the origin of the body."""

    diameter: PositiveLength
    from_: Length = Field(alias="from")
    to: Length

    @model_validator(mode="after")
    def _long(self):
        if self.to <= self.from_:
            raise SceneError("must lie beyond from", path=("to",))
        return self
