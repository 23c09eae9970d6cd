"""Planetary stages in axes that turn: closed forms in space, and motion in space by time steps."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import solidgear as sg
from solidgear.core.errors import SolidgearError
from solidgear.core.frames import rotation
from tests.test_planetary import (
    PIN,
    frequencies,
    published,
)
from tests.test_planetary_space import stage

#: turns a second of the carrier, so many that all terms are seen
FAST = 150.0


def hz(stage, *speed):
    return np.array([m.frequency_hz for m in stage.turning_modes(*speed)])


def test_a_carrier_that_stands_still_has_the_modes_it_has():
    for own in (published(4), stage(4)):
        assert hz(own, 0.0) == pytest.approx(frequencies(own), rel=1e-7, abs=1e-4)


def test_a_sun_that_vibrates_in_space_is_seen_a_turn_faster_and_slower():
    """Alone on its bearing, also as a gyroscope: of ``J p^2 - I w p - k = 0`` both roots, less W."""
    own = stage(3)
    loose = tuple(replace(p, sun_mesh=1e-6, ring_mesh=1e-6) for p in own.planets)
    own = replace(own, planets=loose, base_helix=0.0)
    about, sun = 2 * np.pi * FAST, own.sun
    spin = about * (1 + own.ring.radius / own.sun.radius)
    shifts = np.sqrt(sun.bearing[0, 0] / sun.mass) * np.array([1, -1])
    tilts = np.roots([sun.diametral, -sun.inertia * spin, -sun.bearing[3, 3]])
    found = hz(own, FAST)
    for p in (*shifts, *tilts):
        assert np.abs(found / (abs(p - about) / (2 * np.pi)) - 1).min() < 1e-8


def test_a_carrier_with_fast_planets_is_one_gyroscope():
    """Heavy planets of no extent, held fast, make a rotor of ``m R^2`` more; what their centrifugal
    force does where the carrier tilts is as much as its gyroscopic moment."""
    own = stage(3, helix=0.0, face=0.0)
    pin = 1e12 * np.diag([1.0, 1, 1, 1e-7, 0, 1e-7])
    heavy = [
        replace(p, mass=7.0, inertia=1e-7, diametral=6e-8, pin=pin, sun_mesh=1e-6, ring_mesh=1e-6)
        for p in own.planets
    ]
    own = replace(own, planets=tuple(heavy))
    about, carrier = 2 * np.pi * FAST, own.carrier
    more = 3 * 7.0 * carrier.radius**2
    polar, across = carrier.inertia + more, carrier.diametral + more / 2
    tilts = np.roots([across, -polar * about, -carrier.bearing[3, 3]])
    found = hz(own, FAST)
    for p in tilts:  # pins give by some 1e-5
        assert np.abs(found / (abs(p - about) / (2 * np.pi)) - 1).min() < 1e-4


def moved_in_space(own, start, rate, seconds):
    """Coordinates after some time, from motions in space: forces of springs and no others.

    Springs of pins turn with the carrier, however far; they are so short that planets run on the
    radius that the stage tells, and meshes carry nothing but vibration.
    """
    about, radius = 2 * np.pi * FAST, own.carrier.radius
    flat = sg.System(own.parts, {n: x for n, x in own.links.items() if not n.endswith("pin")})
    stiffness, mass = flat.stiffness, np.diag(flat.mass)
    azimuth = np.array([0.0] * 3 + [p.azimuth for p in own.planets])
    place = np.array([0.0] * 3 + [radius] * len(own.planets))
    bodies = len(place)
    force = own.planets[0].mass * about**2 * radius
    length = radius - force / PIN

    def axes(angle):
        """(bodies, 2, 2) own axes of bodies in space, x and z as columns."""
        c, s = np.cos(azimuth + angle), np.sin(azimuth + angle)
        return np.array([[c, s], [-s, c]]).transpose(2, 0, 1)

    def inside(time, motion):
        """Coordinates of the stage from those in space."""
        turned = axes(about * time)
        xz = np.einsum("bij,bi->bj", turned, motion.reshape(bodies, 3)[:, :2])
        xz[:, 0] -= place
        return np.column_stack([xz, motion.reshape(bodies, 3)[:, 2]]).ravel()

    def rates(time, state):
        motion, speed = np.split(state, 2)
        turned = axes(about * time)
        own_force = -(stiffness @ inside(time, motion)).reshape(bodies, 3)
        out = np.column_stack([np.einsum("bij,bj->bi", turned, own_force[:, :2]), own_force[:, 2]])
        body = motion.reshape(bodies, 3)
        arm = body[3:, :2] - body[2, :2]
        pin_axes = axes(about * time + body[2, 2])[3:]
        stretch = np.einsum("bij,bi->bj", pin_axes, arm) - [length, 0.0]
        push = -PIN * np.einsum("bij,bj->bi", pin_axes, stretch)
        out[3:, :2] += push
        out[2, :2] -= push.sum(axis=0)
        out[2, 2] -= (arm[:, 1] * push[:, 0] - arm[:, 0] * push[:, 1]).sum()
        return np.concatenate([speed, out.ravel() / mass])

    turned = axes(0.0)
    xz = start.reshape(bodies, 3)[:, :2] + np.column_stack([place, 0 * place])
    at = np.column_stack([np.einsum("bij,bj->bi", turned, xz), start.reshape(bodies, 3)[:, 2]])
    around = np.column_stack([at[:, 1], -at[:, 0]]) * about
    own_rate = rate.reshape(bodies, 3)
    going = around + np.einsum("bij,bj->bi", turned, own_rate[:, :2])
    first = np.concatenate([at.ravel(), np.column_stack([going, own_rate[:, 2]]).ravel()])
    run = solve_ivp(rates, (0, seconds), first, "DOP853", rtol=1e-12, atol=1e-12)
    return inside(seconds, run.y[: 3 * bodies, -1])


@pytest.mark.parametrize("place, kind", [(2, "translational"), (8, "rotational")])
def test_modes_in_turning_axes_are_motions_in_space(place, kind):
    """By time steps that know of no Coriolis force."""
    own = published(3)
    mode = own.turning_modes(FAST)[place]
    size = 1e-6  # of 0.1 m: what is not linear is 1e-5 of it
    shape = size * mode.shape / np.abs(mode.shape).max()
    rate = 2j * np.pi * mode.frequency_hz
    seconds = 0.7 / mode.frequency_hz
    found = moved_in_space(own, shape.real, (rate * shape).real, seconds)
    wanted = (shape * np.exp(rate * seconds)).real
    assert mode.kind == kind
    assert found == pytest.approx(wanted, abs=1e-4 * size)


def test_a_helical_stage_obeys_the_equations_of_rotors_in_space():
    """Bodies there know of their spin alone, ``J t'' - I w y x t'``; springs turn with the carrier.
    Rates of change from differences of ninth order."""
    own = stage(3)
    about, system = 2 * np.pi * FAST, own.system
    turns = own.ring.radius / np.array([own.sun.radius] + [-p.radius for p in own.planets])
    spins = dict(zip(["sun", "planet 1", "planet 2", "planet 3"], about * (1 + turns)))
    spins["carrier"] = about
    gyroscope = np.zeros((system.size, system.size))
    for name, spin in spins.items():
        place = system.place(name).start
        polar = system.mass[place + 4, place + 4]
        gyroscope[place + 3, place + 5] -= polar * spin
        gyroscope[place + 5, place + 3] += polar * spin
    stiffness = system.stiffness + own.turning_terms(FAST).pull
    weight = np.array([3, -32, 168, -672, 0, 672, -168, 32, -3]) / 840
    curve = np.array([-9, 128, -1008, 8064, -14350, 8064, -1008, 128, -9]) / 5040
    for mode in own.turning_modes(FAST)[4:30:5]:
        rate = 2 * np.pi * mode.frequency_hz
        step = 0.05 / (rate + about)
        time = step * np.arange(-4, 5)
        turn = [np.kron(np.eye(system.size // 6), rotation(1, about * t)) for t in time]
        moved = [a @ (mode.shape * np.exp(1j * rate * t)) for a, t in zip(turn, time)]
        speed, growth = weight @ moved / step, curve @ moved / step**2
        felt = system.mass @ growth + gyroscope @ speed + stiffness @ moved[4]
        assert np.abs(felt).max() < 1e-6 * np.abs(stiffness @ moved[4]).max()


def test_a_free_stage_stays_free_for_its_planets_pull_turns_with_it():
    own = published(3)
    terms = own.turning_terms(FAST)
    turned = own.system.free[:, 0]
    assert (terms.pull - terms.centrifugal) @ turned == pytest.approx(0, abs=1e-6)
    assert turned @ terms.centrifugal @ turned > 0
    first = own.turning_modes(FAST)[0]
    assert (first.kind, first.frequency_hz, first.growth) == ("rotational", 0.0, 0.0)


@pytest.mark.parametrize("own", [published(5), stage(5)], ids=["plane", "space"])
def test_at_speed_pairs_part_and_kinds_stay(own):
    rest = {}
    for mode in own.modes():
        rest[mode.kind] = rest.get(mode.kind, 0) + mode.multiplicity
    turning = own.turning_modes(FAST)
    assert {k: [m.kind for m in turning].count(k) for k in rest} == rest
    (kind,) = [k for k in rest if k.startswith("translational")]
    found = np.array([m.frequency_hz for m in turning if m.kind == kind])
    assert np.diff(found).min() > 1.0
    planets = np.array([m.frequency_hz for m in turning if m.kind == "planet"])
    assert planets[::2] == pytest.approx(planets[1::2], rel=1e-7)
    assert max(abs(m.growth) for m in turning) < 1e-3


def test_a_sun_shifted_in_space_turns_backwards_and_feels_no_inertia():
    own = stage(3)
    terms = own.turning_terms(FAST)
    sun = own.system.place("sun")
    back = np.zeros(6, complex)
    back[[0, 2]] = 1.0, 1j  # times exp(-i W t)
    about = -2 * np.pi * FAST
    mass = own.system.mass[sun, sun]
    felt = -(about**2) * mass + 1j * about * terms.gyroscopic[sun, sun]
    felt = (felt - terms.centrifugal[sun, sun]) @ back
    assert abs(felt).max() < 1e-12 * own.sun.mass * about**2
    ahead = -(about**2) * mass - 1j * about * terms.gyroscopic[sun, sun]
    assert abs((ahead - terms.centrifugal[sun, sun]) @ back).max() > own.sun.mass * about**2


def test_a_speed_that_is_none_is_told():
    own = stage(3)
    with pytest.raises(SolidgearError, match="the carrier turns at nan; give a finite speed"):
        own.turning_terms(np.nan)
