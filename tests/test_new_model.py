"""A model is one class: added to the ladder it is in every command, table, chart and picture."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import solidgear as sg
from solidgear.app.render import Drawn, render_mode
from solidgear.comparison.page.html import render_page
from solidgear.comparison.page.sheet import final_table
from solidgear.comparison.race.figure import race_chart
from solidgear.comparison.race.timing import plan, race
from solidgear.core.ladder.beams import Timoshenko
from solidgear.core.ladder.harmonic import Harmonic
from solidgear.core.ladder.model import Model
from solidgear.core.ladder.registry import LADDER
from solidgear.guards.check import check_scene
from tests.charted import texts_of

ROOT = Path(__file__).parent.parent
LIGHT = {"harmonic": {"order": 3, "layers": 1}}


class Coarse(Timoshenko):
    """The Timoshenko beam on a quarter of its elements."""

    name = "coarse"
    title = "coarse beam"
    heading = "coarse"
    preset = {"elements": 6}
    colour = "#123456"
    marker = "X"
    series = Model.series


class Quadratic(Harmonic):
    """The harmonic solid on elements of order 2, whatever its bars."""

    name = "quadratic"
    title = "harmonic solid of order 2"
    preset = {"order": 2}


@pytest.fixture(scope="module")
def ladder():
    patch = pytest.MonkeyPatch()
    patch.setattr(LADDER, "models", (*LADDER.models[:1], Coarse(), *LADDER.models[1:]))
    yield LADDER
    patch.undo()


@pytest.fixture(scope="module")
def scene():
    return sg.load(ROOT / "geometry" / "shaft_stepped.toml")


@pytest.fixture(scope="module")
def found(ladder, scene):
    return sg.compare(scene, ("coarse", "timoshenko", "harmonic"), settings=LIGHT)


def printed(renderable):
    from rich.console import Console

    console = Console(width=100, record=True, file=open("/dev/null", "w"))
    console.print(renderable)
    return console.export_text()


@pytest.mark.long
def test_it_is_compared_and_judged(found):
    record = found.record
    assert (record.models["coarse"].colour, record.models["coarse"].marker) == ("#123456", "X")
    assert list(record.models) == ["coarse", "timoshenko", "harmonic"]
    # fewer elements, marks of the scene included: measured 7 against 40
    assert record.models["coarse"].dofs < 0.6 * record.models["timoshenko"].dofs
    assert {d.model for d in record.deviations} == {"coarse", "timoshenko"}
    # like for like both beams are within 5 % (measured 2 %), so the cheaper one is the one to take
    judged = [m for m in record.models if record.models[m].valid]
    assert "coarse" in judged or record.models["coarse"].why_not


@pytest.mark.long
def test_it_is_in_the_tables_and_on_the_page(found, tmp_path):
    assert "coarse" in printed(final_table(found.record))
    page = render_page(found.record, tmp_path)
    assert "Coarse beam" in page and "#123456" in page


@pytest.mark.long
def test_it_is_drawn_and_written(found, ladder, tmp_path):
    body, modes = found.solutions["coarse"].body, found.solutions["coarse"].modes
    assert body.fidelity == "coarse"
    assert len(body.surface(modes.named("bending 1").vectors[0]).points) > 100
    try:
        assert (
            render_mode(Drawn(body, modes, "coarse"), "bending 1", tmp_path / "mode.png")
            .stat()
            .st_size
            > 1000
        )
    except sg.SolidgearError as error:
        pytest.skip(f"no pictures here: {error}")


@pytest.mark.long
def test_guards_have_a_verdict_on_it(ladder, scene):
    verdicts = check_scene(scene, sg.build(scene, "coarse")).verdicts
    # what is made for features alone has no verdict on a scene without
    assert set(verdicts) == {model.name for model in ladder if not model.for_features}
    # held against a solid as every beam: of more elements it is off by as much
    assert verdicts["coarse"] == verdicts["timoshenko"]


@pytest.mark.long
def test_a_solid_with_options_of_its_own_keeps_them_where_meshes_follow_bars(scene, monkeypatch):
    monkeypatch.setattr(LADDER, "models", (*LADDER.models, Quadratic()))
    found = sg.compare(scene, ("quadratic", "harmonic"))
    assert found.solutions["quadratic"].options["order"] == 2
    assert found.solutions["harmonic"].options["order"] > 2
    # too stiff by what its order leaves out, and it says so: the other lies within its bar
    coarse, fine = (found.record.models[m] for m in ("quadratic", "harmonic"))
    gap = fine.compliance[2][2] / coarse.compliance[2][2] - 1
    assert 0 < gap < coarse.band.each["C_zz"]


@pytest.mark.long
def test_it_is_charted(ladder, scene):
    rows = [row for row in plan(scene) if row.model == "coarse"]
    assert [(row.family, row.series, row.options) for row in rows] == [("beam", "coarse", {})]
    done = race(scene, rows, runs=1, budget=100.0, sure=1e-2)
    assert done.rows[0].status == "ok" and 0 < done.rows[0].errors["bending 1"] < 0.2
    texts = texts_of(race_chart(done))
    assert any("coarse" in text for text in texts)


@pytest.mark.long
def test_it_is_in_the_help_and_among_the_choices():
    code = (
        "import sys\n"
        "from solidgear.core.ladder.beams import Timoshenko\n"
        "from solidgear.core.ladder.registry import LADDER\n"
        "class Coarse(Timoshenko):\n"
        "    name, title = 'coarse', 'coarse beam'\n"
        "LADDER.models += (Coarse(),)\n"
        "from solidgear.app import main\n"
        "for line in sys.argv[1:]:\n"
        "    sys.argv = ['solidgear', *line.split()]\n"
        "    try:\n"
        "        main()\n"
        "    except SystemExit:\n"
        "        print('<end>', flush=True)\n"
    )
    lines = (
        "stiffness --help",
        "stiffness geometry/shaft_stepped.toml -f coarse",
        "compare geometry/shaft_stepped.toml --models x",
    )
    # the help is made when the command line is imported: a process of its own, one for all
    done = subprocess.run(
        [sys.executable, "-c", code, *lines],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=120,
        cwd=ROOT,
        env={**os.environ, "COLUMNS": "200"},  # a table that breaks no name
    )
    page, told, refused, _ = done.stdout.split("<end>")
    assert "coarse" in page
    assert "shaft_stepped: coarse" in told
    assert "choose from" in refused and "coarse" in refused
