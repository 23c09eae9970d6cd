"""Traits that models on a mesh of the volume share."""

from __future__ import annotations

from typing import Any

from solidgear.core.ladder.model import SOLID, Model, Options
from solidgear.core.registry import addition

#: unknowns of a tetrahedron of second order, most of which it shares
PER_TETRAHEDRON = 4.0


class Volume(Model):
    """A model on a 3D mesh: without section ties, the volume off by arcs between nodes."""

    family = SOLID
    section_ties = False
    mass_tolerance = 1e-3

    def wanted(self, scene: Any, options: Options) -> list[tuple[Any, str]]:
        """Return the stations with their attachments."""
        from solidgear.core.scene.attached import attached_stations

        return [*attached_stations(scene.stations, options["attachments"])]

    def limits(self, scene: Any) -> str:
        """Return the reason why the features of a scene have no sector that can be meshed; empty if
        they have.
        """
        return addition("question of features", "no sector")(scene)
