"""The data sheet in a real browser: on paper one sheet, on a phone no wider than it, and of a train."""

import re
from dataclasses import replace

import pytest
from made_up_sheet import made_up_shaft, made_up_sheet
from test_report_browser import CHROMIUM, looked_at

import solidgear as sg
from solidgear.datasheet.browser import pages_of

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium here"),
]


def crowded(language="de"):
    """A sheet with as much as a page takes."""
    sheet = made_up_sheet(language=language)
    return replace(
        sheet,
        figures=sheet.figures * 5,
        bearings=sheet.bearings * 6,
        motions=sheet.motions * 7,
        frequencies=sheet.frequencies * 6,
        resonances=sheet.resonances * 6,
        cautions=sheet.cautions * 4,
    )


@pytest.mark.parametrize("crowded_train", [False, True])
def test_a_printed_sheet_is_one_page_of_a4(tmp_path, crowded_train):
    sheet = made_up_sheet()
    if crowded_train:
        shafts = tuple(replace(made_up_shaft(), name=f"Welle {k}") for k in range(6))
        sheet = replace(crowded(), train=True, drawn=shafts)
    (path,) = sheet.save(tmp_path / "sheet.pdf")
    data = path.read_bytes()
    assert pages_of(data) == 1
    (box,) = set(re.findall(rb"/MediaBox \[([\d. ]+)\]", data))
    assert [float(end) for end in box.split()] == pytest.approx([0, 0, 595, 842], abs=1)


@pytest.mark.parametrize("flags", [(), ("--blink-settings=preferredColorScheme=0",)])
def test_a_sheet_fits_a_phone_and_is_readable_in_the_dark(tmp_path, flags):
    measured, console = looked_at(tmp_path, crowded().to_html(), *flags)
    assert console == []
    for width, found in measured.items():
        assert found["width"] <= int(width), width
        assert found["worst"][0] > 4.5, found["worst"]
        for chart in found["charts"]:
            assert chart["outside"] == [] and not chart["scrolls"]
            assert chart["least"] >= 6.5, (width, chart["least"])


def test_a_train_has_the_sheet_of_its_operating_point():
    facts = sg.sheet("geometry/gearbox_train.toml")
    pinion, gear = facts.drawn
    assert (pinion.sense, gear.sense) == ("-y", "+y")
    assert pinion.speed / gear.speed == pytest.approx(57 / 20)
    for shaft in facts.drawn:
        sums = [sum(force.six[k] for force in shaft.forces) for k in range(3)]
        assert sums == pytest.approx([0, 0, 0], abs=1e-3)
    teeth = [next(f for f in s.forces if not f.by_bearing and any(f.six[:3])) for s in facts.drawn]
    # parallel axes: the same force, turned round
    assert teeth[0].six[:3] == pytest.approx([-f for f in teeth[1].six[:3]], rel=1e-9)
    # tangential force of 115 N m at 30 mm, across the axis; and 15 degrees of helix along it
    assert abs(teeth[0].six[4]) == pytest.approx(115)
    assert abs(teeth[0].six[1]) == pytest.approx(115 / 0.03 * 0.26795, rel=1e-3)
    assert {b.name for b in facts.bearings} == {"pinion.A", "pinion.B", "gear.C", "gear.D"}
    hours = {life.name: life.duty.hours for life in sg.bearing("geometry/gearbox_train.toml").lives}
    assert {b.name: b.hours for b in facts.bearings} == pytest.approx(hours)
    assert facts.trust.reached and facts.trust.demand == "within misalignment"


def test_a_comparison_leaves_a_sheet_with_its_numbers(tmp_path):
    comparison = sg.compare("geometry/shaft_hollow.toml", ("timoshenko", "harmonic"))
    comparison.write_report(tmp_path, renders=False, sheet="de")
    page = (tmp_path / "sheet.html").read_text(encoding="utf-8")
    assert 'href="report.html"' in page and "sheet.html" in comparison.record.files
    value = comparison.record.model("harmonic").mode("bending 1").frequency_hz
    assert f"{value:.1f}".replace(".", ",") in page
