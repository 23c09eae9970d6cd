"""Sheets of a shaft and of a train at rest under load: sentences, tables, charts and lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from math import degrees, isfinite
from typing import Any

import numpy as np

from solidgear.core import DOF_NAMES, listed
from solidgear.show.command import caution
from solidgear.show.panel import GREY, Panel, Series, curve, lines_legend, readout
from solidgear.show.plot import NARROW, WIDE, Chart, Make, in_columns
from solidgear.show.scales import Axis
from solidgear.show.sheet import Sheet, Terminal
from solidgear.show.table import Aside, Cell, Column, Table, in_units, numbers, quantity, text, word
from solidgear.show.units import ENGINEERING, Units
from solidgear.show.words import DASH
from solidgear.strength.deflection.at_rest import (
    MOVED,
    ROUNDING,
    Deflection,
    Deflections,
    Measured,
)
from solidgear.strength.deflection.shaft import BearingState, ShaftDeflection
from solidgear.strength.loads_sheet import loads_table, torque_table
from solidgear.trains.assembly.components import FORCE_UNITS
from solidgear.trains.assembly.layout import senses_sentence
from solidgear.trains.assembly.turn import StageTurn
from solidgear.trains.page.chart import COLOURS

BAR, ENDS = "error bar", ("least", "largest")
#: per cent; no smaller error bar is shown
LEAST = 0.01
#: what the charts say
LINES_SHOWN = (
    "Deflection lines of every shaft in both planes, by every model; dashed lines are bearings."
)
TURN_SHOWN = (
    "Mesh force of every planet over a turn of its carrier from the file's position on; bearings "
    "have their stiffness at rest."
)
OF_BARS = f"Error bar: of the mesh, by {{}}; none below {LEAST:g} % is shown."


def sheet(deflected: Deflections, units: Units) -> Sheet:
    """Return the sheet of a train at an operating point, or of a shaft under its load."""
    judge = deflected.judge
    skew = misalignment(deflected, units)
    pressed = face_load(judge, units)
    turning = over_a_turn(judge.turns, units)
    over = over_points if deflected.load is None else over_cases
    by_point = over(deflected.points, units)
    housed = housing(judge, units)
    acting, turned = _of_loads(judge, units)
    carried = [
        *acting,
        *motions(deflected, units),
        *bearings(judge, units),
        displacements(judge, units),
        *turned,
    ]
    title = f"{deflected.title}: deflection"
    by_model = {model.model: model.shafts for model in deflected.solutions}
    charts: dict[str, Make] = {"deflection": partial(deflection_chart, by_model, title, units)}
    charts |= {f"turn_{turn.stage}": partial(turn_chart, turn, units) for turn in judge.turns}
    words = {"deflection": LINES_SHOWN} | {f"turn_{turn.stage}": TURN_SHOWN for turn in judge.turns}
    lines = {f"deflection_{shaft.name}": line(shaft) for shaft in judge.shafts}
    lines |= {f"turn_{turn.stage}": turn_lines(turn) for turn in judge.turns}
    if deflected.load is not None:
        lead = f"{deflected.load.words(units)}; numbers by {judge.model}."
        heading, cautions = [deflected.title, lead], []
    else:
        force, point = mesh_forces_in_words(deflected, units), judge.point
        lead = f"At {point.label}: {force} along the line of action."
        sense = senses_sentence(deflected.senses)
        heading = [
            f"{deflected.title} at {point.label}",
            f"Mesh force {force} along the line of action, {'coast' if point.coast else 'drive'} "
            "flank.",
            f"{sense[0].upper()}{sense[1:]}.",
        ]
        cautions = [sense]
    return Sheet(
        name="deflection",
        title=title,
        lead=lead,
        tables=[skew, *pressed, *turning, *by_point, *housed, *carried],
        data=deflected.as_dict(),
        charts=charts,
        lines=lines,
        headline=deflected.verdict(),
        cautions=[*cautions, *judge.notes, *deflected.cautions],
        terminal=Terminal(
            heading=heading,
            tables=[skew, *pressed, *carried, *housed, *turning, *by_point],
            closing=[*judge.notes, *map(caution, deflected.cautions)],
        ),
        words=words,
    )


def _of_loads(judge: Deflection, units: Units) -> tuple[list[Table], list[Table]]:
    """Return tables of the loads and of the torque of a shaft alone; none of a train."""
    if judge.load is None or judge.statics is None:
        return [], []
    return loads_table(judge.load, judge.statics, units), torque_table(judge.statics, units)


def mesh_forces_in_words(deflected: Deflections, units: Units) -> str:
    """Return the force of every mesh in words; a planetary stage has it once for each planet."""
    words = []
    for name, size in deflected.judge.mesh_forces.items():
        planets = " (each planet)" if name in deflected.planets else ""
        words.append(f"{units.text(size, 'N', 5)}{name.removeprefix('mesh')}{planets}")
    return ", ".join(words)


def misalignment(deflected: Deflections, units: Units = ENGINEERING) -> Table:
    """Return misalignment by every model, with error bar and range by bearing data."""
    measures = deflected.judge.misalignment
    columns = [word("of the axes"), *(Column(s.model) for s in deflected.solutions)]
    has_ranges = any(m.open is not None for m in measures)
    columns += [
        Column("error bar"),
        Column("range", name="least", hidden=not has_ranges),
        Column("largest", hidden=True),
        Column("unit", hidden=True),
    ]
    rows: list[list[Any]] = []
    for k, m in enumerate(measures):
        values = [_misaligned(s, k) for s in deflected.solutions]
        share = Cell(m.bar, "", percent_of(m.bar, m.value) or DASH)
        shown = [in_units(value, m.unit, units, 3) for value in values]
        name = Cell(m.name, "", f"{m.name}, {units.unit(m.unit)}")
        least, largest = m.open or (None, None)
        ends = [units.number(end, m.unit, 3) for end in m.open or ()]
        range_ = Cell(least, "", " to ".join(ends) or DASH)
        rows.append([name, *shown, share, range_, largest, m.si_unit])
    note = (
        f"{meanings(measures, units)}. Error bar: of the last model's mesh, by "
        f"{deflected.judge.bars_by}; models differ by what their theory leaves out."
    )
    if has_ranges:
        note += " Range: by estimated insides and classes of clearance of the bearings. "
        note += deflected.judge.led
    return Table("Misalignment", columns, rows, note.strip())


def face_load(deflected: Deflection, units: Units = ENGINEERING) -> list[Table]:
    """Return the face load factor of every mesh by the norm; none without known teeth."""
    if not deflected.face_loads:
        return []
    columns = [
        word("mesh"),
        quantity("line load", "N/m along", units, digits=4),
        quantity("f_sh", "m moved", units, digits=3),
        quantity("flanks", "m moved", units, digits=3),
        Column("c_ga, N/(mm um)", write=_tooth_stiffness, name="c_ga", unit="N/m²"),
        Column("KHb", write="{:.2f}".format),
        Column("error bar"),
    ]
    rows = [
        [
            load.mesh,
            load.line_load,
            _without_rounding(load.skew, deflected.largest[0][0]),
            load.shape,
            load.stiffness,
            load.factor,
            Cell(load.bar, "", percent_of(load.bar, load.factor) or DASH),
        ]
        for load in deflected.face_loads
    ]
    note = (
        "By c_ga of the materials, f_sh under an even load and slopes of the file's flanks, without further "
        "deviations and running-in; line load: transverse force per face width. solidgear contact solves "
        "the teeth."
    )
    return [Table("Face load factor by ISO 6336-1", columns, rows, note)]


def percent_of(bar: float | None, value: float) -> str | None:
    """Return an error bar in per cent of a value; None without either."""
    if bar is None or not value:
        return None
    return f"± {max(100 * bar / abs(value), LEAST):.2g} %"


def meanings(measures: Sequence[Measured], units: Units) -> str:
    """Return the meanings of all numbers, each once for all meshes, with their faces."""
    meanings = {m.name.removesuffix(m.mesh): m.meaning for m in measures}
    faces: dict[str, dict[str, None]] = {}
    for m in measures:
        if m.face is not None:
            faces.setdefault(units.given(m.face, "m"), {})[m.mesh.strip()] = None
    unit = units.unit("m")
    parts = ", ".join(f"{face} {unit} {listed(meshes)}" for face, meshes in faces.items())
    width = (
        f"the face ({parts})" if len(faces) > 1 else "".join(f"{f} {unit} of face" for f in faces)
    )
    each = (f"{name}: {meaning}" for name, meaning in meanings.items())
    return "; ".join(each).replace("the face", width, 1)


def over_a_turn(turns: Sequence[StageTurn], units: Units = ENGINEERING) -> list[Table]:
    """Return the mesh forces of planets over a turn of their carrier, a table for each stage."""
    heads = ("here", "mean", "least", "largest", "once a turn")
    columns = [Column("planet"), *(quantity(head, "N", units, digits=4) for head in heads)]
    note = (
        "Force of each planet with the sun, and with the ring alike, since it spins freely; "
        "bearings have their stiffness at this position. Here: at the file's position; once a "
        "turn: amplitude at the carrier's frequency."
    )
    return [
        Table(
            f"Mesh forces over a turn of the carrier ({turn.stage})",
            columns,
            [[p.planet, p.at, p.mean, p.least, p.most, p.once] for p in turn.planets],
            note,
        )
        for turn in turns
    ]


def turn_lines(turn: StageTurn) -> Table:
    """Return the mesh force of every planet over the angle of the carrier in SI, for other
    programs.
    """
    forces = {f"planet {k} [N]": force for k, force in enumerate(turn.force.T, start=1)}
    return numbers({"carrier [rad]": turn.angle, **forces}, axes=1)


def _tooth_stiffness(value: float) -> str:
    return f"{1e-9 * value:.3g}"


def over_points(points: Sequence[Deflection], units: Units = ENGINEERING) -> list[Table]:
    """Return misalignment and radial bearing loads over several operating points; none for one
    point.
    """
    if not points:
        return []
    first = points[0]
    lie = [text("at")]
    for name in first.mesh_forces:
        lie.append(quantity("mesh force" + name.removeprefix("mesh"), "N", units, digits=4))
    bars = []
    for k, m in enumerate(first.misalignment):
        lie.append(quantity(m.name, m.unit, units, digits=3))
        at_points = [point.misalignment[k] for point in points]
        widest = max((m.bar for m in at_points if m.bar is not None), default=None)
        if share := percent_of(widest, max(abs(m.value) for m in at_points)):
            bars.append(f"{m.name} {share}")
    note = f"By {first.model}; error bars {', '.join(bars)} at most." if bars else ""
    lie += [
        Column(f"KHb{load.mesh.removeprefix('mesh')}", write="{:.2f}".format)
        for load in first.face_loads
    ]
    ends = [f"{shaft.name}.{b.name}" for shaft in first.shafts for b in shaft.bearings]
    carried = [text("at"), *(quantity(end, "N", units, digits=4) for end in ends)]
    lie_rows = [
        [
            p.point.label,
            *p.mesh_forces.values(),
            *(_misaligned(p, k) for k in range(len(p.misalignment))),
            *(load.factor for load in p.face_loads),
        ]
        for p in points
    ]
    carried_rows = [[p.point.label, *(row[1] for row in _carried(p))] for p in points]
    return [
        Table("Misalignment over the operating points", lie, lie_rows, note),
        Table("Radial bearing loads over the operating points", carried, carried_rows),
    ]


def over_cases(cases: Sequence[Deflection], units: Units = ENGINEERING) -> list[Table]:
    """Return motions of lumped points and bearing loads of a shaft over the cases of its loads; none
    for one case.
    """
    if not cases:
        return []
    points = [*cases[0].lumped]
    moved = [
        [case.point.label, name, *_moved([m.value for m in case.displacement[name]], case)]
        for case in cases
        for name in points
    ]
    carried = [
        [case.point.label, b.name, radial, axial, moment]
        for case in cases
        for b, (_, radial, _, axial, moment) in zip(case.shafts[0].bearings, _carried(case))
    ]
    loads = [quantity(head, "N", units, digits=4) for head in ("radial", "axial")]
    return [
        Table("Motions over the cases", [text("in"), word("place"), *_six(MOVED, units)], moved),
        Table(
            "Bearing loads over the cases",
            [text("in"), word("bearing"), *loads, quantity("moment", "N m", units, digits=4)],
            carried,
        ),
    ]


def displacements(deflected: Deflection, units: Units = ENGINEERING) -> Table:
    """Return the motion of every lumped point and bearing, with error bars of the lumped points,
    and of all places of a shaft alone.
    """
    note = "Relative to the unloaded state, in the axes of each shaft's scene, y along it."
    if deflected.still:
        note += f" thy: against {deflected.still}, which stands still."
    rows: list[list[Any]] = []
    for shaft in deflected.shafts:
        for name, six in shaft.ports.items():
            rows.append([f"{shaft.name}.{name}", *_moved(six, deflected)])
            # the only gear of a shaft stands first, and has the name of its shaft
            only = shaft.name if name == next(iter(shaft.ports)) else ""
            keys = (name,) if deflected.load is not None else (f"{shaft.name}.{name}", only)
            rows[-1:] = _with_bars(rows[-1], [_bars(deflected, key, units) for key in keys])
    if deflected.barred:
        note += f" {OF_BARS.format(deflected.bars_by)}"
    columns = [word("place"), *_six(MOVED, units), *_beside(BAR)]
    return Table("Displacements", columns, rows, note)


def housing(deflected: Deflection, units: Units = ENGINEERING) -> list[Table]:
    """Return loads on the mounts of a housing and its motion; none without one."""
    if not deflected.mounts:
        return []
    loads = {name: [m.value for m in six] for name, six in deflected.mounts.items()}
    carried = [
        [name, *map(_without_rounding, six, deflected.largest[1])] for name, six in loads.items()
    ]
    note = "Load of the housing on each mount, in the axes of the first shaft's scene."
    motion = np.array([m.value for m in deflected.displacement["housing"]])
    moved = [["centre of mass", *_moved(motion, deflected)]]
    return [
        Table("Mount loads", [word("mount"), *_six(FORCE_UNITS, units)], carried, note),
        Table("Motion of the housing", [word("place"), *_six(MOVED, units)], moved),
    ]


def motions(deflected: Deflections, units: Units = ENGINEERING) -> list[Table]:
    """Return the motion of the lumped point of a shaft alone by every model, with error bars and
    ranges by bearing data; none of a train.
    """
    if deflected.load is None:
        return []
    port = deflected.load.port
    ranges = [m.open for m in deflected.judge.compared if m.open is not None]
    ends = {end: _moved(six, deflected.judge) for end, six in zip(ENDS, zip(*ranges))}
    rows: list[Sequence[object]] = []
    for solution in deflected.solutions:
        row = [solution.model, *_moved([m.value for m in solution.compared], solution)]
        of_judge = ends.values() if solution is deflected.judge else [[None] * 6] * len(ends)
        beside = [value for six in of_judge for value in six]
        for line in _with_bars(row, [_bars(solution, port, units)]):
            rows.append(type(line)([*line, *beside]))
    note = f"No error bars: {deflected.why_without_bar}."
    barred = [solution for solution in deflected.solutions if solution.barred]
    if barred:
        note = (
            f"{OF_BARS.format(barred[-1].bars_by)} Models differ by what their theory leaves out."
        )
    columns = [word("model"), *_six(MOVED, units), *_beside(BAR)]
    for end, six in ends.items():
        columns += _beside(end)
        rows.append(Aside([end, *six, *[None] * 6 * (1 + len(ends))]))
    if ends:
        note += (
            " Least and largest: by estimated insides and classes of clearance of the bearings. "
        )
        note += deflected.judge.led
    return [Table(f"Motion of {port}", columns, rows, note.strip())]


def _with_bars(row: list[Any], bars: Sequence[Sequence[Cell]]) -> list[list[Any]]:
    """Return a row of six components with its error bars beside them in a frame, and below where they
    are shown.
    """
    six = next(filter(None, bars), [None] * 6)
    return [
        [*row, *six],
        *(Aside([Cell(BAR), *known, *[None] * 6]) for known in bars if known),
    ]


def _beside(kind: str) -> list[Column]:
    """Return columns of six components that frames have beside those shown."""
    return [
        Column(f"{dof} {kind}", unit=si.split()[0], hidden=True)
        for dof, si in zip(DOF_NAMES, MOVED)
    ]


def _bars(deflected: Deflection, place: str, units: Units) -> list[Cell]:
    """Return the error bars of a place, none less than a share of the largest translation or rotation,
    and none that is rounding; empty where it has none.
    """
    if not deflected.barred or place not in deflected.displacement:
        return []
    six = deflected.displacement[place]
    largest = np.abs([m.value for m in six]).reshape(2, 3).max(axis=1)
    least = np.repeat(LEAST / 100 * largest, 3)
    return [
        in_units(float(max(m.bar, size)), m.unit, units, 2)
        if m.bar is not None and _without_rounding(m.bar, moved)
        else Cell(None)
        for m, size, moved in zip(six, least, deflected.largest[0])
    ]


def _six(si_units: Sequence[str], units: Units) -> list[Column]:
    """Return columns of six components."""
    return [quantity(dof, si, units, digits=4) for dof, si in zip(DOF_NAMES, si_units)]


def _without_rounding(value: float, size: float) -> float:
    """Return a number, zero where it is rounding beside a size."""
    return value if abs(value) > ROUNDING * size else 0.0


def _moved(six: Sequence[float] | np.ndarray, solution: Deflection) -> list[float]:
    """Return a motion without components that are rounding."""
    return [*map(_without_rounding, map(float, six), solution.largest[0])]


def _misaligned(solution: Deflection, k: int) -> float:
    """Return a misalignment, zero where it is rounding."""
    measure = solution.misalignment[k]
    return _without_rounding(measure.value, solution.largest_beside(measure))


def _carried(solution: Deflection) -> list[list[Any]]:
    """Return rows of every bearing: name, radial load with its direction in degrees, axial load and
    moment, without rounding.
    """
    force, moment = solution.largest[1][[0, 3]]
    rows = []
    for shaft in solution.shafts:
        for b in shaft.bearings:
            radial = _without_rounding(b.radial, force)
            at = degrees(b.azimuth) if radial else None
            axial = _without_rounding(float(b.load[1]), force)
            tilting = _without_rounding(b.moment, moment)
            rows.append([f"{shaft.name}.{b.name}", radial, at, axial, tilting])
    return rows


def bearings(solution: Deflection, units: Units = ENGINEERING) -> list[Table]:
    """Return loads of every bearing, and the elements that carry them in catalogue bearings."""
    by_name = [(f"{shaft.name}.{b.name}", b) for shaft in solution.shafts for b in shaft.bearings]
    inside = [(name, bearing) for name, bearing in by_name if bearing.rows]
    loads = [
        word("bearing"),
        quantity("radial", "N", units, digits=4),
        Column("at, deg", write=lambda azimuth: f"{azimuth:.0f}"),
        quantity("axial", "N", units, digits=4),
        quantity("moment", "N m", units, digits=4),
    ]
    note = "Load of the shaft on the bearing; it acts at an angle from x towards z."
    rows = _carried(solution)
    if not inside:
        return [Table("Bearing loads", loads, rows, note)]
    loads += [Column("C0/P0"), Column("L10r, 1e6", name="L10r", unit="1")]
    for row, (_, bearing) in zip(rows, by_name):
        row += [_rated(bearing.static_safety, 1.0), _rated(bearing.reference_life, 1e6)]
    note += (
        " C0/P0: static safety (ISO 76); L10r: basic reference life (ISO/TS 16281) in 1e6 "
        "revolutions; solidgear bearing shows their ranges and duty tables."
    )
    elements = [
        word("bearing"),
        word("loaded"),
        quantity("largest", "N", units, digits=4),
        quantity("pressure", "Pa", units, digits=4),
        quantity("clearance", "m moved", units, digits=3),
    ]
    element_note = (
        "Number of loaded elements of all, row by row; largest load of an element; largest "
        "pressure at both rings, by Hertz or in slices; radial clearance once mounted and warm."
    )
    carried = [
        [name, _loaded(b), max(float(row.load.max()) for row in b.rows), b.pressure, b.clearance]
        for name, b in inside
    ]
    return [
        Table("Bearing loads", loads, rows, note),
        Table("Inside the bearings", elements, carried, element_note),
    ]


def _rated(value: float | None, unit: float) -> Cell | None:
    if value is None:
        return None
    return Cell(value, "", f"{value / unit:.3g}" if isfinite(value) else "endless")


def _loaded(bearing: BearingState) -> str | Cell:
    counts = ", ".join(f"{n}/{len(row.load)}" for n, row in zip(bearing.loaded, bearing.rows))
    return counts if any(bearing.loaded) else Cell("none", "bad")


def line(shaft: ShaftDeflection) -> Table:
    """Return the deflection line of a shaft in SI, for other programs."""
    heads = [f"{dof} [{si.split()[0]}]" for dof, si in zip(DOF_NAMES, MOVED)]
    # along the shaft, where y is the motion that way
    return numbers({"place [m]": shaft.stations, **dict(zip(heads, shaft.line.T))}, axes=1)


def turn_chart(turn: StageTurn, units: Units = ENGINEERING, width: float = WIDE) -> Chart:
    """Chart the mesh force of every planet of a stage over a turn of the carrier."""
    names = [f"planet {k}" for k in range(1, turn.force.shape[1] + 1)]
    looks = {name: Series(COLOURS[k % len(COLOURS)]) for k, name in enumerate(names)}
    angle = np.degrees(np.append(turn.angle, 2 * np.pi))
    force = units.values(np.vstack([turn.force, turn.force[:1]]), "N")
    unit, room = units.unit("N"), 0.12 * np.ptp(force) or 0.12 * np.abs(force).max()
    panel = Panel(
        Axis(
            "carrier in degrees", (0.0, 360.0), ticks={a: f"{a:g}" for a in np.arange(0.0, 361, 60)}
        ),
        Axis(f"mesh force in {unit}", (force.min() - room, force.max() + room)),
        230.0,
        series=looks,
        legend=lines_legend(6),
    )
    for name, values in zip(names, force.T):
        panel.draw("line", curve(angle, values, name=name))
        read = curve(angle, values)
        for row in read:
            position, size = ("at", f"{row['x']:.0f}", "°"), ("", f"{row['y']:.4g}", unit)
            row["readout"] = readout(name, position, size)
        panel.read(read, looks[name].colour)
    return Chart([[panel]], width, f"Mesh forces over a turn of the carrier ({turn.stage})")


#: planes by the translation and the rotation that belong to each
PLANES = {"x": (0, 5), "z": (2, 3)}


def deflection_chart(
    shafts: Mapping[str, Sequence[ShaftDeflection]],
    title: str,
    units: Units = ENGINEERING,
    width: float = WIDE,
) -> Chart:
    """Chart the deflection of every shaft in both planes by every model, the last of them the
    reference.
    """
    looks = {name: Series(COLOURS[k % len(COLOURS)]) for k, name in enumerate(shafts)}
    names = [shaft.name for shaft in next(iter(shafts.values()))]
    panels = [
        _panel(shafts, looks, k, plane, units, width, first=k == 0 and plane == "x")
        for k in range(len(names))
        for plane in PLANES
    ]
    columns = 2 if width > NARROW else 1
    return Chart(in_columns(panels, columns), width, title)


def _panel(
    by_model: Mapping[str, Sequence[ShaftDeflection]],
    looks: Mapping[str, Series],
    k: int,
    plane: str,
    units: Units,
    width: float,
    first: bool,
) -> Panel:
    """Return the panel of one shaft in one plane."""
    component = PLANES[plane][0]
    shafts = {name: lines[k] for name, lines in by_model.items()}
    reference = list(shafts.values())[-1]
    along = {name: units.values(s.stations, "m") for name, s in shafts.items()}
    moved = {name: units.values(s.line[:, component], "m moved") for name, s in shafts.items()}
    ends = _ends(np.concatenate(list(moved.values())))
    length, unit = units.unit("m"), units.unit("m moved")
    last = float(along[list(shafts)[-1]][-1])
    panel = Panel(
        Axis(f"y of {reference.name} in {length}", (0.0, last)),
        Axis(f"{plane} in {unit}", ends),
        190.0,
        f"{reference.name}, {plane}",
        series=looks,
        legend=lines_legend(4) if first else None,
    )
    panel.draw({"type": "rule", "color": GREY}, [{"y": 0.0}])
    for bearing in reference.bearings:
        place = float(units.values(np.array([bearing.place]), "m")[0])
        panel.draw({"type": "rule", "color": GREY, "strokeDash": [2, 3]}, [{"x": place}])
        name = {"type": "text", "color": GREY, "align": "left", "dx": 3, "dy": 10}
        panel.draw(name, [{"x": place, "y": panel.y.ends[1], "text": bearing.name}])
    for model in shafts:
        panel.draw("line", curve(along[model], moved[model], name=model))
        read = curve(along[model], moved[model])
        for row in read:
            abscissa, size = ("y", f"{row['x']:.1f}", length), (plane, f"{row['y']:.3g}", unit)
            row["readout"] = readout(model, abscissa, size)
        panel.read(read, looks[model].colour)
    return panel


def _ends(values: np.ndarray) -> tuple[float, float]:
    """Return ends of an axis that holds all values and zero, with room."""
    low, high = min(values.min(), 0.0), max(values.max(), 0.0)
    room = 0.12 * (high - low) or 1.0
    return float(low - room), float(high + room)
