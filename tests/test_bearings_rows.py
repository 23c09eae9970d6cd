"""Rows of balls and rollers: limits, and what a tangent has to be; published displacements and closed
forms are cases of `validation/manual`.
"""

import numpy as np
import pytest

from solidgear.bearings.ball import BallRow
from solidgear.bearings.hertz import line_constant, point_contact
from solidgear.bearings.roller import RollerRow
from solidgear.bearings.rolling import RollingBearing
from solidgear.core.errors import SolidgearError
from solidgear.core.frames import rotation

ANGULAR_218 = BallRow(
    count=16,
    diameter=22.225e-3,
    pitch=125.26e-3,
    angle=np.radians(40.0),
    inner=11.6281 / 22.225,
    outer=11.6281 / 22.225,
    E=206.844e9,
)
TAPERED = RollerRow(
    count=16, diameter=12e-3, length=18e-3, pitch=100e-3, angle=np.radians(15), side=-1
)
ROWS = {
    "angular": ANGULAR_218,
    "groove": BallRow(count=7, diameter=11.5e-3, pitch=43.5e-3, clearance=10e-6, height=0.01),
    "tapered": TAPERED,
    "cylindrical": RollerRow(
        count=13, diameter=9e-3, length=10e-3, pitch=46.5e-3, clearance=10e-6, height=-0.02
    ),
}
row_of_each_kind = pytest.mark.parametrize("row", ROWS.values(), ids=ROWS.keys())


def groove(clearance):
    return RollingBearing((BallRow(count=7, diameter=11.5e-3, pitch=43.5e-3, clearance=clearance),))


def random_motions(n, seed=0):
    """Motions that load some elements and leave others."""
    size = np.array([2e-5, 2e-5, 2e-5, 4e-4, 0.0, 4e-4])
    return np.random.default_rng(seed).normal(size=(n, 6)) * size


def test_published_tilt_under_load():
    # a commercial program's ISO/TS 16281 result, as in validation/manual/cases/bearings.py: it takes
    # half the pitch diameter for the lever of the moment, we the centre of the groove, (2 f_i - 1) D /
    # D_pw = 1.06 % apart, and half as much again where load turns angles
    skew = groove(10e-6).motion([1000.0, 1000.0, 0, 1.0, 0, 0])
    assert np.hypot(skew[0], skew[2]) == pytest.approx(19.7144e-6, rel=1e-3)
    assert skew[1] == pytest.approx(146.3084e-6, rel=1e-3)
    assert np.hypot(skew[3], skew[5]) == pytest.approx(2.7239e-3, rel=0.015)


def test_contact_constant_between_sphere_and_cylinder():
    # crossed cylinders are a sphere on a plane; a slender ellipse approaches its own limit slowly
    sphere = point_contact(200.0, 200.0)
    assert sphere.long == sphere.short
    nearly = point_contact(200.0, 200.0 * (1 + 1e-7))
    assert nearly.constant == pytest.approx(sphere.constant, rel=1e-6)
    slender = point_contact(200.0, 2e-4)
    assert slender.long / slender.short > 1e3


def test_a_radial_row_of_many_rollers_meets_the_load_integral():
    # J of Sjovall: F = n c d^p (1 / 2 pi) integral of cos^(p + 1) over the loaded half
    from scipy.integrate import quad

    row = RollerRow(400, 1e-3, 0.2, length=10e-3, profile="straight")
    integral = quad(lambda t: np.cos(t) ** (19 / 9), -np.pi / 2, np.pi / 2, epsabs=1e-13)[0]
    load = 400 * line_constant(10e-3) * 5e-6 ** (10 / 9) * integral / (2 * np.pi)
    assert row.load(np.array([5e-6, 0, 0, 0, 0, 0]))[0] == pytest.approx(load, rel=1e-6)


@pytest.mark.parametrize("count", [4, 8, 12, 16])
def test_rollers_at_right_angles_to_the_load_carry_nothing_and_stiffen_nothing(count):
    """Pushed towards any roller, those a quarter turn away just touch, whatever rounding says."""
    push = 5e-6
    row = RollerRow(count, 9e-3, 46.5e-3, length=10e-3, profile="straight")
    # by whole numbers: rollers strictly within a quarter turn of the load
    c = np.cos([2 * np.pi * k / count for k in range(-count, count) if 4 * abs(k) < count])
    each = 10 / 9 * line_constant(10e-3) * (push * c) ** (1 / 9)
    for turn in row.azimuth:
        along, across = np.zeros((2, 6))
        along[[0, 2]] = np.cos(turn), np.sin(turn)
        across[[0, 2]] = -np.sin(turn), np.cos(turn)
        motion = push * along
        tangent = row.tangent(motion)
        assert along @ tangent @ along == pytest.approx(each @ c**2, rel=1e-12)
        stiffest = 1e-12 * each.sum()  # of four rollers only one is loaded
        assert across @ tangent @ across == pytest.approx(each @ (1 - c**2), rel=1e-9, abs=stiffest)
        assert np.count_nonzero(row.contacts(motion).load) == len(c)


def test_a_roller_is_in_contact_however_little_the_ring_moves():
    """Rounding is judged by the motion, not by a length: stiffness goes with its ninth root."""
    row = RollerRow(12, 9e-3, 46.5e-3, length=10e-3, profile="straight")
    large, small = (row.tangent(np.array([push, 0, 0, 0, 0, 0])) for push in (1e-6, 1e-15))
    assert np.allclose(10 * small, large, rtol=1e-9, atol=1e-12 * large[0, 0])


def reference_load(row, motion):
    """The same physics written anew, one element at a time, of complex motions as well."""
    x, y, z, tx, _, tz = motion
    total = np.zeros(6, complex)
    for turn in row.azimuth:
        c, s = np.cos(turn), np.sin(turn)
        if isinstance(row, BallRow):
            free = (row.inner + row.outer - 1) * row.diameter
            out = (row.inner - 0.5) * row.diameter
            points = [(out * np.cos(row.angle), out * np.sin(row.angle) * row.side, 0.0)]
        else:
            normal = np.array([np.cos(row.angle), row.side * np.sin(row.angle)])
            points = [(-a * normal[1], a * normal[0], d) for a, d in zip(row.along, row.drop)]
        for outwards, up, drop in points:
            place = np.array([c * (row.pitch / 2 + outwards), row.height + up, 0.0])
            place[2] = s * (row.pitch / 2 + outwards)
            moved = np.array([x, y, z]) + np.cross([tx, 0, tz], place)
            radial, axial = moved[0] * c + moved[2] * s, moved[1]
            if isinstance(row, BallRow):
                radial += free * np.cos(row.angle) - row.clearance / 2
                axial += row.side * free * np.sin(row.angle)
                if row.angle and (row.side * axial).real < 0:
                    axial = 0.0
                length = np.sqrt(radial**2 + axial**2)
                direction, approach = np.array([radial, axial]) / length, length - free
                constant, power = row.constant, 3 / 2
            else:
                approach = normal @ [radial, axial] - row.clearance / 2 * normal[0] - 2 * drop
                direction, constant, power = normal, row.constant / row.slices, 10 / 9
            if approach.real > 0:
                press = constant * approach**power
                force = press * np.array([direction[0] * c, direction[1], direction[0] * s])
                total += np.concatenate([force, np.cross(place, force)])
    return total


@row_of_each_kind
def test_tangent_is_the_derivative_of_a_load_written_anew(row):
    # a complex step of 1e-30 has no truncation and no cancellation
    for motion in random_motions(3, seed=1):
        own = row.load(motion)
        anew = reference_load(row, motion.astype(complex))
        assert np.allclose(own, np.where(np.arange(6) == 4, 0, anew.real), rtol=1e-9, atol=1e-6)
        for k in (0, 1, 2, 3, 5):
            stepped = motion.astype(complex)
            stepped[k] += 1e-30j
            column = reference_load(row, stepped).imag / 1e-30
            column[4] = 0.0  # of thy by rounding
            scale = np.sqrt(np.diag(row.tangent(motion))) * np.sqrt(row.tangent(motion)[k, k])
            assert np.all(np.abs(row.tangent(motion)[:, k] - column) <= 1e-9 * scale.max() + 1e-6)


@row_of_each_kind
def test_tangent_equals_differences_over_random_loads(row):
    motions = random_motions(4_000)
    tangent = row.tangent(motions)
    step = np.array([1e-10] * 3 + [3e-9] * 3)
    # a contact that begins within the step has no derivative there: those motions are left out
    pressed = [row.contacts(motions + d * step).load > 0 for d in (-1, 0, 1)]
    usable = np.all(pressed[0] == pressed[2], axis=1) & np.any(pressed[1], axis=1)
    if isinstance(row, RollerRow):  # of a slice at its onset the slope itself is not smooth
        nearest = np.abs(row._start + motions[:, [0, 1, 2, 3, 5]] @ row._normal.T).min(axis=1)
        usable &= nearest > 1e-8
    else:
        *_, approach = row._stretch(motions)
        usable &= np.where(approach > 0, approach, 1.0).min(axis=1) > 1e-8
    assert usable.sum() > 1000
    scale = np.sqrt(tangent.diagonal(axis1=1, axis2=2).max(axis=0))
    scale[scale == 0] = np.inf  # cylindrical rollers along y
    for k in (0, 1, 2, 3, 5):
        shift = np.zeros(6)
        shift[k] = step[k]
        slope = (row.load(motions + shift) - row.load(motions - shift)) / (2 * step[k])
        gap = np.abs(slope - tangent[:, :, k])[usable] / scale / scale[k]
        assert gap.max() < 1e-6


@row_of_each_kind
def test_tangent_is_symmetric_semidefinite_and_free_in_torsion(row):
    tangent = row.tangent(random_motions(10_000, seed=2))
    assert np.array_equal(tangent, tangent.swapaxes(1, 2))
    assert not tangent[:, 4].any() and not tangent[:, :, 4].any()
    size = np.array([1, 1, 1, 20.0, 20.0, 20.0])  # a radian at 50 mm
    value = np.linalg.eigvalsh(tangent * np.outer(size, size))
    assert np.all(value[:, 0] >= -1e-12 * value[:, -1])
    loaded = np.abs(row.load(random_motions(10_000, seed=2))).max(axis=1) > 0
    assert np.all(value[loaded, -1] > 0) and not value[~loaded].any()


@row_of_each_kind
def test_turning_the_frame_by_one_pitch_changes_nothing(row):
    q = rotation(1, 2 * np.pi / row.count)
    motions = random_motions(20)
    assert np.allclose(row.load(motions @ q.T), row.load(motions) @ q.T, rtol=1e-9, atol=1e-6)
    turned = q @ row.tangent(motions) @ q.T
    assert np.allclose(row.tangent(motions @ q.T), turned, rtol=1e-9, atol=1e-3)


@pytest.mark.parametrize("name, power", [("angular", 1 / 3), ("tapered", 1 / 10)])
def test_stiffness_grows_with_load(name, power):
    # balls: k ~ F^(1/3), until the contact angle turns; rollers: F^(1/10), once the profile is
    # small beside the approach, so straight ones are taken
    row = ROWS[name]
    if name == "tapered":
        row = RollerRow(
            16, 12e-3, 0.1, length=18e-3, angle=np.radians(15), side=-1, profile="straight"
        )
    bearing = RollingBearing((row,))
    loads = row.side * np.geomspace(1e-3, 1e3, 13)
    along = [bearing.tangent(bearing.motion([0, f, 0, 0, 0, 0]))[1, 1] for f in loads]
    assert np.all(np.diff(along) > 0)
    exponent = np.diff(np.log(along)) / np.diff(np.log(np.abs(loads)))
    assert exponent[:2] == pytest.approx(power, rel=2e-3)


def test_what_a_bearing_cannot_carry():
    with pytest.raises(SolidgearError, match="nothing holds it in y"):
        RollingBearing((TAPERED,)).motion([0, 5e3, 0, 0, 0, 0])
    with pytest.raises(SolidgearError, match="no torque about its axis"):
        RollingBearing((TAPERED,)).motion([0, -5e3, 0, 0, 1.0, 0])


def test_random_loads_are_carried():
    pair = RollingBearing(
        tuple(
            RollerRow(16, 12e-3, 0.1, length=18e-3, angle=0.26, side=side, height=0.02 * side)
            for side in (-1, 1)
        )
    )
    rng = np.random.default_rng(5)
    for _ in range(50):
        load = rng.normal(size=6) * [1e4, 1e4, 1e4, 2e2, 0, 2e2] * 10 ** rng.uniform(-3, 1)
        left = np.abs(pair.load(pair.motion(load)) - load).max()
        assert left < 1e-9 * np.abs(load).max()


@pytest.mark.parametrize("case", ["ball_bearing_displacement", "angular_contact_218", "roller_row"])
def test_one_per_cent_of_a_contact_is_not_ok(case, monkeypatch):
    from validation.manual import CASES

    stiffer = {"BallRow": BallRow.constant.func, "RollerRow": RollerRow.constant.func}
    for kind, right in ((BallRow, stiffer["BallRow"]), (RollerRow, stiffer["RollerRow"])):
        monkeypatch.setattr(kind, "constant", property(lambda row, right=right: 1.01 * right(row)))
    (model,) = CASES[case].models
    assert not all(line.ok for line in CASES[case].lines(model, model.solve().values))
