"""Chart and table of order lines: frequency over the speed of the pinion, like a Campbell diagram."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.machine.whole_file import whole
from solidgear.report.chart_style import new_figure, styled
from solidgear.report.readout import readable
from solidgear.report.units import ENGINEERING, Units, plain
from solidgear.report.words import hertz

#: least distance of two names beside the chart, of its height
APART = 0.021
#: widest line, pt, and how many decades of force below the largest are told apart
WIDEST, DECADES = 5.0, 2.0
#: places at which a line without a force is read
PLACES = 101
PLAIN = {"mesh": "#666666", "pinion": "#b3305c", "gear": "#5a3e8c"}
HEAD = ("order", "mode", "frequency [Hz]", "pinion speed [rpm]", "mesh force [N]")


def order_figure(found: Any, title: str, teeth: int, units: Units = ENGINEERING):
    """Order lines and natural frequencies.

    Parameters
    ----------
    found : OrderMap
    title : str
    teeth : int
        Of the pinion, for the upper axis.
    units : Units, optional

    Returns
    -------
    matplotlib Figure
    """
    with styled():
        figure = new_figure(9.6, 7.2)
        axis: Any = figure.subplots()
        axis.set(xlim=(0, found.highest_rpm), ylim=(0, found.highest_hz))
        axis.set(xlabel="pinion speed in rpm", ylabel="frequency in Hz")
        for mode in found.modes:
            axis.axhline(mode.frequency_hz, color="#9aa4ad", lw=0.8, zorder=2)
        _mode_names(axis, found)
        loaded = [line for line in found.lines if line.force is not None]
        largest = max((line.force.max() for line in loaded), default=1.0)
        for line in found.lines:
            _line(axis, line, found, largest, units)
        if loaded:
            _scale(figure, axis, units.value(largest, "N") or largest, units.unit("N"))
        at = [c for c in found.crossings if c.force is not None]
        axis.plot(
            [c.rpm for c in at],
            [c.frequency_hz for c in at],
            "o",
            mfc="white",
            mec="black",
            ms=3.5,
            zorder=5,
        )
        _read_crossings(axis, found, units)
        upper = axis.secondary_xaxis(
            "top", functions=(lambda n: n * teeth / 60, lambda f: 60 * f / teeth)
        )
        upper.set_xlabel("first order of the mesh in Hz")
        figure.suptitle(title, fontsize=10.5, x=0.01, ha="left")
        return figure


def _mode_names(axis, found: Any) -> None:
    """Names right of their lines, moved apart where frequencies are close."""
    places = np.array([mode.frequency_hz / found.highest_hz for mode in found.modes])
    order = np.argsort(places)
    shown = spread(places[order], APART)
    for k, height in zip(order, shown):
        mode = found.modes[k]
        axis.annotate(
            f"{mode.name}  {mode.frequency_hz:.0f} Hz",
            (1.0, places[k]),
            xytext=(1.025, height),
            xycoords="axes fraction",
            textcoords="axes fraction",
            fontsize=7.5,
            va="center",
            arrowprops={"arrowstyle": "-", "color": "#9aa4ad", "lw": 0.6},
            annotation_clip=False,
        )


def spread(places: np.ndarray, apart: float) -> np.ndarray:
    """Ascending places moved as little as may be until neighbours are a distance apart, and kept
    below 1.

    Parameters
    ----------
    places : (n,) ndarray
    apart : float

    Returns
    -------
    (n,) ndarray

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
            if high - low >= (n + m) / 2 * apart - 1e-12:
                break
            groups[-2:] = [((n * low + m * high) / (n + m), n + m)]
    out = [middle + (k - (n - 1) / 2) * apart for middle, n in groups for k in range(n)]
    below = 1.0 - apart * np.arange(len(out))[::-1]
    return np.minimum(out, below)


def _read_crossings(axis, found: Any, units: Units) -> None:
    """Every crossing, to be read with the mode that is met."""
    for name in dict.fromkeys(c.line for c in found.crossings):
        met = [c for c in found.crossings if c.line == name]
        speeds, heights = [c.rpm for c in met], [c.frequency_hz for c in met]
        told = {"meets": ("", [c.mode for c in met])}
        told |= _told(speeds, heights, [c.force for c in met], units)
        readable(axis, speeds, heights, name, told, colour=PLAIN[name.split()[0]])


def _told(rpm, hz, force, units: Units) -> dict[str, tuple[str, list[str]]]:
    """What is to be read along an order; no force where there is none."""
    return {
        "pinion speed": ("rpm", [f"{v:.0f}" for v in rpm]),
        "frequency": ("Hz", [hertz(float(v)) for v in hz]),
        "mesh force": (
            units.unit("N"),
            ["" if v is None else plain(units.value(float(v), "N"), 4) for v in force],
        ),
    }


def _line(axis, line: Any, found: Any, largest: float, units: Units) -> None:
    from matplotlib.collections import LineCollection

    kind = line.name.split()[0]
    rpm = min(found.highest_rpm, 60 * found.highest_hz / line.per_turn)
    hz = rpm * line.per_turn / 60
    if line.force is None:
        style = "--" if kind == "mesh" else ":"
        axis.plot([0, rpm], [0, hz], style, color=PLAIN[kind], lw=1.0, zorder=3)
        speeds, force = np.linspace(0, rpm, PLACES), [None] * PLACES
    else:
        speeds, force = line.rpm, line.force
        points = np.column_stack([line.rpm, line.rpm * line.per_turn / 60])
        share = 1 + np.log10(np.maximum(line.force / largest, 10**-DECADES)) / DECADES
        wide = 0.8 + (WIDEST - 0.8) * share
        pieces = LineCollection(
            list(np.stack([points[:-1], points[1:]], axis=1)),
            cmap="viridis_r",
            norm=_norm(largest),
            linewidths=(wide[:-1] + wide[1:]) / 2,
            capstyle="round",
            zorder=4,
        )
        pieces.set_array(np.sqrt(line.force[:-1] * line.force[1:]))
        axis.add_collection(pieces)
    heights = speeds * line.per_turn / 60
    told = _told(speeds, heights, force, units)
    readable(axis, speeds, heights, line.name, told, colour=PLAIN[kind], marked=False)
    # names are staggered: lines of one kind run close together
    steps = -0.06 if kind == "mesh" else 0.13
    place = (0.93 if kind == "mesh" else 0.67) + steps * (int(line.name.split()[1]) % 3)
    axis.annotate(
        line.name,
        (place * rpm, place * hz),
        xytext=(-3, 5),
        textcoords="offset points",
        fontsize=8,
        ha="right",
        color="black" if kind == "mesh" else PLAIN[kind],
        zorder=6,
    )


def _norm(largest: float):
    from matplotlib.colors import LogNorm

    return LogNorm(largest * 10**-DECADES, largest)


def _scale(figure, axis, largest: float, unit: str) -> None:
    """The bar that tells what a colour is."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.ticker import FuncFormatter, NullFormatter

    bar = figure.colorbar(
        ScalarMappable(_norm(largest), "viridis_r"),
        ax=axis,
        location="bottom",
        shrink=0.5,
        aspect=40,
        pad=0.02,
    )
    bar.set_label(f"mesh force along an order, {unit}", fontsize=8)
    bar.ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    bar.ax.xaxis.set_minor_formatter(NullFormatter())


def write_crossings(path: Path, found: Any) -> None:
    """The crossings of an order map as a table.

    Parameters
    ----------
    path : Path
    found : OrderMap
    """
    with whole(path) as partial, partial.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(HEAD)
        for c in found.crossings:
            force = "" if c.force is None else f"{c.force:.9g}"
            writer.writerow([c.line, c.mode, f"{c.frequency_hz:.9g}", f"{c.rpm:.9g}", force])
