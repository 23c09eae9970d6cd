"""Gears and meshes of a REXS document as tables of a train."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, hypot, pi, radians
from typing import Any

import numpy as np

from solidgear.exchange.rexs.commented import Sourced, deg, mm, said
from solidgear.exchange.rexs.document import Component, Document, RexsError
from solidgear.exchange.rexs.gearbox import NEAR, SHARE, Gearbox, GearOnShaft, PairStage
from solidgear.exchange.rexs.materials import density_of
from solidgear.exchange.rexs.units import UNIT_OF, UNITS

#: c_gamma of steel gears (ISO 6336-1), N/m for a metre of face
USUAL_STIFFNESS = 20e9
USUAL_PRESSURE_ANGLE = radians(20)
SHIFT = "addendum_modification_coefficient"
#: difference of tooth data of both flanks, or of both gears, that digits leave
SAME = 1e-6


def flanks_of(document: Document, gear: Component) -> list[Component]:
    """Return the left and the right flank of a gear, as far as the file has them."""
    out = []
    for relation in document.related("flank", gear, "gear"):
        out += [document.components[i] for side in ("left", "right") for i in relation.ids(side)]
    return out


def flank_number(gearbox: Gearbox, gear: Component, name: str) -> tuple[float | None, str]:
    """Return a number of both flanks, and where it came from; note flanks that differ."""
    flanks = flanks_of(gearbox.document, gear)
    numbers = {f.label: f.number(name) for f in flanks}
    values = [value for value in numbers.values() if value is not None]
    if not values:
        return None, ""
    if max(values) - min(values) > SAME:
        gearbox.notes.doubt(
            gear,
            f"{name} of left and right flank are {' and '.join(_in_file(name, v) for v in values[:2])}: "
            "the first is taken",
        )
    return values[0], f"{next(k for k, v in numbers.items() if v is not None)}: {name}"


def _in_file(name: str, value: float) -> str:
    """Return a number of an attribute in the unit of REXS."""
    unit = UNIT_OF.get(name, "none")
    return f"{value / UNITS[unit][1]:.6g}" + (f" {unit}" if unit != "none" else "")


def shift_of(gearbox: Gearbox, gear: Component) -> float:
    """Return the profile shift of a gear, in modules: of its flanks, or as it was filled."""
    shift, _ = flank_number(gearbox, gear, SHIFT)
    return gearbox.shifts.get(gear.id, 0.0) if shift is None else shift


def gear_table(gearbox: Gearbox, gear: GearOnShaft, loaded_side: str = "") -> dict[str, Any]:
    """Return the table of a gear."""
    component, document = gear.component, gearbox.document
    label = component.label
    if component.kind == "bevel_gear":
        return _bevel_table(component)
    table: dict[str, Any] = {"teeth": Sourced(teeth_of(component), f"{label}: number_of_teeth")}
    helix = component.number("helix_angle_reference_diameter")
    if helix is None:
        gearbox.notes.assume(
            component, "no helix_angle_reference_diameter is given: straight teeth"
        )
    if helix:
        hand = "right" if (helix > 0) else "left"
        table["hand"] = Sourced(hand, f"{label}: sign of helix_angle_reference_diameter")
    if loaded_side:
        table["loaded_side"] = Sourced(loaded_side, "from the direction of the torque")
    table["module"] = Sourced(mm(module_of(component)), f"{label}: normal_module")
    if helix:
        angle = Sourced(deg(abs(helix)), f"{label}: helix_angle_reference_diameter")
        table["helix_angle"] = angle
    width = component.number("face_width")
    if width:
        table["face_width"] = Sourced(mm(width), f"{label}: face_width")
    shift, source = flank_number(gearbox, component, SHIFT)
    if shift is None:
        shift, source = shift_of(gearbox, component), "from the centre distance"
    if shift:
        table["profile_shift"] = Sourced(round(shift, 12), source)
    table |= _tips(gearbox, component) | _rack(document, component)
    table |= _modifications(gearbox, component, gear.shaft.sign)
    if head := _head(gearbox, gear):
        table["head"] = head
    return table


def _bevel_table(gear: Component) -> dict[str, Any]:
    """Return the table of a bevel gear."""
    table: dict[str, Any] = {"teeth": Sourced(teeth_of(gear), f"{gear.label}: number_of_teeth")}
    if hand := gear.text("spiral_angle_pitch_direction"):
        table["hand"] = Sourced(hand, f"{gear.label}: spiral_angle_pitch_direction")
    if diameter := gear.number("outer_pitch_diameter"):
        table["pitch_radius"] = Sourced(mm(diameter / 2), f"{gear.label}: outer_pitch_diameter")
    if width := gear.number("face_width"):
        table["face_width"] = Sourced(mm(width), f"{gear.label}: face_width")
    for key, name in (("pitch_angle", "pitch_angle"), ("spiral_angle", "mean_spiral_angle")):
        if (angle := gear.number(name)) is not None:
            table[key] = Sourced(deg(angle), f"{gear.label}: {name}")
    if mass := gear.number("mass_of_component"):
        table["head"] = {"mass": Sourced(said(mass, "kg"), f"{gear.label}: mass_of_component")}
    return table


def teeth_of(gear: Component) -> int:
    """Return the teeth of a gear or a ring, above zero."""
    teeth = gear.whole("number_of_teeth")
    if teeth is None or teeth == 0:
        raise gear.wrong("number_of_teeth", "is missing" if teeth is None else "must not be zero")
    return abs(teeth)


def module_of(gear: Component) -> float:
    """Return the normal module of a gear, m."""
    module = gear.number("normal_module")
    if module is None or module <= 0:
        reason = "is missing" if module is None else "must be greater than zero"
        raise gear.wrong("normal_module", reason)
    return module


@dataclass(frozen=True)
class Circles:
    """Radii of a gear that the basic rack of ISO 53 cuts, m."""

    radius: float  #: of the reference circle
    tip: float
    root: float


def circles_of(gearbox: Gearbox, gear: Component) -> Circles:
    """Return the radii of a gear."""
    module, shift = module_of(gear), shift_of(gearbox, gear)
    helix = gear.number("helix_angle_reference_diameter") or 0.0
    radius = module * teeth_of(gear) / (2 * cos(helix))
    return Circles(radius, radius + module * (1 + shift), radius - module * (1.25 - shift))


def _tips(gearbox: Gearbox, gear: Component) -> dict[str, Any]:
    tip = gear.number("tip_diameter")
    if not tip:
        return {}
    wheel = circles_of(gearbox, gear)
    # the thinnest and the thickest teeth that a rack of any standard gives
    low, high = 2 * wheel.root, 2 * (wheel.tip + module_of(gear))
    if not low < tip < high:
        gearbox.notes.doubt(
            gear,
            f"tip_diameter {1e3 * tip:.6g} mm does not fit its teeth, whose roots lie at "
            f"{1e3 * low:.6g} mm; that of the basic rack is taken, {2e3 * wheel.tip:.6g} mm",
        )
        return {}
    return {"tip_diameter": Sourced(mm(tip), f"{gear.label}: tip_diameter")}


def _rack(document: Document, gear: Component) -> dict[str, Any]:
    """Return the rack that the tool of a gear makes: what is the tool's addendum is the dedendum of
    the teeth.
    """
    tools = document.referenced(gear, "rack_shaped_tool")
    flanks = flanks_of(document, gear)
    for relation in document.relations:
        if relation.type == "manufacturing_step":
            cut = [flank.id for flank in flanks if flank.id in relation.ids("workpiece")]
            tools += [document.components[i] for i in relation.ids("tool") if cut]
    tools = [tool for tool in tools if tool.kind == "rack_shaped_tool"]
    if not tools:
        return {}
    tool = tools[0]
    rack = {}
    dedendum = tool.number("addendum_coefficient_reference_profile")
    radius = tool.number("tip_radius_factor")
    if dedendum:
        rack["dedendum"] = Sourced(
            dedendum, f"{tool.label}: addendum_coefficient_reference_profile"
        )
    if radius:
        rack["root_radius"] = Sourced(radius, f"{tool.label}: tip_radius_factor")
    return {"rack": Sourced(rack, tool.label)} if rack else {}


def _modifications(gearbox: Gearbox, gear: Component, sign: int) -> dict[str, Any]:
    """Return relief and crowning, of the first flank that has them."""
    document, notes = gearbox.document, gearbox.notes
    kinds = ("tip_relief", "root_relief", "helix_crowning")
    flanks = flanks_of(document, gear)
    by_kind = {k: [c for f in flanks for c in document.referenced(f, k)] for k in kinds}
    out: dict[str, Any] = {}
    relief: dict[str, Any] = {}
    for kind, depth, start in (("tip_relief", "tip", "from"), ("root_relief", "root", "root_from")):
        for component in by_kind[kind][:1]:
            amount = component.number(f"{kind}_depth")
            diameter = component.number(f"{kind}_datum_diameter")
            if amount:
                source = f"{component.label}: {kind}_depth"
                relief[depth] = Sourced(said(abs(amount), "um", 1e-6), source)
                if diameter:
                    relief[start] = Sourced(mm(diameter), component.label)
    if relief:
        source = ", ".join(c.label for k in kinds[:2] for c in by_kind[k][:1])
        out["relief"] = Sourced(relief, source)
    for component in by_kind["helix_crowning"][:1]:
        names = [f"helix_crowning_amount_{face}_face" for face in ("datum", "non_datum")]
        amounts = [component.number(name) or 0.0 for name in names]
        if max(amounts) - min(amounts) > 1e-9:
            notes.assume(component, "crowns both ends of the face alike, by the mean of both")
        if any(amounts):
            text = said(abs(sum(amounts)) / 2, "um", 1e-6)
            out["crowning"] = Sourced(text, f"{component.label}: helix_crowning_amount")
    if len(flanks) > 1 and any(len(found) == 1 for found in by_kind.values()):
        notes.assume(gear, "both flanks are modified as the one of which the file says it")
    return out


def _head(gearbox: Gearbox, gear: GearOnShaft) -> dict[str, Any]:
    """Return the rigid mass of a wheel that is thicker than its shaft: up to the middle of its teeth,
    or as heavy as the file says.
    """
    component, shaft = gear.component, gear.shaft
    width, given = component.number("face_width"), component.number("mass_of_component")
    if not width or gearbox.document.is_ours and not given:
        return {}
    wheel = circles_of(gearbox, component)
    outer = wheel.tip + wheel.root
    lo, hi = gear.y - width / 2, gear.y + width / 2
    inner = max(shaft.mean_outer(lo, hi), component.number("inner_diameter") or 0.0)
    if inner >= outer:
        return {}
    density, _ = density_of(gearbox, component, shaft.component)
    mass, torsional, bending = ring_inertia(outer, inner, width, density)
    source = f"{component.label}: from {1e3 * inner:.4g} mm of its shaft to the middle of its teeth"
    if given:
        torsional, bending, mass = torsional * given / mass, bending * given / mass, given
        source = f"{component.label}: mass_of_component"
    else:
        gearbox.notes.assume(
            "wheels without mass_of_component",
            "are rigid and full, from the shaft to the middle of their teeth",
        )
    return {
        "mass": Sourced(said(round(mass, 9), "kg"), source),
        "torsional": said(torsional, "kg*m^2"),
        "bending": said(bending, "kg*m^2"),
    }


def ring_inertia(
    outer: float, inner: float, width: float, density: float
) -> tuple[float, float, float]:
    """Return mass (kg), and inertia about the axis and across it (kg m^2), of a ring by diameters."""
    mass = density * pi / 4 * (outer**2 - inner**2) * width
    torsional = mass * (outer**2 + inner**2) / 8
    return mass, torsional, torsional / 2 + mass * width**2 / 12


def mesh_table(gearbox: Gearbox, stage: PairStage, has_torque: bool) -> dict[str, Any]:
    """Return the table of a mesh; its gears are in the order in which power passes them."""
    first, second = stage.gears
    label = stage.component.label
    if stage.component.kind == "bevel_stage":
        return _bevel_mesh(stage)
    a, b = first.component, second.component
    for name in ("normal_module", "helix_angle_reference_diameter"):
        values = [abs(gear.number(name) or 0.0) for gear in (a, b)]
        if abs(values[0] - values[1]) > SAME * (1 + values[0]):
            raise b.wrong(name, f"is not that of {a.label}, and both are in {label}")
    table: dict[str, Any] = {
        "name": stage.name,
        "between": Sourced([f"{g.shaft.name}.{g.name}" for g in stage.gears], label),
        "shaft_angle": 0,
    }
    _refuse_one_hand(stage)
    angle, source = pressure_angle(gearbox, stage)
    table["pressure_angle"] = Sourced(deg(angle), source)
    table |= _where(gearbox, stage)
    table |= _stiffness(gearbox, stage, has_torque)
    return table


def _refuse_one_hand(stage: PairStage) -> None:
    """Refuse two helical gears on parallel shafts that lean the same way."""
    name = "helix_angle_reference_diameter"
    a, b = (gear.component for gear in stage.gears)
    first, second = (gear.number(name) or 0.0 for gear in (a, b))
    if first * second > 0:
        hand = "right" if first > 0 else "left"
        raise b.wrong(
            name,
            f"{a.label} and this gear are both {hand}-handed, and {stage.component.label} on parallel "
            "shafts needs one of each hand: change the sign of one",
        )


def pressure_angle(gearbox: Gearbox, stage: PairStage) -> tuple[float, str]:
    """Return the normal pressure angle of a stage, rad, and where it came from; note gears that differ
    and gears without one.
    """
    name = "normal_pressure_angle"
    gears = [gear.component for gear in stage.gears]
    rows = [flank_number(gearbox, gear, name) for gear in gears]
    angles = [(angle, source) for angle, source in rows if angle is not None]
    if not angles:
        gearbox.notes.assume(stage.component, f"its {name} is 20 deg")
        return USUAL_PRESSURE_ANGLE, "assumed: ISO 53"
    if len(angles) == 2 and abs(angles[0][0] - angles[1][0]) > SAME:
        words = " and ".join(_in_file(name, angle) for angle, _ in angles)
        gearbox.notes.doubt(
            stage.component,
            f"{name} of {gears[0].title} and {gears[1].title} are {words}, and such teeth do not mesh: "
            "the first is taken",
        )
    return angles[0]


def _bevel_mesh(stage: PairStage) -> dict[str, Any]:
    """Return the table of a mesh of bevel gears."""
    component = stage.component
    table: dict[str, Any] = {
        "name": stage.name,
        "between": Sourced([f"{g.shaft.name}.{g.name}" for g in stage.gears], component.label),
    }
    rows = (
        ("shaft_angle", "shaft_angle"),
        ("pressure_angle", "nominal_design_pressure_angle_drive"),
    )
    for key, name in rows:
        if (angle := component.number(name)) is not None:
            table[key] = Sourced(deg(angle), f"{component.label}: {name}")
    return table


def _where(gearbox: Gearbox, stage: PairStage) -> dict[str, Any]:
    """Return centre distance, azimuth and offset along the axes of a mesh."""
    first, second = stage.gears
    label, notes = stage.component.label, gearbox.notes
    out: dict[str, Any] = {}
    distance, source = centre_distance(gearbox, stage)
    turned = stage.component.number("rotating_angle_around_neg_u_axis")
    frames = first.shaft.frame, second.shaft.frame
    if frames[0] is None or frames[1] is None:
        if distance:
            out["centre_distance"] = Sourced(mm(distance), source)
        if turned is not None:
            azimuth = (pi - turned + pi) % (2 * pi) - pi
            source = f"{label}: rotating_angle_around_neg_u_axis"
            out["azimuth"] = Sourced(deg(azimuth), source)
        return out
    apart = gear_places(gearbox, second) - gear_places(gearbox, first)
    across = hypot(apart[0], apart[2])
    if across < NEAR:
        raise RexsError(
            f"{label}: the axes of {first.component.label} and {second.component.label} are one"
        )
    due = distance or across
    if abs(across - due) > SHARE * due:
        notes.doubt(
            stage.component,
            f"center_distance {1e3 * due:.6g} mm, and its shafts lie {1e3 * across:.6g} mm apart: "
            "the first is taken",
        )
    out["centre_distance"] = Sourced(mm(round(due, 12)), source)
    azimuth = atan2(apart[2], -apart[0])
    if abs(azimuth) > 1e-9:
        # half a turn is one place, whatever the sign of a zero
        azimuth += 2 * pi if azimuth < -pi + 1e-9 else 0.0
        out["azimuth"] = Sourced(deg(azimuth), "from the places of shafts")
    if abs(apart[1]) > NEAR:
        place = [mm(-due), mm(round(apart[1], 9)), mm(0.0)]
        out["gear_position"] = Sourced(place, "faces that do not lie beside each other")
    return out


def centre_distance(gearbox: Gearbox, stage: PairStage) -> tuple[float | None, str]:
    """Return the centre distance of a stage, m, and where it came from: that of the file, or between
    its shafts; None where the file has neither.
    """
    if distance := stage.component.number("center_distance"):
        return distance, f"{stage.component.label}: center_distance"
    first, second = stage.gears
    if first.shaft.frame is None or second.shaft.frame is None:
        return None, ""
    apart = gear_places(gearbox, second) - gear_places(gearbox, first)
    return hypot(apart[0], apart[2]), "the places of shafts"


def gear_places(gearbox: Gearbox, gear: GearOnShaft) -> np.ndarray:
    """Return the place (3,) of a gear in x, y, z of the first shaft, m."""
    shaft, first = gear.shaft, gearbox.reference
    assert shaft.frame is not None and first is not None  # asked of placed shafts
    u = gear.y if shaft.sign > 0 else shaft.length - gear.y
    place = shaft.frame.origin + (u + shaft.first) * shaft.frame.u - first.origin
    return first.train_axes.T @ place


def _stiffness(gearbox: Gearbox, stage: PairStage, has_torque: bool) -> dict[str, Any]:
    """Return the stiffness of a mesh: from its contact under a torque, else that of the file or the
    usual one.
    """
    has_width = all(g.component.number("face_width") for g in stage.gears)
    if has_torque and has_width and not is_stiffness_given(gearbox, stage.component):
        return {"stiffness": Sourced("teeth", "from the contact of the teeth under the torque")}
    widths = [g.component.number("face_width") or 0.0 for g in stage.gears]
    width = min(w for w in widths if w) if any(widths) else 0.0
    return mesh_stiffness(gearbox, stage.component, width, "stiffness")


def is_stiffness_given(gearbox: Gearbox, stage: Component) -> bool:
    """Return True for a stage with the stiffness of its file; other programs give that of a standard."""
    name = "mesh_stiffness_for_load_distribution_along_face_width"
    return gearbox.document.is_ours and stage.number(name) is not None


def mesh_stiffness(gearbox: Gearbox, stage: Component, width: float, key: str) -> dict[str, Any]:
    """Return the stiffness of a mesh by that of a metre of face."""
    width = stage.number("common_face_width") or width
    name = "mesh_stiffness_for_load_distribution_along_face_width"
    each = stage.number(name)
    if not width:
        raise RexsError(f"{stage.label}: no gear of it has a face_width")
    source = f"{stage.label}: {name} times common_face_width"
    if not each:
        each, source = USUAL_STIFFNESS, "assumed: 20 N/(mm um), usual of steel (ISO 6336-1)"
        gearbox.notes.assume(stage, "its mesh is as stiff as usual, 20 N/(mm um) of its face width")
    return {key: Sourced(said(each * width, "N/m"), source)}


def ratio_of(first: GearOnShaft, second: GearOnShaft) -> float:
    """Return the teeth of the second gear over those of the first."""
    return teeth_of(second.component) / teeth_of(first.component)
