"""Shafts of a REXS document as tables of scene files."""

from __future__ import annotations

from typing import Any

import numpy as np

from solidgear.exchange.rexs.bearings import bearing_table, width_of
from solidgear.exchange.rexs.commented import Sourced, mm, said
from solidgear.exchange.rexs.document import Component, RexsError
from solidgear.exchange.rexs.gearbox import Gearbox, sides_of
from solidgear.exchange.rexs.gears import gear_places
from solidgear.exchange.rexs.materials import STEEL, material_of, material_table
from solidgear.exchange.rexs.planets import cage_diameter, carried_masses, point_of
from solidgear.exchange.rexs.running import Case, Drive, load_vector, lubrication_table, planets_of
from solidgear.exchange.rexs.shafts import Section, Shaft, plain_name

#: pieces that stand for a conical bore; each has its volume
STEPS = 8
#: kg/m^3 of a stub that stands for parts whose mass is elsewhere: a thousandth of steel
LIGHT = 8.0
#: share of the width that seats of bearings beside each other lose
BEARINGS = (
    "concept_bearing",
    "rolling_bearing_with_catalog_geometry",
    "rolling_bearing_with_detailed_geometry",
)


def scene_table(
    gearbox: Gearbox, shaft: Shaft, cases: list[Case], drive: Drive | None
) -> tuple[dict[str, Any], dict[int, str]]:
    """Return the tables of a scene, and the lumped points of loads that push or drive, by the number
    of the load.
    """
    shift, before, after = _stubs(gearbox, shaft)
    segments = [*before, *_segments(gearbox, shaft), *after]
    names = {segment["name"] for segment in segments}
    tables: dict[str, Any] = {
        "title": shaft.component.name or shaft.name,
        "source": f"REXS {gearbox.document.version}, {shaft.component.label}",
        "material": material_table(gearbox, shaft.component),
        "segment": segments,
    }
    bearings = _bearings(gearbox, shaft, shift, names)
    ports, loads = _ports(gearbox, shaft, cases, drive, shift)
    masses = [
        *(mass for stage in planets_of(gearbox, shaft) for mass in carried_masses(gearbox, stage)),
        *_masses(gearbox, shaft, shift),
    ]
    if bearings:
        tables["bearing"] = [table for _, table in bearings]
    else:
        gearbox.notes.doubt(shaft.component, "has no bearing: it floats")
    tables["port"] = ports
    if masses:
        tables["mass"] = masses
    rolling = [b for b, table in bearings if "catalogue" in table]
    if lubrication := lubrication_table(gearbox, rolling):
        tables["lubrication"] = lubrication
    return tables, loads


def _segments(gearbox: Gearbox, shaft: Shaft) -> list[dict[str, Any]]:
    out = []
    for number, section in enumerate(shaft.sections, 1):
        if section.length <= 1e-9:
            gearbox.notes.drop(section.component, "has no length")
            continue
        pieces = _cylindrical_bores(section)
        if len(pieces) > 1:
            gearbox.notes.assume(
                section.component, f"its conical bore is {STEPS} cylinders of the same volume"
            )
        for k, piece in enumerate(pieces, 1):
            name = f"s{number}" if len(pieces) == 1 else f"s{number}_{k}"
            out.append(_segment(name, piece))
    return out


def _segment(name: str, section: Section) -> dict[str, Any]:
    label = section.component.label
    start, end = section.outer
    table: dict[str, Any] = {"kind": "cylinder" if start == end else "cone", "name": name}
    table["length"] = Sourced(mm(round(section.length, 12)), f"{label}: length")
    if start == end:
        table["diameter"] = Sourced(mm(start), "outer_diameter")
    else:
        table["start_diameter"] = Sourced(mm(start), "outer_diameter")
        table["end_diameter"] = mm(end)
    if section.inner[0]:
        table["bore"] = Sourced(mm(section.inner[0]), "inner_diameter")
    return table


def _cylindrical_bores(section: Section) -> list[Section]:
    """Return a section in pieces with cylindrical bores of the volume of a conical one."""
    a, b = section.inner
    if a == b:
        return [section]
    marks = np.linspace(0.0, 1.0, STEPS + 1)
    pieces = []
    for low, high in zip(marks[:-1], marks[1:]):
        d0, d1 = a + low * (b - a), a + high * (b - a)
        bore = float(np.sqrt((d0 * d0 + d0 * d1 + d1 * d1) / 3))
        y0, y1 = (section.y0 + float(share) * section.length for share in (low, high))
        outer = section.outer_at(y0), section.outer_at(y1)
        pieces.append(Section(section.component, y0, y1, outer, (bore, bore)))
    return pieces


def _stubs(
    gearbox: Gearbox, shaft: Shaft
) -> tuple[float, list[dict[str, Any]], list[dict[str, Any]]]:
    """Return light segments that lead from the ends of a carrier to the middle of its planets, and by
    how much the shaft moves along y.
    """
    before: list[dict[str, Any]] = []
    after: list[dict[str, Any]] = []
    shift = 0.0
    for stage in planets_of(gearbox, shaft):
        y = _pins_at(gearbox, stage.sun, shaft)
        reach = -y if y < 0 else y - shaft.length
        if reach <= 0:
            continue
        end = shaft.sections[0] if y < 0 else shaft.sections[-1]
        bore = end.inner[0 if y < 0 else 1]
        modulus = _modulus(gearbox, shaft.component)
        segment = {
            "kind": "cylinder",
            "name": f"cage_{stage.name}"[:40],
            "length": Sourced(mm(round(reach, 12)), f"{stage.component.label}: up to its pins"),
            "diameter": Sourced(mm(cage_diameter(gearbox, stage)), "of its plates"),
            "material": {"E": said(modulus, "GPa", 1e9), "density": f"{LIGHT:g} kg/m^3"},
        }
        if bore:
            segment["bore"] = mm(bore)
        (before if y < 0 else after).append(segment)
        shift += reach if y < 0 else 0.0
        gearbox.notes.assume(
            stage.carrier.component,
            f"a light stub of {1e3 * reach:.4g} mm leads from its end to the middle of the planets; "
            "plates, pins and what couplings join to it are masses there",
        )
    return shift, before, after


def _modulus(gearbox: Gearbox, shaft: Component) -> float:
    material = material_of(gearbox, shaft)
    return (material.number("elastic_modulus") if material is not None else None) or STEEL.E


def _pins_at(gearbox: Gearbox, sun: Any, carrier: Shaft) -> float:
    """Return the place of the middle of the sun along a carrier, m."""
    if sun.shaft.frame is None or carrier.frame is None:
        return carrier.length / 2
    first = next(s for s in gearbox.shafts.values() if s.frame is not None)
    assert first.frame is not None  # it was looked for
    start = float((carrier.frame.origin - first.frame.origin) @ first.frame.u)
    return carrier.place(carrier.sign * (float(gear_places(gearbox, sun)[1]) - start))


def _bearings(
    gearbox: Gearbox, shaft: Shaft, shift: float, taken: set[str]
) -> list[tuple[Component, dict[str, Any]]]:
    """Return the bearings of a shaft with their tables, in the order of y."""
    rows, names = [], [*taken, *(g.name for g in gearbox.gears.values())]
    for bearing in gearbox.document.of_kind(*BEARINGS):
        u = _seat_of(gearbox, bearing, shaft)
        if u is None:
            continue
        y = shaft.place(u)
        width, source = width_of(bearing, shaft, y, gearbox.notes)
        seat = shaft.seat(y, width)
        if seat is None:
            raise RexsError(
                f"{bearing.label}: lies at {1e3 * u:.6g} mm, off {shaft.component.label}, which is "
                f"{1e3 * shaft.length:.6g} mm long"
            )
        rows.append((seat, bearing, y, source))
    rows.sort(key=lambda row: row[0])
    seats = [row[0] for row in rows]
    for k in range(len(seats) - 1):
        if seats[k][1] > seats[k + 1][0]:
            middle = (seats[k][1] + seats[k + 1][0]) / 2
            seats[k], seats[k + 1] = (seats[k][0], middle), (middle, seats[k + 1][1])
    out = []
    for (lo, hi), (_, bearing, y, source) in zip(seats, rows):
        name = plain_name(bearing.name, names, f"bearing_{bearing.id}")
        names.append(name)
        width, _ = width_of(bearing, shaft, y, gearbox.notes)
        if hi - lo < width - 1e-6:
            gearbox.notes.assume(bearing, "its seat ends where the shaft has a step or ends")
        if abs((lo + hi) / 2 - y) > 1e-6:
            gearbox.notes.assume(
                bearing, f"stands {1e3 * ((lo + hi) / 2 - y):+.4g} mm off its place, beside a step"
            )
        table = {
            "name": name,
            "position": Sourced(mm(round((lo + hi) / 2 + shift, 12)), bearing.label),
            "seat_width": Sourced(mm(round(hi - lo, 12)), source),
        }
        out.append((bearing, table | bearing_table(gearbox.document, bearing, shaft, y, gearbox.notes)))
    return out


def _seat_of(gearbox: Gearbox, bearing: Component, shaft: Shaft) -> float | None:
    """Return the coordinate of a bearing on a shaft that it carries, m; None where it carries another:
    one between two shafts that turn stands under that with fewer bearings in the casing.
    """
    sides = sides_of(gearbox.document, bearing)
    if sides is None:
        gearbox.notes.drop(bearing, "no relation says between what it stands")
        return None
    if shaft.component not in sides:
        return None
    side = "inner" if sides[0] == shaft.component else "outer"
    other = sides[1] if side == "inner" else sides[0]
    if other.kind == "shaft":
        counts = [_in_casing(gearbox, part) for part in (shaft.component, other)]
        if counts[0] > counts[1] or (counts[0] == counts[1] and side == "outer"):
            return None
        gearbox.notes.assume(
            bearing,
            f"stands on the ground under {shaft.component.title}, not in {other.title}: trains have no "
            "bearings between shafts",
        )
    elif other.kind != "gear_casing":
        gearbox.notes.assume(bearing, f"stands on the ground, not in {other.title}")
    u = bearing.number(f"u_coordinate_on_shaft_{side}_side")
    if u is None:
        raise bearing.wrong(f"u_coordinate_on_shaft_{side}_side", "is missing")
    return u


def _in_casing(gearbox: Gearbox, shaft: Component) -> int:
    pairs = (sides_of(gearbox.document, b) for b in gearbox.document.of_kind(*BEARINGS))
    return sum(1 for pair in pairs if pair and shaft in pair and any(p.kind == "gear_casing" for p in pair))


def _ports(
    gearbox: Gearbox, shaft: Shaft, cases: list[Case], drive: Drive | None, shift: float
) -> tuple[list[dict[str, Any]], dict[int, str]]:
    """Return the lumped points of a shaft: its gears, the pins that it carries, loads that push."""
    ports = []
    for gear in gearbox.gears.values():
        if gear.shaft is shaft:
            width = gear.component.number("face_width") or 0.0
            ports.append(_port(shaft, gear.name, gear.component, gear.y, width, shift))
    for stage in planets_of(gearbox, shaft):
        y = _pins_at(gearbox, stage.sun, shaft)
        if 0 <= y <= shaft.length:
            ports.append(_port(shaft, point_of(stage), stage.component, y, shaft.length / 10, shift))
            continue
        middle = {"at": f"cage_{stage.name}"[:40] + (".start" if y < 0 else ".end")}
        middle |= {"attach_to": f"cage_{stage.name}"[:40]}
        ports.append({"name": point_of(stage), **middle})
    loads: dict[int, str] = {}
    driving = () if drive is None else (drive.engine.id, drive.load.id)
    names = [port["name"] for port in ports]
    for load in gearbox.document.parts_of(shaft.component, "external_load"):
        vectors = [load_vector(case.components[load.id], shaft) for case in cases]
        pushes = any(np.any(force) or np.any(moment) for force, moment in vectors)
        if not pushes and load.id not in driving:
            continue
        u = load.number("u_coordinate_on_shaft")
        if u is None:
            raise load.wrong("u_coordinate_on_shaft", "is missing")
        name = plain_name(load.name, names, f"load_{load.id}")
        names.append(name)
        width = load.number("width_of_external_load") or shaft.length / 20
        ports.append(_port(shaft, name, load, shaft.place(u), width, shift))
        loads[load.id] = name
    if not ports:
        ports.append(_port(shaft, "middle", shaft.component, shaft.length / 2, shaft.length / 10, shift))
    return ports, loads


def _port(
    shaft: Shaft, name: str, part: Component, y: float, width: float, shift: float
) -> dict[str, Any]:
    span = shaft.span(y, width)
    if span is None or not -1e-6 <= y <= shaft.length + 1e-6:
        raise RexsError(
            f"{part.label}: lies at {1e3 * y:.6g} mm, off {shaft.component.label}, which is "
            f"{1e3 * shaft.length:.6g} mm long"
        )
    y = min(max(y, 0.0), shaft.length)
    return {
        "name": name,
        "position": Sourced(mm(round(y + shift, 12)), part.label),
        "span": [mm(round(end + shift, 12)) for end in span],
    }


def _masses(gearbox: Gearbox, shaft: Shaft, shift: float) -> list[dict[str, Any]]:
    """Return additional masses of a shaft."""
    out = []
    for mass in gearbox.document.parts_of(shaft.component, "additional_mass"):
        size, u = mass.number("mass_of_component"), mass.number("u_coordinate_on_shaft")
        seat = None if u is None else shaft.seat(shaft.place(u), mass.number("length") or 0.01)
        if not size or seat is None:
            gearbox.notes.drop(mass, "has no mass_of_component, or lies off its shaft")
            continue
        inertia = [mass.number(f"moment_of_inertia_{axis}_axis") or 0.0 for axis in "wuv"]
        out.append(
            {
                "name": plain_name(mass.name, [m["name"] for m in out], f"mass_{mass.id}"),
                "mass": Sourced(said(size, "kg"), f"{mass.label}: mass_of_component"),
                "inertia": [said(v, "kg*m^2") for v in inertia],
                "position": mm(round((seat[0] + seat[1]) / 2 + shift, 12)),
                "seat_width": mm(round(seat[1] - seat[0], 12)),
            }
        )
    return out
