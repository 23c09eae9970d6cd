"""Every problem of a scene file is told at once, and files that are no scene end in a sentence."""

import os
import sys
import threading
from pathlib import Path

import pytest

from solidgear.core.errors import MOST_PROBLEMS, SceneError, show
from solidgear.core.scene import Port, Scene, Segment
from solidgear.core.scene.file import load

GOOD = (Path(__file__).parents[1] / "geometry" / "pinion_overhung.toml").read_text(encoding="utf-8")


def spoilt(*changes):
    text = GOOD
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    return text


def refusal(text, tmp_path):
    path = tmp_path / "spoilt.toml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(SceneError) as caught:
        load(path)
    return caught.value


def sentences(text, tmp_path):
    """What is said of each problem, without the file's name."""
    error = refusal(text, tmp_path)
    mark = "spoilt.toml: "
    lines = str(error).splitlines()
    if len(error.problems) > 1:
        assert lines[0].startswith(f"{len(error.problems)} problems in ") and lines[0].endswith(
            "spoilt.toml"
        )
        assert all(line.startswith("  ") for line in lines[1:])
        lines = lines[1:]
    assert all(mark in line for line in lines), lines
    return [line.split(mark, 1)[1] for line in lines]


# ------------------------------------------------------------------------------------------------- all of them
def test_every_problem_in_the_order_of_the_file(tmp_path):
    text = spoilt(
        ('E = "207 GPa"', 'E = "207 GPA"'),
        ("pitch_radius", "pitch_radios"),
        ('kxx = "8.823e9 N/m"', 'kxx = "8.823e9 N"'),
        ('from = "head.end"', 'from = "haed.end"'),
        ('attach_to = "head" ', 'attach_to = "gear"'),
        ("tolerance = 0.05", "tolerance = 5"),
    )
    found = sentences(text, tmp_path)
    order = [
        "material.E",
        "segment[1]",
        "bearing[1]",
        "bearing[1]",
        "port.attach_to",
        "ask.tolerance",
    ]
    # the file itself says in which order its tables stand
    order.sort(
        key=lambda name: text.index(
            {
                "material": "[material]",
                "segment": "[[segment]]",
                "bearing": "[[bearing]]",
                "port": "[port]",
                "ask": "[ask]",
            }[name.split("[")[0].split(".")[0]]
        )
    )
    assert [line[: len(name)] for line, name in zip(found, order)] == order and len(found) == len(
        order
    )
    assert any('did you mean "pitch_radius"' in line for line in found)


def test_all_entries_of_a_stiffness(tmp_path):
    found = sentences(
        spoilt(
            ('kxx = "8.823e9 N/m"', "kxx = true\nkxq = 1"), ('kyy = "8.887e8 N/m"', 'kyy = "1 Hz"')
        ),
        tmp_path,
    )
    assert [line.split(" = ")[0] for line in found] == [
        'bearing[1] "1".stiffness.kxx',
        'bearing[1] "1".stiffness.kxq',
        'bearing[1] "1".stiffness.kyy',
    ]


def test_places_are_judged_beside_a_bearing_that_is_refused(tmp_path):
    found = sentences(
        spoilt(
            ('seat_width = "40 mm"', 'seat_width = "40 mN"'),
            ('position = "150 mm"', 'position = "900 mm"'),
            ('at = "head.', 'position = "2 m" #'),
        ),
        tmp_path,
    )
    assert [line.split(" = ")[0] for line in found] == [
        'bearing[1] "1".seat_width',
        "port.position",
    ]
    assert (
        "outside the shaft" in found[1]
    )  # the second bearing hangs on the first, whose place is not known


def test_a_consequence_is_not_told(tmp_path):
    # nothing is said of seats beyond a shaft whose length is in doubt, nor of the name of what is
    # misspelt
    assert len(sentences(spoilt(('length = "208 mm"', "length = 208")), tmp_path)) == 1
    assert len(sentences(spoilt(("seat_width", "seat_widht")), tmp_path)) == 1
    assert len(sentences(spoilt(('diameter = "90 mm"', 'diameter = "90 um"')), tmp_path)) == 1


def test_a_long_list_is_cut(tmp_path):
    error = refusal(
        spoilt(("[ask]", "[ask]\n" + "\n".join(f"x{k} = 1" for k in range(MOST_PROBLEMS + 5)))),
        tmp_path,
    )
    lines = str(error).splitlines()
    assert len(error.problems) == MOST_PROBLEMS + 5 and len(lines) == MOST_PROBLEMS + 2
    assert lines[0].startswith(f"{MOST_PROBLEMS + 5} problems") and lines[-1] == "  and 5 more"


def test_an_empty_file(tmp_path):
    told = sentences("", tmp_path)
    for line, name in zip(told, ("material", "segment"), strict=True):
        assert line.startswith(f"{name}: this key is missing; write {name} = ")


def test_a_place_for_a_position_is_sent_to_its_key(tmp_path):
    """Also of the shaft itself; what is neither a place nor a number is told as before."""
    for place in ("seat.middle", "end"):
        (line,) = sentences(spoilt(('position = "', f'position = "{place}"  # ')), tmp_path)
        assert line.endswith(f'write position = "0 mm" and from = "{place}"')
    (line,) = sentences(spoilt(('position = "', 'position = "about"  # ')), tmp_path)
    assert "must be a number with a unit" in line


@pytest.mark.parametrize(
    ("written", "instead", "meant"),
    [
        ("density", "rho", "density"),
        ("position", "at", "position"),
        ("seat_width", "width", "seat_width"),
        ("diameter", "od", "diameter"),
        ("seat_width", "kzz", "stiffness.kzz"),
        ("seat_width", "contact_angle", "catalogue.contact_angle"),
        ("seat_width", "designation", "catalogue.designation"),  # and not position, which is alike
        ("seat_width", "seat_widht", "seat_width"),
    ],
)
def test_words_of_the_field_are_sent_to_their_keys(written, instead, meant, tmp_path):
    told = sentences(spoilt((f"{written} =", f"{instead} =")), tmp_path)
    assert any(f'unknown key; did you mean "{meant}"?' in line for line in told), told


def test_one_problem_is_one_sentence(tmp_path):
    error = refusal(spoilt(("nu = 0.3 ", "nu = 0.7 ")), tmp_path)
    assert error.problems == (error,) and "\n" not in str(error)
    assert (error.field, error.value, error.path) == ("material.nu", "0.7", ("material", "nu"))


def test_a_scene_made_in_python_keeps_its_problems():
    rod = Segment.cylinder("rod", length=0.3, diameter=0.06)
    with pytest.raises(SceneError) as caught:
        Scene.from_parts([rod], port=Port(y=1.0, lo=0.2, hi=0.1))
    assert [one.path for one in caught.value.problems] == [("port", "y"), ("port", "hi")]
    assert str(caught.value).endswith("(and 1 more problem: see its problems)") and "\n" not in str(
        caught.value
    )


# ------------------------------------------------------------------------------------------------- no TOML
PLAIN = {
    "a second port": (
        "[port]",
        '[port]\nname = "a"\n[port]',
        "line",
        "there is a second [port]; each is written with double brackets, [[port]]",
    ),
    "a port after a list of them": (
        "[port]",
        '[port]\nname = "a"\n[[port]]',
        "line",
        "there is a [port] before; each is written with double brackets, [[port]]",
    ),
    "single brackets": (
        "[[segment]]",
        '[segment]\nname = "a"\n[segment]',
        "line",
        "written with double brackets, [[segment]]",
    ),
    "second stiffness": (
        "[bearing.stiffness]",
        "[bearing.stiffness]\n[bearing.stiffness]",
        "line",
        "second [bearing.stiffness]; a bearing has one",
    ),
    "decimal comma": (
        'diameter = "90 mm"',
        "diameter = 0,09",
        "diameter = 0,09",
        "decimals take a point",
    ),
    "unquoted unit": (
        'diameter = "90 mm"',
        "diameter = 90 mm",
        "diameter = 90 mm",
        "is a text in quotes",
    ),
    "unquoted text": (
        'from = "head.end"',
        "from = head.end",
        "from = head.end",
        "a text is written in quotes",
    ),
    "key twice": (
        'diameter = "90 mm"',
        'diameter = "90 mm"\ndiameter = "80 mm"',
        "diameter",
        "a key is given twice",
    ),
    "no value": ('diameter = "90 mm"', "diameter =", "diameter =", "no value behind the ="),
    "open quotes": (
        'diameter = "90 mm"',
        'diameter = "90 mm',
        "diameter",
        "last quotes are missing",
    ),
    "colon": ('diameter = "90 mm"', 'diameter: "90 mm"', "diameter:", "behind =, not behind :"),
    "Python's truth": ('diameter = "90 mm"', "diameter = True", "diameter = True", "true or false"),
}


@pytest.mark.parametrize("kind", PLAIN)
def test_the_parser_in_plain_words(kind, tmp_path):
    old, new, line, says = PLAIN[kind]
    (found,) = sentences(spoilt((old, new)), tmp_path)
    assert found.startswith("not valid TOML in line ") and line in found and says in found
    assert not any(word in found for word in ("Cannot", "Expected", "('", "(at "))


@pytest.mark.parametrize("table", ["[[material]]"])
def test_double_brackets_where_there_is_one(table, tmp_path):
    (found,) = sentences(spoilt((table[1:-1], table)), tmp_path)
    assert f"write {table[1:-1]} with single brackets" in found


@pytest.mark.parametrize(
    "content, says",
    [
        (b"title = '\0'", "not UTF-8 text (byte 9): it is UTF-16 or no text"),
        (GOOD.encode("utf-16"), "UTF-16"),
        ("title = 'Welle für Öl'".encode("latin-1"), "not UTF-8 text (byte 16)"),
        (b"title" + b".a" * 1000 + b" = 1", "more than 100 full stops"),
        (b"a = " + b"[" * 5000, "nested too deeply"),
        (b"material = " + b"{a=" * 60 + b"1" + b"}" * 60, "material.a"),
        (b"[material]\nE = 0x" + b"f" * 5000, "material.E = 0xfff"),
        (b"[material]\nE = " + b"9" * 5000, "thousands of digits"),
        (b"segment = [" + b"{}," * 101 + b"]", "101 segments are more than the 100"),
        (b"bearing = [" + b"{}," * 51 + b"]", "51 bearings are more than the 50"),
        (b"a = 1\n" * 60_000, "larger than 300 kB"),
    ],
)
def test_no_scene(content, says, tmp_path):
    message = str(refusal(content, tmp_path))
    assert says in message and len(message) < 10_000 and message.replace("\n", "").isprintable()


def test_a_byte_order_mark_is_no_problem(tmp_path):
    path = tmp_path / "marked.toml"
    path.write_bytes(b"\xef\xbb\xbf" + GOOD.encode())
    assert load(path).name == "marked"


@pytest.mark.skipif(sys.platform == "win32", reason="needs pipes and devices in the file system")
def test_pipes_and_devices_are_not_waited_for(tmp_path):
    pipe = tmp_path / "scene.toml"
    os.mkfifo(pipe)
    found = []

    def read(path):
        try:
            load(path)
        except SceneError as error:
            found.append(str(error))

    for path in (pipe, "/dev/zero", "/dev/null"):
        # a thread of its own, since reading an empty pipe would never return
        reader = threading.Thread(target=read, args=(path,), daemon=True)
        reader.start()
        reader.join(10.0)
    assert len(found) == 3 and all(
        "this is a pipe or a device, not a file" in message for message in found
    )


# ------------------------------------------------------------------------------------------------- texts
def test_values_of_any_size_and_depth_are_shown():
    deep = {}
    for _ in range(5000):
        deep = {"a": deep}
    assert show(deep).startswith('{"a": {"a": ') and len(show(deep)) == 70
    assert show(10**6000).startswith("0x") and show([1.5] * 10**6, 20) == "[1.5, 1.5, 1.5, 1..."
    assert (
        show("\u202e\x1b[2J\n") == '"\\u202e\\u001b[2J\\n"'
        and show([None, True, float("nan"), -float("inf")]) == "[null, true, nan, -inf]"
    )


TRAPS = {
    '"1,000 mm"': "decimals take a point",
    '"nan mm"': "finite",
    "1979-05-27": "must be a number",
    "12:00:00": "must be a number",
    "123456789012345678901234567890": "larger than 1e+24",
    '"3.5 K"': "not a unit of length",
    "[1]": "must be a number",
    "{a = 1}": "must be a number",
    '""': "must be a number",
}


@pytest.mark.parametrize("written", TRAPS)
def test_what_a_length_may_not_be(written, tmp_path):
    (found,) = sentences(spoilt(('diameter = "90 mm"', f"diameter = {written}")), tmp_path)
    assert found.startswith('segment[2] "shaft".diameter = ') and TRAPS[written] in found


def test_a_fillet_beside_a_feature_on_no_segment_is_told_of_the_segment(tmp_path):
    """A feature without a place was asked for it by every fillet, which ended in a traceback."""
    feature = '[[feature]]\nkind = "flat"\nsegment = "shift"\nlength = 0.02\ndepth = 0.004\n'
    fillet = '[[feature]]\nkind = "fillet"\nat = "head.end"\nradius = "1 mm"\n\n'
    (told,) = sentences(spoilt(("[ask]", f"{feature}{fillet}[ask]")), tmp_path)
    assert told.startswith("feature[1].segment") and 'did you mean "shaft"' in told
