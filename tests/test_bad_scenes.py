"""Every way we know to spoil a scene file is refused in one line that names the file, the key and
the value.

Each case is one textual edit of a scene that works.
"""

from pathlib import Path

import pytest

from solidgear.core.errors import SceneError, SolidgearError
from solidgear.core.loading import explained
from solidgear.core.scene.file import load

GOOD = (Path(__file__).parents[1] / "geometry" / "pinion_overhung.toml").read_text(encoding="utf-8")
BRG2 = GOOD.index('position = "150 mm"')  # edits marked "2:" are made from here on

# what is wrong: text in the good file, its replacement, key and value in the message, what else it
# says; the numbers at the end of the table are valid TOML, pass the sign checks, and led to overflow,
# endless meshes or singular matrices
TABLE = (Path(__file__).parent / "bad_scenes.txt").read_text(encoding="utf-8").splitlines()[1:]
CASES = {
    kind: [cell.replace("\\n", "\n") for cell in cells]
    for kind, *cells in (line.split(" | ") for line in TABLE)
} | {
    "2: no stiffness": (
        GOOD[GOOD.rindex("[bearing.stiffness]") : GOOD.index("# The source also")],
        "",
        'bearing[2] "2".stiffness',
        "",
        "missing",
    ),
    "newline in a key": ("tolerance = 0.05", '"a\\nb" = 1', "ask", "", "unknown key"),
    "unit without end": (
        '"7850 kg/m^3"',
        f'"7850 kg/m^{"9" * 4000}"',
        "material.density",
        "",
        "unknown unit",
    ),
}


def refusal(path):
    with pytest.raises(SceneError) as caught:
        load(path)
    message = str(caught.value)
    assert len(message.splitlines()) == 1 and len(message) < 600, message
    assert "pydantic" not in message
    return message


@pytest.mark.parametrize("kind", CASES)
def test_refused_in_one_line(kind, tmp_path):
    old, new, key, value, says = CASES[kind]
    start = GOOD.index(old, BRG2 - 40 if kind.startswith("2:") else 0)
    path = tmp_path / "spoilt.toml"
    path.write_text(GOOD[:start] + new + GOOD[start + len(old) :], encoding="utf-8")
    message = refusal(path)
    place = f"spoilt.toml: {key} = {value}: " if value else f"spoilt.toml: {key}"
    assert place in message
    assert says in message


def test_the_unspoilt_file_is_accepted(tmp_path):
    path = tmp_path / "spoilt.toml"
    path.write_text(GOOD, encoding="utf-8")
    assert load(path).name == "spoilt"


def spoilt_unit(i, j, value):
    """Rows of the unit matrix with one entry changed."""
    rows = [[float(i == j) for j in range(6)] for i in range(6)]
    rows[i][j] = value
    return rows


@pytest.mark.parametrize(
    "matrix, says",
    [
        ([[1, 0], [0, 1]], "6 rows of 6"),
        (spoilt_unit(0, 4, 0.5), "(x, thy) is 0.5"),
        (spoilt_unit(5, 5, float("nan")), "row 6, column 6"),
        (spoilt_unit(3, 3, -1.0), "the stiffness in thx is -1; it must not be negative"),
    ],
)
def test_bad_matrix(matrix, says, tmp_path):
    start, end = GOOD.rindex("[bearing.stiffness]"), GOOD.index("# The source also")
    path = tmp_path / "spoilt.toml"
    path.write_text(GOOD[:start] + f"matrix = {matrix}\n" + GOOD[end:], encoding="utf-8")
    message = refusal(path)
    assert 'spoilt.toml: bearing[2] "2".matrix = [[' in message and says in message


def test_no_segments(tmp_path):
    path = tmp_path / "spoilt.toml"
    path.write_text(
        'segment = []\nmaterial = {E = 2e11, nu = 0.3, density = 7850}\nport = {at = "start", span = [0, 1]}\n',
        encoding="utf-8",
    )
    assert "spoilt.toml: segment = []: a scene needs at least one" in refusal(path)


def test_no_file_or_a_folder(tmp_path):
    assert "absent.toml: there is no such file" in refusal(tmp_path / "absent.toml")
    assert "this is a folder" in refusal(tmp_path)


def test_a_name_that_is_no_text_is_no_datum(tmp_path):
    # such a name was written out among the known ones, some thousand characters of it
    path = tmp_path / "spoilt.toml"
    spoilt = GOOD.replace('name = "1"', f"name = {[[1, 0]] * 200}", 1)
    assert spoilt != GOOD and 'from = "bearing.1"' in GOOD
    path.write_text(spoilt, encoding="utf-8")
    with pytest.raises(SceneError, match="must be a text in quotes") as caught:
        load(path)
    assert max(map(len, str(caught.value).splitlines())) < 500


def test_what_bearings_do_not_settle_on_is_told_with_the_file():
    with pytest.raises(SceneError, match="^shaft.toml: shaft and bearings find no equilibrium$"):
        with explained("shaft.toml"):
            raise SolidgearError("shaft and bearings find no equilibrium")
