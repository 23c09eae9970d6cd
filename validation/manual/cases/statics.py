"""Compliance at the tip of a shaft that is held at one end."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import solidgear as sg
from validation.manual.case import Answer, Case, Model, Reference, references
from validation.manual.exact import STEEL, Tube
from validation.manual.models import FIRM, bearing, compliances

MATERIAL = "E 207 GPa, Poisson's ratio 0.3."
#: where the shaft is held (m from its left end): the bearing needs a seat around it
HELD = 0.04
PLACES = {"C_zz": (2, 2), "C_z,thx": (2, 3), "C_thx": (3, 3), "C_yy": (1, 1), "C_thy": (4, 4)}
UNITS = {"C_zz": "m/N", "C_z,thx": "1/N", "C_thx": "rad/(N m)", "C_yy": "m/N", "C_thy": "rad/(N m)"}
ROUNDING = "elements are exact in statics: the refinement of the static solution stops at 1e-12"
CLAMP = "All six motions of the cross-section held by springs of 1e24; unit loads at the free end."


def _held(segments: Sequence[sg.Segment]) -> sg.Scene:
    length = segments[-1].y1
    tip = sg.Port(name="tip", y=length, lo=length - 0.002, hi=length, attachment="section")
    clamp = bearing("clamp", HELD, 2 * HELD, [FIRM] * 6)
    material = sg.Material(E=STEEL.E, nu=STEEL.nu, density=STEEL.density)
    return sg.Scene.from_parts(segments, material, bearings=[clamp], port=tip)


def _tip(segments: Sequence[sg.Segment], fidelity: str, names: dict[str, str], **options) -> Answer:
    """Compliances by the quantities of the case: ``names`` says which entry each is."""
    scene = _held(segments)
    body = sg.build(scene, fidelity, **options)
    found = compliances(body, scene)
    return Answer({name: found[PLACES[entry]] for name, entry in names.items()}, body.size)


def _theory(entries: Sequence[str], theory: str) -> dict[str, str]:
    """Names of the quantities; only the lateral compliance differs between the theories."""
    return {f"{e}, {theory}" if e == "C_zz" else e: e for e in entries}


# --------------------------------------------------------------------------- uniform
SPAN = Tube(length=0.5 - HELD, outer=0.03)


def _uniform(fidelity: str, theory: str, **options) -> Answer:
    segments = [sg.Segment.cylinder("rod", length=0.5, diameter=2 * SPAN.outer)]
    return _tip(segments, fidelity, _theory([*PLACES], theory), **options)


def _uniform_compliance() -> dict[str, float]:
    bend = SPAN.length / (STEEL.E * SPAN.second)
    euler = bend * SPAN.length**2 / 3
    shear = SPAN.length / (SPAN.shear_coefficient(STEEL.nu) * STEEL.G * SPAN.area)
    return {
        "C_zz, Euler": euler,
        "C_zz, Timoshenko": euler + shear,
        "C_z,thx": bend * SPAN.length / 2,
        "C_thx": bend,
        "C_yy": SPAN.length / (STEEL.E * SPAN.area),
        "C_thy": SPAN.length / (2 * STEEL.G * SPAN.second),
    }


def _closed(values: dict[str, float], source: str) -> tuple[Reference, ...]:
    parts: list[Reference] = []
    for name, value in values.items():
        unit = UNITS[name.split(", ")[0]]
        parts += references({name: value}, unit, "closed_form", source, 0.0, "closed form")
    return tuple(parts)


def _judged(theory: str, tolerance: float) -> dict[str, float]:
    return dict.fromkeys(_theory([*PLACES], theory), tolerance)


CANTILEVER = Case(
    name="cantilever",
    title="Uniform cantilever: compliance of the tip",
    problem="What unit forces and moments at the free end of a round bar do to it.",
    geometry="Free length 460 mm, diameter 60 mm, solid: L/D 7.7. A stub of 40 mm behind the clamp "
    "is free of stress.",
    material=MATERIAL,
    supports=CLAMP,
    asked="Lateral, tilt, axial and torsional compliance, and how a force tilts the tip.",
    references=_closed(
        _uniform_compliance(),
        "L^3 / 3 E I (and L / kappa G A with shear), L^2 / 2 E I, L / E I, L / E A, L / G J: "
        "Timoshenko, Strength of Materials, part I; kappa of Hutchinson (2001), equation 49",
    ),
    models=(
        Model(
            "Euler beam, 10 elements",
            lambda: _uniform("euler", "Euler", elements=10),
            _judged("Euler", 2e-8),
            ROUNDING,
        ),
        Model(
            "Timoshenko beam, 10 elements",
            lambda: _uniform("timoshenko", "Timoshenko", elements=10),
            _judged("Timoshenko", 2e-8),
            ROUNDING,
        ),
        Model(
            "harmonic solid, order 4, section ties",
            lambda: _uniform("harmonic", "Timoshenko", order=4),
            _judged("Timoshenko", 4e-3),
            "model form: at the clamp and at the loaded section the solid warps, over a length of "
            "about a radius",
        ),
    ),
)

# --------------------------------------------------------------------------- cone
BIG, SMALL, LONG = 0.05, 0.02, 0.4


def _cone_segments() -> list[sg.Segment]:
    stub = sg.Segment.cylinder("stub", length=HELD, diameter=2 * BIG)
    cone = sg.Segment.cone(
        "cone", length=LONG, start_diameter=2 * BIG, end_diameter=2 * SMALL, y0=HELD
    )
    return [stub, cone]


def _cone(fidelity: str, theory: str, **options) -> Answer:
    return _tip(_cone_segments(), fidelity, _theory([*PLACES], theory), **options)


def _cone_compliance() -> dict[str, float]:
    """Integrals of powers of a radius that changes linearly, a at the clamp and b at the tip."""
    a, b = BIG, SMALL
    kappa = Tube(LONG, BIG).shear_coefficient(STEEL.nu)
    stretch = LONG / (np.pi * STEEL.E * a * b)
    euler = 4 * LONG**3 / (3 * np.pi * STEEL.E * a**3 * b)
    bend = 4 * LONG * (a**2 + a * b + b**2) / (3 * np.pi * STEEL.E * a**3 * b**3)
    return {
        "C_zz, Euler": euler,
        "C_zz, Timoshenko": euler + stretch * STEEL.E / (kappa * STEEL.G),
        "C_z,thx": 2 * LONG**2 * (a + 2 * b) / (3 * np.pi * STEEL.E * a**3 * b**2),
        "C_thx": bend,
        "C_yy": stretch,
        "C_thy": bend * STEEL.E / (2 * STEEL.G),
    }


CONE = Case(
    name="tapered_cantilever",
    title="Tapered cantilever: compliance of the tip",
    problem="A solid cone held at its large end: the taper is integrated, not cut into steps.",
    geometry="Cone 400 mm long, diameter 100 mm at the clamp, 40 mm at the tip.",
    material=MATERIAL,
    supports=CLAMP,
    asked="Lateral, tilt, axial and torsional compliance, and how a force tilts the tip.",
    references=_closed(
        _cone_compliance(),
        "Unit-load integrals over a radius from a to b: 4 L^3 / (3 pi E a^3 b) (and "
        "L / (kappa pi G a b) with shear), 2 L^2 (a + 2 b) / (3 pi E a^3 b^2), "
        "4 L (a^2 + a b + b^2) / (3 pi E a^3 b^3), L / (pi E a b); kappa of Hutchinson (2001), "
        "equation 49",
    ),
    models=(
        Model(
            "Euler beam, 4 elements",
            lambda: _cone("euler", "Euler", elements=4),
            _judged("Euler", 2e-8),
            "eight Gauss points on a quarter of the cone leave 1e-11",
        ),
        Model(
            "Timoshenko beam, 4 elements",
            lambda: _cone("timoshenko", "Timoshenko", elements=4),
            _judged("Timoshenko", 2e-8),
            "eight Gauss points on a quarter of the cone leave 1e-11",
        ),
    ),
    remarks="A solid cone is no beam: near its tip stress spreads at the angle of the cone, which "
    "is 4 degrees here. Solids are held to shoulders and heads in other cases.",
)

# --------------------------------------------------------------------------- torsion over a step
THICK, THIN = Tube(0.3, 0.04), Tube(0.2, 0.02)


def _twist(fidelity: str, **options) -> Answer:
    segments = [
        sg.Segment.cylinder("thick", length=THICK.length, diameter=2 * THICK.outer),
        sg.Segment.cylinder("thin", length=THIN.length, diameter=2 * THIN.outer, y0=THICK.length),
    ]
    return _tip(segments, fidelity, {"C_thy": "C_thy"}, **options)


def _twist_compliance() -> float:
    thick = (THICK.length - HELD) / (2 * STEEL.G * THICK.second)
    return thick + THIN.length / (2 * STEEL.G * THIN.second)


STEPPED_TWIST = Case(
    name="stepped_shaft_torsion",
    title="Stepped shaft: static torsion",
    problem="Twist of a shaft of two diameters under a unit torque.",
    geometry="260 mm of diameter 80 mm from the clamp, then 200 mm of diameter 40 mm; sharp shoulder.",
    material=MATERIAL,
    supports=CLAMP,
    asked="Torsional compliance of the tip.",
    references=_closed(
        {"C_thy": _twist_compliance()},
        "Sum of L / G J over the spans: Timoshenko, Strength of Materials, part I",
    ),
    models=(
        Model(
            "Timoshenko beam, 4 elements",
            lambda: _twist("timoshenko", elements=4),
            2e-8,
            ROUNDING,
        ),
        Model(
            "harmonic solid, order 3, section ties",
            lambda: _twist("harmonic", order=3, layers=3),
            1e-3,
            "model form: torque spreads into the thick span over a length of about the small "
            "radius; the known deviation is that, the tolerance around it holds the mesh",
            known={"C_thy": 0.0233},
        ),
    ),
)

CASES = (CANTILEVER, CONE, STEPPED_TWIST)
