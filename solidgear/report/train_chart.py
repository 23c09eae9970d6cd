"""Charts of a train over frequency, every model in one figure: mesh force and transmission error, or
a receptance.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from solidgear.report.chart_style import new_figure, styled
from solidgear.report.readout import readable
from solidgear.report.units import ENGINEERING, Units, plain
from solidgear.report.words import hertz

COLOURS = ("#00805e", "#0072b2", "#c98a00", "#b3305c", "#5a3e8c", "#444444", "#1f9bb8", "#8a6d3b")
#: labels of peaks closer than this share of a decade would lie on one another
APART = 0.028
#: room for the names of peaks above the curves, in decades over those of the curves
ROOM = 0.55
#: ticks of a decade
TICKS = (1.0, 2.0, 5.0)
#: how far up the dotted lines of departures reach, of the panel
DEPARTS = 0.5
#: column of a response, its name on a panel, and its SI unit
PANELS = (
    ("mesh force [N]", "mesh force", "N"),
    ("dynamic transmission error [m]", "dynamic transmission error", "m moved"),
)


def response_figure(
    responses: Sequence[Any],
    title: str,
    teeth: int,
    band: float,
    marks: Mapping[str, float],
    units: Units = ENGINEERING,
):
    """Mesh force and dynamic transmission error over frequency, the first response the reference.

    Parameters
    ----------
    responses : sequence of TrainResponse
        Labelled by their rungs; the peaks of the first are named.
    title : str
    teeth : int
        Of the pinion, for the upper axis in rpm.
    band : float
        Drawn around the first where there are others, dB.
    marks : mapping of str to float
        Where a model leaves the band, Hz, by label.
    units : Units, optional

    Returns
    -------
    matplotlib Figure
    """
    with styled():
        figure = new_figure(9.0, 7.4)
        axes = figure.subplots(2, 1, sharex=True, height_ratios=(1.7, 1))
        last = responses[0].frequency_hz[-1]
        # where models differ is the upper end; below half the first departure they are one line
        first = max(responses[0].frequency_hz[0], min(marks.values(), default=0.0) / 2)
        for axis, (column, words, si) in zip(axes, PANELS):
            sizes = [units.values(np.abs(r.columns[column]), si) for r in responses]
            _curves(axis, responses, sizes, band)
            for k, (response, size) in enumerate(zip(responses, sizes)):
                told = _told(response.frequency_hz, size, teeth, words, units.unit(si))
                _read(axis, k, response, response.frequency_hz, size, told)
            axis.set_ylabel(f"{words} in {units.unit(si)}")
            axis.set_xlim(first, last)
            axis.set_ylim(_ends(responses, sizes, first))
        tops = [
            _tops([(p.frequency_hz, p.force, p.mode) for p in r.peaks], "N", units)
            for r in responses
        ]
        _named(axes[0], tops[0], first)
        _read_tops(axes[0], responses, tops, teeth, "mesh force", units.unit("N"))
        for k, response in enumerate(responses[1:], start=1):
            if label(response) in marks:
                colour = COLOURS[k % len(COLOURS)]
                place = marks[label(response)]
                axes[0].axvline(place, ymax=DEPARTS, color=colour, lw=1.2, ls=":")
        for axis in axes:
            _plain(axis.yaxis, (1.0,))
        _finish(figure, axes, f"mesh frequency in Hz{_cut(responses[0], first)}", title, teeth)
        return figure


def _cut(response: Any, first: float) -> str:
    """What an axis leaves out below, in words; nothing where it begins with the response."""
    if first <= response.frequency_hz[0]:
        return ""
    below = sum(peak.frequency_hz < first for peak in response.peaks)
    peaks = {0: "", 1: "; 1 peak lies below"}.get(below, f"; {below} peaks lie below")
    return f", from half of where the first model leaves the band{peaks}"


def receptance_figure(found: Sequence[Any], title: str, teeth: int, units: Units = ENGINEERING):
    """Amplitude and phase of a receptance over frequency, the peaks of the first model named.

    Parameters
    ----------
    found : sequence of TrainReceptance
        Of the same two ends.
    title : str
    teeth : int
        Of the pinion, for the upper axis in rpm.
    units : Units, optional

    Returns
    -------
    matplotlib Figure
    """
    with styled():
        figure, unit = new_figure(9.0, 6.6), units.unit(found[0].unit)
        axes = figure.subplots(2, 1, sharex=True, height_ratios=(2.2, 1))
        for k, one in enumerate(found):
            look = {"color": COLOURS[k % len(COLOURS)], "lw": 1.6 if k == 0 else 1.0}
            look["zorder"] = 9 - k
            hz, size = one.frequency_hz, units.values(np.abs(one.value), one.unit)
            phase = np.degrees(np.angle(one.value))
            axes[0].loglog(hz, size, label=label(one), **look)
            axes[1].semilogx(hz, phase, ".", ms=1.5, **look)
            told = _told(hz, size, teeth, "receptance", unit)
            told["phase"] = ("degrees", [f"{v:.1f}" for v in phase])
            _read(axes[0], k, one, hz, size, told)
            _read(axes[1], k, one, hz, phase, told)
        axes[0].set_ylabel(f"receptance in {unit}")
        axes[1].set_ylabel("phase in degrees")
        axes[1].set_ylim(-185, 185)
        axes[1].set_yticks((-180, -90, 0, 90, 180))
        axes[1].set_xlim(found[0].frequency_hz[0], found[0].frequency_hz[-1])
        _plain(axes[0].yaxis, (1.0,))
        tops = [_tops(one.peaks, one.unit, units) for one in found]
        _named(axes[0], tops[0], found[0].frequency_hz[0])
        _read_tops(axes[0], found, tops, teeth, "receptance", unit)
        _finish(figure, axes, "frequency in Hz", title, teeth)
        return figure


def _finish(figure, axes, words: str, title: str, teeth: int) -> None:
    """What two panels over frequency share: axes in Hz and in rpm, title and legend."""
    axes[1].set_xlabel(words)
    upper = axes[0].secondary_xaxis(
        "top", functions=(lambda f: 60 * f / teeth, lambda n: n * teeth / 60)
    )
    upper.set_xlabel("pinion speed in rpm at which the teeth mesh at it")
    for axis in (*(a.xaxis for a in axes), upper.xaxis):
        _plain(axis, TICKS)
    figure.suptitle(title, fontsize=10.5, x=0.01, ha="left")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", fontsize=7.5, ncols=3)


def _plain(axis, subs) -> None:
    """Ticks of a logarithmic axis as plain numbers, few enough to be read."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axis.set_major_locator(LogLocator(subs=subs, numticks=20))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def label(response: Any) -> str:
    """A model in a legend."""
    return f"pinion {response.pinion}, gear {response.gear}"


def _told(hz, size, teeth: int, what: str, unit: str) -> dict[str, tuple[str, list[str]]]:
    """What is to be read of a curve over frequency."""
    return {
        "frequency": ("Hz", [hertz(float(v)) for v in hz]),
        "pinion speed": ("rpm", [f"{60 * v / teeth:.0f}" for v in hz]),
        what: (unit, [plain(float(v), 4) for v in size]),
    }


def _read(axis, k: int, one: Any, x, y, told: Mapping) -> None:
    readable(axis, x, y, label(one), told, colour=COLOURS[k % len(COLOURS)], marked=False)


def _tops(peaks: Sequence[tuple[float, float, str]], si: str, units: Units) -> list:
    """Peaks (Hz, size, mode), their sizes in the units chosen."""
    return [(hz, units.value(size, si), mode) for hz, size, mode in peaks]


def _read_tops(axis, models, tops: Sequence, teeth: int, what: str, unit: str) -> None:
    """The peaks of every model, to be read with the modes that make them."""
    for k, (one, peaks) in enumerate(zip(models, tops)):
        hz, sizes, modes = [p[0] for p in peaks], [p[1] for p in peaks], [p[2] for p in peaks]
        told = {"peak of": ("", modes), **_told(hz, sizes, teeth, what, unit)}
        readable(axis, hz, sizes, label(one), told, colour=COLOURS[k % len(COLOURS)])


def _curves(axis, responses, sizes, band) -> None:
    for k, (response, size) in enumerate(zip(responses, sizes)):
        colour = COLOURS[k % len(COLOURS)]
        text = label(response)
        width = 1.6 if k == 0 else 1.0
        axis.loglog(response.frequency_hz, size, color=colour, lw=width, label=text, zorder=9 - k)
        if k == 0 and len(responses) > 1:
            factor = 10 ** (band / 20)
            axis.fill_between(
                response.frequency_hz,
                size / factor,
                size * factor,
                color=colour,
                alpha=0.15,
                lw=0,
                label=f"{band:g} dB around it",
            )


def _ends(responses, sizes, first: float) -> tuple[float, float]:
    """Least and largest amplitude from a frequency on, with room."""
    seen = [size[r.frequency_hz >= first] for r, size in zip(responses, sizes)]
    return 0.6 * min(s.min() for s in seen), 1.8 * max(s.max() for s in seen)


def _named(axis, tops: Sequence[tuple[float, float, str]], first: float) -> None:
    """Names over the peaks (Hz, size, mode); one that would lie on its neighbour is left to the
    table.
    """
    last = -np.inf
    low, high = axis.get_ylim()
    axis.set_ylim(low, high * (high / low) ** ROOM)
    for hz, size, mode in tops:
        place = np.log10(hz)
        if hz < first:
            continue
        if place - last < APART:
            continue
        last = place
        axis.annotate(
            f"{mode}  {hz:.0f} Hz",
            (hz, size),
            xytext=(0, 6),
            textcoords="offset points",
            rotation=90,
            ha="center",
            va="bottom",
            fontsize=7.5,
            zorder=20,
        )
