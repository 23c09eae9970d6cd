"""A train at one speed: orders of bearings and teeth, and whose the peaks of a spectrum are."""

import json

import numpy as np
import pytest
from test_bearings_catalogue import KNOWN_BALLS
from test_train_models import OVERHUNG

import solidgear as sg
from solidgear.bearings.catalogue import Catalogue
from solidgear.bearings.geometry import inner_geometry
from solidgear.bearings.inside import Inside
from solidgear.bearings.passing import passing
from solidgear.core.errors import SolidgearError
from solidgear.trains.assembly.kinematics import SLIP, bearing_orders, settled_angles, train_orders
from solidgear.trains.response.at_speed import Line, at_speed, explained, turns_of_pinion
from solidgear.trains.response.measured_chart import outline
from solidgear.trains.response.spectrum import Spectrum, read_spectrum
from tests.charted import words_of
from tests.command import command, table

TRAIN = sg.load_train(OVERHUNG)
GEARBOX = sg.load("geometry/gearbox_catalogue.toml")
MODES = ()


def catalogue_train():
    """The overhung train with a catalogue bearing on its pinion shaft."""
    data = {"designation": "6220", "load_rating": "127 kN", "load": {"z": "10 kN"}}
    scene = TRAIN.pinion.scene
    first = scene.bearings[0].with_changes(catalogue=Catalogue(**data))
    scene = scene.with_changes(bearings=(first, *scene.bearings[1:]))
    return TRAIN.with_changes(pinion=TRAIN.pinion.with_changes(scene=scene))


def rolled(inside, inner, outer):
    """FTF, BPFO, BPFI, BSF from the velocities of the contacts, which rolling without slip shares."""
    c, d, pitch = np.cos(inside.angle), inside.diameter, inside.pitch
    at_inner, at_outer = (pitch - d * c) / 2, (pitch + d * c) / 2
    cage = (inner * at_inner + outer * at_outer) / 2 / (pitch / 2)
    # from the cage an element stands, and the inner race goes by at the speed of its surface
    spin = (inner - cage) * at_inner / (d / 2)
    assert (cage - outer) * at_outer / (d / 2) == pytest.approx(spin)  # and so does the outer one
    z = inside.elements
    return cage, z * abs(cage - outer), z * abs(inner - cage), abs(spin)


@pytest.mark.parametrize("inner, outer", [(1.0, 0.0), (0.0, 1.0), (1.3, -0.4)])
@pytest.mark.parametrize("angle", [0.0, 0.7])
def test_elements_pass_as_they_roll(angle, inner, outer):
    inside = Inside(13, 9e-3, 0.0, 46.5e-3, angle, (0.52, 0.52))
    found = passing(inside, inner=inner, outer=outer)
    assert found == pytest.approx(rolled(inside, inner, outer), rel=1e-12)


def test_passages_over_both_rings_are_all_turns_of_the_shaft():
    inside = inner_geometry(Catalogue(designation="6206", load_rating="19.5 kN")).middle
    found = passing(inside)
    assert found.inner + found.outer == pytest.approx(inside.elements, rel=1e-12)


@pytest.mark.parametrize("designation, rating, count, diameter, pitch", KNOWN_BALLS)
def test_the_bar_of_a_bearing_line_holds_the_true_inside(
    designation, rating, count, diameter, pitch
):
    # nothing of the inside is told, and nothing slips
    true = passing(Inside(count, diameter, 0.0, pitch, 0.0, (0.52, 0.52)))
    data = Catalogue(designation=designation, load_rating=rating)
    for order in (order for order in bearing_orders("A", data, 1.0) if order.name.endswith(" 1")):
        assert order.low / (1 - SLIP) < getattr(true, order.kind) < order.high / (1 + SLIP)
        assert "estimated elements, element diameter, pitch diameter" in order.source


def test_a_known_inside_leaves_the_slip_alone():
    bearing = next(b for b in GEARBOX.bearings if b.name == "B")
    for order in bearing_orders("B", bearing.catalogue, 0.5):
        assert order.high / order.per_turn == pytest.approx(1 + SLIP)
        assert order.low / order.per_turn == pytest.approx(1 - SLIP)
        assert "estimated" not in order.source and "nominal" in order.source


def test_the_angle_at_work_moves_the_lines_as_its_cosine_says():
    bearing = next(b for b in GEARBOX.bearings if b.name == "B")
    angles = settled_angles(GEARBOX)["B"]
    assert len(angles) == 2 and min(angles) < 0.70 < max(angles)  # 40 degrees are 0.698
    inside = inner_geometry(bearing.catalogue).middle
    (line, *_) = (
        o for o in bearing_orders("B", bearing.catalogue, 1.0, angles) if o.kind == "outer"
    )
    ends = sorted(passing(inside, angle).outer for angle in angles)
    assert ends[0] < line.per_turn < ends[1]
    assert line.low == pytest.approx(ends[0] * (1 - SLIP)) and "at work" in line.source


def test_orders_of_teeth_are_exact_and_of_both_shafts():
    by = {order.name: order for order in train_orders(TRAIN)}
    assert by["gear 2"].per_turn == pytest.approx(2 * 14 / 45, rel=1e-14)
    assert by["mesh 3"].per_turn == 42
    assert by["mesh 2 - gear 1"].per_turn == pytest.approx(28 - 14 / 45, rel=1e-14)
    assert all(order.low == order.per_turn == order.high for order in by.values())


def test_the_speed_of_the_gear_is_that_of_the_pinion_over_the_ratio():
    turns = turns_of_pinion(TRAIN, 2 * np.pi * 14.0, "gear")
    assert turns == pytest.approx(45.0, rel=1e-14)
    assert turns_of_pinion(TRAIN, 2 * np.pi * 45.0, "pinion") == pytest.approx(turns, rel=1e-14)


# --------------------------------------------------------------------------- spectra
def spectrum(tones, resolution=0.25, high=2000.0, noise=1e-3):
    """Amplitudes of tones, windowed by Hann and sampled as an analyser does, in white noise."""
    seconds, rate = 1 / resolution, 2 * high
    t = np.arange(round(seconds * rate)) / rate
    rng = np.random.default_rng(3)
    x = noise * np.sqrt(rate / 2) * rng.standard_normal(len(t))
    for hz, size in tones.items():
        x += size * np.sin(2 * np.pi * hz * t + 1.0)
    window = np.hanning(len(t))
    y = 2 * np.abs(np.fft.rfft(x * window)) / window.sum()
    return Spectrum("made.csv", "acceleration", "m/s^2", np.fft.rfftfreq(len(t), 1 / rate), y)


def test_every_peak_finds_its_order_and_a_foreign_one_does_not():
    turns = 43.21
    tones = {
        14 * turns: 1.0,
        28 * turns: 0.5,
        13 * turns: 0.3,
        14 / 45 * turns: 0.2,
        14 * turns + 14 / 45 * turns: 0.2,
        777.7: 0.2,
    }
    found = at_speed(TRAIN, MODES, turns, "", spectrum=spectrum(tones))
    names = {round(peak.frequency_hz, 1): peak.name for peak in found.peaks}
    assert names == {
        round(14 / 45 * turns, 1): "gear 1",
        round(13 * turns, 1): "mesh 1 - pinion 1",
        round(14 * turns, 1): "mesh 1",
        round(14 * turns + 14 / 45 * turns, 1): "mesh 1 + gear 1",
        777.7: "not ours",
        round(28 * turns, 1): "mesh 2",
    }
    assert found.covered < 0.02
    assert "6 peaks stand out, 1 of them not ours" in found.notes()[-1]
    wrong = at_speed(TRAIN, MODES, 1.07 * turns, "", spectrum=found.spectrum)
    assert wrong.notes()[-1].startswith("No peak is an order of the mesh: check the speed")


def test_noise_has_no_peaks():
    assert spectrum({}).peaks() == []


def test_a_peak_is_found_between_two_lines():
    (top,) = spectrum({500.1: 1.0}).peaks()
    assert top[0] == pytest.approx(500.1, abs=0.02)  # of lines 0.25 Hz apart: Hann is no parabola


def test_levels_have_the_same_peaks_as_their_amplitudes():
    linear = spectrum({500.1: 1.0, 620.0: 0.1})
    level = 20 * np.log10(linear.amplitude / 1e-6)
    decibels = Spectrum("", "", "dB re 1e-6", linear.frequency_hz, level)
    assert [top[0] for top in decibels.peaks()] == pytest.approx([t[0] for t in linear.peaks()])


def test_a_peak_in_a_wide_bar_yields_to_what_teeth_give():
    mesh = Line("mesh", "mesh 1", "", 280.0, 280.0, 280.0)
    rolling = Line("outer", "bearing 1 BPFO 2", "", 280.3, 270.0, 290.0)
    lines = (rolling, mesh)
    both = explained(lines, 280.2, 1.0, 0.25)  # nearer to the middle of the bar
    assert both.name == "mesh 1" and both.others == ("bearing 1 BPFO 2",)
    assert explained(lines, 280.3, 1.0, 0.25).name == "bearing 1 BPFO 2"
    assert explained(lines, 290.2, 1.0, 0.25).name == "bearing 1 BPFO 2"
    assert explained(lines, 290.3, 1.0, 0.25).line is None


def test_lines_of_a_catalogue_bearing_stand_in_the_train():
    lines = {line.name: line for line in at_speed(catalogue_train(), MODES, 20.0, "").lines}
    bar = lines["pinion bearing 1 BPFO 2"]
    assert bar.low_hz < bar.frequency_hz < bar.high_hz
    assert bar.frequency_hz == pytest.approx(2 * lines["pinion bearing 1 BPFO 1"].frequency_hz)


def test_the_speed_is_fitted_to_the_mesh_order():
    made = spectrum({14 * 43.21: 1.0, 28 * 43.21: 0.2})
    found = at_speed(TRAIN, MODES, 44.0, "44 turns a second", spectrum=made, fit=0.03)
    # a resolution of 0.25 Hz, of which the parabola leaves less than a tenth
    assert found.rpm == pytest.approx(60 * 43.21, rel=0.025 / (14 * 43.21))
    assert "fitted" in found.speed and "-1.80 % from 44 turns" in found.speed
    with pytest.raises(SolidgearError, match="no peak of the spectrum lies within 1 %"):
        at_speed(TRAIN, MODES, 44.0, "", spectrum=made, fit=0.01)


GOOD = "frequency [Hz],acceleration [m/s^2]\n" + "".join(f"{k},{k % 3}\n" for k in range(9))


@pytest.mark.parametrize(
    "text, words",
    [
        (GOOD.replace("[Hz]", "[rpm]"), 'first column is "frequency .rpm."; it must be'),
        (GOOD.replace("frequency [Hz]", "speed in rpm"), "must be a frequency in Hz"),
        (GOOD.replace("frequency [Hz]", "order"), "must be a frequency in Hz"),
        (GOOD.replace("\n5,", "\n3.5,"), "line 7 goes from 4 to 3.5 Hz; frequencies must ascend"),
        (GOOD.replace("\n5,2", "\n5,nan"), 'line 7 is "5, nan"; it must hold two finite'),
        (GOOD.replace("\n5,2", "\n5"), 'line 7 is "5"; it must hold two finite'),
        (GOOD.replace("\n5,2", "\n5,-2"), "line 7 has an amplitude of -2"),
        (GOOD.replace("\n0,", "\n-1,"), "begins at -1 Hz"),
        (GOOD[:60], "lines of numbers are too few for a spectrum; give 8 or more"),
        ("", "0 lines of numbers"),
        ("".join(f"{k},0\n" for k in range(9)), "all amplitudes are zero"),
    ],
)
def test_a_spectrum_that_is_none_is_refused_in_one_sentence(tmp_path, text, words):
    file = tmp_path / "spectrum.csv"
    file.write_text(text)
    with pytest.raises(SolidgearError, match=words) as caught:
        read_spectrum(file)
    assert "\n" not in str(caught.value) and str(file) in str(caught.value)


@pytest.mark.parametrize(
    "text",
    [
        GOOD,
        GOOD.replace(",", ";"),
        GOOD.replace(",", "\t"),
        "".join(f"{k},0;{k % 3},0\n" for k in range(9)),
        "# of a microphone\n\n" + "".join(f"{k} {k % 3}\n" for k in range(9)),
        "".join(f"{k}, {k % 3}, 180\n" for k in range(9)),
    ],
)
def test_columns_are_parted_in_many_ways(tmp_path, text):
    (tmp_path / "a.csv").write_text(text)
    found = read_spectrum(tmp_path / "a.csv")
    assert found.frequency_hz.tolist() == list(range(9))
    assert found.amplitude.tolist() == [0, 1, 2] * 3
    assert found.unit == ("m/s^2" if "[" in text else "")


def test_an_outline_keeps_every_top_of_a_curve():
    x, y = np.arange(10_000.0), np.zeros(10_000)
    y[[1234, 5678]] = 1.0
    kept = outline(x, y, columns=100)
    assert {0, 1234, 5678, 9999} <= set(kept.tolist()) and len(kept) < 250


# --------------------------------------------------------------------------- command
BEAMS = ["response", str(OVERHUNG), "--pinion", "euler", "--gear", "euler", "--out"]


@pytest.mark.long
def test_the_command_tells_orders_and_lays_a_spectrum_over_the_response(tmp_path):
    made = spectrum({14 * 25.0: 1.0, 333.3: 0.3}, high=1000.0)
    rows = zip(made.frequency_hz, made.amplitude)
    file = tmp_path / "run.csv"
    file.write_text("frequency [Hz],acceleration [g]\n" + "".join(f"{a},{b}\n" for a, b in rows))
    words = [*BEAMS, tmp_path / "out", "--max-frequency", "900"]
    done = command(*words, "--speed", "1500 rpm", "--measured", file)
    assert done.exit_code == 0, done.output
    assert "not ours" in done.output and "Speed: 1500 rpm of the pinion." in done.output
    peaks = table(tmp_path / "out" / "peaks.csv")
    assert [row["order"] for row in peaks] == ["not ours", "mesh 1"]
    assert float(peaks[1]["amplitude [g]"]) == pytest.approx(1.0, rel=0.2)  # Hann's scallop: 1.4 dB
    lines = {row["order"]: row for row in table(tmp_path / "out" / "lines.csv")}
    assert float(lines["mesh 1"]["frequency [Hz]"]) == 350.0
    found = json.loads((tmp_path / "out" / "response.json").read_text())["at_speed"]
    near = table(tmp_path / "out" / "near.csv")
    assert [row["order"] for row in near] == [one["line"] for one in found["coincidences"]]
    assert found["pinion_rpm"] == pytest.approx(1500) and len(found["measured"]["peaks"]) == 2
    chart = (tmp_path / "out" / "measured.svg").read_text(encoding="utf-8")
    assert "acceleration, g" in chart and "not ours" in chart and "mesh force in N" in chart
    read = words_of(chart)
    assert any("amplitude:" in w for w in read) and any("natural frequency:" in w for w in read)
    page = (tmp_path / "out" / "response.html").read_text(encoding="utf-8")
    assert "First orders at this speed" in page and "Peaks of run.csv" in page


@pytest.mark.parametrize(
    "more, words",
    [
        (["--speed", "0 rpm"], "must be greater than zero"),
        (["--speed", "-100 rpm"], "must be greater than zero"),
        (["--speed", "3000"], 'a number and a unit, such as "3000 rpm"'),
        (["--speed", "50 Hz"], 'a number and a unit, such as "3000 rpm"'),
        (["--speed", "3000 rpm", "--of", "wheel"], "a train has a pinion and a gear"),
        (["--speed", "3000 rpm", "--within", "5"], "give a share between 0 and 1"),
        (["--measured", "a.csv"], "--measured needs a speed"),
        (["--of", "gear"], "--of needs a speed"),
        (["--speed", "3000 rpm", "--fit-speed", "0.1"], "needs a spectrum"),
        (["--speed", "3000 rpm", "--measured", "none.csv"], "cannot be read: No such file"),
    ],
)
def test_bad_words_on_speed_are_told_before_anything_is_solved(tmp_path, more, words):
    done = command(*BEAMS, tmp_path / "out", *more)
    assert done.exit_code != 0 and not (tmp_path / "out").exists()
    said = str(done.exception) + done.output
    assert words in said


def test_at_an_operating_point_the_angles_are_those_of_its_equilibrium():
    data = {"designation": "7220 B", "load_rating": "130 kN", "arrangement": "back_to_back"}
    scene = TRAIN.pinion.scene
    bearing = scene.bearings[0].with_changes(catalogue=Catalogue(**data, preload="500 N"))
    scene = scene.with_changes(bearings=(bearing, *scene.bearings[1:]))
    train = TRAIN.with_changes(
        pinion=TRAIN.pinion.with_changes(scene=scene), operation=({"torque": 300.0},)
    )
    lines = {line.name: line for line in at_speed(train, MODES, 20.0, "").lines}
    assert "at work" in lines["pinion bearing 1 BPFO 1"].source
