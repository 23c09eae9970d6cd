"""Solids where no beam goes: waves of a cylinder, a tube whose section becomes an oval."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla
from skfem import Basis

import solidgear as sg
from validation.manual.case import Answer, Case, Model, references
from validation.manual.exact import STEEL, Tube, hinged_beam, ring_frequency
from validation.manual.exact_waves import bending_wave
from validation.manual.models import bearing, frequencies, numbered, shaft

MATERIAL = "E 207 GPa, Poisson's ratio 0.3, density 7850 kg/m^3."

# --------------------------------------------------------------------------- waves
CYLINDER = Tube(length=0.3, outer=0.03)
NUMBERS = (1, 2, 3)
EXACT = [bending_wave(n * np.pi / CYLINDER.length, CYLINDER.outer) for n in NUMBERS]


def _sliding(order: int) -> Answer:
    """Waves between end faces that slide in their planes and do not move along the axis."""
    scene = shaft([CYLINDER])
    body = sg.build(scene, "harmonic", order=order, layers=1, edge_layers=1)
    block, geometry = body.blocks[0], body.geometry
    mass_matrix = sp.csr_matrix(block.mass)
    basis = Basis(geometry.mesh, geometry.element)

    def on(place) -> np.ndarray:
        return basis.get_dofs(geometry.mesh.facets_satisfying(place)).all()

    nodes = int(geometry.dofs.max()) + 1
    kept, free = np.ones((nodes, 3), bool), np.ones((nodes, 3), bool)
    # of the three components on the axis the body keeps the one that bending moves
    kept[on(lambda x: x[0] < 1e-9), 1:] = False
    free[on(lambda x: abs(x[1]) < 1e-9), 2] = False
    free[on(lambda x: abs(x[1] - CYLINDER.length) < 1e-9), 2] = False
    at = np.flatnonzero(free[kept])
    stiffness, mass = (m[at][:, at].tocsc() for m in (block.stiffness, mass_matrix))
    found = []
    for exact in EXACT:
        # other waves are many, and one motion is rigid: the one nearest to the reference
        wanted = (2 * np.pi * exact) ** 2
        near = spla.eigsh(stiffness, 4, M=mass, sigma=0.98 * wanted, return_eigenvectors=False)
        omega2 = near[np.argmin(np.abs(near - wanted))]
        found.append(np.sqrt(omega2) / (2 * np.pi))
    return Answer(numbered("bending wave", found), len(at))


def _hinged(fidelity: str, **options) -> Answer:
    width = 2e-4
    span = Tube(CYLINDER.length + width, CYLINDER.outer)
    ends = [
        bearing("left", width / 2, width, (1e14, 1e14, 1e14, 0, 0, 0)),
        bearing("right", span.length - width / 2, width, (1e14, 0, 1e14, 0, 0, 0)),
    ]
    scene = shaft([span], bearings=ends)
    body = sg.build(scene, fidelity, **options)
    found = frequencies(sg.modes(body, scene, n=12), "bending")
    return Answer(numbered("bending wave", found[:3]), body.size)


WAVES = Case(
    name="bending_waves",
    title="Bending waves of a cylinder: exact elasticity",
    problem="Standing bending waves of a solid cylinder whose end faces slide in their planes: a "
    "travelling wave of the infinite cylinder fits exactly.",
    geometry="Length 300 mm, diameter 60 mm, solid; wavelengths 600, 300 and 200 mm.",
    material=MATERIAL,
    supports="No axial displacement and no shear on the end faces; no load. For beams this is the "
    "beam between hinges, whose waves are the same.",
    asked="Frequencies of the lowest bending wave for half-waves 1, 2 and 3 along the length.",
    references=references(
        numbered("bending wave", EXACT),
        "Hz",
        "closed_form",
        "Pochhammer (1876) and Chree (1889): zeros of the determinant of the tractions on the "
        "lateral surface; Love, Theory of Elasticity, sec. 199 to 202",
        1e-9,
        "cancellation in the determinant",
    ),
    models=(
        Model(
            "harmonic solid, order 6, end faces constrained",
            lambda: _sliding(6),
            2e-8,
            "polynomials of degree 6 on cells of a radius: the nine digits printed",
            2.0,
        ),
        Model(
            "harmonic solid, order 2, end faces constrained",
            lambda: _sliding(2),
            2.5e-3,
            "quadratic cells of about a radius, a tenth of the shortest wave: 2e-3 in the third",
        ),
        Model(
            "Timoshenko beam, 40 elements, hinged",
            lambda: _hinged("timoshenko", elements=40),
            3e-3,
            "Hutchinson's beam leaves out terms of fourth order in k a, 0.94 in the third wave",
        ),
    ),
    remarks="The exact Timoshenko frequencies are "
    f"{', '.join(f'{hinged_beam(CYLINDER, n):.6g}' for n in NUMBERS)} Hz: what modelling C is off "
    "is the theory, not the elements.",
)

# --------------------------------------------------------------------------- ovals
#: wall over outer radius 0.02; ten diameters long
PIPE = Tube(length=10.0, outer=0.5, inner=0.49)
MIDDLE = (PIPE.outer + PIPE.inner) / 2
WALL = PIPE.outer - PIPE.inner


def _oval(order: int) -> Answer:
    body = sg.build(
        shaft([PIPE]),
        "harmonic",
        order=order,
        layers=0,
        edge_layers=0,
        size=PIPE.outer,
        ovalising=(2, 3),
    )
    found = sg.modes(body, n=20)
    values = {}
    for waves in (2, 3):
        values[f"ovalising n={waves}"] = frequencies(found, f"ovalising n={waves}")[0]
    return Answer(values, body.size)


def _oval_solid(around: int) -> Answer:
    body = sg.build(
        shaft([PIPE]),
        "solid",
        element="hex20",
        around=around,
        layers=0,
        edge_layers=0,
        radial_layers=0,
        size=PIPE.outer,
    )
    found = frequencies(sg.modes(body, n=4), "ovalising n=2")
    return Answer({"ovalising n=2": found[0]}, body.size)


OVALISING = Case(
    name="ovalising_tube",
    title="Long thin tube: ovalising",
    problem="A thin tube changes the shape of its section at a lower frequency than its axis bends; "
    "beams have no such mode.",
    geometry="Length 10 m, outer diameter 1 m, wall 10 mm (0.02 of the outer radius).",
    material=MATERIAL,
    supports="None; both ends free, no load.",
    asked="Lowest frequencies with two and with three waves around.",
    references=references(
        {f"ovalising n={n}": ring_frequency(n, WALL, MIDDLE, STEEL) for n in (2, 3)},
        "Hz",
        "closed_form",
        "Inextensional ring, w^2 = E' I n^2 (n^2 - 1)^2 / (rho A R^4 (n^2 + 1)): Love, Theory of "
        "Elasticity, sec. 293, with E' = E / (1 - nu^2) of a long tube",
        3e-3,
        "no shear, rotary inertia or stretching of the wall, of second order in it; free ends, "
        "where the wall is not held by its neighbours",
    ),
    models=(
        Model(
            "harmonic solid, order 4, with n = 2 and 3",
            lambda: _oval(4),
            3e-3,
            "the uncertainty of the reference; the mesh owes less than 1e-4",
        ),
        Model(
            "3D solid, HEX20, 64 cells around",
            lambda: _oval_solid(64),
            {"ovalising n=2": 1e-2},
            "the uncertainty of the reference, and cells that are stiff in bending around",
            5.0,
        ),
    ),
)

CASES = (WAVES, OVALISING)
