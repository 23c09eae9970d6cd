"""Section forces of a free shaft, nominal stress, and loads that are no equilibrium."""

from pathlib import Path

import numpy as np
import pytest
from filleted import shoulder

import solidgear as sg
from solidgear import PointMass, Segment, SolidgearError
from solidgear.core import Outline
from solidgear.core.scene.closed_form import mass_properties
from solidgear.strength.stress.nominal import CrossSection, nominal_rows, nominal_stress
from solidgear.strength.stress.section_forces import (
    Load,
    forces_of,
    move_load,
    on_ports,
    section_forces,
)
from solidgear.strength.stress.spread_weight import SpreadWeight

GEOMETRY = Path(__file__).parent.parent / "geometry"
LENGTH = 0.6


def balanced(*loads):
    """Loads and one more at the far end that balances them."""
    total = sum(move_load(load.six, load.y, LENGTH) for load in loads)
    return [*loads, Load("wall", LENGTH, -total)]


def drawn(seed, count=5):
    rng = np.random.default_rng(seed)
    return [Load(f"{k}", y, rng.normal(size=6)) for k, y in enumerate(rng.uniform(0, 0.5, count))]


def test_a_beam_on_two_supports_is_the_textbook_one():
    """F a b / l under the force, in both planes; the side away from the force is pulled."""
    a, b = 0.2, 0.4
    up, down = 1000.0 * b / LENGTH, -1000.0
    for axis, moment, sign in ((2, 3, 1.0), (0, 5, -1.0)):
        loads = []
        for name, y, force in (("A", 0.0, up), ("gear", a, down), ("B", LENGTH, 1000.0 - up)):
            six = np.zeros(6)
            six[axis] = force
            loads.append(Load(name, y, six))
        found = section_forces(loads, LENGTH)
        assert found.at(a)[moment] == pytest.approx(sign * 1000 * a * b / LENGTH, rel=1e-12)
        assert found.at(0.1)[axis] == pytest.approx(-up) and found.right[-1].tolist() == [0.0] * 6
        section = CrossSection(0.02, 0.0)
        six = found.at(a)
        # sigma = -M_x z / I + M_z x / I at the surface away from the force, which points to -z or -x
        below = -six[3] * -0.02 + six[5] * -0.02
        assert below / section.second_moment == pytest.approx(nominal_stress(section, six).bending)


@pytest.mark.parametrize("seed", range(3))
def test_section_forces_are_those_of_either_side(seed):
    loads = balanced(*drawn(seed))
    found = section_forces(loads, LENGTH)
    for y in (0.03, 0.27, 0.55):
        beyond = sum(move_load(load.six, load.y, y) for load in loads if load.y > y)
        assert np.allclose(found.at(y), beyond, atol=1e-12)


def test_moments_grow_by_the_shear():
    found = section_forces(balanced(*drawn(7)), LENGTH)
    a, b = found.at(0.5001), found.at(0.5999)
    assert (b[3] - a[3]) / 0.0998 == pytest.approx(-a[2], rel=1e-9)
    assert (b[5] - a[5]) / 0.0998 == pytest.approx(a[0], rel=1e-9)
    assert (b - a)[[0, 1, 2, 4]].tolist() == [0.0] * 4


def test_a_load_makes_a_step_of_its_own_size():
    loads = balanced(*drawn(3))
    found = section_forces(loads, LENGTH)
    for load in loads[:-1]:
        k = found.names.index(load.name)
        assert np.allclose(found.left[k] - found.right[k], load.six, atol=1e-12)


@pytest.mark.parametrize(
    "six, words",
    [
        ([0, 0, 0, 0, 50.0, 0], r"50 N m of thy is left .* a drive torque is a load too$"),
        ([0, -3.0, 0, 0, 0, 0], r"-3 N of y is left"),
        ([0, 0, 2.0, 0, 0, 0], r"2 N of z, 0.6 N m of thx is left"),
    ],
)
def test_loads_that_leave_something_are_refused(six, words):
    with pytest.raises(SolidgearError, match=words):
        section_forces([Load("gear", 0.3, np.array(six))], LENGTH)


def test_loads_are_named_as_the_scene_names_its_ports():
    scene = shoulder()
    with pytest.raises(SolidgearError, match='load on "gaer": .* did you mean "gear"'):
        on_ports(scene, {"gaer": [0] * 6})
    with pytest.raises(SolidgearError, match='load on "A": it must be six finite numbers'):
        on_ports(scene, {"A": [0, 0, 1.0]})


def test_a_port_beside_its_seat_loads_the_seat():
    """What lies between the two is not in the way of the force."""
    scene = shoulder()
    beside = scene.with_port(y=scene.port.hi + 0.02)
    (load,) = on_ports(beside, {"gear": [0, 0, 100.0, 0, 0, 0]})
    assert load.y == scene.port.hi
    assert np.allclose(load.six, [0, 0, 100.0, 2.0, 0, 0])


def test_weight_is_that_of_the_segments_and_masses():
    scene = shoulder(bore=0.02).with_changes(
        masses=(PointMass(name="disc", mass=3.0, on="gear", offset=[0.0, 0.01, 0.0]),)
    )
    mass = mass_properties(scene.outline)
    force, arm = mass.mass + 3.0, mass.mass * mass.centre + 3.0 * (scene.port.y + 0.01)
    a, b = (bearing.y for bearing in scene.bearings)
    rear = 9.81 * (arm - a * force) / (b - a)
    up = {"A": 9.81 * force - rear, "B": rear}
    found = forces_of(scene, {n: [0, 0, z, 0, 0, 0] for n, z in up.items()}, [0, 0, -9.81])
    assert found.right[0].tolist() == found.right[-1].tolist() == [0.0] * 6
    assert "weight of disc" in found.names


def test_a_rod_under_its_weight_bends_as_in_the_textbook():
    """q l^2 / 8 in the middle of two supports, less q a^2 / 2 by what overhangs; N hangs in y."""
    q, over, span = 12.0, 0.05, 0.5
    rod = Outline([Segment.cylinder("rod", length=0.6, diameter=0.03)])
    line = q / mass_properties(rod).mass * 0.6
    spread = SpreadWeight(rod, line * np.array([0.0, 0.5, -1.0]))
    held = np.array([0.0, -0.5 * q * 0.6, q * 0.3, 0.0, 0.0, 0.0])
    found = section_forces(
        [Load("A", over, held), Load("B", over + span, held * [1, 0, 1, 1, 1, 1])], 0.6, spread
    )
    middle = q * span**2 / 8 - q * over**2 / 2
    assert found.largest_moment == pytest.approx(middle, rel=1e-12)
    assert found.peak == pytest.approx(0.3, abs=1e-6)
    for y in (0.1, 0.33):
        moment = q * 0.3 * (y - over) - q * y**2 / 2
        shear, tension = q * 0.3 - q * y, 0.5 * q * (0.6 - y)
        assert found.at(y)[[1, 2, 3]] == pytest.approx([tension, -shear, moment], rel=1e-12)
    (row,) = (row for row in nominal_rows(rod.segments, found) if row.names == "largest M")
    assert np.hypot(row.forces[3], row.forces[5]) == pytest.approx(middle, rel=1e-12)


def test_the_sum_of_discs_is_the_weight_of_cones_and_fillets():
    scene = sg.load(GEOMETRY / "pinion_filleted.toml")
    spread = SpreadWeight(scene.outline, np.array([0.0, 0.0, -9.81]))
    places = np.linspace(0.0, scene.length, 200_001)
    middles = (places[1:] + places[:-1]) / 2
    area = np.zeros_like(middles)
    for piece in scene.outline.pieces:
        inside = (middles > piece.y0) & (middles < piece.y1)
        share = (middles[inside] - piece.y0) / (piece.y1 - piece.y0)
        radius = piece.r0 + share * (piece.r1 - piece.r0)
        if piece.corner and piece.corner.centre:
            r, y = piece.corner.centre
            reach = piece.corner.radial**2 - (middles[inside] - y) ** 2
            radius = r - piece.corner.out * np.sqrt(reach)
        area[inside] += (1 if piece.surface == "outer" else -1) * np.pi * radius**2
    line = 9.81 * scene.segments[0].material.density * area * np.diff(places)
    for lo, hi in ((0.0, scene.length), (0.011, 0.0617)):
        cut = (middles > lo) & (middles < hi)
        six = spread.between(lo, hi, about=hi)
        assert six[2] == pytest.approx(-line[cut].sum(), rel=1e-4)
        assert six[3] == pytest.approx(-(line * (middles - hi))[cut].sum(), rel=1e-4)
    arc = next(p.corner for p in scene.outline.pieces if p.corner and p.corner.centre)
    lo, hi = arc.span[0], sum(arc.span) / 2  # half of a fillet
    cut = (middles > lo) & (middles < hi)
    assert spread.between(lo, hi, about=0.0)[2] == pytest.approx(-line[cut].sum(), rel=2e-3)
    whole = mass_properties(scene.outline)
    weight = spread.between(0.0, scene.length, about=0.0)
    assert weight[2] == pytest.approx(-9.81 * whole.mass, rel=1e-13)
    assert weight[3] == pytest.approx(-9.81 * whole.mass * whole.centre, rel=1e-13)


def test_nominal_stress_stands_on_both_sides_of_loads_and_steps():
    scene = shoulder(bore=0.02)
    span = scene.bearings[1].y - scene.bearings[0].y
    share = (scene.port.y - scene.bearings[0].y) / span
    z = {"gear": -1000.0, "A": 1000.0 * (1 - share), "B": 1000.0 * share}
    loads = on_ports(scene, {name: [0, 0, force, 0, 0, 0] for name, force in z.items()})
    rows = nominal_rows(scene.segments, section_forces(loads, scene.length))
    step = [row for row in rows if abs(row.y - scene.segments[0].y1) < 1e-9]
    assert [row.segment for row in step] == ["s0", "s1"]
    assert np.allclose(step[0].forces, step[1].forces)
    moment = step[0].forces[3]
    for row, a in zip(step, (0.025, 0.0375)):
        expected = moment * a / (np.pi / 4 * (a**4 - 0.01**4))
        assert row.stress.bending == pytest.approx(expected, rel=1e-12)
