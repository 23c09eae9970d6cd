"""Beside and below the panels of a race: the legend, and where its numbers come from."""

from __future__ import annotations

import textwrap
from typing import Any

from solidgear.judge.race.pareto import AUTOMATIC, Race
from solidgear.report.race_rows import left_out
from solidgear.report.race_style import FAMILIES, REFERENCE, Look, family_name, looks
from solidgear.report.words import seconds

#: grey of the Pareto front, and of marks that any family may have
FRONT, MARK = "#9a9a9a", "#555555"
#: letters in a line of the footer
WIDTH = 190


def legend(race: Race) -> list:
    """Handles: a head for each family and its series, then what marks mean."""
    from matplotlib.lines import Line2D

    handles = []
    for family, series in looks(race).items():
        if family not in ("lumped", AUTOMATIC):  # their one series has their name
            handles.append(Line2D([], [], ls="", label=family_name(family).upper()))
        handles += [_series(look) for look in series]
    handles.append(Line2D([], [], ls="", label=""))
    handles += [Line2D([], [], **mark) for mark in _marks()]
    return handles


def _series(look: Look):
    from matplotlib.lines import Line2D

    return Line2D(
        [],
        [],
        color=look.colour,
        mfc=look.fill,
        marker=look.marker,
        ms=5.5,
        label=look.name,
        ls=look.dashes if look.converges else "",
        lw=look.width,
    )


def _marks() -> list[dict[str, Any]]:
    return [
        {
            "ls": ":",
            "marker": "s",
            "mfc": "white",
            "color": FAMILIES["beam"][1],
            "ms": 5.5,
            "label": "like for like:\nsection ties on both sides",
        },
        {
            "color": FRONT,
            "lw": 5,
            "alpha": 0.45,
            "label": "Pareto front,\ncancellations not counted",
        },
        {
            "ls": "",
            "marker": "*",
            "ms": 11,
            "mfc": "white",
            "color": REFERENCE,
            "label": "the reference itself",
        },
        {
            "ls": "",
            "marker": 7,
            "ms": 8,
            "color": MARK,
            "label": "below the band: not resolved",
        },
        {
            "ls": "",
            "marker": "x",
            "ms": 8,
            "mew": 2,
            "color": MARK,
            "label": "failed, or no such number",
        },
    ]


def footer(race: Race) -> str:
    """The reference, how times were taken, the machine, and what was left out."""
    machine = race.environment
    lines = [
        _reference(race),
        _times(race),
        f"{machine.get('cpu')}, {machine.get('cores')} cores, {machine.get('date')}; "
        f"the whole chart took {race.seconds:.0f} s.",
    ]
    if left_out(race):
        words = f"Left out ({race.budget:g} s allowed): {left_out(race)}; reasons in rows.csv."
        lines += textwrap.wrap(words, WIDTH)
    return "\n".join(lines)


def _reference(race: Race) -> str:
    reference = race.reference
    options = ", ".join(f"{name} {value}" for name, value in reference["options"].items())
    order = reference["options"]["order"]
    return (
        f"Reference: harmonic solid, {options}, {reference['unknowns']} unknowns, "
        f"{seconds(reference['seconds'])} s; its band is the grid convergence index "
        f"of orders {order - 2} to {order}."
    )


def _times(race: Race) -> str:
    runs = [len(row.samples) for row in race.rows if row.status == "ok"]
    words = f"Time: new body, six loads, {race.modes} modes; median of {race.runs} interleaved runs"
    if runs and min(runs) < race.runs:
        words += f" (slow cases down to {min(runs)})"
    if race.setup:
        setup = ", ".join(f"{what} {seconds(spent)} s" for what, spent in race.setup.items())
        words += f". Set-up, not in it: {setup}"
    return words + "."
