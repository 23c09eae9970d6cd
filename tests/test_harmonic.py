"""The axisymmetric-harmonic solid against exact elasticity: torsion, Pochhammer-Chree waves,
frustum integrals, Hutchinson's beam.
"""

import numpy as np
import pytest
import scipy.sparse.linalg as spla
from scipy.optimize import brentq
from skfem import Basis

import solidgear as sg
from solidgear.core.body import as_supports
from solidgear.core.scene import STEEL, Port, Scene, Segment
from solidgear.core.solve.coupling import decoupled
from solidgear.core.solve.eigen import lowest
from solidgear.core.solve.supported import Supported
from tests.dense import mass_matrix
from validation.manual.exact import Elastic, Tube, beam_frequencies
from validation.manual.exact_waves import bending_wave
from validation.shipped import shafts_of_revolution

SCENES = shafts_of_revolution()
#: with fillets and chamfers, as a smaller pinion has them
DEAR = ("reducer_wheel", "pinion_straddle")
RADIUS, LENGTH = 0.03, 0.3
E, NU, RHO = STEEL.E, STEEL.nu, STEEL.density
G = E / (2 * (1 + NU))
LONGITUDINAL, SHEAR = np.sqrt(E * (1 - NU) / (1 + NU) / (1 - 2 * NU) / RHO), np.sqrt(G / RHO)


def rod(bore=0.0, length=LENGTH, radius=RADIUS):
    segment = Segment.cylinder("rod", length=length, diameter=2 * radius, bore=bore)
    return Scene.from_parts([segment], port=Port(y=length / 2, lo=0.25 * length, hi=0.75 * length))


# --------------------------------------------------------------------------- torsion
@pytest.mark.parametrize("bore", [pytest.param(0.0, marks=pytest.mark.long), 0.02])
def test_free_free_torsion(bore):
    body = sg.build(rod(bore), "harmonic", order=7, layers=1, edge_layers=1)
    found = [
        m.frequency_hz
        for m in sg.modes(body, n=16).modes
        if m.family == "torsion" and m.frequency_hz > 0
    ]
    exact = SHEAR / (2 * LENGTH) * np.arange(1, 3)
    # sin(pi y / L) by polynomials of degree 7 on cells of a tenth of the length: the discretisation
    # error is far below rounding, which the shift of 1e-3 of the first eigenvalue amplifies to
    # about 1e-13; a hundred times that
    assert found[:2] == pytest.approx(exact, rel=1e-11)


# --------------------------------------------------------------------------- mass
@pytest.mark.parametrize(
    "path",
    [pytest.param(p, marks=pytest.mark.long if p.stem in DEAR else ()) for p in SCENES],
    ids=lambda p: p.stem,
)
def test_mass_matrix_of_shipped_scenes(path):
    scene = sg.load(path)
    # sides on a circle are of the order of the element
    m = sg.build(scene, "harmonic", order=7 if scene.blends else 2).mass_matrix()
    expected = mass_matrix(scene)
    # r^5 on straight-sided cells is a polynomial within the degree of the rule: rounding only
    size = np.sqrt(np.diag(expected))
    assert np.abs((m - expected) / np.outer(size, size)).max() < 1e-13


# --------------------------------------------------------------------------- Pochhammer-Chree
@pytest.mark.long
def test_bending_wave_of_a_cylinder_between_sliding_ends():
    # u_y = 0 and no shear at the end faces: the travelling wave of wave number pi / L fits exactly
    length = 0.12
    body = sg.build(rod(length=length), "harmonic", order=8, layers=1, edge_layers=1)
    block = body.blocks[0]
    assert block.name == "bending_z"
    geometry = body.geometry
    basis = Basis(geometry.mesh, geometry.element)

    def on(place):
        return basis.get_dofs(geometry.mesh.facets_satisfying(place)).all()

    n = int(geometry.dofs.max()) + 1
    keep, free = np.ones((n, 3), bool), np.ones((n, 3), bool)
    keep[on(lambda x: x[0] < 1e-9), 1:] = False  # regularity on the axis, taken out by the library
    assert keep.sum() == block.size
    free[on(lambda x: abs(x[1]) < 1e-9), 2] = False
    free[on(lambda x: abs(x[1] - length) < 1e-9), 2] = False
    at = np.flatnonzero(free[keep])
    k, mass = block.stiffness[at][:, at].tocsc(), block.mass[at][:, at].tocsc()
    wave = np.pi / length
    exact = 2 * np.pi * bending_wave(wave, RADIUS, Elastic(E, NU, RHO))
    # a body that may slide has one rigid motion and many waves: look at those around the exact
    # value
    near = spla.eigsh(k, 4, M=mass, sigma=(0.99 * exact) ** 2, return_eigenvectors=False)
    found = np.sqrt(near[np.argmin(np.abs(near - exact**2))])
    # degree 8 on cells no longer than a radius reaches rounding, about 1e-12 after the shifted
    # solve; a hundred times that
    assert found == pytest.approx(exact, rel=1e-10)


def test_pochhammer_determinant_itself():
    # Long waves are Euler's beam, w = k^2 sqrt(E I / rho A): the first correction is -(k a)^2 (1 +
    # E / kappa G) / 8.
    for ka in (0.04, 0.1):
        k = ka / RADIUS
        euler = k**2 * np.sqrt(E * RADIUS**2 / 4 / RHO)
        root = 2 * np.pi * bending_wave(k, RADIUS, Elastic(E, NU, RHO))
        kappa = 6 * (1 + NU) ** 2 / (7 + 12 * NU + 4 * NU**2)
        correction = -(ka**2) / 8 * (1 + E / (kappa * G))
        # the next term is smaller by (k a)^2; cancellation in the determinant, eps / (k a)^4, adds
        # a part in a thousand
        assert root / euler - 1 == pytest.approx(correction, rel=ka**2 + 2e-3)


# --------------------------------------------------------------------------- kappa of tubes
class Cowper(Tube):
    """A tube with the older coefficient."""

    def shear_coefficient(self, nu):
        m = (self.inner / self.outer) ** 2
        return 6 * (1 + nu) * (1 + m) ** 2 / ((7 + 6 * nu) * (1 + m) ** 2 + (20 + 12 * nu) * m)


@pytest.mark.parametrize("ratio, limit", [(0.0, 5e-5), (0.5, 5e-5), (0.8, 4e-4)])
def test_hutchinson_coefficient_fits_the_exact_solid(ratio, limit):
    # At a length of eight diameters the first mode has k a = 0.3.  What Hutchinson's beam leaves
    # out is of fourth order in k a and grows with the radius of gyration, most for the thin tube,
    # whose ends warp freely.  Cowper's coefficient differs by 4 to 6 %, which moves the frequency
    # by 7e-4 to 2e-3.
    a, length = 0.05, 0.8
    b = ratio * a
    steel = Elastic(E, NU, RHO)
    exact, older = (
        beam_frequencies([kind(length, a, b)], [], 1, steel)[0] for kind in (Tube, Cowper)
    )
    found = (
        sg.modes(sg.build(rod(2 * b, length, a), "harmonic", order=4), n=6)
        .named("bending 1")
        .frequency_hz
    )
    gap = abs(exact / found - 1)
    assert gap < limit
    assert abs(older / found - 1) > 5 * gap
    # ... and the library's own coefficient is this one: the same beam, built, lands where the
    # reference does. 300 elements leave a discretisation error of 1e-5.
    beam = (
        sg.modes(sg.build(rod(2 * b, length, a), "timoshenko", elements=300), n=6)
        .named("bending 1")
        .frequency_hz
    )
    assert beam == pytest.approx(exact, rel=2e-5)


# --------------------------------------------------------------------------- order
def test_order_and_grading_converge_from_above():
    scene = sg.load(SCENES[0].parent / "pinion_overhung.toml")
    stiffness = [
        sg.condense(
            sg.build(scene, "harmonic", order=p, layers=2, edge_layers=2), scene, "pinion"
        ).stiffness[2, 2]
        for p in (1, 2, 4)
    ]
    # Richer spaces on the same mesh: the averaged port makes the body softer, and the sequence
    # contracts (about 20 each).
    assert stiffness[0] > stiffness[1] > stiffness[2] > 4.70996e9 * (1 - 1e-5)
    assert stiffness[2] == pytest.approx(
        4.70996e9, rel=2e-4
    )  # order 4 with two layers is good to 1e-4


@pytest.mark.parametrize(
    ("family", "exponent"),
    # of a right-angled shoulder: of twist 2/3, of all else the root of sin(1.5 pi a) = -a sin(1.5 pi)
    [("torsion", 2 / 3), ("axial", brentq(lambda a: np.sin(1.5 * np.pi * a) - a, 0.5, 0.6))],
)
def test_a_cut_towards_a_shoulder_leaves_the_share_that_its_exponent_says(family, exponent):
    """0.15^(2 a) each, where the order is high enough for nothing else to be left."""
    parts = [
        Segment.cylinder("a", length=0.06, diameter=0.04),
        Segment.cylinder("b", y0=0.06, length=0.06, diameter=0.06),
    ]
    scene = Scene.from_parts(parts, port=Port(y=0.03, lo=0.0, hi=0.06))
    found = []
    for count in (1, 2, 3, 4):
        body = sg.build(
            scene,
            "harmonic",
            order=8,
            layers=0,
            edge_layers=0,
            plain=True,
            families=(family,),
            cuts=((0.06, 0.02, count),),
        )
        found.append(sg.modes(body, n=3, ovalising=False).named(f"{family} 1").frequency_hz)
    steps = -np.diff(found)
    assert (steps > 0).all()  # from above, as an energy method does
    assert steps[1:] / steps[:-1] == pytest.approx(0.15 ** (2 * exponent), rel=0.02)


def test_rigid_seats_hold_a_tube_against_ovalising():
    """As in the 3D solid: seats that cannot deform leave the walls between them to do it."""
    tube = Segment.cylinder("tube", length=0.2, diameter=0.1, bore=0.092)
    springs = {"kxx": "1e8 N/m", "kyy": "1e8 N/m", "kzz": "1e8 N/m"}
    found = {}
    for tie in ("average", "rigid"):
        bearings = [
            sg.Bearing(name=n, y=y, seat_width=0.02, stiffness=springs, attachment=tie)
            for n, y in (("A", 0.02), ("B", 0.18))
        ]
        scene = Scene.from_parts([tube], bearings=bearings, port=Port(y=0.1, lo=0.09, hi=0.11))
        body = sg.build(scene, "harmonic", order=4, layers=0, edge_layers=0)
        found[tie] = sg.modes(body, scene, 24).named("ovalising n=2 1").frequency_hz
    assert found["rigid"] > 3 * found["average"]


def test_families_that_no_bearing_holds_are_solved_beside_held_ends():
    """Springs that stand for a clamp act on no block of two waves; its modes are those of the free
    body.
    """
    scene = sg.load("geometry/rotor_disc.toml")
    # cells so small that an inverse is refined
    body = sg.build(scene, "harmonic", order=2, layers=3, ovalising=(2,))
    own = [k for k, block in enumerate(body.blocks) if block.name == "ovalising_2"]
    found = []
    for supports in (as_supports(scene), as_supports(())):
        spring, _ = decoupled(body, supports, 1e-6)
        found.append(lowest(Supported(body, supports, spring, own), 2, None).elastic[0].value)
    assert found[0] == pytest.approx(found[1], rel=1e-9)
