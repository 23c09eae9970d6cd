"""The chart on file, in the terminal and in the report."""

from __future__ import annotations

import csv
import json
from copy import deepcopy
from dataclasses import replace
from pathlib import Path

import pytest

import solidgear as sg
from solidgear.comparison.race import command
from solidgear.comparison.race import race as race_rows
from solidgear.comparison.race import timing as racing
from solidgear.comparison.race.figure import UNLISTED, race_chart
from solidgear.comparison.race.race import (
    MACHINE,
    PICTURE,
    ROWS,
    Race,
    Reference,
    Row,
    race_of,
    read_race,
    records,
    write_rows,
)
from solidgear.comparison.race.sheet import front_rows
from solidgear.comparison.race.timing import AUTO, answer, plan, race
from solidgear.core.quantity import QUANTITIES
from solidgear.show.panel import SHAPES
from solidgear.show.plot import Chart
from tests.charted import SETUP, few, texts_of, words_of
from tests.plain import render_page, write_report

ROOT = Path(__file__).parent.parent
SCENE = ROOT / "geometry" / "shaft_stepped.toml"
COARSE = {"order": 3, "layers": 0, "edge_layers": 0}
#: of the chart in the report
SPEED = 'aria-label="Error against wall time'


@pytest.fixture(scope="module", autouse=True)
def light():
    """A small plan and a small reference, solved once, so that what is tested is the way of the
    numbers, not their size.
    """
    solve, known = racing._reference, {}

    def once(scene, sure, *rest):
        if sure not in known:
            known[sure] = solve(scene, sure, *rest)
        return deepcopy(known[sure])

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(command, "plan", few)
        patch.setattr(racing, "SURE", 1e-2)
        patch.setattr(racing, "_reference", once)
        patch.setattr(command, "setup_seconds", lambda: SETUP)
        yield


@pytest.fixture
def undrawn(monkeypatch):
    monkeypatch.setattr(Chart, "write", lambda chart, path: path)


def panels(found):
    """Rows of panels of a race, without the legend."""
    return [panel for row in race_chart(found).rows[:-1] for panel in row]


def marks(panel, shape):
    """Places of the markers of a shape, and the looks of the last of them."""
    layers = [(mark, rows) for mark, rows, _ in panel.layers if mark.get("shape") == SHAPES[shape]]
    return [row for _, rows in layers for row in rows]


# ------------------------------------------------------------------------------------------------- files
def test_what_is_written_is_what_is_read(raced, tmp_path):
    write_rows(raced, tmp_path)
    again = read_race(tmp_path)
    assert again.rows == raced.rows
    assert again == raced
    machine = json.loads((tmp_path / MACHINE).read_text())
    assert machine["environment"]["numpy"] and machine["environment"]["cores"]
    assert not list(tmp_path.glob(".*"))


def test_rows_hold_every_case_with_runs_times_errors_and_reasons(raced, tmp_path):
    write_rows(raced, tmp_path)
    with open(tmp_path / ROWS, newline="") as f:
        lines = list(csv.DictReader(f))
    assert len(lines) == 5
    beam, bad = lines[1], lines[3]
    assert (beam["status"], beam["runs"], beam["options"]) == ("ok", "2", "elements=1")
    assert float(beam["seconds_min"]) <= float(beam["seconds_median"]) <= float(beam["seconds_max"])
    assert len(beam["samples"].split()) == 2
    value, reference = float(beam["C_zz"]), raced.reference.values["C_zz"]
    assert float(beam["error_C_zz"]) == pytest.approx(abs(value / reference - 1))
    assert float(beam["like_for_like_C_zz"]) > 0 and float(beam["error_C_6x6"]) > 0
    assert (
        bad["status"] == "failed"
        and "order 99" in bad["reason"]
        and bad["error_C_zz"] == ""
        and bad["front_C_zz"] == ""
    )
    # the last case is within the bar of the reference, which is as good as it gets
    assert lines[4]["resolved_C_zz"] == "no" and "seconds" in lines[4]["front_C_zz"]


@pytest.mark.parametrize(
    ("name", "text"), [(MACHINE, "{"), (MACHINE, "{}"), (MACHINE, "[]"), (ROWS, "a,b\n1,2\n")]
)
def test_a_damaged_file_is_no_race_and_no_crash(raced, tmp_path, name, text):
    write_rows(raced, tmp_path)
    (tmp_path / name).write_text(text)
    assert read_race(tmp_path) is None
    assert race_of(tmp_path, raced.scene) is None


# ------------------------------------------------------------------------------------------------- figure
def test_both_quantities_are_charted_over_both_costs(raced):
    found = panels(raced)
    assert len(found) == 4
    names = {panel.y.title for panel in found}
    assert names == {"error of port compliance C_zz", "error of first bending frequency"}
    assert all(panel.x.log and panel.y.log for panel in found)


def test_failures_are_crosses_where_their_cost_is_known(raced):
    over_seconds, over_unknowns = panels(raced)[:2]
    (cross,) = marks(over_seconds, "x")
    assert cross["x"] == raced.rows[3].samples[0]
    assert not marks(over_unknowns, "x")


def test_a_number_that_is_missing_is_a_cross_in_its_own_panels():
    row = Row(
        "hexahedra",
        "HEX8 uniform",
        1,
        "solid",
        {},
        "ok",
        "found no bending 1",
        300,
        [0.5],
        {"C_zz": 1.01},
        {"C_zz": 0.01},
    )
    reference = Reference(
        model="harmonic solid",
        options=COARSE,
        setting="order 3",
        unknowns=1,
        seconds=9.0,
        values={"C_zz": 1.0, "bending 1": 1.0},
        bands={"C_zz": 1e-6, "bending 1": 1e-6},
    )
    made = Race({}, reference, [row], {}, 1, 10, 1.0)
    assert [len(marks(panel, "x")) for panel in panels(made)] == [0, 0, 1, 1]


def test_points_below_the_bar_stand_on_it(raced):
    panel = panels(raced)[0]
    bar = raced.reference.bands["C_zz"]
    assert [row["y"] for row in marks(panel, "D")] == [bar]
    for mark, rows, _ in panel.layers:
        if mark["type"] == "point" and mark["shape"] != SHAPES["*"]:
            assert all(row["y"] >= bar for row in rows)


def test_beams_show_like_for_like_beside_their_own_error(raced):
    row = raced.rows[1]
    heights = [mark["y"] for mark in marks(panels(raced)[0], "s")]
    assert heights == [row.errors["C_zz"], row.like_for_like["C_zz"]]


@pytest.mark.long
def test_the_automatic_choice_is_charted_at_its_largest_system():
    # the finest mesh is solved for bending and last for torsion alone, which has a fifth of it
    scene = sg.load("geometry/shaft_stepped.toml")
    found = answer(scene, AUTO, {"tol": 1e-3}, 10)
    told = sg.answer(scene, 1e-3, QUANTITIES)
    most = max(step.unknowns or 0 for step in told.steps)
    # a mesh is told with all systems that were solved on it; the largest of three is no less than a third
    assert most / 3 <= found.body.size <= most


@pytest.mark.slow
def test_the_automatic_choice_is_a_line_of_its_own_and_within_its_tolerance():
    rows = [row for row in plan(sg.load(SCENE)) if row.model == AUTO][:2]
    found = race(sg.load(SCENE), rows, runs=1, sure=2e-4)
    # a twentieth of the tighter tolerance
    assert max(found.reference.bands.values()) < 5e-4
    assert [row.status for row in found.rows] == ["ok", "ok"]
    for row in found.rows:
        assert max(row.errors.values()) < row.options["tol"]
        assert row.unknowns > 0
    assert {"10 %", "1 %"} <= set(texts_of(panels(found)[0]))


def test_picture_is_a_png(raced, tmp_path):
    path = race_chart(raced).write(tmp_path / PICTURE)
    assert path.read_bytes()[:4] == b"\x89PNG"


def test_front_table_lists_the_front_over_time(raced):
    names = {row.series for row, _ in front_rows(raced)}
    assert names == {r.series for q in raced.reference.values for r in raced.front(q)}
    assert raced.error_text(raced.rows[4], "C_zz").startswith("< ")


def test_where_there_is_no_error_the_reason_stands(raced):
    failed = raced.rows[3]
    assert failed.reason and raced.error_text(failed, "C_zz") == failed.reason
    assert raced.error_text(replace(raced.rows[4], errors={}), "C_zz") == "found no C_zz"
    assert raced.error_text(replace(failed, status="waiting", reason=""), "C_zz") == "waiting"


def test_left_out_names_the_first_level_of_each_series(raced):
    rows = [
        Row("hexahedra", "HEX20 graded", k, "solid", {}, "left out" if k > 1 else "ok")
        for k in (1, 2, 3)
    ]
    made = Race({}, raced.reference, rows, {}, 1, 10, 1.0)
    assert made.left_out == "HEX20 graded from level 2"


def test_an_unknown_family_is_drawn_in_grey_and_named_in_the_legend(raced):
    row = Row("shells", "S4 graded", 1, "shell", {}, "ok", "", 90, [0.3], {}, {"C_zz": 0.01})
    chart = race_chart(Race({}, raced.reference, [row], {}, 1, 10, 1.0))
    colours = {mark["stroke"] for mark, *_ in chart.rows[0][0].layers if mark.get("size") == 45}
    assert colours == {UNLISTED}
    assert texts_of(chart.rows[-1][0])[:2] == ["SHELLS", "S4 graded"]


# ------------------------------------------------------------------------------------------------- report
@pytest.mark.long
def test_report_has_the_section_when_its_folder_has_a_race_of_the_scene(raced, tmp_path):
    results = {"scene": raced.scene, "models": {}}
    assert SPEED not in render_page(results, tmp_path)
    write_rows(raced, tmp_path)
    page = render_page(results, tmp_path)
    assert SPEED in page and "The Pareto front over wall time" in page
    # what is read off it is what the table says
    chart = page[page.index(SPEED) :]
    row = next(row for row in raced.rows if row.status == "ok")
    (found,) = {w for w in words_of(chart) if w.startswith(f"{row.series}\nerror of C_zz")}
    assert f"C_zz: {raced.error_text(row, 'C_zz')}\n" in found
    assert f"unknowns: {row.unknowns}" in found
    assert "order 99" in page
    other = {"scene": raced.scene | {"name": "another"}, "models": {}}
    assert SPEED not in render_page(other, tmp_path)
    assert SPEED not in render_page(results)


# ------------------------------------------------------------------------------------------------- command
@pytest.mark.long
def test_command_writes_everything_and_puts_the_chart_into_a_report(run, tmp_path, no_charts):
    scene = sg.load(SCENE)
    out = tmp_path / "there"
    results = {"scene": json.loads(json.dumps(scene.as_dict())), "models": {}}
    out.mkdir()
    (out / "results.json").write_text(json.dumps(results))
    write_report(results, out)
    before = (out / "report.html").read_text()
    code, text, _ = run("chart", SCENE, "--out", out, "--runs", "1")
    assert code == 0
    assert {p.name for p in out.iterdir()} == {
        "results.json",
        "report.html",
        ROWS,
        MACHINE,
        PICTURE,
    }
    assert (
        "Pareto front over wall time" in text
        and "failed: harmonic p graded, level 1" in text
        and "report.html" in text
    )
    assert SPEED not in before and SPEED in (out / "report.html").read_text()
    assert json.loads((out / "results.json").read_text()) == results


def test_command_refuses_a_comparison_of_an_older_version_before_it_times_anything(
    run, tmp_path, monkeypatch
):
    monkeypatch.setattr(racing, "_run", lambda *_: pytest.fail("timed"))
    old = {"schema": 2, "scene": json.loads(json.dumps(sg.load(SCENE).as_dict())), "models": {}}
    text = json.dumps(old)
    (tmp_path / "results.json").write_text(text)
    code, out, err = run("chart", SCENE, "--out", tmp_path, "--runs", "1")
    assert code == 1 and out == "" and "results.json: written by an older version" in err
    assert {p.name for p in tmp_path.iterdir()} == {"results.json"}
    assert (tmp_path / "results.json").read_text() == text


@pytest.mark.long
def test_json_is_for_machines_and_the_report_of_another_scene_stays(run, tmp_path, undrawn):
    (tmp_path / "results.json").write_text(json.dumps({"scene": {"name": "another"}, "models": {}}))
    code, text, err = run("chart", SCENE, "--out", tmp_path, "--runs", "1", "--json")
    assert "report.html" not in text and not (tmp_path / "report.html").exists()
    found = json.loads(text, parse_constant=lambda word: pytest.fail(word))
    assert code == 0 and err == ""
    assert (
        found["complete"] is True
        and len(found["rows"]) == 5
        and found["rows"][3]["error_C_zz"] is None
    )


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--runs", "0"), "--runs 0"),
        (("--runs", "-3"), "--runs -3"),
        (("--budget", "0"), "--budget 0"),
        (("--budget", "nan"), "--budget nan"),
        (("--budget", "inf"), "--budget inf"),
    ],
)
def test_command_refuses_bad_options_in_a_sentence_and_writes_nothing(
    run, tmp_path, arguments, said
):
    code, out, err = run("chart", SCENE, "--out", tmp_path / "new", *arguments)
    assert code == 1 and out == "" and said in err and err.count("\n") == 1
    assert not (tmp_path / "new").exists()


def test_command_refuses_a_folder_that_cannot_be_written(run, tmp_path):
    (tmp_path / "file").write_text("")
    code, _, err = run("chart", SCENE, "--out", tmp_path / "file" / "inside")
    assert code == 1 and "--out" in err


def test_an_interrupt_leaves_rows_and_chart_of_what_there_was(run, tmp_path, monkeypatch):
    real, seen = racing._run, []

    def interrupted(scene, row, *rest):
        if len(seen) == 2:
            raise KeyboardInterrupt
        seen.append(row.series)
        real(scene, row, *rest)

    monkeypatch.setattr(racing, "_run", interrupted)
    code, _, _ = run("chart", SCENE, "--out", tmp_path)
    assert code == 130
    found = read_race(tmp_path)
    assert not found.complete and sorted(len(r.samples) for r in found.rows) == [0, 0, 0, 1, 1]
    assert (tmp_path / PICTURE).exists()
    assert [r["reason"] for r in records(found)].count("interrupted") == 3


@pytest.mark.slow
def test_rows_are_written_as_they_come(run, tmp_path, monkeypatch, undrawn):
    """A process that is killed leaves what it had measured."""
    lengths, real = [], race_rows.write_rows

    def watch(found, folder):
        real(found, folder)
        lengths.append(sum(bool(r.samples) for r in read_race(folder).rows))

    monkeypatch.setattr(command, "write_rows", watch)
    run("chart", SCENE, "--out", tmp_path, "--runs", "1")
    assert lengths[:5] == [1, 2, 3, 4, 5]
