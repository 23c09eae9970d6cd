"""Scenes as shafts of a REXS document: sections, material, bearings, masses."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

import numpy as np

from solidgear.core import Bearing, Scene, SolidgearError, show
from solidgear.exchange.rexs.bearings import KINDS, ONE_WAY
from solidgear.exchange.rexs.export.parts import Parts
from solidgear.exchange.rexs.shafts import is_file_name
from solidgear.exchange.rexs.units import MOTIONS

TYPES = {kind: word for word, kind in KINDS.items()}
#: places of u, v, w and of the turns about v and w among the six motions of a scene
_PLACES = dict(zip(MOTIONS, (1, 2, 0, 5, 3)))
#: rows of a bearing that holds the shaft both ways by itself
TWO_ROWS = ("double_row", "back_to_back", "face_to_face", "tandem")


def add_shaft(
    parts: Parts, name: str, scene: Scene, origin: np.ndarray, axes: np.ndarray, **attributes: Any
) -> int:
    """Add a shaft at a place in the axes of the first; return its number."""
    if not scene.segments:
        raise SolidgearError(
            f"{scene.name} has no segments, and REXS has shafts of round sections: it stays where it is"
        )
    if not is_file_name(name):
        raise SolidgearError(
            f"shaft {show(name, 40)}: its file is named after it when it comes back; use letters, "
            "digits, blanks, - and _"
        )
    frame = parts.frame(origin, axes)
    shaft = parts.add("shaft", name, parts.unit, **frame, **attributes)
    tables = scene.to_dict()
    if scene.lubrication is not None and parts.components[parts.casing].attributes == {}:
        parts.write(parts.casing, operating_viscosity=scene.lubrication.viscosity)
    material = parts.add(
        "material",
        elastic_modulus=scene.material.E,
        poisson_ratio=scene.material.nu,
        density=scene.material.density,
    )
    parts.relate("reference", origin=shaft, referenced=material)
    _add_sections(parts, shaft, scene)
    for bearing, table in zip(scene.bearings, tables.get("bearing", ())):
        _add_bearing(parts, shaft, bearing, table, scene)
    for mass in scene.masses:
        if mass.on is None and not any(mass.offset):
            inertia: dict[str, Any] = {
                f"moment_of_inertia_{axis}_axis": v for axis, v in zip("wuv", mass.inertia)
            }
            parts.add(
                "additional_mass",
                mass.name,
                shaft,
                u_coordinate_on_shaft=mass.y,
                length=mass.seat_width,
                mass_of_component=mass.mass,
                **inertia,
            )
    return shaft


def add_points(parts: Parts, shaft: int, scene: Scene, gears: Collection[str]) -> dict[str, int]:
    """Add the lumped points of a scene that carry no gear, as places of loads; return their numbers."""
    out = {}
    for port in scene.ports:
        if port.name not in gears:
            out[port.name] = parts.add(
                "external_load",
                port.name,
                shaft,
                u_coordinate_on_shaft=port.y,
                width_of_external_load=port.hi - port.lo,
                transmits_torque=False,
            )
    return out


def forces(load: Mapping[str, float]) -> dict[str, Any]:
    """Return forces and moments of a load by their attributes, from those of a scene by their keys."""
    out = {f"force_{axis}_direction": load.get(key) for axis, key in zip("uvw", "yzx")}
    out |= {f"torque_around_{axis}_axis": load.get(f"th{key}") for axis, key in zip("uvw", "yzx")}
    return {name: number for name, number in out.items() if number}


def _add_sections(parts: Parts, shaft: int, scene: Scene) -> None:
    for segment in scene.segments:
        (bore0, outer0), (bore1, outer1) = (segment.radius_at(y) for y in (segment.y0, segment.y1))
        parts.add(
            "shaft_section",
            segment.name,
            shaft,
            u_coordinate_on_shaft=segment.y0,
            length=segment.y1 - segment.y0,
            outer_diameter_begin=2 * outer0,
            outer_diameter_end=2 * outer1,
            inner_diameter_begin=2 * bore0,
            inner_diameter_end=2 * bore1,
        )


def _add_bearing(parts: Parts, shaft: int, bearing: Bearing, table: Mapping, scene: Scene) -> None:
    catalogue = table.get("catalogue")
    kind = "concept_bearing"
    if catalogue is not None:
        inside = {"elements", "element_diameter", "pitch_diameter"} <= {*catalogue}
        geometry = "detailed" if inside else "catalog"
        kind = f"rolling_bearing_with_{geometry}_geometry"
    number = parts.add(
        kind,
        bearing.name,
        u_coordinate_on_shaft_inner_side=bearing.y,
        u_coordinate_on_shaft_outer_side=bearing.y,
        radial_force_absorption=True,
        **_stiffness(bearing.matrix if catalogue is None else None),
    )
    parts.relate("side", assembly=number, inner_part=shaft, outer_part=parts.casing)
    if catalogue is None:
        parts.write(number, width=bearing.seat_width)
    else:
        _add_catalogue(parts, number, catalogue, table, scene)


def _stiffness(matrix: Any) -> dict[str, Any]:
    """Return the stiffness of a bearing: radial, along and tilting, or the 6x6 with its couplings."""
    if matrix is None:
        return {}
    K = np.asarray(matrix, dtype=float)
    plain = np.diag([K[0, 0], K[1, 1], K[0, 0], K[3, 3], 0.0, K[3, 3]])
    if np.array_equal(K, plain):
        absorbs = "both_directions" if K[1, 1] else "no_direction"
        return {
            "radial_stiffness": K[0, 0],
            "axial_stiffness": K[1, 1] or None,
            "bending_stiffness": K[3, 3],
            "axial_force_absorption": absorbs,
        }
    out: dict[str, Any] = {"axial_force_absorption": "both_directions"}
    for load in MOTIONS:
        for motion in MOTIONS:
            word = f"m_{load[0]}" if load.endswith("rot") else f"f_{load}"
            turn = f"rot_{motion[0]}" if motion.endswith("rot") else f"d_{motion}"
            entry = K[_PLACES[load], _PLACES[motion]]
            out[f"operating_point_stiffness_{word}_{turn}"] = entry or None
    return out


def _add_catalogue(parts: Parts, number: int, data: Mapping, table: Mapping, scene: Scene) -> None:
    """Add what a catalogue says of a rolling bearing."""
    kind = data["kind"]
    way = "axial" if kind == "thrust_ball" else "radial"
    clearance = data.get("clearance")
    lubrication = scene.lubrication
    cleanliness = None if lubrication is None else lubrication.cleanliness
    parts.write(
        number,
        bearing_type=TYPES.get(kind),
        catalogue_designation=data.get("designation"),
        inner_diameter=data.get("bore"),
        outer_diameter=data.get("outer_diameter"),
        width=data.get("width"),
        axial_force_absorption=_absorbs(data, table),
        fatigue_limit_load=data.get("fatigue_limit"),
        preload_force=(data.get("preload") or {}).get("force"),
        preload_distance=(data.get("preload") or {}).get("displacement"),
        radial_clearance_class=(
            clearance.replace("CN", "C0") if isinstance(clearance, str) else None
        ),
        radial_bearing_clearance=clearance if isinstance(clearance, float) else None,
        contamination_factor_iso_281_2007=cleanliness if isinstance(cleanliness, float) else None,
        number_of_bearing_rows=2 if data.get("arrangement") in TWO_ROWS else None,
        distance_between_bearing_rows=data.get("row_distance"),
        **{f"{way}_dynamic_load_rating": data.get("load_rating")},
        **{f"{way}_static_load_rating": data.get("static_rating")},
    )
    diameter = data.get("element_diameter")
    row_keys = ("elements", "pitch_diameter", "contact_angle", "conformity", "element_length")
    if diameter is None and not any(data.get(key) for key in row_keys):
        return
    grooves = [ratio * diameter for ratio in data.get("conformity", ()) if diameter] or [None] * 2
    row = parts.add(
        "rolling_bearing_row",
        whole=number,
        by="ordered_assembly",
        number_of_rolling_elements=data.get("elements"),
        reference_diameter=data.get("pitch_diameter"),
        pressure_angle=data.get("contact_angle"),
        raceway_radius_of_inner_ring=grooves[0],
        raceway_radius_of_outer_ring=grooves[1],
    )
    if diameter or data.get("element_length"):
        parts.add(
            "rolling_element",
            whole=row,
            by="ordered_assembly",
            diameter_of_rolling_element=diameter,
            length_of_rolling_element=data.get("element_length"),
        )


def _absorbs(data: Mapping, table: Mapping) -> str:
    """Return the direction along the shaft in which a rolling bearing takes force."""
    one_way = data["kind"] in ONE_WAY or data.get("ribs") == "one way"
    if one_way and data.get("holds"):
        return "positive" if data["holds"] == "+y" else "negative"
    ribbed = data.get("ribs") == "both ways"
    floats = data["kind"] == "needle" or (data["kind"] == "cylindrical" and not ribbed)
    return "no_direction" if floats or table.get("support") == "floating" else "both_directions"
