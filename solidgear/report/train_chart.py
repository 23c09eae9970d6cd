"""Charts of a train's response: mesh force and transmission error, every model in one figure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from solidgear.report.chart_style import STYLE

COLOURS = ("#00805e", "#0072b2", "#c98a00", "#b3305c", "#5a3e8c", "#444444", "#1f9bb8", "#8a6d3b")
#: labels of peaks closer than this share of a decade would lie on one another
APART = 0.028
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
        for axis, (column, words) in zip(axes, PANELS):
            _curves(axis, responses, column, band)
            axis.set_ylabel(words)
        _peaks(axes[0], responses[0])
        for k, response in enumerate(responses[1:], start=1):
            if label(response) in marks:
                colour = COLOURS[k % len(COLOURS)]
                axes[0].axvline(marks[label(response)], color=colour, lw=0.8, ls=":")
        axes[1].set_xlabel("mesh frequency in Hz")
        upper = axes[0].secondary_xaxis(
            "top", functions=(lambda f: 60 * f / teeth, lambda n: n * teeth / 60)
        )
        upper.set_xlabel("pinion speed in rpm")
        figure.suptitle(title, fontsize=10.5, x=0.01, ha="left")
        axes[1].legend(loc="lower left", fontsize=7.5, ncols=2)
        return figure


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
    axis.set_xlim(responses[0].frequency_hz[0], responses[0].frequency_hz[-1])


def _peaks(axis, response) -> None:
    """Names over the peaks; one that would lie on its neighbour is left to the table."""
    last = -np.inf
    low, high = axis.get_ylim()
    axis.set_ylim(low, high * (high / low) ** 0.42)
    for peak in response.peaks:
        place = np.log10(peak.frequency_hz)
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
