"""The lumped model, which rests on the body of another."""

from __future__ import annotations

from typing import TYPE_CHECKING

from solidgear.core.ladder.model import LUMPED, Model

if TYPE_CHECKING:
    pass


class Lumped(Model):
    """Masses and springs at the lumped point."""

    name = "lumped"
    title = "lumped model"
    heading = "lumped"
    family = LUMPED
    colour = "#b3305c"
    marker = "P"
