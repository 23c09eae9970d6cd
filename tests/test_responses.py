"""Resonances found in measured responses: where they are, how sure, and what is read of files."""

from __future__ import annotations

import numpy as np
import pytest
from universal_files import nodes, response, units, written

from solidgear.core.errors import SceneError, SolidgearError
from solidgear.measured.data import load_measured, measured_from_responses
from solidgear.measured.modal_fit import fit_modes
from solidgear.measured.universal import Responses, read_universal
from solidgear.parts.universal_units import UNITS

#: frequencies, Hz, and damping ratios; two are 0.5 % apart, one stands at the end of the axis
MODES = [(120.0, 0.01), (333.0, 0.002), (700.0, 0.003), (703.5, 0.003), (1200.0, 0.001)]
MODES += [(1500.0, 0.004), (1990.0, 0.002)]
HERTZ = np.linspace(1.0, 2000.0, 2000)


def accelerances(seed, modes=MODES, points=10, noise=0.01, grows=False, hertz=HERTZ):
    """Responses of modes with shapes at random, and noise: a floor, or one that grows with them."""
    rng = np.random.default_rng(seed)
    s = 2j * np.pi * hertz
    out = np.zeros((points, len(hertz)), complex)
    for frequency, damping in modes:
        pole = 2 * np.pi * frequency * (-damping + 1j * np.sqrt(1 - damping**2))
        shape = rng.uniform(0.3, 1.0, points) * rng.choice([-1.0, 1.0], points)
        out += shape[:, None] * s**2 / ((s - pole) * (s - pole.conjugate()))
    drawn = rng.standard_normal((*out.shape, 2)) @ [1, 1j] / np.sqrt(2)
    rms = np.sqrt(np.mean(np.abs(out) ** 2, axis=1))[:, None]
    return out + noise * (np.abs(out) if grows else rms) * drawn


def off(found, modes=MODES):
    """How far frequencies and damping ratios are from the truth, in their deviations."""
    assert len(found.poles) == len(modes)
    hertz, ratio = np.array(modes).T
    return np.concatenate(
        [
            (found.frequencies - hertz) / found.deviations[0],
            (found.damping - ratio) / found.deviations[1],
        ]
    )


@pytest.mark.parametrize("grows", [False, True])
def test_all_modes_and_no_other_are_found_within_their_deviations(grows):
    away = [off(fit_modes(HERTZ, accelerances(seed, grows=grows))) for seed in range(3)]
    # of frequencies and of damping 21 numbers each: 1 +- 0.15 rms, and beyond 4.5 once in 7,000 such sets
    for numbers in np.split(np.array(away), 2, axis=1):
        assert 0.65 < np.sqrt(np.mean(np.square(numbers))) < 1.45
        assert np.max(np.abs(numbers)) < 4.5


@pytest.mark.slow
@pytest.mark.parametrize("points", [2, 10])
@pytest.mark.parametrize("grows", [False, True])
def test_intervals_of_95_per_cent_hold_95_of_a_hundred(points, grows):
    found = [fit_modes(HERTZ, accelerances(s, points=points, grows=grows)) for s in range(50)]
    right = [one for one in found if len(one.poles) == len(MODES)]
    # with two responses a peak of growing noise is now and then taken for two
    assert len(right) >= 48
    away = [off(one) for one in right]
    # 350 intervals each: 95 % +- 1.2 %
    for numbers in np.split(np.array(away), 2, axis=1):
        assert 0.91 < np.mean(np.abs(numbers) < 1.96) < 0.99


def test_what_polynomials_leave_of_clean_responses_is_no_mode():
    """Five digits of a formula, without noise: a third pole would be as wide as it is unsure."""
    hertz = np.arange(4.0, 6001.0, 4.0)
    modes = ((1496.4, 0.5), (3953.4, 0.4))
    clean = sum(-(hertz**2) * s / (f**2 - hertz**2 + 0.004j * f * hertz) for f, s in modes)
    digits = [float(f"{part:.5e}") for part in np.column_stack([clean.real, clean.imag]).ravel()]
    found = fit_modes(hertz, np.reshape(digits, (1, -1, 2)) @ [1, 1j])
    assert found.frequencies == pytest.approx([1496.4, 3953.4], abs=1e-3)


def test_two_modes_within_their_half_width_are_told_apart_where_they_stand_out():
    near = [(700.0, 0.003), (701.5, 0.003)]
    found = fit_modes(HERTZ[500:900], accelerances(2, near, hertz=HERTZ[500:900]))
    assert np.max(np.abs(off(found, near))) < 4.5


@pytest.mark.long
def test_residues_are_those_of_the_modes_whatever_the_noise_of_each_response():
    clean = accelerances(4, points=5, noise=0.0)
    drawn = np.random.default_rng(9).standard_normal((*clean.shape, 2)) @ [1, 1j]
    levels = np.geomspace(1e-3, 1.0, len(clean))[:, None]
    found = fit_modes(HERTZ, clean + levels * drawn)
    exact = fit_modes(HERTZ, clean)
    assert exact.frequencies == pytest.approx([hertz for hertz, _ in MODES], rel=1e-7)
    quiet = levels[:, 0] < 0.1
    ratio = found.residues[:, quiet] / exact.residues[:, quiet]
    assert np.abs(ratio - 1).max() < 0.02


# ------------------------------------------------------------------------------------------- files
def measured(path, code=5, kind=12, values=None, places=True, directions=(1,)):
    """A universal file of responses, SI values told in the units of a code."""
    length, force = UNITS.get(code, (1e-3, 1e-2))
    values = accelerances(1) if values is None else values
    points = np.arange(3 * len(values)).reshape(3, -1).T / length
    sets = [units(code, 1 / length, 1 / force)] + [nodes(points)] * places
    for k, row in enumerate(values, start=1):
        way = directions[k % len(directions)]
        sets.append(response(k, HERTZ[: len(row)], row * force / length, way, kind))
    return written(path, *sets)


@pytest.mark.parametrize("code", range(1, 10))
def test_responses_in_every_unit_are_the_same(tmp_path, code):
    values = accelerances(1, hertz=HERTZ[:40])[:2]
    found = read_universal(measured(tmp_path / "a.unv", code, values=values))
    # factors of units are written with ten digits
    assert found.values == pytest.approx(values, rel=1e-6)
    assert found.places[2] == pytest.approx((1.0, 3.0, 5.0), rel=1e-6)
    assert found.derivatives == 2 and len(found.frequencies) == 40


def test_a_file_of_responses_is_read_as_its_resonances_with_shapes(tmp_path):
    values = accelerances(1, points=4, noise=1e-4)
    found = load_measured(measured(tmp_path / "a.uff", values=values, directions=(-3, 1)))
    assert [one.frequency for one in found.modes] == pytest.approx([f for f, _ in MODES], abs=0.05)
    # the noise moves them by less than a kelvin does
    assert np.all(found.responses.fit.deviations[0] < 0.05)
    assert all(one.width_hz == pytest.approx(2e-4 * one.frequency, rel=0.1) for one in found.modes)
    # point 1 moved along x, point 2 was measured backwards along z
    fit, shapes = found.responses.fit, found.on_points
    assert shapes.values[:, 0, 0] == pytest.approx(fit.residues[:, 0])
    assert shapes.values[:, 1, 2] == pytest.approx(-fit.residues[:, 1])
    assert not shapes.values[:, 0, 1:].any()
    bare = load_measured(measured(tmp_path / "b.uff", values=values, places=False))
    assert bare.on_points is None and bare.mode == found.mode


def test_a_hammer_that_goes_round_tells_the_shapes_of_a_sensor_that_does():
    values = accelerances(1, points=3, noise=1e-3)
    round_about, fixed = ((1, 1), (2, -3), (3, 2)), ((1, 1),) * 3
    places = {k: (float(k), 0.0, 0.0) for k in (1, 2, 3)}
    sensor, hammer = (
        measured_from_responses(Responses(HERTZ, values, *ends, places, 2)).on_points
        for ends in ((round_about, fixed), (fixed, round_about))
    )
    assert np.array_equal(sensor.values, hammer.values) and sensor.values[:, 1, 2].all()


@pytest.mark.long
def test_receptances_have_the_modes_of_accelerances(tmp_path):
    values = accelerances(1, points=4, noise=1e-4)
    one = load_measured(measured(tmp_path / "a.uff", values=values))
    receptance = values / (2j * np.pi * HERTZ) ** 2
    other = load_measured(measured(tmp_path / "b.uff", kind=8, values=receptance))
    # rounding of two factors that cancel
    assert other.responses.fit.poles == pytest.approx(one.responses.fit.poles, rel=1e-9)


def test_responses_of_a_table_of_numbers(tmp_path):
    path = tmp_path / "a.csv"
    values = accelerances(2, points=2)
    columns = np.column_stack([HERTZ / 1e3, *(part for v in values for part in (v.real, v.imag))])
    head = "frequency [kHz],real,imaginary,real [m/s^2/N],imaginary"
    np.savetxt(path, columns, delimiter=",", header=head, comments="")
    found = load_measured(path)
    assert found.responses.fit.poles == pytest.approx(fit_modes(HERTZ, values).poles, rel=1e-9)
    for text, said in {
        "frequency [Hz],real\n1,2\n": "has other heads",
        "frequency [Hz],real,imaginary\n1,2,\n": "not all numbers",
        "frequency [Hz],real,imaginary\n1,2,3\n": "have 1 lines",
    }.items():
        path.write_text(text)
        with pytest.raises(SceneError, match=said):
            load_measured(path)


def test_noise_alone_has_no_resonance():
    drawn = np.random.default_rng(1).standard_normal((4, 2000, 2)) @ [1, 1j]
    with pytest.raises(SolidgearError, match="no resonance stands out"):
        fit_modes(HERTZ, drawn)
