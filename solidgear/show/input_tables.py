"""Tables of what was given: the scene in facts, its segments and its bearings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from solidgear.core import Quantity, Record
from solidgear.show.bearing_words import catalogue, load_row, speed_row, without_column
from solidgear.show.matrices import entry
from solidgear.show.table import Cell, Column, Table, given, text, word
from solidgear.show.units import ENGINEERING, Units
from solidgear.show.words import DASH, engineering, is_number, short_percent

#: of a bearing's 6x6
BEARING_ENTRIES = tuple(map(Quantity, ("K_xx", "K_yy", "K_zz", "K_z,thx", "K_thx", "K_thz")))
#: lengths that a feature can have
SIZES = ("y", "length", "width", "depth", "diameter", "radius", "size", "height")


def scene_facts(record: Record, units: Units = ENGINEERING) -> Table:
    """Return the scene in a few lines."""
    scene = record.scene
    free = record.port.free if record.port else []
    rows = [
        ["source", scene.get("source") or "not given"],
        ["length", f"{units.given(scene.get('length'), 'm')} {units.unit('m')}"],
        ["material", material_words(scene.get("material") or {}, units)],
        ["lumped point", _lumped_point(record, units)],
        ["free motions there", ", ".join(free) or "none"],
        *_further_points(scene, units),
        _housing(scene, units),
        *load_row(scene, units),
        *speed_row(scene),
        ["asked for", _asked(scene.get("ask") or {})],
    ]
    return Table("Scene", ["item", text("value")], rows if scene else [], style="facts")


def _lumped_point(record: Record, units: Units) -> str:
    """Return the place of the lumped point and the seat that carries it, by the scene, else by the
    solution.
    """
    port = record.scene.get("port")
    if not port:
        port = record.port.model_dump(exclude_defaults=True) if record.port else {}
    return f"{_placed(port, units)}, {_carried(port, units)}"


def _further_points(scene: Mapping, units: Units) -> list[list[str]]:
    """Yield other lumped points, a row each."""
    ports = scene.get("further_ports") or []
    return [["further point", f"{_placed(p, units)}, {_carried(p, units)}"] for p in ports]


def _placed(port: Mapping, units: Units) -> str:
    y = units.given(port.get("y"), "m")
    return f"{port.get('name', '')} on the axis at y = {y} {units.unit('m')}"


def _carried(port: Mapping, units: Units) -> str:
    lo, hi = (units.given(port.get(name), "m") for name in ("lo", "hi"))
    return (
        f"carried by the outer surface from {lo} to {hi} {units.unit('m')}, "
        f"attachment {port.get('attachment', DASH)}"
    )


def _housing(scene: Mapping, units: Units) -> list[str]:
    """Return the row on the housing that all bearings share."""
    around, spring = scene.get("housing"), scene.get("housing_axial")
    if not around:
        return [
            "housing spring along y",
            units.text(spring, "N/m") if is_number(spring) else "none",
        ]
    stiffnesses = around["entries"].items()
    entries = ", ".join(f"{name} {engineering(value, 4)}" for name, value in stiffnesses)
    y = units.given(around["y"], "m")
    return [
        "housing of all bearings",
        f"6x6 about y = {y} {units.unit('m')}, SI: {entries}; rigid in every other motion, no mass",
    ]


def _asked(ask: Mapping) -> str:
    """Return the questions of a scene in a line."""
    words = f"{ask.get('modes', DASH)} modes"
    if is_number(ask.get("max_frequency")):
        words += f" up to {ask['max_frequency']:g} Hz"
    if is_number(ask.get("tolerance")):
        words += f", to a tolerance of {short_percent(ask['tolerance'])}"
    return words


def segments(scene: Mapping, units: Units = ENGINEERING) -> Table:
    """Return the shaft, a segment a row."""
    default = scene.get("material") or {}
    length = units.unit("m")

    def bore(s: Mapping) -> str | None:
        return _diameters(s, "inner", units) if s.get("inner0") or s.get("inner1") else None

    columns = [
        Column("segment", lambda s: str(s.get("name", ""))),
        word("part", lambda s: s.get("part", "shaft")),
        given("from y", "m", units, lambda s: s.get("y0")),
        given("to y", "m", units, lambda s: s.get("y1")),
        given("length", "m", units, lambda s: s.get("length", s["y1"] - s["y0"])),
        Column(f"outer diameter, {length}", lambda s: _diameters(s, "outer", units)),
        Column(f"bore, {length}", bore),
        word("material", lambda s: _own_material(s.get("material") or default, default, units)),
    ]
    title = "Shaft segments, from the first end face (y = 0)"
    return Table(title, columns, scene.get("segments") or [])


def _diameters(segment: Mapping, side: str, units: Units) -> str:
    """Return diameters at both ends of the outer or inner surface, or one if they are equal."""
    ends = [units.given(2 * segment[side + end], "m") for end in "01"]
    return " → ".join(dict.fromkeys(ends))


def _own_material(material: Mapping, default: Mapping, units: Units) -> str:
    if material == default:
        return "default"
    if material.get("name"):
        return str(material["name"])
    modulus = f"{units.given(material.get('E'), 'Pa')} {units.unit('Pa')}"
    density = f"{units.given(material.get('density'), 'kg/m³')} {units.unit('kg/m³')}"
    return f"E {modulus}, nu {material.get('nu')}, density {density}"


def bearings(scene: Mapping, units: Units = ENGINEERING) -> Table:
    """Return the bearings with the stiffness they are solved with."""
    rows = scene.get("bearings") or []
    columns = [
        Column("bearing", lambda b: str(b.get("name", ""))),
        given("y", "m", units, lambda b: b.get("y")),
        given("seat", "m", units, lambda b: b.get("seat_width")),
        word("attachment", lambda b: b.get("attachment")),
        *(_stiffness(name, units) for name in BEARING_ENTRIES),
        word("status", lambda b: mark(b.get("status") or "not stated")),
        text("note", lambda b: _note(b, units)),
    ]
    note = (
        "Status is the source of the stiffness: published, measured, identified (fitted), "
        "assumed, or from catalogue data: calculated, or estimated like the inner geometry. "
        + without_column(rows, [name.place for name in BEARING_ENTRIES])
    )
    return Table("Bearings, series springs included", columns, rows, note.strip())


def _stiffness(name: Quantity, units: Units) -> Column:
    """Return a column of one stiffness entry; held motions have none."""

    def told(bearing: Mapping) -> str | None:
        value = entry(bearing.get("stiffness"), *name.place)
        if bearing.get("hold"):
            return bearing["hold"] if value else None
        return units.number(value, name.unit, 4)

    return Column(f"{name}, {units.unit(name.unit)}", told)


def _note(bearing: Mapping, units: Units) -> str:
    """Return the remark on a bearing in words, catalogue data and the housing at its seat
    included.
    """
    support = str(bearing.get("support") or "")
    words = [f"{support.capitalize()}." if support else ""]
    words += [catalogue(bearing.get("catalogue"), units), str(bearing.get("note") or "")]
    housing = bearing.get("housing")
    if housing:
        entries = ", ".join(f"{name} {engineering(value, 4)}" for name, value in housing.items())
        words.append(f"Stands in its own housing, SI: {entries}.")
    return " ".join(filter(None, words))


def features(scene: Mapping, units: Units = ENGINEERING) -> Table:
    """Return the table of features: cut out of the shaft, standing on it or rounding its edges."""

    def kind(feature: Mapping) -> str:
        return str(feature.get("kind", "")).replace("_", " ")

    def sizes(feature: Mapping) -> str:
        number = [f"{feature['count']} of them"] if feature.get("count") else []
        sizes_of = (
            f"{name.replace('_', ' ')} {units.given(feature[name], 'm')} {units.unit('m')}"
            for name in SIZES
            if is_number(feature.get(name))
        )
        return ", ".join([*number, *sizes_of])

    columns = [
        Column("feature", lambda f: str(f.get("name") or kind(f))),
        Column("kind", kind),
        word("on", lambda f: f.get("segment") or f.get("at") or None),
        text("place and size", sizes),
    ]
    return Table(
        "Features", columns, [*(scene.get("features") or []), *(scene.get("blends") or [])]
    )


def masses(scene: Mapping, units: Units = ENGINEERING) -> Table:
    """Return the rigid masses on ports."""

    def several(head: str, name: str, si: str) -> Column:
        return Column(
            f"{head}, {units.unit(si)}",
            lambda mass: ", ".join(units.given(v, si) for v in mass.get(name, ())),
        )

    columns = [
        Column("mass", lambda mass: str(mass.get("name", ""))),
        Column("moves with", lambda mass: str(mass.get("on") or "own seat")),
        given("y", "m", units, lambda mass: mass.get("y")),
        given("mass", "kg", units, lambda mass: mass.get("mass")),
        several("inertia x, y, z", "inertia", "kg m²"),
        several("offset", "offset", "m"),
    ]
    note = "Inertia about the centre of mass; offset of that centre from the station."
    return Table("Rigid masses", columns, scene.get("masses") or [], note)


def material_words(material: Mapping[str, Any], units: Units) -> str:
    """Return a material by its name, where it has one, and its constants."""
    modulus = f"{units.given(material.get('E'), 'Pa')} {units.unit('Pa')}"
    density = f"{units.given(material.get('density'), 'kg/m³')} {units.unit('kg/m³')}"
    words = f"E = {modulus}, nu = {material.get('nu', DASH)}, density = {density}"
    return f"{material['name']}: {words}" if material.get("name") else words


def mark(status: str) -> Cell:
    """Return the status of an input, in its colour."""
    return Cell(status, f"mark {status}".rstrip())
