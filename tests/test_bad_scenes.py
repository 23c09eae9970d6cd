"""Every way we know to spoil a scene file is refused in one line that names the file, the key and
the value.

Each case is one textual edit of a scene that works.
"""

from pathlib import Path

import pytest

from solidgear.errors import SceneError, SolidgearError
from solidgear.scene.file import load
from solidgear.studies.loading import explained

GOOD = (Path(__file__).parents[1] / "geometry" / "pinion_overhung.toml").read_text(encoding="utf-8")
BRG2 = GOOD.index('position = "150 mm"')  # edits marked "2:" are made from here on

# what is wrong: (text in the good file, its replacement, key in the message, value in the message,
# what else it says)
CASES = {
    "zero length": (
        'length = "208 mm"',
        'length = "0 mm"',
        'segment[2] "shaft".length',
        '"0 mm"',
        "greater than zero",
    ),
    "negative diameter": (
        'diameter = "90 mm"',
        "diameter = -0.09",
        'segment[2] "shaft".diameter',
        "-0.09",
        "greater than zero",
    ),
    "bore as wide as the shaft": (
        'diameter = "90 mm"',
        'diameter = "90 mm"\nbore = "90 mm"',
        'segment[2] "shaft".bore',
        '"90 mm"',
        "smaller than diameter",
    ),
    "bore through the small end": (
        'toe = "start"',
        'bore = "86 mm"',
        'segment[1] "head".bore',
        '"86 mm"',
        "small end",
    ),
    "incompressible": ("nu = 0.3 ", "nu = 0.5 ", "material.nu", "0.5", "between -1 and 0.5"),
    "nu below -1": ("nu = 0.3 ", "nu = -1 ", "material.nu", "-1", "between -1 and 0.5"),
    "zero modulus": ('E = "207 GPa"', "E = 0", "material.E", "0", "greater than zero"),
    "negative density": (
        '"7850 kg/m^3"',
        '"-7850 kg/m^3"',
        "material.density",
        '"-7850 kg/m^3"',
        "greater than zero",
    ),
    "nu of one segment": (
        'name = "shaft"',
        'name = "shaft"\nmaterial = {nu = 0.7}',
        'segment[2] "shaft".material.nu',
        "0.7",
        "between",
    ),
    "flat pitch cone": (
        '"0.391 rad"',
        '"90 deg"',
        'segment[1] "head".pitch_angle',
        '"90 deg"',
        "between 0 and 90",
    ),
    "face past the apex": (
        'face_width = "63 mm"',
        'face_width = "180 mm"',
        'segment[1] "head".face_width',
        '"180 mm"',
        "cone distance 0.1758",
    ),
    "unknown unit": (
        'diameter = "90 mm"',
        'diameter = "90 mmm"',
        'segment[2] "shaft".diameter',
        '"90 mmm"',
        'unknown unit "mmm"',
    ),
    "wrong dimension": (
        'diameter = "90 mm"',
        'diameter = "90 kg"',
        'segment[2] "shaft".diameter',
        '"90 kg"',
        "not a unit of length",
    ),
    "ratio for an angle": (
        '"0.391 rad"',
        '"0.391 m/m"',
        'segment[1] "head".pitch_angle',
        '"0.391 m/m"',
        "not a unit of angle",
    ),
    "rpm for Hz": (
        '"10 kHz"',
        '"6000 rpm"',
        "ask.max_frequency",
        '"6000 rpm"',
        "not a unit of frequency",
    ),
    "text without a unit": (
        'diameter = "90 mm"',
        'diameter = "90"',
        'segment[2] "shaft".diameter',
        '"90"',
        "add a unit",
    ),
    "decimal comma": (
        'diameter = "90 mm"',
        'diameter = "9,0 cm"',
        'segment[2] "shaft".diameter',
        '"9,0 cm"',
        "90 mm",
    ),
    "not a number": (
        'diameter = "90 mm"',
        "diameter = true",
        'segment[2] "shaft".diameter',
        "true",
        "must be a number",
    ),
    "NaN": ('diameter = "90 mm"', "diameter = nan", 'segment[2] "shaft".diameter', "nan", "finite"),
    "infinite": (
        'length = "208 mm"',
        'length = "inf mm"',
        'segment[2] "shaft".length',
        '"inf mm"',
        "finite",
    ),
    "2: misspelt key": (
        "seat_width",
        "seat_widht",
        'bearing[2] "2".seat_widht',
        '"40 mm"',
        'did you mean "seat_width"',
    ),
    "misspelt table": ("[ask]", "[aks]", "aks", "", 'did you mean "ask"'),
    "2: missing key": ('seat_width = "40 mm"', "", 'bearing[2] "2".seat_width', "", "missing"),
    "missing table": ("[material]", "[[material]]", "material", "", "must be a table"),
    "2: no stiffness": (
        GOOD[GOOD.rindex("[bearing.stiffness]") : GOOD.index("# The source also")],
        "",
        'bearing[2] "2".stiffness',
        "",
        "missing",
    ),
    "unknown kind": (
        'kind = "cylinder"\nname',
        'kind = "cilinder"\nname',
        'segment[2] "shaft".kind',
        '"cilinder"',
        "'cylinder'",
    ),
    "missing kind": ('kind = "cylinder"\nname', "name", 'segment[2] "shaft".kind', "", "missing"),
    "unit for a ratio": ("nu = 0.3 ", 'nu = "0.3 m" ', "material.nu", '"0.3 m"', "plain ratio"),
    "2: bearings of one name": (
        'name = "2"',
        'name = "1"',
        'bearing[2] "1".name',
        '"1"',
        "another bearing",
    ),
    "segments of one name": (
        'name = "shaft"',
        'name = "head"',
        'segment[2] "head".name',
        '"head"',
        "another segment",
    ),
    "name of a datum": (
        'name = "shaft"',
        'name = "end"',
        'segment[2] "end".name',
        '"end"',
        "kept for datums",
    ),
    "unknown datum": (
        'from = "head.end"',
        'from = "haed.end"',
        'bearing[1] "1".from',
        '"haed.end"',
        'did you mean "head.end"',
    ),
    "later bearing as datum": (
        'from = "head.end"',
        'from = "bearing.2"',
        'bearing[1] "1".from',
        '"bearing.2"',
        "unknown datum",
    ),
    "2: seat past the end": (
        '"40 mm"',
        '"61 mm"',
        'bearing[2] "2".seat_width',
        '"61 mm"',
        "inside the shaft",
    ),
    "2: seats overlap": (
        'position = "150 mm"',
        'position = "39 mm"',
        'bearing[2] "2".seat_width',
        '"40 mm"',
        'overlaps that of "1"',
    ),
    "seat across the shoulder": (
        'position = "28 mm"',
        'position = "19.9 mm"',
        'bearing[1] "1".seat_width',
        '"40 mm"',
        "step",
    ),
    "port off the shaft": (
        'at = "head.mid_face"',
        'position = "-1 mm"',
        "port.position",
        '"-1 mm"',
        "outside the shaft",
    ),
    "unknown port datum": (
        'at = "head.mid_face"',
        'at = "head.midface"',
        "port.at",
        '"head.midface"',
        'did you mean "head.mid_face"',
    ),
    "span across the shoulder": (
        'attach_to = "head" ',
        'span = ["0 mm", "70 mm"]',
        "port.span",
        '["0 mm", "70 mm"]',
        "step",
    ),
    "span backwards": (
        'attach_to = "head" ',
        'span = ["30 mm", "20 mm"]',
        "port.span",
        '["30 mm", "20 mm"]',
        "beyond its start",
    ),
    "span with a wrong unit": (
        'attach_to = "head" ',
        'span = ["0 mm", "20 Hz"]',
        "port.span[2]",
        '"20 Hz"',
        "not a unit of length",
    ),
    "unknown segment": (
        'attach_to = "head" ',
        'attach_to = "gear"',
        "port.attach_to",
        '"gear"',
        "known here: head, shaft",
    ),
    "unknown attachment": (
        'attachment = "average"',
        'attachment = "glued"',
        "attachment",
        '"glued"',
        "'rigid'",
    ),
    "2: unknown stiffness entry": (
        "kzz",
        "kzx",
        'bearing[2] "2".stiffness.kzx',
        '"8.599e9 N/m"',
        "valid are kxx, kxy",
    ),
    "2: stiffness of a wrong dimension": (
        '"-1.521e8 N/rad"',
        '"-1.521e8 N/m"',
        'bearing[2] "2".stiffness.kx_thz',
        '"-1.521e8 N/m"',
        "not a unit of force",
    ),
    "2: coupling too strong": (
        '"-1.521e8 N/rad"',
        '"-1.821e8 N/rad"',
        'bearing[2] "2".stiffness',
        "",
        "indefinite in the pair (x, thz)",
    ),
    "2: coupling to nothing": (
        'kyy = "1.721e9 N/m"',
        "",
        'bearing[2] "2".stiffness',
        "",
        "indefinite in the pair (x, y)",
    ),
    "2: zero series spring": (
        '"4.1e8 N/m"',
        '"0 N/m"',
        'bearing[2] "2".axial_series[1]',
        '"0 N/m"',
        "greater than zero",
    ),
    "metres for millimetres": (
        'length = "208 mm"',
        "length = 208",
        'segment[2] "shaft".length',
        "208",
        "wrong units",
    ),
    "radius above 10 m": (
        'diameter = "90 mm"',
        "diameter = 90",
        'segment[2] "shaft".diameter',
        "90",
        "wrong units",
    ),
    "no modes": ("modes = 10", "modes = 0", "ask.modes", "0", "greater than or equal to 1"),
    "tolerance in per cent": (
        "tolerance = 0.05",
        "tolerance = 5",
        "ask.tolerance",
        "5",
        "between 0 and 1",
    ),
    "2: unknown status": (
        '"published"',
        '"guessed"',
        'bearing[2] "2".status',
        '"guessed"',
        "'identified'",
    ),
    "newline in a key": ("tolerance = 0.05", '"a\\nb" = 1', "ask", "1", "unknown key"),
}


def refusal(path):
    with pytest.raises(SceneError) as caught:
        load(path)
    message = str(caught.value)
    assert len(message.splitlines()) == 1, message
    assert "pydantic" not in message
    return message


@pytest.mark.parametrize("kind", CASES)
def test_refused_in_one_line(kind, tmp_path):
    old, new, key, value, says = CASES[kind]
    start = GOOD.index(old, BRG2 - 40 if kind.startswith("2:") else 0)
    path = tmp_path / "spoilt.toml"
    path.write_text(GOOD[:start] + new + GOOD[start + len(old) :], encoding="utf-8")
    message = refusal(path)
    place = (
        f"spoilt.toml: {key} = {value}: "
        if value and kind != "newline in a key"
        else f"spoilt.toml: {key}"
    )
    assert place in message
    assert says in message


def test_the_unspoilt_file_is_accepted(tmp_path):
    path = tmp_path / "spoilt.toml"
    path.write_text(GOOD, encoding="utf-8")
    assert load(path).name == "spoilt"


@pytest.mark.parametrize(
    "matrix, says",
    [
        ("[[1, 0], [0, 1]]", "6 rows of 6"),
        (
            "["
            + ", ".join(
                str([float(i == j) + 0.5 * (i == 0 and j == 4) for j in range(6)]) for i in range(6)
            )
            + "]",
            "(x, thy) is 0.5",
        ),
        (
            "["
            + ", ".join(str([float(i == j) for j in range(6)]) for i in range(5))
            + ", [0, 0, 0, 0, 0, nan]]",
            "row 6, column 6",
        ),
        (
            "["
            + ", ".join(str([float(i == j) * (-1) ** (i == 3) for j in range(6)]) for i in range(6))
            + "]",
            "the stiffness in thx is -1; it must not be negative",
        ),
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


@pytest.mark.parametrize(
    "content, says",
    [
        (b"title = ", "not valid TOML"),
        (b'title = "\xff\xfe"', "not UTF-8"),
        (b"a = " + b"[" * 5000, "spoilt.toml"),
    ],
)
def test_not_a_scene(content, says, tmp_path):
    path = tmp_path / "spoilt.toml"
    path.write_bytes(content)
    message = refusal(path)
    assert "spoilt.toml: " in message and says in message


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
