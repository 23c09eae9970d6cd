"""The 14-DOF pair against answers one can work out by hand, its invariances, and identification on
made-up data.
"""

import re
from dataclasses import replace

import numpy as np
import pytest
from shafts import moved_by

from solidgear.errors import SolidgearError
from solidgear.system.gear_mesh import MeshVector, line_of_action, mesh_point, to_gear_frame
from validation.thesis.highest_frequency import consistency, rayleigh_bound
from validation.thesis.identify import Unknown, identify, torsion_springs
from validation.thesis.lumped_pair import (
    COMPONENTS,
    ENGINE,
    GEAR,
    LOAD,
    PINION,
    LumpedPair,
    diagonal_mass,
    shaft_stiffness,
)

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


def test_zero_mode_is_exact(pair):
    modes = pair.solve()
    assert modes.rigid == 1 and modes.frequency_hz[0] == 0.0
    turn = modes.shapes[:, 0]
    moving = np.flatnonzero(turn)
    assert moving.tolist() == [0, 5, 11, 13]
    assert turn[ENGINE] == turn[5] and turn[11] == turn[LOAD]
    assert turn[ENGINE] / turn[LOAD] == pytest.approx(-RATIO, rel=1e-14)
    assert abs(pair.transmission @ turn) < 1e-17
    assert not modes.energy[0].any()


def test_modes_are_mass_normalised_and_solve_the_problem(pair):
    k, m = pair.matrices()
    modes = pair.solve()
    assert np.abs(modes.shapes.T @ m @ modes.shapes - np.eye(14)).max() < 1e-13
    omega2 = (2 * np.pi * modes.frequency_hz) ** 2
    assert np.abs(modes.shapes.T @ k @ modes.shapes - np.diag(omega2)).max() < 1e-13 * omega2.max()
    assert modes.residual < 1e-13
    assert (np.diff(modes.frequency_hz) >= 0).all()


def test_energy_is_that_of_the_springs(pair):
    modes = pair.solve()
    for j in range(1, 14):
        u = modes.shapes[:, j]
        want = {
            "pinion rotation": pair.pinion_torsion * (u[0] - u[5]) ** 2,
            "gear rotation": pair.gear_torsion * (u[11] - u[13]) ** 2,
            "mesh": pair.mesh_stiffness
            * (pair.pinion_mesh.vector @ u[PINION] - pair.gear_mesh.vector @ u[GEAR]) ** 2,
        }
        total = (2 * np.pi * modes.frequency_hz[j]) ** 2
        for name, energy in want.items():
            assert modes.energy[j, COMPONENTS.index(name)] == pytest.approx(
                energy / total, abs=1e-11
            )
        for body, place, k in (
            ("pinion", PINION, pair.pinion_support),
            ("gear", GEAR, pair.gear_support),
        ):
            both = (
                modes.energy[j, COMPONENTS.index(f"{body} translation")]
                + modes.energy[j, COMPONENTS.index(f"{body} bending")]
            )
            assert both == pytest.approx(u[place] @ k @ u[place] / total, abs=1e-11)


# -- invariances -------------------------------------------------------------------------------------------------------------
def test_transmission_error_ignores_a_common_rigid_motion(pair):
    # Pinion and gear carried together, each in its own frame about a common apex, keep their teeth
    # as they were.
    n, apex_p, apex_g = (
        pair.pinion_mesh.normal,
        np.array([-0.055, 0.18, 0.0]),
        to_gear_frame([-0.055, 0.18, 0.0]),
    )
    held = replace(
        pair, pinion_mesh=MeshVector(n, apex_p), gear_mesh=MeshVector(to_gear_frame(n), apex_g)
    )
    for motion in np.eye(6):
        q = np.zeros(14)
        q[PINION] = motion
        q[GEAR] = np.concatenate([to_gear_frame(motion[:3]), to_gear_frame(motion[3:])])
        assert abs(held.transmission @ q) < 1e-16
    q[GEAR] *= -1
    assert abs(held.transmission @ q) > 1e-2


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
    k, m = pair.matrices()
    bound, top = rayleigh_bound(k, m), pair.solve().frequency_hz[-1]
    assert 0.5 * top < bound <= top
    assert rayleigh_bound([[4.0, 0], [0, 1]], np.eye(2)) == pytest.approx(
        2 / (2 * np.pi), rel=1e-15
    )


def test_published_masses_contradict_published_frequencies():
    k = np.diag(shaft_stiffness(1.585e10, 1.015e9, 5.14e7, -7.294e7))
    verdict = consistency(k, np.diag(diagonal_mass(14.72, 0.0587, 0.502)), 4139.6)
    assert not verdict.consistent
    # sqrt(1.585e10 / 14.72) / 2 pi, rounded to 0.1 Hz, and the mass that would just do.
    assert verdict.bound_hz == pytest.approx(5222.5, abs=0.06)
    assert verdict.needed_mass == pytest.approx(23.43, abs=0.006)
    assert "impossible" in str(verdict)
    assert consistency(k, np.diag(diagonal_mass(24.4, 0.0587, 0.45)), 4139.6).consistent


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
    assert k.status == m.status == "identified"
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


# -- the thesis --------------------------------------------------------------------------------------------------------------
@pytest.fixture(scope="module")
def thesis():
    from validation.thesis import pair

    return pair


def thesis_errors(thesis, values):
    k = thesis.gear_support()
    found = [thesis.geared_pair(values, case, k).solve().frequency_hz[1:] for case in thesis.CASES]
    return np.concatenate(found) / thesis.ELASTIC - 1


# Identified from both lists at once; see validation/thesis/identification.py.
THESIS = {"pinion torsion": 1.088e4, "gear torsion": 8.63e4, "mesh stiffness": 8.617e8}
MASSES = {"pinion mass": 24.77, "pinion bending inertia": 0.4544}


def test_identified_masses_meet_all_frequencies_of_the_thesis(thesis):
    error = thesis_errors(thesis, THESIS | MASSES)
    assert np.abs(error).max() < 0.055  # 5.0 % on 620.2 Hz, with room for the four digits above
    assert np.abs(error[[0, 1, 13, 14]]).max() < 0.01


def test_published_masses_do_not(thesis):
    assert np.abs(thesis_errors(thesis, THESIS)).max() > 0.25


# -- bad input ---------------------------------------------------------------------------------------------------------------
def with_entry(matrix, i, j, value):
    out = np.array(matrix)
    out[i, j] = out[j, i] = value
    return out


BAD = [
    ("engine_inertia", 0.0, "engine inertia is 0.0"),
    ("engine_inertia", float("nan"), "engine inertia is nan"),
    ("pinion_mass", np.eye(5), "shape (5, 5)"),
    ("pinion_support", np.full((6, 6), np.nan), "NaN"),
    ("mesh_stiffness", -1.0, "mesh stiffness is -1.0"),
    ("pinion_mass", np.diag([1.0, 1, 1, 1, 0, 1]), "has 0 for thy"),
    ("gear_mass", with_entry(np.eye(6), 0, 5, 2.0), "gear mass is not positive definite"),
    ("gear_mass", np.triu(np.ones((6, 6))), "not symmetric"),
    ("pinion_support", shaft_stiffness(1e9, 1e9, 1e6, 1e9), "indefinite"),
    ("gear_support", np.eye(6), "resists thy"),
    ("gear_mesh", [0, 1, 0], "must be a MeshVector"),
]


@pytest.mark.parametrize("name, value, words", BAD, ids=[f"{n}-{w}" for n, _, w in BAD])
def test_bad_pair_is_one_sentence(pair, name, value, words):
    with pytest.raises(SolidgearError, match=re.escape(words)) as caught:
        replace(pair, **{name: value})
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 200


@pytest.mark.parametrize(
    "make, words",
    [
        (lambda: consistency([1.0], [1.0, 2.0], 3.0), "same length"),
        (lambda: consistency([1.0], [0.0], 3.0), "positive"),
        (lambda: torsion_springs(1, 1, 1, 1, 1, 10.0, 10.1), "no torsional springs"),
        (lambda: Unknown("k", 2.0, 1.0), "ascending"),
        (lambda: identify(lambda v: [1.0], [Unknown("k", 1, 2)], [0.0]), "leave out the zero"),
        (
            lambda: identify(lambda v: [1.0], [Unknown("k", 1, 2), Unknown("m", 1, 2)], [1.0]),
            "cannot be identified from 1",
        ),
        (lambda: identify(lambda v: [0.0], [Unknown("k", 1, 2)], [1.0]), "rigid modes"),
    ],
)
def test_bad_arguments_are_one_sentence(make, words):
    with pytest.raises(SolidgearError, match=re.escape(words)) as caught:
        make()
    assert "\n" not in str(caught.value)


def test_a_mesh_that_turns_nothing_is_said_so(pair):
    idle = replace(pair, pinion_mesh=AXIAL, gear_mesh=AXIAL)
    # Engine with pinion and gear with load then turn apart from one another: two zero frequencies.
    assert idle.solve().rigid == 2
    with pytest.raises(SolidgearError, match="transmits no rotation"):
        _ = idle.train_rotation
