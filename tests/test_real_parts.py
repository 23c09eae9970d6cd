"""Random parts with features: a slice of `validation.real_parts`, and what it counts by."""

import math

import numpy as np
import pytest

import solidgear as sg
from solidgear.meshing.cuts import volume
from solidgear.meshing.teeth import section_area, section_polar
from solidgear.scene import BoltCircle, Flat, Keyway, Teeth
from validation.real_parts.claims import judged
from validation.real_parts.scenes import SORTS, draw
from validation.real_parts.volumes import removed_mass, toothed_area

SLOW = [pytest.param(seed, marks=pytest.mark.slow) for seed in (8, 25, 44, 56)]


@pytest.mark.parametrize("seed", (26, *SLOW))
def test_what_must_hold_of_every_part(seed, tmp_path):
    """A fillet with a chamfer, teeth with a bolt circle; a keyway, three without a mirror plane, cross holes."""
    out = judged(draw(seed).text, seed, tmp_path / "part.toml", bands=False)
    assert not out.refused and not out.failures
    assert {"rigid", "mass", "symmetry"} <= set(out.numbers)


def test_a_part_follows_from_its_seed():
    assert draw(5).text == draw(5).text
    assert {draw(seed).sort for seed in range(60)} == set(SORTS)


def test_points_are_counted_as_closed_forms_say():
    """A quarter of a million points of a low-discrepancy sequence: some 1e-3 of what is cut out."""
    rod = sg.Segment.cylinder("rod", length=0.3, diameter=0.06)
    key = Keyway(name="k", segment="rod", y=0.1, length=0.05, width=0.015, depth=0.006, angle=0.7)
    flat = Flat(name="f", segment="rod", y=0.2, length=0.05, depth=0.004)
    bolts = BoltCircle(name="b", segment="rod", count=5, diameter=0.008, circle=0.03)
    for feature, taken in (
        (key, volume(key, 0.03, 0.0)),
        (flat, volume(flat, 0.03, 0.0)),
        (bolts, 5 * math.pi * 0.004**2 * 0.3),
    ):
        mass = removed_mass(sg.Scene.from_parts([rod], features=(feature,)))
        assert mass[0, 0] == pytest.approx(7850 * taken, rel=4e-3)
    # a key at a quarter turn takes mass at +x, so that a turn about z moves it along +y
    side = key.with_changes(angle=math.pi / 2)
    mass = removed_mass(sg.Scene.from_parts([rod], features=(side,)))
    assert mass[1, 5] > 0 and abs(mass[1, 3]) < 1e-2 * mass[1, 5]


def test_teeth_from_their_definition_have_the_section_of_the_mesh():
    for more in ({}, {"flank_angle": 0.2, "half_thickness": 0.2}, {"addendum": 0.5}):
        teeth = Teeth(name="t", segment="s", count=14, **more)
        own = section_area(teeth), section_polar(teeth)
        assert np.allclose(toothed_area(teeth), own, rtol=1e-12)
