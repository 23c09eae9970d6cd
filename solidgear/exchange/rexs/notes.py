"""What an import leaves out, assumes or doubts, each once, with the name of the component."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from solidgear.exchange.rexs.document import JOINTS, Component, Document
from solidgear.exchange.rexs.units import OTHER_NAMES, REST

#: attributes that are read, by type; what is where is said by the others of :mod:`units`
READ = {
    "gear_unit": (
        "support_vector u_axis_vector w_axis_vector reference_component_for_position "
        "number_of_gears gear_shift_index account_for_gravity direction_vector_gravity_u "
        "direction_vector_gravity_v direction_vector_gravity_w operating_time_fraction "
        "account_for_shear_deformation"
    ),
    "gear_casing": "temperature_lubricant operating_viscosity",
    "shaft": (
        "support_vector u_axis_vector w_axis_vector reference_component_for_position "
        "rotational_speed defines_speed"
    ),
    "shaft_section": (
        "u_coordinate_on_shaft length outer_diameter_begin outer_diameter_end "
        "inner_diameter_begin inner_diameter_end"
    ),
    "material": "elastic_modulus poisson_ratio density material_designation shear_modulus",
    "lubricant": "viscosity_at_40_degree_celsius viscosity_at_100_degree_celsius name",
    "external_load": (
        "u_coordinate_on_shaft width_of_external_load torque_around_u_axis torque_around_v_axis "
        "torque_around_w_axis force_u_direction force_v_direction force_w_direction power "
        "transmits_torque defines_torque"
    ),
    "additional_mass": (
        "u_coordinate_on_shaft length mass_of_component moment_of_inertia_u_axis "
        "moment_of_inertia_v_axis moment_of_inertia_w_axis"
    ),
    "cylindrical_gear": (
        "support_vector u_axis_vector w_axis_vector reference_component_for_position "
        "u_coordinate_on_shaft face_width number_of_teeth normal_module tip_diameter "
        "helix_angle_reference_diameter inner_diameter mass_of_component"
    ),
    "cylindrical_stage": (
        "center_distance rotating_angle_around_neg_u_axis "
        "mesh_stiffness_for_load_distribution_along_face_width common_face_width"
    ),
    "cylindrical_gear_flank": "normal_pressure_angle addendum_modification_coefficient",
    "cylindrical_stage_gear_data": "is_driving_gear",
    "side_plate": (
        "inner_diameter outer_diameter length mass_of_component support_vector u_axis_vector "
        "w_axis_vector reference_component_for_position"
    ),
    "planet_carrier": "",
    "planetary_stage": "",
    "rack_shaped_tool": "addendum_coefficient_reference_profile tip_radius_factor",
    "tip_relief": "tip_relief_depth tip_relief_datum_diameter",
    "root_relief": "root_relief_depth root_relief_datum_diameter",
    "helix_crowning": "helix_crowning_amount_datum_face helix_crowning_amount_non_datum_face",
    "rolling_element": "diameter_of_rolling_element length_of_rolling_element",
    "rolling_bearing_row": (
        "number_of_rolling_elements pressure_angle raceway_radius_of_inner_ring "
        "raceway_radius_of_outer_ring reference_diameter_rolling_bearing "
        "axial_force_absorption_of_row"
    ),
    "coupling": (
        "u_coordinate_on_shaft_inner_side u_coordinate_on_shaft_outer_side axial_stiffness "
        "radial_stiffness bending_stiffness rotational_stiffness support_vector u_axis_vector "
        "w_axis_vector reference_component_for_position is_engaged"
    ),
    "concept_bearing": (
        "u_coordinate_on_shaft_inner_side u_coordinate_on_shaft_outer_side axial_stiffness "
        "radial_stiffness bending_stiffness axial_force_absorption radial_force_absorption "
        "support_vector u_axis_vector w_axis_vector reference_component_for_position width "
        "inner_diameter outer_diameter"
    ),
}
#: of bevel gears, which are read where this program wrote them
READ_OURS = {
    "bevel_gear": (
        READ["cylindrical_gear"] + " outer_pitch_diameter pitch_angle mean_spiral_angle "
        "spiral_angle_pitch_direction"
    ),
    "bevel_stage": "shaft_angle nominal_design_pressure_angle_drive",
}
READ["ring_gear"] = READ["cylindrical_gear"]
READ |= {
    joint: "support_vector u_axis_vector w_axis_vector reference_component_for_position"
    for joint in JOINTS
}
READ["switchable_coupling"] = READ["coupling"]
READ["rolling_bearing_with_catalog_geometry"] = (
    READ["concept_bearing"]
    + " catalogue_designation bearing_type manufacturer radial_dynamic_load_rating "
    "radial_static_load_rating fatigue_limit_load axial_dynamic_load_rating "
    "axial_static_load_rating radial_clearance_class radial_bearing_clearance "
    "mounted_radial_bearing_clearance number_of_bearing_rows distance_between_bearing_rows "
    "contamination_factor_iso_281_2007 preload_force preload_distance"
)
READ["rolling_bearing_with_detailed_geometry"] = READ["rolling_bearing_with_catalog_geometry"]
#: why parts are left out
UNREAD = "not read: no train here has such a part"
BEVEL = "not read: write [[mesh]] and the gears of a bevel stage into the train by hand"
#: stiffness at an operating point, of bearings
_OPERATING = "operating_point_stiffness"


@dataclass
class Notes:
    """What an import leaves out, assumes or doubts: for each reason the components that it is about."""

    dropped: dict[str, list[str]] = field(default_factory=dict)
    assumed: dict[str, list[str]] = field(default_factory=dict)
    contradictory: dict[str, list[str]] = field(default_factory=dict)
    #: what no file of REXS says, and only the user knows
    unknown: dict[str, list[str]] = field(default_factory=dict)

    def drop(self, component: Component | str, reason: str) -> None:
        """Note what is left out."""
        _add(self.dropped, component, reason)

    def assume(self, component: Component | str, reason: str) -> None:
        """Note what is assumed."""
        _add(self.assumed, component, reason)

    def doubt(self, component: Component | str, reason: str) -> None:
        """Note a contradiction, and what is taken."""
        _add(self.contradictory, component, reason)

    def ask(self, reason: str) -> None:
        """Note what only the user knows."""
        self.unknown[reason] = []

    def reasons(self, component: Component) -> list[str]:
        """Return why a component is left out."""
        return [reason for reason, labels in self.dropped.items() if component.title in labels]

    @property
    def groups(self) -> list[tuple[str, list[str]]]:
        """Headings with their lines, without those that have none."""
        groups = (
            ("Contradictory", self.contradictory),
            ("Assumed", self.assumed),
            ("Left out", self.dropped),
            ("Only you know", self.unknown),
        )
        return [(heading, [*map(_line, rows.items())]) for heading, rows in groups if rows]


def _add(rows: dict[str, list[str]], component: Component | str, reason: str) -> None:
    label = component if isinstance(component, str) else component.title
    labels = rows.setdefault(reason, [])
    if label not in labels:
        labels.append(label)


def _line(row: tuple[str, list[str]]) -> str:
    reason, labels = row
    return f"{'; '.join(labels)}: {reason}" if labels else reason


def unread(document: Document) -> Iterator[tuple[str, str]]:
    """Yield components of types that no train here has, and attributes without a place, by type."""
    names: dict[str, dict[str, None]] = {}
    read = READ | (READ_OURS if document.is_ours else {})
    spectra = (c for s in document.spectra for case in s.cases for c in case.components)
    for component in [*document.components.values(), *spectra]:
        kind = document.components[component.id].kind
        if kind not in read:
            yield f"{component.title} ({kind})", BEVEL if kind.startswith("bevel") else UNREAD
            continue
        words = read[kind].split()
        known = {*words, *(other for word in words for other in OTHER_NAMES.get(word, ()))}
        for name, attribute in component.attributes.items():
            used = name in known or name == REST or name.startswith(_OPERATING)
            if not used and attribute.value not in ("", ()):
                names.setdefault(kind, {})[name] = None
    for kind, attributes in names.items():
        yield f"attributes of {kind}", ", ".join(attributes)
