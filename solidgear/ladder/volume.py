"""Traits that models on a mesh of the volume share."""

from __future__ import annotations

from typing import Any

from solidgear.ladder.model import SOLID, Model, Options

#: unknowns of a tetrahedron of second order, most of which it shares
PER_TETRAHEDRON = 4.0


class Volume(Model):
    """A 3D mesh: not of one sort with the others in its ties, and closed to what arcs lose."""

    family = SOLID
    section_ties = False
    mass_tolerance = 1e-3

    def wanted(self, scene: Any, options: Options) -> list[tuple[Any, str]]:
        """Stations with their attachments."""
        from solidgear.scene.attached import attached_stations

        return [*attached_stations(scene.stations, options["attachments"])]

    def limits(self, scene: Any) -> str:
        """Reason why the features of a scene have no sector that can be meshed, or nothing."""
        from solidgear.models.sector.body import no_sector

        return no_sector(scene)
