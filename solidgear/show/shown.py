"""Scenes, bodies and results as they show themselves: in a line, a table or a picture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.core import DOF_NAMES
from solidgear.core.quantity import ACROSS, BLOCK_UNITS, QUANTITIES, Quantity
from solidgear.show.panel import GREY, Panel, Series, curve
from solidgear.show.plot import Chart, in_columns
from solidgear.show.scales import Axis
from solidgear.show.sketch import Sketch, draw
from solidgear.show.table import Cell, Column, Table
from solidgear.show.words import bar_of, percent

if TYPE_CHECKING:
    from solidgear.core import Body, Condensed, Mode, ModeSet, Scene
    from solidgear.core.judge.answer import Answered
    from solidgear.core.solve.condensed import Coupled

#: shapes that a picture shows unless told otherwise
MOST_SHAPES = 6
#: a motion this small beside the largest of its mode is not drawn
SMALL = 0.05
#: of motions along and about x, y and z
COLOURS = ("#0072b2", "#00805e", "#c4541c")


def scene(shaft: Scene) -> Table:
    """Return parts of a shaft along its axis."""
    rows: list[tuple[str | float, ...]] = []
    for s in shaft.segments:
        bore = f", bore {_diameters(s.inner0, s.inner1)} mm" if s.inner0 or s.inner1 else ""
        size = f"diameter {_diameters(s.outer0, s.outer1)} mm{bore}"
        rows.append((s.name, "segment", 1e3 * s.y0, 1e3 * s.y1, size))
    for f in shaft.features:
        lo, hi = f.span(shaft.segments)
        rows.append((f.name, f.what, 1e3 * lo, 1e3 * hi, f"on {f.segment}"))
    for b in shaft.bearings:
        rows.append((b.name, "bearing", *(1e3 * y for y in b.rim), b.attachment))
    seats = {s.name: s for s in shaft.stations}
    for m in shaft.masses:
        seat = seats[m.station]
        rows.append((m.name, "mass", 1e3 * seat.lo, 1e3 * seat.hi, f"{m.mass:.6g} kg"))
    for c in shaft.corners:
        rows.append(
            (c.name, c.kind, *(1e3 * y for y in c.span), f"on {shaft.segments[c.owner].name}")
        )
    if shaft.body is not None:
        rows.append(
            (
                shaft.body.name,
                shaft.body.what,
                0.0,
                1e3 * shaft.length,
                "segments are its round part",
            )
        )
    for port in shaft.ports:
        rows.append((port.name, "port", 1e3 * port.lo, 1e3 * port.hi, port.attachment))
    title = shaft.title or shaft.name
    return Table(
        f"Scene {shaft.name}: {title}, {1e3 * shaft.length:.6g} mm long",
        ("part", "kind", "from mm", "to mm", "what"),
        rows,
    )


def _diameters(first: float, last: float) -> str:
    """Return diameters by the radii at both ends, mm."""
    return " to ".join(f"{2e3 * r:.6g}" for r in dict.fromkeys((first, last)))


def scene_figure(shaft: Scene) -> Sketch | None:
    """Return the dimensioned section of the report."""
    return draw(shaft.as_dict())


def body(free_body: Body) -> Table:
    """Return blocks of a body."""
    rows = [
        (b.name, " ".join(DOF_NAMES[c] for c in b.components), b.size, b.mirror is not None)
        for b in free_body.blocks
    ]
    ports = ", ".join(f"{p.name} ({p.attachment})" for p in free_body.ports)
    return Table(
        f"Body {free_body.fidelity}: {free_body.size} unknowns, ports {ports}",
        ("block", "moves", "unknowns", "twin"),
        rows,
    )


def mode_set(modes: ModeSet) -> Table:
    """Return the natural frequencies."""
    rows = [(m.name, m.frequency_hz, m.multiplicity, m.waves, m.error) for m in modes.modes]
    return Table(
        f"Modes of the {modes.fidelity} body",
        ("mode", "Hz", "shapes", "waves around", "solver's error"),
        rows,
    )


def mode_set_tables(modes: ModeSet) -> dict[str, Table]:
    """Return frequencies, and motions of sections in all shapes: those of a pair are two."""
    shapes = [
        (f"{mode.name} {letter}".strip(), mode.frequency_hz, y, dof, float(motion))
        for mode in modes.modes
        for letter, sections in zip("ab" if mode.multiplicity > 1 else [""], mode.motions)
        for y, six in zip(modes.stations, sections)
        for dof, motion in zip(DOF_NAMES, six)
    ]
    motions = shapes_table("sections", "y [m]", shapes)
    return {"frequencies": mode_set(modes), "shapes": motions}


def shapes_table(of: str, place: str, rows: Sequence[Sequence[Any]]) -> Table:
    """Return motions in all shapes, of rows with shape, frequency, place, component and motion."""
    columns = [
        Column("shape", axis=True),
        Column("frequency [Hz]", over="shape"),
        Column(place, axis=True),
        Column("component", axis=True),
        Column("motion"),
    ]
    title = f"Motions of {of}, of unit modal mass; rotations in rad for translations in m"
    return Table(title, columns, rows)


def mode_set_figure(modes: ModeSet, names: Sequence[str] = ()) -> Chart:
    """Draw section motions of elastic modes along the shaft: translations, for torsion rotations.

    Parameters
    ----------
    names : sequence of str
        Modes to draw, by name; the first few elastic ones by default.
    """
    elastic = [m for m in modes.modes if m.frequency_hz > 0]
    chosen = [modes.named(name) for name in names] if names else elastic[:MOST_SHAPES]
    drawn = [mode for mode in chosen if mode is not None]
    if not drawn or len(drawn) < len(chosen):
        raise ValueError(f"no such mode; there are {', '.join(modes.names)}")
    panels = [_shape(modes, mode, last=mode is drawn[-1]) for mode in drawn]
    return Chart(in_columns(panels, 1), 640.0)


def _shape(modes: ModeSet, mode: Mode, last: bool) -> Panel:
    """Draw section motions of a mode; those that are small beside the largest are left out."""
    y = 1e3 * modes.stations
    moves, turns = np.abs(mode.motions[0]).max(axis=0).reshape(2, 3)
    # turns of a bent line say what the line says; where it stays, as in torsion, they are all
    bent = moves.max() > SMALL * turns.max() * np.ptp(modes.stations)
    components = range(3) if bent else range(3, 6)
    largest = (moves if bent else turns).max() or 1.0
    moving = [k for k in components if np.abs(mode.motions[0, :, k]).max() > SMALL * largest]
    panel = Panel(
        Axis("y, mm" if last else "", (float(y.min()), float(y.max()))),
        Axis("", (-1.15, 1.15), ticks={}),
        80.0,
        f"{mode.name}, {mode.frequency_hz:.1f} Hz",
        series={DOF_NAMES[k]: Series(COLOURS[k % 3]) for k in moving},
        legend={"orient": "right", "symbolType": "stroke"},
        left=10.0,
        right=60.0,
    )
    panel.draw({"type": "rule", "color": GREY}, [{"y": 0.0}])
    for k in moving:
        line = curve(y, mode.motions[0, :, k] / largest, name=DOF_NAMES[k])
        panel.draw({"type": "line", "strokeWidth": 1.5, "point": {"size": 14}}, line)
    return panel


def condensed(statics: Condensed, kind: str = "stiffness") -> Table:
    """Return the 6x6 at a port, a stiffness or a compliance."""
    return _matrix(statics, kind, f"at {statics.port} ({statics.attachment})", DOF_NAMES, "free")


def condensed_tables(statics: Condensed | Coupled) -> dict[str, Table]:
    """Return both matrices as they are shown, and their entries with units."""
    heads = list(statics.order)
    rows = [
        (
            *(a, b),
            *(float(getattr(statics, kind)[i, j]) for kind in BLOCK_UNITS),
            *(of_kind[(i % 6 > 2) + (j % 6 > 2)] for of_kind in BLOCK_UNITS.values()),
        )
        for i, a in enumerate(heads)
        for j, b in enumerate(heads)
    ]
    columns = [Column(head, axis=True) for head in ("row", "column")]
    columns += [*map(Column, BLOCK_UNITS), *(Column(f"unit of {kind}") for kind in BLOCK_UNITS)]
    shown: dict[str, Any] = {kind: statics.table(kind) for kind in BLOCK_UNITS}
    return {**shown, "entries": Table("entries", columns, rows)}


coupled_tables = condensed_tables


def coupled(statics: Coupled, kind: str = "compliance") -> Table:
    """Return the matrix between several ports, a stiffness or a compliance."""
    heads = [f"{port} {name}" for port in statics.ports for name in DOF_NAMES]
    return _matrix(statics, kind, f"between {' and '.join(statics.ports)}", heads, "free together")


def _matrix(
    statics: Condensed | Coupled, kind: str, place: str, heads: Sequence[str], free: str
) -> Table:
    if kind not in BLOCK_UNITS:
        raise ValueError(f"kind {kind!r}: use stiffness or compliance")
    rows = [
        (name, *(float(v) if np.isfinite(v) else None for v in row))
        for name, row in zip(heads, getattr(statics, kind))
    ]
    names = f"; {free}: {', '.join(statics.free_names)}" if statics.free_names else ""
    return Table(f"{kind} {place}, {', '.join(BLOCK_UNITS[kind])}{names}", ("", *heads), rows)


def comparison(compared: Any) -> Table:
    """Return the verdict and first numbers of every model."""
    record, rows = compared.record, []
    for name, model in record.models.items():
        first = model.mode("bending 1")
        c_zz = model.compliance[2][2] if model.compliance else None
        spent = round(sum(v for v in model.seconds.values() if v is not None), 3)
        rows.append(
            (name, c_zz, first.frequency_hz if first else None, model.valid, model.dofs, spent)
        )
    trust = record.verdict.trust
    tolerance = percent(record.verdict.tolerance, signed=False)
    title = f"trust {trust}" if trust else "not judged"
    return Table(
        f"Comparison of {compared.scene.name}: {title}; within {tolerance}: {record.verdict.cheapest or 'none'}",
        ("model", "C_zz m/N", "bending 1 Hz", "valid", "unknowns", "s"),
        rows,
    )


def comparison_tables(compared: Any) -> dict[str, Table]:
    """Return the models, and the numbers of each with their error bars."""
    rows = []
    for name, model in compared.record.models.items():
        for quantity in (*QUANTITIES, *ACROSS):
            if quantity.is_frequency:
                mode = model.mode(quantity)
                value = None if mode is None else mode.frequency_hz
            else:
                value = model.value(quantity)
            rows.append((name, str(quantity), value, quantity.unit, model.bars.get(quantity)))
    axes = [Column(head, axis=True) for head in ("model", "quantity")]
    numbers = Table("Numbers", [*axes, "value", "unit", Column("error bar", unit="1")], rows)
    return {"models": comparison(compared), "numbers": numbers}


def answered(answer: Answered) -> Table:
    """Return numbers with their error bars."""
    rows = [(v.quantity, v.value, v.unit, Cell(v.bar, "", bar_of(v))) for v in answer.values]
    words = "within" if answer.reached else "not within"
    return Table(
        f"Answer for {answer.scene}: {answer.rung}, {words} {percent(answer.tolerance, signed=False)}",
        ("quantity", "value", "unit", "error bar"),
        rows,
    )


def swept(rows: Any) -> Table:
    """Return the varied values, the first natural frequencies with error bars, and why a row has
    none.
    """
    heads = [*rows.varied, *(name for name in ("f1_hz", "f2_hz", "f3_hz") if name in rows.columns)]
    columns = [*heads, "status"]
    cells = [tuple(_told(rows.columns, head, k) for head in columns) for k in range(len(rows))]
    return Table("Rows of a sweep, SI", columns, cells)


def swept_tables(rows: Any) -> dict[str, Table]:
    """Return all columns of all rows, over the entries that vary where all combinations are there, else
    over the variants.
    """
    values = {name: rows.columns[name] for name in rows.varied}
    full = np.prod([len(set(column)) for column in values.values()]) == len(rows)
    places = len(set(zip(*values.values())))
    axes = rows.varied if full and places == len(rows) else ("variant",)
    columns = [
        Column(name, write=str, name=name, unit=_unit(name), axis=name in axes)
        for name in rows.columns
    ]
    return {"rows": Table("Rows of a sweep, SI", columns, list(zip(*rows.columns.values())))}


def _unit(column: str) -> str:
    """Return the unit of a column of a sweep, where its name says so."""
    name = Quantity(column.removesuffix(" bar"))
    if not name.is_frequency:
        return name.unit
    return "Hz" if name.endswith("_hz") else ""


def _told(columns: Mapping[str, list], head: str, k: int) -> str:
    """Return a number of a row with its error bar, where it has one."""
    value, bar = (columns[name][k] if name in columns else None for name in (head, f"{head} bar"))
    if value is None or isinstance(value, str):
        return (value or "-")[:60]
    return f"{value:.6g}" if bar is None else f"{value:.6g} ± {bar:.1g}"
