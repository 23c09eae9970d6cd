"""Charts in the dark and on narrow paper: what must not change, whatever a chart shows."""

import colorsys
import json
import re
from collections import Counter
from html import unescape
from io import BytesIO
from pathlib import Path

import matplotlib
import pytest
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from solidgear.report import night
from solidgear.report.chart_style import NARROW_WIDTH, legend_columns, new_figure, svg_of
from solidgear.report.chart_style import STYLE as STYLE_OF_CHARTS
from solidgear.report.charts import CHARTS
from solidgear.report.night import INK, PAPER, in_the_dark, luminance
from solidgear.report.paper import WITHOUT, written
from solidgear.report.readout import PER_INCH

STYLE = Path(night.__file__).with_name("style.html").read_text()


@pytest.fixture(scope="module")
def drawings(made_up_charts):
    """Wide and narrow SVG of every chart."""
    return {
        name: re.findall(r"<svg.*?</svg>", made_up_charts.svg[name].decode(), re.S)
        for name in CHARTS
    }


def contrast(one, other):
    low, high = sorted((luminance(one), luminance(other)))
    return (high + night.FLARE) / (low + night.FLARE)


def hue(colour):
    return colorsys.rgb_to_hsv(*(int(colour[k : k + 2], 16) for k in (1, 3, 5)))[0]


@pytest.mark.parametrize("value", ["ff", "c0", "80", "40", "00"])
@pytest.mark.parametrize(
    "pattern", ["{0}{1}{1}", "{1}{0}{1}", "{1}{1}{0}", "{0}{0}{1}", "{0}{0}{0}"]
)
def test_a_colour_keeps_its_contrast_and_its_hue_in_the_dark(pattern, value):
    """As far as the ink goes: what is darker than ink is on white is ink."""
    for other in ("00", "50", "a0", "f0"):
        colour = "#" + pattern.format(value, other)
        dark = in_the_dark(colour)
        wanted = min(contrast(colour, "#ffffff"), contrast(INK, PAPER))
        # an eighth of a bit in a dark colour is 1 % of its contrast
        assert contrast(dark, PAPER) == pytest.approx(wanted, rel=0.03)
        *_, chroma, _ = (
            0,
            *colorsys.rgb_to_hsv(*(int(dark[k : k + 2], 16) for k in (1, 3, 5)))[1:],
        )
        if chroma > 0.3 and value != other and luminance(colour) < 0.6:
            # OKLab's hue and that of HSV part by a twelfth of the circle in blue
            apart = abs(hue(dark) - hue(colour))
            assert min(apart, 1 - apart) < 1 / 8, (colour, dark)


def test_white_and_black_become_the_paper_and_the_ink_of_the_page():
    assert (in_the_dark("#ffffff"), in_the_dark("#000000")) == (PAPER, INK)
    dark = STYLE[STYLE.index("prefers-color-scheme: dark") :]
    assert f"--paper: {PAPER}; --ink: {INK};" in dark


def test_every_colour_of_a_chart_has_a_partner(drawings):
    """None is left that the dark does not change, and print sees what was drawn."""
    for name, both in drawings.items():
        for svg in both:
            drawn = re.sub(r"<style>.*?</style>|<metadata.*?</metadata>", "", svg, flags=re.S)
            used = set(re.findall(r"var\(--c([0-9a-f]{6}), #\1\)", drawn))
            bare = re.sub(r"var\(--c[0-9a-f]{6}, #[0-9a-f]{6}\)", "", drawn)
            tags = " ".join(re.findall(r"<[a-z][^>]*>", bare))
            assert not re.findall(r'[:"]\s*#[0-9a-fA-F]{3,8}\b(?!-)', tags), name
            assert "<image" not in drawn, name
            sheet = re.search(
                r"<style>(@media screen and \(prefers-color-scheme: dark\).*?)</style>", svg
            )
            assert used <= set(re.findall(r"--c([0-9a-f]{6}): #", sheet[1])), name


def test_the_narrow_drawing_says_what_the_wide_one_does(drawings):
    for name, (wide, narrow) in drawings.items():
        width = float(re.search(r'viewBox="0 0 ([\d.]+)', narrow)[1])
        assert (
            width
            <= NARROW_WIDTH * PER_INCH + 1e-6
            < float(re.search(r'width="([\d.]+)pt', wide)[1])
        )
        told = []
        for svg in (wide, narrow):
            found = re.search(r'<metadata class="readings">(.*?)</metadata>', svg, re.S)
            series = json.loads(unescape(found[1])) if found else []
            told.append(sorted([s["name"], s["colour"], s["told"]] for s in series))
        assert told[0] == told[1], name


def example_figure(*_):
    """Panels whose layout depends on what is written: decades, a bar of colours, legends, a foot."""
    figure = new_figure(9.0, 4.0)
    first, second = figure.subplots(1, 2)
    first.loglog([1, 1e3], [2e-7, 3], label="a curve")
    first.set_title("twelve decades, and a title")
    first.legend()
    drawn = second.pcolormesh([[0.0, 1.0], [2.0, 3.0]])
    figure.colorbar(drawn, ax=second, label="per cent")
    second.set_aspect("equal")
    figure.legend(loc="outside lower left")
    figure.supxlabel("a foot", x=0.01, ha="left")
    return figure


def test_a_figure_is_laid_out_as_matplotlib_would_save_it():
    """To the byte: one layout and one drawing, measured by one renderer, where savefig takes two."""
    theirs, ours = BytesIO(), []
    with matplotlib.rc_context({**STYLE_OF_CHARTS, "svg.hashsalt": "one"}):
        figure = example_figure()
        for part in figure.findobj(lambda one: one.get_rasterized()):
            part.set_rasterized(False)
        figure.savefig(theirs, format="svg", metadata=WITHOUT)
        # the second is measured with what the renderer remembers of the first
        ours = [written(example_figure()) for _ in range(2)]
    assert ours == [theirs.getvalue().decode()] * 2


def test_a_chart_is_drawn_once_wide_and_once_narrow(monkeypatch):
    """And laid out no more often than what is fitted to narrow paper asks for."""
    calls = Counter()

    def counted(owner, name):
        original = getattr(owner, name)

        def call(*args, **more):
            calls[name] += 1
            return original(*args, **more)

        monkeypatch.setattr(owner, name, call)

    counted(Figure, "draw")
    counted(ConstrainedLayoutEngine, "execute")
    svg_of("example", example_figure)
    # narrow: before, with the legend above the foot, and on paper without its empty part
    assert calls["draw"] == 2 and calls["execute"] <= 1 + 3


def test_panels_stand_below_one_another_and_keep_their_names():
    """Also those that had the name of their row or column alone, and whatever is written fits."""
    seen = []

    def make():
        figure = new_figure(12.0, 5.0)
        grid = figure.subplots(2, 3, sharex="col", sharey="row")
        for row in grid:
            row[0].set_ylabel(f"height {len(seen)}")
            for k, ax in enumerate(row):
                ax.plot([0, 1e6], [0, 1])
                ax.set_title(
                    f"a title of so many words that no phone there is, nor any there will be, shows them in one line, {k}"
                )
        for k, ax in enumerate(grid[-1]):
            ax.set_xlabel(f"length {k}")
        figure.legend(["a", "b"], loc="outside right upper", ncols=legend_columns(4))
        figure.supxlabel(
            "where all of it comes from, in a sentence that needs more lines than one",
            x=0.01,
            ha="left",
        )
        seen.append(figure)
        return figure

    svg_of("grid", make)
    wide, narrow = seen
    assert wide.get_size_inches().tolist() == [12.0, 5.0]
    assert narrow.get_size_inches().tolist() == [NARROW_WIDTH, 15.0]
    boxes = [ax.get_position() for ax in narrow.axes]
    assert all(upper.y0 > lower.y1 for upper, lower in zip(boxes, boxes[1:]))
    assert [ax.get_xlabel() for ax in narrow.axes] == ["length 0", "length 1", "length 2"] * 2
    assert [ax.get_ylabel() for ax in narrow.axes] == ["height 1"] * 6
    (legend,), foot = narrow.legends, narrow._supxlabel.get_window_extent()
    assert foot.y1 <= legend.get_window_extent().y0
    assert legend.get_window_extent().y1 <= narrow.axes[-1].get_tightbbox().y0
    page = narrow.get_window_extent()
    for ax in narrow.axes:
        for text in (ax._left_title, ax.title, ax.xaxis.label):
            assert text.get_window_extent().x1 <= page.x1 + 1
        ends = [label.get_window_extent() for label in ax.get_xticklabels()]
        if not any(label.get_rotation() for label in ax.get_xticklabels()):
            assert all(one.x1 <= other.x0 for one, other in zip(ends, ends[1:]))
