"""What a chart shows is what was measured: places of marks, words of numbers, in the units chosen."""

import re
from functools import partial

import numpy as np
import pytest
from test_train_models import COARSE, OVERHUNG

import solidgear as sg
from solidgear.comparison.page.charts import CHARTS
from solidgear.show.panel import Panel, read_places, readout
from solidgear.show.plot import NARROW, WIDE, Chart, page_svg
from solidgear.show.scales import Axis
from solidgear.show.units import SYSTEMS
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.page.chart import receptance_chart, response_chart
from solidgear.trains.response.receptance import receptance
from solidgear.trains.response.respond import respond
from tests.charted import facts_of, texts_of, words_of
from tests.made_up_run import fixture_results

SIDE = ("timoshenko", "euler")
#: from a mark to its place in the picture
AT = re.compile(r'<path aria-label="([^"&]*)[^>]*translate\(([\d.-]+),([\d.-]+)\)')


def number(text):
    """As it was before its digits were put in groups of three and its unit behind it."""
    return float(text.split(" ")[0].replace("\u00a0", ""))


def panel_of(rows, **axes):
    ends = {"x": (1.0, 1000.0), "y": (1e-3, 1.0)} | axes
    panel = Panel(*(Axis(name, ends[name], log=True) for name in "xy"), 100.0)
    panel.draw({"type": "point", "size": 9}, rows)
    return panel


def test_marks_stand_where_their_numbers_say_on_logarithmic_axes():
    rows = [
        {"x": x, "y": y, "readout": readout(name, ("v", "1", ""))}
        for name, x, y in (("a", 1.0, 1e-3), ("b", 30.0, 0.5), ("c", 1000.0, 7e-2))
    ]
    for width in (WIDE, NARROW):
        places = {
            name: (float(x), float(y))
            for name, x, y in AT.findall(Chart([[panel_of(rows)]], width).svg())
        }
        left, low = places["a"]
        across = places["c"][0] - left
        assert across > 0.6 * width
        # places are written to a hundredth of a pixel
        assert places["b"][0] - left == pytest.approx(across * np.log10(30) / 3, abs=0.03)
        for name, y in (("b", 0.5), ("c", 7e-2)):
            assert low - places[name][1] == pytest.approx(100 * np.log10(y / 1e-3) / 3, abs=0.03)


def test_what_is_no_number_or_has_no_logarithm_is_not_drawn():
    values = {"in": 1.0, "nan": np.nan, "none": None, "zero": 0.0, "below": -1.0}
    rows = [
        {"x": 2.0, "y": y, "readout": readout(name, ("v", "1", ""))} for name, y in values.items()
    ]
    assert [name for name, *_ in AT.findall(Chart([[panel_of(rows)]]).svg())] == ["in"]


def test_a_curve_is_read_at_its_tops_and_at_few_places_else():
    x = np.linspace(1, 2, 20001)
    y = np.where(np.arange(20001) == 7777, 1.0, 0.0)
    for log in (False, True):
        places = read_places(x, y, 50, log)
        assert {0, 7777, 20000} <= set(places) and len(places) < 60


def test_a_second_axis_above_leaves_the_one_below():
    row = {"x": 10.0, "y": 0.1}
    panel = Panel(
        Axis("under", (1.0, 1e3), log=True),
        Axis("", (1e-3, 1.0), log=True),
        100.0,
        upper=Axis("over", (1.0, 1e3), log=True, ticks={10.0: "ten"}),
    )
    panel.draw("rule", [{"y": 0.1}])
    panel.draw("point", [row])
    panel.draw("text", [row | {"text": "here"}])
    svg = Chart([[panel]]).svg()
    assert [svg.count(f">{text}<") for text in ("under", "over", "ten", "100")] == [1, 1, 1, 1]


def test_words_cannot_end_the_picture_or_begin_a_script():
    evil = '</text></svg><script>alert("x")</script>\\'
    row = {"x": 2.0, "y": 0.5, "readout": readout(evil, (evil, evil, evil)), "text": evil}

    def make(width):
        panel = panel_of([row])
        panel.draw("text", [row])
        panel.title, panel.x = evil, Axis(evil, (1.0, 9.0), ticks={2.0: evil})
        return Chart([[panel]], width, evil, evil)

    svg = page_svg("evil", make).decode()
    assert "<script" not in svg and svg.count("</svg>") == 2
    assert set(words_of(svg)) == {row["readout"]}


def test_a_series_has_a_colour_and_a_shape_of_its_own(made_up_charts):
    """In print without colours shapes tell models apart."""
    marks = re.findall(
        r'aria-label="([^"&]+)[^>]*? d="([^"]+)" fill="([^"]+)"',
        made_up_charts.svg["modes"].decode(),
    )
    looks = {name: (shape, colour) for name, shape, colour in marks}
    assert len(looks) >= 4
    for values in zip(*looks.values()):
        assert len(set(values)) == len(looks)


def test_every_chart_of_values_is_read_and_the_narrow_drawing_says_what_the_wide_one_does(
    made_up_charts,
):
    """All of the report but the drawing of the shaft, and with the numbers of the run."""
    # the run leaves nothing open, and has no chart of that
    named = [name for name in CHARTS if name != "budget"]
    drawn = {name: made_up_charts.svg[name].decode() for name in named}
    for name, svg in drawn.items():
        wide, narrow = re.findall(r"<svg.*?</svg>", svg, re.S)
        assert bool(words_of(wide)) == (name != "sketch")
        assert set(words_of(wide)) == set(words_of(narrow)), name
    results = fixture_results()
    euler = results["models"]["euler"]
    first = next(m["frequency_hz"] for m in euler["modes"] if m["name"] == "bending 1")
    facts = [f for name, f in facts_of(drawn["modes"]) if name == euler["title"]]
    (read,) = {number(f["frequency"]) for f in facts if f["mode"] == "bending 1"}
    assert read == pytest.approx(first, abs=0.05)


@pytest.fixture(scope="module")
def assembly():
    return Assembly(sg.load_train(OVERHUNG), settings=COARSE)


@pytest.fixture(scope="module")
def found(assembly):
    return respond(assembly, *SIDE, highest_hz=900.0)


def test_a_response_that_is_drawn_from_further_up_says_so(found):
    def words(marks):
        panel = response_chart([found], "", 14, 3.0, marks).rows[-1][0]
        return panel.x.title, panel.x.ends[0]

    assert words({}) == ("mesh frequency in Hz", pytest.approx(found.frequency_hz[0]))
    said, first = words({"both euler": 500.0})
    below = [peak for peak in found.peaks if peak.frequency_hz < first]
    assert first == pytest.approx(250.0) and len(below) > 1
    assert "from half the frequency where the first model leaves the tolerance" in said
    assert said.endswith(f"; {len(below)} peaks lie below")


@pytest.mark.parametrize(
    "units, newton, micrometre",
    [("si", 1, 1e-6), ("engineering", 1, 1), ("us", 1 / 4.4482216152605, 1e3 / 25.4)],
)
def test_a_response_is_read_in_the_units_chosen(found, units, newton, micrometre):
    chart = response_chart([found], "", 14, 3.0, {}, SYSTEMS[units])
    facts = [fact for _, fact in facts_of(chart.svg())]
    error = found.columns["dynamic transmission error [m]"]
    for what, si, one in (
        ("mesh force", np.abs(found.force), newton),
        ("dynamic transmission error", 1e6 * np.abs(error), micrometre),
    ):
        rows = [fact for fact in facts if what in fact and "peak of" not in fact]
        hz = np.array([number(fact["frequency"]) for fact in rows])
        at = np.abs(found.frequency_hz[:, None] - hz).argmin(axis=0)
        # a frequency is told to 0.05 Hz and a value to four figures; flanks here move by 8 % in 1 Hz
        read = [number(fact[what]) for fact in rows]
        np.testing.assert_allclose(read, one * si[at], rtol=5e-3)
    peaks = {f["peak of"]: number(f["mesh force"]) for f in facts if "peak of" in f}
    assert peaks == {p.mode: pytest.approx(p.force * newton, rel=6e-4) for p in found.peaks}
    top = max(found.peaks, key=lambda p: p.force)
    rpm = next(number(f["pinion speed"]) for f in facts if f.get("peak of") == top.mode)
    assert rpm == pytest.approx(60 * top.frequency_hz / 14, abs=0.5)
    assert any(text.startswith(top.mode) for text in texts_of(chart))


def test_a_receptance_is_read_with_its_phase(assembly):
    one = receptance(
        assembly, *SIDE, from_=("pinion.pinion", "z"), to=("gear.gear", "thx"), highest_hz=900.0
    )
    make = partial(receptance_chart, [one], "", 14, SYSTEMS["us"])
    facts = [fact for _, fact in facts_of(page_svg("receptance", make).decode())]
    size, mode = max((size, mode) for _, size, mode in one.peaks)
    (told_as,) = {f["receptance"] for f in facts if f.get("peak of") == mode}
    assert one.unit == "rad/N" and told_as.endswith(" µrad/lbf")
    assert number(told_as) == pytest.approx(4.4482216e6 * size, rel=6e-4)
    phases = {number(f["phase"]) for f in facts if "phase" in f}
    assert phases <= set(np.round(np.degrees(np.angle(one.value)), 1))


def test_words_of_ticks_stand_with_their_middle_at_the_tick():
    svg = Chart([[panel_of([{"x": 10.0, "y": 0.1}])]]).svg()
    words = {
        text: float(y) for y, text in re.findall(r'<text x="[^"]+" y="([^"]+)"[^>]*>([^<]+)<', svg)
    }
    ticks = [float(y) for y in re.findall(r"M[\d.]+,([\d.]+)h-5\.0", svg)]
    # the foot of letters of 12 px lies 0.3 of their height below the middle
    drawn = sorted(words[text] - 3.6 for text in ("1", "0.1", "0.01", "0.001"))
    np.testing.assert_allclose(drawn, sorted(ticks), atol=0.06)
