"""Planetary stages of a REXS document as tables of a train."""

from __future__ import annotations

from collections.abc import Iterator
from math import atan2, pi
from typing import Any

import numpy as np

from solidgear.core.scene.support import RIGID
from solidgear.exchange.rexs.bearings import absorbed
from solidgear.exchange.rexs.commented import Sourced, deg, mm, said
from solidgear.exchange.rexs.document import Component, RexsError
from solidgear.exchange.rexs.frames import frame_of
from solidgear.exchange.rexs.gearbox import (
    SHARE,
    Gearbox,
    PlanetStage,
    couplings_of,
    place_of,
    stage_gears,
)
from solidgear.exchange.rexs.gears import (
    SHIFT,
    USUAL_PRESSURE_ANGLE,
    circles_of,
    flank_number,
    gear_places,
    is_stiffness_given,
    mesh_stiffness,
    ring_inertia,
    shift_of,
    teeth_of,
)
from solidgear.exchange.rexs.materials import STEEL, density_of, material_of
from solidgear.exchange.rexs.pins import clamped_compliance, on_middle
from solidgear.exchange.rexs.shafts import Shaft


def stage_table(gearbox: Gearbox, stage: PlanetStage, has_torque: bool) -> dict[str, Any]:
    """Return the table of a planetary stage.

    Raises
    ------
    RexsError
        Planets that differ, or profile shifts, which stages of trains do not have.
    """
    notes = gearbox.notes
    _refuse_shifts(gearbox, stage)
    first = stage.planets[0].component
    table: dict[str, Any] = {
        "sun": Sourced(f"{stage.sun.shaft.name}.{stage.sun.name}", stage.sun.component.label),
        "carrier": Sourced(
            f"{stage.carrier.name}.{point_of(stage)}", stage.carrier.component.label
        ),
        "ring_teeth": Sourced(teeth_of(stage.ring), f"{stage.ring.label}: number_of_teeth"),
    }
    table |= _angles(gearbox, stage)
    table["planet"] = {
        "teeth": Sourced(teeth_of(first), f"{first.label}: number_of_teeth"),
        **_planet_mass(gearbox, stage),
        "pin": _pin(gearbox, stage),
    }
    notes.assume(stage.component, "its ring is fixed, and its planets are rigid")
    angle, source = flank_number(gearbox, stage.sun.component, "normal_pressure_angle")
    if angle is None:
        angle, source = USUAL_PRESSURE_ANGLE, "assumed: ISO 53"
        notes.assume(stage.component, "its normal_pressure_angle is 20 deg")
    mesh: dict[str, Any] = {}
    widths = [g.number("face_width") or 0.0 for g in (stage.sun.component, first, stage.ring)]
    width = min(w for w in widths if w) if any(widths) else 0.0
    for mate in ("sun", "ring"):
        part = next(p for p in stage.stages if _is_of_ring(gearbox, p) == (mate == "ring"))
        if has_torque and width and not is_stiffness_given(gearbox, part):
            mesh[f"{mate}_stiffness"] = Sourced("teeth", "from the contact of the teeth")
            continue
        mesh |= mesh_stiffness(gearbox, part, width, f"{mate}_stiffness")
    mesh["pressure_angle"] = Sourced(deg(angle), source)
    table["mesh"] = mesh
    distance = stage.stages[0].number("center_distance")
    due = circles_of(gearbox, stage.sun.component).radius + circles_of(gearbox, first).radius
    if distance and abs(distance - due) > SHARE * due:
        notes.doubt(
            stage.stages[0],
            f"center_distance {1e3 * distance:.6g} mm, and its teeth without profile shift roll at "
            f"{1e3 * due:.6g} mm: the teeth are taken",
        )
    return table


def point_of(stage: PlanetStage) -> str:
    """Return the name of the lumped point of the carrier that holds the pins."""
    return pins_name(stage.name)


def pins_name(stage: str) -> str:
    """Return the name of the lumped point that holds the pins of a stage."""
    return f"pins_{stage}"[:40]


def _is_of_ring(gearbox: Gearbox, part: Component) -> bool:
    ids = stage_gears(gearbox.document, part) or ()
    return any(gearbox.document.components[i].kind == "ring_gear" for i in ids)


def _refuse_shifts(gearbox: Gearbox, stage: PlanetStage) -> None:
    gears = [stage.sun.component, *(p.component for p in stage.planets), stage.ring]
    for gear in gears:
        if flank_number(gearbox, gear, SHIFT)[0] is None:
            gearbox.notes.assume(gear, f"no {SHIFT} is given: 0")
        if shift_of(gearbox, gear):
            raise RexsError(
                f"{gear.label} of {stage.component.label}: has a profile shift, and planetary stages "
                "of trains have none; set addendum_modification_coefficient to 0 to go on"
            )
    teeth = {teeth_of(planet.component) for planet in stage.planets}
    if len(teeth) > 1:
        raise RexsError(
            f"{stage.component.label}: its planets have {sorted(teeth)} teeth; one is needed"
        )


def _angles(gearbox: Gearbox, stage: PlanetStage) -> dict[str, Any]:
    """Return how many planets there are, and where they stand."""
    count = len(stage.planets)
    if any(g.shaft.frame is None for g in (stage.sun, *stage.planets)):
        return {"planets": Sourced(count, "at equal angles; the file places none")}
    sun = gear_places(gearbox, stage.sun)
    places = [gear_places(gearbox, planet) - sun for planet in stage.planets]
    angles = sorted(atan2(-p[2], p[0]) % (2 * pi) for p in places)
    angles = [0.0 if angle > 2 * pi - SHARE else angle for angle in angles]
    angles.sort()
    steps = np.diff([*angles, angles[0] + 2 * pi])
    if np.max(np.abs(steps - 2 * pi / count)) < SHARE:
        table: dict[str, Any] = {"planets": Sourced(count, "at equal angles, as their shafts lie")}
        if angles[0] > SHARE:
            table["position"] = Sourced(deg(round(angles[0], 12)), "of the first planet")
        return table
    return {"angles": Sourced([deg(round(a, 12)) for a in angles], "as their shafts lie")}


def _planet_mass(gearbox: Gearbox, stage: PlanetStage) -> dict[str, Any]:
    """Return mass and inertia of a planet: its rim up to the middle of its teeth, and its shaft."""
    planet = stage.planets[0]
    gear, shaft = planet.component, planet.shaft
    width = gear.number("face_width") or shaft.length
    wheel = circles_of(gearbox, gear)
    density, source = density_of(gearbox, gear, shaft.component)
    inner = shaft.mean_outer(planet.y - width / 2, planet.y + width / 2)
    bodies = [(*ring_inertia(wheel.tip + wheel.root, inner, width, density), 0.0)]
    bodies += section_bodies(gearbox, shaft, planet.y)
    mass, torsional, bending = total(bodies)
    given = gear.number("mass_of_component")
    source = f"{gear.label} up to the middle of its teeth, and {shaft.component.label}"
    if given:
        torsional, bending, mass = torsional * given / mass, bending * given / mass, given
        source = f"{gear.label}: mass_of_component"
    return {
        "mass": Sourced(said(round(mass, 9), "kg"), source),
        "torsional": said(torsional, "kg*m^2"),
        "bending": said(bending, "kg*m^2"),
    }


#: mass, inertia about the axis and across it through its centre, and place along the axis
Body = tuple[float, float, float, float]


def section_bodies(gearbox: Gearbox, shaft: Shaft, origin: float) -> list[Body]:
    """Return the sections of a shaft as bodies, by places from `origin`, m; none without density."""
    material = material_of(gearbox, shaft.component)
    if material is not None and material.number("density") is None:
        gearbox.notes.assume(shaft.component, f"has no mass: {material.label} has no density")
        return []
    density, _ = density_of(gearbox, shaft.component)
    out = []
    for section in shaft.sections:
        outer, inner = (sum(ends) / 2 for ends in (section.outer, section.inner))
        body = ring_inertia(outer, inner, section.length, density)
        out.append((*body, (section.y0 + section.y1) / 2 - origin))
    return out


def total(bodies: list[Body]) -> tuple[float, float, float]:
    """Return mass and inertia about the axis and across it at the origin of bodies."""
    mass = sum(body[0] for body in bodies)
    torsional = sum(body[1] for body in bodies)
    bending = sum(body[2] + body[0] * body[3] ** 2 for body in bodies)
    return mass, torsional, bending


def _pin(gearbox: Gearbox, stage: PlanetStage) -> dict[str, Any]:
    """Return the springs of pin and planet bearings."""
    document, notes = gearbox.document, gearbox.notes
    planet = stage.planets[0]
    bearings = [
        b
        for b in document.components.values()
        if "bearing" in b.kind and planet.shaft.component in (document.sides_of(b) or ())
    ]
    if not bearings:
        raise RexsError(f"{planet.component.label}: its shaft has no bearing on a pin")
    arms, compliance, axial = [], [], 0.0
    for bearing in bearings:
        sides = document.sides_of(bearing)
        side = "outer" if sides and sides[1] == planet.shaft.component else "inner"
        u = place_of(gearbox, bearing, planet.shaft, f"u_coordinate_on_shaft_{side}_side")
        arms.append(planet.shaft.place(u) - planet.y)
        stiffness = bearing.number("radial_stiffness") or RIGID
        compliance.append(1 / min(stiffness, RIGID))
        if absorbed(bearing, notes) != "no_direction":
            axial += min(bearing.number("axial_stiffness") or RIGID, RIGID)
    matrix = np.diag(compliance)
    source = ", ".join(b.label for b in bearings)
    pin = _pin_of(gearbox, stage, bearings)
    along = axial or sum(1 / c for c in compliance)
    if pin is not None:
        pin_matrix, pin_axial = _pin_compliance(gearbox, pin, planet.shaft, arms, planet.y)
        matrix, along = matrix + pin_matrix, 1 / (1 / along + pin_axial)
        source += f", and {pin.component.label} clamped in its plates"
    K = on_middle(matrix, arms)
    if len(bearings) == 1:
        width = bearings[0].number("width") or planet.component.number("face_width") or 0.0
        if pin is None and bearings[0].number("bending_stiffness"):
            return _pin_springs(bearings[0])
        K[1, 1] = (bearings[0].number("bending_stiffness") or 0.0) or K[0, 0] * width**2 / 12
        notes.assume(bearings[0], "tilts as if its radial stiffness were spread over its width")
    notes.assume(stage.component, "pins and planet bearings are springs at the middle of a planet")
    return {
        "radial": Sourced(said(float(f"{K[0, 0]:.6g}"), "N/m"), source),
        "axial": said(float(f"{along:.6g}"), "N/m"),
        "tilting": said(float(f"{K[1, 1]:.6g}"), "N*m/rad"),
    }


def _pin_springs(bearing: Component) -> dict[str, Any]:
    """Return the springs of a single bearing that has all three, and no pin."""
    rows = (("radial", "N/m"), ("axial", "N/m"), ("bending", "N*m/rad"))
    numbers = [bearing.number(f"{word}_stiffness") or RIGID for word, _ in rows]
    words = [said(number, unit) for number, (_, unit) in zip(numbers, rows)]
    table: dict[str, Any] = dict(zip(("radial", "axial", "tilting"), words))
    return table | {"radial": Sourced(words[0], bearing.label)}


def _pin_of(gearbox: Gearbox, stage: PlanetStage, bearings: list[Component]) -> Shaft | None:
    sides = [side.id for b in bearings for side in gearbox.document.sides_of(b) or ()]
    return next((pin for pin in stage.pins if pin.component.id in sides), None)


def _pin_compliance(
    gearbox: Gearbox, pin: Shaft, planet: Shaft, arms: list[float], middle: float
) -> tuple[np.ndarray, float]:
    """Return the (n, n) compliance across a pin at its bearings, and that along it, m/N."""
    document = gearbox.document
    shift = 0.0
    if pin.frame is not None and planet.frame is not None:
        shift = float((planet.frame.origin - pin.frame.origin) @ pin.frame.u)
    places = [middle + arm + shift for arm in arms]
    ends = []
    for coupling, _ in couplings_of(document, pin.component):
        sides = document.sides_of(coupling)
        side = "inner" if sides and sides[0] == pin.component else "outer"
        u = place_of(gearbox, coupling, pin, f"u_coordinate_on_shaft_{side}_side")
        ends.append(u - pin.first)
    ends = ends or [0.0, pin.length]
    outer = pin.mean_outer(0.0, pin.length)
    bore = pin.sections[0].inner[0]
    material = material_of(gearbox, pin.component)
    E = (material.number("elastic_modulus") if material else None) or STEEL.E
    nu = (material.number("poisson_ratio") if material else None) or STEEL.nu
    area = pi / 4 * (outer**2 - bore**2)
    place = places[0]
    reach = [abs(place - end) for end in ends if abs(place - end) > 0]
    along = 1 / sum(E * area / r for r in reach) if reach else 0.0
    return clamped_compliance(places, ends, outer, bore, E, nu), along


def carried_masses(gearbox: Gearbox, stage: PlanetStage) -> Iterator[dict[str, Any]]:
    """Yield tables of the masses that move with a carrier beside its shaft: plates, other shafts and
    pins, each about the lumped point of the pins.
    """
    origin = _carrier_start(gearbox, stage) + pins_at(gearbox, stage)
    for part in stage.carrier_parts:
        shaft = gearbox.shafts.get(part.id)
        body = _plate(gearbox, part) if part.kind == "side_plate" else None
        if shaft is not None:
            body = total(section_bodies(gearbox, shaft, shaft.length / 2))
        if body is not None and body[0]:
            length = shaft.length if shaft is not None else part.number("length") or 0.0
            yield _mass(stage, part.label, body, _along(gearbox, part, length) - origin)
    for pin, planet in zip(stage.pins, stage.planets):
        mass, torsional, bending = total(section_bodies(gearbox, pin, pin.length / 2))
        wheels = [circles_of(gearbox, g.component) for g in (stage.sun, planet)]
        radius = wheels[0].radius + wheels[1].radius
        count = len(stage.pins)
        whole = (
            count * mass,
            count * (torsional + mass * radius**2),
            count * (bending + mass * radius**2 / 2),
        )
        label = f"{count} pins like {pin.component.label}"
        if mass:
            place = _along(gearbox, pin.component, pin.length) - origin
            yield _mass(stage, label, whole, place)
        break


def _carrier_start(gearbox: Gearbox, stage: PlanetStage) -> float:
    """Return the place of the beginning of the carrier's scene along the first shaft, m."""
    carrier = stage.carrier
    beginning = _along(gearbox, carrier.component, 0.0)
    return (
        beginning + carrier.first
        if carrier.sign > 0
        else beginning - carrier.first - carrier.length
    )


def _plate(gearbox: Gearbox, plate: Component) -> tuple[float, float, float] | None:
    sizes = [plate.number(k) for k in ("outer_diameter", "inner_diameter", "length")]
    if not (sizes[0] and sizes[2]):
        gearbox.notes.drop(plate, "has no outer_diameter and length: it has no mass here")
        return None
    density, _ = density_of(gearbox, plate)
    body = ring_inertia(sizes[0], sizes[1] or 0.0, sizes[2], density)
    given = plate.number("mass_of_component")
    return body if not given else (given, body[1] * given / body[0], body[2] * given / body[0])


def _along(gearbox: Gearbox, part: Component, length: float) -> float:
    """Return the place of the middle of a part along the first shaft, m."""
    frame = frame_of(gearbox.document, part)
    first = gearbox.reference
    if frame is None or first is None:
        return 0.0
    # parts are placed by their beginnings
    return float((frame.origin + length / 2 * frame.u - first.origin) @ first.u)


def _mass(
    stage: PlanetStage, label: str, body: tuple[float, float, float], place: float
) -> dict[str, Any]:
    mass, torsional, bending = body
    inertia = [said(v, "kg*m^2") for v in (bending, torsional, bending)]
    return {
        "name": label.split(" ", 1)[0] + f"_{label.split()[1]}",
        "mass": Sourced(said(round(mass, 9), "kg"), label),
        "inertia": inertia,
        "offset": ["0 mm", mm(round(place, 9)), "0 mm"],
        "on": point_of(stage),
    }


def pins_middle(gearbox: Gearbox, stage: PlanetStage) -> float:
    """Return the place of the middle of the sun along the carrier, m, on its shaft or off it."""
    carrier = stage.carrier
    if stage.sun.shaft.frame is None or carrier.frame is None:
        return carrier.length / 2
    first = gearbox.reference
    assert first is not None  # a shaft is placed
    start = float((carrier.frame.origin - first.origin) @ first.u)
    return carrier.place(carrier.sign * (float(gear_places(gearbox, stage.sun)[1]) - start))


def pins_at(gearbox: Gearbox, stage: PlanetStage) -> float:
    """Return the place on the shaft of the carrier at which it holds the pins, m."""
    return min(max(pins_middle(gearbox, stage), 0.0), stage.carrier.length)
