"""Chart and table of order lines: frequency over the speed of the pinion, like a Campbell diagram."""

from __future__ import annotations

import numpy as np

from solidgear.show.panel import INK, Panel, read_places, readout
from solidgear.show.plot import NARROW, WIDE, Chart
from solidgear.show.scales import VIRIDIS, Axis, Shade, log_ticks, number
from solidgear.show.units import ENGINEERING, Units, plain
from solidgear.show.words import hertz
from solidgear.trains.assembly.orders import OrderLine, OrderMap

#: widest line, pt, and how many decades of force below the largest are told apart
WIDEST, DECADES = 5.0, 2.0
#: places at which a line is read, and pieces of which one is drawn
PLACES, PIECES = 60, 120
#: px; right of the chart for the names of modes, on a wide and on a narrow page
NAMES, NARROW_NAMES = 190.0, 135.0
#: of natural frequencies
MODE = "#9aa4ad"
PLAIN, SHAFTS = "#666666", ("#b3305c", "#5a3e8c", "#2b7a5d", "#8a5a00")


def order_chart(
    orders: OrderMap, title: str, teeth: float, units: Units = ENGINEERING, width: float = WIDE
) -> Chart:
    """Chart order lines and natural frequencies; the upper axis needs the teeth per turn of the
    speed's shaft.
    """
    high, narrow = orders.highest_rpm, width <= NARROW
    panel = Panel(
        Axis(f"{orders.teeth.of} speed in rpm", (0.0, high)),
        Axis("frequency in Hz", (0.0, orders.highest_hz)),
        400 if narrow else 520,
        right=NARROW_NAMES if narrow else NAMES,
        upper=Axis(
            "first order of the mesh in Hz",
            (0.0, high),
            ticks={60 * hz / teeth: f"{hz:g}" for hz in _rounds(high * teeth / 60)},
            grid=False,
        ),
    )
    places = [{"y": mode.frequency_hz} for mode in orders.modes]
    panel.draw({"type": "rule", "color": MODE}, places)
    _mode_names(panel, orders, 9 if narrow else 10)
    forces = [line.force.max() for line in orders.lines if line.force is not None]
    largest = max(forces, default=1.0)
    for line in orders.lines:
        _line(panel, line, orders, largest, units)
    _crossings(panel, orders, units)
    return Chart([[panel]], width, title)


def _rounds(high: float) -> np.ndarray:
    """Return some round numbers from zero to an end."""
    decade = 10.0 ** np.floor(np.log10(high))
    step = next(decade * part for part in (0.1, 0.2, 0.5, 1.0, 2.0) if high <= 8 * decade * part)
    return np.arange(0.0, high, step)


def _mode_names(panel: Panel, orders: OrderMap, letter: int) -> None:
    """Draw names right of their lines, separated where frequencies are close."""
    order = sorted(orders.modes, key=lambda mode: mode.frequency_hz)
    shares = np.array([mode.frequency_hz / orders.highest_hz for mode in order])
    heights = orders.highest_hz * spread(shares, letter * 1.25 / panel.height)
    end = orders.highest_rpm
    rows = [
        {"x": end, "x2": 1.02 * end, "y": mode.frequency_hz, "y2": height}
        for mode, height in zip(order, heights.tolist())
    ]
    panel.draw({"type": "rule", "color": MODE, "clip": False}, rows)
    names = [
        {"x": row["x2"], "y": row["y2"], "text": f"{mode.name}  {mode.frequency_hz:.0f} Hz"}
        for mode, row in zip(order, rows)
    ]
    look = {"type": "text", "align": "left", "dx": 3, "fontSize": letter}
    panel.draw(look, names)


def spread(places: np.ndarray, distance: float) -> np.ndarray:
    """Return ascending places (n,) moved as little as possible so that neighbours are `distance`
    apart and below 1.

    Examples
    --------
    >>> spread(np.array([0.1, 0.11, 0.5, 1.0]), 0.05).round(3)
    array([0.08, 0.13, 0.5 , 1.  ])
    """
    groups: list[tuple[float, int]] = []  # middle and number of those that touch
    for place in places:
        groups.append((float(place), 1))
        while len(groups) > 1:
            (low, n), (high, m) = groups[-2:]
            if high - low >= (n + m) / 2 * distance - 1e-12:
                break
            groups[-2:] = [((n * low + m * high) / (n + m), n + m)]
    out = [middle + (k - (n - 1) / 2) * distance for middle, n in groups for k in range(n)]
    below = 1.0 - distance * np.arange(len(out))[::-1]
    return np.minimum(out, below)


def _crossings(panel: Panel, orders: OrderMap, units: Units) -> None:
    """Draw every crossing with its mode; a ring where there is a force."""
    for excited in (True, False):
        rows = [
            {
                "x": c.rpm,
                "y": c.frequency_hz,
                "readout": readout(
                    c.line,
                    ("meets", c.mode, ""),
                    *_facts(orders, c.rpm, c.frequency_hz, c.force, units),
                ),
            }
            for c in orders.crossings
            if (c.force is not None) == excited
        ]
        ring = {"type": "point", "fill": "#ffffff", "stroke": INK, "strokeWidth": 1}
        panel.draw(ring | {"size": 18 if excited else 0}, rows)


def _facts(
    orders: OrderMap, rpm: float, hz: float, force: float | None, units: Units
) -> list[tuple[str, str, str]]:
    """Return the words on a place of an order; no force where there is none."""
    size = "" if force is None else plain(units.value(float(force), "N"), 4)
    return [
        (f"{orders.teeth.of} speed", f"{rpm:.0f}", "rpm"),
        ("frequency", hertz(float(hz)), "Hz"),
        ("mesh force", size, units.unit("N")),
    ]


def _line(panel: Panel, line: OrderLine, orders: OrderMap, largest: float, units: Units) -> None:
    """Draw an order, as wide and dark as its force, and its name."""
    kind, number = line.name.split()[0], int(line.name.split()[-1])
    shafts = [*dict.fromkeys(order_line.name.split()[0] for order_line in orders.lines)]
    shafts = [name for name in shafts if name != "mesh"]
    kind_colour = PLAIN if kind == "mesh" else SHAFTS[shafts.index(kind) % len(SHAFTS)]
    end = min(orders.highest_rpm, 60 * orders.highest_hz / line.per_turn)
    speeds, forces, places = np.linspace(0, end, PLACES), None, [*range(PLACES)]
    if line.rpm is None or line.force is None:
        dash = [6, 4] if kind == "mesh" else [2, 3]
        ends = [{"x": rpm, "y": rpm * line.per_turn / 60} for rpm in (0.0, end)]
        panel.draw(
            {"type": "line", "color": kind_colour, "strokeDash": dash, "strokeWidth": 1}, ends
        )
    else:
        speeds, forces = line.rpm, line.force
        places = read_places(speeds, forces, PLACES)
        _pieces(panel, line.per_turn, speeds, forces, largest, units)
    rows = []
    for k in places:
        rpm = float(speeds[k])
        force = None if forces is None else forces[k]
        facts = _facts(orders, rpm, rpm * line.per_turn / 60, force, units)
        words = readout(line.name, *facts)
        rows.append({"x": rpm, "y": rpm * line.per_turn / 60, "readout": words})
    panel.read(rows, kind_colour)
    # names are staggered: lines of one kind run close together
    steps = -0.06 if kind == "mesh" else 0.13
    share = (0.93 if kind == "mesh" else 0.67) + steps * (number % 3)
    colour = INK if kind == "mesh" else kind_colour
    name = {"type": "text", "align": "right", "color": colour, "dx": -4, "dy": -6}
    place = {"x": share * end, "y": share * end * line.per_turn / 60}
    panel.draw(name, [{**place, "text": line.name}])


def _pieces(
    panel: Panel,
    per_turn: float,
    speeds: np.ndarray,
    forces: np.ndarray,
    largest: float,
    units: Units,
) -> None:
    """Draw an order in pieces, each in the colour and width of the force there."""
    ends = np.unique([*read_places(speeds, forces, PIECES), *np.flatnonzero(forces == largest)])
    rpm, force = speeds[ends], forces[ends]
    middle = np.sqrt(force[:-1] * force[1:])
    share = 1 + np.log10(np.maximum(middle / largest, 10**-DECADES)) / DECADES
    rows = [
        {
            "x": rpm[k],
            "x2": rpm[k + 1],
            "y": rpm[k] * per_turn / 60,
            "y2": rpm[k + 1] * per_turn / 60,
            "force": units.value(float(middle[k]), "N"),
            "strokeWidth": round(0.8 + (WIDEST - 0.8) * float(share[k]), 2),
        }
        for k in range(len(middle))
    ]
    top = units.value(float(largest), "N") or largest
    low = top * 10**-DECADES
    panel.draw(
        {"type": "rule", "strokeCap": "round"},
        rows,
        Shade(
            "force",
            (low, top),
            VIRIDIS[::-1],
            f"mesh force along an order, {units.unit('N')}",
            {value: number(value) for value in log_ticks(low, top)},
        ),
    )
