"""Picture of the mesh of a meridian, every cell in the colour of its share of the error."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from solidgear.show.panel import GREY, Panel, readout
from solidgear.show.plot import BETWEEN, WIDE, Chart
from solidgear.show.scales import HEAT, Axis, Shade, in_percent
from solidgear.show.words import percent

if TYPE_CHECKING:
    from solidgear.core import Record
    from solidgear.core.judge.record import PlaceRecord, WhereRecord

#: shares below this are all of one colour
LEAST = 1e-4
#: colours of shares
SHADES = Shade("share", (LEAST, 1.0), HEAT)
#: a shaft that is more slender than this is drawn with its radius stretched
SLENDEREST = 7.0
#: px; the most that a half section gets, and of paper that the number of a place takes
HIGHEST, DIGIT = 330.0, 20.0
#: px, least and most; a picture from close by of cells at a place whose corners are nearer than
#: this share of the length
CLOSE, LARGEST, SMALL = 170.0, 200.0, 0.02
#: places that are named, and the share from which on they are
MOST_PLACES, WORTH_NAMING = 5, 5e-4


def draw_where(file: Path, places: WhereRecord, title: str = "") -> None:
    """Write the picture as ``.png`` or ``.svg``; SolidgearError for another ending, or a file that
    cannot be written.
    """
    _chart(places, title, WIDE).write(file)


def _chart(record: WhereRecord, title: str, width: float) -> Chart:
    points, cells, shares = map(np.array, (record.points, record.cells, record.shares))
    spots = [
        (place, place.y, place.r)
        for place in worth_naming(record.rows)
        if place.y is not None and place.r is not None
    ]
    places = [place for place, *_ in spots]
    r, y = 1e3 * points
    length, radius = np.ptp(y), r.max()
    stretch = max(1.0, length / (SLENDEREST * radius))
    corners = np.stack([y[cells], r[cells]], axis=-1).transpose(1, 0, 2)
    room = width - 80.0
    scale = min(room / (1.04 * length), HIGHEST / (1.1 * stretch * radius))  # px of a millimetre
    on_paper = [(1e3 * scale * a, 1e3 * scale * stretch * b) for _, a, b in spots]
    heights = [height / scale / stretch for height in _raised(on_paper)]
    top = max([1.05 * radius, *(height + DIGIT / scale / stretch for height in heights)])
    panel = Panel(
        Axis("y, mm", (y.min() - 0.02 * length, y.max() + 0.02 * length), grid=False),
        Axis("r, mm", (0.0, top), grid=False),
        scale * stretch * top,
        right=12 + room - 1.04 * scale * length,
    )
    ticks = {value: in_percent(value) for value in np.geomspace(LEAST, 1.0, 5).tolist()}
    legend = SHADES._replace(title="share of the cell", ticks=ticks, length=min(room, 300.0))
    _draw(panel, corners, shares, legend)
    numbers = [
        {"x": 1e3 * along, "y": 1e3 * across, "y2": height, "text": str(number)}
        for number, ((_, along, across), height) in enumerate(zip(spots, heights), 1)
    ]
    panel.draw("rule", [{key: row[key] for key in ("x", "y", "y2")} for row in numbers])
    labels = [{"x": row["x"], "y": row["y2"], "text": row["text"]} for row in numbers]
    panel.draw({"type": "point", "size": 300, "fill": "#ffffff", "stroke": GREY}, labels)
    panel.draw({"type": "text", "fontWeight": "bold"}, labels)
    names = [
        f"{number}: {place.what}, y = {1e3 * along:.4g} mm, {100 * (place.share or 0.0):.2g} %"
        for number, (place, along, _) in enumerate(spots, 1)
    ]
    drawn_as = "" if stretch == 1.0 else f"radius drawn {stretch:.2g} times as large"
    close = _close(points, places)[: int(width / CLOSE)]
    insets = [_inset(corners, shares, places[n - 1], n, half) for n, half in close]
    inset_width = (width - BETWEEN * (len(insets) - 1)) / max(len(insets), 1)
    for inset in insets:  # as wide as high, beside axes as wide as those above
        inset.height = min(inset_width - panel.beside - inset.right, LARGEST)
        inset.right = inset_width - panel.beside - inset.height
    rows_of = [[panel], insets] if insets else [[panel]]
    return Chart(rows_of, width, "; ".join(filter(None, (title, drawn_as))), "\n".join(names))


def _inset(corners, shares, place: PlaceRecord, number: int, half: float) -> Panel:
    """Return cells near a place, so many metres to either side."""
    centre = 1e3 * np.array([place.y, place.r])
    low, high = centre - 1e3 * half, centre + 1e3 * half
    inside = np.all((corners.min(axis=1) < high) & (corners.max(axis=1) > low), axis=1)
    across, height = (Axis("", ends, grid=False) for ends in zip(low.tolist(), high.tolist()))
    panel = Panel(across, height, CLOSE, f"{number}, {2e3 * half:.2g} mm wide", least=CLOSE)
    _draw(panel, corners[inside], shares[inside], SHADES)
    return panel


def _draw(panel: Panel, corners, shares, shades: Shade) -> None:
    """Draw cells in the colours of their shares, which can be read off."""
    sizes = np.abs(shares).clip(LEAST, None).tolist()
    rows = [
        {"x": x, "y": y, "detail": k, "share": sizes[k]}
        for k, cell in enumerate(corners.tolist())
        for x, y in cell
    ]
    mark = {"type": "line", "interpolate": "linear-closed", "stroke": "#808080"}
    panel.draw(mark | {"strokeWidth": 0.5}, rows, shades)
    places = [
        {"x": x, "y": y, "readout": _words(x, y, share)}
        for (x, y), share in zip(corners.mean(axis=1).tolist(), shares)
    ]
    panel.read(places, "#444444")


def _words(y: float, r: float, share: float) -> str:
    size = percent(abs(share), signed=False)
    places = ("y", f"{y:.4g}", "mm"), ("r", f"{r:.4g}", "mm")
    return readout("cell", ("share of the error", size, ""), *places)


def _close(points: np.ndarray, places: Sequence[PlaceRecord]) -> list[tuple[int, float]]:
    """Return numbers of places with cells too small to be seen, and half the width (m) of an
    inset.
    """
    out = []
    for number, place in enumerate(places, 1):
        away = np.hypot(points[0] - place.r, points[1] - place.y)
        near = away[away > 1e-9 * np.ptp(points[1])].min()
        if place.reach is not None and near < SMALL * np.ptp(points[1]):
            out.append((number, float(np.sqrt(near * max(place.reach, near)))))
    return out


def _raised(spots: Sequence[tuple[float, float]]) -> list[float]:
    """Return heights (px) of the numbers of places, so that none overlap."""
    occupied: list[tuple[float, float]] = []
    for x, y in spots:
        y += DIGIT
        while any(abs(x - a) < DIGIT and abs(y - b) < DIGIT for a, b in occupied):
            y += 1.01 * DIGIT
        occupied.append((x, y))
    return [y for _, y in occupied]


def where_chart(record: Record, width: float = WIDE) -> Chart | None:
    """Chart the places of the reference's error; None without a record."""
    places = record.where
    if places is None or not places.cells:
        return None
    return _chart(places, "", width)


def worth_naming(rows: Sequence[PlaceRecord]) -> list[PlaceRecord]:
    """Return the first few places with a share worth a word, of places from the largest down."""
    return [r for r in rows[:MOST_PLACES] if r.share is not None and abs(r.share) >= WORTH_NAMING]
