"""Charts of a train's response: mesh force and transmission error, every model in one figure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from solidgear.report.chart_style import STYLE

COLOURS = ("#00805e", "#0072b2", "#c98a00", "#b3305c", "#5a3e8c", "#444444", "#1f9bb8", "#8a6d3b")
#: labels of peaks closer than this share of a decade would lie on one another
APART = 0.028
#: room for the names of peaks above the curves, in decades over those of the curves
ROOM = 0.55
#: ticks of a decade
TICKS = (1.0, 2.0, 5.0)
#: how far up the dotted lines of departures reach, of the panel
DEPARTS = 0.5
PANELS = (
    ("mesh force [N]", "mesh force in N"),
    ("dynamic transmission error [m]", "dynamic transmission error in m"),
)


def response_figure(
    responses: Sequence[Any], title: str, teeth: int, band: float, marks: Mapping[str, float]
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

    Returns
    -------
    matplotlib Figure
    """
    import matplotlib
    from matplotlib.figure import Figure

    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(STYLE)
        figure = Figure(figsize=(9.0, 7.4), layout="constrained")
        axes = figure.subplots(2, 1, sharex=True, height_ratios=(1.7, 1))
        last = responses[0].frequency_hz[-1]
        # where models differ is the upper end; below half the first departure they are one line
        first = max(responses[0].frequency_hz[0], min(marks.values(), default=0.0) / 2)
        for axis, (column, words) in zip(axes, PANELS):
            _curves(axis, responses, column, band)
            axis.set_ylabel(words)
            axis.set_xlim(first, last)
            axis.set_ylim(_ends(responses, column, first))
        _peaks(axes[0], responses[0], first)
        for k, response in enumerate(responses[1:], start=1):
            if label(response) in marks:
                colour = COLOURS[k % len(COLOURS)]
                place = marks[label(response)]
                axes[0].axvline(place, ymax=DEPARTS, color=colour, lw=1.2, ls=":")
        axes[1].set_xlabel("mesh frequency in Hz")
        upper = axes[0].secondary_xaxis(
            "top", functions=(lambda f: 60 * f / teeth, lambda n: n * teeth / 60)
        )
        upper.set_xlabel("pinion speed in rpm")
        for axis in (*(a.xaxis for a in axes), upper.xaxis):
            _plain(axis, TICKS)
        for axis in axes:
            _plain(axis.yaxis, (1.0,))
        figure.suptitle(title, fontsize=10.5, x=0.01, ha="left")
        handles, words = axes[0].get_legend_handles_labels()
        figure.legend(handles, words, loc="outside lower center", fontsize=7.5, ncols=3)
        return figure


def _plain(axis, subs) -> None:
    """Ticks of a logarithmic axis as plain numbers, few enough to be read."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axis.set_major_locator(LogLocator(subs=subs, numticks=20))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def label(response: Any) -> str:
    """A model in a legend."""
    return f"pinion {response.pinion}, gear {response.gear}"


def _curves(axis, responses, column, band) -> None:
    for k, response in enumerate(responses):
        size = np.abs(response.columns[column])
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


def _ends(responses, column, first: float) -> tuple[float, float]:
    """Least and largest amplitude from a frequency on, with room."""
    seen = [np.abs(r.columns[column])[r.frequency_hz >= first] for r in responses]
    return 0.6 * min(s.min() for s in seen), 1.8 * max(s.max() for s in seen)


def _peaks(axis, response, first: float) -> None:
    """Names over the peaks; one that would lie on its neighbour is left to the table."""
    last = -np.inf
    low, high = axis.get_ylim()
    axis.set_ylim(low, high * (high / low) ** ROOM)
    for peak in response.peaks:
        place = np.log10(peak.frequency_hz)
        if peak.frequency_hz < first:
            continue
        if place - last < APART:
            continue
        last = place
        axis.annotate(
            f"{peak.mode}  {peak.frequency_hz:.0f} Hz",
            (peak.frequency_hz, peak.force),
            xytext=(0, 6),
            textcoords="offset points",
            rotation=90,
            ha="center",
            va="bottom",
            fontsize=7.5,
            zorder=20,
        )
