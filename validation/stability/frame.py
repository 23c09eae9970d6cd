"""What every script of this folder shares: a finding (where a method fails), its table, chart and
three sentences.

A script defines ``measure(quick) -> Finding`` (or a list of them) and ``draw(finding, axes)``, and
ends in ``main(measure, draw)``.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from validation.common import ROOT, results_folder, show, write_rows

FOLDER = Path(__file__).resolve().parent
#: how charts look, whatever the user's own matplotlibrc says
STYLE = {
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 9.5,
    "axes.titlelocation": "left",
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e3e3e3",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "lines.markersize": 4.5,
    "lines.linewidth": 1.2,
}
__all__ = ["FOLDER", "ROOT", "Finding", "crossing", "main", "publish"]


@dataclass(frozen=True)
class Finding:
    """One edge of one method.

    Attributes
    ----------
    name : str
        Folder of the results, in words.
    method : str
    fails, edge, program : str
        The three sentences: what fails; where, with the measured number; what the program does
        about it, in which command.
    guard : str
        Id of the test that holds the guard, ``tests/test_x.py::test_y``; empty where nothing in the
        program needs one.
    rows : list of dict
        What was measured.
    """

    name: str
    method: str
    fails: str
    edge: str
    program: str
    guard: str = ""
    rows: list[dict] = field(default_factory=list)

    @property
    def text(self) -> str:
        """The three sentences, one a line."""
        return "\n".join((self.fails, self.edge, self.program))


def findings(measured) -> list[Finding]:
    """What ``measure`` returned, as a list."""
    return [measured] if isinstance(measured, Finding) else list(measured)


def crossing(x, y, level: float) -> float:
    """Where a curve last crosses a level, read off on log-log axes; NaN where it does not.

    Parameters
    ----------
    x, y : (n,) sequences of positive numbers
        Along the curve.
    level : float
    """
    import numpy as np

    x, y = (
        np.log(np.asarray(x, float)),
        np.log(np.maximum(np.asarray(y, float), 1e-300)) - np.log(level),
    )
    change = np.flatnonzero(np.sign(y[:-1]) != np.sign(y[1:]))
    if not len(change):
        return float("nan")
    i = change[-1]
    return float(np.exp(x[i] - y[i] * (x[i + 1] - x[i]) / (y[i + 1] - y[i])))


def publish(finding: Finding, draw: Callable | None) -> Path:
    """Write rows.csv, chart.png and finding.txt of one finding; returns their folder."""
    folder = results_folder("stability") / finding.name
    folder.mkdir(exist_ok=True)
    write_rows(folder / "rows.csv", finding.rows)
    (folder / "finding.txt").write_text(finding.text + "\n")
    if draw is not None:
        import matplotlib
        from matplotlib.figure import Figure

        with matplotlib.rc_context():
            matplotlib.rcdefaults()
            matplotlib.rcParams.update(STYLE)
            figure = Figure(figsize=(8.0, 4.4), dpi=150, layout="constrained")
            axes = figure.subplots()
            draw(finding, axes)
            figure.savefig(folder / "chart.png")
    return folder


def main(measure: Callable, draw: Callable | None) -> None:
    """Measure, print, publish: what a script does when it is run."""
    parser = argparse.ArgumentParser(
        description=sys.modules["__main__"].__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--quick", action="store_true", help="fewer and coarser points")
    for finding in findings(measure(quick=parser.parse_args().quick)):
        show(finding.method, finding.rows)
        print(finding.text)
        print(f"written to {publish(finding, draw).relative_to(ROOT)}\n")
