"""Exponents of corners, and the sharpest one of a shaft."""

import math
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.bounds.singular_places import sharpest_exponent
from solidgear.core.bounds.solid import share_of_error
from solidgear.core.meshing.corners import SHOULDER, corner_layers, sharpest_corner
from solidgear.core.meshing.wedge import wedge_exponent
from solidgear.core.scene import Material
from tests.shafts import shaft

STEEL = Material(E=2.07e11, nu=0.3, density=7850)
GEOMETRY = Path(__file__).parent.parent / "geometry"


@pytest.mark.parametrize(
    ("degrees", "exponent", "tolerance"),
    [
        (90, 1.0, 0),  # not re-entrant
        (180, 1.0, 0),
        (225, 0.6736, 5e-5),  # literature, four digits
        (270, 0.5444837, 5e-8),  # Williams (1952), seven digits
        (360, 0.5, 1e-7),  # crack
    ],
)
def test_corner_exponent(degrees, exponent, tolerance):
    assert corner_exponent(math.radians(degrees)) == pytest.approx(exponent, abs=tolerance)


@pytest.mark.parametrize("degrees", range(185, 360, 5))
def test_corner_exponent_solves_the_characteristic_equation(degrees):
    w = math.radians(degrees)
    found = corner_exponent(w)
    # root to eight digits, slope of the equation below 10
    assert abs(abs(math.sin(found * w)) - abs(found * math.sin(w))) < 1e-7
    # and the smallest one: no sign change of either branch below it
    below = np.linspace(1e-6, found - 1e-6, 5000)
    for sign in (1, -1):
        f = np.sin(below * w) + sign * below * np.sin(w)
        assert np.all(f[1:] * f[:-1] > 0)


def corner_exponent(angle):
    return wedge_exponent([(angle, STEEL)])


def test_sharper_corners_are_more_singular():
    found = [corner_exponent(math.radians(d)) for d in range(180, 361)]
    assert np.all(np.diff(found) < 0)
    # no jump where the first root enters the search: a degree moves the exponent by 0.011 near 180
    # degrees
    assert np.max(-np.diff(found)) < 0.012


def mirrored(parts):
    return [(length, b, a, *reversed(bore)) for length, a, b, *bore in reversed(parts)]


SLOPE = math.atan(0.2)  # 0.02 over 0.1
CORNERS = {
    "plain": ([(0.1, 0.05, 0.05)], math.pi),
    "two equal cylinders": ([(0.1, 0.05, 0.05), (0.1, 0.05, 0.05)], math.pi),
    "shoulder": ([(0.1, 0.05, 0.05), (0.1, 0.03, 0.03)], 1.5 * math.pi),
    "cone widens after a cylinder": ([(0.1, 0.03, 0.03), (0.1, 0.03, 0.05)], math.pi + SLOPE),
    "cone ends in a cylinder of its large end": ([(0.1, 0.03, 0.05), (0.1, 0.05, 0.05)], math.pi),
    "cone narrows to a cylinder": ([(0.1, 0.05, 0.03), (0.1, 0.03, 0.03)], math.pi + SLOPE),
    "cone narrows after a cylinder": ([(0.1, 0.05, 0.05), (0.1, 0.05, 0.03)], math.pi),
    "waist of two cones": ([(0.1, 0.05, 0.03), (0.1, 0.03, 0.05)], math.pi + 2 * SLOPE),
    "step down to a widening cone": ([(0.1, 0.08, 0.08), (0.1, 0.03, 0.05)], 1.5 * math.pi + SLOPE),
    "step down to a narrowing cone": (
        [(0.1, 0.08, 0.08), (0.1, 0.05, 0.03)],
        1.5 * math.pi - SLOPE,
    ),
    "step in the bore": (
        [(0.1, 0.08, 0.08, 0.02, 0.02), (0.1, 0.08, 0.08, 0.04, 0.04)],
        1.5 * math.pi,
    ),
    "bore that narrows after a cylinder": (
        [(0.1, 0.08, 0.08, 0.04, 0.04), (0.1, 0.08, 0.08, 0.04, 0.02)],
        math.pi + SLOPE,
    ),
    "bore that widens after a cylinder": (
        [(0.1, 0.08, 0.08, 0.02, 0.02), (0.1, 0.08, 0.08, 0.02, 0.04)],
        math.pi,
    ),
    "blind bore that widens to its bottom": (
        [(0.1, 0.08, 0.08, 0.02, 0.04), (0.1, 0.08, 0.08)],
        1.5 * math.pi + SLOPE,
    ),
    "blind bore that narrows to its bottom": (
        [(0.1, 0.08, 0.08, 0.04, 0.02), (0.1, 0.08, 0.08)],
        1.5 * math.pi - SLOPE,
    ),
    "shoulder and waist": (
        [(0.1, 0.05, 0.05), (0.1, 0.03, 0.03), (0.1, 0.03, 0.05)],
        1.5 * math.pi,
    ),
}


@pytest.mark.parametrize("flip", [False, True], ids=["", "mirrored"])
@pytest.mark.parametrize("name", CORNERS)
def test_sharpest_corner(name, flip):
    parts, angle = CORNERS[name]
    found, exponent = sharpest_corner(shaft(*(mirrored(parts) if flip else parts)))
    # plane geometry of the outline: rounding
    assert found == pytest.approx(angle, abs=1e-12)
    assert exponent == corner_exponent(found)


def test_a_joint_of_materials_has_layers_as_its_exponent_says():
    """A shoulder of the same exponent has as many; of nearly equal materials it is nearly smooth."""
    layers = {}
    for name, nu, modulus in (
        ("steel", 0.3, 2.07e11),
        ("aluminium", 0.34, 7e10),
        ("rubber", 0.49, 1e7),
    ):
        other = Material(E=modulus, nu=nu, density=1000)
        scene = shaft((0.1, 0.02, 0.02), (0.1, 0.02, 0.02))
        first, second = scene.segments
        scene = scene.with_changes(
            segments=(first.with_changes(material=STEEL), second.with_changes(material=other))
        )
        layers[name] = corner_layers(scene.outline, 1, 4)
    assert layers == {"steel": 0, "aluminium": 1, "rubber": 4}
    # a cut of ratio q leaves q^(2 a) of what a corner costs, which begins at 1 - a
    assert corner_layers(shaft((0.1, 0.02, 0.02), (0.1, 0.03, 0.03)).outline, 1, 4) == 4


def test_sharpest_corner_of_shipped_scenes():
    # shoulder behind the backcone
    angle, exponent = sharpest_corner(sg.load(GEOMETRY / "pinion_overhung.toml"))
    assert angle == pytest.approx(1.5 * math.pi, abs=1e-12)  # rounding
    assert exponent == pytest.approx(0.5444837, abs=5e-8)  # seven digits of the literature
    assert sharpest_corner(sg.load(GEOMETRY / "cylinder_free.toml")) == (math.pi, 1.0)
    # 40 mm to 60 mm of radius over 60 mm
    angle, _ = sharpest_corner(sg.load(GEOMETRY / "shaft_hollow.toml"))
    assert angle == pytest.approx(math.pi + math.atan(20 / 60), abs=1e-12)  # rounding


def test_a_slot_in_a_smooth_part_of_a_file_is_a_notch():
    """Its round part has no corner, and bars of its 3D solid took it for smooth: 1.25 for 1.7."""
    scene = sg.load(Path(__file__).parent / "found/parts/slot_shallow.toml")
    assert sharpest_exponent(scene) == 1.0
    body = sg.build(scene, "solid", refinement=0.3)
    right_angle = 1 / (1 - (2 / 3) ** (4 * SHOULDER))
    assert share_of_error(scene, body) == pytest.approx(right_angle, rel=1e-3)
