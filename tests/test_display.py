"""What scenes, bodies and results tell of themselves: short, whole, and fit for a notebook."""

import builtins
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

import solidgear as sg
from solidgear.comparison.models import Comparison
from solidgear.core.display import _shown
from solidgear.show.table import MOST_ROWS, Table

ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / "solidgear"


@pytest.fixture(scope="module")
def told():
    scene = sg.load(ROOT / "geometry" / "shaft_hollow.toml")
    body = sg.build(scene, "timoshenko")
    return {
        "scene": scene,
        "body": body,
        "modes": sg.modes(body, scene, n=6),
        "at": sg.condense(body, scene, "port"),
        "answer": sg.answer(scene, tol=0.1, ask="bending"),
        "comparison": sg.compare(scene, models=("euler", "timoshenko")),
    }


@pytest.mark.parametrize("name", ["scene", "body", "modes", "at", "answer", "comparison"])
def test_a_result_is_told_on_one_screen(told, name):
    text = repr(told[name])
    assert str(told[name]) == text
    assert 1 < len(text.splitlines()) <= MOST_ROWS + 3 and len(text) < 2500
    assert all(len(line) < 130 for line in text.splitlines())


def test_numbers_are_those_of_the_result(told):
    hz = told["modes"].named("bending 1").frequency_hz
    assert f"bending 1  {hz:.2f}" in " ".join(repr(told["modes"]).replace("  ", " ").split()) or (
        f"{hz:.2f}" in repr(told["modes"])
    )
    rows = told["at"].table("compliance").rows
    assert rows[2][3] == told["at"].compliance[2, 2]
    assert rows[4][5] is None and "free: thy" in repr(told["at"])
    assert told["answer"].table().rows[0][1] == told["answer"]["bending 1"]
    assert "not judged" in repr(told["comparison"])
    assert "bore 50 mm" in repr(told["scene"]) and "80 to 120 mm" in repr(told["scene"])


def test_a_mass_is_shown_where_it_sits():
    """Also one that moves with a bearing or a lumped point and has no seat of its own."""
    scene = sg.load(ROOT / "geometry" / "rotor_disc.toml")
    rows = {row[0]: row for row in scene.table().rows}
    assert rows["disc"][2:4] == rows["fan"][2:4] and rows["disc"][4] == "22 kg"
    assert rows["coupling"][3] - rows["coupling"][2] == pytest.approx(24.0)


class _Balanced(HTMLParser):
    def __init__(self):
        super().__init__()
        self.open, self.cells = [], []

    def handle_starttag(self, tag, attrs):
        self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if data.strip():
            self.cells.append(data)


def test_a_notebook_gets_a_table_and_no_markup_from_names():
    table = Table("<b>bold</b>", ("a", "b & c"), [("<script>", 1.5), (None, True)])
    page = _Balanced()
    page.feed(table._repr_html_())
    assert not page.open
    assert page.cells == ["<b>bold</b>", "a", "b & c", "<script>", "1.5", "–", "yes"]


def test_a_long_table_says_how_much_it_leaves_out():
    lines = repr(Table("many", ("n",), [(k,) for k in range(MOST_ROWS + 7)])).splitlines()
    assert len(lines) == MOST_ROWS + 3 and lines[-1] == "  and 7 more"


def test_pictures_show_what_is_asked(told):
    figure = told["modes"].plot(["bending 1", "axial 1"])
    panels = [panel for (panel,) in figure.rows]
    assert [panel.title.split(",")[0] for panel in panels] == ["bending 1", "axial 1"]
    lines = [layer.rows for layer in panels[0].layers if layer.mark["type"] == "line"]
    assert max(abs(row["y"]) for rows in lines for row in rows) == pytest.approx(1.0)
    assert told["scene"].plot().svg().startswith("<svg")
    with pytest.raises(ValueError, match="no such mode; there are"):
        told["modes"].plot(["bending 99"])
    with pytest.raises(TypeError, match="a Body has no picture"):
        told["body"].plot()


def test_a_data_frame_needs_pandas_and_nothing_else_does(told, monkeypatch):
    real = builtins.__import__

    def without(name, *rest):
        if name == "pandas":
            raise ImportError("No module named 'pandas'")
        return real(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(sg.SolidgearError, match="needs pandas: pip install"):
        told["modes"].to_dataframe()


def test_what_is_told_is_found_for_every_result(told):
    assert isinstance(told["comparison"], Comparison)
    for result in told.values():
        assert type(result).shown and isinstance(result.table(), Table)


def test_every_result_names_a_function_that_is_there():
    """Rooms move; a result that shows itself by a name must find it."""
    names = set()
    for path in sorted(PACKAGE.rglob("*.py")):
        names |= set(re.findall(r'shown: ClassVar\[str\] = "(\w[\w.:]*)"', path.read_text()))
    assert len(names) > 8
    assert [name for name in sorted(names) if not callable(_shown(name))] == []
