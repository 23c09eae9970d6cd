"""Exponents of displacement where materials, free and held faces meet, against closed forms."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from solidgear import Port, Scene, Segment
from solidgear.core.bounds.singular_places import sharpest_exponent
from solidgear.core.meshing import wedge
from solidgear.core.meshing.wedge import wedge_exponent
from solidgear.core.scene import Material

STEEL = Material(E=2.07e11, nu=0.3, density=7850)
ALUMINIUM = Material(E=7e10, nu=0.34, density=2700)
RUBBER = Material(E=2e9, nu=0.49, density=1400)
CARBIDE = Material(E=6e11, nu=0.22, density=15000)
SOFT = Material(E=1e7, nu=0.4999, density=1100)
PAIRS = [(STEEL, ALUMINIUM), (STEEL, RUBBER), (CARBIDE, RUBBER), (STEEL, SOFT)]
DEGREE = math.pi / 180


def dundurs(a, b):
    """Both constants of a pair in plane strain; Dundurs (1969), J. Appl. Mech. 36, 650."""
    g, kappa = zip(*((m.shear_modulus, 3 - 4 * m.nu) for m in (a, b)))
    whole = g[0] * (kappa[1] + 1) + g[1] * (kappa[0] + 1)
    alpha = (g[0] * (kappa[1] + 1) - g[1] * (kappa[0] + 1)) / whole
    return alpha, (g[0] * (kappa[1] - 1) - g[1] * (kappa[0] - 1)) / whole


def first_root(f, most=0.9999):
    """The least root of a function between a twentieth and one; one if there is none."""
    grid = np.linspace(0.05, most, 2000)
    values = f(grid)
    change = np.flatnonzero(values[:-1] * values[1:] < 0)
    return brentq(f, grid[change[0]], grid[change[0] + 1]) if len(change) else 1.0


def free(angle):
    """Williams (1952): sin(a w) = +- a sin(w)."""
    if angle == 2 * math.pi:
        return 0.5
    return min(
        first_root(lambda a, s=sign: np.sin(a * angle) + s * a * np.sin(angle)) for sign in (1, -1)
    )


@pytest.mark.parametrize("degrees", [200, 225, 270, 315, 360])
def test_one_free_wedge_is_that_of_williams(degrees):
    whole = degrees * DEGREE
    for parts in ([1.0], [0.3, 0.7]):  # cut in two of one material, nothing changes
        found = wedge_exponent([(share * whole, STEEL) for share in parts])
        assert found == pytest.approx(free(whole), abs=1e-6)


@pytest.mark.parametrize("material", [STEEL, RUBBER, SOFT])
@pytest.mark.parametrize("degrees", [80, 90, 120, 270])
def test_a_wedge_held_on_one_face_is_that_of_williams(material, degrees):
    # Williams (1952), J. Appl. Mech. 19, 526, clamped and free; across the plane pi / 2 angle
    angle, kappa = degrees * DEGREE, 3 - 4 * material.nu

    def equation(a):
        rest = ((kappa + 1) ** 2 - 4 * a**2 * np.sin(angle) ** 2) / (4 * kappa)
        return np.sin(a * angle) ** 2 - rest

    expected = min(first_root(equation), math.pi / 2 / angle)
    assert wedge_exponent([(angle, material)], held=True) == pytest.approx(expected, abs=1e-6)


def test_of_a_clamp_on_a_smooth_surface_stress_goes_with_the_root():
    for material in (STEEL, SOFT):
        assert wedge_exponent([(math.pi, material)], held=True) == pytest.approx(0.5, abs=1e-8)


@pytest.mark.parametrize("pair", PAIRS)
def test_of_bonded_quarter_planes_it_is_that_of_bogy(pair):
    # Bogy (1968), J. Appl. Mech. 35, 460; (1971) 38, 377
    alpha, beta = dundurs(*pair)

    def equation(a):
        sine = np.sin(math.pi * a / 2) ** 2
        square = (sine - a**2) ** 2 * beta**2 + 2 * a**2 * (sine - a**2) * alpha * beta
        return square + a**2 * (a**2 - 1) * alpha**2 + np.sin(math.pi * a) ** 2 / 4

    expected = first_root(equation)
    assert 0.5 < expected < 0.95
    for order in (pair, pair[::-1]):
        found = wedge_exponent([(math.pi / 2, material) for material in order])
        assert found == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize("pair", PAIRS)
def test_of_a_crack_between_two_materials_stress_turns_as_it_grows(pair):
    # Williams (1959), Bull. Seismol. Soc. Am. 49, 199: 1/2 + i ln((1 - beta) / (1 + beta)) / 2 pi
    beta = dundurs(*pair)[1]
    laws = [(math.pi, wedge._plane(m.E / pair[0].E, m.nu)) for m in pair]
    roots = wedge._roots(*wedge._matrices(laws, 2), 0)
    turn = abs(math.log((1 - beta) / (1 + beta))) / (2 * math.pi)
    assert np.abs(roots - (0.5 + 1j * turn)).min() < 1e-6
    assert wedge_exponent([(math.pi, m) for m in pair]) == pytest.approx(0.5, abs=1e-6)


@pytest.mark.parametrize("pair", PAIRS)
def test_of_four_quarters_in_turn_it_is_that_across_the_plane(pair):
    """Of two materials like fields of a chessboard tan^2(a pi / 4) is the ratio of the shear moduli."""
    ratio = min(
        pair[0].shear_modulus / pair[1].shear_modulus, pair[1].shear_modulus / pair[0].shear_modulus
    )
    expected = 4 / math.pi * math.atan(math.sqrt(ratio))
    found = wedge_exponent([(math.pi / 2, m) for m in (*pair, *pair)], closed=True)
    assert found == pytest.approx(expected, rel=1e-6)


def test_around_an_edge_inside_one_material_nothing_is_singular():
    parts = [(math.pi / 2, STEEL), (1.5 * math.pi, STEEL)]
    assert wedge_exponent(parts, closed=True) == pytest.approx(1.0, abs=1e-6)
    # and a soft corner hardly holds the notch that is filled with it
    filled = wedge_exponent([(math.pi / 2, SOFT), (1.5 * math.pi, STEEL)], closed=True)
    assert filled == pytest.approx(free(1.5 * math.pi), abs=1e-3)


def test_across_the_plane_two_wedges_follow_their_shear_moduli():
    # a stress of either side through the joint: G1 tan(a w1) + G2 tan(a w2) = 0
    for a, b in PAIRS:
        laws = [(w, wedge._across(m.E / a.E, m.nu)) for w, m in ((math.pi / 2, a), (math.pi, b))]
        roots = wedge._roots(*wedge._matrices(laws, 1), 0).real
        g1, g2 = a.shear_modulus, b.shear_modulus

        def equation(x, g1=g1, g2=g2):
            one, two = x * math.pi / 2, x * math.pi
            return g1 * np.sin(one) * np.cos(two) + g2 * np.sin(two) * np.cos(one)

        assert np.abs(roots - first_root(equation)).min() < 1e-8


def shaft(parts, rigid=None, attachment="rigid"):
    """Cylinders (length, diameter, material) in mm with a seat (from, to) on them."""
    segments, y = [], 0.0
    for k, (length, diameter, material) in enumerate(parts):
        size = {"length": length * 1e-3, "diameter": diameter * 1e-3, "y0": y * 1e-3}
        segments.append(Segment.cylinder(f"s{k}", **size, material=material))
        y += length
    lo, hi = (place * 1e-3 for place in rigid or (5, 10))
    tie = attachment if rigid else "average"
    port = Port(y=(lo + hi) / 2, lo=lo, hi=hi, attachment=tie)
    return Scene.from_parts(segments, port=port)


QUARTER, HALF = math.pi / 2, math.pi
BODIES = {
    "smooth": ([(50, 20, STEEL), (50, 20, STEEL)], None, 1.0),
    "butt joint": (
        [(50, 20, STEEL), (50, 20, RUBBER)],
        None,
        wedge_exponent([(QUARTER, STEEL), (QUARTER, RUBBER)]),
    ),
    "sleeve": (
        [(50, 20, RUBBER), (50, 30, STEEL)],
        None,
        wedge_exponent([(QUARTER, RUBBER), (HALF, STEEL)]),  # less sharp than one of steel
    ),
    "soft sleeve": (
        [(50, 20, STEEL), (50, 30, RUBBER)],
        None,
        wedge_exponent([(QUARTER, STEEL), (HALF, RUBBER)]),
    ),
    "seat on a smooth surface": ([(100, 20, STEEL)], (40, 60), 0.5),
    "seat to a shoulder": ([(50, 20, STEEL), (50, 30, STEEL)], (40, 50), 1 / 3),
    "seat to a shoulder of a soft body": (
        [(50, 20, SOFT), (50, 30, SOFT)],
        (40, 50),
        wedge_exponent([(1.5 * HALF, SOFT)], held=True),
    ),
    "seat over a whole disc": (
        [(50, 20, STEEL), (10, 80, STEEL), (50, 20, STEEL)],
        (50, 60),
        free(1.5 * HALF),  # its own ends are less sharp
    ),
    "seat to a joint": (
        [(50, 20, STEEL), (50, 20, RUBBER)],
        (40, 50),
        # of its end within the steel, or where it meets the rubber: the lesser
        min(0.5, wedge_exponent([(QUARTER, STEEL), (QUARTER, RUBBER)], held=True)),
    ),
}


@pytest.mark.parametrize("name", BODIES)
def test_the_sharpest_edge_of_a_shaft(name):
    parts, seat, expected = BODIES[name]
    assert sharpest_exponent(shaft(parts, seat)) == pytest.approx(expected, abs=1e-4)
    # and of the same shaft turned round
    length = sum(part[0] for part in parts)
    turned = None if seat is None else (length - seat[1], length - seat[0])
    mirrored = shaft(parts[::-1], turned)
    assert sharpest_exponent(mirrored) == pytest.approx(expected, abs=1e-4)


def test_seats_are_as_the_body_has_them():
    scene = shaft([(100, 20, STEEL)], (40, 60), "average")
    assert sharpest_exponent(scene) == 1.0
    assert sharpest_exponent(scene, rigid=["port"]) == pytest.approx(0.5)
