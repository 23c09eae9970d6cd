"""Extension and torsion of free rods."""

from __future__ import annotations

import numpy as np

import solidgear as sg
from validation.manual.case import Answer, Case, Model, references
from validation.manual.exact import STEEL, Tube, stepped_torsion
from validation.manual.models import frequencies, numbered, shaft

MATERIAL = "E 207 GPa, Poisson's ratio 0.3, density 7850 kg/m^3."
ROD = Tube(length=0.5, outer=0.025)
STEPPED = (Tube(0.3, 0.04), Tube(0.2, 0.02))
NUMBERS = (1, 2)


def _bar(number: int) -> float:
    return number * STEEL.bar_speed / (2 * ROD.length)


def _rayleigh(number: int) -> float:
    squeeze = (STEEL.nu * number * np.pi * ROD.outer / ROD.length) ** 2
    return _bar(number) / np.sqrt(1 + squeeze / 2)


def _twist(number: int) -> float:
    return number * STEEL.shear_speed / (2 * ROD.length)


def _rod(fidelity: str, **options) -> Answer:
    body = sg.build(shaft([ROD]), fidelity, **options)
    found = sg.modes(body, n=16)
    axial, torsion = frequencies(found, "axial")[:2], frequencies(found, "torsion")[:2]
    what = "bar" if fidelity in ("euler", "timoshenko") else "solid"
    return Answer(numbered(f"axial, {what}", axial) | numbered("torsion", torsion), body.size)


def _stepped(fidelity: str, **options) -> Answer:
    body = sg.build(shaft(STEPPED), fidelity, **options)
    found = frequencies(sg.modes(body, n=20), "torsion")
    return Answer(numbered("torsion", found[:2]), body.size)


FREE_ROD = Case(
    name="free_rod",
    title="Free rod: extension and torsion",
    problem="Natural frequencies of a round rod along and about its axis. Torsion is exact "
    "elasticity; in extension the rod also narrows, and a solid knows it.",
    geometry="Length 500 mm, diameter 50 mm, solid: L/D 10.",
    material=MATERIAL,
    supports="None; both ends free, no load.",
    asked="First two frequencies of extension (of a bar without and with lateral inertia) and of "
    "torsion.",
    references=references(
        numbered("axial, bar", map(_bar, NUMBERS)),
        "Hz",
        "closed_form",
        "n c / 2 L with c = sqrt(E / rho): Blevins, Formulas for Natural Frequency and Mode Shape, "
        "longitudinal vibration of free-free uniform beams",
        0.0,
        "closed form of the bar",
    )
    + references(
        numbered("axial, solid", map(_rayleigh, NUMBERS)),
        "Hz",
        "closed_form",
        "The bar with the inertia of its narrowing, 1 / sqrt(1 + (nu n pi a / L)^2 / 2): Rayleigh, "
        "Theory of Sound, sec. 157; Love, Theory of Elasticity, chapter XX",
        1e-4,
        "terms of fourth order in the radius over the wavelength, and free end faces",
    )
    + references(
        numbered("torsion", map(_twist, NUMBERS)),
        "Hz",
        "closed_form",
        "n c / 2 L with c = sqrt(G / rho), exact for a circular rod: Love, Theory of Elasticity, "
        "sec. 200",
        0.0,
        "exact elasticity",
    ),
    models=(
        Model(
            "Timoshenko beam, 40 elements",
            lambda: _rod("timoshenko", elements=40),
            {"axial, bar 1": 3e-4, "axial, bar 2": 1.2e-3, "torsion 1": 3e-4, "torsion 2": 1.2e-3},
            "two-node elements of consistent mass are high by (n pi / 40)^2 / 24: 2.6e-4 and 1.03e-3",
        ),
        Model(
            "Timoshenko beam, 160 elements",
            lambda: _rod("timoshenko", elements=160),
            {"axial, bar 1": 2e-5, "axial, bar 2": 8e-5, "torsion 1": 2e-5, "torsion 2": 8e-5},
            "as modelling A, a sixteenth of it",
        ),
        Model(
            "harmonic solid, order 5",
            lambda: _rod("harmonic", order=5, layers=1, edge_layers=1),
            {"axial, solid 1": 1e-4, "axial, solid 2": 1e-4, "torsion 1": 2e-8, "torsion 2": 2e-8},
            "axial: what the reference leaves out; torsion: the nine digits printed",
            0.5,
        ),
        Model(
            "3D solid, HEX20",
            lambda: _rod("solid", element="hex20", around=8, size=0.04, layers=0, edge_layers=0),
            {"axial, solid 1": 1e-4, "axial, solid 2": 1e-4, "torsion 1": 5e-5, "torsion 2": 2e-4},
            "eight cells around and twelve along owe 1e-4 in the second mode of torsion",
        ),
    ),
)

STEPPED_ROD = Case(
    name="stepped_rod_torsion",
    title="Free stepped rod: torsion",
    problem="Natural frequencies of torsion of a rod of two diameters.",
    geometry="300 mm of diameter 80 mm, then 200 mm of diameter 40 mm; solid, sharp shoulder.",
    material=MATERIAL,
    supports="None; both ends free, no load.",
    asked="First two frequencies of torsion.",
    references=references(
        numbered("torsion", stepped_torsion(STEPPED, 2)),
        "Hz",
        "closed_form",
        "J1 tan(w L1 / c) + J2 tan(w L2 / c) = 0 with c = sqrt(G / rho): torsion waves of two "
        "spans, angle and torque equal at the step",
        1e-12,
        "root finding",
    ),
    models=(
        Model(
            "Timoshenko beam, 160 elements",
            lambda: _stepped("timoshenko", elements=160),
            7e-5,
            "two-node elements of consistent mass are high by (k h)^2 / 24, 5e-5 in the second mode",
        ),
        Model(
            "harmonic solid, order 3",
            lambda: _stepped("harmonic", order=3, layers=3),
            5e-4,
            "model form: torque spreads into the thick span over a length of about the small "
            "radius; the known deviation is that, the tolerance around it holds the mesh",
            0.5,
            known={"torsion 1": -0.0212, "torsion 2": -0.0020},
        ),
        Model(
            "3D solid, HEX20",
            lambda: _stepped("solid", element="hex20", around=8, size=0.04),
            1e-3,
            "as the harmonic solid, with a coarser mesh",
            5.0,
            known={"torsion 1": -0.0212, "torsion 2": -0.0020},
        ),
    ),
)

CASES = (FREE_ROD, STEPPED_ROD)
