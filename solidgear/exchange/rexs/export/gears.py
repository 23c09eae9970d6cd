"""Gears of trains as components of a REXS document: teeth, flanks, stiffness of their meshes."""

from __future__ import annotations

from typing import Any

import numpy as np

from solidgear.exchange.rexs.export.parts import Parts
from solidgear.trains.file.cylindrical import first_given
from solidgear.trains.file.gears import Gear


def with_mate(gear: Gear, mate: Gear) -> Gear:
    """Return a cylindrical gear with the module, helix and width that its file leaves to its mate."""
    module = gear.module
    if module is None and gear.pitch_radius is None:
        module = cylindrical(mate)["normal_module"]
    helix = first_given(gear.helix_angle, gear.spiral_angle, mate.helix_angle, mate.spiral_angle)
    width = first_given(gear.face_width, mate.face_width)
    return gear.model_copy(update={"module": module, "helix_angle": helix, "face_width": width})


def cylindrical(gear: Gear) -> dict[str, Any]:
    """Return module, helix and tips of a cylindrical gear, by the radius where the file has that."""
    helix = gear.helix_angle or gear.spiral_angle or 0.0
    module = gear.module
    if module is None and gear.pitch_radius is not None:
        module = 2 * gear.pitch_radius * float(np.cos(helix)) / gear.teeth
    return {
        "normal_module": module,
        "helix_angle_reference_diameter": (-helix if gear.hand == "left" else helix) or None,
        "tip_diameter": gear.tip_diameter,
    }


def bevel(gear: Gear) -> dict[str, Any]:
    """Return cone, spiral and hand of a bevel gear."""
    return {
        "outer_pitch_diameter": None if gear.pitch_radius is None else 2 * gear.pitch_radius,
        "pitch_angle": gear.pitch_angle,
        "mean_spiral_angle": gear.spiral_angle,
        "spiral_angle_pitch_direction": gear.hand,
    }


def add_flanks(parts: Parts, number: int, gear: Gear, pressure_angle: float | None) -> None:
    """Add both flanks of a cylindrical gear, with what shapes them and the tool that cuts them."""
    flanks = [
        parts.add(
            "cylindrical_gear_flank",
            normal_pressure_angle=pressure_angle,
            addendum_modification_coefficient=gear.profile_shift or None,
        )
        for _ in range(2)
    ]
    parts.relate("flank", gear=number, left=flanks[0], right=flanks[1])
    shapes: list[tuple[str, dict[str, Any]]] = []
    if gear.relief is not None and gear.relief.tip:
        amount: dict[str, Any] = {"tip_relief_depth": gear.relief.tip}
        shapes.append(("tip_relief", amount | {"tip_relief_datum_diameter": gear.relief.from_}))
    if gear.relief is not None and gear.relief.root:
        amount = {"root_relief_depth": gear.relief.root}
        start = {"root_relief_datum_diameter": gear.relief.root_from}
        shapes.append(("root_relief", amount | start))
    if gear.crowning:
        amounts = (f"helix_crowning_amount_{face}_face" for face in ("datum", "non_datum"))
        shapes.append(("helix_crowning", dict.fromkeys(amounts, gear.crowning)))
    for flank in flanks:
        for kind, attributes in shapes:
            shape = parts.add(kind, **attributes)
            parts.relate("reference", origin=flank, referenced=shape)
    if gear.rack is not None:
        tool = parts.add(
            "rack_shaped_tool",
            addendum_coefficient_reference_profile=gear.rack.dedendum,
            tip_radius_factor=gear.rack.root_radius,
        )
        for flank in flanks:
            parts.relate("manufacturing_step", workpiece=flank, tool=tool)


def write_stiffness(parts: Parts, stage: int, stiffness: Any, width: float) -> None:
    """Add the stiffness of a mesh to its stage, for a metre of face."""
    if isinstance(stiffness, float):
        name = "mesh_stiffness_for_load_distribution_along_face_width"
        parts.write(stage, common_face_width=width, **{name: stiffness / width})
