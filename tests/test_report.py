"""The report says everything the run found, escapes what it was given, and survives a run that
broke off.
"""

from __future__ import annotations

import copy
import io
import re
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

import solidgear as sg
from solidgear.app.modes import modes_table
from solidgear.comparison.page import charts
from solidgear.comparison.recording import Findings, as_record, recorded
from solidgear.core.errors import SolidgearError
from solidgear.core.judge.open_numbers import OpenNumbers
from solidgear.core.judge.record import SCHEMA, Record
from solidgear.show import input_tables, viewer
from solidgear.show.page_parts import data_uri
from solidgear.show.plot import WIDE
from solidgear.show.terminal import matrix_table
from solidgear.show.units import ENGINEERING
from solidgear.show.viewer import END, START, TURNED
from solidgear.show.words import engineering, hertz, percent
from tests.made_up_run import STIFFNESS, fixture_results
from tests.plain import final_table, render_page, verdict_text, write_report

ROOT = Path(__file__).parent.parent


@pytest.fixture(scope="module")
def page(made_up_charts):
    return render_page(fixture_results(), drawn=made_up_charts)


@pytest.fixture(scope="module")
def si_page(made_up_charts):
    """Charts are the same in all units."""
    return render_page(fixture_results() | {"shown_in": "si"}, drawn=made_up_charts)


def text_of(page):
    return re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", page))  # a space that does not break, too


def shown(renderable, width=80):
    console = Console(width=width, file=io.StringIO(), color_system=None)
    console.print(renderable)
    return console.file.getvalue()


# ------------------------------------------------------------------------------------------------- the page
#: the one script of the page
READS = f"<script>\n{(Path(viewer.__file__).parent / 'readout.js').read_text().rstrip()}</script>"


def test_page_needs_no_other_file_and_no_network(page):
    assert not re.search(r"""(src|href)\s*=\s*["'](?!data:|#)""", page)
    assert page.count("<script") == 1 and page.count(READS) == 1, "one script, and it is ours"
    assert not re.search(r"https?:|fetch|XMLHttp|import", READS)
    assert "@import" not in page and "<link" not in page
    assert not re.search(r"url\((?!#)", page)
    assert page.count("<svg") == 2 * 8, "a wide and a narrow one for each chart"


#: elements that a label may name without a role
NAMED = ("section", "nav", "select", "input", "button")


def test_what_has_a_label_has_a_role(page):
    labelled = re.findall(r"<(\w+)([^>]*\saria-label=[^>]*)>", page)
    assert len(labelled) > 100
    assert [tag for tag, rest in labelled if tag not in NAMED and " role=" not in rest] == []


def test_pictures_are_dark_where_the_page_is_and_cut_tables_show_it(page):
    dark = re.findall(r"@media screen and \(prefers-color-scheme: dark\) \{ (.+) \}\n", page)
    assert any("figure img" in rule and "invert" in rule for rule in dark)
    scroll = re.search(r"\.scroll \{[^}]*\}", page)[0]
    # the cover moves with the table, the shade stays at the edge
    assert "background-attachment: local, local, scroll, scroll" in scroll


def test_a_picture_is_in_the_page_once(tmp_path, no_charts):
    picture = tmp_path / "mode.png"
    picture.write_bytes(b"\x89PNG made up")
    results = fixture_results() | {"images": {"harmonic": "mode.png"}, "files": [TURNED]}
    uri = data_uri("harmonic", picture)
    viewer = (
        f'<div class="sg-turn has-still"><img src="{uri}" alt="Mode shape, deformation enlarged">'
    )
    (tmp_path / TURNED).write_text(f"{START}\n{viewer}</div>\n{END}")
    assert render_page(results, tmp_path).count(uri) == 1
    # the viewer's own stands in where no other picture does
    assert render_page(results | {"images": {}}, tmp_path).count(uri) == 1


def test_identifiers_of_the_charts_do_not_collide(page):
    ids = re.findall(r'\sid="([^"]+)"', page)
    assert len(ids) == len(set(ids))
    assert set(re.findall(r'(?:url\(|href=")#([^")]+)', page)) <= set(ids)


def test_figures_of_the_run_are_on_the_page(page):
    # 240 130: K_z,thx in kN/rad; 2758 Hz: with a bar of 0.05 %, the fourth is the first uncertain one
    figures = "4710.8 N/µm|7327.9|1136.4|240 130|19 010 000 N m/rad|2758 Hz|0.59611 µm/kN|3343.9"
    figures += "|1385.6|138 210|0.12 %|35.3|2610|+26.0 %|-43.1 %|0.9993|3.1e-14|29.1226"
    figures += "|58.2453|5415.5|published|identified|Seat width assumed.|41.2|2.4.0"
    assert not [figure for figure in figures.split("|") if figure not in text_of(page)]


def test_the_same_figures_in_si(si_page):
    figures = "4.7108e9 7.3279e9 1.1364e9 240.13e6 19.010e6 596.11e-12 5.4155e9".split()
    assert not [figure for figure in figures if figure not in text_of(si_page)]


def test_page_says_where_the_error_sits(page):
    assert "97 % of what is left in C_zz sits at the shoulder at y = 186 mm" in page
    assert "1: shoulder, y = 186 mm, 97 %" in page  # beside the picture


def test_page_shows_the_surface_that_the_error_of_a_3d_solid_sits_on(tmp_path, no_charts):
    picture = tmp_path / "error_solid.png"
    picture.write_bytes(b"\x89PNG made up")
    where = {
        "model": "solid",
        "quantity": "C_thx",
        "total": 4e-3,
        "sentence": "71 % of the error bar of C_thx arises at the shoulder at y = 60 mm",
        "picture": "../elsewhere/error_solid.png",  # inside the folder only
    }
    page = render_page(fixture_results() | {"where_solid": where}, tmp_path)
    assert page.count(data_uri("solid", picture)) == 1
    (words,) = re.findall(r'alt="(Surface of the 3D solid: [^"]*)"', page)
    assert "of the error bar of C_thx" in words and "at the shoulder at y = 60 mm" in words
    told = f"{where['sentence']} (a bound in one order more, 0.40 %, on the mesh of the 3D solid)."
    assert f"<p>{told}</p>" in page
    # without the file, or without a 3D solid
    assert "Surface of" not in render_page(fixture_results() | {"where_solid": where})
    assert told not in render_page(fixture_results(), tmp_path)


def test_every_matrix_names_its_units(page, si_page):
    for text, turn, soft in ((page, "N m/rad", "µrad/(kN m)"), (si_page, "N m/rad", "rad/(N m)")):
        matrices = re.findall(r'<table class="matrix">.*?</table>', text, re.S)
        kinds = [re.search("stiffness|compliance", m).group() for m in matrices]
        assert kinds == ["stiffness", "compliance"] + 3 * ["stiffness"]  # the judge's, the others'
        for kind, shown_ in zip(kinds, matrices):
            assert f">{turn if kind == 'stiffness' else soft}</td>" in shown_
    for model in STIFFNESS:
        assert engineering(STIFFNESS[model][3]) in text_of(si_page)


def test_free_motion_is_a_dash_in_both_matrices(page):
    table = page[page.index("Harmonic solid: stiffness") :]
    row = re.search(r'<th scope="row">thy</th>(.*?)</tr>', table).group(1)
    assert re.findall(r">([^<]+)</td>", row) == ["–"] * 6


def test_small_difference_is_called_not_resolved(page):
    assert 'class="unresolved">not resolved (+0.098 %)</td>' in page
    assert "validated against experiment" in page and "Code verification" in page


def test_compliance_comes_first_among_differences(page):
    part = page[page.index('id="deviations"') : page.index('id="causes"')]
    assert re.findall(r'<tr><th scope="row">([^<]+)</th>', part) == ["C_zz", "K_zz", "bending 1"]


def test_same_results_same_page_from_numpy_or_plain(no_charts):
    results = fixture_results()
    for model in results["models"].values():
        model["compliance"] = np.array(
            [[np.nan if v is None else v for v in row] for row in model["compliance"]]
        )
        model["unknowns"] = np.int64(model["unknowns"])
    assert render_page(results) == render_page(fixture_results())


def test_names_from_a_scene_are_escaped(monkeypatch):
    named = {name: charts.CHARTS[name] for name in ("sketch", "modes", "mac", "where")}
    undrawn = dict.fromkeys(charts.CHARTS, lambda results: None)
    monkeypatch.setattr(charts, "CHARTS", undrawn | named)
    results = fixture_results()
    evil = '<script>alert("x")</script>$\\frac{'
    for part in (
        results["scene"],
        results["scene"]["bearings"][0],
        results["scene"]["segments"][0],
        results["scene"]["port"],
    ):
        part["name"] = evil
    results["scene"] |= {"title": evil, "source": evil}
    results["scene"]["bearings"][1]["note"] = "<img src=http://x/>"
    results["models"]["harmonic"]["modes"][1]["name"] = evil
    results["cautions"], results["verdict"]["sentences"] = [evil], [evil]
    page = render_page(results)
    page = page.replace(READS, "")
    assert "<script" not in page and "<img" not in page and "&lt;script&gt;" in page
    assert page.count("<svg") == 2 * len(named)


# ------------------------------------------------------------------------------------------------- missing parts
def test_interrupted_run_has_a_banner(page, no_charts):
    assert "Interrupted run" not in page
    results = fixture_results() | {"complete": False, "missing": ["3D solid"]}
    del results["models"]["solid"], results["verdict"]
    page = render_page(results)
    assert (
        "Interrupted run" in page
        and "models without results: 3D solid" in page
        and "No verdict" in page
    )


PARTS = [(key,) for key in fixture_results()] + [tuple(fixture_results())]


@pytest.mark.parametrize("gone", PARTS, ids=lambda gone: "everything" if len(gone) > 1 else gone[0])
def test_any_part_may_be_missing(no_charts, gone):
    for results in (
        fixture_results() | dict.fromkeys(gone),
        {k: v for k, v in fixture_results().items() if k not in gone},
    ):
        assert "</html>" in render_page(results)
        shown(final_table(results))
        verdict_text(results)


@pytest.mark.parametrize("gone", list(fixture_results()["models"]["harmonic"]))
def test_any_part_of_a_model_may_be_missing(no_charts, gone):
    results = fixture_results()
    for model in results["models"].values():
        model[gone] = None
    assert "</html>" in render_page(results)
    assert "harmonic" in shown(final_table(results))
    del results["models"]["solid"][gone]
    assert "</html>" in render_page(results)


@pytest.mark.parametrize(
    "name, needs",
    [
        ("sketch", "scene"),
        ("modes", "models"),
        ("mac", "mac"),
        ("convergence", "models"),
        ("where", "where"),
        ("causes", "causes"),
        ("cost", "models"),
        ("attachments", "attachments"),
    ],
)
def test_chart_without_its_data_is_none(name, needs):
    assert charts.CHARTS[name](as_record(fixture_results() | {needs: None})) is None
    assert charts.CHARTS[name](Record()) is None


def test_charts_draw_what_is_left_of_a_broken_off_run():
    results = fixture_results() | {"verdict": None, "port": None}
    del (
        results["models"]["solid"],
        results["models"]["harmonic"]["band"],
        results["models"]["harmonic"]["convergence"]["quantities"]["bending 1"],
    )
    results["models"]["harmonic"]["convergence"]["levels"][0]["h"] = None
    results["scene"]["port"], results["scene"]["bearings"] = None, []
    results["causes"][0]["quantities"]["C_zz"] = None
    record = as_record(results)
    assert charts.CHARTS["sketch"](record)
    drawn = [make(record, WIDE) for make in charts.DESCRIBED.values()]
    assert all(chart.svg() for chart in drawn if chart is not None)


def test_chart_that_fails_costs_only_itself(monkeypatch):
    def broken(results):
        raise ValueError("no pen")

    monkeypatch.setattr(
        charts, "CHARTS", dict.fromkeys(charts.CHARTS, broken) | {"causes": charts.CHARTS["causes"]}
    )
    page = render_page(fixture_results())
    assert "no pen" in page and page.count("<svg") == 2 and "</html>" in page


def test_models_without_a_record_are_named_by_the_ladder():
    scene = sg.load(ROOT / "geometry" / "shaft_stepped.toml")
    record = recorded(scene, Findings(failed={"euler": "no memory"}, complete=False))
    assert record.missing == ["Timoshenko beam", "harmonic solid", "3D solid"]
    assert record.models["euler"].title == "Euler beam"


def test_model_without_a_title_is_called_by_its_key(no_charts):
    results = fixture_results()
    for model in results["models"].values():
        del model["title"], model["short"]
    assert "harmonic: stiffness" in render_page(results).lower()
    assert "Trust: harmonic\n" in verdict_text(results)
    assert "timoshenko" in shown(final_table(results))


# ------------------------------------------------------------------------------------------------- the border
@pytest.mark.parametrize("version", [1, 2, SCHEMA + 1, "x"])
def test_results_of_another_version_are_refused_in_a_sentence(version):
    which = "an older" if version in (1, 2) else "another"
    with pytest.raises(SolidgearError, match=f"written by {which} version") as refused:
        as_record(fixture_results() | {"schema": version})
    assert "run solidgear compare again" in str(refused.value)
    assert "\n" not in str(refused.value)


def test_what_is_no_record_is_refused_with_the_place_of_the_fault():
    results = fixture_results()
    results["models"]["solid"]["unknowns"] = "many"
    with pytest.raises(SolidgearError, match=r"models\.solid\.unknowns") as refused:
        as_record(results)
    assert "\n" not in str(refused.value)


def test_a_record_comes_back_from_its_plain_data():
    record = Record.model_validate(fixture_results())
    assert as_record(record.as_dict()) == record


# ------------------------------------------------------------------------------------------------- the file
PNG = b"\x89PNG\r\n\x1a\n" + b"0" * 20


def test_file_is_written_whole_with_its_pictures(tmp_path, no_charts):
    for name in ("harmonic.png", "solid.png"):
        (tmp_path / name).write_bytes(PNG)
    (tmp_path / "timoshenko.png").write_bytes(b"no picture")
    names = {key: f"{key}.png" for key in STIFFNESS}
    path = write_report(fixture_results() | {"images": names}, tmp_path)
    page = path.read_text(encoding="utf-8")
    assert path == tmp_path / "report.html"
    assert page.count('src="data:image/png;base64,') == 2
    assert page.count("could not be made or read") == 2  # one is not there, one is none
    assert not list(tmp_path.glob(".*"))


def test_pictures_named_by_the_results_come_from_the_folder_only(tmp_path, no_charts):
    (tmp_path / "secret.png").write_bytes(PNG)
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "mode_solid.png").write_bytes(PNG)
    page = write_report(
        fixture_results() | {"images": {"solid": "mode_solid.png", "euler": "../secret.png"}},
        tmp_path / "out",
    ).read_text(encoding="utf-8")
    assert page.count('src="data:image/png;base64,') == 1


def test_failed_report_leaves_the_old_one(tmp_path, monkeypatch, no_charts):
    path = write_report(fixture_results(), tmp_path)
    before = path.read_bytes()
    monkeypatch.setattr("solidgear.comparison.page.html.render_page", lambda *a: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        write_report(fixture_results(), tmp_path)
    assert path.read_bytes() == before and len(list(tmp_path.iterdir())) == 1


# ------------------------------------------------------------------------------------------------- the terminal
def test_final_table_fits_eighty_columns():
    text = shown(final_table(fixture_results()), width=200)
    assert max(len(line.rstrip()) for line in text.splitlines()[:8]) <= 80
    text = shown(final_table(fixture_results()), width=80)
    assert "…" not in text and "\x1b" not in text
    words = "4711|0.5961|N/um|um/kN|2758.1|138k|0.12 %|24.7|n.r.|smaller than the error bars|ref."
    assert not [word for word in words.split("|") if word not in text]
    assert "shear: the shaft is stubby" in text


def test_final_table_survives_names_with_brackets():
    results = fixture_results()
    odd = copy.deepcopy(results["models"]["solid"])
    del odd["title"], odd["short"]
    results["models"]["[red]x[/nonsense]"] = odd
    assert "[red]x" in shown(final_table(results))


def test_verdict_names_model_and_tolerance():
    text = verdict_text(fixture_results())
    assert "harmonic solid" in text and "5 %" in text and "- The Timoshenko beam" in text


@pytest.mark.parametrize("kind, unit", [("stiffness", "N m/rad"), ("compliance", "rad/(N m)")])
def test_matrix_table_has_units_and_fits(kind, unit):
    text = shown(matrix_table(fixture_results()["models"]["harmonic"][kind], kind))
    assert unit in text and "…" not in text and max(map(len, text.splitlines())) <= 80


def test_modes_table_lists_pairs():
    text = shown(
        modes_table(as_record(fixture_results()).models["harmonic"].modes, {}, OpenNumbers())
    )
    assert "rigid torsion" in text and "2758.1" in text


@pytest.mark.parametrize(
    "value, text",
    [
        (4.71078133e9, "4.7108e9"),
        (-2.40131e8, "-240.13e6"),
        (9.999999e5, "1.0000e6"),
        (0.0, "0"),
        (None, "–"),
        (float("nan"), "–"),
        (53.93, "53.930"),
        (5.96e-10, "596.00e-12"),
    ],
)
def test_engineering(value, text):
    assert engineering(value) == text


@pytest.mark.parametrize(
    "value, text",
    [
        (0.2603, "+26.0 %"),
        (-0.0654, "-6.54 %"),
        (0.0012, "+0.12 %"),
        (3.2e-5, "+0.0032 %"),
        (0.0, "0 %"),
        (-4.7e-15, "<1e-6 %"),
        (None, "–"),
    ],
)
def test_percent(value, text):
    assert percent(value) == text
    assert hertz(2758.09) == "2758.1"


def test_a_material_of_a_segments_own_has_its_units():
    steel = {"E": 2.1e11, "nu": 0.3, "density": 7850.0}
    stack = {"E": 4e10, "nu": 0.28, "density": 7600.0}
    told = input_tables._own_material(stack, steel, ENGINEERING)
    assert told == "E 40 GPa, nu 0.28, density 7600 kg/m³"
