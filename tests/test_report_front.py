"""Page one says what was asked, how sure it is, which model to trust and why; its units are exact."""

from __future__ import annotations

import copy
import json
import re

import pytest

import solidgear as sg
from solidgear.comparison.page import html
from solidgear.core.errors import SolidgearError
from solidgear.core.judge.record import Record
from solidgear.show.input_tables import scene_facts
from solidgear.show.table import Cell
from solidgear.show.terminal import matrix_table
from solidgear.show.units import (
    ENGINEERING,
    SI,
    SYSTEMS,
    US,
    digits_for,
    in_ascii,
    plain,
    units_named,
)
from solidgear.show.viewer import END, START, TURNED
from tests.made_up_run import fixture_results
from tests.plain import final_table, render_page
from tests.test_report import shown, text_of

pytestmark = pytest.mark.usefixtures("no_charts")


def record_of(**changes):
    return Record.model_validate(fixture_results() | changes)


def si_page():
    return render_page(fixture_results() | {"shown_in": "si"})


def part(page, name):
    """One of the three parts of a page, as text."""
    start = page.index(f'<div class="{name}">')
    ends = [page.find(mark, start) for mark in ('<div class="customer">', '<div class="appendix">')]
    ends = [end for end in ends if end > start]
    return text_of(page[start : min(ends, default=len(page))])


# ------------------------------------------------------------------------------------------------- units
@pytest.mark.parametrize(
    "units, si, value, told",
    [
        (ENGINEERING, "N/m", 4.7105e9, "4710.5 N/µm"),
        (ENGINEERING, "m/N", 5.9612e-10, "0.59612 µm/kN"),
        (ENGINEERING, "N m/rad", 1.9008e7, "19 008 000 N m/rad"),
        (ENGINEERING, "rad/N", -7.5308e-9, "-7.5308 µrad/kN"),
        (ENGINEERING, "rad/(N m)", 1e-9, "1.0000 µrad/(kN m)"),
        (ENGINEERING, "Hz", 2758.06, "2758.1 Hz"),
        (SI, "N/m", 4.7105e9, "4.7105e9 N/m"),
        (SI, "m/N", 2e-9, "2.0000e-9 m/N"),
        # 1 lbf/in = 175.126835 N/m, 1 lbf in = 0.112984829 N m (NIST SP 811, appendix B.8)
        (US, "N/m", 175.126835, "1.0000 lbf/in"),
        (US, "N m/rad", 0.112984829, "1.0000 lbf in/rad"),
        (US, "m/N", 1e-6 / 175.126835, "1.0000 µin/lbf"),
        (US, "rad/(N m)", 1e-6 / 0.112984829, "1.0000 µrad/(lbf in)"),
        (US, "Pa", 6.894757e6, "1.0000 ksi"),
        (US, "m", 0.0254, "1.0000 in"),
        # pounds are of mass where kilograms were: 1 lb = 0.45359237 kg
        (US, "kg", 0.45359237, "1.0000 lb"),
        (US, "kg m²", 0.45359237 * 0.0254**2, "1.0000 lb in²"),
        (US, "kg/m³", 0.45359237 / 0.0254**3, "1.0000 lb/in³"),
        (US, "m/s²", 0.0254, "1.0000 in/s²"),
    ],
)
def test_a_value_in_its_unit(units, si, value, told):
    assert units.text(value, si).replace("\u00a0", " ") == told


@pytest.mark.parametrize(
    "value, told",
    [
        (0.0, "0"),
        (999.996, "1000.0"),
        (12345.6, "12 346"),
        (1.5e-3, "0.0015000"),
        (2e-5, "20.000e-6"),
        (1.5e9, "1.5000e9"),
        (None, "–"),
        (float("nan"), "–"),
    ],
)
def test_numbers_with_all_their_digits(value, told):
    assert plain(value).replace("\u00a0", " ") == told


def test_figures_end_where_the_bar_begins():
    assert [digits_for(bar) for bar in (0.3, 0.02, 1.2e-3, 4e-5, 1e-9)] == [3, 3, 4, 5, 6]


def test_unknown_units_are_refused_in_a_sentence():
    with pytest.raises(SolidgearError, match='did you mean "si".*engineering, si, us'):
        units_named("sii")


def test_terminal_is_ascii_in_every_choice():
    stiffness = fixture_results()["models"]["harmonic"]["stiffness"]
    for name in SYSTEMS:
        text = shown(matrix_table(stiffness, "stiffness", name)) + shown(
            final_table(fixture_results() | {"shown_in": name})
        )
        assert "…" not in text and max(map(len, text.splitlines())) <= 80
        assert in_ascii(SYSTEMS[name].unit("N/m")) in text
        assert text.replace("─", "").isascii()
    stiff = shown(matrix_table(stiffness, "stiffness", "engineering"))
    assert "19010000" in stiff  # one number, not three columns


def test_the_choice_is_kept_for_a_page_that_is_written_again():
    again = render_page(json.loads(json.dumps(record_of(shown_in="si").as_dict())))
    assert again == si_page() != render_page(fixture_results())


# ------------------------------------------------------------------------------------------------- page one
def test_customers_part_has_no_exponents():
    page = render_page(fixture_results())
    for name in ("front", "customer"):
        assert not re.search(r"\de[+-]?\d", part(page, name))
    assert re.search(r"\de-?\d", part(si_page(), "front"))


def test_page_one_has_date_version_and_hash():
    text = part(render_page(fixture_results()), "front")
    for words in ("2026-01-05", "solidgear 0.1.0", "scene pinion_overhung", "scene hash "):
        assert words in text
    digest = re.search(r"scene hash ([0-9a-f]{12}) ", text).group(1)
    changed = fixture_results()
    changed["scene"]["segments"][2]["outer1"] += 1e-9
    assert html.scene_hash(fixture_results()["scene"]) == digest
    assert html.scene_hash(changed["scene"]) != digest


def test_hash_is_of_the_data_and_not_of_the_file():
    scene = sg.load("geometry/pinion_overhung.toml")
    told = Record(scene=scene.as_dict()).scene
    assert html.scene_hash(told) == html.scene_hash(json.loads(json.dumps(told)))


def test_numbers_are_those_of_the_trusted_model_with_its_bars():
    record = record_of()
    record.models["harmonic"].band.each["C_zz"] = 0.02
    rows = {row[0]: row for row in html.numbers(record, ENGINEERING).rows}
    assert rows["First bending mode"][1:] == [Cell("2758 Hz", "strong"), "± 0.050 %"]
    compliance = rows["Compliance across the shaft, C_zz"][1:]
    assert compliance == [Cell("0.596 µm/kN", "strong"), "± 2.00 %"]
    assert rows["Stiffness along the shaft, K_yy"][2] == "no error bar"
    record.verdict.trust = "solid"
    (first, *_) = html.numbers(record, ENGINEERING).rows
    assert first[1] == Cell("2759 Hz", "strong")


def test_what_the_scene_asks_for_is_among_the_numbers():
    scene = copy.deepcopy(fixture_results()["scene"])
    scene["ask"]["quantities"] = ["torsion 1", "C_z,thx"]
    told = [row[0] for row in html.numbers(record_of(scene=scene), ENGINEERING).rows]
    assert "First torsion mode" in told and any("C_z,thx" in label for label in told)
    # one that has no words is told by its symbol, not left out
    scene["ask"]["quantities"] = ["C_x,thz", "bending 3"]
    told = [row[0] for row in html.numbers(record_of(scene=scene), ENGINEERING).rows]
    assert "C_x,thz" in told and "bending 3" in told


def test_two_directions_across_are_told_apart():
    record = record_of()
    labels = [row[0] for row in html.numbers(record, ENGINEERING).rows]
    assert not any("K_xx" in label for label in labels)
    record.models["harmonic"].stiffness[0][0] *= 1.05
    *_, last = html.numbers(record, ENGINEERING).rows
    assert "K_xx" in last[0] and last[1][0].startswith("4946")


def test_three_sentences_say_why():
    own, second, others = html.reasons(record_of())
    assert "harmonic solid" in own and "0.050 % in first bending" in own and "5 %" in own
    assert "3D solid" in second and "0.098 %" in second and "less than both error bars" in second
    assert others == "No cheaper model was shown to be within 5 %: do not use the Euler beam here."
    record = record_of()
    record.verdict.cheapest = "timoshenko"
    assert html.reasons(record)[2].startswith("The Timoshenko beam is enough within 5 %;")
    del record.models["solid"]
    record.deviations = [d for d in record.deviations if d.model != "solid"]
    assert html.reasons(record)[1].startswith("No second solid")


def test_without_trust_page_one_says_so():
    record = record_of()
    record.verdict.trust, record.verdict.sentences = None, ["Not judged: no solid was run."]
    text = part(render_page(record), "front")
    assert "No model is trusted Not judged: no solid was run." in text
    assert "Model trusted" not in text


# ------------------------------------------------------------------------------------------------- sections
def test_no_section_is_empty_and_the_contents_name_and_number_all_that_are_there(made_up_charts):
    page = render_page(fixture_results(), drawn=made_up_charts)
    there, numbers = zip(*re.findall(r'<h2 id="([^"]+)">(A?\d+)', page))
    # one point, no open input, no pictures, no chart of speed, and no synthesis asked for
    customer = ["scene", "stiffness", "frequencies", "models"]
    engineer = (
        "results matrices modes deviations causes attachments verification mac cost provenance"
    )
    assert list(there) == customer + engineer.split()
    assert numbers[:5] == ("1", "2", "3", "4", "A1") and numbers[-1] == "A10"
    assert re.findall(r'<a href="#([^"]+)">(A?\d+)', page) == [*zip(there, numbers)]
    assert "not available" not in page
    assert render_page({}).count("<h2") == 0


def test_lumped_synthesis_is_told_only_where_it_is_asked_for():
    results = fixture_results()
    made = {"frequency_hz": 2000.0, "feasible": True, "first": True, "verdict": "fine"}
    results["lumped"] = {"harmonic": {"frequency_hz": 2758.1, "variants": {"thesis": made}}}
    assert "equations 52" not in render_page(results)
    results["scene"]["ask"]["lumped"] = True
    assert "equations 52" in render_page(results) and 'id="lumped"' in render_page(results)


def test_a_viewer_stands_in_the_section_of_the_mode_shape(tmp_path):
    fragment = f'{START}<div id="turning"></div>{END}'
    (tmp_path / TURNED).write_text(fragment)
    page = render_page(fixture_results() | {"files": [TURNED]}, tmp_path)
    section = page[page.index('<h2 id="shapes">') : page.index('<h2 id="models">')]
    assert '<div id="turning"></div>' in section
    assert 'id="turning"' not in render_page(fixture_results(), tmp_path)


def test_the_name_of_a_material_stands_beside_its_constants_until_they_change():
    shaft = sg.load("geometry/shaft_stepped.toml")
    steel = sg.Material(E="210 GPa", nu=0.3, density=7850, name="20MnCr5")
    named = shaft.with_changes(material=steel)
    told = dict(scene_facts(Record(scene=named.as_dict())).rows)
    assert told["material"].startswith("20MnCr5: E = 210 GPa")
    assert steel.with_changes(E="70 GPa").name == "" and steel.with_changes(E="210 GPa").name
