"""One figure a part: errors over processor seconds and over peak memory."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from solidgear.report.chart_style import new_figure, percent_decades, styled, tolerance_line
from validation.real_speed_accuracy import lines
from validation.real_speed_accuracy.ratios import QUANTITIES, Row, errors, references

LOOK = {
    lines.UNIFORM: ("#9a86b8", "v"),
    lines.GRADED: ("#5a3e8c", "D"),
    lines.HALVES: ("#0072b2", "s"),
    lines.SECTOR: ("#c2185b", "h"),
    lines.CORRECTED: ("#a05a00", "^"),
    lines.DIFFERENCE: ("#a05a00", "^"),
    lines.HEAVY: ("#c98a00", "P"),
    lines.PLAIN: ("#00805e", "o"),
    lines.CALCULIX: ("#222222", "X"),
}
TITLES = {"keyed": "Keyed pinion", "toothed": "Toothed pinion", "step": "Shaft from a STEP file"}
WORDS = {"C_zz": "error of C_zz", "bending_1": "error of first bending"}
COSTS = {"cpu_s": "processor seconds, scene to answer, one thread", "peak_MB": "peak memory, MB"}


def draw(rows: Sequence[Row], part: str, path: Path, target: float = 1e-3) -> None:
    """Write the figure of a part.

    Parameters
    ----------
    rows : sequence of Row
    part : str
    path : Path
    target : float
        The error that ratios are taken at.
    """
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    truth = references(rows, part)
    with styled():
        figure = new_figure(9.6, 6.8)
        axes = figure.subplots(2, 2, sharex="col", sharey="row")
        for i, what in enumerate(QUANTITIES):
            for j, (cost, words) in enumerate(COSTS.items()):
                ax = axes[i][j]
                for line in lines.LINES[part]:
                    own = [r for r in rows if r["part"] == part and r["line"] == line]
                    if line == lines.REFERENCE or not own:
                        continue
                    colour, marker = LOOK[line]
                    style = {"color": colour, "marker": marker, "markersize": 5, "linewidth": 1.2}
                    e = errors(rows, part, line, what)
                    ax.loglog([r[cost] for r in own], e, label=line, **style)
                ax.axhspan(1e-9, truth[what].doubt, color="#e8e8e8", zorder=0)
                tolerance_line(ax, target, x=0.99, size=7, linewidth=0.8, linestyle="--")
                ax.set_ylim(3e-5, 6e-2)
                percent_decades(ax)
                ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
                ax.xaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:g}"))
                ax.xaxis.set_minor_formatter(NullFormatter())
                if i:
                    ax.set_xlabel(words)
            axes[i][0].set_ylabel(WORDS[what])
        handles, names = axes[0][0].get_legend_handles_labels()
        figure.legend(handles, names, loc="outside lower center", ncols=3, fontsize=8)
        said = "grey: the reference knows no better"
        figure.suptitle(f"{TITLES[part]}: error against cost ({said})", fontsize=10.5)
        figure.savefig(path, dpi=110)
