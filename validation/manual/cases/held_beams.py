"""Beams that something holds: hinges, springs, a clamp."""

from __future__ import annotations

import numpy as np

import solidgear as sg
from solidgear.core.reduction.effective_mass import synthesise
from validation.manual.case import Answer, Case, Model, Reference, references
from validation.manual.exact import (
    STEEL,
    Spring,
    Tube,
    beam_frequencies,
    hinged_beam,
    rigid_on_springs,
)
from validation.manual.models import bearing, frequencies, numbered, shaft
from validation.thesis.krylov import from_scene, krylov

MATERIAL = "E 207 GPa, Poisson's ratio 0.3, density 7850 kg/m^3."

# --------------------------------------------------------------------------- hinges
HINGED = Tube(length=1.0, outer=0.05)
#: the shaft ends this far (m) beyond each hinge, since a bearing needs a seat
BEYOND = 5e-4
HINGE = 1e14
NUMBERS = (1, 2, 3)


def _hinged(fidelity: str, theory: str, **options) -> Answer:
    width = 2 * BEYOND
    left = bearing("left", BEYOND, width, (HINGE, HINGE, HINGE, 0, 0, 0))
    right = bearing("right", BEYOND + HINGED.length, width, (HINGE, 0, HINGE, 0, 0, 0))
    scene = shaft([Tube(HINGED.length + width, HINGED.outer)], bearings=[left, right])
    body = sg.build(scene, fidelity, **options)
    found = sg.modes(body, scene, n=10)
    return Answer(numbered(f"{theory}, bending", frequencies(found, "bending")[:3]), body.size)


def _of(theory: str, tolerance: float) -> dict[str, float]:
    return {f"{theory}, bending {n}": tolerance for n in NUMBERS}


HINGED_BEAM = Case(
    name="hinged_beam",
    title="Beam between two hinges",
    problem="Natural frequencies of bending of a uniform round shaft whose ends cannot move "
    "sideways but are free to tilt.",
    geometry="""
Length between hinges 1 m, diameter 100 mm, solid: L/D 10.

    o=================================o
    ^             1 m                 ^
""",
    material=MATERIAL,
    supports="Lateral springs of 1e14 N/m at both ends, one axial; no load.",
    asked="First three frequencies of bending, by the theory of Euler and by that of Timoshenko.",
    references=references(
        numbered("Euler, bending", [hinged_beam(HINGED, n, shear=False) for n in NUMBERS]),
        "Hz",
        "closed_form",
        "Euler-Bernoulli: f = n^2 pi / (2 L^2) sqrt(E I / rho A); Blevins, table 8-1, "
        "pinned-pinned beam",
        0.0,
        "closed form",
    )
    + references(
        numbered("Timoshenko, bending", [hinged_beam(HINGED, n) for n in NUMBERS]),
        "Hz",
        "closed_form",
        "Timoshenko (1921), Phil. Mag. 41, 744: the quadratic in the square of the frequency that "
        "sines satisfy, with the shear coefficient of Hutchinson (2001), equation 49",
        0.0,
        "closed form",
    ),
    models=(
        Model(
            "Euler beam, 40 elements",
            lambda: _hinged("euler", "Euler", elements=40),
            _of("Euler", 5e-6),
            "cubic elements are high by (n pi h / L)^4 / 1440, 2e-6 in the third mode",
        ),
        Model(
            "Timoshenko beam, 40 elements",
            lambda: _hinged("timoshenko", "Timoshenko", elements=40),
            _of("Timoshenko", 1e-4),
            "the half millimetre of shaft beyond each hinge turns with it: its rotary inertia "
            "lowers the third mode by 4e-5",
        ),
        Model(
            "harmonic solid, order 4, section ties",
            lambda: _hinged("harmonic", "Timoshenko", order=4, layers=0, edge_layers=0, size=0.05),
            _of("Timoshenko", 1e-3),
            "the beam leaves out terms of fourth order in k a, 0.47 in the third mode, and the "
            "solid bends its end faces",
        ),
    ),
)

# --------------------------------------------------------------------------- springs
#: a stepped shaft cut where its bearings sit
CUT = (
    Tube(0.05, 0.030),
    Tube(0.05, 0.030),
    Tube(0.25, 0.040),
    Tube(0.05, 0.025),
    Tube(0.10, 0.025),
)
WHOLE = (Tube(0.10, 0.030), Tube(0.25, 0.040), Tube(0.15, 0.025))
SPRINGS = (Spring(after=1, lateral=3e8, tilt=1e5), Spring(after=4, lateral=1e8, tilt=5e4))


def _stepped_scene() -> sg.Scene:
    one, two = SPRINGS
    left = (one.lateral, one.lateral, one.lateral, one.tilt, 0, one.tilt)
    right = (two.lateral, 0, two.lateral, two.tilt, 0, two.tilt)
    return shaft(WHOLE, bearings=[bearing("1", 0.05, 0.02, left), bearing("2", 0.40, 0.02, right)])


def _stepped(fidelity: str, theory: str, **options) -> Answer:
    scene = _stepped_scene()
    body = sg.build(scene, fidelity, **options)
    found = sg.modes(body, scene, n=10)
    return Answer(numbered(f"{theory}, bending", frequencies(found, "bending")[:3]), body.size)


def _stepped_krylov() -> Answer:
    found = krylov(*from_scene(_stepped_scene()), n=3).frequency_hz
    return Answer(numbered("Euler, bending", found), 4)


SPRUNG_SHAFT = Case(
    name="stepped_shaft_on_springs",
    title="Stepped shaft on two bearings that tilt",
    problem="Natural frequencies of bending of a shaft of three diameters on elastic bearings.",
    geometry="""
Three solid spans end to end: 100 mm of diameter 60, 250 mm of 80, 150 mm of 50. Bearings at
50 mm and 400 mm from the left end.

         ____________________
    ____|                    |_________
    __^_|____________________|__^______
       100        250           150
""",
    material=MATERIAL,
    supports="Bearing 1: 3e8 N/m and 1e5 N m/rad; bearing 2: 1e8 N/m and 5e4 N m/rad, in both "
    "planes, on the mean motion of the cross-section; no load.",
    asked="First three frequencies of bending, by the theory of Euler and by that of Timoshenko.",
    references=references(
        numbered(
            "Euler, bending", beam_frequencies(CUT, SPRINGS, 3, STEEL, shear=False, rotary=False)
        ),
        "Hz",
        "closed_form",
        "Exact transfer matrices of the Euler-Bernoulli beam over the spans, jumps of force and "
        "moment at the springs, determinant of the free ends",
        1e-10,
        "rounding of the determinant",
    )
    + references(
        numbered("Timoshenko, bending", beam_frequencies(CUT, SPRINGS, 3)),
        "Hz",
        "closed_form",
        "The same with the equations of Timoshenko (1921), Phil. Mag. 41, 744, and the shear "
        "coefficient of Hutchinson (2001), equation 49",
        1e-10,
        "rounding of the determinant",
    ),
    models=(
        Model(
            "Euler beam, 40 elements",
            lambda: _stepped("euler", "Euler", elements=40),
            _of("Euler", 1e-6),
            "fourth order in the length of an element, 3e-7 in the third mode",
        ),
        Model(
            "initial-parameter method with Krylov-Duncan functions",
            _stepped_krylov,
            _of("Euler", 2e-8),
            "another exact solution of the same equations: the nine digits printed",
        ),
        Model(
            "Timoshenko beam, 40 elements",
            lambda: _stepped("timoshenko", "Timoshenko", elements=40),
            _of("Timoshenko", 1e-6),
            "fourth order in the length of an element, 3e-8 in the third mode",
        ),
        Model(
            "harmonic solid, order 3, section ties",
            lambda: _stepped("harmonic", "Timoshenko", order=3, layers=3),
            _of("Timoshenko", 1e-3),
            "model form: material beside a shoulder carries no load, which a beam does not know; "
            "the known deviation is that, the tolerance around it holds the mesh",
            1.0,
            known={
                "Timoshenko, bending 1": -0.0035,
                "Timoshenko, bending 2": -0.0129,
                "Timoshenko, bending 3": -0.0256,
            },
        ),
    ),
)

# --------------------------------------------------------------------------- a rigid body
BLOCK = Tube(length=0.12, outer=0.05)
PLACES, LATERAL, AXIAL = (0.03, 0.10), (2e4, 5e4), 3e4


def _rigid(fidelity: str, **options) -> Answer:
    seats = [
        bearing("1", PLACES[0], 0.02, (LATERAL[0], AXIAL, LATERAL[0], 0, 0, 0)),
        bearing("2", PLACES[1], 0.02, (LATERAL[1], 0, LATERAL[1], 0, 0, 0)),
    ]
    scene = shaft([BLOCK], bearings=seats)
    body = sg.build(scene, fidelity, **options)
    found = sg.modes(body, scene, n=4)
    values = numbered("bending", frequencies(found, "bending")[:2])
    values["axial"] = frequencies(found, "axial")[0]
    values["free rotations"] = float(np.count_nonzero(found.frequency_hz == 0))
    return Answer(values, body.size)


MASS = STEEL.density * BLOCK.area * BLOCK.length
SOFT = "the cylinder gives by 1e-7 to 4e-7 of what its springs do"

RIGID_ROTOR = Case(
    name="rigid_rotor",
    title="Rigid cylinder on two soft springs",
    problem="The six motions of a body that does not deform: mass, centre and inertia of every "
    "model, and the place where a bearing acts.",
    geometry="Solid cylinder, length 120 mm, diameter 100 mm; springs 30 mm and 100 mm from the "
    "left end.",
    material=MATERIAL,
    supports="Lateral springs of 2e4 and 5e4 N/m in both planes, an axial one of 3e4 N/m at the "
    "first; nothing resists rotation about the axis.",
    asked="Two frequencies of bounce and tilt, the axial one, and how many motions are free.",
    references=references(
        numbered("bending", rigid_on_springs(BLOCK, PLACES, LATERAL)),
        "Hz",
        "closed_form",
        "Newton's (k - w^2 m)(t - w^2 J) = c^2 with k, c, t the sums of k_i, k_i s_i, k_i s_i^2 "
        "about the centre of mass and J = m (3 a^2 + L^2) / 12",
        4e-7,
        SOFT,
    )
    + (
        Reference(
            "axial",
            float(np.sqrt(AXIAL / MASS) / (2 * np.pi)),
            "Hz",
            "closed_form",
            "f = sqrt(k / m) / 2 pi",
            2e-7,
            SOFT,
        ),
        Reference(
            "free rotations",
            1.0,
            "1",
            "closed_form",
            "rotation about the axis, 0 Hz exactly",
            0.0,
            "a count",
        ),
    ),
    models=(
        Model(
            "Euler beam with rotary inertia",
            lambda: _rigid("euler", rotary_inertia=True),
            1e-6,
            SOFT,
        ),
        Model("Timoshenko beam", lambda: _rigid("timoshenko"), 1e-6, SOFT),
        Model("harmonic solid, order 3", lambda: _rigid("harmonic", order=3), 1e-6, SOFT),
        Model(
            "3D solid, HEX20",
            lambda: _rigid("solid", element="hex20", around=8, size=0.05, layers=0, edge_layers=0),
            1e-6,
            SOFT + "; cells keep the area of the circle",
        ),
        Model(
            "3D solid, TET10",
            lambda: _rigid("solid", element="tet10", size=0.04, graded_size=0.04),
            5e-5,
            "quadratic edges around cut off some 3e-5 of the mass",
        ),
    ),
)

# --------------------------------------------------------------------------- lumped models
#: a disc beyond two bearings; cut at the bearings and in the middle of the disc
DISC_CUT = (
    Tube(0.02, 0.10),
    Tube(0.02, 0.10),
    Tube(0.08, 0.03),
    Tube(0.20, 0.03),
    Tube(0.03, 0.03),
)
DISC_WHOLE = (Tube(0.04, 0.10), Tube(0.31, 0.03))
DISC_SPRINGS = (Spring(after=3, lateral=1e9), Spring(after=4, lateral=5e8))


def _disc_scene() -> sg.Scene:
    one, two = (s.lateral for s in DISC_SPRINGS)
    seats = [
        bearing("1", 0.12, 0.02, (one, one, one, 0, 0, 0)),
        bearing("2", 0.32, 0.02, (two, 0, two, 0, 0, 0)),
    ]
    port = sg.Port(name="disc", y=0.02, lo=0.0, hi=0.04, attachment="section")
    return shaft(DISC_WHOLE, bearings=seats, port=port)


def _disc(fidelity: str, **options) -> Answer:
    scene = _disc_scene()
    body = sg.build(scene, fidelity, **options)
    found = sg.modes(body, scene, n=6)
    return Answer({"bending 1": frequencies(found, "bending")[0]}, body.size)


def _disc_lumped(method: str) -> Answer:
    scene = _disc_scene()
    body = sg.build(scene, "timoshenko", elements=40)
    _, lumped = synthesise(body, scene, scene.port.name)
    frequency = lumped[method].frequency_hz
    return Answer({} if frequency is None else {"bending 1": frequency}, 2)


OVERHUNG_DISC = Case(
    name="overhung_disc",
    title="Overhung disc: the beam and what it is lumped to",
    problem="First bending of a heavy disc on a light shaft beyond two bearings, by the beam and by "
    "two numbers at the middle of the disc.",
    geometry="""
Disc 40 mm thick, diameter 200 mm; shaft 310 mm long, diameter 60 mm. Bearings 80 mm and 280 mm
behind the disc.

     ___
    |   |
    |   |_________________________
    |   |_________________________|
    |   |       ^              ^
    |___|
""",
    material=MATERIAL,
    supports="Bearing 1: 1e9 N/m, bearing 2: 5e8 N/m, in both planes, free to tilt; no load.",
    asked="First frequency of bending.",
    references=references(
        {"bending 1": beam_frequencies(DISC_CUT, DISC_SPRINGS, 1)[0]},
        "Hz",
        "closed_form",
        "Exact transfer matrices of the beam of Timoshenko (1921) with the shear coefficient of "
        "Hutchinson (2001), equation 49",
        1e-10,
        "rounding of the determinant",
    ),
    models=(
        Model(
            "Timoshenko beam, 40 elements",
            lambda: _disc("timoshenko", elements=40),
            1e-6,
            "fourth order in the length of an element",
        ),
        Model(
            "lumped, mode-matched on the Timoshenko beam",
            lambda: _disc_lumped("mode-matched"),
            1e-6,
            "made to keep the first frequency of its beam",
        ),
        Model(
            "lumped, Guyan on the Timoshenko beam",
            lambda: _disc_lumped("guyan"),
            2e-5,
            "a mode is not a static shape: high, and by how much is known",
            known={"bending 1": 1.64e-4},
        ),
        Model(
            "lumped, total mass",
            lambda: _disc_lumped("old"),
            1e-3,
            "the inertia of the whole shaft about the disc does not move with the disc: low, and by "
            "how much is known",
            known={"bending 1": -0.4776},
        ),
        Model(
            "harmonic solid, order 3, section ties",
            lambda: _disc("harmonic", order=3, layers=3),
            1e-3,
            "model form: the disc bends at the shoulder, which a beam does not know; the "
            "known deviation is that, the tolerance around it holds the mesh",
            1.0,
            known={"bending 1": -0.0080},
        ),
    ),
)

CASES = (HINGED_BEAM, SPRUNG_SHAFT, RIGID_ROTOR, OVERHUNG_DISC)
