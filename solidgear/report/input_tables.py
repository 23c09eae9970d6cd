"""Tables of what was given: the scene in facts, its segments and its bearings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from solidgear.evidence.record import Record
from solidgear.report.cells import DASH, eng, mm, short_percent
from solidgear.report.table import Table
from solidgear.report.words import hertz, is_number, percent


def scene_facts(record: Record) -> Table:
    """The scene in a few lines."""
    scene = record.scene
    material, housing = scene.get("material") or {}, scene.get("housing_axial")
    free = record.port.free if record.port else []
    rows = [
        ["source", scene.get("source") or "not given"],
        ["length", f"{mm(scene.get('length'))} mm"],
        ["material", _material(material)],
        ["lumped point", _lumped_point(record)],
        ["free motions there", ", ".join(free) or "none"],
        [
            "housing spring along y",
            f"{eng(housing)} N/m" if is_number(housing) else "none",
        ],
        ["asked for", _asked(scene.get("ask") or {})],
    ]
    return Table("Scene", ["item", "value"], rows if scene else [], css="facts")


def _material(material: Mapping[str, Any]) -> str:
    modulus = eng(material.get("E"), 4)
    nu, density = material.get("nu", DASH), material.get("density", DASH)
    return f"E = {modulus} Pa, nu = {nu}, density = {density} kg/m³"


def _lumped_point(record: Record) -> str:
    """Where the lumped point is and what carries it, by the scene, else by the solution."""
    port = record.scene.get("port")
    if not port:
        port = record.port.model_dump(exclude_defaults=True) if record.port else {}
    return (
        f"{port.get('name', '')} on the axis at y = {mm(port.get('y'))} mm, "
        f"carried by the outer surface from {mm(port.get('lo'))} to {mm(port.get('hi'))} mm, "
        f"attachment {port.get('attachment', DASH)}"
    )


def _asked(ask: Mapping) -> str:
    """The questions of a scene in a line."""
    words = f"{ask.get('modes', DASH)} modes"
    if is_number(ask.get("max_frequency")):
        words += f" up to {ask['max_frequency']:g} Hz"
    if is_number(ask.get("tolerance")):
        words += f", to a tolerance of {short_percent(ask['tolerance'])}"
    return words


def segments(scene: Mapping) -> Table:
    """The shaft, a segment a row."""
    default = scene.get("material") or {}
    rows = []
    for s in scene.get("segments") or []:
        hollow = s.get("inner0") or s.get("inner1")
        rows.append(
            [
                str(s.get("name", "")),
                (s.get("part", "shaft"), "word text"),
                mm(s.get("y0")),
                mm(s.get("y1")),
                mm(s.get("length", s["y1"] - s["y0"])),
                _diameters(s, "outer"),
                _diameters(s, "inner") if hollow else DASH,
                (_own_material(s.get("material") or default, default), "word text"),
            ]
        )
    return Table(
        "Shaft segments, from the first end face (y = 0)",
        [
            "segment",
            "part",
            "from y, mm",
            "to y, mm",
            "length, mm",
            "outer diameter, mm",
            "bore, mm",
            "material",
        ],
        rows,
    )


def _diameters(segment: Mapping, side: str) -> str:
    """Diameters, mm, at both ends of the outer or inner surface."""
    return f"{mm(2 * segment[side + '0'])} → {mm(2 * segment[side + '1'])}"


def _own_material(material: Mapping, default: Mapping) -> str:
    if material == default:
        return "default"
    modulus = eng(material.get("E"), 4)
    return f"E {modulus}, nu {material.get('nu')}, density {material.get('density')}"


def bearings(scene: Mapping) -> Table:
    """The bearings with the stiffness they are solved with."""
    rows = []
    for b in scene.get("bearings") or []:
        stiffness = b.get("stiffness") or [[None] * 6] * 6
        shown = [stiffness[i][j] for i, j in ((0, 0), (1, 1), (2, 2), (2, 3), (3, 3), (5, 5))]
        # what is held has the stiffness of nothing real
        cells = [b["hold"] if value else DASH for value in shown] if b.get("hold") else None
        status = b.get("status") or "not stated"
        rows.append(
            [
                str(b.get("name", "")),
                mm(b.get("y")),
                mm(b.get("seat_width")),
                (b.get("attachment", DASH), "word text"),
                *(cells or (eng(value, 4) for value in shown)),
                (status, f"word text mark {status}"),
                (str(b.get("note") or ""), "text"),
            ]
        )
    head = [
        "bearing",
        "y, mm",
        "seat, mm",
        "attachment",
        "K_xx, N/m",
        "K_yy, N/m",
        "K_zz, N/m",
        "K_z,thx, N/rad",
        "K_thx, N m/rad",
        "K_thz, N m/rad",
        "status",
        "note",
    ]
    return Table(
        "Bearings, series springs included",
        head,
        rows,
        note=(
            "Status says where the stiffness comes from: published, measured, identified (fitted), "
            "assumed, or from catalogue data: calculated, or estimated where the inner geometry is."
        ),
    )


def bearing_range(found: Mapping) -> Table:
    """What is not known of catalogue bearings, as bands on natural frequencies: beside these stand
    those of mesh and model.
    """
    rows = []
    for b in found.get("bounds") or []:
        middle, low, high = b["frequency_hz"], b["low"], b["high"]
        band = f"{percent(low / middle - 1)} / {percent(high / middle - 1)}"
        rows.append([str(b["mode"]), *(hertz(f) for f in (middle, low, high)), band])
    lost = [f"Bearing {name} carries nothing somewhere in it." for name in found.get("lost") or []]
    note = (
        f"Of the {found.get('model')} model over {found.get('points')} points: "
        f"{found.get('varied')}. {' '.join(lost)}"
    )
    return Table(
        "What the bearings leave open, natural frequencies in Hz",
        ["mode", "at the scene's load", "from", "to", "band"],
        rows,
        note=note.strip(),
    )


def masses(scene: Mapping) -> Table:
    """The rigid masses on ports."""
    rows = [
        [
            str(mass.get("name", "")),
            str(mass.get("on") or "a seat of its own"),
            mm(mass.get("y")),
            eng(mass.get("mass"), 4),
            ", ".join(eng(value, 4) for value in mass.get("inertia", ())),
            ", ".join(mm(value) for value in mass.get("offset", ())),
        ]
        for mass in scene.get("masses") or []
    ]
    head = ["mass", "moves with", "y, mm", "mass, kg", "inertia x, y, z, kg m²", "offset, mm"]
    return Table(
        "Rigid masses",
        head,
        rows,
        note="Inertia about the centre of mass; offset of that centre from the station.",
    )
