"""Sheets of sweeps: rows and curves over the number that varies, and sentences on the run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core import build, number_cautions
from solidgear.core.judge.cautions import SHOWN
from solidgear.core.plain import plain
from solidgear.guards.check import cautions as cautions_on
from solidgear.show.command import caution
from solidgear.show.panel import Panel, Series, readout
from solidgear.show.plot import NARROW, WIDE, Chart, Make, in_columns
from solidgear.show.scales import Axis
from solidgear.show.settled import over_the_sweep
from solidgear.show.sheet import Sheet, Terminal
from solidgear.show.shown import swept_tables
from solidgear.show.table import NUMBER, Column, Table, text
from solidgear.show.units import ENGINEERING, Units
from solidgear.show.units import plain as digits
from solidgear.trains.assembly.shaft import JUDGE, mix_label
from solidgear.trains.page.chart import COLOURS
from solidgear.variants.sweep.bearing_task import SweptBearings
from solidgear.variants.sweep.curves import Curve, Curves
from solidgear.variants.sweep.error_chart import error_chart, error_table
from solidgear.variants.sweep.error_curves import ErrorCurves
from solidgear.variants.sweep.file_task import BARS, Swept
from solidgear.variants.sweep.shaft_numbers import NOT_RATED
from solidgear.variants.sweep.train_task import CONTACT, MODES, MOST_MODES, PARTS, TrainTask

#: file of all rows in a folder
ROWS = Path("rows.csv")
#: rows that are printed on the terminal as well
FEW = 40
#: reasons of refusals that are printed
REASONS = 5
#: px; names at the right ends of curves, and the least distance of two
NAMES, APART = 150.0, 13.0
#: natural frequencies in the table of a train without operating points
MOVING = 4
#: mode that is shown whether it moves or not
FIRST = "bending 1"
#: of the largest value of a column
ROUNDING = 1e-9
#: colour of curves with their names beside them
LINE = "#00805e"


def sweep_sheet(result: Swept, units: Units = ENGINEERING, chart: Path | None = None) -> Sheet:
    """Return the sheet of a sweep, whose curves go into a file where one is given."""
    if isinstance(result, SweptBearings):
        return _bearings_sheet(result, units, chart)
    if isinstance(result.task, TrainTask):
        return _train_sheet(result, result.task, units, chart)
    return _scene_sheet(result, units, chart)


def filed_sheet(result: Swept, units: Units, folder: Path) -> Sheet:
    """Return the sheet of a sweep for a folder, which gets the rows as well."""
    sheet, rows = sweep_sheet(result, units), ROWS.with_suffix("").name
    return replace(
        sheet,
        lead=sheet.lead.replace(result.path.name, ROWS.name),
        data={**sheet.data, "file": ROWS.name},
        lines={rows: swept_tables(result)["rows"]},
    )


def _bearings_sheet(result: SweptBearings, units: Units, chart: Path | None) -> Sheet:
    """Return the sheet of a sweep of bearings on one body."""
    task, settled = result.task, result.task.settled
    scene = task.variants.scene
    cautions = cautions_on(scene, build(scene.plain, "timoshenko"), task.model)
    cautions += number_cautions(scene, SHOWN, task.model)
    return _sheet(
        result,
        scene.title or scene.name,
        units,
        lead=f"Rows in {result.path.name}.",
        solved="Bearings alone vary: one body does for all, reduced to its seats.\n"
        f"{result.unknowns} unknowns with {result.seats} seats solved once in "
        f"{result.seconds_once:.1f} s;\n{result.total - result.skipped} variants of up to "
        f"{result.basis} unknowns, {1e3 * result.seconds_each:.1f} ms each; {result.refused} "
        f"refused, {result.full} solved in full.",
        notes=[*filter(None, [result.settling]), *over_the_sweep(settled)],
        chart=chart,
        cautions=cautions,
        data=plain(result) | {"cautions": cautions} | ({} if settled is None else plain(settled)),
        reached=settled is None or settled.reached,
    )


def _scene_sheet(result: Swept, units: Units, chart: Path | None) -> Sheet:
    """Return the sheet of variants of the file of a shaft."""
    return _sheet(
        result,
        result.task.variants.path.stem,
        units,
        lead=f"Rows in {result.path.name}.",
        solved=_solved(result),
        notes=[*_on_bars(result), *result.task.variants.followed, *_not_rated(result)],
        chart=chart,
        cautions=result.cautions,
        data=plain(result) | {"cautions": result.cautions},
    )


def _on_bars(result: Swept) -> list[str]:
    """Return a sentence on the error bars of the rows, where there is something to say of them."""
    if BARS in result.columns:
        return ["A model that is given has no error bars; -f auto has."]
    columns = result.columns
    bars = [
        bar / hz
        for bar, hz in zip(columns.get("f1_hz bar", []), columns.get("f1_hz", []))
        if bar is not None and hz
    ]
    if bars:
        return [f"Error bars are in columns beside the numbers; of f1 up to {max(bars):.2g}."]
    names = [name for name in columns if name.endswith(" bar") and name != "mass bar"]
    barred = any(any(columns[name]) for name in names)
    return ["Error bars are in columns beside the numbers."] if barred else []


def _not_rated(result: Swept) -> list[str]:
    """Return a sentence on what has no safety, and may be worse than the worst notch."""
    names = [*dict.fromkeys(filter(None, result.columns.get(NOT_RATED, [])))]
    rest = f" (and {len(names) - 1} more in other rows)" if len(names) > 1 else ""
    return [f"Not rated, and perhaps worse: {names[0]}{rest}."] if names else []


def _train_sheet(result: Swept, task: TrainTask, units: Units, chart: Path | None) -> Sheet:
    """Return the sheet of variants of the file of a train; the shafts made are known where no other
    process made any.
    """
    title, models = task.usual.title or task.usual.name, mix_label(task.models)
    if task.ask == (CONTACT,):
        models = "teeth by plane slices, on Timoshenko shafts"
    made, cut = task.bench.made if result.alone else None, task.cut(result.columns)
    notes = [*task.variants.followed]
    if cut > 0:
        notes.append(
            f"Rows have up to {MOST_MODES + cut} natural frequencies, and columns for "
            f"{MOST_MODES}: give -n {MOST_MODES + cut} for all."
        )
    if MODES in task.ask:
        meshes = ""
        if JUDGE in task.models.values():
            meshes = "; what the meshes leave, solidgear system-modes shows for one variant"
        notes.append(f"Column reduction_bound: what the reduction leaves, proven{meshes}.")
    if CONTACT in task.ask:
        model = "" if task.ask == (CONTACT,) else "Teeth: plane slices, on Timoshenko shafts. "
        notes.append(
            f"{model}Numbers of teeth have no error bars here; solidgear contact has them."
        )
    cautions = (*result.cautions, *_caution_on_parting(result))
    shafts = "" if not made else f"{made} shafts meshed and reduced; "
    return _sheet(
        result,
        title,
        units,
        heading=[f"{title}: {models}"],
        lead=f"{models[0].upper()}{models[1:]}; rows in {result.path.name}.",
        solved=shafts + _solved(result),
        notes=notes,
        chart=chart,
        errors=result.error_curves,
        cautions=cautions,
        data=plain(result) | {"bodies": made, "cut": cut, "title": title, "cautions": cautions},
    )


def _sheet(
    result: Swept,
    title: str,
    units: Units,
    *,
    heading: Sequence[str] = (),  # of the terminal
    lead: str,
    solved: str,  # how the variants of this run were solved
    notes: Sequence[str],
    cautions: Sequence[str],
    data: Mapping[str, Any],
    chart: Path | None = None,  # file of it
    errors: Sequence[ErrorCurves] = (),  # of the teeth over the torque
    reached: bool = True,
) -> Sheet:
    """Return the sheet of a sweep; a terminal shows few rows, and the sentences on the run."""
    curves, charts, tables = result.curves, dict[str, Make](), list[Table]()
    if curves is not None and not curves.empty:
        title, tables = f"{title}: sweep over {curves.over}", [sweep_table(curves, units)]
        charts = {"sweep": partial(sweep_chart, curves, "", units)}
    few = curves is not None and len(curves.x) <= FEW and curves.on_terminal
    if errors:
        tables = [error_table(mesh, units) for mesh in errors]
        charts = {"transmission_error": partial(error_chart, errors, "", units)}
        few = len(errors[0].torque) <= FEW
    path = str(result.path).encode("utf-8", "backslashreplace").decode()  # bytes that are no text
    new = result.total - result.skipped
    before = f"; {result.skipped} more were there already" if result.skipped else ""
    run = [f"{path}: all {result.total} rows were there already."]
    if new:
        run = [f"Wrote {_counted(new, 'row')} to {path}{before}.", solved]
    drawn = [] if chart is None else [f"Chart: {chart if charts else 'none'}"]
    return Sheet(
        name="sweep",
        title=title,
        lead=lead,
        tables=tables,
        data=data,
        charts=charts,
        cautions=cautions,
        reached=reached,
        terminal=Terminal(
            heading=heading,
            tables=tables if few else [],
            closing=[*run, *refusals(result), *notes, *drawn, *map(caution, cautions)],
        ),
        words={
            "sweep": "Natural frequencies and other columns over the number that varies.",
            "transmission_error": "Loaded transmission error from peak to peak over the torque.",
        },
    )


def _counted(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def _solved(result: Swept) -> str:
    """Return the sentence on the variants of this run and their time."""
    new, seconds = result.total - result.skipped, result.seconds
    each = 1e3 * seconds / max(new, 1)
    return f"{_counted(new, 'variant')} in {seconds:.1f} s, {each:.0f} ms each; {result.refused} refused."


def _caution_on_parting(result: Swept) -> list[str]:
    """Return the sentence on rows whose teeth part, if there are any."""
    lowest = [hz for hz in result.columns.get(PARTS, []) if hz is not None]
    if not lowest:
        return []
    rows = "row" if len(lowest) == 1 else "rows"
    return [
        f"in {len(lowest)} {rows} of {result.total} the dynamic mesh force passes the mean one, from "
        f"{min(lowest):.0f} Hz at the lowest (column {PARTS}): the teeth part, and peaks from there on "
        "do not hold; ask solidgear nonlinear of that variant"
    ]


def refusals(result: Swept) -> list[str]:
    """Return a sentence a reason for which variants were refused, the commonest first."""
    reasons = sorted(result.whys.items(), key=lambda why: -why[1])
    sentences = []
    for reason, count in reasons[:REASONS]:
        variants = f" ({count} variants)" if count > 1 else ""
        sentences.append(f"Refused{variants}: {reason}")
    if len(reasons) > REASONS:
        others = sum(count for _, count in reasons[REASONS:])
        sentences.append(f"{others} more are refused for other reasons (column status).")
    return sentences


def sweep_chart(
    curves: Curves, title: str, units: Units = ENGINEERING, width: float = WIDE
) -> Chart:
    """Draw natural frequencies and all other curves of the rows over the number that varies; width in
    px.
    """
    lengths = [curve for curve in curves.misalignment if curve.unit == "m moved"]
    angles = [curve for curve in curves.misalignment if curve.unit != "m moved"]
    first = _panel(
        curves, curves.frequencies, "natural frequency", units, 380.0, named=width > NARROW
    )
    others = [
        _panel(curves, curves.peak_force, "largest mesh force", units),
        _panel(curves, lengths, "misalignment", units),
        _panel(curves, angles, "misalignment", units),
        _panel(curves, curves.radial, "radial load of bearings", units),
        _panel(curves, curves.axial, "axial load of bearings", units),
    ]
    others += [_panel(curves, lines, name, units) for name, lines in curves.teeth.items()]
    panels = [panel for panel in others if panel is not None]
    rows = [[first]] if first is not None else []
    return Chart(rows + in_columns(panels, 2 if width > NARROW else 1), width, title)


def sweep_table(curves: Curves, units: Units = ENGINEERING) -> Table:
    """Return the table of every row: of a train the operating point and the largest peak of the mesh
    force, else the stiffness at the lumped point and the modes that move most, by their names.
    """
    columns = [text("point", lambda k: curves.labels[k])] if curves.labels else []
    last = curves.over.rpartition(".")[2]
    columns.append(
        Column(f"{last}\n{curves.unit or 'SI'}", lambda k: f"{curves.x[k]:.6g}", kind=NUMBER)
    )
    of_train = [*curves.mesh_force, *curves.misalignment]
    modes = _by_name(curves.frequencies)
    shown = {} if of_train or curves.teeth else _moving_most(modes)
    numbers = [(c.name, c.values, c.unit) for c in (*of_train, *curves.statics)]
    for name, lines in curves.teeth.items():
        numbers += [(f"{name} {c.name}".strip(), c.values, c.unit) for c in lines]
    numbers += [(name, values, "Hz") for name, values in shown.items()]
    numbers += [("peak", c.values, c.unit) for c in (*curves.peak_hz, *curves.peak_force)]
    columns += [_column(head, values, si, units) for head, values, si in numbers]
    for hz in curves.peak_hz:
        columns.append(text("mode", [word or None for word in hz.words].__getitem__))
    notes = ["Peak: largest of the mesh force."] if curves.peak_hz else []
    if len(shown) < len(modes) and shown:
        notes.append("Modes that change most; the file has all.")
    style = "bare" if len(curves.mesh_force) < 2 else "ruled"  # names of meshes fill their columns
    return Table(f"Over {curves.over}", columns, range(len(curves.x)), " ".join(notes), style=style)


def _by_name(frequencies: Sequence[Curve]) -> dict[str, np.ndarray]:
    """Return the natural frequencies of all rows by the names of modes, the lowest first."""
    modes: dict[str, np.ndarray] = {}
    for curve in frequencies:
        for k, name in enumerate(curve.words):
            if name:
                row = modes.setdefault(name, np.full(len(curve.values), np.nan))
                row[k] = curve.values[k] if np.isnan(row[k]) else row[k]
    return dict(sorted(modes.items(), key=lambda mode: float(np.nanmin(mode[1]))))


def _moving_most(modes: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return first bending and the modes that change most, in their order."""
    compared = {name: values for name, values in modes.items() if np.isfinite(values).sum() > 1}
    change = {name: np.nanmax(values) / np.nanmin(values) for name, values in compared.items()}
    most = sorted(change, key=lambda name: (name != FIRST, -change[name]))[:MOVING]
    return {name: values for name, values in modes.items() if name in (most or modes)}


def _column(head: str, numbers: np.ndarray, si: str, units: Units) -> Column:
    write = partial(units.number, si=si, digits=4)
    # numbers that are negligible beside the others are rounding
    least = ROUNDING * float(np.nanmax(np.abs(numbers)))
    values = np.where(np.abs(numbers) < least, 0.0, numbers).tolist()
    return Column(f"{head}\n{units.unit(si)}", values.__getitem__, write)


def _panel(
    curves: Curves,
    lines: Sequence[Curve],
    title: str,
    units: Units,
    height: float = 230.0,
    named: bool = False,
) -> Panel | None:
    """Draw curves of one unit; None where there is none. Named ones have their words at their ends, the
    others a legend where there are several.
    """
    if not lines:
        return None
    unit = units.unit(lines[0].unit)
    if len(lines) == 1 and not lines[0].words:
        title = f"{title} {lines[0].name}".strip()
    values = [units.values(curve.values, curve.unit) for curve in lines]
    several = len(lines) > 1 and not lines[0].words
    series = {curve.name: Series(COLOURS[k % len(COLOURS)]) for k, curve in enumerate(lines)}
    over = f"{curves.over}, {curves.unit}" if curves.unit else curves.over
    panel = Panel(
        Axis(over, _ends(curves.x, 0.0, curves.log), log=curves.log),
        Axis(f"{title} in {unit}" if unit else title, _ends(np.concatenate(values), 0.06)),
        height,
        series=series if several else {},
        legend={"orient": "top", "columns": 4, "symbolType": "stroke", "symbolStrokeWidth": 3},
        right=NAMES if named else 8.0,
    )
    for curve, y in zip(lines, values):
        look = {"name": curve.name} if several else {}
        colour = series[curve.name].colour if several else LINE
        fixed_colour = {} if several else {"color": LINE}
        line = {"type": "line", "point": {"size": 14, **fixed_colour}, **fixed_colour}
        # a curve is broken where a variant was refused
        parts = zip(curves.x.tolist(), y.tolist(), np.cumsum(~np.isfinite(y)).tolist())
        panel.draw(line, [{"x": a, "y": b, "detail": part, **look} for a, b, part in parts])
        panel.read(_readouts(curves, curve, y, title, unit), colour)
    if named:
        _draw_names(panel, curves, lines, values)
    return panel


def _readouts(
    curves: Curves, curve: Curve, y: np.ndarray, title: str, unit: str
) -> list[dict[str, Any]]:
    """Return the words on every place of a curve."""
    rows = []
    for k, (a, b) in enumerate(zip(curves.x.tolist(), y.tolist())):
        label = curves.labels[k] if curves.labels else curve.name
        words = curve.words[k] if curve.words else curve.name
        over = curves.over, f"{a:.6g}", curves.unit
        rows.append(
            {"x": a, "y": b, "readout": readout(words or label, over, (title, digits(b, 5), unit))}
        )
    return rows


def _draw_names(
    panel: Panel, curves: Curves, lines: Sequence[Curve], values: Sequence[np.ndarray]
) -> None:
    """Draw the words of the last place of each curve beside it, unless they would lie on others."""
    low, high = panel.y.ends
    step = APART * (high - low) / panel.height
    rows, last = [], -np.inf
    for curve, y in zip(lines, values):
        if np.isfinite(y[-1]) and y[-1] >= last + step:
            last = float(y[-1])
            rows.append({"x": float(curves.x[-1]), "y": last, "text": curve.words[-1]})
    look = {"type": "text", "align": "left", "dx": 6, "fontSize": 10}
    panel.draw(look, rows)


def _ends(values: np.ndarray, room: float, log: bool = False) -> tuple[float, float]:
    """Return the ends of an axis that holds all values."""
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    more = room * (high - low) if high > low else 0.5 * abs(high) or 1.0
    if log:
        return (low, high) if high > low else (low / 2, high * 2)
    return (low - more if low < 0 else max(low - more, 0.0)), high + more
