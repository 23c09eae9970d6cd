"""Units of REXS and the words of its attributes, in all versions.

The source of both tables is the specification (https://www.rexs.info), whose schemas of 1.0 to 2.0
are published with the reference implementations.  A unit belongs to its attribute, so that a file
may leave it out.
"""

from __future__ import annotations

from math import pi

#: REXS unit -> (dimension, factor to SI; temperatures in degrees Celsius as they are)
UNITS: dict[str, tuple[str, float]] = {
    "none": ("number", 1.0),
    "%": ("share", 1e-2),
    "mm": ("length", 1e-3),
    "m": ("length", 1.0),
    "mum": ("length", 1e-6),
    "°": ("angle", pi / 180),
    "deg": ("angle", pi / 180),
    "rad": ("angle", 1.0),
    "N": ("force", 1.0),
    "kN": ("force", 1e3),
    "N m": ("torque", 1.0),
    "kW": ("power", 1e3),
    "W": ("power", 1.0),
    "1 / min": ("speed", 2 * pi / 60),
    "rad / s": ("speed", 1.0),
    "N / m": ("force per length", 1.0),
    "N / mm": ("force per length", 1e3),
    "N / rad": ("force per angle", 1.0),
    "N mm / rad": ("torque per angle", 1e-3),
    "N m / rad": ("torque per angle", 1.0),
    "N / (mm mum)": ("stiffness per width", 1e9),
    "N / mm^2": ("stress", 1e6),
    "MPa": ("stress", 1e6),
    "Pa": ("stress", 1.0),
    "kg": ("mass", 1.0),
    "kg m^2": ("inertia", 1.0),
    "kg / dm^3": ("density", 1e3),
    "mm^2 / s": ("viscosity", 1e-6),
    "C": ("temperature", 1.0),
    "K": ("temperature difference", 1.0),
    "h": ("time", 3600.0),
    "s": ("time", 1.0),
    "m / s^2": ("acceleration", 1.0),
}

#: the program that a document of this one names, and the attribute of what REXS has no place for
OURS, REST = "solidgear", "custom_solidgear_rest"


#: attributes that are whole numbers, or numbers of components, by their type in JSON
WHOLE = {
    "number_of_teeth": "integer",
    "number_of_rolling_elements": "integer",
    "number_of_bearing_rows": "integer",
    "reference_component_for_position": "reference_component",
}


def scaled(number: float, factor: float) -> float:
    """Return a number in a unit in SI: dividing by 1000 is exact where multiplying by 0.001 is not."""
    inverse = round(1 / factor) if factor < 1 else 0
    return number / inverse if inverse and factor * inverse == 1 else number * factor


#: unit of an attribute, of those that are read
_IN_UNITS = {
    "mm": (
        "support_vector u_axis_vector w_axis_vector eccentricity_vector u_coordinate_on_shaft "
        "u_coordinate_on_shaft_inner_side u_coordinate_on_shaft_outer_side length "
        "outer_diameter_begin outer_diameter_end inner_diameter_begin inner_diameter_end "
        "inner_diameter outer_diameter width face_width normal_module tip_diameter root_diameter "
        "center_distance common_face_width width_of_external_load diameter_of_rolling_element "
        "length_of_rolling_element raceway_radius_of_inner_ring raceway_radius_of_outer_ring "
        "outer_pitch_diameter reference_diameter reference_diameter_rolling_bearing "
        "distance_between_bearing_rows tip_relief_depth "
        "tip_relief_datum_diameter root_relief_depth root_relief_datum_diameter "
        "helix_crowning_amount_datum_face helix_crowning_amount_non_datum_face helix_slope"
    ),
    "mum": "radial_bearing_clearance mounted_radial_bearing_clearance preload_distance",
    "deg": (
        "helix_angle_reference_diameter normal_pressure_angle rotating_angle_around_neg_u_axis "
        "pressure_angle pitch_angle mean_spiral_angle shaft_angle nominal_design_pressure_angle_drive"
    ),
    "N / m": "radial_stiffness axial_stiffness",
    "N mm / rad": "bending_stiffness rotational_stiffness",
    "N / (mm mum)": "mesh_stiffness_for_load_distribution_along_face_width",
    "N / mm^2": "elastic_modulus",
    "kg / dm^3": "density",
    "kg": "mass_of_component",
    "kg m^2": "moment_of_inertia_u_axis moment_of_inertia_v_axis moment_of_inertia_w_axis",
    "kN": (
        "fatigue_limit_load radial_dynamic_load_rating radial_static_load_rating "
        "axial_dynamic_load_rating axial_static_load_rating"
    ),
    "N": "force_u_direction force_v_direction force_w_direction preload_force",
    "N m": "torque_around_u_axis torque_around_v_axis torque_around_w_axis",
    "kW": "power",
    "1 / min": "rotational_speed",
    "mm^2 / s": "viscosity_at_40_degree_celsius viscosity_at_100_degree_celsius operating_viscosity",
    "C": "temperature_lubricant",
    "%": "operating_time_fraction",
}
UNIT_OF = {name: unit for unit, names in _IN_UNITS.items() for name in names.split()}

#: the five motions of a 6x6 at an operating point, u v w and the turns about v and w
MOTIONS = ("u", "v", "w", "v_rot", "w_rot")
#: unit of such an entry, by whether it is of a force, and whether the motion is a turn
_STIFFNESS_UNITS = {
    (True, False): "N / m",
    (True, True): "N / rad",
    (False, False): "N",
    (False, True): "N mm / rad",
}


def _stiffness_words() -> dict[str, str]:
    """Return names of 1.0 of the stiffness at an operating point, and those from 1.1 on."""
    words = {}
    for load in MOTIONS:
        for motion in MOTIONS:
            kind, axis = ("M", load[0]) if load.endswith("rot") else ("F", load)
            turn = f"rot_{motion[0]}" if motion.endswith("rot") else f"d_{motion}"
            words[f"operating_point_stiffness_d{kind}_{axis}_d_{motion}"] = (
                f"operating_point_stiffness_{kind.lower()}_{axis}_{turn}"
            )
    return words


#: name from 1.4 on -> names of other versions, which differ by names
OTHER_NAMES: dict[str, tuple[str, ...]] = {
    "radial_dynamic_load_rating": ("dynamic_capacity",),
    "radial_static_load_rating": ("static_capacity",),
    "catalogue_designation": ("name",),
    "radial_bearing_clearance": ("radial_backlash",),
    "radial_clearance_class": ("clearance_class",),
    "contamination_factor_iso_281_2007": (
        "contamination_factor_according_to_iso_281_2007",
        "contamination_factor_according_to_din_26281",
    ),
    "preload_force": ("initial_load",),
    "preload_distance": ("initial_load_shift",),
    "raceway_radius_of_inner_ring": ("running_path_radius_of_inner_ring",),
    "raceway_radius_of_outer_ring": ("running_path_radius_of_outer_ring",),
    "reference_diameter_rolling_bearing": ("reference_diameter",),
    "operating_time_fraction": ("load_duration_fraction",),
    "u_coordinate_on_shaft_inner_side": ("u_coordinate_on_shaft_side_1",),
    "u_coordinate_on_shaft_outer_side": ("u_coordinate_on_shaft_side_2",),
    "tip_radius_factor": ("tip_corner_radius_factor_reference_profile",),
    **{new: (old,) for old, new in _stiffness_words().items()},
}
UNIT_OF |= {
    new: _STIFFNESS_UNITS["_dF_" in old, old.endswith("rot")]
    for old, new in _stiffness_words().items()
}
#: type from 1.3 on, by the name of another version
TYPES = {
    "flank_geometry": "cylindrical_gear_flank",
    "fixed_coupling": "coupling",
    "stage_gear_data": "cylindrical_stage_gear_data",
}
