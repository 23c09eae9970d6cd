"""Derivatives of a beam by its shape and material: its matrices with the same elements, moved."""

from __future__ import annotations

from typing import Any

import numpy as np

from solidgear.body import Body
from solidgear.errors import SolidgearError
from solidgear.models.beam.body import on_nodes
from solidgear.scene.attached import attached_stations

#: what a beam is built with unless told otherwise
USUAL = {"head": "cone", "mass": "consistent", "kappa": "hutchinson", "shoulder": False}


class BeamAdjoint:
    """A beam whose nodes follow the ends of segments, rigid seats and sections."""

    def __init__(self, scene, body: Body, options: dict[str, Any]):
        self.scene, self.body = scene, body
        self.nodes = body.geometry.nodes  # type: ignore[union-attr]
        shear = body.mesh["element"] == "timoshenko"
        self.options = {"shear": shear, "rotary_inertia": body.mesh["rotary_inertia"]}
        self.options |= {key: options.get(key, usual) for key, usual in USUAL.items()}

    def moved(self, scene) -> Body:
        """The body of a scene like this one.

        Raises
        ------
        SolidgearError
            If the shaft takes another form, or what lies at one place moves apart.
        """
        marks: dict[float, float] = {}
        tol = 1e-9 * self.scene.length
        for old, new in zip(_places(self.scene), _places(scene), strict=True):
            near = [m for m in marks if abs(m - old[0]) < tol]
            if not near:
                marks[old[0]] = new[0]
            elif abs(marks[near[0]] - new[0]) > tol:
                raise SolidgearError(f"{old[1]} moves away from where something else stays")
        at = np.array(sorted(marks))
        nodes = np.interp(self.nodes, at, [marks[m] for m in at])
        return on_nodes(scene, nodes, [*attached_stations(scene.stations)], **self.options)


def _places(scene) -> list[tuple[float, str]]:
    """Places that nodes follow, and whose they are."""
    out = [(0.0, "the shaft")] + [(s.y1, s.name) for s in scene.segments]
    for station, attachment in attached_stations(scene.stations):
        if attachment == "section":
            out.append((station.y, station.name))
        elif attachment == "rigid":
            out += [(station.lo, station.name), (station.hi, station.name)]
    return out
