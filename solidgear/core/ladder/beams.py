"""Beams: solved once, without an error bar."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from solidgear.core.ladder.model import BEAM, Model, Series
from solidgear.core.models.options import BEAM_OPTIONS

if TYPE_CHECKING:
    from solidgear.core.body import Body
    from solidgear.core.scene.shaft import Shaft


class Timoshenko(Model):
    """Beam of sections that shear and have rotary inertia."""

    name = "timoshenko"
    title = "Timoshenko beam"
    heading = "Timoshenko"
    family = BEAM
    colour = "#0072b2"
    marker = "s"
    options = BEAM_OPTIONS
    coarser = "give fewer elements"
    most_seats = 200

    def builder(self) -> Callable[..., Body]:
        from solidgear.core.models.beam.body import beam

        return beam

    def series(self, scene: Shaft, full: bool) -> list[Series]:
        """Return few elements and the usual number."""
        return [(BEAM, self.heading, [{"elements": 1}, {}])]


class Euler(Timoshenko):
    """Beam of sections that neither shear nor have rotary inertia."""

    name = "euler"
    title = "Euler beam"
    heading = "Euler"
    colour = "#c98a00"
    marker = "v"
    preset = {"shear": False, "rotary_inertia": False}
