"""The 14-DOF pair against answers one can work out by hand, its invariances, and identification on
made-up data.
"""

from dataclasses import replace

import numpy as np
import pytest
from shafts import moved_by

from solidgear.core.system.gear_mesh import MeshVector, line_of_action, mesh_point, to_gear_frame
from validation.thesis.identification import highest, torsion_springs
from validation.thesis.identify import Unknown, identify
from validation.thesis.lumped_pair import COMPONENTS, LumpedPair, diagonal_mass, shaft_stiffness

RATIO = 45 / 14
# Singular values are good to a few roundings of the largest one: 1e4 Hz * 1e-15 against the 16 Hz
# of the softest mode, times 10.
CLOSE = 1e-11
AXIAL = MeshVector([0, 1, 0], [0, 0, 0])  # line of action along both shafts: no torque, no tilt
NOTHING = np.zeros((6, 6))


@pytest.fixture
def pair():
    n = line_of_action(0.391, 0.478, np.radians(25), "left", "concave")
    return LumpedPair(
        2.734,
        5.25,
        diagonal_mass(24.8, 0.0587, 0.454),
        diagonal_mass(122.69, 1.92, 2.065),
        shaft_stiffness(8.644e9, 1.013e9, 2.843e7, -4.14e8),
        shaft_stiffness(1.306e10, 2.28e9, 1.0715e8, -1.0546e9),
        1.09e4,
        8.63e4,
        8.6e8,
        MeshVector(n, mesh_point(0.055, 0.004)),
        MeshVector(to_gear_frame(n), mesh_point(0.055 * RATIO, -0.003, member="gear")),
    )


def hertz(*eigenvalues):
    return np.sqrt(eigenvalues) / (2 * np.pi)


def test_single_mass_on_its_support(pair):
    # Axial: one mass on one spring. Bending: the quadratic of (x, thz), twice, for the two planes.
    alone = replace(
        pair, mesh_stiffness=0.0, pinion_torsion=0.0, gear_torsion=0.0, gear_support=NOTHING
    )
    modes = alone.solve()
    k, t, c, m, i = 8.644e9, 2.843e7, -4.14e8, 24.8, 0.454
    half, product = (k / m + t / i) / 2, (k * t - c**2) / (m * i)
    root = np.sqrt(half**2 - product)
    want = np.sort(
        hertz(
            product / (half + root), product / (half + root), half + root, half + root, 1.013e9 / m
        )
    )
    assert modes.rigid == 9
    assert np.allclose(modes.frequency_hz[9:], want, rtol=1e-10)


def test_two_masses_joined_by_the_mesh_spring(pair):
    loose = replace(
        pair, pinion_torsion=0.0, gear_torsion=0.0, pinion_support=NOTHING, gear_support=NOTHING
    )
    modes = replace(loose, pinion_mesh=AXIAL, gear_mesh=AXIAL).solve()
    assert modes.rigid == 13
    assert modes.frequency_hz[13] == pytest.approx(
        hertz(8.6e8 * (1 / 24.8 + 1 / 122.69)), rel=1e-13
    )
    assert np.array_equal(modes.energy[13], np.eye(7)[6])


def test_signs_of_the_shaft_stiffness_are_those_of_a_spring_behind_the_lumped_point():
    # A bearing at y = +L holds the shaft against x and z: seen from the lumped point it is the
    # shifted spring.
    k, length = 3e9, 0.1
    behind = moved_by(np.diag([k, 0, k, 0, 0, 0]), (0, -length, 0))
    assert np.allclose(shaft_stiffness(k, 0, k * length**2, -k * length), behind, rtol=1e-14)


def test_energy_is_that_of_the_springs(pair):
    modes, shapes = pair.solve(), pair.system.modes().shapes
    assert modes.rigid == 1 and not modes.energy[0].any()
    assert modes.energy[1:].sum(axis=1) == pytest.approx(np.ones(13), abs=1e-11)
    motion = {name: pair.system.motion(name) @ shapes for name in pair.system.parts}
    stretch = {
        "pinion rotation": motion["engine"][4] - motion["pinion"][4],
        "gear rotation": motion["gear"][4] - motion["load"][4],
        "mesh": pair.pinion_mesh.vector @ motion["pinion"] - pair.gear_mesh.vector @ motion["gear"],
    }
    stiffness = {
        "pinion rotation": pair.pinion_torsion,
        "gear rotation": pair.gear_torsion,
        "mesh": pair.mesh_stiffness,
    }
    total = (2 * np.pi * modes.frequency_hz[1:]) ** 2
    share = dict(zip(COMPONENTS, modes.energy[1:].T))
    for name, moved in stretch.items():
        assert share[name] == pytest.approx(stiffness[name] * moved[1:] ** 2 / total, abs=1e-11)
    for body, k in (("pinion", pair.pinion_support), ("gear", pair.gear_support)):
        u = motion[body][:, 1:]
        both = share[f"{body} translation"] + share[f"{body} bending"]
        assert both == pytest.approx((u * (k @ u)).sum(axis=0) / total, abs=1e-11)
        translation = (u[:3] * (k @ u)[:3]).sum(axis=0) / total
        assert share[f"{body} translation"] == pytest.approx(translation, abs=1e-11)


# -- invariances -------------------------------------------------------------------------------------------------------------
def test_transmission_error_ignores_a_common_rigid_motion(pair):
    # Pinion and gear carried together about a common apex keep their teeth as they were.
    apex = np.array([-0.055, 0.18, 0.0])
    pinion = MeshVector(pair.pinion_mesh.normal, apex)
    gear = MeshVector(to_gear_frame(pinion.normal), to_gear_frame(apex))
    for motion in np.eye(6):
        seen = np.concatenate([to_gear_frame(motion[:3]), to_gear_frame(motion[3:])])
        assert abs(pinion.vector @ motion - gear.vector @ seen) < 1e-16


def test_moving_a_lumped_point_changes_no_frequency(pair):
    offset = np.array([0.0, 0.07, 0.0])
    moved = replace(
        pair,
        pinion_mass=moved_by(pair.pinion_mass, offset),
        pinion_support=moved_by(pair.pinion_support, offset),
        pinion_mesh=MeshVector(pair.pinion_mesh.normal, pair.pinion_mesh.point - offset),
    )
    assert moved.pinion_mass[0, 5] != 0
    a, b = pair.solve(), moved.solve()
    assert np.allclose(a.frequency_hz, b.frequency_hz, rtol=CLOSE, atol=0)
    assert np.allclose(a.energy[:, [2, 3, 6]], b.energy[:, [2, 3, 6]], rtol=0, atol=1e-9)


# -- Rayleigh ----------------------------------------------------------------------------------------------------------------
def test_rayleigh_bound_is_below_the_highest_frequency(pair):
    bound, dof, _ = highest(pair.pinion_support, pair.pinion_mass, 1.0)
    top = pair.solve().frequency_hz[-1]
    assert 0.5 * top < bound <= top and dof in (0, 2)


def test_published_masses_contradict_published_frequencies():
    k = shaft_stiffness(1.585e10, 1.015e9, 5.14e7, -7.294e7)
    bound, _, needed = highest(k, diagonal_mass(14.72, 0.0587, 0.502), 4139.6)
    # sqrt(1.585e10 / 14.72) / 2 pi, rounded to 0.1 Hz, and the mass that would just do.
    assert bound == pytest.approx(5222.5, abs=0.06)
    assert needed == pytest.approx(23.43, abs=0.006)
    assert highest(k, diagonal_mass(24.4, 0.0587, 0.45), 4139.6)[0] < 4139.6


# -- identification ----------------------------------------------------------------------------------------------------------
def test_torsion_springs_give_back_their_frequencies():
    pairs = torsion_springs(2.734, 0.0587, 1.92, 5.25, RATIO, 16.3, 47.3)
    # Four digits are quoted.
    assert np.allclose(pairs, [(1.159e4, 8.044e4), (1.059e4, 8.810e4)], rtol=5e-4)
    j = np.diag([2.734, 0.0587 + 1.92 / RATIO**2, 5.25 / RATIO**2])
    for k1, k2 in pairs:
        k = np.array(
            [
                [k1, -k1, 0],
                [-k1, k1 + k2 / RATIO**2, -k2 / RATIO**2],
                [0, -k2 / RATIO**2, k2 / RATIO**2],
            ]
        )
        found = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(j, k)).real)[1:]) / (2 * np.pi)
        assert np.allclose(found, [16.3, 47.3], rtol=1e-10)


def springs_and_masses(v):
    return np.sqrt([v["k"] / v["m"], v["k"] / (2 * v["m"]), v["k"] / (v["m"] + 1.0)])


def test_identification_recovers_what_made_the_data():
    true = {"k": 3.0e6, "m": 7.0}
    unknowns = [Unknown("k", 1e5, 1e8, "N/m"), Unknown("m", 1.0, 50.0, "kg")]
    found = identify(springs_and_masses, unknowns, springs_and_masses(true), starts=4)
    assert found.values["k"] == pytest.approx(3.0e6, rel=1e-6)
    assert found.values["m"] == pytest.approx(7.0, rel=1e-6)
    assert found.agreeing == 4 and not found.on_bounds
    k, m = found.quantities
    # Frequencies go as sqrt(k): exactly a half. Central differences with a step of 1e-5 of the
    # range err by about 1e-9.
    assert np.allclose(k.sensitivity, 0.5, rtol=1e-7)
    assert np.allclose(m.sensitivity, [-0.5, -0.5, -0.5 * 7 / 8], rtol=1e-5)


def test_a_bound_is_reported():
    found = identify(lambda v: [np.sqrt(v["k"])], [Unknown("k", 1.0, 4.0)], [3.0], starts=2)
    assert found.quantities[0].on_bound == "upper" and found.on_bounds == ("k",)
    assert found.error[found.worst] == pytest.approx(-1 / 3, rel=1e-2)


def test_what_the_data_do_not_fix_is_reported():
    # Only the ratio of k and m shows.
    found = identify(
        lambda v: np.sqrt([v["k"] / v["m"], 2 * v["k"] / v["m"]]),
        [Unknown("k", 1, 9), Unknown("m", 1, 9)],
        [1.0, 1.5],
    )
    assert found.condition > 1e6
    assert all(q.spread == np.inf for q in found.quantities)
