"""Scenes without a lumped point: natural frequencies need none, and what is lumped asks for one."""

import json
import tomllib
from pathlib import Path

import pytest

import solidgear as sg
from solidgear.core.judge.quantities import judged

FOUND = Path(__file__).parent / "found"
HUNG = FOUND / "people/free_shaft.toml"


def test_a_hung_shaft_has_natural_frequencies(run):
    code, out, _ = run("modes", HUNG, "--json")
    modes = [mode for mode in json.loads(out)["modes"] if mode["frequency_hz"] > 0]
    assert code == 0 and modes[0]["name"] == "bending 1"
    # with a point that nobody asks for: a section at its end holds nothing
    scene = sg.load(HUNG)
    end = sg.Port(name="end", y=0.0, lo=0.0, hi=0.12, attachment="section")
    with_point = sg.answer(scene.with_changes(port=end), ask="bending 1")["bending 1"]
    assert modes[0]["frequency_hz"] == pytest.approx(with_point, rel=0.005)  # both bars


def test_a_free_part_has_natural_frequencies_and_six_free_motions():
    scene = sg.load(FOUND / "parts/port_free.toml")
    assert scene.ports == ()
    modes = sg.modes(sg.build(scene, "solid", refinement=0.2), scene, n=8)
    free, elastic = modes.frequency_hz[:6], modes.frequency_hz[6:]
    assert list(free) == [0.0] * 6 and min(elastic) > 100.0


def test_it_is_judged_by_frequencies_alone():
    assert judged(sg.load(HUNG)) == ("bending 1", "axial 1")
    assert [v.quantity for v in sg.answer(HUNG).values] == ["bending 1", "axial 1"]


def test_it_is_checked_without_a_word_on_lumping():
    check = sg.check(HUNG)
    said = " ".join([*check.facts, *check.cautions])
    assert "bending 1 of the Euler beam is" in said
    assert "(start)" not in said and "not checked" not in said
    assert not [model for model in check.verdicts if model.startswith("lumped")]


def test_a_sweep_of_it_has_its_natural_frequencies():
    """Rows of it have no compliance, and the frequencies of `answer`."""
    rows = sg.sweep(HUNG, "segment.right.diameter=45 mm,50 mm", n=1)
    assert list(rows["status"]) == ["ok", "ok"] and "C_zz" not in rows.columns
    assert rows["f1_hz"][0] == pytest.approx(sg.answer(HUNG)["bending 1"], rel=1e-6)
    (beam,) = sg.sweep(HUNG, "segment.right.diameter=45 mm", model="timoshenko", n=1)["f1_hz"]
    assert beam == pytest.approx(rows["f1_hz"][0], rel=0.05)  # beam against solid


def test_a_search_for_what_it_has_not_is_refused(run):
    vary = ("--vary", "segment.left.diameter=38 mm:45 mm", "-f", "timoshenko")
    code, _, err = run("optimise", HUNG, *vary, "--goal", "min C_zz")
    said = " ".join(err.split())
    assert code != 0 and 'a design has no "C_zz"; it has mass,' in said


def test_measured_resonances_of_it_are_paired(run, tmp_path):
    (tmp_path / "peaks.csv").write_text("frequency [Hz]\n1300\n2630\n")
    code, out, _ = run("correlate", HUNG, tmp_path / "peaks.csv", "--tol", "1e-2", "--json")
    assert code == 0 and [p["mode"] for p in json.loads(out)["pairs"]] == ["bending 1", "bending 2"]


@pytest.mark.parametrize(
    "words",
    [("answer", "--ask", "C_zz"), ("stiffness",), ("compare", "--out", "page"), ("sensitivities",)],
    ids=lambda words: words[0],
)
def test_what_is_lumped_asks_for_a_point_that_can_be_pasted(words, run, tmp_path):
    code, _, err = run(words[0], HUNG, *words[1:])
    said = " ".join(err.split())
    assert code != 0 and "free_shaft has no lumped point" in said
    line = said[said.index("port = {") : said.index(", or where")]
    mended = tmp_path / "mended.toml"
    mended.write_text(f"{line}\n{HUNG.read_text()}")
    assert sg.load(mended).port.name == "gear"


def test_the_table_to_paste_names_what_a_body_without_an_axis_has():
    block = {"material": "steel", "body": {"block": [0.04, 0.02, 0.04]}}
    block["bearing"] = [{"name": "gear", "patch": "-y", "hold": "clamped"}]
    scene = sg.Scene.from_dict(block, name="pad")
    assert scene.ports == ()
    with pytest.raises(sg.SceneError, match="pad has no lumped point") as refused:
        _ = scene.port
    line = str(refused.value)
    port = tomllib.loads(line[line.index("port = {") : line.index(", or where")])
    assert sg.Scene.from_dict(block | port).port.patch.name != "-y"


def test_it_reads_back_and_takes_a_point_later():
    scene = sg.load(HUNG)
    assert sg.Scene.from_dict(scene.to_dict()) == scene and "port" not in scene.to_dict()
    assert scene.with_changes(port=sg.Port(y=0.1, lo=0.0, hi=0.12)).port.y == 0.1
    assert scene.with_attachment("rigid").ports == ()


def test_a_load_at_a_point_that_is_not_there_is_refused(tmp_path):
    loaded = tmp_path / "loaded.toml"
    loaded.write_text(HUNG.read_text() + '\n[load]\nz = "1 kN"\n')
    with pytest.raises(sg.SceneError, match="no lumped point"):
        sg.load(loaded)
