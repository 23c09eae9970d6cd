"""Problem: effective masses of the overhung pinion's first bending mode, with the lumped point
moved along the shaft from the toe to the far end. Reference: the Timoshenko beam they are made
from.

Models: the published pair of equations (energy and determinant), mode-matched, Guyan, total mass.
"""

from __future__ import annotations

import numpy as np

import solidgear as sg
from solidgear.core.reduction.effective_mass import METHODS, synthesise
from validation.common import ROOT
from validation.stability.frame import Finding, columns

STATUS = ("first", "second", "negative", "no real pair", "none")


def status(s) -> str:
    """What a lumped model came to, in a word."""
    if s.feasible:
        return "first" if s.first else "second"
    if s.mass is not None:
        return "negative"
    return "no real pair" if s.numbers.get("discriminant", 0.0) < 0 else "none"


def measure(quick: bool = False) -> Finding:
    """Every synthesis over the position of the lumped point."""
    scene = sg.load(ROOT / "geometry" / "pinion_overhung.toml").with_attachment("section")
    rows = []
    for y in np.linspace(0.0, scene.length, 14 if quick else 80):
        here = scene.with_port(y=float(y))
        body = sg.build(here, "timoshenko")
        point, found = synthesise(body, here, here.port.name)
        row = {
            "y mm": float(1e3 * y),
            "energy share of the static shape": point.static_share,
            "discriminant": found["thesis"].numbers["discriminant"],
        }
        for name in METHODS:
            s = found[name]
            row |= {name: status(s), f"{name} f1 error": s.frequency_error}
        matched = found["mode-matched"]
        chosen = matched if matched.feasible and matched.first else found["guyan"]
        own = point.omega / (2 * np.pi)
        row |= {
            "mass kg": float(matched.mass[0, 0]),
            "inertia kg m2": float(matched.mass[1, 1]),
            "chosen": chosen.method,
            "chosen f1 error": chosen.frequency_error,
            "chosen kinetic error": chosen.kinetic_error,
            "chosen holds to / f1": chosen.valid_to_hz / own,
        }
        rows.append(row)
    count = {word: sum(r["mode-matched"] == word for r in rows) for word in STATUS}
    thesis = {word: sum(r["thesis"] == word for r in rows) for word in STATUS}
    good = [
        r["y mm"]
        for r in rows
        if r["mode-matched"] == "first" and r["energy share of the static shape"] >= 0.95
    ]
    poor = max(rows, key=lambda r: abs(r["chosen f1 error"]))
    return Finding(
        "effective_mass_limits",
        "Effective mass and inertia",
        "An effective mass and inertia need a first mode that is nearly the static "
        "shape of the lumped point.",
        f"Of {len(rows)} positions along the overhung pinion the published equations are met "
        f"at {thesis['first']} ({thesis['no real pair']} have no real root). Mode-matched is "
        f"first at {count['first']}, second at {count['second']}, negative at "
        f"{count['negative']}. Only from {min(good):.0f} to {max(good):.0f} mm does the static "
        "shape hold 95 % of the energy; where the program falls back to Guyan f1 is up to "
        f"{100 * poor['chosen f1 error']:.0f} % off.",
        "`solidgear compare` falls back from mode-matched to Guyan where it is negative "
        "or second, and reports kinetic error and range of validity. `solidgear check` "
        "cautions where the static shape holds less than 95 % of the energy.",
        "tests/test_check_guards.py::test_guard[second mode]",
        rows,
    )


def draw(finding: Finding, axes) -> None:
    """Energy share, discriminant and frequency errors along the shaft."""
    for name, line, colour, words in (
        ("energy share of the static shape", "-", "#0072b2", "energy share of the static shape"),
        ("discriminant", "--", "#888888", "discriminant of the published equations"),
        ("guyan f1 error", "-", "#00805e", "Guyan, error of f1"),
        ("chosen holds to / f1", ":", "#c4541c", "receptance of the chosen one holds to, over f1"),
    ):
        y, along = columns(finding.rows, "y mm", name)
        axes.plot(y, along, line, color=colour, label=words)
    for word, colour in (("first", "#0072b2"), ("second", "#e0a030"), ("negative", "#aa2222")):
        at = [r["y mm"] for r in finding.rows if r["mode-matched"] == word]
        axes.plot(at, [-0.45] * len(at), "s", color=colour, label=f"mode-matched: {word}")
    axes.axhline(0.95, color="#aa2222", lw=0.8, ls=":")
    axes.set(
        xlabel="lumped point from the toe, mm",
        ylabel="share, error, ratio",
        title=finding.method,
        ylim=(-0.6, 1.6),
    )
    axes.legend(fontsize=7, ncols=2)
