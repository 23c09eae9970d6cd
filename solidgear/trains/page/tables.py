"""Tables of the page about a train, from its plain results."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from math import degrees
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from solidgear.show.input_tables import mark, material_words
from solidgear.show.table import Cell, Column, Table, quantity, text, word
from solidgear.show.units import ENGINEERING, Units, engineering
from solidgear.show.words import hertz, percent, whole

if TYPE_CHECKING:
    from solidgear.trains.assembly.orders import Crossing
    from solidgear.trains.response.response import TrainResponse

MOVED_BY_MESHES = (
    "Mesh: error bar of the mode's frequency by the meshes of harmonic shafts; a peak lies lower by "
    "no more, and its height has none."
)


def facts(train: Mapping[str, Any], units: Units = ENGINEERING, title: str = "Train") -> Table:
    """Return the train in a few lines, each value with its source."""
    status = train["statuses"]
    rows = [row for mesh in train["meshes"] for row in _mesh(mesh, status, units)]
    rows += [row for stage in train["stages"] for row in _stage(stage, units)]
    senses = ", ".join(f"{side} {sense}" for side, sense in train["senses"].items())
    rows.append(["turning, right-handed about each shaft's own y", senses, ""])
    for name in train["rotors"]:
        rotor = train[name]
        rows.append(
            [f"{name} inertia", units.text(rotor["inertia"], "kg m²", 4), f"{name}.inertia"]
        )
        spring = f"{units.text(rotor['spring'], 'N m/rad', 4)} at {rotor['at']}"
        rows.append([f"{name} spring", spring, f"{name}.spring.stiffness"])
        if rotor["share"] is not None:
            rows.append(
                [f"{name} share", f"{percent(rotor['share'], signed=False)} of the power", ""]
            )
    losses = ", ".join(f"{name} {value:g}" for name, value in train["losses"].items())
    rows.append(["loss factors", losses, "losses"])
    rows += _housing(train["housing"], units) if "housing" in train else []
    rows += [
        [f"{side}'s material", _materials(train[side]["scene"], units), ""]
        for side in train["shafts"]
    ]
    columns = [
        text("item", lambda row: row[0]),
        text("value", lambda row: row[1]),
        word("status", lambda row: mark(status.get(row[2], ""))),
    ]
    note = "Status is the source of a value: published, measured, identified or assumed."
    return Table(title, columns, rows, note, style="facts")


def _housing(box: Mapping[str, Any], units: Units) -> list[list[str]]:
    """Return rows of the housing and its mounts."""

    def place(point: Sequence[float]) -> str:
        return f"at ({', '.join(units.given(v, 'm') for v in point)}) {units.unit('m')}"

    alone = ", ".join(f"{hz:.1f}" for hz in box["alone_hz"])
    mass = f"{units.value(box['mass'], 'kg'):.4g} {units.unit('kg')}"
    carries = f"{mass} {place(box['centre'])}, carries {', '.join(box['carries'])}"
    rows = [
        ["housing, elastic" if box["elastic"] else "housing, rigid", carries, "housing"],
        ["housing alone on its mounts", f"{alone} Hz", ""],
    ]
    for name, mount in box["mounts"].items():
        springs = ", ".join(
            f"{key} {engineering(value, 4)}" for key, value in mount["stiffness"].items()
        )
        text_ = f"{place(mount['position'])}, SI: {springs}, loss factor {mount['loss']:g}"
        rows.append([f"mount {name}", text_, f"mount {name}"])
    return rows


def housing_columns(columns: Iterable[str]) -> list[tuple[str, str]]:
    """Return columns of a response for its housing, with their titles."""
    return [
        (column, column.partition(" [")[0])
        for column in columns
        if column.startswith("mount ")
        and " force [" in column
        or column.startswith("housing ")
        and " acceleration [" in column
    ]


def housing(response: TrainResponse, units: Units = ENGINEERING) -> Table:
    """Return the largest loads of mounts and accelerations of the housing over a response."""
    rows = []
    for column, name in housing_columns(response.columns):
        size = abs(response.columns[column])
        si, top = column.partition(" [")[2].rstrip("]"), int(size.argmax())
        largest = Cell(float(size[top]), "", units.text(float(size[top]), si, 4))
        rows.append((name, largest, response.frequency_hz[top], si))
    columns = [
        text("of the housing", lambda row: row[0]),
        text("largest", lambda row: row[1]),
        Column("Hz", lambda row: row[2], hertz),
        Column("unit", lambda row: row[3], hidden=True),
    ]
    note = "Root of the sum of squares of the amplitudes in all three directions."
    return Table("Loads of mounts and accelerations", columns, rows, note)


def _materials(scene: Mapping[str, Any], units: Units) -> str:
    """Return materials of a shaft, each with the segments that are not of the first one."""
    parts: dict[str, list[str]] = {material_words(scene["material"], units): []}
    for segment in scene["segments"]:
        words = material_words(segment.get("material") or scene["material"], units)
        parts.setdefault(words, []).append(str(segment.get("name", "")))
    first, *further = parts
    return "; ".join([first, *(f"{', '.join(parts[words])}: {words}" for words in further)])


def _mesh(mesh: Mapping[str, Any], status: Mapping[str, str], units: Units) -> list[list[str]]:
    """Return rows of one mesh, below its name where there are several."""
    name, (pinion, gear) = mesh["name"], mesh["teeth"]
    first = mesh["between"][0].partition(".")[0]
    keys = f"{name}.stiffness", f"{name}.transmission_error"
    line = next((k for k in status if k.startswith(f"{name}.") and k not in keys), "")
    rows = [
        ["teeth", f"{pinion} and {gear}, ratio {gear / pinion:.4f}", ""],
        ["shaft angle", f"{degrees(mesh['shaft_angle']):g}°", ""],
        ["mesh stiffness", units.text(mesh["stiffness"], "N/m", 4), keys[0]],
        [f"line of action on the {first}", _vector(mesh["line_of_action"][0], 4), line],
        ["mesh point from the lumped points", _points(mesh, units), ""],
        ["lever arms", _levers(mesh, units), ""],
        ["transmission error", _error(mesh["transmission_error"], units), keys[1]],
    ]
    return rows if name == "mesh" else [[name, " and ".join(mesh["between"]), ""], *rows]


def _stage(stage: Mapping[str, Any], units: Units) -> list[list[str]]:
    """Return rows of one planetary stage."""
    name, planet, mesh = stage["name"], stage["planet"], stage["mesh"]
    sun, turning, ring = stage["teeth"]
    angles = ", ".join(f"{degrees(angle + stage['position']):.4g}°" for angle in stage["angles"])
    stiff = (units.text(mesh[f"{mate}_stiffness"], "N/m", 4) for mate in ("sun", "ring"))
    pin = f"on pins of {units.text(planet['pin']['radial'], 'N/m', 4)} radially"
    rows = [
        [name, f"sun {stage['sun']}, carrier {stage['carrier']}", ""],
        ["teeth", f"sun {sun}, planets {turning}, ring {ring}, ratio {stage['ratio']:.4f}", ""],
        ["planets", f"at {angles}, pins at {units.text(stage['pin_radius'], 'm', 4)}", ""],
        ["each planet", f"{units.text(planet['mass'], 'kg', 4)} {pin}", f"{name}.planet"],
        ["meshes with sun and ring", " and ".join(stiff), f"{name}.mesh"],
        ["transmission error of each", _errors(mesh, units), f"{name}.mesh"],
    ]
    support = "fixed"
    if stage["ring"] is not None:
        support = f"{units.text(stage['ring']['mass'], 'kg', 4)} on springs"
    return [*rows, ["ring", support, f"{name}.ring"]]


def _errors(mesh: Mapping[str, Any], units: Units) -> str:
    """Return the transmission errors of planets with sun and ring."""
    both = (mesh[f"{mate}_error"] or mesh["transmission_error"] for mate in ("sun", "ring"))
    return " and ".join(dict.fromkeys(_error(error, units) for error in both))


def _vector(values, digits: int) -> str:
    return f"({', '.join(f'{v:.{digits}f}' for v in values)})"


def _points(mesh: Mapping[str, Any], units: Units) -> str:
    unit = units.unit("m")
    digits = 2 if unit == "mm" else 4
    points = (_vector([units.value(v, "m") for v in point], digits) for point in mesh["point"])
    return " and ".join(f"{text} {unit}" for text in points)


def _levers(mesh: Mapping[str, Any], units: Units) -> str:
    arms = (units.given(abs(lever), "m") for lever in mesh["lever"])
    return " and ".join(f"{arm} {units.unit('m')}" for arm in arms)


def _error(table: Mapping[str, Any] | None, units: Units) -> str:
    if table is None:
        return "none"
    unit = units.unit("m moved")
    if table["orders"]:
        sizes = ", ".join(units.given(v, "m moved") for v in table["orders"])
        return f"{sizes} {unit}" + (" by order of the mesh" if len(table["orders"]) > 1 else "")
    low, high = table["frequency"][0], table["frequency"][-1]
    most = units.given(max(table["amplitude"]), "m moved")
    return f"a table from {low:g} to {high:g} Hz, up to {most} {unit}"


def peaks(
    tops: Sequence[tuple[float, float, str]],
    name: str,
    si: str,
    teeth: float,
    units: Units = ENGINEERING,
    model: str = "",
    bars: Mapping[str, float] = MappingProxyType({}),
) -> Table:
    """Return peaks (Hz, size, mode) of a quantity such as ``mesh force`` in its SI unit, with the
    error bars of modes by meshes.
    """
    units = units.fitting([size for _, size, _ in tops], si)
    columns = [
        replace(text("its mode", lambda peak: peak[2]), name="mode"),
        Column("Hz", lambda peak: peak[0], hertz),
        _speed(turned(teeth), lambda peak: 60 * peak[0] / teeth),
        quantity(name, si, units, lambda peak: peak[1], 4),
    ]
    note = ""
    if bars:
        bar = Column("mesh", lambda peak: bars.get(peak[2]), lambda bar: f"{bar:.0e}")
        columns.append(replace(bar, name="error bar of the frequency", unit="1"))
        note = MOVED_BY_MESHES
    title = f"Peaks of the {name}{', ' + model if model else ''}"
    return Table(title, columns, tops, note, style="ruled")


def _speed(shaft: str, of: Callable[[Any], float]) -> Column:
    """Return a column of speeds of a shaft."""
    return Column(f"{shaft} rpm", of, whole, name=f"{shaft} speed", unit="rpm")


def turned(teeth: float | None) -> str:
    """Return the shaft of speeds: the pinion unless the teeth name another."""
    from solidgear.trains.file.layout import PerTurn  # start-up: pages of one shaft have none

    return teeth.of if isinstance(teeth, PerTurn) else "pinion"


def crossings(rows: Sequence[Crossing], units: Units = ENGINEERING, shaft: str = "pinion") -> Table:
    """Return the table of crossings of order lines and natural frequencies."""
    columns = [
        text("order", lambda crossing: crossing.line),
        text("mode", lambda crossing: crossing.mode),
        Column("Hz", lambda crossing: crossing.frequency_hz, hertz),
        _speed(shaft, lambda crossing: crossing.rpm),
        quantity("mesh force", "N", units, lambda crossing: crossing.force, 4),
    ]
    note = "A dash: the transmission error has no such order."
    return Table("Where orders meet natural frequencies", columns, rows, note)
