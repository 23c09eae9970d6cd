"""Tables of what was given: the scene in facts, its segments and its bearings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from solidgear.judge.record import Record
from solidgear.quantity import Quantity
from solidgear.report.bearing_words import catalogue, load_row, without_column
from solidgear.report.cells import DASH, short_percent
from solidgear.report.reading import entry, model_name
from solidgear.report.table import Table
from solidgear.report.units import ENGINEERING, Units
from solidgear.report.words import engineering, hertz, is_number, percent

#: of a bearing's 6x6
BEARING_ENTRIES = tuple(map(Quantity, ("K_xx", "K_yy", "K_zz", "K_z,thx", "K_thx", "K_thz")))
#: lengths that a feature can have
SIZES = ("y", "length", "width", "depth", "diameter", "radius", "size", "height")


def scene_facts(record: Record, units: Units = ENGINEERING) -> Table:
    """The scene in a few lines."""
    scene = record.scene
    material = scene.get("material") or {}
    free = record.port.free if record.port else []
    rows = [
        ["source", scene.get("source") or "not given"],
        ["length", f"{units.given(scene.get('length'), 'm', DASH)} {units.unit('m')}"],
        ["material", _material(material, units)],
        ["lumped point", _lumped_point(record, units)],
        ["free motions there", ", ".join(free) or "none"],
        *_further_points(scene, units),
        _housing(scene, units),
        *load_row(scene, units),
        ["asked for", _asked(scene.get("ask") or {})],
    ]
    return Table("Scene", ["item", "value"], rows if scene else [], css="facts")


def _material(material: Mapping[str, Any], units: Units) -> str:
    modulus = f"{units.given(material.get('E'), 'Pa', DASH)} {units.unit('Pa')}"
    density = units.given(material.get("density"), "kg/m³", DASH)
    return f"E = {modulus}, nu = {material.get('nu', DASH)}, density = {density} kg/m³"


def _lumped_point(record: Record, units: Units) -> str:
    """Where the lumped point is and what carries it, by the scene, else by the solution."""
    port = record.scene.get("port")
    if not port:
        port = record.port.model_dump(exclude_defaults=True) if record.port else {}
    return f"{_placed(port, units)}, {_carried(port, units)}"


def _further_points(scene: Mapping, units: Units) -> list[list[str]]:
    """Other lumped points, a row each."""
    found = scene.get("further_ports") or []
    return [["further point", f"{_placed(p, units)}, {_carried(p, units)}"] for p in found]


def _placed(port: Mapping, units: Units) -> str:
    y = units.given(port.get("y"), "m", DASH)
    return f"{port.get('name', '')} on the axis at y = {y} {units.unit('m')}"


def _carried(port: Mapping, units: Units) -> str:
    lo, hi = (units.given(port.get(name), "m", DASH) for name in ("lo", "hi"))
    return (
        f"carried by the outer surface from {lo} to {hi} {units.unit('m')}, "
        f"attachment {port.get('attachment', DASH)}"
    )


def _housing(scene: Mapping, units: Units) -> list[str]:
    """What all bearings stand in."""
    around, spring = scene.get("housing"), scene.get("housing_axial")
    if not around:
        return ["housing spring along y", units.text(spring, "N/m", nothing="none")]
    found = around["entries"].items()
    entries = ", ".join(f"{name} {engineering(value, 4)}" for name, value in found)
    y = units.given(around["y"], "m", DASH)
    return [
        "housing of all bearings",
        f"6x6 about y = {y} {units.unit('m')}, SI: {entries}; rigid in every other motion, no mass",
    ]


def _asked(ask: Mapping) -> str:
    """The questions of a scene in a line."""
    words = f"{ask.get('modes', DASH)} modes"
    if is_number(ask.get("max_frequency")):
        words += f" up to {ask['max_frequency']:g} Hz"
    if is_number(ask.get("tolerance")):
        words += f", to a tolerance of {short_percent(ask['tolerance'])}"
    return words


def segments(scene: Mapping, units: Units = ENGINEERING) -> Table:
    """The shaft, a segment a row."""
    default = scene.get("material") or {}
    rows = []
    for s in scene.get("segments") or []:
        hollow = s.get("inner0") or s.get("inner1")
        rows.append(
            [
                str(s.get("name", "")),
                (s.get("part", "shaft"), "word text"),
                units.given(s.get("y0"), "m", DASH),
                units.given(s.get("y1"), "m", DASH),
                units.given(s.get("length", s["y1"] - s["y0"]), "m", DASH),
                _diameters(s, "outer", units),
                _diameters(s, "inner", units) if hollow else DASH,
                (_own_material(s.get("material") or default, default, units), "word text"),
            ]
        )
    return Table(
        "Shaft segments, from the first end face (y = 0)",
        [
            "segment",
            "part",
            f"from y, {units.unit('m')}",
            f"to y, {units.unit('m')}",
            f"length, {units.unit('m')}",
            f"outer diameter, {units.unit('m')}",
            f"bore, {units.unit('m')}",
            "material",
        ],
        rows,
    )


def _diameters(segment: Mapping, side: str, units: Units) -> str:
    """Diameters at both ends of the outer or inner surface; one where they are the same."""
    ends = [units.given(2 * segment[side + end], "m", DASH) for end in "01"]
    return " → ".join(dict.fromkeys(ends))


def _own_material(material: Mapping, default: Mapping, units: Units) -> str:
    if material == default:
        return "default"
    modulus = f"{units.given(material.get('E'), 'Pa', DASH)} {units.unit('Pa')}"
    density = units.given(material.get("density"), "kg/m³", DASH)
    return f"E {modulus}, nu {material.get('nu')}, density {density} kg/m³"


def bearings(scene: Mapping, units: Units = ENGINEERING) -> Table:
    """The bearings with the stiffness they are solved with."""
    rows = []
    for b in scene.get("bearings") or []:
        stiffness = b.get("stiffness") or [[None] * 6] * 6
        shown = [(entry(stiffness, *name.place), name.unit) for name in BEARING_ENTRIES]
        # what is held has the stiffness of nothing real
        cells = [b["hold"] if value else DASH for value, _ in shown] if b.get("hold") else None
        status = b.get("status") or "not stated"
        rows.append(
            [
                str(b.get("name", "")),
                units.given(b.get("y"), "m", DASH),
                units.given(b.get("seat_width"), "m", DASH),
                (b.get("attachment", DASH), "word text"),
                *(cells or (units.number(value, si, 4, DASH) for value, si in shown)),
                (status, f"word text mark {status}"),
                (_note(b, units), "text"),
            ]
        )
    head = [
        "bearing",
        f"y, {units.unit('m')}",
        f"seat, {units.unit('m')}",
        "attachment",
        *(f"{name}, {units.unit(name.unit)}" for name in BEARING_ENTRIES),
        "status",
        "note",
    ]
    return Table(
        "Bearings, series springs included",
        head,
        rows,
        note=(
            "Status says where the stiffness comes from: published, measured, identified (fitted), "
            "assumed, or from catalogue data: calculated, or estimated where the inner geometry is. "
            + without_column(scene.get("bearings") or [], [name.place for name in BEARING_ENTRIES])
        ).strip(),
    )


def _note(bearing: Mapping, units: Units) -> str:
    """What is told of a bearing in words, catalogue data and the housing at its seat included."""
    words = [catalogue(bearing.get("catalogue"), units), str(bearing.get("note") or "")]
    own = bearing.get("housing")
    if own:
        entries = ", ".join(f"{name} {engineering(value, 4)}" for name, value in own.items())
        words.append(f"Stands in a housing of its own, SI: {entries}.")
    return " ".join(filter(None, words))


def bearing_range(record: Record) -> Table:
    """What is not known of catalogue bearings, as bands on natural frequencies: beside these stand
    those of mesh and model.
    """
    found = record.bearing_range
    rows = []
    for b in found.get("bounds") or []:
        middle, low, high = b["frequency_hz"], b["low"], b["high"]
        band = f"{percent(low / middle - 1)} / {percent(high / middle - 1)}"
        rows.append([str(b["mode"]), *(hertz(f) for f in (middle, low, high)), band])
    lost = [f"Bearing {name} carries nothing somewhere in it." for name in found.get("lost") or []]
    note = (
        f"Of the {model_name(record, found.get('model'))} over {found.get('points')} points: "
        f"{found.get('varied')}. {' '.join(lost)}"
    )
    return Table(
        "What the bearings leave open, natural frequencies in Hz",
        ["mode", "at the scene's load", "from", "to", "band"],
        rows,
        note=note.strip(),
    )


def features(scene: Mapping, units: Units = ENGINEERING) -> Table:
    """What is cut out of the shaft, stands on it or rounds its edges."""
    rows = []
    for found in [*(scene.get("features") or []), *(scene.get("blends") or [])]:
        where = str(found.get("segment") or found.get("at") or DASH)
        number = [f"{found['count']} of them"] if found.get("count") else []
        sizes = number + [
            f"{name.replace('_', ' ')} {units.given(found[name], 'm')} {units.unit('m')}"
            for name in SIZES
            if is_number(found.get(name))
        ]
        kind = str(found.get("kind", "")).replace("_", " ")
        rows.append(
            [str(found.get("name") or kind), kind, (where, "word text"), (", ".join(sizes), "text")]
        )
    return Table("Features", ["feature", "kind", "on", "place and size"], rows)


def masses(scene: Mapping, units: Units = ENGINEERING) -> Table:
    """The rigid masses on ports."""
    rows = [
        [
            str(mass.get("name", "")),
            str(mass.get("on") or "a seat of its own"),
            units.given(mass.get("y"), "m", DASH),
            units.given(mass.get("mass"), "kg", DASH),
            ", ".join(units.given(value, "kg m²", DASH) for value in mass.get("inertia", ())),
            ", ".join(units.given(value, "m", DASH) for value in mass.get("offset", ())),
        ]
        for mass in scene.get("masses") or []
    ]
    length = units.unit("m")
    head = [
        "mass",
        "moves with",
        f"y, {length}",
        "mass, kg",
        "inertia x, y, z, kg m²",
        f"offset, {length}",
    ]
    return Table(
        "Rigid masses",
        head,
        rows,
        note="Inertia about the centre of mass; offset of that centre from the station.",
    )
