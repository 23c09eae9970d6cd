"""Modes whose names are a toss-up: torsion and bending beside a flat on one side."""

from dataclasses import replace

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.solve.mixtures import TOSS_UP, mixtures
from solidgear.cuts.features import Flat


@pytest.fixture(scope="module")
def stepped():
    """A shaft whose thin neck between two heavy ends has its third bending 1 % above torsion."""
    pieces, y = [], 0.0
    for name, length, diameter in (
        ("journal", 0.06996, 0.05704),
        ("wheel", 0.03921, 0.1087),
        ("neck", 0.04765, 0.04446),
    ):
        pieces.append(sg.Segment.cylinder(name, length=length, diameter=diameter, y0=y))
        y += length
    ends = {"start_diameter": 0.06364, "end_diameter": 0.08188}
    return [*pieces, sg.Segment.cone("rotor", length=0.08386, **ends, y0=y)]


def found_with(pieces, *features):
    soft = np.diag([1.52e8, 9.03e7, 1.54e8, 6.1e4, 0.0, 6.1e4])
    stiff = np.diag([5.97e8, 1.75e8, 6.27e8, 2.4e5, 0.0, 2.4e5])
    bearings = [
        sg.Bearing(name="A", y=0.04202, seat_width=0.014, matrix=soft),
        sg.Bearing(name="B", y=0.14197, seat_width=0.014, matrix=stiff, attachment="rigid"),
    ]
    port = sg.Port(y=0.0896, lo=0.06996, hi=0.10917)
    scene = sg.Scene.from_parts(pieces, port=port, bearings=bearings, features=features)
    return sg.modes(sg.build(scene, "solid", refinement=0.3), scene, n=9)


def test_torsion_and_bending_beside_a_flat(stepped):
    """Half of each in each: both are named, and once."""
    flat = Flat(name="f", segment="neck", y=0.10917, length=0.03987, depth=0.005875)
    found = found_with(stepped, flat)
    (one,) = mixtures(found)
    assert {one.name, one.partner} == {"torsion 1", "bending x 3"}
    assert 0.35 < one.share < TOSS_UP
    assert one.sentence.startswith(f"{one.name} and {one.partner} (+")
    first, other = (found.named(n).frequency_hz for n in (one.name, one.partner))
    assert one.gap == pytest.approx(other / first - 1)


def test_a_mixture_whose_partner_is_not_near_says_its_parts(stepped):
    flat = Flat(name="f", segment="neck", y=0.10917, length=0.03987, depth=0.005875)
    found = found_with(stepped, flat)
    (pair,) = mixtures(found)
    first = tuple(mode for mode in found.modes if mode.name != pair.partner)
    (alone,) = mixtures(replace(found, modes=first))
    assert (alone.name, alone.partner) == (pair.name, "")
    assert alone.share + alone.rest == pytest.approx(1.0, abs=0.05)  # next to nothing moves along
    assert alone.sentence.startswith(f"{alone.name} is {100 * alone.rest:.0f} % {alone.second}: ")


def test_a_shaft_of_revolution_has_none(stepped):
    assert not mixtures(found_with(stepped))
