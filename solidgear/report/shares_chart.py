"""Chart of where the strain energy of modes is: a stacked bar for each mode of each of two things."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from solidgear.report.panel import INK, PERCENT, Axis, Panel, Series, readout, wrapped
from solidgear.report.plot import NARROW, WIDE, Chart
from solidgear.report.words import hertz

#: in the order of shares, the colours in turn; shafts are dark, what they rest on is light
COLOURS = ("#8a6d3b", "#0072b2", "#9cc9e6", "#b3305c", "#9fd3bf", "#00805e", "#5a3e8c")
LIGHT = ("#9cc9e6", "#9fd3bf")
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
    """Stacked bars of the shares of modes; None without any.

    Parameters
    ----------
    modes : sequence of (str, sequence of Bar)
        Name of a mode, and it in both things, or in one.
    width : float
        px.
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
        series={place: Series(COLOURS[k % len(COLOURS)]) for k, place in enumerate(places)},
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
