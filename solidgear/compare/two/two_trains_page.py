"""Page of two trains beside each other: their sections and charts."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from itertools import cycle
from pathlib import Path
from typing import Any, NamedTuple

from solidgear.compare.two import two_trains_tables as tables
from solidgear.show import beside
from solidgear.show.panel import INK, PERCENT, Axis, Panel, Series, readout, wrapped
from solidgear.show.plot import NARROW, WIDE, Chart, Make
from solidgear.show.run_tables import pairs_of
from solidgear.show.sheet import Section
from solidgear.show.table import Table
from solidgear.show.units import Units, in_ascii
from solidgear.show.words import hertz
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
    f"Those of {100 * LARGE:g} % of the largest of their kind or more, and the largest of every "
    "bearing. All are in results.json and in the tables response_a.csv and response_b.csv."
)
MOTIONS = "In the axes of each shaft's own file: y along the shaft, x and z across it."


def write_two_trains(found: Any, out: str | os.PathLike, units: Units) -> Path:
    """Write results.json, the responses as tables, the charts and report.html; the path is that of
    the page.
    """
    charts = charts_of(found, units)
    return beside.write_beside(
        found,
        partial(_sections, found, charts, units),
        out,
        units,
        lines={
            f"response_{key}": over_frequency(one.response, _teeth(found, one))
            for key, one in zip("ab", found.both)
        },
        charts={name: charts[name] for name in FILED},
    )


def printed(found: Any, units: Units) -> tuple[Any, ...]:
    """Tables and sentences for a terminal."""
    return (
        beside.inputs(found, beside.SHORT),
        beside.modes(found),
        tables.peaks(found, units),
        *map(in_ascii, found.told(units)),
        *found.results["unpublished_lines"],
    )


def charts_of(found: Any, units: Units) -> dict[str, Make]:
    """Charts by their names: response, shares, and those of reactions and motions, numbered."""
    both = [one.response for one in found.both]
    teeth, its = (_teeth(found, one) for one in found.both)
    shared = teeth if (teeth, teeth.of) == (its, its.of) else None
    charts: dict[str, Make] = {
        "response": partial(response_chart, both, "", shared, None, {}, units),
        "shares": partial(shares_chart, _bars(found)),
    }
    forces, moved = reactions(found), motions(found)
    for name, groups in (
        ("response", [others(found)]),
        ("reactions", [[c for c in forces if c[0].endswith(f" {unit}")] for unit in REACTED]),
        ("motions", [[c for c in moved if _place(c[0]) == side] for side in found.models]),
        ("housing", [train_tables.housing_columns(found)]),
    ):
        for k, own in enumerate(_pages(groups)):
            charts[f"{name}_{k}"] = partial(columns_chart, both, own, shared, units)
    return charts


def _teeth(found: Any, one: Any) -> Any:
    train = one.workshop.train
    return train.per_turn(train.named_mesh(found.mesh))


def _place(column: str) -> str:
    """Shaft or bearing that a column of a component is of."""
    return column.partition(" [")[0].rpartition(" ")[0]


def others(found: Any) -> list[tuple[str, str]]:
    """Columns of forces of meshes that do not drive, and what they are called."""
    return [*found.forces.items()][1:]


def reactions(found: Any) -> list[tuple[str, str]]:
    """Columns of bearing reactions that are large, or the largest of their bearing, and what they are
    called; forces before moments, shaft by shaft.
    """
    out: list[tuple[str, str]] = []
    turn = [*found.models]
    for unit in REACTED:
        sizes: dict[tuple[str, str], float] = {}
        for column in found.columns:
            bearing, _, dof = column.removesuffix(f" {unit}").rpartition(" ")
            if " bearing " in column and column.endswith(unit):
                tops = [one.largest(column) for one in found.both]
                sizes[bearing, dof] = max(top[1] for top in tops if top is not None)
        largest = max(sizes.values(), default=0.0)
        by_bearing = sorted(
            sizes.items(),
            key=lambda one: (turn.index(one[0][0].partition(" bearing ")[0]), one[0][0]),
        )
        for (bearing, dof), size in by_bearing:
            own = max(other for (name, _), other in sizes.items() if name == bearing)
            if size > 0 and (size == own or size >= LARGE * largest):
                out.append((f"{bearing} {dof} {unit}", f"{bearing}, {dof}"))
    return out


def _pages(groups: Sequence[list[tuple[str, str]]]) -> Iterator[list[tuple[str, str]]]:
    """Columns that share a chart: those of a group, and no more than a sheet takes."""
    for own in groups:
        charts = math.ceil(len(own) / MOST_PANELS)
        size = 2 * math.ceil(len(own) / charts / 2) if own else 1  # alike, whole rows of two
        yield from (own[k : k + size] for k in range(0, len(own), size))


def motions(found: Any) -> list[tuple[str, str]]:
    """Columns of the motions of the main lumped points, and what they are called."""
    return [
        (column, f"{_place(column)}, {column.partition(' [')[0].rpartition(' ')[2]}")
        for column in found.columns
        if _place(column) in found.models
    ]


def _bars(found: Any) -> list[tuple[str, Sequence[Bar]]]:
    out: list[tuple[str, Sequence[Bar]]] = []
    for pair in found.modes:
        bars = [
            Bar(letter, one.name, one.frequency_hz, one.shares)
            for letter, one in (("A", pair.a), ("B", pair.b))
            if one is not None
        ]
        out.append((bars[0].name, bars))
    return out


def _sections(found: Any, charts: Mapping[str, Make], units: Units) -> list[Section]:
    results = found.results
    loaded = [one for one in found.both if found.misalignment()]
    points = []
    for one in loaded:
        told = [
            units.text(size, "N", 4) + name.removeprefix("mesh")
            for name, size in one.loaded.mesh_forces.items()
        ]
        at = one.loaded.point.label
        points.append(f"{one.letter} at {at}: {', '.join(told)} along the line of action.")
    facts = [
        train_tables.facts(train, units, f"Train {one.label}")
        for train, one in zip(results["trains"].values(), found.both)
    ]
    machine = pairs_of(results["environment"], "Environment of the run")

    def section(name: str, title: str, words: str, *told: Table) -> Section:
        own = {key: make for key, make in charts.items() if key.partition("_")[0] == name}
        return Section(name, title, words, own, told)

    return [
        section(
            "input",
            "Input",
            "" if found.inputs else beside.SAME,
            beside.inputs(found),
        ),
        section(
            "response",
            "Mesh force",
            EXCITED,
            tables.peaks(found, units),
            *tables.largest(found, others(found), units),
        ),
        section("modes", "Modes", "", beside.modes(found)),
        section(
            "reactions",
            "Bearing reactions",
            REACTIONS,
            *tables.largest(found, reactions(found), units),
        ),
        section(
            "motions",
            "Motions of the lumped points",
            MOTIONS,
            *tables.largest(found, motions(found), units),
        ),
        section(
            "housing",
            "Housing",
            "",
            *tables.largest(found, train_tables.housing_columns(found), units),
        ),
        section("shares", "Strain energy", "", tables.shares(found)),
        section(
            "rest",
            "Under torque",
            " ".join(points),
            *([tables.misalignment(found, units)] if loaded else []),
            *([tables.bearing_loads(found, units)] if loaded else []),
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
    """Stacked bars of the shares of modes, each with its name and what it is in both things, or in
    one; None without any.
    """
    places = list(dict.fromkeys(p for _, bars in modes for bar in bars for p in bar.shares))
    if not modes:
        return None
    left = NAMES if width > NARROW else NARROW_NAMES
    most, low = max(len(bars) for _, bars in modes), -LETTER / (width - left - 2 * LETTER)
    names = {float(k): "\n".join(wrapped(name, left - 10)) for k, (name, _) in enumerate(modes)}
    lines = max(name.count("\n") + 1 for name in names.values())
    panel = Panel(
        Axis("share of the strain energy", (low, 1.0), label=PERCENT),
        Axis("", (len(modes) - 0.5, -0.5), ticks=names, grid=False),
        max(BAR * most + 8, 15 * lines + 2) * len(modes),
        series={place: Series(colour) for place, colour in _colours(places).items()},
        legend={"orient": "top", "columns": int(width / PLACE), "symbolType": "square"},
        left=left,
    )
    thick = 0.84 / most
    pieces: list[dict[str, Any]] = []
    letters: list[dict[str, Any]] = []
    for k, (_, bars) in enumerate(modes):
        at = [k + (i - (len(bars) - 1) / 2) * thick for i in range(len(bars))]
        letters += [{"x": low / 2, "y": y, "text": bar.letter} for y, bar in zip(at, bars)]
        pieces += [piece for y, bar in zip(at, bars) for piece in _pieces(bar, y, 0.45 * thick)]
    panel.draw({"type": "text", "baseline": "middle", "fontSize": 10}, letters)
    panel.draw({"type": "rect", "strokeWidth": 0}, pieces)
    for colour in (INK, "#ffffff"):
        own = [p for p in pieces if (panel.series[p["name"]].colour in LIGHT) == (colour == INK)]
        figures = [
            {"x": (p["x"] + p["x2"]) / 2, "y": (p["y"] + p["y2"]) / 2, "text": f"{100 * size:.0f}"}
            for p in own
            if (size := p["x2"] - p["x"]) >= WORTH_A_FIGURE
        ]
        look = {"type": "text", "baseline": "middle", "fontSize": 9, "color": colour}
        panel.draw(look, figures)
    return Chart([[panel]], width)


def _colours(places: Sequence[str]) -> dict[str, str]:
    """Colour of every place."""
    if len(places) <= len(COLOURS):
        return dict(zip(places, COLOURS))
    left = {kind: cycle(own) for kind, own in OF_KIND.items()}
    meshes = cycle(OF_MESHES)
    return {place: next(left.get(place.rpartition(" ")[2], meshes)) for place in places}


def _pieces(bar: Bar, y: float, half: float) -> Iterator[dict[str, Any]]:
    """Pieces of a bar."""
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
