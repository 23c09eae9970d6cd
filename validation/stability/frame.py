"""What every script of this folder shares: a finding (where a method fails) and the ways to read and
draw its rows.

A script defines ``measure(quick) -> Finding`` (or a list of them) and ``draw(finding, axes)``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

#: a column of rows: its name, or what it is of a row
Column = str | Callable[[dict], float]


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


def crossing(x, y, level: float) -> float:
    """Where a curve last crosses a level, read off on log-log axes; NaN where it does not.

    Parameters
    ----------
    x, y : (n,) sequences of positive numbers
        Along the curve.
    level : float
    """
    x, y = (
        np.log(np.asarray(x, float)),
        np.log(np.maximum(np.asarray(y, float), 1e-300)) - np.log(level),
    )
    change = np.flatnonzero(np.sign(y[:-1]) != np.sign(y[1:]))
    if not len(change):
        return float("nan")
    i = change[-1]
    return float(np.exp(x[i] - y[i] * (x[i + 1] - x[i]) / (y[i + 1] - y[i])))


def columns(rows: Sequence[dict], *names: Column) -> list[np.ndarray]:
    """Columns of rows as arrays; what is None there is NaN."""
    return [
        np.array([r[name] if isinstance(name, str) else name(r) for r in rows], float)
        for name in names
    ]


def curve(
    axes,
    rows: Sequence[dict],
    x: Column,
    y: Column,
    line: str,
    colour: str | None,
    label: str | None = None,
    *,
    least_x: float = 0.0,
    least: float = 0.0,
    **style,
) -> None:
    """Draw the sizes of a column of rows over another on logarithmic axes, none below the least."""
    at, size = (np.abs(column) for column in columns(rows, x, y))
    at, size = np.maximum(at, least_x), np.maximum(size, least)
    axes.loglog(at, size, line, color=colour, label=label, **style)
