"""What is to be read off a chart: places of the picture, words of the numbers, in the units chosen."""

import html
import json
import re

import numpy as np
import pytest
from test_train_models import COARSE, OVERHUNG

import solidgear as sg
from solidgear.report.chart_style import new_figure, svg_of
from solidgear.report.charts import CHARTS
from solidgear.report.readout import STEPS, readable, readings
from solidgear.report.train_chart import receptance_figure, response_figure
from solidgear.report.units import SYSTEMS
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.receptance import receptance
from solidgear.studies.train.respond import respond
from tests.made_up_run import fixture_results

SIDE = ("timoshenko", "euler")


def told_by(svg: bytes):
    found = re.search(r'<metadata class="readings">(.*?)</metadata>', svg.decode(), re.S)
    return json.loads(html.unescape(found[1]))


def column(series, what):
    (found,) = (values for head, _, values in series["told"] if head == what)
    return found


def number(text):
    """As it was before its digits were put in groups of three."""
    return float(text.replace("\u00a0", ""))


def test_places_are_those_of_the_markers_in_the_picture():
    """On logarithmic axes in a layout that is only known once it is drawn."""

    def make():
        figure = new_figure(7.0, 3.0)
        for ax in figure.subplots(1, 2):
            xs, ys = [1.0, 30.0, 1000.0], [2e-3, 0.5, 7e-2]
            ax.loglog(xs, ys, "o")
            ax.set_ylabel("a name that takes room")
            readable(ax, xs, ys, "model", {"value": ("N", ["a", "b", "c"])})
        return figure

    wide, narrow, _ = svg_of("placed", make).split(b"</svg>")
    for svg in (wide, narrow):
        # ticks are markers as well, without a fill
        drawn = re.findall(r'<use [^>]*x="([\d.]+)" y="([\d.]+)" style="fill', svg.decode())
        markers = [(float(x), float(y)) for x, y in drawn]
        at = np.array([one["at"] for one in told_by(svg)]).reshape(-1, 2) / STEPS
        assert len(at) == len(markers) == 6
        for place in at:
            assert min(np.hypot(x - place[0], y - place[1]) for x, y in markers) < 0.1


def test_what_lies_outside_of_a_panel_or_is_no_number_is_not_read():
    figure = new_figure(4.0, 3.0)
    ax = figure.subplots()
    ax.set(xlim=(0, 10), ylim=(0, 10))
    values = ["in", "beyond", "nothing", "edge"]
    readable(ax, [1, 11, 2, 10], [1, 5, np.nan, 10], "model", {"value": ("", values)})
    readable(ax, [20], [20], "nowhere", {"value": ("", ["out"])})
    (one,) = readings(figure)
    assert column(one, "value") == ["in", "edge"]


def test_a_curve_keeps_its_tops_and_loses_what_the_eye_cannot_tell():
    x = np.linspace(0, 1, 20001)
    y = np.where(np.arange(20001) == 7777, 1.0, 0.0)
    figure = new_figure(4.0, 3.0)
    readable(figure.subplots(), x, y, "curve", {"y": ("", y.astype(str))}, marked=False)
    (one,) = readings(figure)
    assert "1.0" in column(one, "y")
    assert len(column(one, "y")) < 1000


def test_words_cannot_end_the_script_or_the_picture():
    evil = '</metadata></svg><script>alert("x")</script>'

    def make():
        figure = new_figure(4.0, 3.0)
        readable(figure.subplots(), [0.5], [0.5], evil, {evil: (evil, [evil])})
        return figure

    svg = svg_of("evil", make)
    assert b"<script" not in svg and svg.count(b"</svg>") == 2
    assert told_by(svg)[0]["name"] == evil


def test_every_chart_of_values_is_read(made_up_charts):
    """All of the report but the drawing of the shaft, and with the numbers of the run."""
    results = fixture_results()
    drawn = {name: made_up_charts.svg[name] for name in CHARTS}
    read = {name for name, svg in drawn.items() if svg and b'class="readings"' in svg}
    assert read == {name for name, svg in drawn.items() if svg} - {"sketch"}
    euler = results["models"]["euler"]["modes"]
    first = next(m["frequency_hz"] for m in euler if m["name"] == "bending 1")
    rows = [s for s in told_by(drawn["modes"]) if s["name"] == results["models"]["euler"]["title"]]
    at = column(rows[0], "mode").index("bending 1")
    assert float(column(rows[0], "frequency")[at]) == pytest.approx(first, abs=0.05)


@pytest.fixture(scope="module")
def shop():
    return Workshop(sg.load_train(OVERHUNG), settings=COARSE)


@pytest.fixture(scope="module")
def found(shop):
    return respond(shop, *SIDE, 900.0)


def drawn(found, units):
    return told_by(
        svg_of("response", lambda: response_figure([found], "", 14, 3.0, {}, SYSTEMS[units]))
    )


def test_a_response_that_is_drawn_from_further_up_says_so(found):
    def words(marks):
        axes = response_figure([found], "", 14, 3.0, marks).axes[1]
        return axes.get_xlabel(), axes.get_xlim()[0]

    assert words({}) == ("mesh frequency in Hz", pytest.approx(found.frequency_hz[0]))
    told, first = words({"both euler": 500.0})
    below = [peak for peak in found.peaks if peak.frequency_hz < first]
    assert first == pytest.approx(250.0) and len(below) > 1
    assert "from half of where the first model leaves the band" in told
    assert told.endswith(f"; {len(below)} peaks lie below")


@pytest.mark.parametrize(
    "units, newton, micrometre",
    [("si", 1, 1e-6), ("engineering", 1, 1), ("us", 1 / 4.4482216152605, 1e3 / 25.4)],
)
def test_a_response_is_read_in_the_units_chosen(found, units, newton, micrometre):
    force, peaks, error = drawn(found, units)
    for series, what, si, one in (
        (force, "mesh force", np.abs(found.force), newton),
        (
            error,
            "dynamic transmission error",
            1e6 * np.abs(found.columns["dynamic transmission error [m]"]),
            micrometre,
        ),
    ):
        hz = np.array([number(text) for text in column(series, "frequency")])
        read = np.array([number(text) for text in column(series, what)])
        at = np.abs(found.frequency_hz[:, None] - hz).argmin(axis=0)
        # a frequency is told to 0.05 Hz and a value to four figures; flanks here move by 8 % in 1 Hz
        np.testing.assert_allclose(read, one * si[at], rtol=5e-3)
    modes = dict(zip(column(peaks, "peak of"), map(number, column(peaks, "mesh force"))))
    assert modes == {p.mode: pytest.approx(p.force * newton, rel=6e-4) for p in found.peaks}
    top = max(found.peaks, key=lambda p: p.force)
    rpm = column(peaks, "pinion speed")[column(peaks, "peak of").index(top.mode)]
    assert float(rpm) == pytest.approx(60 * top.frequency_hz / 14, abs=0.5)


def test_a_receptance_is_read_with_its_phase_and_its_ticks_are_numbers(shop):
    one = receptance(shop, *SIDE, ("pinion.pinion", "z"), ("gear.gear", "thx"), 900.0)
    svg = svg_of("receptance", lambda: receptance_figure([one], "", 14, SYSTEMS["us"]))
    amplitude, peaks, phase = told_by(svg)
    assert b"mathdefault" not in svg
    (unit,) = {unit for head, unit, _ in amplitude["told"] if head == "receptance"}
    assert one.unit == "rad/N" and unit == "µrad/lbf"
    size, mode = max((size, mode) for _, size, mode in one.peaks)
    at = column(peaks, "peak of").index(mode)
    assert number(column(peaks, "receptance")[at]) == pytest.approx(4.4482216e6 * size, rel=6e-4)
    assert {float(v) for v in column(phase, "phase")} <= set(
        np.round(np.degrees(np.angle(one.value)), 1)
    )
