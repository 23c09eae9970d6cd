"""Page of two trains beside each other: sections, charts and tables, these for terminals too."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import cycle
from math import degrees
from pathlib import Path
from typing import Any, NamedTuple

from solidgear.show import beside
from solidgear.show.beside import band, its, names
from solidgear.show.panel import INK, PERCENT, Axis, Panel, Series, readout, wrapped
from solidgear.show.plot import NARROW, WIDE, Chart, Make
from solidgear.show.run_tables import pairs_of
from solidgear.show.sheet import Section
from solidgear.show.table import Cell, Column, Table, quantity, text, word
from solidgear.show.units import ENGINEERING, Units, in_ascii
from solidgear.show.words import hertz, percent
from solidgear.strength.deflection.sheet import meanings
from solidgear.trains.page import tables as train_tables
from solidgear.trains.page.chart import columns_chart, response_chart
from solidgear.trains.page.files import over_frequency

#: a reaction is drawn if it has this share of the largest of its unit in either train
LARGE = 0.2
#: panels of a chart: more do not fit a sheet of paper
MOST_PANELS = 8
#: charts that are files as well; those of many panels are read on the page
FILED = ("response", "shares")
REACTED = ("[N]", "[N m]")
EXCITED = "Steady response to the transmission error of each file."
REACTIONS = (
    f"From {100 * LARGE:g} % of the largest of their kind on, and the largest of every bearing. "
    "All are in results.json, response_a.csv and response_b.csv."
)
MOTIONS = "In the axes of each shaft's file: y along the shaft, x and z across it."


def write_two_trains(pair: Any, out: str | os.PathLike, units: Units) -> Path:
    """Write results.json, the responses as tables, the charts and report.html; the path is that of
    the page.
    """
    charts = charts_of(pair, units)
    return beside.write_beside(
        pair,
        partial(_sections, pair, charts, units),
        out,
        units,
        lines={
            f"response_{key}": over_frequency(train.response, _teeth(pair, train))
            for key, train in zip("ab", pair.both)
        },
        charts={name: charts[name] for name in FILED},
    )


def printed(pair: Any, units: Units) -> tuple[Any, ...]:
    """Return tables and sentences for a terminal."""
    return (
        beside.inputs(pair, beside.SHORT),
        beside.modes(pair),
        peaks(pair, units),
        *map(in_ascii, pair.told(units)),
        *pair.results["unpublished_lines"],
    )


def charts_of(pair: Any, units: Units) -> dict[str, Make]:
    """Return charts by their names: response, shares, and those of reactions and motions,
    numbered.
    """
    responses = [train.response for train in pair.both]
    teeth, teeth_b = (_teeth(pair, train) for train in pair.both)
    shared = teeth if (teeth, teeth.of) == (teeth_b, teeth_b.of) else None
    charts: dict[str, Make] = {
        "response": partial(response_chart, responses, "", shared, None, {}, units),
        "shares": partial(shares_chart, _bars(pair)),
    }
    forces, moved = reactions(pair), motions(pair)
    for name, groups in (
        ("response", [others(pair)]),
        ("reactions", [[c for c in forces if c[0].endswith(f" {unit}")] for unit in REACTED]),
        ("motions", [[c for c in moved if _place(c[0]) == side] for side in pair.models]),
        ("housing", [train_tables.housing_columns(pair)]),
    ):
        for k, group in enumerate(_pages(groups)):
            charts[f"{name}_{k}"] = partial(columns_chart, responses, group, shared, units)
    return charts


def _teeth(pair: Any, side: Any) -> Any:
    train = side.assembly.train
    return train.per_turn(train.named_mesh(pair.mesh))


def _place(column: str) -> str:
    """Return the shaft or bearing of a column of a component."""
    return column.partition(" [")[0].rpartition(" ")[0]


def others(pair: Any) -> list[tuple[str, str]]:
    """Return columns of forces of meshes that do not drive, with their titles."""
    return [*pair.forces.items()][1:]


def reactions(pair: Any) -> list[tuple[str, str]]:
    """Return columns of large bearing reactions with their titles, forces before moments."""
    out: list[tuple[str, str]] = []
    turn = [*pair.models]
    for unit in REACTED:
        sizes: dict[tuple[str, str], float] = {}
        for column in pair.columns:
            bearing, _, dof = column.removesuffix(f" {unit}").rpartition(" ")
            if " bearing " in column and column.endswith(unit):
                tops = [train.largest(column) for train in pair.both]
                sizes[bearing, dof] = max(top[1] for top in tops if top is not None)
        largest = max(sizes.values(), default=0.0)
        by_bearing = sorted(
            sizes.items(),
            key=lambda train: (turn.index(train[0][0].partition(" bearing ")[0]), train[0][0]),
        )
        for (bearing, dof), size in by_bearing:
            largest_load = max(load for (name, _), load in sizes.items() if name == bearing)
            if size > 0 and (size == largest_load or size >= LARGE * largest):
                out.append((f"{bearing} {dof} {unit}", f"{bearing}, {dof}"))
    return out


def _pages(groups: Sequence[list[tuple[str, str]]]) -> Iterator[list[tuple[str, str]]]:
    """Split columns into groups that share a chart."""
    for group in groups:
        charts = math.ceil(len(group) / MOST_PANELS)
        size = 2 * math.ceil(len(group) / charts / 2) if group else 1  # alike, whole rows of two
        yield from (group[k : k + size] for k in range(0, len(group), size))


def motions(pair: Any) -> list[tuple[str, str]]:
    """Return columns of the motions of the main lumped points, with their titles."""
    return [
        (column, f"{_place(column)}, {column.partition(' [')[0].rpartition(' ')[2]}")
        for column in pair.columns
        if _place(column) in pair.models
    ]


def _bars(trains: Any) -> list[tuple[str, Sequence[Bar]]]:
    out: list[tuple[str, Sequence[Bar]]] = []
    for pair in trains.modes:
        bars = [
            Bar(letter, mode.name, mode.frequency_hz, mode.shares)
            for letter, mode in (("A", pair.a), ("B", pair.b))
            if mode is not None
        ]
        out.append((bars[0].name, bars))
    return out


def _sections(pair: Any, charts: Mapping[str, Make], units: Units) -> list[Section]:
    results = pair.results
    loaded = [side for side in pair.both if pair.misalignment()]
    points = []
    for side in loaded:
        sentences = [
            units.text(size, "N", 4) + name.removeprefix("mesh")
            for name, size in side.loaded.mesh_forces.items()
        ]
        point = side.loaded.point.label
        points.append(f"{side.letter} at {point}: {', '.join(sentences)} along the line of action.")
    facts = [
        train_tables.facts(train, units, f"Train {side.label}")
        for train, side in zip(results["trains"].values(), pair.both)
    ]
    machine = pairs_of(results["environment"], "Environment of the run")

    def section(name: str, title: str, words: str, *sentences: Table) -> Section:
        drawn = {key: make for key, make in charts.items() if key.partition("_")[0] == name}
        return Section(name, title, words, drawn, sentences)

    return [
        section(
            "input",
            "Input",
            "" if pair.inputs else beside.SAME,
            beside.inputs(pair),
        ),
        section(
            "response",
            "Mesh force",
            EXCITED,
            peaks(pair, units),
            *largest(pair, others(pair), units),
        ),
        section("modes", "Modes", "", beside.modes(pair)),
        section(
            "reactions",
            "Bearing reactions",
            REACTIONS,
            *largest(pair, reactions(pair), units),
        ),
        section(
            "motions",
            "Motions of the lumped points",
            MOTIONS,
            *largest(pair, motions(pair), units),
        ),
        section(
            "housing",
            "Housing",
            "",
            *largest(pair, train_tables.housing_columns(pair), units),
        ),
        section("shares", "Strain energy", "", shares(pair)),
        section(
            "rest",
            "Under torque",
            " ".join(points),
            *([misalignment(pair, units)] if loaded else []),
            *([bearing_loads(pair, units)] if loaded else []),
        ),
        section("trains", "Both trains", " ".join(results["unpublished_lines"]), *facts, machine),
    ]


#: in the order of shares, the colours in turn; shafts are dark, what they rest on is light
COLOURS = ("#8a6d3b", "#0072b2", "#9cc9e6", "#b3305c", "#9fd3bf", "#00805e", "#5a3e8c")
#: of more places than that by the last word of their names, in turn, and of meshes
OF_KIND = {
    "spring": ("#8a6d3b", "#5a3e8c", "#1f9bb8"),
    "shaft": ("#0072b2", "#00805e", "#c46200", "#444444"),
    "bearings": ("#9cc9e6", "#9fd3bf", "#f2c79b", "#c4c4c4"),
    "mounts": ("#d9c94f",),
}
OF_MESHES = ("#b3305c", "#e07aa0", "#7a1f3d")
LIGHT = OF_KIND["bearings"]
#: px of a bar; of the names of modes on a wide and on a narrow page; of the letter beside a bar, and
#: of a place in the legend
BAR, NAMES, NARROW_NAMES, LETTER, PLACE = 13.0, 215.0, 120.0, 14.0, 142.0
#: shares below this are too narrow for their figure
WORTH_A_FIGURE = 0.08


class Bar(NamedTuple):
    """A mode of one thing: its letter, its frequency, and its shares by place."""

    letter: str
    name: str
    hz: float
    shares: Mapping[str, float]


def shares_chart(modes: Sequence[tuple[str, Sequence[Bar]]], width: float = WIDE) -> Chart | None:
    """Chart the shares of modes as stacked bars, each with its name in both trains; None without
    any.
    """
    places = list(dict.fromkeys(p for _, bars in modes for bar in bars for p in bar.shares))
    if not modes:
        return None
    margin = NAMES if width > NARROW else NARROW_NAMES
    most, low = max(len(bars) for _, bars in modes), -LETTER / (width - margin - 2 * LETTER)
    names = {float(k): "\n".join(wrapped(name, margin - 10)) for k, (name, _) in enumerate(modes)}
    lines = max(name.count("\n") + 1 for name in names.values())
    panel = Panel(
        Axis("share of the strain energy", (low, 1.0), label=PERCENT),
        Axis("", (len(modes) - 0.5, -0.5), ticks=names, grid=False),
        max(BAR * most + 8, 15 * lines + 2) * len(modes),
        series={place: Series(colour) for place, colour in _colours(places).items()},
        legend={"orient": "top", "columns": int(width / PLACE), "symbolType": "square"},
        left=margin,
    )
    thick = 0.84 / most
    pieces: list[dict[str, Any]] = []
    letters: list[dict[str, Any]] = []
    for k, (_, bars) in enumerate(modes):
        heights = [k + (i - (len(bars) - 1) / 2) * thick for i in range(len(bars))]
        letters += [{"x": low / 2, "y": y, "text": bar.letter} for y, bar in zip(heights, bars)]
        pieces += [
            piece for y, bar in zip(heights, bars) for piece in _pieces(bar, y, 0.45 * thick)
        ]
    panel.draw({"type": "text", "baseline": "middle", "fontSize": 10}, letters)
    panel.draw({"type": "rect", "strokeWidth": 0}, pieces)
    for colour in (INK, "#ffffff"):
        labelled = [
            p for p in pieces if (panel.series[p["name"]].colour in LIGHT) == (colour == INK)
        ]
        figures = [
            {"x": (p["x"] + p["x2"]) / 2, "y": (p["y"] + p["y2"]) / 2, "text": f"{100 * size:.0f}"}
            for p in labelled
            if (size := p["x2"] - p["x"]) >= WORTH_A_FIGURE
        ]
        look = {"type": "text", "baseline": "middle", "fontSize": 9, "color": colour}
        panel.draw(look, figures)
    return Chart([[panel]], width)


def _colours(places: Sequence[str]) -> dict[str, str]:
    """Return the colour of every place."""
    if len(places) <= len(COLOURS):
        return dict(zip(places, COLOURS))
    cycles = {kind: cycle(palette) for kind, palette in OF_KIND.items()}
    meshes = cycle(OF_MESHES)
    return {place: next(cycles.get(place.rpartition(" ")[2], meshes)) for place in places}


def _pieces(bar: Bar, y: float, half: float) -> Iterator[dict[str, Any]]:
    """Yield pieces of a bar."""
    x = 0.0
    for place, share in bar.shares.items():
        words = readout(
            f"{bar.letter}: {bar.name}",
            ("frequency", hertz(bar.hz), "Hz"),
            (place, f"{100 * share:.1f}", "%"),
        )
        ends = {"x": x, "x2": x + share, "y": y - half, "y2": y + half}
        yield {**ends, "name": place, "readout": words}
        x += share


#: of a share that is shown: less is no place of a mode
LEAST_SHARE = 0.0005


def peaks(pair: Any, units: Units = ENGINEERING) -> Table:
    """Return peaks of the mesh force side by side."""
    columns = [
        text("its mode", lambda p: names(p, "mode")),
        Column("A, Hz", lambda p: its(p.a, "frequency_hz"), hertz),
        Column("B, Hz", lambda p: its(p.b, "frequency_hz"), hertz),
        Column("difference", _shift),
        quantity("A", "N", units, lambda p: its(p.a, "force"), 4),
        quantity("B", "N", units, lambda p: its(p.b, "force"), 4),
        Column("B over A", lambda p: _decibels(p.decibels)),
    ]
    note = "Peaks of the same mode share a row. A dash: no peak in the other train."
    return Table("Peaks of the mesh force", columns, pair.peaks, note, style="ruled")


def _shift(pair: Any) -> str | None:
    if pair.a is None or pair.b is None:
        return None
    return percent(pair.b.frequency_hz / pair.a.frequency_hz - 1)


def _decibels(value: float | None) -> str | None:
    return None if value is None else f"{value:+.1f} dB"


#: what columns of a unit are
KINDS = {
    "N": "forces",
    "N m": "moments",
    "m": "motions",
    "rad": "rotations",
    "m/s²": "accelerations",
}


def largest(
    pair: Any, columns: Sequence[tuple[str, str]], units: Units = ENGINEERING
) -> list[Table]:
    """Return largest amplitudes of columns of the responses, a table for every unit."""
    out = []
    for si, title in KINDS.items():
        dimension = f"{si} moved" if si in ("m", "rad") else si
        rows = [
            (name, *(train.largest(column) for train in pair.both), pair.decibels(column))
            for column, name in columns
            if column.endswith(f" [{si}]")
        ]
        heads: list[Column] = [text("", lambda row: row[0])]
        for k, letter in ((1, "A"), (2, "B")):
            heads.append(quantity(letter, dimension, units, partial(_top, k, 1), 4))
            heads.append(Column(f"{letter}, at Hz", partial(_top, k, 0), hertz))
        heads.append(Column("B over A", lambda row: _decibels(row[3])))
        out.append(Table(f"Largest {title} over frequency", heads, rows))
    return [table for table in out if table]


def _top(k: int, i: int, row: Any) -> float | None:
    return None if row[k] is None else row[k][i]


def shares(trains: Any) -> Table:
    """Return strain energy of every mode by part, A and B in turn."""
    rows = [
        (pair, mode, letter)
        for pair in trains.modes
        for letter, mode in (("A", pair.a), ("B", pair.b))
        if mode is not None
    ]
    places = list(dict.fromkeys(place for _, mode, _ in rows for place in mode.shares))
    columns = [
        text("mode", lambda row: f"{row[2]}: {row[1].name}"),
        Column("Hz", lambda row: row[1].frequency_hz, hertz),
        *(Column(f"{place}, %", partial(_share, place)) for place in places),
    ]
    return Table("Strain energy", columns, rows)


def _share(place: str, row: Any) -> str | None:
    share = row[1].shares.get(place, 0.0)
    return f"{100 * share:.1f}" if share >= LEAST_SHARE else None


def misalignment(pair: Any, units: Units = ENGINEERING) -> Table:
    """Return the misalignment of both trains at rest under load."""
    opens = [{m.name: m.open for m in train.loaded.misalignment} for train in pair.both]
    columns = [
        word("of the axes", lambda row: f"{row[0]}, {units.unit(row[1])}"),
        *(Column(letter, partial(_value, key, units)) for letter, key in (("A", "a"), ("B", "b"))),
        Column("difference", lambda row: _apart(row, units)),
    ]
    rows = pair.misalignment()
    shown_names = {row[0] for row in rows}
    measures = [m for m in pair.a.loaded.misalignment if m.name in shown_names] if rows else []
    note = f"{meanings(measures, units)}."
    if any(change.band is not None for *_, change in rows):
        columns.append(Column("both error bars", lambda row: band(row[3])))
        columns.append(word("", lambda row: row[3].verdict))
        note += " Both error bars: sum of both mesh errors, relative to A."
    for letter, ranges in zip("AB", opens):
        if any(ranges[row[0]] is not None for row in rows):
            columns.append(Column(f"range, {letter}", partial(_range, ranges, units)))
    if any(ranges[row[0]] is not None for row in rows for ranges in opens):
        note += (
            " Range: by estimated insides and classes of clearance of bearings, which both trains "
            "may share."
        )
    return Table("Misalignment", columns, rows, note)


def _value(key: str, units: Units, row: Any) -> str:
    return units.number(getattr(row[3], key), row[1], 3)


def _apart(row: Any, units: Units) -> str | Cell:
    difference = units.number(row[3].difference, row[1], 3)
    return Cell(difference, "unresolved") if row[3].verdict == "not resolved" else difference


def _range(ranges: Any, units: Units, row: Any) -> str | None:
    if ranges[row[0]] is None:
        return None
    low, high = (units.number(v, row[1], 3) for v in ranges[row[0]])
    return f"{low} to {high}"


def bearing_loads(pair: Any, units: Units = ENGINEERING) -> Table:
    """Return loads of all bearings of both trains at rest under load."""
    loads = [
        {f"{s.name}.{b.name}": b for s in train.loaded.shafts for b in s.bearings}
        for train in pair.both
    ]
    columns = [word("bearing", lambda name: name)]
    for title, si, component in (
        ("radial", "N", lambda b: b.radial),
        ("axial", "N", lambda b: float(b.load[1])),
        ("moment", "N m", lambda b: b.moment),
    ):
        for letter, side_loads in zip("AB", loads):
            columns.append(
                quantity(f"{title} {letter}", si, units, partial(_load, side_loads, component), 4)
            )
    for letter, side_loads in zip("AB", loads):
        columns.append(Column(f"radial {letter} at, deg", partial(_azimuth, side_loads)))
    note = (
        "Load of the shaft on the bearing; radial loads act at an angle from x towards z. They have "
        "no error bar."
    )
    return Table("Bearing loads", columns, list(dict.fromkeys([*loads[0], *loads[1]])), note)


def _load(loads: dict[str, Any], component: Callable[[Any], float], name: str) -> float | None:
    return component(loads[name]) if name in loads else None


def _azimuth(loads: dict[str, Any], name: str) -> str | None:
    return f"{degrees(loads[name].azimuth):.0f}" if name in loads else None
