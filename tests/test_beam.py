"""Beam elements against exact solutions of the beam equations.

References come from transfer matrices (matrix exponential of the first-order system), root finding
and adaptive quadrature; none of it shares code with the elements.
"""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import solidgear as sg
from solidgear.core.errors import SolidgearError
from solidgear.core.models.beam.element import shear_coefficient
from solidgear.core.scene import STEEL, Bearing, Port, Scene, Segment
from validation.manual.exact import Elastic, Tube, beam_frequencies

LENGTH, RADIUS = 0.5, 0.03
HELD = 0.04
E, NU, RHO = STEEL.E, STEEL.nu, STEEL.density
G = E / (2 * (1 + NU))


def rod(bore=0.0, length=LENGTH):
    return Scene.from_parts(
        [Segment.cylinder("rod", length=length, diameter=2 * RADIUS, bore=bore)]
    )


def kappa_solid(nu=NU):
    return 6 * (1 + nu) ** 2 / (7 + 12 * nu + 4 * nu**2)


def free_free(count, bore=0.0):
    """Frequencies (rad/s) of Timoshenko's equations with Hutchinson's coefficient."""
    tube = Tube(LENGTH, RADIUS, bore / 2)
    return 2 * np.pi * np.array(beam_frequencies([tube], [], count, Elastic(E, NU, RHO)))


def bending(modeset, count):
    found = [m.frequency_hz for m in modeset.modes if m.family == "bending" and m.frequency_hz > 0]
    return 2 * np.pi * np.array(found[:count])


@pytest.mark.parametrize("bore", [0.0, 0.03])
def test_free_free_timoshenko(bore):
    body = sg.build(rod(bore), "timoshenko", elements=40)
    found = bending(sg.modes(body, n=12), 3)
    exact = free_free(3, bore)
    # 40 elements owe 1e-5 in the first three modes; the internal fields of the element make that a
    # fourth-order error.
    assert np.abs(found / exact - 1).max() < 1e-5
    assert np.all(found > exact * (1 - 1e-9))  # Rayleigh: consistent elements bound from above


def test_free_free_timoshenko_converges_with_fourth_order():
    exact = free_free(2)[1]
    errors = [
        bending(sg.modes(sg.build(rod(), "timoshenko", elements=n), n=10), 2)[1] / exact - 1
        for n in (10, 20)
    ]
    # a factor of 16 when h is halved, up to the next order; without the internal fields it is 4
    assert errors[0] / errors[1] == pytest.approx(16, rel=0.05)


def test_free_free_euler():
    roots = [
        brentq(lambda x: np.cos(x) - 1 / np.cosh(x), x - 0.5, x + 0.5, xtol=1e-14)
        for x in (4.73, 7.853, 10.996)
    ]
    assert roots[0] == pytest.approx(4.73004074, abs=1e-8)  # Blevins' table
    exact = np.array(roots) ** 2 * np.sqrt(E * RADIUS**2 / 4 / RHO) / LENGTH**2
    found = bending(sg.modes(sg.build(rod(), "euler", elements=40), n=12), 3)
    # cubic elements, error (beta h)^4 / 720 in the eigenvalue, half of it in the frequency: 1.4e-7,
    # 1.0e-6, 4.0e-6
    expected = (np.array(roots) / 40) ** 4 / 1440
    assert found / exact - 1 == pytest.approx(expected, rel=0.05)


# --------------------------------------------------------------------------- rods
def discrete_rod(speed, n, elements, length=LENGTH):
    """Frequency of mode n of two-node elements with consistent mass: closed form of the difference
    equation.
    """
    h = length / elements
    c = np.cos(n * np.pi / elements)
    return np.sqrt(6 * speed**2 / h**2 * (1 - c) / (2 + c))


@pytest.mark.parametrize(
    "family, speed", [("axial", np.sqrt(E / RHO)), ("torsion", np.sqrt(G / RHO))]
)
def test_free_free_rod(family, speed):
    body = sg.build(rod(), "timoshenko", elements=40)
    found = [
        2 * np.pi * m.frequency_hz
        for m in sg.modes(body, n=20).modes
        if m.family == family and m.frequency_hz > 0
    ]
    for n in (1, 2):
        # the shift of 1e-3 of the first eigenvalue costs three digits of rounding
        assert found[n - 1] == pytest.approx(discrete_rod(speed, n, 40), rel=1e-9)
        # ... and the discrete rod is within (n pi / 40)^2 / 24 of the continuous one
        assert found[n - 1] / (n * np.pi * speed / LENGTH) - 1 == pytest.approx(
            (n * np.pi / 40) ** 2 / 24, rel=0.01
        )


# --------------------------------------------------------------------------- cantilevers
def cantilever(segments, spring=1e24, **options):
    """Compliance at the tip of a shaft held at y = HELD by a bearing of equal stiffness in all six
    components.

    The stub behind the clamp is free of stress; were it 1 mm short, 12 EI / h^3 of its one element
    would cost the Euler beam four digits.
    """
    length = segments[-1].y1
    clamp = Bearing(
        name="clamp", y=HELD, seat_width=2 * HELD, matrix=np.eye(6) * spring, attachment="section"
    )
    tip = Port(name="tip", y=length, lo=length - 0.002, hi=length, attachment="section")
    scene = Scene.from_parts(segments, bearings=[clamp], port=tip)
    fidelity = options.pop("fidelity", "timoshenko")
    return sg.condense(sg.build(scene, fidelity, **options), scene, "tip").compliance, length - HELD


@pytest.mark.parametrize("fidelity", ["euler", "timoshenko"])
def test_uniform_cantilever(fidelity):
    segments = [Segment.cylinder("rod", length=LENGTH, diameter=2 * RADIUS)]
    c, length = cantilever(segments, fidelity=fidelity, elements=10)
    area, second = np.pi * RADIUS**2, np.pi / 4 * RADIUS**4
    shear = length / (kappa_solid() * G * area) if fidelity == "timoshenko" else 0.0
    bend = length / (E * second)
    expected = np.zeros((6, 6))
    expected[2, 2] = expected[0, 0] = bend * length**2 / 3 + shear
    expected[3, 3] = expected[5, 5] = bend
    expected[2, 3] = expected[3, 2] = bend * length / 2
    expected[0, 5] = expected[5, 0] = -bend * length / 2
    expected[1, 1] = length / (E * area)
    expected[4, 4] = length / (G * 2 * second)
    # The elements are exact in statics, and a spring of 1e24 N/m adds 1e-24 m/N to 1e-9.  What is
    # left is where the static refinement stops, 1e-12 of the flexibility, and here the flexibility
    # of the free body is of the result's size.
    size = np.sqrt(np.diag(expected))
    assert np.abs((c - expected) / np.outer(size, size)).max() < 1e-11


def test_soft_clamp_adds_its_own_compliance():
    # Springs of 1e6 in all components sit in series: 1/k, and the tilt of the clamp times the arm.
    segments = [Segment.cylinder("rod", length=LENGTH, diameter=2 * RADIUS)]
    soft, length = cantilever(segments, spring=1e6)
    stiff, _ = cantilever(segments)
    added = np.zeros((6, 6))
    added[np.diag_indices(6)] = 1e-6
    added[2, 2] = added[0, 0] = 1e-6 * (1 + length**2)
    added[2, 3] = added[3, 2] = 1e-6 * length
    added[0, 5] = added[5, 0] = -1e-6 * length
    # exact in algebra; the largest entries are of the same order on both sides, so a few roundings
    # of them and the static refinement's 1e-12
    assert np.abs(soft - stiff - added).max() < 1e-11 * np.abs(added).max()


@pytest.mark.parametrize("bore", [0.0, 0.02])
def test_tapered_cantilever_against_the_unit_load_integral(bore):
    a0, a1, length = 0.05, 0.02, 0.4
    cone = Segment.cone(
        "cone", length=length, start_diameter=2 * a0, end_diameter=2 * a1, bore=bore
    )
    c, span = cantilever([cone], elements=4)
    radius = lambda y: a0 + (a1 - a0) * y / length  # noqa: E731
    area = lambda y: np.pi * (radius(y) ** 2 - bore**2 / 4)  # noqa: E731
    second = lambda y: np.pi / 4 * (radius(y) ** 4 - bore**4 / 16)  # noqa: E731

    def kappa(y):
        a, b = radius(y) ** 2, bore**2 / 4
        return (6 * (1 + NU) ** 2 * (a + b) ** 2) / (
            7 * a**2
            + 34 * a * b
            + 7 * b**2
            + NU * (12 * a**2 + 48 * a * b + 12 * b**2)
            + NU**2 * (4 * a**2 + 16 * a * b + 4 * b**2)
        )

    def integral(f):
        return quad(f, length - span, length, epsabs=0, epsrel=1e-13, limit=200)[0]

    arm = lambda y: length - y  # noqa: E731
    expected = {
        (2, 2): integral(lambda y: arm(y) ** 2 / (E * second(y)) + 1 / (kappa(y) * G * area(y))),
        (2, 3): integral(lambda y: arm(y) / (E * second(y))),
        (3, 3): integral(lambda y: 1 / (E * second(y))),
        (1, 1): integral(lambda y: 1 / (E * area(y))),
        (4, 4): integral(lambda y: 1 / (2 * G * second(y))),
    }
    for (i, j), value in expected.items():
        # 8 Gauss points on a quarter of the cone (radius changing by a quarter) leave about 1e-11
        # of the integral of r^-4
        assert c[i, j] == pytest.approx(value, rel=1e-10), (i, j)


def test_mean_head_is_the_cylinder_of_mean_radius():
    cone = Segment.cone("cone", length=0.4, start_diameter=0.1, end_diameter=0.04)
    mean, length = cantilever([cone], head="mean")
    second = np.pi / 4 * 0.035**4
    assert mean[3, 3] == pytest.approx(
        length / (E * second), rel=1e-10
    )  # as for the uniform cantilever, more elements


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
def test_shear_coefficient_of_a_thin_tube(nu):
    # Hutchinson's limit (1 + nu) / (2 + nu); the correction is of first order in the thickness
    # squared
    assert shear_coefficient(nu, 1.0, 1 - 1e-6) == pytest.approx((1 + nu) / (2 + nu), rel=1e-6)


# --------------------------------------------------------------------------- mass
@pytest.mark.parametrize("mass", ["consistent", "lumped"])
def test_beam_mass_is_that_of_the_cone(mass):
    length, a, b = 0.3, 0.02, 0.05
    cone = Segment.cone("cone", length=length, start_diameter=2 * a, end_diameter=2 * b)
    m = sg.build(Scene.from_parts([cone]), "timoshenko", mass=mass).mass_matrix()
    radius = lambda y: a + (b - a) * y / length  # noqa: E731
    total = quad(lambda y: RHO * np.pi * radius(y) ** 2, 0, length, epsrel=1e-13)[0]
    polar = quad(lambda y: RHO * np.pi / 2 * radius(y) ** 4, 0, length, epsrel=1e-13)[0]
    assert m[0, 0] == m[2, 2] == pytest.approx(total, rel=1e-12)  # polynomials, integrated exactly
    assert m[1, 1] == pytest.approx(total, rel=1e-12)
    assert m[4, 4] == pytest.approx(polar, rel=1e-12)
    if mass == "consistent":
        first = quad(lambda y: RHO * np.pi * radius(y) ** 2 * y, 0, length, epsrel=1e-13)[0]
        cross = quad(
            lambda y: RHO * np.pi * (radius(y) ** 2 * y**2 + radius(y) ** 4 / 4),
            0,
            length,
            epsrel=1e-13,
        )[0]
        assert m[2, 3] == pytest.approx(first, rel=1e-12)
        assert m[0, 5] == pytest.approx(-first, rel=1e-12)
        assert m[3, 3] == pytest.approx(cross, rel=1e-12)


@pytest.mark.parametrize("gap, refused", [(1e-5, True), (1e-4, True), (1e-3, False)])
def test_euler_elements_too_short_to_keep_digits_are_refused(gap, refused):
    """Two marks 1e-8 m apart once gave frequencies 59 % wrong without a word; Timoshenko does not
    mind them.
    """
    bearing = Bearing(name="1", y=0.1, seat_width=0.02, matrix=1e8 * np.eye(6))
    scene = Scene.from_parts(
        rod().segments, bearings=[bearing], port=Port(y=0.1 + gap * LENGTH, lo=0.05, hi=0.15)
    )
    if refused:
        with pytest.raises(
            SolidgearError, match=r"euler: the element at y = 0\.1 m is .* loses its digits"
        ):
            sg.build(scene, "euler")
    else:
        sg.build(scene, "euler")
    assert sg.modes(sg.build(scene, "timoshenko"), scene, n=2).frequency_hz[-1] > 0
