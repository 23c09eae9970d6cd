"""Planetary stages: the published one of Lin and Parker, an assembly that shares nothing with ours,
and what breaks the symmetry of theirs.
"""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg as sla

import solidgear as sg
from solidgear.core.errors import SolidgearError
from solidgear.core.system.gear_mesh import cylindrical_mesh

# both are eigenvalues of the same 18 to 27 coordinates, whose stiffness spans four decades
ROUNDING = 1e-9
ALPHA = np.radians(24.6)
BASE = {
    "sun": 77.42e-3 / 2,
    "ring": 275.03e-3 / 2,
    "carrier": 176.8e-3 / 2,
    "planet": 100.35e-3 / 2,
}
MASS = {"sun": 0.4, "ring": 2.35, "carrier": 5.43, "planet": 0.66}
#: I / r^2, kg
TURNED = {"sun": 0.39, "ring": 3.00, "carrier": 6.29, "planet": 0.61}
MESH, PIN, BEARING, RING_HELD = 5e8, 1e8, 1e8, 1e9


def published(planets=3):
    """Reducer of the OH-58 (Lin and Parker 1999, table 1)."""
    inertia = {name: TURNED[name] * BASE[name] ** 2 for name in BASE}
    held = {"ring": RING_HELD * BASE["ring"] ** 2}
    central = [
        sg.CentralMember(MASS[n], inertia[n], BASE[n], BEARING, held.get(n, 0.0))
        for n in ("sun", "ring", "carrier")
    ]
    planet = sg.Planet(MASS["planet"], inertia["planet"], BASE["planet"], PIN, MESH, MESH)
    return sg.PlanetaryStage(*central, planet.spaced(planets), ALPHA)


def assembled(azimuths, sun_meshes):
    """Natural frequencies, Hz, by equations 1 to 9 of Lin and Parker (1999) in their coordinates:
    x, y, u = r theta of carrier, ring and sun, then zeta, eta, u of every planet.
    """
    size = 9 + 3 * len(azimuths)
    c, r, s = np.eye(size)[:3], np.eye(size)[3:6], np.eye(size)[6:9]
    mass = np.zeros(size)
    for k, name in enumerate(("carrier", "ring", "sun")):
        mass[3 * k : 3 * k + 3] = MASS[name], MASS[name], TURNED[name]
    springs = [(BEARING, row) for row in (*c[:2], *r[:2], *s[:2])] + [(RING_HELD, r[2])]
    for k, (psi, mesh) in enumerate(zip(azimuths, sun_meshes)):
        mass[9 + 3 * k : 12 + 3 * k] = MASS["planet"], MASS["planet"], TURNED["planet"]
        zeta, eta, u = np.eye(size)[9 + 3 * k : 12 + 3 * k]
        to_sun, to_ring = psi - ALPHA, psi + ALPHA
        springs += [
            (PIN, c[1] * np.sin(psi) + c[0] * np.cos(psi) - zeta),
            (PIN, c[1] * np.cos(psi) - c[0] * np.sin(psi) + c[2] - eta),
            (
                mesh,
                s[1] * np.cos(to_sun) - s[0] * np.sin(to_sun) + s[2]
                - zeta * np.sin(ALPHA) - eta * np.cos(ALPHA) + u,
            ),
            (
                MESH,
                r[1] * np.cos(to_ring) - r[0] * np.sin(to_ring) + r[2]
                + zeta * np.sin(ALPHA) - eta * np.cos(ALPHA) - u,
            ),
        ]  # fmt: skip
    stiffness = sum(k * np.outer(row, row) for k, row in springs)
    return np.sqrt(np.abs(sla.eigvalsh(stiffness, np.diag(mass)))) / (2 * np.pi)


def frequencies(stage):
    return np.concatenate([[m.frequency_hz] * m.multiplicity for m in stage.modes()])


def of_kind(stage, kind):
    return [m for m in stage.modes() if m.kind == kind]


def test_three_planets_have_the_published_frequencies_to_every_digit():
    stage = published()
    rotational = [round(m.frequency_hz, 1) for m in of_kind(stage, "rotational")]
    assert rotational == [0, 1475.7, 1930.3, 2658.3, 7462.8, 11775.3]
    translational = [round(m.frequency_hz, 1) for m in of_kind(stage, "translational")]
    assert translational == [743.2, 1102.4, 1896.0, 2276.4, 6986.3, 9647.9]


@pytest.mark.parametrize("count", [3, 4, 5, 6])
def test_modes_come_in_the_numbers_that_symmetry_gives(count):
    stage = published(count)
    for kind, number, multiplicity in (
        ("rotational", 6, 1),
        ("translational", 6, 2),
        ("planet", 3 if count > 3 else 0, count - 3),
    ):
        assert [m.multiplicity for m in of_kind(stage, kind)] == [multiplicity] * number
    angles = 2 * np.pi * np.arange(count) / count
    assert frequencies(stage)[1:] == pytest.approx(
        assembled(angles, [MESH] * count)[1:], rel=ROUNDING
    )
    assert frequencies(stage)[0] == 0.0


def test_planet_modes_do_not_depend_on_how_many_planets_there_are():
    four, six = (of_kind(published(n), "planet") for n in (4, 6))
    assert [m.frequency_hz for m in four] == pytest.approx(
        [m.frequency_hz for m in six], rel=ROUNDING
    )


def test_a_planet_off_its_angle_splits_every_pair():
    stage = published(4)
    azimuths = [p.azimuth + 0.1 * (k == 1) for k, p in enumerate(stage.planets)]
    planets = tuple(replace(p, azimuth=a) for p, a in zip(stage.planets, azimuths))
    split = replace(stage, planets=planets)
    assert frequencies(split)[1:] == pytest.approx(
        assembled(azimuths, [MESH] * 4)[1:], rel=ROUNDING
    )
    assert not of_kind(split, "translational")
    first, second = [m.frequency_hz for m in split.modes()][1:3]
    assert 1.005 < second / first < 1.02


def test_of_every_pair_one_mode_leaves_a_soft_mesh_alone_and_the_other_falls():
    # one spring less is a change of rank one, and in a pair some shape does not strain it
    stage = published(4)
    meshes = [MESH, MESH / 2, MESH, MESH]
    planets = tuple(replace(p, sun_mesh=k) for p, k in zip(stage.planets, meshes))
    split = replace(stage, planets=planets)
    azimuths = [p.azimuth for p in planets]
    assert frequencies(split)[1:] == pytest.approx(assembled(azimuths, meshes)[1:], rel=ROUNDING)
    pairs = [m.frequency_hz for m in of_kind(stage, "translational")]
    left = of_kind(split, "translational")
    assert [m.frequency_hz for m in left] == pytest.approx(pairs, rel=ROUNDING)
    assert {m.multiplicity for m in left} == {1}


def test_an_internal_mesh_pushes_the_mate_inwards_and_turns_both_alike():
    # force on the mate, along the line of action, of a gear that drives about +y: mate on its +x side
    for internal, inwards, lever in ((False, -1, -0.02), (True, 1, 0.02)):
        gear, mate = cylindrical_mesh(0.06, 0.02, ALPHA, internal=internal)
        assert np.array_equal(gear.normal, mate.normal)
        assert gear.normal == pytest.approx([-inwards * np.sin(ALPHA), 0, -np.cos(ALPHA)])
        assert (gear.lever, mate.lever) == pytest.approx((0.06, lever))


def test_both_points_of_a_mesh_lie_on_one_line_where_circles_and_axes_fit():
    for internal, distance in ((False, 0.08), (True, 0.04)):
        gear, mate = cylindrical_mesh(0.06, 0.02, ALPHA, 0.7, internal=internal)
        axis = distance / np.cos(ALPHA) * np.array([np.cos(0.7), 0, -np.sin(0.7)])
        assert np.cross(axis + mate.point - gear.point, gear.normal) == pytest.approx(0, abs=1e-15)


@pytest.mark.parametrize(
    "changed, words",
    [
        ({"pin": 0.0}, "planet 1 is on no pin: its stiffness is 0.0 N/m"),
        ({"sun_mesh": 0.0}, "sun_mesh is 0 N/m for every planet"),
        ({"radius": 0.2}, "a ring is larger than what turns in it"),
        ({"mass": -1.0}, "mass of planet 1 is -1.0; it must be finite and positive"),
    ],
)
def test_a_planet_that_cannot_be_is_told_in_one_sentence(changed, words):
    stage = published()
    planets = tuple(replace(p, **changed) for p in stage.planets)
    with pytest.raises(SolidgearError, match=words):
        replace(stage, planets=planets)


def test_two_planets_at_one_angle_are_refused():
    stage = published()
    planets = (*stage.planets, replace(stage.planets[0], azimuth=2 * np.pi))
    with pytest.raises(SolidgearError, match="planet 1 and planet 4 are at one angle"):
        replace(stage, planets=planets)


def test_three_pressure_angles_are_refused():
    with pytest.raises(SolidgearError, match="give one, or that of the meshes with the sun"):
        replace(published(), pressure_angle=(0.4, 0.4, 0.4))
