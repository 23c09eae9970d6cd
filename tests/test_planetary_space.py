"""Planetary stages whose members have six motions: helical teeth, symmetry, and the locked plane."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import scipy.linalg as sla

import solidgear as sg
from solidgear.core.errors import SolidgearError
from solidgear.core.frames import cross_matrix, rotation, shift
from solidgear.core.reduction.superelement import PortMotion
from solidgear.core.system.gear_mesh import cylindrical_mesh, line_of_action
from tests.test_planetary import frequencies, of_kind, published

# eigenvalues of 36 to 54 coordinates, whose stiffness spans four decades
ROUNDING = 1e-9
PRESSURE, HELIX, FACE = np.radians(20.0), np.radians(16.0), 25e-3
TEETH = sg.PlanetaryTeeth(17, 34, 85, 2.5e-3, pressure_angle=PRESSURE, helix=HELIX)
BASE_HELIX = TEETH.base_helix
SUN_MESH, RING_MESH = 2e8, 3e8
#: mass, about the axis, about a diameter: kg, kg m^2
INERTIA = {
    "sun": (0.4, 9e-5, 7e-5),
    "ring": (2.4, 0.03, 0.016),
    "carrier": (5.0, 0.022, 0.02),
    "planet": (0.7, 7e-4, 5e-4),
}
HELD = {
    "sun": np.diag([1e8, 4e7, 1e8, 2e4, 0.0, 2e4]),
    "ring": np.diag([1e8, 3e8, 1e8, 5e5, 2e7, 5e5]),
    "carrier": np.diag([2e8, 1e8, 2e8, 6e4, 0.0, 6e4]),
}
#: x and z couple with tilting, as on a cantilever; the spin is free
PIN = np.zeros((6, 6))
PIN[np.ix_([0, 5], [0, 5])] = [[1.2e8, 9e5], [9e5, 3e4]]
PIN[np.ix_([2, 3], [2, 3])] = [[0.9e8, -6e5], [-6e5, 2e4]]
PIN[1, 1] = 5e7


def stage(planets=4, helix=BASE_HELIX, face=FACE):
    sun, planet, ring = TEETH.base_radii
    radius = {"sun": sun, "ring": ring, "carrier": TEETH.pin_radius}
    central = [
        sg.CentralMember(*INERTIA[n][:2], radius[n], HELD[n], diametral=INERTIA[n][2])
        for n in ("sun", "ring", "carrier")
    ]
    mass, about, across = INERTIA["planet"]
    one = sg.Planet(mass, about, planet, PIN, SUN_MESH, RING_MESH, diametral=across)
    return sg.PlanetaryStage(*central, one.spaced(planets), PRESSURE, helix, face)


def by_points(azimuths, sun_meshes):
    """Natural frequencies, Hz, from motions of contact points in the axes of the stage alone.

    Teeth by their trace on the pitch cylinder and the pressure angle normal to it, each mesh at
    two points of the face that have its second moment.
    """
    names = ["sun", "ring", "carrier", *range(len(azimuths))]
    size = 6 * len(names)
    mass = np.concatenate(
        [
            [m, m, m, across, about, across]
            for m, about, across in (INERTIA.get(n, INERTIA["planet"]) for n in names)
        ]
    )
    own = {n: np.eye(size)[6 * k : 6 * k + 6] for k, n in enumerate(names)}
    stiffness = sum(own[n].T @ HELD[n] @ own[n] for n in HELD)
    axis = np.array([0.0, 1.0, 0.0])
    to_pin = TEETH.pin_radius
    sun_pitch = TEETH.module * TEETH.sun / 2
    ring_pitch = TEETH.module * TEETH.ring / 2

    def moved(name, arm):
        return own[name][:3] - cross_matrix(arm) @ own[name][3:]

    for k, (psi, sun_mesh) in enumerate(zip(azimuths, sun_meshes)):
        out = np.array([np.cos(psi), 0.0, -np.sin(psi)])
        around = np.cross(axis, out)
        turn = np.kron(np.eye(2), np.column_stack([out, axis, np.cross(out, axis)]))
        carried = np.vstack([moved("carrier", to_pin * out), own["carrier"][3:]])
        apart = turn.T @ (own[k] - carried)
        stiffness = stiffness + apart.T @ PIN @ apart
        normal_pressure = np.arctan(np.tan(PRESSURE) * np.cos(HELIX))
        for mate, pitch, push, hand, mesh in (
            ("sun", sun_pitch, out, 1, sun_mesh),
            ("ring", ring_pitch, -out, -1, RING_MESH),
        ):
            across = np.cos(HELIX) * around - hand * np.sin(HELIX) * axis
            n = np.cos(normal_pressure) * across + np.sin(normal_pressure) * push
            for y in (-FACE / 2 / np.sqrt(3), FACE / 2 / np.sqrt(3)):
                at = pitch * out + y * axis
                row = n @ (moved(mate, at) - moved(k, at - to_pin * out))
                stiffness = stiffness + mesh / 2 * np.outer(row, row)
    return np.sqrt(np.abs(sla.eigvalsh(stiffness, np.diag(mass)))) / (2 * np.pi)


@pytest.mark.parametrize("count", [3, 4, 5, 6])
def test_helical_stages_are_those_of_an_assembly_by_points_and_modes_come_as_symmetry_says(count):
    own = stage(count)
    psi = 2 * np.pi * np.arange(count) / count
    assert frequencies(own)[0] == 0.0
    assert frequencies(own)[1:] == pytest.approx(
        by_points(psi, [SUN_MESH] * count)[1:], rel=ROUNDING
    )
    # Eritenel and Parker: 12, 12 pairs, and 6 of as many as there are planets beyond three; one of
    # the first is the free rotation, in which nothing moves along the axis
    for kind, number, multiplicity in (
        ("rotational", 1, 1),
        ("rotational-axial", 11, 1),
        ("translational-tilting", 12, 2),
        ("planet", 6 if count > 3 else 0, count - 3),
    ):
        assert [m.multiplicity for m in of_kind(own, kind)] == [multiplicity] * number


def test_a_helical_stage_of_unequal_planets_is_that_assembly_too():
    own = stage(5)
    psi = np.array([p.azimuth for p in own.planets]) + [0, 0.1, 0, -0.05, 0]
    meshes = [SUN_MESH, SUN_MESH, SUN_MESH / 2, SUN_MESH, SUN_MESH]
    planets = [replace(p, azimuth=a, sun_mesh=k) for p, a, k in zip(own.planets, psi, meshes)]
    own = replace(own, planets=tuple(planets))
    assert frequencies(own)[1:] == pytest.approx(by_points(psi, meshes)[1:], rel=ROUNDING)
    # four planets are alike: one of the two planet modes at any angles is left
    assert [m.multiplicity for m in of_kind(own, "planet")] == [1] * 6


@pytest.mark.parametrize("count", [3, 5])
def test_spur_teeth_leave_the_plane_to_itself(count):
    """The published stage with all six motions: those in the plane are as if the others were locked."""
    flat = published(count)
    members = {n: getattr(flat, n) for n in ("sun", "ring", "carrier")}
    loose = {
        n: replace(m, bearing=m.support + np.diag([0, 1e7, 0, 1e4, 0, 1e4]), turning=0.0,
                   diametral=0.6 * m.inertia)
        for n, m in members.items()
    }  # fmt: skip
    pin = np.diag([1e8, 2e7, 1e8, 1e4, 0.0, 3e4])
    planets = tuple(replace(p, pin=pin, diametral=0.7 * p.inertia) for p in flat.planets)
    own = replace(flat, **loose, planets=planets, face_width=30e-3)
    for kind in ("rotational", "translational", "planet"):
        found, wanted = of_kind(own, kind), of_kind(flat, kind)
        assert [m.multiplicity for m in found] == [m.multiplicity for m in wanted]
        assert [m.frequency_hz for m in found] == pytest.approx(
            [m.frequency_hz for m in wanted], rel=ROUNDING
        )
    assert [m.multiplicity for m in of_kind(own, "axial")] == [1] * 6
    assert [m.multiplicity for m in of_kind(own, "tilting")] == [2] * 6


def test_modes_of_several_kinds_at_one_frequency_are_told_apart():
    """Without a face width planets of a spur stage tilt on their pins alone, all in one phase or in
    one that central members do not feel."""
    own = stage(5, helix=0.0, face=0.0)
    pin = np.diag(np.diag(PIN))
    own = replace(own, planets=tuple(replace(p, pin=pin) for p in own.planets))
    about_x, about_z = np.sqrt(np.diag(PIN)[[3, 5]] / INERTIA["planet"][2]) / (2 * np.pi)
    for kind, multiplicity in (("axial", 1), ("planet-tilting", 2)):
        found = of_kind(own, kind)
        for hz in (about_x, about_z):
            (alone,) = [m for m in found if abs(m.frequency_hz / hz - 1) < ROUNDING]
            assert alone.multiplicity == multiplicity
    assert not of_kind(own, "mixed")


def test_helical_teeth_push_as_the_textbook_has_it():
    """A right-handed gear that drives about +y is pushed along +y; by the bevel formula at pitch
    angle 0, from the pressure angle normal to the tooth."""
    gear, mate = cylindrical_mesh(0.06, 0.02, PRESSURE, base_helix=BASE_HELIX)
    normal_pressure = np.arctan(np.tan(PRESSURE) * np.cos(HELIX))
    on_gear = line_of_action(0.0, HELIX, normal_pressure, "right", "right", "gear")
    assert on_gear[1] > 0
    assert -gear.normal == pytest.approx(on_gear, abs=1e-15)
    assert gear.point - mate.point == pytest.approx([0.08 / np.cos(PRESSURE), 0, 0])


def test_a_planet_between_helical_meshes_is_tilted_but_not_pushed_along_its_axis():
    force = sum(on_planet.vector for _, on_planet in stage(3).meshes(1).values())
    assert force[[1, 4]] == pytest.approx(0, abs=1e-15)
    assert abs(force[5]) == pytest.approx(
        2 * TEETH.base_radii[1] / np.cos(PRESSURE) * np.sin(BASE_HELIX), rel=1e-12
    )


def test_parts_of_ones_own_make_the_same_stage():
    """Bodies with a port at every planet, anywhere and in axes of its own."""
    own = stage(3)
    parts = {}
    for name in ("sun", "ring", "carrier"):
        member = getattr(own, name)
        ports = {"centre": PortMotion(np.eye(6), np.zeros(3), np.eye(3))}
        for k in (1, 2, 3):
            axes, place = rotation(k - 1, 0.4 * k)[:3, :3], np.array([0.03 * k, 0.01, -0.02])
            rows = np.kron(np.eye(2), axes.T) @ shift(place)
            ports[f"planet {k}"] = PortMotion(rows, place, axes)
        mass, about, across = INERTIA[name]
        body = np.diag([mass, mass, mass, across, about, across])
        part = SimpleNamespace(mass=body, strain=np.zeros((0, 6)), ports=ports)
        parts[name] = sg.CentralMember.of(part, member.radius, member.bearing)
    moved = frequencies(replace(own, **parts))
    assert moved[1:] == pytest.approx(frequencies(own)[1:], rel=ROUNDING)


PIN_THAT_BRAKES = PIN + np.diag([0, 0, 0, 0, 1.0, 0])


@pytest.mark.parametrize(
    "member, changed, words",
    [
        ("planet", {"pin": PIN_THAT_BRAKES}, "the pin of planet 1 resists its spin; row and"),
        ("planet", {"pin": np.diag([1e8, 1e8, 0, 0, 0, 0])}, "planet 1 is on no pin"),
        ("planet", {"pin": np.ones(6)}, r"pin of planet 1 has shape \(6,\); it must be \(6, 6\)"),
        (
            "sun",
            {"diametral": 3e-5},
            "diametral of sun is 3e-05 kg m\\^2; about a diameter no body",
        ),
        ("ring", {"part": sg.Inertia(1.0)}, "the part of ring needs a port 'centre'; it has end"),
        (
            "carrier",
            {"part": sg.Placed(sg.RigidBody(np.eye(6)), origin=[0, 0.02, 0])},
            r"the port 'centre' of the part of carrier is at \[0.0, 0.02, 0.0\] m or turned",
        ),
        ("stage", {"base_helix": 1.6}, "base_helix, its sign apart, is 1.6 rad"),
        ("stage", {"face_width": -1.0}, "face_width is -1.0; it must be finite and not negative"),
    ],
)
def test_what_no_stage_in_space_can_be_is_told_in_one_sentence(member, changed, words):
    own = stage(3)
    with pytest.raises(SolidgearError, match=words):
        if member == "stage":
            replace(own, **changed)
        elif member == "planet":
            replace(own, planets=tuple(replace(p, **changed) for p in own.planets))
        else:
            replace(own, **{member: replace(getattr(own, member), **changed)})
