"""Free uniform beams: the roots of Euler's and of Timoshenko's frequency equations."""

from __future__ import annotations

import numpy as np

import solidgear as sg
from validation.manual.case import Answer, Case, Model, references
from validation.manual.exact import STEEL, Tube, beam_frequencies
from validation.manual.models import frequencies, numbered, shaft
from validation.thesis.krylov import from_scene, krylov

SLENDER = Tube(length=1.0, outer=0.005)
ROD, TUBE = Tube(length=0.5, outer=0.03), Tube(length=0.5, outer=0.03, inner=0.015)
#: Blevins, table 8-1: roots of cos x cosh x = 1
ROOTS = (4.73004074, 7.85320462, 10.9956078)


def _euler_hz() -> list[float]:
    unit = STEEL.E * SLENDER.second / (STEEL.density * SLENDER.area * SLENDER.length**4)
    return [root**2 * np.sqrt(unit) / (2 * np.pi) for root in ROOTS]


def _slender(fidelity: str, **options) -> Answer:
    body = sg.build(shaft([SLENDER]), fidelity, **options)
    found = sg.modes(body, n=12)
    return Answer(numbered("bending", frequencies(found, "bending")[:3]), body.size)


def _slender_krylov() -> Answer:
    found = krylov(*from_scene(shaft([SLENDER])), n=5).frequency_hz
    return Answer(numbered("bending", found[found > 0][:3]), 4)


def _stubby(fidelity: str, **options) -> Answer:
    values: dict[str, float] = {}
    size = 0
    for name, span, count in (("rod", ROD, 3), ("tube", TUBE, 2)):
        body = sg.build(shaft([span]), fidelity, **options)
        found = sg.modes(body, n=12)
        values |= numbered(f"{name}, bending", frequencies(found, "bending")[:count])
        size = max(size, body.size)
    return Answer(values, size)


FREE_EULER_BEAM = Case(
    name="free_euler_beam",
    title="Free slender beam: Euler-Bernoulli bending",
    problem="Natural frequencies of bending of a uniform round bar that nothing holds.",
    geometry="Length 1 m, diameter 10 mm, solid: L/D 100.",
    material="E 207 GPa, Poisson's ratio 0.3, density 7850 kg/m^3.",
    supports="None; both ends free, no load.",
    asked="First three frequencies of bending.",
    references=references(
        numbered("bending", _euler_hz()),
        "Hz",
        "literature",
        "Blevins, Formulas for Natural Frequency and Mode Shape, table 8-1, free-free beam: "
        "lambda 4.73004074, 7.85320462, 10.9956078 in "
        "f = lambda^2 / (2 pi L^2) sqrt(E I / rho A)",
        1e-8,
        "digits of the table",
    ),
    models=(
        Model(
            "Euler beam, 80 elements",
            lambda: _slender("euler", elements=80),
            1e-6,
            "cubic elements are high by (lambda h / L)^4 / 1440, 2.5e-7 in the third mode",
        ),
        Model(
            "initial-parameter method with Krylov-Duncan functions",
            _slender_krylov,
            2e-8,
            "exact solution of the same equation; what is left are the digits of the table",
        ),
        Model(
            "Timoshenko beam, 80 elements",
            lambda: _slender("timoshenko", elements=80),
            2.5e-3,
            "shear and rotary inertia lower a frequency by (lambda a / L)^2 (1 + E / kappa G) / 8, "
            "a the radius: at most 1.5e-3 here; end effects and rounding up",
        ),
        Model(
            "harmonic solid, order 4",
            lambda: _slender("harmonic", order=4, layers=0, edge_layers=0, size=0.02),
            2.5e-3,
            "as the Timoshenko beam: the solid has both effects",
        ),
    ),
)

FREE_TIMOSHENKO_BEAM = Case(
    name="free_timoshenko_beam",
    title="Free stubby rod and tube: Timoshenko bending",
    problem="Natural frequencies of bending where shear and rotary inertia count.",
    geometry="Length 500 mm, outer diameter 60 mm: L/D 8.3. The rod is solid, the tube has a bore "
    "of 30 mm.",
    material="E 207 GPa, Poisson's ratio 0.3, density 7850 kg/m^3.",
    supports="None; both ends free, no load.",
    asked="First three frequencies of bending of the rod, first two of the tube.",
    references=references(
        numbered("rod, bending", beam_frequencies([ROD], (), 3))
        | numbered("tube, bending", beam_frequencies([TUBE], (), 2)),
        "Hz",
        "closed_form",
        "Timoshenko (1921), Phil. Mag. 41, 744, with the shear coefficient of Hutchinson (2001), "
        "J. Appl. Mech. 68, 87, equation 49: zeros of the determinant that free ends make of the "
        "exact transfer matrix",
        1e-10,
        "rounding of the determinant",
    ),
    models=(
        Model(
            "Timoshenko beam, 40 elements",
            lambda: _stubby("timoshenko", elements=40),
            2e-5,
            "fourth order in the length of an element: 40 owe 1e-5 in the third mode",
        ),
        Model(
            "harmonic solid, order 4",
            lambda: _stubby("harmonic", order=4),
            1e-3,
            "what Hutchinson's beam leaves out is of fourth order in k a, 0.6 in the third mode",
            0.5,
        ),
        Model(
            "3D solid, HEX20",
            lambda: _stubby("solid", element="hex20", around=8, size=0.04, layers=0, edge_layers=0),
            2e-3,
            "as the harmonic solid, and 1e-3 of a coarse mesh",
            1.0,
        ),
    ),
)

CASES = (FREE_EULER_BEAM, FREE_TIMOSHENKO_BEAM)
