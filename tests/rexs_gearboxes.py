"""Small gearboxes in REXS for tests, made up, in the words of version 1.0 or of 1.4."""

from xml.sax.saxutils import quoteattr

#: type or attribute of 1.4 by that of 1.0
OLD = {
    "cylindrical_gear_flank": "flank_geometry",
    "cylindrical_stage_gear_data": "stage_gear_data",
    "catalogue_designation": "name",
    "radial_dynamic_load_rating": "dynamic_capacity",
    "radial_static_load_rating": "static_capacity",
    "radial_bearing_clearance": "radial_backlash",
    "contamination_factor_according_to_iso_281_2007": "contamination_factor_according_to_din_26281",
}
NONE = "none"


class Gearbox:
    """A document that grows: components with attributes, and relations."""

    def __init__(self, version="1.4"):
        self.version = version
        self.components, self.relations, self.cases = [], [], []

    def word(self, name):
        return OLD.get(name, name) if self.version == "1.0" else name

    def add(self, number, kind, name="", **attributes):
        """Add a component; attributes are values, or values with units."""
        self.components.append((number, self.word(kind), name, attributes))

    def place(self, origin, u=(1, 0, 0), w=(0, 0, 1)):
        """Return the attributes of a frame, in mm."""
        vectors = {"support_vector": origin, "u_axis_vector": u, "w_axis_vector": w}
        return {key: (tuple(vector), "mm") for key, vector in vectors.items()} | {
            "reference_component_for_position": (1, NONE)
        }

    def relate(self, kind, **roles):
        self.relations.append((kind, [(role, number) for role, number in roles.items()]))

    def sections(self, shaft, first, *sizes):
        """Add sections of (length, outer begin, outer end, bore) in mm, end to end."""
        u = 0.0
        for k, (length, begin, end, bore) in enumerate(sizes):
            self.add(
                first + k,
                "shaft_section",
                f"section {k}",
                u_coordinate_on_shaft=(u, "mm"),
                length=(length, "mm"),
                outer_diameter_begin=(begin, "mm"),
                outer_diameter_end=(end, "mm"),
                inner_diameter_begin=(bore, "mm"),
                inner_diameter_end=(bore, "mm"),
            )
            self.relate("assembly", assembly=shaft, part=first + k)
            u += length

    def bearing(self, number, shaft, u, kind="concept_bearing", name="", **attributes):
        """Add a bearing between a shaft and the casing, which is component 2."""
        self.add(
            number,
            kind,
            name or f"bearing {number}",
            u_coordinate_on_shaft_inner_side=(u, "mm"),
            u_coordinate_on_shaft_outer_side=(u, "mm"),
            **attributes,
        )
        self.relate("side", assembly=number, inner_part=shaft, outer_part=2)

    def gear(self, number, shaft, u, teeth, module, helix, width, shift, at):
        """Add a gear with both flanks; `u` is the middle of its face, `at` its place in space."""
        begin = u - width / 2 if self.version == "1.0" else u
        self.add(
            number,
            "cylindrical_gear",
            f"gear {number}",
            u_coordinate_on_shaft=(begin, "mm"),
            face_width=(width, "mm"),
            number_of_teeth=(teeth, NONE),
            normal_module=(module, "mm"),
            helix_angle_reference_diameter=(helix, "deg"),
            **self.place(at),
        )
        self.relate("assembly", assembly=shaft, part=number)
        for side, flank in (("left", 1000 + number), ("right", 2000 + number)):
            self.add(
                flank,
                "cylindrical_gear_flank",
                normal_pressure_angle=(20, "deg"),
                addendum_modification_coefficient=(shift, NONE),
            )
            if side == "left":
                self.relate("flank", gear=number, left=flank, right=1000 + flank)

    def xml(self):
        lines = ["<?xml version='1.0' encoding='UTF-8'?>"]
        lines.append(
            f'<model version="{self.version}" applicationId="test" applicationVersion="1" date="x">'
        )
        lines.append("<relations>")
        for k, (kind, refs) in enumerate(self.relations, 1):
            inside = "".join(f'<ref id="{n}" role="{role}"/>' for role, n in refs)
            lines.append(f'<relation id="{k}" type="{kind}">{inside}</relation>')
        lines += ["</relations>", "<components>"]
        lines += [self._component(*component) for component in self.components]
        lines.append("</components>")
        if self.cases:
            lines.append('<load_spectrum id="1">')
            for k, components in enumerate(self.cases, 1):
                inside = "".join(self._component(*component) for component in components)
                lines.append(f'<load_case id="{k}">{inside}</load_case>')
            lines.append("</load_spectrum>")
        return "\n".join([*lines, "</model>"])

    def _component(self, number, kind, name, attributes):
        inside = "\n".join(self._attribute(key, value) for key, value in attributes.items())
        named = f" name={quoteattr(name)}" if name else ""
        return f'<component id="{number}" type="{kind}"{named}>\n{inside}\n</component>'

    def _attribute(self, name, value):
        value, unit = value if isinstance(value, tuple) else (value, NONE)
        if isinstance(value, tuple):
            value = "<array>" + "".join(f"<c>{entry}</c>" for entry in value) + "</array>"
        return f'<attribute id="{self.word(name)}" unit="{unit}">{value}</attribute>'


def helical(version="1.4", **steel):
    """A helical pair: the pinion on bearings of given stiffness, the wheel on catalogue ones."""
    box = Gearbox(version)
    box.add(1, "gear_unit", "unit", **box.place((0, 0, 0)))
    box.add(2, "gear_casing", "casing", temperature_lubricant=(70, "C"))
    box.add(3, "shaft", "input", rotational_speed=(1500, "1 / min"), defines_speed="true",
            **box.place((0, 0, 0)))  # fmt: skip
    box.add(4, "shaft", "output", **box.place((10, 60, -80)))
    for shaft in (3, 4):
        box.relate("assembly", assembly=1, part=shaft)
    box.sections(3, 100, (40, 30, 30, 0), (60, 40, 40, 10), (50, 34, 28, 0))
    box.sections(4, 200, (45, 45, 45, 0), (40, 60, 60, 0), (45, 45, 45, 0))
    stiff = {
        "radial_stiffness": (2e8, "N / m"),
        "bending_stiffness": (5e6, "N mm / rad"),
        "radial_force_absorption": "true",
        "width": (16, "mm"),
    }
    box.bearing(
        10, 3, 15, axial_stiffness=(1e8, "N / m"), axial_force_absorption="both_directions", **stiff
    )
    box.bearing(11, 3, 125, axial_force_absorption="no_direction", **stiff)
    catalogue = {
        "kind": "rolling_bearing_with_catalog_geometry",
        "bearing_type": "radial_grooved_ball_bearing",
        "contamination_factor_according_to_iso_281_2007": (0.5, NONE),
    }
    box.bearing(
        12, 4, 20, name="left", catalogue_designation="6209", axial_force_absorption="both_directions",
        radial_dynamic_load_rating=(35.1, "kN"), radial_static_load_rating=(21.6, "kN"), **catalogue
    )  # fmt: skip
    box.bearing(
        13, 4, 110, name="right", catalogue_designation="6209-C3",
        axial_force_absorption="no_direction", **catalogue
    )  # fmt: skip
    box.gear(20, 3, 70, 23, 2.5, 15, 30, 0.2, (70, 0, 0))
    box.gear(21, 4, 62, 53, 2.5, -15, 28, 0.1, (72, 60, -80))
    box.add(30, "cylindrical_stage", "stage", center_distance=(100, "mm"))
    box.relate("assembly", assembly=1, part=30)
    box.relate("stage", stage=30, gear_1=20, gear_2=21)
    box.add(40, "external_load", "in", u_coordinate_on_shaft=(0, "mm"), transmits_torque="true",
            defines_torque="true", torque_around_u_axis=(120, "N m"))  # fmt: skip
    box.add(41, "external_load", "out", u_coordinate_on_shaft=(130, "mm"), transmits_torque="true")
    box.relate("assembly", assembly=3, part=40)
    box.relate("assembly", assembly=4, part=41)
    box.add(50, "material", "steel", elastic_modulus=(206000, "N / mm^2"), poisson_ratio=(0.3, NONE),
            density=(7.83, "kg / dm^3"), **steel)  # fmt: skip
    for shaft in (3, 4):
        box.relate("reference", origin=shaft, referenced=50)
    box.add(51, "lubricant", "oil", viscosity_at_40_degree_celsius=(100, "mm^2 / s"),
            viscosity_at_100_degree_celsius=(11, "mm^2 / s"))  # fmt: skip
    return box


def planetary():
    """A spur planetary stage with three planets, whose ring a coupling holds."""
    box = Gearbox()
    box.add(1, "gear_unit", "unit", **box.place((0, 0, 0)))
    box.add(2, "gear_casing", "casing")
    box.add(3, "shaft", "sun", rotational_speed=(1000, "1 / min"), **box.place((0, 0, 0)))
    box.add(4, "shaft", "carrier", **box.place((-80, 0, 0)))
    box.add(5, "shaft", "ring", **box.place((0, 0, 0)))
    box.sections(3, 100, (120, 30, 30, 0))
    box.sections(4, 110, (80, 60, 60, 0))
    box.sections(5, 120, (30, 200, 200, 180))
    rigid = {"radial_stiffness": (1e20, "N / m"), "radial_force_absorption": "true"}
    for number, shaft, u, axial in ((10, 3, 60, "both_directions"), (11, 3, 100, "no_direction"),
                                    (12, 4, 20, "both_directions"), (13, 4, 60, "no_direction")):  # fmt: skip
        box.bearing(number, shaft, u, axial_force_absorption=axial, width=(12, "mm"), **rigid)
    box.gear(20, 3, 15, 17, 2, 0, 30, 0, (15, 0, 0))
    box.add(21, "ring_gear", "ring gear", number_of_teeth=(-61, NONE), normal_module=(2, "mm"),
            face_width=(30, "mm"), **box.place((15, 0, 0)))  # fmt: skip
    box.relate("assembly", assembly=5, part=21)
    box.add(9, "planetary_stage", "stage")
    box.add(8, "planet_carrier", "cage")
    box.relate("assembly", assembly=9, part=8)
    box.relate("central_shaft", planetary_stage=9, shaft=3)
    box.relate("planet_carrier_shaft", planetary_stage=9, shaft=4)
    box.add(14, "coupling", "hold", rotational_stiffness=(1e20, "N mm / rad"))
    box.relate("side", assembly=14, inner_part=5, outer_part=2)
    box.add(7, "side_plate", "plate", outer_diameter=(110, "mm"), inner_diameter=(60, "mm"),
            length=(8, "mm"), **box.place((-8, 0, 0)))  # fmt: skip
    box.relate("assembly", assembly=8, part=7)
    for k, (v, w) in enumerate(((0, 39), (33.774990748, -19.5), (-33.774990748, -19.5))):
        planet, pin, bearing = 60 + k, 65 + k, 70 + k
        box.add(planet, "shaft", f"planet {k}", **box.place((0, v, w)))
        box.sections(planet, 300 + k, (30, 24, 24, 20))
        box.add(pin, "shaft", f"pin {k}", **box.place((-8, v, w)))
        box.sections(pin, 310 + k, (46, 18, 18, 0))
        box.relate("planet_shaft", planetary_stage=9, shaft=planet)
        box.relate("planet_pin", planetary_stage=9, shaft=pin)
        for m, u in ((0, 8), (1, 22)):
            number = bearing + 10 * m
            box.add(number, "concept_bearing", f"planet bearing {number}",
                    u_coordinate_on_shaft_inner_side=(u + 8, "mm"),
                    u_coordinate_on_shaft_outer_side=(u, "mm"), radial_stiffness=(5e8, "N / m"),
                    axial_stiffness=(1e8, "N / m"),
                    axial_force_absorption="both_directions" if m == 0 else "no_direction")  # fmt: skip
            box.relate("side", assembly=number, inner_part=pin, outer_part=planet)
        box.gear(30 + k, planet, 15, 22, 2, 0, 30, 0, (15, v, w))
        for number, mate, first in ((90 + k, 20, 20), (95 + k, 21, 30 + k)):
            box.add(number, "cylindrical_stage", f"mesh {number}", center_distance=(39, "mm"))
            box.relate("assembly", assembly=9, part=number)
            second = 30 + k if mate == 20 else 21
            box.relate("stage", stage=number, gear_1=first, gear_2=second)
    box.add(40, "external_load", "in", u_coordinate_on_shaft=(120, "mm"), transmits_torque="true",
            defines_torque="true", power=(20, "kW"))  # fmt: skip
    box.add(41, "external_load", "out", u_coordinate_on_shaft=(0, "mm"), transmits_torque="true")
    box.relate("assembly", assembly=3, part=40)
    box.relate("assembly", assembly=4, part=41)
    return box
