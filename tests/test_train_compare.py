"""A train is compared as a shaft is: one command, one folder, one page; and no command takes the
other's file in silence.
"""

import json
import re
from pathlib import Path

import pytest

from tests.command import command, page_of, table

ROOT = Path(__file__).parent.parent
TRAIN, SHAFT = "geometry/axle_overhung.toml", "geometry/pinion_overhung.toml"


@pytest.fixture(scope="module")
def compared(tmp_path_factory):
    """The shipped train on coarse meshes; --json, so that what is printed is what is stored."""
    out = tmp_path_factory.mktemp("train") / "out"
    done = command("compare", TRAIN, "--out", out, "--json", "--no-renders", "--tol", "0.05")
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout), out


@pytest.mark.long
def test_the_page_says_what_is_stored_and_needs_no_other_file(compared):
    found, out = compared
    verdict = found["verdict"]
    assert verdict["cheapest"] == {"pinion": "harmonic", "gear": "harmonic"}
    drawn = {"left_out": [], "pictures": {}}
    page, text = page_of(out, found | drawn, [*verdict["sentences"], *verdict["cautions"]])
    for mix in found["verdict"]["mixes"]:
        end = mix["force_to_hz"]
        assert end is None or f" {end:.0f} " in text
    for mode in found["modes"]["modes"]:
        assert mode["name"] in text and f"{mode['frequency_hz']:.2f}" in text
    assert "Assumed, not published: mesh.transmission_error." in text
    assert "2 µm" in text
    # the viewer with its data, and what reads values off charts
    scripts = re.findall(r"<script[^>]*>(.*?)</script>", page, re.S)
    assert len(scripts) == page.count("<script") == 3
    assert not any(re.search(r"https?:|fetch\(|XMLHttp|import", text) for text in scripts)
    assert 'aria-label="' in page and "mesh force: " in page


@pytest.mark.long
def test_the_table_of_the_folder_is_the_judges_response(compared):
    found, out = compared
    rows = table(out / "response.csv")
    size = {float(r["frequency [Hz]"]): float(r["mesh force [N]"]) for r in rows}
    for peak in found["peaks"]:
        near = min(size, key=lambda hz: abs(hz - peak["frequency_hz"]))
        assert size[near] == pytest.approx(peak["force"], rel=1e-6)


@pytest.mark.parametrize("name", ["stiffness", "modes", "answer", "render", "chart"])
def test_commands_of_a_shaft_name_those_of_a_train(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = command(name, ROOT / TRAIN)
    assert done.exit_code == 1 and not list(tmp_path.iterdir())
    assert "run solidgear compare, check, system-modes, response or receptance" in str(
        done.exception
    )


@pytest.mark.parametrize("name", ["system-modes", "response", "judge-system", "receptance"])
def test_commands_of_a_train_name_those_of_a_shaft(name, tmp_path):
    more = ["--out", tmp_path / "out"] if name != "system-modes" else []
    more += ["--from", "a:x", "--to", "b:x"] if name == "receptance" else []
    done = command(name, SHAFT, *more)
    assert done.exit_code == 1
    assert "the scene of one shaft" in str(done.exception)
    assert "solidgear compare, answer or modes" in str(done.exception)
    assert not (tmp_path / "out").exists() or not list((tmp_path / "out").iterdir())


@pytest.mark.parametrize(
    "option", [["--models", "euler"], ["--set", "harmonic.order=3"], ["--chart"]]
)
def test_options_for_one_shaft_are_refused_for_a_train(option, tmp_path):
    done = command("compare", TRAIN, "--out", tmp_path / "out", *option)
    assert done.exit_code == 1 and f"{option[0]} is for one shaft" in str(done.exception)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("others", [[], [ROOT / "geometry/axle_straddle.toml"]], ids=["one", "two"])
def test_the_tolerance_of_the_meshes_of_trains_is_that_of_the_option(others, monkeypatch):
    class Asked(Exception):
        pass

    def assembled(*_, tol, **__):
        raise Asked(tol)

    monkeypatch.setattr("solidgear.trains.options.Assembly", assembled)
    done = command("compare", TRAIN, *others, "--tol", "3%")
    assert isinstance(done.exception, Asked) and done.exception.args == (0.03,), done.output


@pytest.mark.parametrize("count, said", [(1, "--tol is for trains"), (2, "--tol does not apply")])
def test_a_tolerance_of_meshes_is_refused_for_shafts(count, said):
    shafts = [SHAFT, ROOT / "geometry/shaft_stepped.toml"][:count]
    done = command("compare", *shafts, "--tol", "0.01")
    assert done.exit_code == 1 and said in str(done.exception)
