"""Planetary stages of trains as components of a REXS document."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np

from solidgear.exchange.rexs.export.gears import write_stiffness
from solidgear.exchange.rexs.export.parts import Parts
from solidgear.trains.file.planetary import Stage


@dataclass(frozen=True)
class SunPlace:
    """The sun of a stage: where it is, and the teeth that the whole stage has."""

    gear: int  #: number of its component
    shafts: tuple[int, int]  #: numbers of its shaft and of the carrier
    middle: np.ndarray  #: (3,) of its face in the axes of the first shaft, m
    axes: np.ndarray  #: (3, 3) of its scene as columns, in those of the first shaft
    carrier_y: float  #: where the carrier holds the pins, along its shaft, m
    module: float
    helix: float  #: of planets and ring, rad
    width: float  #: of the face, m

    @property
    def teeth(self) -> dict[str, Any]:
        """Attributes of the teeth of planets and ring."""
        helix = self.helix or None
        teeth = {"normal_module": self.module, "face_width": self.width}
        return teeth | {"helix_angle_reference_diameter": helix}


def add_stage(parts: Parts, stage: Stage, sun: SunPlace) -> None:
    """Add a planetary stage, its planets on shafts of their own that bearings hold to the carrier."""
    number = parts.add("planetary_stage", stage.called, parts.unit)
    cage = parts.add("planet_carrier", whole=number)
    parts.relate("assembly", assembly=cage, part=sun.shafts[1])
    parts.relate("central_shaft", planetary_stage=number, shaft=sun.shafts[0])
    parts.relate("planet_carrier_shaft", planetary_stage=number, shaft=sun.shafts[1])
    ring = parts.add(
        "ring_gear",
        f"ring of {stage.called}",
        **parts.frame(sun.middle, sun.axes),
        **sun.teeth,
        number_of_teeth=-stage.table.ring_teeth,
    )
    transverse = float(sun.module / np.cos(sun.helix))
    distance = transverse * (stage.sun.teeth + stage.table.planet.teeth) / 2
    for k, angle in enumerate(_angles(stage.table), 1):
        outward = sun.axes @ np.array([np.cos(angle), 0.0, -np.sin(angle)])
        name = f"planet {k} of {stage.called}"
        planet = _add_planet(parts, stage, sun, name, sun.middle + distance * outward, number)
        for mate, first, second in (("sun", sun.gear, planet), ("ring", planet, ring)):
            name = f"{mate} {k} of {stage.called}"
            mesh = parts.add("cylindrical_stage", name, number, center_distance=distance)
            parts.relate("stage", stage=mesh, gear_1=first, gear_2=second)
            write_stiffness(parts, mesh, getattr(stage.table.mesh, f"{mate}_stiffness"), sun.width)


def _add_planet(
    parts: Parts, stage: Stage, sun: SunPlace, name: str, centre: np.ndarray, number: int
) -> int:
    """Add a planet with its shaft and the springs of its pin; return the number of its gear."""
    table = stage.table.planet
    begin = centre - sun.axes[:, 1] * sun.width / 2
    shaft = parts.add("shaft", name, **parts.frame(begin, sun.axes))
    parts.relate("planet_shaft", planetary_stage=number, shaft=shaft)
    body = float(sun.module / np.cos(sun.helix)) * table.teeth / 2
    parts.add_cylinder(shaft, sun.width, body)
    gear = parts.add(
        "cylindrical_gear",
        name,
        shaft,
        **parts.frame(centre, sun.axes),
        **sun.teeth,
        u_coordinate_on_shaft=sun.width / 2,
        number_of_teeth=table.teeth,
        mass_of_component=table.mass,
    )
    assert table.pin is not None  # planets of files have one
    pin = parts.add(
        "concept_bearing",
        f"pin of {name}",
        u_coordinate_on_shaft_inner_side=sun.carrier_y,
        u_coordinate_on_shaft_outer_side=sun.width / 2,
        radial_stiffness=table.pin.radial,
        axial_stiffness=table.pin.axial,
        bending_stiffness=table.pin.tilting,
        axial_force_absorption="both_directions",
        radial_force_absorption=True,
    )
    parts.relate("side", assembly=pin, inner_part=sun.shafts[1], outer_part=shaft)
    return gear


def _angles(table: Any) -> list[float]:
    angles = table.angles or [2 * pi * k / table.planets for k in range(table.planets)]
    return [float(angle) + table.position for angle in angles]
