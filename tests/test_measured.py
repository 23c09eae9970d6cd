"""Measured resonances: read, laid beside computed modes, and what is identified from them."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from command import command

import solidgear as sg
from solidgear.core.body import as_supports
from solidgear.core.judge.bounded import mode_bars
from solidgear.core.loading import scene_of
from solidgear.core.plain import plain
from solidgear.core.scene.paths import keys_of, with_entry
from solidgear.core.scene.toml_file import parse
from solidgear.core.scene.uncertain import with_ranges
from solidgear.measured.alignment import Peak, ShapeLikeness, align
from solidgear.measured.computed import Computed, computed_up_to
from solidgear.measured.correlate import SURE, correlate
from solidgear.measured.data import Measured, load_measured
from solidgear.measured.fit import Fit, varied_of
from solidgear.measured.identify import Sprung, identify
from solidgear.measured.same_part import Common
from solidgear.variants.sensitivity.adjoint import mode_form
from solidgear.variants.sensitivity.derivatives import Derivatives

ROD = """
material = { E = "200 GPa", nu = 0.3, density = "7850 kg/m^3" }
segment = [{ kind = "cylinder", name = "rod", length = "0.6 m", diameter = "20 mm" }]
port = { at = "rod.middle", attach_to = "rod" }
"""
SHAFT = "geometry/shaft_stepped.toml"


@pytest.fixture
def rod(tmp_path):
    path = tmp_path / "rod.toml"
    path.write_text(ROD)
    return path


def drawn(rng, count=14, shift=0.02, scatter=0.003):
    """Computed modes, a third of them pairs, and what a careful measurement finds of them."""
    logs = np.cumsum(rng.exponential(0.12, count)) + 3.0
    computed = [Peak(float(x), 1e-4, 2 if rng.random() < 0.4 else 1) for x in logs]
    moved = [float(x + shift + scatter * rng.standard_normal()) for x in logs]
    measured = [Peak(x, 5e-4, one.multiplicity) for x, one in zip(moved, computed)]
    return computed, measured


def told(measured, computed, truth):
    """Wrong pairs that are told as sure; the truth is the mode of each resonance, or None."""
    order = sorted(range(len(measured)), key=lambda i: measured[i].log_frequency)
    found = align([measured[i] for i in order], computed)
    return [
        (i, j)
        for row, i in zip(found.pairs, order)
        for j in np.flatnonzero(row >= SURE)
        if truth[i] != j
    ], found


@pytest.mark.parametrize(
    "slip",
    [
        "none",
        "swapped",
        *(
            pytest.param(s, marks=pytest.mark.long)
            for s in ("missing", "spurious", "split", "unknown multiplicity")
        ),
    ],
)
def test_pairs_that_are_told_as_sure_are_right(slip):
    rng = np.random.default_rng(7)
    wrong = sure = 0
    for _ in range(25):
        computed, measured = drawn(rng)
        truth = list(range(len(computed)))
        at = int(rng.integers(2, len(computed) - 2))
        if slip == "missing":
            del measured[at], truth[at]
        elif slip == "spurious":
            where = rng.uniform(measured[2].log_frequency, measured[-3].log_frequency)
            measured.insert(at, Peak(float(where), 5e-4, 1))
            truth.insert(at, None)
        elif slip == "split":
            pair = next(k for k, one in enumerate(computed) if one.multiplicity == 2)
            one = replace(measured[pair], multiplicity=1)
            measured[pair : pair + 1] = [one, replace(one, log_frequency=one.log_frequency + 1e-3)]
            truth[pair : pair + 1] = [pair, pair]
        elif slip == "swapped":
            # nearer than what scatters them: nobody can tell which is which
            alike = replace(computed[at], log_frequency=computed[at].log_frequency + 1e-3)
            computed[at + 1] = alike
            low, high = sorted([measured[at].log_frequency, measured[at].log_frequency + 2e-3])
            measured[at : at + 2] = [replace(measured[at], log_frequency=f) for f in (low, high)]
            truth[at : at + 2] = [at + 1, at]
        elif slip == "unknown multiplicity":
            measured = [replace(one, multiplicity=None) for one in measured]
        found, alignment = told(measured, computed, truth)
        wrong += len(found)
        sure += int((alignment.pairs >= SURE).sum())
    # a probability of 95 % and more may be wrong once in twenty
    assert wrong <= 0.02 * sure
    assert sure > 0.75 * 25 * (11 if slip == "swapped" else 13)


def test_two_modes_are_under_one_peak_where_it_is_as_wide_as_they_are_apart():
    def shares(gap, wide=2e-3):
        rest = (0.7, 1.0, 1.3, 1.6, 1.9)
        modes = [Peak(x, 1e-4, 1, "", wide) for x in (0.0, 0.3, 0.3 + gap, *rest)]
        return align([Peak(x, 1e-4) for x in (0.0, 0.3, *rest)], modes).pairs[1, 1:3]

    assert shares(3e-4).min() > 0.7
    # the second one was missed
    assert shares(6e-3) == pytest.approx([1.0, 0.0], abs=0.1)
    # but not at a damping ratio of 1 %
    assert shares(6e-3, 2e-2).min() > 0.2


def test_modes_scatter_as_far_as_the_scene_says_of_its_bearings():
    scene = sg.load("geometry/shaft_stepped.toml")
    body = sg.build(scene, "timoshenko")
    modes = tuple(m for m in sg.modes(body, scene, n=4).modes if m.frequency_hz > 0)

    def widths(said):
        told = with_ranges(
            scene, {f"bearing.{b.name}.stiffness": said for b in scene.bearings if said}
        )
        return Computed(told, body, modes, (0.0,) * len(modes), "", {}, 0.0).widths(0.2)

    usual = widths("")
    assert usual.max() > 1e-3
    assert widths("± 20 %") == pytest.approx(usual, rel=0.02)  # 1.2 and 0.8 as logarithms
    # equally likely anywhere from half to twice
    assert widths("0.5 : 2") == pytest.approx(usual * math.log(4) / 12**0.5 / 0.2)


def test_two_modes_that_changed_places_are_told_apart_by_multiplicity():
    computed = [Peak(0.0, 1e-4, 1), Peak(0.3, 1e-4, 1), Peak(0.303, 1e-4, 2), Peak(0.7, 1e-4, 1)]
    measured = [
        Peak(0.0, 1e-4, 1),
        Peak(0.3005, 1e-4, 2),
        Peak(0.3025, 1e-4, 1),
        Peak(0.7, 1e-4, 1),
    ]
    pairs = align(measured, computed).pairs
    assert pairs[1].argmax() == 2 and pairs[2].argmax() == 1


def test_three_modes_in_another_order_are_told_apart_by_their_shapes():
    modes = [Peak(x, 0.1, 1, "bending") for x in (0.0, 0.03, 0.2)] + [Peak(1.0, 1e-3, 1)]
    mac = np.full((4, 4), 0.05)
    right = [1, 2, 0, 3]  # as no neighbours changing places make it
    mac[range(4), right] = 0.998
    seen = ShapeLikeness(mac, 30, np.ones(4, int), 0.05)
    found = align([replace(mode, width=1e-3) for mode in modes], modes, seen)
    assert found.pairs.argmax(axis=1).tolist() == right
    assert found.pairs[range(4), right].min() > SURE


def shaped(x, components=30, noise=0.05, span=1):
    """How like one shape is two modes, of which it is `x` short of the first and 0.99 of the other."""
    mac = np.array([[1 - x, 0.01]])
    return ShapeLikeness(mac, components, np.array([span, span]), noise)


def test_a_shape_is_its_modes_as_far_as_its_noise_says():
    near = [Peak(0.0, 1e-4, 1, "bending"), Peak(0.003, 1e-4, 1, "bending")]

    def logs(*about, modes=near, scatter=1e-6):
        return shaped(*about).log_likelihoods(modes, scatter)[0]

    # noise leaves 1 - MAC = 0.05^2 of a shape: there it speaks for the mode, and less where noise
    # cannot explain it, of a clean measurement sooner
    assert logs(0.0025)[0] > 30
    assert logs(0.02)[0] < logs(0.0025)[0] and logs(0.02, 30, 0.02)[0] < logs(0.02, 30, 0.1)[0]
    # another mode is worse than none, but points may be numbered otherwise
    assert math.log(1.1e-4) > logs(0.0025)[1] >= math.log(1e-4)
    # two components of three are a pair's by chance
    assert logs(0.0025, 3, 0.05, 2)[0] < 7
    # near neighbours of a family mix by what scatters frequencies, and no others do
    assert logs(0.2, scatter=1e-3)[0] > logs(0.2)[0] + 5
    other = [near[0], replace(near[1], family="torsion")]
    assert logs(0.2, modes=other, scatter=1e-3)[0] == logs(0.2)[0]


def test_probabilities_add_up():
    computed, measured = drawn(np.random.default_rng(3))
    found = align(measured, computed)
    # of a peak under which two modes lie both pairs count
    assert np.all(found.pairs.sum(axis=1) + found.spurious > 1 - 1e-9)
    assert np.all(found.pairs <= 1 + 1e-9) and found.shift == pytest.approx(0.02, abs=0.003)


def test_a_mode_that_hangs_on_its_bearing_is_as_unsure_as_that_one(tmp_path):
    path = tmp_path / "rod.toml"
    bearing = (
        '{ name = "A", position = "0.3 m", seat_width = "5 mm", stiffness = { kyy = "1e5 N/m" } }'
    )
    path.write_text(ROD + f"bearing = [{bearing}]\n")
    computed = computed_up_to(sg.load(path), 2700.0, 1e-2)
    widths = dict(zip((str(mode.name) for mode in computed.modes), computed.widths(0.2)))
    # f goes with the root of a stiffness that all energy is in; no spring holds torsion
    assert widths["axial 1"] == pytest.approx(0.1, rel=1e-3) and widths["torsion 1"] < 1e-9


def test_what_is_common_to_few_pairs_has_wide_intervals():
    found = Common.of([0.010, 0.012, 0.014])
    # tables: chi-square of two is between 0.05064 and 7.378 with 95 %, Student's t within 4.303
    assert (found.off, found.scatter) == pytest.approx((0.012, 0.002))
    assert found.low == pytest.approx(0.002 * math.sqrt(2 / 7.378), rel=1e-3)
    assert found.high == pytest.approx(0.002 * math.sqrt(2 / 0.05064), rel=1e-3)
    assert found.reach == pytest.approx(4.303 * 0.002 / math.sqrt(3), rel=1e-3)
    assert found.sentence.startswith("Common shift +1.2 ± 0.5 %")
    assert Common.of([0.01, 0.02]) is None
    assert Common.of([0.01, -0.012, 0.002]).sentence.startswith("No common shift")


# ------------------------------------------------------------------------------------- what is read
def test_units_and_uncertainties_of_a_table(tmp_path):
    path = tmp_path / "peaks.csv"
    path.write_text(
        "frequency [kHz],uncertainty [Hz],multiplicity,name\n1.5,2,2,bending 1\n3,,1,\n"
    )
    one, other = load_measured(path).modes
    assert (one.frequency, one.width_hz, one.multiplicity, one.name) == (
        1500.0,
        2.0,
        2,
        "bending 1",
    )
    assert other.width_hz is None
    toml = tmp_path / "peaks.toml"
    toml.write_text('uncertainty = "0.1 %"\nmode = [{ frequency = "1.5 kHz" }]')
    assert load_measured(toml).modes[0].width_hz == pytest.approx(1.5)


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("a.csv", "frequency,multiplicity\n1,2\n", "has no unit"),
        (
            "a.csv",
            "frequency [Hz]\n3\n2\n",
            r"mode\[2\].frequency .* below the one before it, 3 Hz",
        ),
        ("a.csv", "hz [Hz]\n3\n", "column .* is unknown"),
        ("a.csv", "", "holds no resonances"),
        ("a.toml", 'mode = [{ frequency = "3" }]', "has no unit"),
        ("a.toml", "mode = [{ frequency = 3, uncertainty = 0 }]", "must be greater than zero"),
        ("a.toml", "mode = [{ frequency = 3, multiplicity = 3 }]", "multiplicity"),
        ("a.toml", "mode = []", "holds 0 resonances"),
        ("nowhere.csv", None, "cannot be read"),
    ],
)
def test_bad_data_end_in_a_sentence(tmp_path, name, text, said):
    path = tmp_path / name
    if text is not None:
        path.write_text(text)
    with pytest.raises(sg.SceneError, match=said) as caught:
        load_measured(path)
    assert str(path) in str(caught.value)


# ------------------------------------------------------------------------------------- correlation
def test_a_rod_is_held_against_the_theory_of_rods(rod):
    """Torsion and extension of a slender free rod are c / 2 L: exact for one, and but for what it
    narrows for the other.
    """
    speeds = {"torsion": math.sqrt(200e9 / 2.6 / 7850), "axial": math.sqrt(200e9 / 7850)}
    exact = {f"{name} 1": c / 1.2 for name, c in speeds.items()}
    modes = [
        {"frequency": f, "name": n.split()[0]} for n, f in sorted(exact.items(), key=lambda x: x[1])
    ]
    found = correlate(sg.load(rod), Measured(uncertainty=1e-5, mode=modes), 1e-4)
    by_name = {str(pair.computed.name): pair for pair in found.pairs}
    assert by_name.keys() == exact.keys()
    assert abs(by_name["torsion 1"].relative) < by_name["torsion 1"].band < 1.2e-4
    # (nu n pi r / L)^2 / 4 of Rayleigh's theory: 6e-5
    assert by_name["axial 1"].relative == pytest.approx(-6.2e-5, abs=2e-5)
    assert all(mode.name.startswith("bending") for mode, _ in found.missed)


def test_a_resonance_far_below_all_modes_has_none_and_data_without_a_number_say_so(rod):
    found = correlate(sg.load(rod), Measured(uncertainty=1e-3, mode=[{"frequency": 11.0}]))
    (pair,) = json.loads(json.dumps(found.results, allow_nan=False))["pairs"]
    assert pair["mode"] is None and found.results["rms"] is None


# ---------------------------------------------------------------------------------- identification
@pytest.mark.long
def test_derivatives_are_those_of_solutions_on_either_side():
    tables, step = parse(SHAFT), 1e-3

    def solved(path, value):
        scene = scene_of(with_entry(tables, keys_of(path, tables), value), SHAFT)
        body = sg.build(scene, "harmonic", order=2)
        found = [m for m in sg.modes(body, scene, n=8).modes if m.frequency_hz > 0]
        return scene, body, found, np.array([m.frequency_hz for m in found])

    scene, body, found, hertz = solved("material.nu", 0.3)
    forms = [mode_form(body, as_supports(scene), mode) for mode in found]
    by = Derivatives(scene, body, forms, "harmonic", {"order": 2}).by
    for path, value in {
        "material.nu": 0.3,
        "material.E": 207e9,
        "bearing.A.stiffness.kyy": 2e8,
    }.items():
        low, high = (solved(path, value * math.exp(x)) for x in (-step, step))
        own = by(low[0], high[0], 2 * step) / hertz
        # of second order in the step
        assert own == pytest.approx(np.log(high[3] / low[3]) / (2 * step), abs=1e-6), path
    assert len(found) >= 5


def test_a_body_that_is_not_solved_again_knows_its_frequencies_on_other_springs():
    scene = sg.load(SHAFT)
    before = computed_up_to(scene, 3000.0, 1e-2)
    other = scene.with_bearing_scale(1.3)
    hertz, motions = Sprung(before).modes_on(as_supports(other))
    there = sg.modes(before.body, other, n=30)
    solved = {str(m.name): m.frequency_hz for m in there.modes}
    moved = [abs(solved[str(m.name)] / m.frequency_hz - 1) for m in before.modes]
    # the modes that were solved and static deflections span those nearby: to a hundredth of what
    # the springs move
    for mode, own in zip(before.modes, hertz):
        assert own == pytest.approx(solved[str(mode.name)], rel=1e-2 * max(moved)), mode.name
    assert max(moved) > 0.02 and motions.any()


@pytest.mark.long
def test_a_modulus_is_found_and_its_deviation_is_that_of_the_data(rod):
    scene = sg.load(rod)
    body = sg.build(scene, "harmonic", order=5)
    modes = [m for m in sg.modes(body, scene, n=12).modes if m.frequency_hz > 0]
    rng, off = np.random.default_rng(5), []
    for _ in range(2):
        noisy = sorted(m.frequency_hz * math.exp(1e-3 * rng.standard_normal()) for m in modes)
        peaks = Measured(uncertainty=1e-3, mode=[{"frequency": 1.01 * f} for f in noisy])
        found = identify(rod, peaks, ["material.E"], tol=3e-3)
        one = found["material.E"]
        off.append(math.log(one.value / (200e9 * 1.01**2)) / one.deviation)
        # f goes with the root of E: twice the deviation of a mean of so many
        assert one.deviation == pytest.approx(2e-3 / math.sqrt(len(modes)), rel=0.6)
    assert max(map(abs, off)) < 3.5


def test_what_the_data_do_not_tell_is_refused_with_its_direction(rod):
    peaks = Measured(uncertainty=1e-3, mode=[{"frequency": f} for f in (251.0, 688.0, 1342.0)])
    with pytest.raises(
        sg.SolidgearError, match="cannot separate material.E up and material.density up"
    ):
        identify(rod, peaks, ["material.E", "material.density"])
    with pytest.raises(sg.SolidgearError, match="fewer than the 4 entries"):
        paths = ["material.E", "material.nu", "material.density", "segment.rod.length"]
        identify(rod, peaks, paths)


PEAKS = Measured(uncertainty=1e-3, mode=[{"frequency": f} for f in (254.4, 699.1, 1363.7)])


def test_bounds_hold_a_value_and_say_so(rod):
    found = identify(rod, PEAKS, ["material.E=180 GPa : 205 GPa"], tol=0.01)
    one = found["material.E"]
    # the data ask for 210 GPa
    assert one.value == pytest.approx(205e9) and one.high == pytest.approx(205e9)
    assert any("at its bound" in sentence for sentence in found.sentences)
    free = identify(rod, PEAKS, ["material.E=180 GPa : 220 GPa"], tol=0.01)["material.E"]
    assert free.low < 210e9 < free.high and not free.at_bound


def test_a_resonance_that_no_other_tells_is_predicted_from_none(rod):
    one = Measured(uncertainty=1e-3, mode=[{"frequency": 254.4}])
    found = identify(rod, one, ["material.E"], tol=0.01)
    assert found.fitted[0].left_out is None and found.rms_left_out is None
    assert any("bending 1 would be fitted by any value" in one for one in found.sentences)
    json.dumps(plain(found), allow_nan=False)


def test_what_is_known_beforehand_stands_where_the_data_tell_nothing(rod):
    """E over density is all that a free body tells."""
    found = identify(rod, PEAKS, ["material.E", "material.density=7700 kg/m^3 ± 0.5 %"], tol=0.01)
    density, modulus = found["material.density"], found["material.E"]
    assert density.value == pytest.approx(7700, rel=1e-4)
    assert density.deviation == pytest.approx(0.005, rel=0.01)
    alone = identify(rod, PEAKS, ["material.E"], tol=0.01)["material.E"]
    assert modulus.value == pytest.approx(alone.value * 7700 / 7850, rel=1e-3)
    assert modulus.deviation == pytest.approx(math.hypot(alone.deviation, 0.005), rel=0.05)
    assert any("do not determine material.density" in sentence for sentence in found.sentences)


@pytest.mark.long
def test_data_and_what_was_known_are_weighed_by_their_deviations(rod):
    alone = identify(rod, PEAKS, ["material.E"], tol=0.01)["material.E"]
    rod.write_text(ROD + '[uncertain]\n"material.E" = "200 GPa ± 2 %"\n')
    both = identify(rod, PEAKS, ["material.E"], tol=0.01, priors=True)["material.E"]
    weights = 1 / alone.deviation**2, 1 / 0.02**2
    mean = np.average(np.log([alone.value, 200e9]), weights=weights)
    # to second order in what is between them
    assert math.log(both.value) == pytest.approx(mean, abs=1e-4)
    assert both.deviation == pytest.approx(sum(weights) ** -0.5, rel=0.02)


#: bearings that are nearly alike; kzz of each is to be found
ALIKE = """
material = { E = "207 GPa", nu = 0.3, density = "7850 kg/m^3" }
segment = [
  { kind = "cylinder", name = "a", length = 0.0846, diameter = 0.0635 },
  { kind = "cylinder", name = "b", length = 0.1477, diameter = 0.0518 },
  { kind = "cylinder", name = "c", length = 0.1114, diameter = 0.0661 },
  { kind = "cylinder", name = "d", length = 0.1143, diameter = 0.0462 },
]
bearing = [
  { name = "A", position = 0, from = "a.middle", seat_width = 0.02, stiffness = { kxx = 4.5e7, kyy = 2e8, kzz = %g } },
  { name = "B", position = 0, from = "d.middle", seat_width = 0.02, stiffness = { kxx = 6.2e8, kyy = 2e8, kzz = %g } },
]
port = { at = "b.middle", attach_to = "b" }
"""


def test_modes_may_have_changed_places_where_entries_can_move_them_so(rod):
    computed = computed_up_to(sg.load(rod), 1400.0, 1e-2)
    hertz = [mode.frequency_hz for mode in computed.modes[:3]]
    measured = Measured(uncertainty=1e-3, mode=[{"frequency": f} for f in hertz])
    x, keys = np.zeros(2), ("material.E", "material.density")
    springs = varied_of(keys, parse(str(rod)))
    # each of two entries moves one mode: bending 2 and 3
    rows = np.array([[0.0, 0.0], [0.4, 0.0], [0.0, 0.4]] + [[0.0, 0.0]] * 9)
    exchanged = Fit(measured, springs, x, computed, rows[: len(computed.modes)], 0.9).exchanges(6.0)
    gap = math.log(hertz[2] / hertz[1])
    # what no search reaches takes no place
    assert not Fit(measured, springs, x, computed, rows[: len(computed.modes)], 0.9).exchanges(1.0)
    assert len(exchanged) == 1 and exchanged[0] == pytest.approx([gap / 0.4, -gap / 0.4])
    # a modulus moves all alike
    rows = np.full((len(computed.modes), 1), 0.5)
    assert not Fit(measured, springs[:1], x[:1], computed, rows, 0.9).exchanges(6.0)


def test_a_mode_without_a_resonance_may_take_one_that_was_left_out(rod):
    computed = computed_up_to(sg.load(rod), 1400.0, 1e-2)
    hertz = [mode.frequency_hz for mode in computed.modes[:3]]
    far = [*hertz[:2], 1.2 * hertz[2]]
    measured = Measured(uncertainty=1e-3, mode=[{"frequency": f} for f in far])
    springs = varied_of(("material.E", "material.density"), parse(str(rod)))
    rows = np.zeros((len(computed.modes), 2))
    rows[1, 0] = rows[2, 1] = 0.4
    fit = Fit(measured, springs, np.zeros(2), computed, rows, 0.9)
    assert [j for _, j in fit.pairs] == [0, 1]
    moved = [change for change in fit.exchanges(6.0) if abs(change[0]) < 0.01]
    assert len(moved) == 1 and moved[0][1] == pytest.approx(math.log(1.2) / 0.4)


@pytest.mark.long
def test_bars_of_a_list_that_is_cut_rest_on_what_was_solved_above_it(rod):
    scene = sg.load(rod)
    body = sg.build(scene, "harmonic", order=3)
    whole, cut = (sg.modes(body, scene, n=9, max_frequency=f) for f in (None, 2000.0))
    assert {m.name for m in cut.solved} == {m.name for m in whole.solved}
    assert max(cut.frequency_hz) < 2000.0 < min(m.frequency_hz for m in cut.above)
    own, every = (mode_bars(scene, body, as_supports(scene), found) for found in (cut, whole))
    assert own and all(bar == pytest.approx(every[name]) for name, bar in own.items())


@pytest.mark.slow
def test_two_bearings_that_may_have_changed_places_are_told(tmp_path):
    """Each bearing has a mode of its own near 3.2 kHz; either may be the lower one."""
    true, path = (9.8e8, 8.7e8), tmp_path / "shaft.toml"
    path.write_text(ALIKE % true)
    scene = sg.load(path)
    modes = sg.modes(sg.build(scene, "harmonic", order=4), scene, n=12).modes
    listed = [{"frequency": m.frequency_hz, "multiplicity": 1} for m in modes if m.frequency_hz > 0]
    path.write_text(ALIKE % (8.5e8, 8.1e8))
    keys = [f"bearing.{name}.stiffness.kzz" for name in "AB"]
    # of a measurement that is not careful both fit
    found = identify(path, Measured(uncertainty=2e-3, mode=listed), keys, tol=1e-3)
    answers = [[one.value for one in found.entries], *found.alike]
    nearest = min(answers, key=lambda one: abs(one[0] - true[0]))
    assert nearest == pytest.approx(true, rel=2e-3)
    assert len(answers) > 1 and any("Not the only answer" in one for one in found.sentences)


@pytest.mark.parametrize(
    ("vary", "said"),
    [
        ([], "nothing is varied"),
        (["material.E=180 mm : 220 mm"], "is not a unit of pressure"),
        (["material.E=180 GPa"], "must be two ends"),
        (["material.E=1 : 2"], "bounds must contain the file's value"),
        (["material.E=± 200 %"], "must be two ends above zero"),
        (["material.e"], "is not in the file"),
        (["material.E", "material.E"], "given twice"),
        (["port.at"], "is .rod.middle"),
    ],
)
def test_what_cannot_be_varied_ends_in_a_sentence(rod, vary, said):
    peaks = Measured(mode=[{"frequency": 250.0}])
    with pytest.raises(sg.SolidgearError, match=said):
        identify(rod, peaks, vary)


def test_commands_tell_and_write_what_they_found(rod, tmp_path):
    peaks = tmp_path / "peaks.csv"
    peaks.write_text("frequency [Hz]\n254.4\n699.1\n1363.7\n")
    out = tmp_path / "out"
    told = command("correlate", rod, peaks, "-o", out)
    assert told.exit_code == 0 and "3 of 3 measured resonances have a mode" in told.output
    data = json.loads((out / "correlation.json").read_text())
    assert [pair["mode"] for pair in data["pairs"]] == ["bending 1", "bending 2", "bending 3"]
    assert (out / "off.png").stat().st_size > 1000 and (out / "correlation.html").exists()
    told = command("identify", rod, peaks, "--vary", "material.E", "--predict", "2", "--json")
    data = json.loads(told.output)
    assert data["entries"][0]["value"] == pytest.approx(209.9e9, rel=0.002)
    # (254.4 Hz over bending 1 of 200 GPa) squared is 1.0495; bending 4 of a rod this slender, and torsion 1 or axial 1 are above
    assert data["predicted"][0]["name"] == "bending 4"


@pytest.mark.long
def test_a_mode_has_one_name_whatever_solid_finds_it():
    """Of a short cylinder two modes that are even around the axis swell more than they stretch."""
    scene = sg.load("validation/experiments/steel_cylinder.toml")
    found = []
    for model, options in (("harmonic", {"order": 4}), ("solid", {"refinement": 0.6})):
        modes = sg.modes(sg.build(scene, model, **options), scene, n=44).modes
        found.append([str(m.name) for m in modes if m.waves == 0 and m.frequency_hz > 0][:5])
    assert found[0] == found[1] == ["torsion 1", "axial 1", "breathing 1", "axial 2", "breathing 2"]


@pytest.mark.slow
def test_the_default_solid_lies_above_the_harmonic_one_by_what_its_cells_around_leave():
    """Both are Ritz methods on the same body: frequencies come from above, the coarser mesh's more.
    Twelve cells around are three to a wave of n = 4, twenty-four are six.
    """
    scene = sg.load("validation/experiments/steel_cylinder.toml")

    def listed(model, **options):
        modes = sg.modes(sg.build(scene, model, **options), scene, n=40).modes
        each = [[m.frequency_hz] * m.multiplicity for m in modes if m.frequency_hz > 0]
        return np.sort(np.concatenate(each))[:38]

    exact = listed("harmonic", order=7)
    coarse, fine = (listed("solid", **one) / exact - 1 for one in ({}, {"around": 24}))
    assert np.all(coarse > 0) and np.all(fine > 0)
    # measured 1.6 and 0.4 %; as quadratic cells a quarter to a sixteenth
    assert 0.01 < coarse.max() < 0.02 and fine.max() < coarse.max() / 3


def test_a_mode_of_a_pair_that_is_not_sure_is_perhaps_not_measured():
    tap = {"mode": [{"frequency": 808.0, "uncertainty": "3 Hz"}]}
    found = sg.correlate("geometry/shaft_stepped.toml", tap, 0.01)
    names = {mode.name for mode, share in found.missed if share < 0.95}
    assert names
    (perhaps,) = [text for text in found.sentences if text.startswith("Perhaps not measured: ")]
    assert all(f"{name} at " in perhaps for name in names) and "%)" in perhaps
    assert not any(
        name in text for name in names for text in found.sentences if "Computed and not" in text
    )
