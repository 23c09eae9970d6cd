"""Shafts of a REXS document as tables of scene files."""

from __future__ import annotations

from typing import Any

import numpy as np

from solidgear.exchange.rexs.bearings import bearing_table, width_of
from solidgear.exchange.rexs.commented import Sourced, mm, said
from solidgear.exchange.rexs.document import Component, RexsError
from solidgear.exchange.rexs.drive import Case, Drive
from solidgear.exchange.rexs.gearbox import Gearbox, place_of
from solidgear.exchange.rexs.materials import material_table
from solidgear.exchange.rexs.planets import carried_masses, pins_at, pins_middle, point_of
from solidgear.exchange.rexs.running import load_vector, lubrication_table, planets_of
from solidgear.exchange.rexs.shafts import Section, Shaft

#: pieces that stand for a conical bore; each has its volume
STEPS = 8
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
    segments = _segments(gearbox, shaft)
    names = {segment["name"] for segment in segments}
    tables: dict[str, Any] = {
        "title": shaft.component.name or shaft.name,
        "source": f"REXS {gearbox.document.version}, {shaft.component.label}",
        "material": material_table(gearbox, shaft.component),
        "segment": segments,
    }
    bearings = _bearings(gearbox, shaft, names)
    ports, loads = _ports(gearbox, shaft, cases, drive)
    masses = [
        *(mass for stage in planets_of(gearbox, shaft) for mass in carried_masses(gearbox, stage)),
        *_masses(gearbox, shaft),
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
            if gearbox.document.is_ours and len(pieces) == 1:
                name = section.component.name
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


def _bearings(
    gearbox: Gearbox, shaft: Shaft, taken: set[str]
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
        name = gearbox.name_of(bearing, names, f"bearing_{bearing.id}")
        names.append(name)
        width, _ = width_of(bearing, shaft, y, gearbox.notes)
        if hi - lo < width - 1e-6:
            gearbox.notes.assume(bearing, "a shorter seat, for the shaft has a step or ends there")
        if abs((lo + hi) / 2 - y) > 1e-6:
            gearbox.notes.assume(
                bearing, f"stands {1e3 * ((lo + hi) / 2 - y):+.4g} mm off its place, beside a step"
            )
        table = {
            "name": name,
            "position": Sourced(mm(round((lo + hi) / 2, 12)), bearing.label),
            "seat_width": Sourced(mm(round(hi - lo, 12)), source),
        }
        out.append(
            (bearing, table | bearing_table(gearbox.document, bearing, shaft, y, gearbox.notes))
        )
    return out


def _seat_of(gearbox: Gearbox, bearing: Component, shaft: Shaft) -> float | None:
    """Return the coordinate of a bearing on a shaft that it carries, m; None where it carries another:
    one between two shafts that turn stands under that with fewer bearings in the casing.
    """
    sides = gearbox.document.sides_of(bearing)
    if sides is None:
        gearbox.notes.drop(bearing, "no relation says between what it stands")
        return None
    if shaft.component not in sides:
        return None
    side = "inner" if sides[0] == shaft.component else "outer"
    other = sides[1] if side == "inner" else sides[0]
    if other.id in (g.shaft.component.id for s in gearbox.planetary for g in s.planets):
        return None
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
    return place_of(gearbox, bearing, shaft, f"u_coordinate_on_shaft_{side}_side")


def _in_casing(gearbox: Gearbox, shaft: Component) -> int:
    pairs = (gearbox.document.sides_of(b) for b in gearbox.document.of_kind(*BEARINGS))
    return sum(
        1 for pair in pairs if pair and shaft in pair and any(p.kind == "gear_casing" for p in pair)
    )


def _ports(
    gearbox: Gearbox, shaft: Shaft, cases: list[Case], drive: Drive | None
) -> tuple[list[dict[str, Any]], dict[int, str]]:
    """Return the lumped points of a shaft: its gears, the pins that it carries, loads that push."""
    ports = []
    for gear in gearbox.gears.values():
        if gear.shaft is shaft:
            width = gear.component.number("face_width") or 0.0
            ports.append(_port(shaft, gear.name, gear.component, gear.y, width))
    for stage in planets_of(gearbox, shaft):
        y = pins_at(gearbox, stage)
        off = pins_middle(gearbox, stage) - y
        if abs(off) > 1e-6:
            gearbox.notes.assume(
                shaft.component,
                f"its planets stand at its end, {1e3 * abs(off):.4g} mm from where they are: trains hold "
                "pins at a place of the carrier's shaft",
            )
        ports.append(_port(shaft, point_of(stage), stage.component, y, shaft.length / 5))
    loads: dict[int, str] = {}
    places: dict[float, str] = {}
    driving = () if drive is None else (drive.engine.id, drive.load.id)
    names = [port["name"] for port in ports]
    for load in gearbox.document.parts_of(shaft.component, "external_load"):
        vectors = [load_vector(case.components[load.id], shaft) for case in cases]
        pushes = any(np.any(force) or np.any(moment) for force, moment in vectors)
        if not (pushes or load.id in driving or gearbox.document.is_ours):
            continue
        u = place_of(gearbox, load, shaft)
        if (name := places.get(u)) is None:
            name = places[u] = gearbox.name_of(load, names, f"load_{load.id}")
            names.append(name)
            width = load.number("width_of_external_load") or shaft.length / 20
            ports.append(_port(shaft, name, load, shaft.place(u), width))
        loads[load.id] = name
    for number, behind in () if drive is None else drive.coupled.items():
        if behind.inside is not shaft:
            continue
        sides = gearbox.document.sides_of(behind.coupling)
        side = "inner" if sides and sides[0] == shaft.component else "outer"
        u = place_of(gearbox, behind.coupling, shaft, f"u_coordinate_on_shaft_{side}_side")
        name = gearbox.name_of(behind.coupling, names, f"coupling_{behind.coupling.id}")
        names.append(name)
        ports.append(_port(shaft, name, behind.coupling, shaft.place(u), shaft.length / 20))
        loads[number] = name
    if not ports:
        ports.append(_port(shaft, "middle", shaft.component, shaft.length / 2, shaft.length / 10))
    return ports, loads


def _port(shaft: Shaft, name: str, part: Component, y: float, width: float) -> dict[str, Any]:
    span = shaft.span(y, width)
    if span is None or not -1e-6 <= y <= shaft.length + 1e-6:
        raise RexsError(
            f"{part.label}: lies at {1e3 * y:.6g} mm, off {shaft.component.label}, which is "
            f"{1e3 * shaft.length:.6g} mm long"
        )
    y = min(max(y, 0.0), shaft.length)
    return {
        "name": name,
        "position": Sourced(mm(round(y, 12)), part.label),
        "span": [mm(round(end, 12)) for end in span],
    }


def _masses(gearbox: Gearbox, shaft: Shaft) -> list[dict[str, Any]]:
    """Return additional masses of a shaft."""
    out: list[dict[str, Any]] = []
    names: list[str] = []
    for mass in gearbox.document.parts_of(shaft.component, "additional_mass"):
        size, u = mass.number("mass_of_component"), place_of(gearbox, mass, shaft)
        seat = shaft.seat(shaft.place(u), mass.number("length") or 0.01)
        if not size or seat is None:
            gearbox.notes.drop(mass, "has no mass_of_component, or lies off its shaft")
            continue
        inertia = [mass.number(f"moment_of_inertia_{axis}_axis") or 0.0 for axis in "wuv"]
        if not any(inertia):
            gearbox.notes.assume(mass, "no moment_of_inertia is given: a mass at a point")
        names.append(gearbox.name_of(mass, names, f"mass_{mass.id}"))
        out.append(
            {
                "name": names[-1],
                "mass": Sourced(said(size, "kg"), f"{mass.label}: mass_of_component"),
                "inertia": [said(v, "kg*m^2") for v in inertia],
                "position": mm(round((seat[0] + seat[1]) / 2, 12)),
                "seat_width": mm(round(seat[1] - seat[0], 12)),
            }
        )
    return out
