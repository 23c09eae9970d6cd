"""Strain energy of modes by part, those of two trains beside each other: chart and table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from itertools import cycle
from typing import Any, NamedTuple

from solidgear.show.panel import INK, Panel, Series, readout, wrapped
from solidgear.show.plot import NARROW, WIDE, Chart
from solidgear.show.scales import Axis, in_percent
from solidgear.show.table import Cell, Column, Table, text
from solidgear.show.words import DASH, hertz

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
#: of a share in the table: less is no place of a mode
LEAST_SHARE = 0.0005


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
        Axis("share of the strain energy", (low, 1.0), label=in_percent),
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
    panel.draw({"type": "text", "fontSize": 10}, letters)
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
        look = {"type": "text", "fontSize": 9, "color": colour}
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


def shares_table(bars: Sequence[Bar]) -> Table:
    """Return strain energy of every mode by part."""
    places = dict.fromkeys(place for bar in bars for place in bar.shares)
    columns = [
        text("mode", lambda bar: f"{bar.letter}: {bar.name}"),
        Column("Hz", lambda bar: bar.hz, hertz),
        *(Column(f"{place}, %", partial(_share, place), name=place, unit="1") for place in places),
    ]
    return Table("Strain energy", columns, bars)


def _share(place: str, bar: Bar) -> Cell:
    share = bar.shares.get(place, 0.0)
    return Cell(share, "", f"{100 * share:.1f}" if share >= LEAST_SHARE else DASH)
